//! Files that change on disk while they are open.

use super::comparing::{compared, not_told};
use super::exporting::{answer, command, menu};
use super::*;

/// The window loses the focus, and gets it back.
fn come_back(harness: &mut Harness<'_, App>) {
    for focused in [false, true] {
        harness.input_mut().focused = focused;
        harness.step();
    }
    harness.run_steps(2);
}

/// Exports the drawing of the plan, and returns it.
fn plan(harness: &mut Harness<'_, App>, folder: &Path) -> Vec<u8> {
    let file = folder.join("window.png");
    // else it is asked whether it is to be replaced
    let _ = std::fs::remove_file(&file);
    harness.key_press(Key::Num2);
    harness.step();
    settle(harness);
    menu(harness, "Export the drawing…");
    answer(harness, &file, "Write");
    std::fs::read(file).unwrap()
}

/// The same by the command.
fn plan_by_command(site: &Path, folder: &Path) -> Vec<u8> {
    let file = folder.join("command.png");
    let options = ["--at", "2026-03-21T13:00", "--out"].map(std::ffi::OsStr::new);
    command(&[&["shadow".as_ref(), site.as_os_str()], options.as_slice(), &[file.as_ref()]].concat());
    std::fs::read(file).unwrap()
}

fn replace_model(folder: &Path) {
    std::fs::copy(sample("tower/tower.glb"), folder.join("works.glb")).unwrap();
}

const NOTICE: &str = "works.glb has changed on the disk.";
const STALE: &str = "The request has changed since: find it again.";

/// Picture and exports show the files as they were read, until somebody reloads them.
#[test]
fn changed_model_is_told_and_read_when_asked() {
    let (folder, site) = small_site();
    let mut harness = window(Some(&site));
    write(&mut harness, "step", "4h");
    click(&mut harness, "Find the hours");
    settle(&mut harness);
    let before = plan_by_command(&site, folder.path());
    come_back(&mut harness);
    assert!(harness.query_by_label(NOTICE).is_none(), "nothing has changed");
    replace_model(folder.path());
    harness.run_steps(3);
    assert!(harness.query_by_label(NOTICE).is_none(), "nobody has looked yet");
    come_back(&mut harness);
    harness.get_by_label(NOTICE);
    // also not by a change of what is set
    write(&mut harness, "step", "2h");
    settle(&mut harness);
    assert!(plan(&mut harness, folder.path()) == before, "what is handed in is what is open");
    click(&mut harness, "Find the hours");
    settle(&mut harness);
    write(&mut harness, "step", "1h");
    write(&mut harness, "step", "2h");
    settle(&mut harness);
    assert!(harness.query_by_label(STALE).is_none(), "the hours are those of what is open");
    click(&mut harness, "Reload");
    settle(&mut harness);
    assert!(harness.query_by_label(NOTICE).is_none());
    harness.get_by_label(STALE);
    assert_eq!(harness.state().site_file().study.step.as_deref(), Some("2h"), "what was set stays");
    let after = plan(&mut harness, folder.path());
    assert!(after != before && after == plan_by_command(&site, folder.path()), "what is open is what lies there now");
}

/// A file that was rewritten with the same content changes nothing.
#[test]
fn hours_stay_where_the_model_is_the_same() {
    let (folder, site) = small_site();
    let mut harness = window(Some(&site));
    click(&mut harness, "Find the hours");
    settle(&mut harness);
    std::thread::sleep(Duration::from_millis(20));
    std::fs::copy(sample("industry/industry.glb"), folder.path().join("works.glb")).unwrap();
    come_back(&mut harness);
    harness.get_by_label(NOTICE);
    harness.key_press(Key::F5);
    harness.step();
    settle(&mut harness);
    assert!(harness.query_by_label(STALE).is_none());
    harness.get_by_label("Show the hours");
}

#[test]
fn changed_site_file_is_read_and_undone() {
    let (_folder, site) = small_site();
    let mut harness = window(Some(&site));
    let step = |harness: &Harness<'_, App>| harness.state().site_file().study.step.clone();
    write(&mut harness, "step", "1h");
    settle(&mut harness);
    let text = std::fs::read_to_string(&site).unwrap();
    std::fs::write(&site, text.replace("\"2h\"", "\"4h\"")).unwrap();
    come_back(&mut harness);
    harness.get_by_label_contains("has changed on the disk.");
    harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::R);
    harness.step();
    harness.step();
    click(&mut harness, "Don't save");
    settle(&mut harness);
    assert_eq!(step(&harness).as_deref(), Some("4h"));
    harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::Z);
    harness.step();
    settle(&mut harness);
    assert_eq!(step(&harness).as_deref(), Some("1h"), "what was set in the window comes back");
    // what cannot be read is told, and what is open stays
    std::fs::write(&site, "[[[").unwrap();
    harness.key_press(Key::F5);
    harness.step();
    harness.step();
    click(&mut harness, "Don't save");
    settle(&mut harness);
    harness.get_by_label_contains("the file must be TOML");
    assert_eq!(step(&harness).as_deref(), Some("1h"));
}

/// Where the site file leaves the place to a model's file, reading both again sets it as opening them does.
#[test]
fn place_of_a_models_file_is_set_when_its_site_is_read_again() {
    let folder = tempfile::tempdir().unwrap();
    let corners = [[0.0, 0.0], [20.0, 0.0], [20.0, 20.0], [0.0, 20.0], [0.0, 0.0]];
    let corners = corners.map(|[east, north]| [691_000.0 + east, 5_334_000.0 + north]);
    let model = serde_json::json!({
        "type": "FeatureCollection",
        "crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::25832"}},
        "features": [{
            "type": "Feature",
            "properties": {"name": "House", "building": "yes", "height": 10},
            "geometry": {"type": "Polygon", "coordinates": [corners]},
        }],
    });
    std::fs::write(folder.path().join("house.geojson"), model.to_string()).unwrap();
    let site = folder.path().join("site.toml");
    let text = "[[model]]\npath = \"house.geojson\"\n[study]\ndate = 2026-03-21\nfrom = \"9:00\"\nto = \"17:00\"\n\
                step = \"2h\"\n[plan]\ncell = 2.0\n";
    std::fs::write(&site, text).unwrap();
    let mut harness = window(Some(&site));
    assert!(harness.query_by_label("Where does it stand?").is_none(), "the model says it");
    let place = harness.state().site_file().place.clone().expect("the model's");
    assert!(place.latitude.is_some_and(|latitude| (latitude - 48.13).abs() < 0.05), "{place:?}");
    std::fs::write(&site, text.replace("2h", "4h")).unwrap();
    harness.key_press(Key::F5);
    harness.step();
    settle(&mut harness);
    let set = harness.state().site_file();
    assert_eq!((set.study.step.as_deref(), set.place.as_ref()), (Some("4h"), Some(&place)));
    assert!(!harness.state().is_unsaved(), "a window that has just read it has nothing to save");
    harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::Z);
    harness.step();
    settle(&mut harness);
    let set = harness.state().site_file();
    assert_eq!((set.study.step.as_deref(), set.place.as_ref()), (Some("2h"), Some(&place)), "undo takes one step back");
}

#[test]
fn model_that_cannot_be_read_leaves_the_open_site() {
    let (folder, site) = small_site();
    let mut harness = window(Some(&site));
    std::fs::write(folder.path().join("works.glb"), b"glTF no more").unwrap();
    harness.key_press(Key::F5);
    harness.step();
    settle(&mut harness);
    harness.get_by_label_contains("works.glb");
    assert!(harness.state().picture().is_ok());
    // mended it is read
    replace_model(folder.path());
    let before = harness.state().picture().unwrap().2;
    harness.key_press(Key::F5);
    harness.step();
    settle(&mut harness);
    assert!(harness.state().picture().unwrap().2 != before);
}

/// The state is kept, the model is drawn again elsewhere, and the change is that between the two.
#[test]
fn kept_state_is_what_it_was_when_its_model_changes() {
    let (folder, site) = small_site();
    let mut harness = window(Some(&site));
    click(&mut harness, "Find the hours");
    settle(&mut harness);
    click(&mut harness, "Compare from here");
    replace_model(folder.path());
    harness.key_press(Key::F5);
    harness.step();
    settle(&mut harness);
    click(&mut harness, "Find the change");
    settle(&mut harness);
    std::fs::copy(sample("industry/industry.glb"), folder.path().join("old.glb")).unwrap();
    let text = std::fs::read_to_string(&site).unwrap();
    let old = site.with_file_name("old.toml");
    std::fs::write(&old, text.replace("works.glb", "old.glb")).unwrap();
    // study and plan are those of the open site
    let (pair, outcome) = compared(&old, &site);
    assert_eq!(not_told(&harness, &pair, &outcome), None);
}
