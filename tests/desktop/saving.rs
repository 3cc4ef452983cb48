//! What is saved, and what is asked about what is not.

use super::handing_in::{answer, menu, name};
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

/// Asks the window to close, as a system does; whether it does.
fn closes(harness: &mut Harness<'_, App>) -> bool {
    harness.input_mut().viewports.get_mut(&ViewportId::ROOT).unwrap().events.push(ViewportEvent::Close);
    harness.step();
    !commands(harness).contains(&ViewportCommand::CancelClose)
}

/// What the window asks of the system in this frame.
fn commands(harness: &Harness<'_, App>) -> Vec<ViewportCommand> {
    harness.output().viewport_output[&ViewportId::ROOT].commands.clone()
}

fn is_asked(harness: &Harness<'_, App>, heading: &str) -> bool {
    harness.query_by_label(heading).is_some()
}

const UNSAVED: &str = "Save what was set?";
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

/// What stands in a field that nobody has left yet is saved, too.
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
}

/// What another program has written into the open file since is no more replaced unasked than any other file.
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

/// A bare model has no file yet: where it stands is saved nowhere, and a path is asked for.
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
