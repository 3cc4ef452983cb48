//! Changes while something else is running, and after it.

use super::exporting::{answer, command, menu};
use super::*;
use gnomon::site::file::Names;
use gnomon::site::{Overrides, Site};

/// The hours are found by the technique that the panel shows, and the saved site gives the command the same.
#[test]
fn hours_are_found_by_the_technique_chosen() {
    let (folder, site) = small_site();
    let mut harness = window(Some(&site));
    click(&mut harness, "Find the hours");
    settle(&mut harness);
    harness.get_by_role_and_label(egui::Role::ComboBox, "Technique").click();
    harness.run_steps(2);
    harness.get_by_label("shadow-map").click();
    harness.step();
    settle(&mut harness);
    harness.get_by_label("The request has changed since: find it again.");
    click(&mut harness, "Find the hours");
    settle(&mut harness);
    menu(&mut harness, "Export the hours…");
    let out = folder.path().join("window");
    answer(&mut harness, &out, "Write");
    menu(&mut harness, "Save as…");
    let saved = folder.path().join("saved.toml");
    answer(&mut harness, &saved, "Write");
    let by_command = folder.path().join("command");
    command(&["profile".as_ref(), saved.as_ref(), "--out".as_ref(), by_command.as_ref(), "--quiet".as_ref()]);
    let [ours, theirs] = [&out, &by_command].map(|folder| std::fs::read(folder.join("shadow-hours.tif")).unwrap());
    assert!(ours == theirs, "the hours are others");
    let report = std::fs::read_to_string(out.join("profile.json")).unwrap();
    assert!(report.contains("\"shadow-map\""), "{report}");
}

/// The ground that was found is shown, can be set and undone, and is saved with the site.
#[test]
fn the_ground_is_set_in_the_panel() {
    let (folder, site) = small_site();
    let text = std::fs::read_to_string(&site).unwrap().replace("[ground]\nlevel = 0.0\n", "");
    std::fs::write(&site, text).unwrap();
    let mut harness = window(Some(&site));
    harness.get_by_label("Ground at 0.00 m, the models' lowest point");
    harness.get_by_role_and_label(egui::Role::SpinButton, "Ground").focus();
    harness.run_steps(2);
    harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::A);
    harness.step();
    harness.event(egui::Event::Text("-1.5".to_owned()));
    harness.step();
    harness.key_press(Key::Enter);
    harness.run_steps(2);
    settle(&mut harness);
    assert_eq!(harness.state().site_file().ground.level, Some(-1.5));
    harness.get_by_label("Ground at −1.50 m; the models begin 1.50 m above it");
    menu(&mut harness, "Save as…");
    let saved = folder.path().join("saved.toml");
    answer(&mut harness, &saved, "Write");
    assert_eq!(Site::load(&saved, &Overrides::default()).unwrap().ground.level, -1.5);
    click(&mut harness, "Find it");
    settle(&mut harness);
    assert_eq!(harness.state().site_file().ground.level, None);
    harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::Z);
    harness.step();
    settle(&mut harness);
    assert_eq!(harness.state().site_file().ground.level, Some(-1.5));
}

/// After the site is saved elsewhere, a state that undo restores still finds its model.
#[test]
fn undo_finds_the_model_of_a_site_saved_elsewhere() {
    let (folder, site) = small_site();
    let mut harness = window(Some(&site));
    write(&mut harness, "step", "4h");
    settle(&mut harness);
    menu(&mut harness, "Save as…");
    answer(&mut harness, &folder.path().join("elsewhere/site.toml"), "Write");
    for _ in 0..3 {
        if harness.state().site_file().study.step.as_deref() != Some("2h") {
            harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::Z);
            harness.step();
            settle(&mut harness);
        }
    }
    assert_eq!(harness.state().site_file().study.step.as_deref(), Some("2h"));
    assert!(harness.query_by_label_contains("there is no file").is_none());
    assert_eq!(harness.state().site_file().model[0].path.as_deref(), folder.path().join("works.glb").to_str());
}

/// Two switches in quick succession both take effect, though the first is still being processed.
#[test]
fn switches_do_not_undo_each_other() {
    let (_folder, site) = small_site();
    let mut harness = window(Some(&site));
    click(&mut harness, "Components");
    let loaded = Site::load(&site, &Overrides::default()).unwrap();
    let names: Vec<&String> = loaded.mesh.components.iter().take(3).map(|component| &component.name).collect();
    // both in one frame, which is before either is read
    for name in &names {
        harness.get_by_label(&format!("{name} casts")).click_accesskit();
    }
    harness.step();
    settle(&mut harness);
    let Names::Some(casts) = harness.state().site_file().model[0].casts.clone() else { panic!("some cast, not all") };
    assert!(names.iter().all(|name| !casts.contains(name)), "{casts:?}");
    assert_eq!(casts.len(), loaded.mesh.components.len() - names.len());
}

/// Hours on façades belong to the model on which they were found, even if it changes in the meantime.
#[test]
fn facades_of_another_model_are_not_laid() {
    let (_folder, site) = small_site();
    let mut harness = window(Some(&site));
    click(&mut harness, "Components");
    let loaded = Site::load(&site, &Overrides::default()).unwrap();
    let name = loaded.mesh.components[0].name.clone();
    click(&mut harness, "On façades, too");
    click(&mut harness, "Find the hours");
    click(&mut harness, &format!("{name} receives"));
    settle(&mut harness);
    assert!(harness.query_by_label("Show the hours").is_none(), "the hours are of other faces");
}

/// Undo takes back the request, but not that its result is shown.
#[test]
fn undo_passes_over_the_hours_that_came() {
    let (_folder, site) = small_site();
    let mut harness = window(Some(&site));
    let undo = |harness: &mut Harness<'_, App>| {
        harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::Z);
        harness.step();
        settle(harness);
    };
    let shown = |harness: &Harness<'_, App>| {
        harness.get_by_label("Show the hours").accesskit_node().toggled() == Some(egui::accesskit::Toggled::True)
    };
    write(&mut harness, "step", "4h");
    settle(&mut harness);
    click(&mut harness, "Find the hours");
    settle(&mut harness);
    assert!(shown(&harness));
    undo(&mut harness);
    assert_eq!(harness.state().site_file().study.step.as_deref(), Some("2h"), "the step is what was set last");
    assert!(shown(&harness), "what is looked at stays");
    harness.get_by_label("The request has changed since: find it again.");
    // nor does ticking it count
    click(&mut harness, "Show the hours");
    assert!(!shown(&harness));
    undo(&mut harness);
    assert!(!shown(&harness));
}

/// A model that may be in millimetres, or lie on its side, is corrected by a button, which can be undone.
#[test]
fn a_unit_and_an_axis_are_mended_by_a_button() {
    let folder = tempfile::tempdir().unwrap();
    let tower = crate::command::units::blocks(&[([-5000.0, -5000.0, 0.0], [5000.0, 5000.0, 30_000.0])]);
    std::fs::write(folder.path().join("tower.glb"), tower.glb()).unwrap();
    let site = folder.path().join("site.toml");
    let text = format!(
        "{}[[model]]\npath = \"tower.glb\"\n[study]\ndate = 2026-09-18\nfrom = \"10:00\"\nto = \"12:00\"\nstep = \"1h\"\n",
        crate::shared::program::PLACE
    );
    std::fs::write(&site, text).unwrap();
    let mut harness = window(Some(&site));
    harness.get_by_label_contains("its unit may be millimetres");
    click(&mut harness, "Set scale = 0.001");
    settle(&mut harness);
    assert_eq!(harness.state().site_file().model[0].scale, Some(0.001));
    assert!(harness.query_by_label_contains("millimetres").is_none());
    click(&mut harness, "Set up = \"z\"");
    settle(&mut harness);
    assert_eq!(harness.state().site_file().model[0].up.as_deref(), Some("z"));
    assert!(harness.query_by_label_contains("on its side").is_none());
    for scale in [Some(0.001), None] {
        harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::Z);
        harness.step();
        settle(&mut harness);
        assert_eq!(
            (harness.state().site_file().model[0].scale, &harness.state().site_file().model[0].up),
            (scale, &None)
        );
    }
    harness.get_by_label_contains("its unit may be millimetres");
}

/// The panel has the scale of a single model; a note on one of several names the site file's key.
#[test]
fn notes_name_no_label_that_is_not_there() {
    let (folder, site) = small_site();
    let tower = crate::command::units::blocks(&[([-5000.0, 0.0, -5000.0], [5000.0, 30_000.0, 5000.0])]);
    std::fs::write(folder.path().join("tower.glb"), tower.glb()).unwrap();
    // its cells would be too many for what is so large
    let text = std::fs::read_to_string(&site).unwrap().replace("[plan]\ncell = 2.0\n", "");
    assert!(!text.contains("[plan]"));
    let alone = folder.path().join("alone.toml");
    std::fs::write(&alone, text.replace("works.glb", "tower.glb")).unwrap();
    window(Some(&alone)).get_by_label_contains("write 0.001 for \"scale\" under Place");
    std::fs::write(&site, text.replace("[study]", "[[model]]\npath = \"tower.glb\"\n[study]")).unwrap();
    let mut harness = window(Some(&site));
    harness.get_by_label_contains("write scale = 0.001 under [[model]]");
    assert!(harness.query_by_label_contains("\"scale\" under Place").is_none());
    click(&mut harness, "Set scale = 0.001 for tower.glb");
    settle(&mut harness);
    assert_eq!(harness.state().site_file().model[1].scale, Some(0.001));
}
