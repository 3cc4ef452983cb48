//! The hours and the exported files are the same as those of the command.

use super::*;
use std::process::Command;

pub(crate) fn command(arguments: &[&std::ffi::OsStr]) {
    let output = Command::new(env!("CARGO_BIN_EXE_gnomon")).args(arguments).output().expect("the command");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

/// If the system has no dialogs, the window shows its own.
pub(crate) fn answer(harness: &mut Harness<'_, App>, path: &Path, go: &str) {
    name(harness, path);
    if harness.query_by_label(go).is_some() {
        click(harness, go);
    }
    settle(harness);
}

/// The same, without waiting for the result.
pub(crate) fn name(harness: &mut Harness<'_, App>, path: &Path) {
    let begun = Instant::now();
    while harness.query_by_role_and_label(egui::Role::TextInput, "Path").is_none() {
        harness.step();
        std::thread::sleep(Duration::from_millis(5));
        assert!(begun.elapsed() < Duration::from_secs(20), "no dialog came");
    }
    write(harness, "Path", &path.display().to_string());
}

pub(crate) fn menu(harness: &mut Harness<'_, App>, entry: &str) {
    click(harness, "File");
    // its keys are part of its name
    harness.get_by_label_contains(entry).click();
    harness.step();
    harness.step();
}

#[test]
fn hours_are_those_of_the_command() {
    let (folder, site) = small_site();
    let mut harness = window(Some(&site));
    click(&mut harness, "Find the hours");
    settle(&mut harness);
    harness.get_by_label_contains("Hours of shadow out of 8:00");
    let shown = harness.state().picture().unwrap();
    click(&mut harness, "Show the hours");
    settle(&mut harness);
    assert!(shown.2 != harness.state().picture().unwrap().2, "the hours are shown");
    menu(&mut harness, "Export the hours…");
    let out = folder.path().join("window");
    answer(&mut harness, &out, "Write");
    let by_command = folder.path().join("command");
    command(&["profile".as_ref(), site.as_ref(), "--out".as_ref(), by_command.as_ref(), "--quiet".as_ref()]);
    for name in ["shadow-hours.tif", "profile.png"] {
        let [ours, theirs] = [&out, &by_command].map(|folder| std::fs::read(folder.join(name)).unwrap());
        assert!(ours == theirs, "{name} is another one");
    }
}

/// Iso-hour lines and outlines, each as PNG and as SVG; messages about what cannot be drawn do not name options of the
/// command.
#[test]
fn lines_are_those_of_the_command() {
    let (folder, site) = small_site();
    let mut harness = window(Some(&site));
    click(&mut harness, "File");
    for entry in ["Export the iso-hour lines…", "Export the outlines…"] {
        assert!(harness.get_by_label(entry).accesskit_node().is_disabled(), "{entry}: nothing is found yet");
    }
    harness.key_press(Key::Escape);
    harness.run_steps(2);
    click(&mut harness, "Find the hours");
    settle(&mut harness);
    let out = folder.path().join("window");
    for entry in ["Export the iso-hour lines…", "Export the outlines…"] {
        menu(&mut harness, entry);
        answer(&mut harness, &out, "Write");
    }
    // beside the result there is the way to the other files
    click(&mut harness, "Export…");
    answer(&mut harness, &out, "Write");
    let by_command = folder.path().join("command");
    let options = ["--draw", "hours,outlines", "--bits", "--quiet", "--out"].map(std::ffi::OsStr::new);
    command(&[&["profile".as_ref(), site.as_os_str()], options.as_slice(), &[by_command.as_ref()]].concat());
    let names = ["hours.png", "hours.svg", "outlines.png", "outlines.svg", "profile.png", "shadow-hours.tif"];
    for name in names.into_iter().chain(["shadow.bits"]) {
        let [ours, theirs] = [&out, &by_command].map(|folder| std::fs::read(folder.join(name)).unwrap());
        assert!(ours == theirs, "{name} is another one");
    }

    write(&mut harness, "step", "10min");
    settle(&mut harness);
    click(&mut harness, "Find the hours");
    settle(&mut harness);
    menu(&mut harness, "Export the outlines…");
    answer(&mut harness, &folder.path().join("none"), "Write");
    harness.get_by_label_contains("49 instants with a sun are too many to tell apart");
    assert!(harness.query_by_label_contains("--").is_none(), "the window has no options");
    assert!(!folder.path().join("none").exists());
    menu(&mut harness, "Export the iso-hour lines…");
    answer(&mut harness, &folder.path().join("none"), "Write");
    assert!(folder.path().join("none/hours.svg").exists(), "lines of hours can be drawn");
}

#[test]
fn click_on_the_model_finds_when_the_sun_reaches_it() {
    let (_folder, site) = small_site();
    let mut harness = window(Some(&site));
    let rect = harness.get_by_label("Model").rect();
    let at = rect.left_bottom() + egui::vec2(200.0, -40.0);
    harness.hover_at(at);
    harness.step();
    harness.step();
    harness.get_by_label_contains("ground    ");
    click_at(&mut harness, at);
    harness.get_by_label("Sun at ground");
    harness.get_by_label("The sky of the point");
    assert!(harness.query_all_by_label_contains("of sun").count() > 0);
    click(&mut harness, "Keep in the site file");
    settle(&mut harness);
    assert_eq!(harness.state().site_file().probe.len(), 1);
    click(&mut harness, "Forget the point");
    assert!(harness.query_by_label("Sun at ground").is_none());
}

/// The result at a point disappears together with its scene.
#[test]
fn card_of_a_point_goes_with_its_scene() {
    let (_folder, site) = small_site();
    let mut harness = window(Some(&site));
    click(&mut harness, "Components");
    let at = harness.get_by_label("Model").rect().left_bottom() + egui::vec2(200.0, -40.0);
    let probe = |harness: &mut Harness<'_, App>| {
        click_at(harness, at);
        harness.get_by_label("Sun at ground");
    };
    probe(&mut harness);
    // another study is of the same scene
    write(&mut harness, "step", "4h");
    settle(&mut harness);
    harness.get_by_label("Sun at ground");
    harness.get_by_label("Latitude").set_value_accesskit(-33.9);
    harness.step();
    settle(&mut harness);
    assert!(harness.query_by_label("Sun at ground").is_none(), "the place is another");
    probe(&mut harness);
    let loaded = gnomon::site::Site::load(&site, &gnomon::site::Overrides::default()).unwrap();
    click(&mut harness, &format!("{} casts", loaded.mesh.components[0].name));
    settle(&mut harness);
    assert!(harness.query_by_label("Sun at ground").is_none(), "the casters are others");
}

/// The drawing of what is shown, and the site file that is saved elsewhere.
fn exported_and_saved(harness: &mut Harness<'_, App>, folder: &Path) -> [PathBuf; 2] {
    let both = ["window.png", "elsewhere/site.toml"].map(|name| folder.join(name));
    menu(harness, "Export the drawing…");
    answer(harness, &both[0], "Write");
    menu(harness, "Save as…");
    answer(harness, &both[1], "Write");
    both
}

/// A saved site reopens to the same view, and the command reads it.
#[test]
fn saved_site_reopens_to_the_same_view() {
    let (folder, site) = small_site();
    let text = std::fs::read_to_string(&site).unwrap();
    std::fs::write(&site, text.replace("[[model]]", "# drawn in 2024\n[[model]]").replace("\"2h\"", "\"2h\" # coarse"))
        .unwrap();
    let mut harness = window(Some(&site));
    let rect = harness.get_by_label("Model").rect();
    drag(&mut harness, rect.left_bottom() + egui::vec2(80.0, -60.0), rect.left_bottom() + egui::vec2(180.0, -90.0));
    write(&mut harness, "step", "4h");
    settle(&mut harness);
    // what is exported from here is what the command draws from what is saved
    let [ours, saved] = exported_and_saved(&mut harness, folder.path());
    let before = harness.state().picture_view().unwrap();
    let again = window(Some(&saved));
    let after = again.state().picture_view().unwrap();
    let (gnomon::view::View::Camera(before), gnomon::view::View::Camera(after)) = (before.0, after.0) else {
        panic!("two cameras")
    };
    assert!(before.eye.distance(after.eye) < 0.005, "{before:?}, {after:?}");
    assert_eq!(again.state().site_file().study.step.as_deref(), Some("4h"));
    let theirs = folder.path().join("command.png");
    let camera = ["--view", "camera", "--at", "2026-03-21T13:00", "--out"].map(std::ffi::OsStr::new);
    command(&[&["shadow".as_ref(), saved.as_os_str()], camera.as_slice(), &[theirs.as_ref()]].concat());
    let [ours, theirs] = [ours, theirs].map(|path| std::fs::read(path).unwrap());
    assert!(ours == theirs, "the perspective is another one");
    let text = std::fs::read_to_string(&saved).unwrap();
    assert!(text.contains("# drawn in 2024") && text.contains("step = \"4h\" # coarse"), "{text}");
}

/// So it does before a side, with the same point in the middle and the same scale.
#[test]
fn saved_site_reopens_to_the_same_side() {
    let (folder, site) = small_site();
    let mut harness = window(Some(&site));
    harness.key_press(Key::Num6);
    harness.step();
    let rect = harness.get_by_label("Model").rect();
    drag(&mut harness, rect.left_bottom() + egui::vec2(80.0, -60.0), rect.left_bottom() + egui::vec2(187.0, -93.0));
    settle(&mut harness);
    let [ours, saved] = exported_and_saved(&mut harness, folder.path());
    let before = harness.state().picture_view().unwrap();
    let mut again = window(Some(&saved));
    let after = again.state().picture_view().unwrap();
    let (gnomon::view::View::Elevation(before), gnomon::view::View::Elevation(after)) = (before.0, after.0) else {
        panic!("two sides")
    };
    assert_eq!(before.to_viewer, after.to_viewer);
    assert!(before.target.distance(after.target) < 0.001, "{before:?}, {after:?}");
    // a window wider than the sheet is as wide, whatever row of messages takes of its height
    let [wide, again_wide] = [before, after].map(|side| side.cell * f64::from(side.width));
    assert!((wide / again_wide - 1.0).abs() < 1e-4, "{before:?}, {after:?}");
    let theirs = folder.path().join("command.png");
    for view in ["camera", "west"] {
        let asked = ["--view", view, "--at", "2026-03-21T13:00", "--out"].map(std::ffi::OsStr::new);
        command(&[&["shadow".as_ref(), saved.as_os_str()], asked.as_slice(), &[theirs.as_ref()]].concat());
        let [ours, theirs] = [&ours, &theirs].map(|path| std::fs::read(path).unwrap());
        assert!(ours == theirs, "--view {view} is another drawing");
    }
    // the perspective is still there, and saved in its turn it is no side any more
    again.key_press(Key::Num1);
    again.step();
    settle(&mut again);
    menu(&mut again, "Save the site file");
    settle(&mut again);
    let text = std::fs::read_to_string(&saved).unwrap();
    assert!(text.contains("eye = ") && !text.contains("side"), "{text}");
}

#[test]
fn drawing_is_that_of_the_command() {
    let (folder, site) = small_site();
    let mut harness = window(Some(&site));
    harness.key_press(Key::Num2);
    harness.step();
    settle(&mut harness);
    menu(&mut harness, "Export the drawing…");
    let ours = folder.path().join("window.png");
    answer(&mut harness, &ours, "Write");
    let theirs = folder.path().join("command.png");
    let at = "2026-03-21T13:00";
    command(&["shadow".as_ref(), site.as_ref(), "--at".as_ref(), at.as_ref(), "--out".as_ref(), theirs.as_ref()]);
    let [ours, theirs] = [ours, theirs].map(|path| std::fs::read(path).unwrap());
    assert!(ours == theirs, "the drawing is another one");
}

/// An export's own notes stand with the others, as long as the site is the one that was exported.
#[test]
fn what_an_export_notes_is_shown() {
    let (folder, site) = small_site();
    // a letter that no font has
    let text = std::fs::read_to_string(&site).unwrap().replace("Works", "Works \u{A4CF}");
    std::fs::write(&site, text).unwrap();
    let mut harness = with_boxes(Some(&site));
    let noted = |harness: &Harness<'_, App>| {
        harness.query_all_by_label_contains("no font has the letters \u{A4CF} of \"Works").count()
    };
    assert_eq!(noted(&harness), 0);
    menu(&mut harness, "Export the drawing…");
    answer(&mut harness, &folder.path().join("window.png"), "Write");
    assert_eq!(noted(&harness), 1, "the drawing has a box for a letter");
    click(&mut harness, "Find the hours");
    settle(&mut harness);
    for (entry, out) in [("Export the hours…", "hours"), ("Export the animation…", "day")] {
        menu(&mut harness, entry);
        answer(&mut harness, &folder.path().join(out), "Write");
        assert_eq!(noted(&harness), 1, "said once, of the last export");
    }
    write(&mut harness, "step", "4h");
    settle(&mut harness);
    assert_eq!(noted(&harness), 0, "another site was exported");
}

/// A model is not replaced by what is made of it.
#[test]
fn nothing_is_exported_over_a_model() {
    let (folder, site) = small_site();
    let mut harness = window(Some(&site));
    let model = folder.path().join("works.glb");
    let before = std::fs::read(&model).unwrap();
    menu(&mut harness, "Export the drawing…");
    answer(&mut harness, &model, "Write");
    click(&mut harness, "Replace");
    settle(&mut harness);
    harness.get_by_label_contains("which the site is read from");
    menu(&mut harness, "Save as…");
    answer(&mut harness, &model, "Write");
    click(&mut harness, "Replace");
    settle(&mut harness);
    harness.get_by_label_contains("which the site is read from");
    assert!(before == std::fs::read(&model).unwrap());
    // a folder in which one of the files is the site's own
    std::fs::rename(&model, folder.path().join("profile.png")).unwrap();
    let text = std::fs::read_to_string(&site).unwrap().replace("works.glb", "profile.png");
    std::fs::write(&site, text).unwrap();
    let mut harness = window(Some(&site));
    click(&mut harness, "Find the hours");
    settle(&mut harness);
    menu(&mut harness, "Export the hours…");
    answer(&mut harness, folder.path(), "Write");
    click(&mut harness, "Replace");
    settle(&mut harness);
    harness.get_by_label_contains("which the site is read from");
    assert!(before == std::fs::read(folder.path().join("profile.png")).unwrap());
    assert!(!folder.path().join("shadow-hours.tif").exists());

    // nor where a study works
    let out = folder.path().join("out");
    let locked = gnomon::deliver::disk::workplace::Workplace::take([out.as_path()], &[], "somebody's study").unwrap();
    for entry in ["Export the hours…", "Export the animation…"] {
        menu(&mut harness, entry);
        answer(&mut harness, &out, "Write");
        harness.get_by_label_contains("another study is working there");
        harness.get_by_label_contains("somebody's study");
    }
    assert_eq!(out.read_dir().unwrap().count(), 1, "the lock alone");
    drop(locked);
    menu(&mut harness, "Export the hours…");
    answer(&mut harness, &out, "Write");
    assert!(out.join("profile.png").exists() && !out.join(".gnomon.lock").exists());
}

/// Cancelled hours are kept: the same study continues from there later.
#[test]
fn hours_that_are_cancelled_are_kept() {
    are_kept(false);
}

#[test]
fn facades_that_are_cancelled_are_kept() {
    are_kept(true);
}

fn are_kept(on_facades: bool) {
    let (folder, site) = small_site();
    let studies = folder.path().join("studies");
    let there = studies.clone();
    let mut harness = Harness::<App>::builder()
        .with_size(egui::vec2(1280.0, 720.0))
        .wgpu_setup(gnomon::desktop::setup())
        .build_eframe(move |cc| App::new(cc, Some(&site)).expect("an adapter").keeping_studies_in(&there));
    settle(&mut harness);
    write(&mut harness, "step", "1s");
    settle(&mut harness);
    if on_facades {
        click(&mut harness, "On façades, too");
    }
    click(&mut harness, "Find the hours");
    let begun = Instant::now();
    let drawn = instants_drawn(&mut harness);
    click(&mut harness, "Cancel the hours");
    let is_kept = || {
        let entries = studies.read_dir().into_iter().flatten().flatten();
        let names: Vec<_> = entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
        names.iter().any(|name| name.starts_with("profile.")) && !names.iter().any(|name| name == ".gnomon.lock")
    };
    while !is_kept() {
        std::thread::sleep(Duration::from_millis(10));
        assert!(begun.elapsed() < Duration::from_secs(40), "nothing was kept");
    }
    settle(&mut harness);
    click(&mut harness, "Find the hours");
    let first = instants_drawn(&mut harness);
    assert!(first >= drawn, "it begins at {first}, and {drawn} were drawn before");
    click(&mut harness, "Cancel the hours");
}

/// The first number of drawn instants that the window shows.
fn instants_drawn(harness: &mut Harness<'_, App>) -> usize {
    let begun = Instant::now();
    loop {
        harness.step();
        let label =
            harness.query_by_label_contains(" of 28801 instants").and_then(|node| node.accesskit_node().label());
        let words = label.iter().flat_map(|label| label.split_whitespace());
        if let Some(number) = words.filter_map(|word| word.parse().ok()).find(|number| *number > 0) {
            return number;
        }
        assert!(begun.elapsed() < Duration::from_secs(20), "no instant was drawn");
    }
}

#[test]
fn hours_can_be_cancelled() {
    let (_folder, site) = small_site();
    let mut harness = window(Some(&site));
    write(&mut harness, "step", "1s");
    settle(&mut harness);
    click(&mut harness, "Find the hours");
    assert!(!harness.state().is_settled(), "hours are on their way");
    click(&mut harness, "Cancel the hours");
    assert!(harness.query_by_label("Cancel the hours").is_none(), "they are given up at once");
    settle(&mut harness);
    harness.get_by_label("Find the hours");
    assert!(harness.query_by_label("Show the hours").is_none(), "no hours came");
}

#[test]
fn copied_picture_is_the_one_that_is_shown() {
    let (_folder, site) = small_site();
    let mut harness = window(Some(&site));
    let (width, height, pixels) = harness.state().picture().unwrap();
    click(&mut harness, "File");
    harness.get_by_label("Copy the picture").click();
    let mut copied = None;
    for _ in 0..3 {
        harness.step();
        for command in &harness.output().platform_output.commands {
            if let egui::OutputCommand::CopyImage(image) = command {
                copied = Some(image.clone());
            }
        }
    }
    let copied = copied.expect("an image for the clipboard");
    assert_eq!(copied.size, [width as usize, height as usize]);
    assert!(copied.pixels.iter().zip(&pixels).all(|(ours, shown)| ours.to_array() == *shown));
    harness.get_by_label("The picture is on the clipboard");
}

/// The frames and the GIF are the command's, of the plan and before the camera.
#[test]
fn animation_is_that_of_the_command() {
    let (folder, site) = small_site();
    let mut harness = window(Some(&site));
    harness.key_press(Key::Num2);
    harness.step();
    settle(&mut harness);
    menu(&mut harness, "Export the animation…");
    let ours = folder.path().join("window");
    answer(&mut harness, &ours, "Write");
    harness.get_by_label(&format!("Written: {}", ours.join("day.gif").display()));
    let theirs = folder.path().join("command");
    command(&["animate".as_ref(), site.as_ref(), "--out".as_ref(), theirs.as_ref(), "--quiet".as_ref()]);
    let files = |folder: &Path| {
        let mut names: Vec<_> = folder.read_dir().unwrap().map(|entry| entry.unwrap().file_name()).collect();
        names.sort();
        names
    };
    assert_eq!(files(&ours), files(&theirs));
    assert_eq!(files(&ours).len(), 6, "five instants and the GIF of them");
    for name in files(&theirs) {
        let [ours, theirs] = [&ours, &theirs].map(|folder| std::fs::read(folder.join(&name)).unwrap());
        assert!(ours == theirs, "{name:?} is another one");
    }
}

#[test]
fn animation_can_be_cancelled() {
    let (folder, site) = small_site();
    let mut harness = window(Some(&site));
    write(&mut harness, "step", "1min");
    settle(&mut harness);
    menu(&mut harness, "Export the animation…");
    let out = folder.path().join("window");
    name(&mut harness, &out);
    let begun = Instant::now();
    while !out.join("frame-0001.png").exists() {
        harness.step();
        std::thread::sleep(Duration::from_millis(5));
        assert!(begun.elapsed() < Duration::from_secs(60), "no frame came");
    }
    click(&mut harness, "Cancel the export");
    settle(&mut harness);
    assert!(harness.query_by_label("Cancel the export").is_none());
    std::thread::sleep(Duration::from_millis(1500));
    let count = || out.read_dir().unwrap().count();
    let then = count();
    std::thread::sleep(Duration::from_millis(1500));
    assert!(count() == then && then < 200, "frames are drawn on");
    assert!(!out.join("day.gif").exists(), "a GIF of a part of them");
}
