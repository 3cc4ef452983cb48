//! The window's graphics device is lost: the picture comes back, and running work continues.

use super::resizing::{SAYS, Watched, on_any_thread, shows_window_of, stencil_site};
use super::xvfb::{screen, server, shades};
use super::*;

/// The pixels of what is shown.
fn pixels(harness: &Harness<'_, App>) -> Vec<[u8; 4]> {
    harness.state().picture().expect("a picture").2
}

/// How many pixels of two pictures differ.
fn differing(a: &[[u8; 4]], b: &[[u8; 4]]) -> usize {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).filter(|(a, b)| a != b).count()
}

fn later(harness: &mut Harness<'_, App>, key: Key) {
    harness.key_press_modifiers(egui::Modifiers::SHIFT, key);
    harness.step();
}

#[test]
fn picture_comes_again_whose_device_is_lost() {
    let (_folder, site) = stencil_site("2h");
    let mut harness = window(Some(&site));
    let first = pixels(&harness);
    later(&mut harness, Key::ArrowRight);
    settle(&mut harness);
    let moved = pixels(&harness);
    assert_ne!(first, moved, "an hour later the shadows lie elsewhere");
    later(&mut harness, Key::ArrowLeft);
    settle(&mut harness);
    assert_eq!(harness.state().fault_and_notice(), [None, None]);
    // while one is drawn, and before the next is asked for
    later(&mut harness, Key::ArrowRight);
    harness.state().lose_pictures(0);
    settle(&mut harness);
    let [fault, note] = harness.state().fault_and_notice();
    assert_eq!(fault, None);
    let note = note.expect("it is told");
    assert!(note.contains("its device was lost"), "{note}");
    assert!(note.ends_with("; the picture was drawn again on a new device"), "{note}");
    harness.get_by_label_contains("the picture was drawn again");
    // it takes room from the picture
    click(&mut harness, "Close");
    settle(&mut harness);
    assert_eq!(differing(&pixels(&harness), &moved), 0, "the same picture on a new device");
    later(&mut harness, Key::ArrowLeft);
    settle(&mut harness);
    assert_eq!(differing(&pixels(&harness), &first), 0, "and so is what follows");
}

/// The processor's picture has the adapter's colours and shadows; lines are its own.
#[test]
fn picture_comes_without_any_device() {
    let mut harness = window(Some(&sample("tower")));
    let right = pixels(&harness);
    let about = |a: &[u8; 4], b: &[u8; 4]| a.iter().zip(b).all(|(a, b)| a.abs_diff(*b) <= 6);
    for (further, note) in [
        (1, "again; pictures are drawn on the processor now, by '"),
        (2, "; pictures are drawn on the processor now, with sun and shadow alone"),
    ] {
        later(&mut harness, Key::ArrowRight);
        harness.state().lose_pictures(further);
        later(&mut harness, Key::ArrowLeft);
        settle(&mut harness);
        let [fault, told] = harness.state().fault_and_notice();
        assert_eq!(fault, None);
        assert!(told.is_some_and(|told| told.contains("its device was lost") && told.contains(note)), "{told:?}");
        click(&mut harness, "Close");
        settle(&mut harness);
        let drawn = pixels(&harness);
        assert_eq!(drawn.len(), right.len());
        let alike = drawn.iter().zip(&right).filter(|(a, b)| about(a, b)).count();
        assert!(alike * 100 > drawn.len() * 90, "{further}: {alike} of {} pixels are alike", drawn.len());
    }
    // and on it goes
    harness.key_press(Key::Num2);
    settle(&mut harness);
    assert_eq!(harness.state().fault_and_notice()[0], None);
}

const LOST: &str = "lost::window_is_opened_again_whose_device_is_lost";

/// Adds up hours, with every device of the window lost on the way, and says whether all is as it was.
fn losing_window() {
    let (_folder, site) = stencil_site("2min");
    let (mut step, mut frames, mut right) = (0, 0, Vec::new());
    desktop::open_with(Some(&site), &on_any_thread, &mut |app, context| {
        frames += 1;
        context.request_repaint_after(Duration::from_millis(20));
        let rests = app.is_settled() && frames > 5;
        let picture = |app: &App| app.picture().expect("a picture").2;
        let before = step;
        match step {
            0 if rests => {
                app.find_hours(context);
                step = 1;
            }
            1 if rests => {
                right = picture(app);
                println!("{SAYS}hours {:?}", app.fault_and_notice());
                step = 2;
            }
            // somebody looks at the screen
            2 if frames == 100 => app.find_hours(context),
            2 if frames > 101 => {
                println!("{SAYS}a study is under way: {}", app.is_adding());
                app.lose_window();
                step = 3;
            }
            // the message takes room from the picture
            3 | 6 if rests => {
                println!("{SAYS}again {:?}", app.fault_and_notice());
                app.hush();
                step += 1;
            }
            4 | 7 if rests => {
                println!("{SAYS}the same hours: {}", picture(app) == right);
                println!("{SAYS}look");
                step += 1;
            }
            // somebody looks at the screen
            5 if frames > 150 => {
                app.lose_pictures(0);
                // egui's renderer panics
                app.lose_window_in_painting(context);
                step = 6;
            }
            8 => context.send_viewport_cmd(egui::ViewportCommand::Close),
            _ => {}
        }
        if step != before {
            frames = 0;
        }
    })
    .expect("a window");
    println!("{SAYS}closed");
}

#[test]
fn window_is_opened_again_whose_device_is_lost() {
    if shows_window_of(LOST) {
        return losing_window();
    }
    let (_server, display) = server(2);
    let mut window = Watched::start(LOST, &display);
    window.until("hours [None, None]");
    // the frame that shows them is painted a moment later
    std::thread::sleep(Duration::from_millis(500));
    let before = shades(&screen(&display).2);
    window.until("look");
    std::thread::sleep(Duration::from_millis(500));
    let after = shades(&screen(&display).2);
    window.until("closed");
    let said = window.said.join("\n");
    assert!(said.contains("a study is under way: true"), "{said}");
    assert_eq!(said.matches("the same hours: true").count(), 2, "{said}");
    let why = "failed (its device was lost); the window was opened again on a new device";
    assert_eq!(said.matches(why).count(), 2, "{said}");
    assert!(before.iter().zip(&after).all(|(a, b)| (a - b).abs() < 0.02), "{before:?} {after:?}");
    assert!(window.process.0.wait().expect("an end").success());
}

const OFTEN: &str = "lost::window_goes_to_the_processor_and_gives_up";

/// Loses the device of each window in its first frames, and prints what the next window says about it.
fn losing_again_and_again() {
    let mut frames = 0;
    let ended = desktop::open_with(None, &on_any_thread, &mut |app, context| {
        frames += 1;
        context.request_repaint_after(Duration::from_millis(20));
        if frames == 3 {
            println!("{SAYS}{:?}", app.fault_and_notice());
            match app.fault_and_notice()[1].is_some_and(|told| told.contains("processor")) {
                true => app.lose_window_in_painting(context),
                false => app.lose_window(),
            }
            frames = 0;
            app.hush();
        }
    });
    println!("{SAYS}ended: {}", ended.expect_err("every device is lost"));
}

/// Devices that are lost again and again: the fourth time within a minute the processor draws the window, and where those
/// of the processor are lost as often the program says so and ends.
#[test]
fn window_goes_to_the_processor_and_gives_up() {
    if shows_window_of(OFTEN) {
        return losing_again_and_again();
    }
    let (_server, display) = server(4);
    let mut window = Watched::start(OFTEN, &display);
    window.until_any("ended: ");
    let said = &window.said;
    assert_eq!(said.len(), 9, "{said:#?}");
    assert_eq!(said[0], "[None, None]");
    for (at, said) in said.iter().enumerate().skip(1) {
        let rest = match at {
            4 => "time and again; the window is drawn on the processor now",
            8 => "time and again, and no window can be shown; check its driver",
            _ => "failed (its device was lost); the window was opened again on a new device",
        };
        assert!(said.contains(rest), "{at}: {said}");
    }
    assert!(window.process.0.wait().expect("an end").success());
}
