//! Saving, the question about unsaved settings, and the settings offered from windows that have ended.

use super::exporting::{answer, menu, name};
use super::*;
use egui::{ViewportCommand, ViewportEvent, ViewportId};

/// What the title says before the name of the program.
fn title(harness: &Harness<'_, App>) -> String {
    harness.state().title().trim_end_matches(" — Gnomon").to_owned()
}

fn save(harness: &mut Harness<'_, App>) {
    harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::S);
    harness.step();
    settle(harness);
}

/// Asks the window to close, as the system does; returns whether it closes.
fn closes(harness: &mut Harness<'_, App>) -> bool {
    harness.input_mut().viewports.get_mut(&ViewportId::ROOT).unwrap().events.push(ViewportEvent::Close);
    harness.step();
    !commands(harness).contains(&ViewportCommand::CancelClose)
}

/// The window's commands to the system in this frame.
fn commands(harness: &Harness<'_, App>) -> Vec<ViewportCommand> {
    harness.output().viewport_output[&ViewportId::ROOT].commands.clone()
}

fn is_asked(harness: &Harness<'_, App>, heading: &str) -> bool {
    harness.query_by_label(heading).is_some()
}

const UNSAVED: &str = "Save what was set?";
const OFFER: &str = "Restore what was not saved?";
const REPLACE: &str = "Replace what is there?";

/// Beside another state in the same folder, as on the samples.
fn two_states() -> (tempfile::TempDir, PathBuf) {
    let (folder, site) = small_site();
    let without = folder.path().join("without.toml");
    std::fs::copy(&site, &without).unwrap();
    (folder, without)
}

#[test]
fn save_writes_the_file_that_is_open() {
    let (_folder, without) = two_states();
    let site = without.with_file_name("site.toml");
    let [other, before] = [&site, &without].map(|path| std::fs::read_to_string(path).unwrap());
    let mut harness = window(Some(&without));
    assert_eq!(title(&harness), "without.toml");
    write(&mut harness, "step", "4h");
    settle(&mut harness);
    assert_eq!(title(&harness), "• without.toml");
    save(&mut harness);
    assert_eq!(title(&harness), "without.toml");
    harness.get_by_label(&format!("Written: {}", without.display()));
    let written = std::fs::read_to_string(&without).unwrap();
    assert!(before.contains("step = \"2h\"") && written.contains("step = \"4h\""), "{written}");
    assert_eq!(std::fs::read_to_string(&site).unwrap(), other, "the other state is as it was");
    // what undo brings back is not what was saved, and redo is
    for (keys, wanted) in [(egui::Modifiers::COMMAND, "• without.toml"), (REDO, "without.toml")] {
        harness.key_press_modifiers(keys, Key::Z);
        harness.step();
        settle(&mut harness);
        assert_eq!(title(&harness), wanted);
    }
}

const REDO: egui::Modifiers = egui::Modifiers { shift: true, ..egui::Modifiers::COMMAND };

/// The text of a field that still has the focus is saved, too.
#[test]
fn save_takes_what_is_being_typed() {
    let (_folder, site) = small_site();
    let mut harness = window(Some(&site));
    harness.get_by_role_and_label(egui::Role::TextInput, "step").focus();
    harness.step();
    harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::A);
    harness.step();
    harness.event(Event::Text("4h".to_owned()));
    harness.step();
    save(&mut harness);
    assert!(std::fs::read_to_string(&site).unwrap().contains("step = \"4h\""));
    // the same when the window closes over it
    harness.get_by_role_and_label(egui::Role::TextInput, "step").focus();
    harness.step();
    harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::A);
    harness.step();
    harness.event(Event::Text("1h".to_owned()));
    harness.step();
    assert!(!closes(&mut harness));
    harness.step();
    assert!(is_asked(&harness, UNSAVED), "what was typed is not saved");
}

#[test]
fn looking_around_is_nothing_to_save() {
    let (_folder, site) = small_site();
    let mut harness = window(Some(&site));
    let rect = harness.get_by_label("Model").rect();
    drag(&mut harness, rect.left_bottom() + egui::vec2(80.0, -60.0), rect.left_bottom() + egui::vec2(180.0, -90.0));
    harness.key_press(Key::Num6);
    harness.step();
    write(&mut harness, "Clock", "15:30");
    settle(&mut harness);
    assert!(!harness.state().is_unsaved());
    assert_eq!(title(&harness), format!("{}/site.toml", site.parent().unwrap().file_name().unwrap().display()));
    assert!(closes(&mut harness), "nothing is asked");
}

#[test]
fn file_that_is_there_is_not_replaced_without_a_question() {
    let (folder, without) = two_states();
    let site = folder.path().join("site.toml");
    let before = std::fs::read(&site).unwrap();
    let mut harness = window(Some(&without));
    menu(&mut harness, "Save as…");
    name(&mut harness, &site);
    settle(&mut harness);
    assert!(is_asked(&harness, REPLACE));
    harness.get_by_label("site.toml is there already.");
    click(&mut harness, "Cancel");
    // back to the path, which is as it was typed
    assert_eq!(value(&harness, "Path"), site.display().to_string());
    click(&mut harness, "Cancel");
    settle(&mut harness);
    assert_eq!(std::fs::read(&site).unwrap(), before);
    write(&mut harness, "step", "4h");
    menu(&mut harness, "Save as…");
    name(&mut harness, &site);
    click(&mut harness, "Replace");
    settle(&mut harness);
    let written = std::fs::read_to_string(&site).unwrap();
    assert!(written.contains("step = \"4h\""), "{written}{}", harness.state().title());
    // the new file is the open one, though the step was still being read when it was written
    assert_eq!(title(&harness), format!("{}/site.toml", folder.path().file_name().unwrap().display()));
    // a drawing may have the name of a model
    menu(&mut harness, "Export the drawing…");
    name(&mut harness, &folder.path().join("works.glb"));
    settle(&mut harness);
    assert!(is_asked(&harness, REPLACE));
    click(&mut harness, "Cancel");
    click(&mut harness, "Cancel");
    // and a folder the files of another study
    click(&mut harness, "Find the hours");
    settle(&mut harness);
    let out = folder.path().join("out");
    for (entry, file) in [
        ("Export the hours…", "shadow-hours.tif"),
        ("Export the iso-hour lines…", "hours.svg"),
        ("Export the animation…", "day.gif"),
    ] {
        menu(&mut harness, entry);
        answer(&mut harness, &out, "Write");
        let written = std::fs::read(out.join(file)).unwrap_or_else(|error| panic!("{file}: {error}"));
        menu(&mut harness, entry);
        name(&mut harness, &out);
        settle(&mut harness);
        assert!(is_asked(&harness, REPLACE), "{entry}");
        assert!(harness.query_by_label_contains("Files of the same names are replaced.").is_some());
        click(&mut harness, "Cancel");
        click(&mut harness, "Cancel");
        assert!(std::fs::read(out.join(file)).unwrap() == written);
    }
    // one frame is enough, whichever it is
    let frames = folder.path().join("frames");
    std::fs::create_dir(&frames).unwrap();
    std::fs::write(frames.join("frame-0003.png"), "somebody's").unwrap();
    menu(&mut harness, "Export the animation…");
    name(&mut harness, &frames);
    settle(&mut harness);
    assert!(is_asked(&harness, REPLACE));
    harness.get_by_label_contains("frame-0003.png is there already.");
    click(&mut harness, "Cancel");
    click(&mut harness, "Cancel");
    assert_eq!(std::fs::read(frames.join("frame-0003.png")).unwrap(), b"somebody's");
}

/// The action that waits for one question does not run after the save of another.
#[test]
fn what_follows_a_question_goes_with_it() {
    let (_folder, site) = small_site();
    let mut harness = window(Some(&site));
    let theirs = std::fs::read_to_string(&site).unwrap().replace("\"17:00\"", "\"16:00\"");
    std::fs::write(&site, &theirs).unwrap();
    write(&mut harness, "step", "4h");
    settle(&mut harness);
    drop_file(&mut harness, &sample("tower/site.toml"));
    assert!(is_asked(&harness, UNSAVED));
    click(&mut harness, "Save");
    settle(&mut harness);
    assert!(is_asked(&harness, "Replace the file?"));
    // instead of an answer the window is closed, which is thought better of
    assert!(!closes(&mut harness));
    harness.step();
    assert!(is_asked(&harness, UNSAVED));
    click(&mut harness, "Cancel");
    save(&mut harness);
    click(&mut harness, "Replace it");
    settle(&mut harness);
    assert!(std::fs::read_to_string(&site).unwrap().contains("4h"));
    harness.get_by_label("Works");
}

/// Changes that another program made to the open file are not replaced without a question.
#[test]
fn file_that_has_changed_is_not_replaced_without_a_question() {
    let (_folder, site) = small_site();
    let mut harness = window(Some(&site));
    let theirs = std::fs::read_to_string(&site).unwrap().replace("\"17:00\"", "\"16:00\"");
    std::fs::write(&site, &theirs).unwrap();
    write(&mut harness, "step", "4h");
    save(&mut harness);
    assert!(is_asked(&harness, "Replace the file?"));
    click(&mut harness, "Cancel");
    assert_eq!(std::fs::read_to_string(&site).unwrap(), theirs);
    assert!(harness.state().is_unsaved());
    save(&mut harness);
    click(&mut harness, "Replace it");
    settle(&mut harness);
    let written = std::fs::read_to_string(&site).unwrap();
    assert!(written.contains("4h") && written.contains("17:00") && !harness.state().is_unsaved(), "{written}");
}

#[test]
fn closing_asks_about_what_is_not_saved() {
    let (_folder, site) = small_site();
    let mut harness = window(Some(&site));
    let before = std::fs::read(&site).unwrap();
    write(&mut harness, "step", "4h");
    settle(&mut harness);
    assert!(!closes(&mut harness), "it stays open");
    harness.step();
    assert!(is_asked(&harness, UNSAVED));
    harness.get_by_label_contains("Save it before the window closes?");
    click(&mut harness, "Cancel");
    assert!(!is_asked(&harness, UNSAVED) && harness.state().is_unsaved());
    assert!(!closes(&mut harness));
    harness.step();
    harness.get_by_label("Don't save").click_accesskit();
    harness.step();
    assert!(commands(&harness).contains(&ViewportCommand::Close), "the window is told to close");
    assert!(closes(&mut harness), "and does");
    assert_eq!(std::fs::read(&site).unwrap(), before);

    let mut harness = window(Some(&site));
    write(&mut harness, "step", "4h");
    settle(&mut harness);
    assert!(!closes(&mut harness));
    harness.step();
    harness.get_by_label("Save").click_accesskit();
    harness.step();
    assert!(commands(&harness).contains(&ViewportCommand::Close));
    assert!(closes(&mut harness));
    assert!(std::fs::read_to_string(&site).unwrap().contains("step = \"4h\""));
}

#[test]
fn opening_and_reloading_ask_about_what_is_not_saved() {
    let (_folder, site) = small_site();
    let step = |harness: &Harness<'_, App>| harness.state().site_file().study.step.clone().unwrap();
    let mut harness = window(Some(&site));
    write(&mut harness, "step", "4h");
    settle(&mut harness);
    drop_file(&mut harness, &sample("tower/site.toml"));
    assert!(is_asked(&harness, UNSAVED));
    click(&mut harness, "Cancel");
    settle(&mut harness);
    harness.get_by_label("Works");
    assert_eq!(step(&harness), "4h");
    // the file stays as it is: a reload takes nothing of what is set
    harness.key_press(Key::F5);
    harness.step();
    settle(&mut harness);
    assert!(!is_asked(&harness, UNSAVED) && step(&harness) == "4h");
    let theirs = std::fs::read_to_string(&site).unwrap().replace("\"17:00\"", "\"16:00\"");
    std::fs::write(&site, theirs).unwrap();
    harness.key_press(Key::F5);
    harness.step();
    harness.step();
    assert!(is_asked(&harness, UNSAVED));
    click(&mut harness, "Don't save");
    settle(&mut harness);
    assert_eq!(step(&harness), "2h");
    assert!(!harness.state().is_unsaved(), "it is what the file says");
    // what is saved first is what another site then replaces
    write(&mut harness, "step", "1h");
    settle(&mut harness);
    drop_file(&mut harness, &sample("tower/site.toml"));
    click(&mut harness, "Save");
    settle(&mut harness);
    harness.get_by_label("Champ de Mars, Paris");
    assert!(std::fs::read_to_string(&site).unwrap().contains("step = \"1h\""));
}

/// A bare model has no site file yet: its place is not saved anywhere, and the window asks for a path.
#[test]
fn bare_model_is_not_saved_until_it_has_a_file() {
    let (folder, site) = small_site();
    std::fs::remove_file(&site).unwrap();
    let mut harness = window(Some(&folder.path().join("works.glb")));
    write(&mut harness, "Latitude, longitude", "48.2, 16.37");
    settle(&mut harness);
    assert_eq!(title(&harness), "• works.glb");
    assert!(!closes(&mut harness));
    harness.step();
    click(&mut harness, "Save");
    // the dialog proposes a name that is not taken
    let begun = Instant::now();
    while harness.query_by_role_and_label(egui::Role::TextInput, "Path").is_none() {
        harness.step();
        assert!(begun.elapsed() < Duration::from_secs(20), "no dialog came");
    }
    assert_eq!(value(&harness, "Path"), site.display().to_string());
    harness.get_by_label("Write").click_accesskit();
    harness.step();
    harness.step();
    let seen = commands(&harness).contains(&ViewportCommand::Close);
    assert!(seen || closes(&mut harness), "what was asked for goes on");
    assert_eq!(title(&harness), format!("{}/site.toml", folder.path().file_name().unwrap().display()));
    assert!(std::fs::read_to_string(&site).unwrap().contains("latitude = 48.2"));
}

/// A window that stores unsaved settings in this folder, as the real one does in its own.
fn keeping(path: Option<&Path>, folder: &Path) -> Harness<'static, App> {
    let (path, folder) = (path.map(Path::to_owned), folder.to_owned());
    let builder = Harness::<App>::builder().with_size([1280.0, 720.0]).wgpu_setup(desktop::setup());
    let mut harness =
        builder.build_eframe(move |cc| App::new(cc, path.as_deref()).expect("an adapter").recovering_in(&folder));
    settle(&mut harness);
    harness
}

fn kept(folder: &Path) -> usize {
    let Ok(entries) = folder.read_dir() else { return 0 };
    entries.flatten().filter(|entry| entry.path().extension().is_some_and(|is| is == "json")).count()
}

/// Waits until unsaved settings are stored and contain this text.
fn until_kept(harness: &mut Harness<'_, App>, folder: &Path, text: &str) {
    let begun = Instant::now();
    let files = || folder.read_dir().into_iter().flatten().flatten().map(|entry| entry.path());
    let has_text = |path: PathBuf| std::fs::read_to_string(path).is_ok_and(|kept| kept.contains(text));
    while !files().any(has_text) {
        harness.step();
        std::thread::sleep(Duration::from_millis(50));
        assert!(begun.elapsed() < Duration::from_secs(20), "nothing is kept");
    }
}

/// Settings of an open window are not offered; those of a closed one are, until somebody saves or discards them.
#[test]
fn what_was_not_saved_is_offered_again() {
    let (folder, site) = small_site();
    let recovery = folder.path().join("recovery");
    let before = std::fs::read(&site).unwrap();
    let mut first = keeping(Some(&site), &recovery);
    assert_eq!(kept(&recovery), 0, "all is saved");
    // of a window that was killed before it kept anything
    std::fs::create_dir_all(&recovery).unwrap();
    let lock = recovery.join("1-0.lock");
    std::fs::write(&lock, "").unwrap();
    write(&mut first, "step", "4h");
    settle(&mut first);
    until_kept(&mut first, &recovery, "4h");
    let second = keeping(None, &recovery);
    assert!(!is_asked(&second, OFFER), "the first window lives");
    assert!(!lock.exists(), "a lock that nobody holds goes");
    drop(second);
    // it ends without a word
    drop(first);
    let mut second = keeping(None, &recovery);
    assert!(is_asked(&second, OFFER));
    let third = keeping(None, &recovery);
    assert!(!is_asked(&third, OFFER), "the second window offers it");
    drop(third);
    click(&mut second, "Ask me later");
    assert_eq!(kept(&recovery), 1);
    drop(second);
    let mut second = keeping(None, &recovery);
    click(&mut second, "Restore");
    settle(&mut second);
    assert_eq!(second.state().site_file().study.step.as_deref(), Some("4h"));
    assert_eq!(title(&second), format!("• {}/site.toml", folder.path().file_name().unwrap().display()));
    assert_eq!(std::fs::read(&site).unwrap(), before, "nothing is written");
    // it is kept as long as it is not saved, and undo brings back what the file says
    assert_eq!(kept(&recovery), 1);
    second.key_press_modifiers(egui::Modifiers::COMMAND, Key::Z);
    second.step();
    settle(&mut second);
    assert!(!second.state().is_unsaved());
    second.key_press_modifiers(REDO, Key::Z);
    second.step();
    settle(&mut second);
    save(&mut second);
    assert!(std::fs::read_to_string(&site).unwrap().contains("step = \"4h\""));
    assert_eq!(kept(&recovery), 0, "it is saved");
    assert_eq!(recovery.read_dir().unwrap().count(), 0);
    drop(second);
    assert!(!is_asked(&keeping(None, &recovery), OFFER));
}

/// A bare model is restored at its place, and discarded settings are gone.
#[test]
fn bare_model_is_offered_again() {
    let (folder, site) = small_site();
    std::fs::remove_file(&site).unwrap();
    let recovery = folder.path().join("recovery");
    let mut first = keeping(Some(&folder.path().join("works.glb")), &recovery);
    write(&mut first, "Latitude, longitude", "48.2, 16.37");
    settle(&mut first);
    write(&mut first, "to", "16:00");
    settle(&mut first);
    until_kept(&mut first, &recovery, "16:00");
    drop(first);
    let mut second = keeping(None, &recovery);
    second.get_by_label("Gnomon was ended before what was set for works.glb was saved.");
    click(&mut second, "Restore");
    settle(&mut second);
    let site = second.state().site_file().clone();
    let place = site.place.unwrap();
    assert_eq!((place.latitude, place.longitude), (Some(48.2), Some(16.37)));
    assert_eq!(site.study.to.unwrap().0, "16:00");
    assert_eq!(title(&second), "• works.glb");
    drop(second);
    let mut third = keeping(None, &recovery);
    click(&mut third, "Discard");
    assert_eq!(kept(&recovery), 0);
    drop(third);
    assert!(!is_asked(&keeping(None, &recovery), OFFER));
}

/// Settings that the user did not save when the window closed are not offered again.
#[test]
fn what_is_left_at_closing_is_not_offered() {
    let (folder, site) = small_site();
    let recovery = folder.path().join("recovery");
    let mut harness = keeping(Some(&site), &recovery);
    write(&mut harness, "step", "4h");
    settle(&mut harness);
    until_kept(&mut harness, &recovery, "4h");
    assert!(!closes(&mut harness));
    harness.step();
    click(&mut harness, "Don't save");
    assert_eq!(kept(&recovery), 0);
    drop(harness);
    assert!(!is_asked(&keeping(None, &recovery), OFFER));
}

/// If nothing can be stored, the window says so once, and everything else continues.
#[test]
fn what_cannot_be_kept_is_told() {
    let (folder, site) = small_site();
    let mut harness = keeping(Some(&site), &folder.path().join("works.glb"));
    write(&mut harness, "step", "4h");
    let begun = Instant::now();
    while harness.query_by_label_contains("what is not saved cannot be kept against a crash").is_none() {
        harness.step();
        std::thread::sleep(Duration::from_millis(50));
        assert!(begun.elapsed() < Duration::from_secs(20), "nothing is told");
    }
    save(&mut harness);
    assert!(!harness.state().is_unsaved());
}
