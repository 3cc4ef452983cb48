//! Opening files: what can be opened, and the questions and messages on the way.

use super::*;
use gnomon::site::{Overrides, Site};

#[test]
fn sample_opens_from_the_first_page() {
    let mut harness = window(None);
    assert!(harness.query_by_label("Time of day: 12:00").is_none(), "nothing is open");
    click(&mut harness, "tower");
    settle(&mut harness);
    harness.get_by_label("Champ de Mars, Paris");
    harness.get_by_label("Time of day: 12:00");
    assert_eq!(value(&harness, "Date"), "2026-09-18");
}

#[test]
fn bare_model_asks_for_its_place() {
    let mut harness = window(None);
    drop_file(&mut harness, &sample("industry/industry.glb"));
    harness.get_by_label("Where does it stand?");
    write(&mut harness, "Latitude, longitude", "98, 16.37");
    settle(&mut harness);
    let told = "latitude 98 is not between -90 and 90 degrees";
    assert!(harness.query_by_label_contains("latitude").is_some(), "{told}");
    drop_file(&mut harness, &sample("industry/industry.glb"));
    write(&mut harness, "Latitude, longitude", "48.2, 16.37");
    settle(&mut harness);
    let place = harness.state().site_file().place.clone().expect("a place");
    assert_eq!((place.latitude, place.longitude), (Some(48.2), Some(16.37)));
    harness.get_by_label_contains("Europe/Vienna");
    assert!(harness.state().picture().is_ok());
}

/// The open site stays, and the message is that of the command.
#[test]
fn bad_model_is_told_as_by_the_command() {
    let (folder, site) = small_site();
    let mut harness = window(Some(&site));
    let before = harness.state().site_file().clone();
    let bad = folder.path().join("bad.glb");
    std::fs::write(&bad, b"glTF no more").unwrap();
    let at = "2026-03-21T12:00".parse().ok();
    let asked = Overrides { place: Some([48.2, 16.37]), at, ..Overrides::default() };
    let error = Site::load(&bad, &asked).expect_err("a bad model").to_string();
    drop_file(&mut harness, &bad);
    click(&mut harness, "Open instead");
    settle(&mut harness);
    harness.get_by_label(&error);
    assert_eq!(*harness.state().site_file(), before);
    harness.get_by_label("Works");
    click(&mut harness, "Close");
    assert!(harness.query_by_label(&error).is_none());
}

/// A model dropped on an open site is added to it if the user says so; undo removes it.
#[test]
fn dropped_model_is_added_to_the_open_site() {
    let (folder, site) = small_site();
    let mut harness = window(Some(&site));
    let models = |harness: &Harness<'_, App>| harness.state().site_file().model.len();
    let before = models(&harness);
    let other = folder.path().join("other.glb");
    std::fs::copy(sample("industry/industry.glb"), &other).unwrap();
    drop_file(&mut harness, &other);
    harness.get_by_label_contains("other.glb is a model. Add it to");
    click(&mut harness, "Cancel");
    settle(&mut harness);
    assert_eq!(models(&harness), before);
    drop_file(&mut harness, &other);
    click(&mut harness, "Add to the site");
    settle(&mut harness);
    assert_eq!(models(&harness), before + 1);
    let path = harness.state().site_file().model.last().and_then(|model| model.path.clone());
    assert_eq!(path.as_deref(), Some("other.glb"), "beside the site file it is named from there");
    assert!(
        harness.state().is_unsaved() && harness.state().fault_and_notice()[0].is_none(),
        "{:?}",
        harness.state().fault_and_notice()
    );
}

/// Models that are dropped together with a site are added to it, in whatever order they come; they are not saved yet.
#[test]
fn model_dropped_with_a_site_is_added_to_it() {
    let (folder, site) = small_site();
    let other = folder.path().join("other.glb");
    std::fs::copy(sample("industry/industry.glb"), &other).unwrap();
    let mut harness = window(None);
    let second = sample("tower/site.toml");
    for path in [&other, &site, &second] {
        harness.input_mut().dropped_files.push(std::sync::Arc::new(Dropped(path.clone())));
    }
    harness.step();
    harness.get_by_label_contains("Not opened: tower");
    settle(&mut harness);
    let paths: Vec<_> = harness.state().site_file().model.iter().filter_map(|model| model.path.clone()).collect();
    assert_eq!(paths, ["works.glb", "other.glb"]);
    assert!(
        harness.state().is_unsaved() && harness.state().fault_and_notice()[0].is_none(),
        "{:?}",
        harness.state().fault_and_notice()
    );
}

/// The elevation of a model's file is shown, and saved with a comment on its source.
#[test]
fn elevation_of_a_file_is_saved() {
    let folder = tempfile::tempdir().unwrap();
    let site = folder.path().join("site.toml");
    let land = "<LandXML xmlns=\"http://www.landxml.org/schema/LandXML-1.2\"><Units><Metric linearUnit=\"meter\"/></Units>\
        <CoordinateSystem epsgCode=\"32631\"/><Surfaces><Surface name=\"ground\"><Definition surfType=\"TIN\"><Pnts>\
        <P id=\"1\">5411900 448100 60</P><P id=\"2\">5411900 448400 60</P><P id=\"3\">5412200 448100 65</P></Pnts>\
        <Faces><F>1 2 3</F></Faces></Definition></Surface></Surfaces></LandXML>";
    std::fs::write(folder.path().join("land.xml"), land).unwrap();
    let text = "[place]\nlatitude = 48.8583\nlongitude = 2.2945\n[[model]]\npath = \"land.xml\"\n\
        [study]\ndate = 2026-03-21\nfrom = \"9:00\"\nto = \"17:00\"\nstep = \"4h\"\n[plan]\ncell = 4.0\n";
    std::fs::write(&site, text).unwrap();
    let mut harness = window(Some(&site));
    settle(&mut harness);
    assert_eq!(harness.state().site_file().place.clone().and_then(|place| place.elevation), Some(60.0));
    harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::S);
    harness.step();
    settle(&mut harness);
    let written = std::fs::read_to_string(&site).unwrap();
    assert!(written.contains("elevation = 60.0 # from land.xml, coordinates\n"), "{written}");
}

#[test]
fn loading_can_be_cancelled() {
    let mut harness = window(None);
    let path = sample("headquarters/site.toml");
    harness.input_mut().dropped_files.push(std::sync::Arc::new(Dropped(path)));
    harness.step();
    harness.step();
    harness.get_by_label("Loading headquarters");
    click(&mut harness, "Cancel");
    settle(&mut harness);
    harness.get_by_label("or drop sites and models on this window");
}

#[test]
fn place_changes_and_comes_back() {
    let (_folder, site) = small_site();
    let mut harness = window(Some(&site));
    let latitude = |harness: &Harness<'_, App>| harness.state().site_file().place.clone().unwrap().latitude;
    harness.get_by_label("Latitude").set_value_accesskit(-33.9);
    harness.step();
    settle(&mut harness);
    assert_eq!(latitude(&harness), Some(-33.9));
    harness.get_by_label_contains("Etc/GMT-1");
    harness.key_press_modifiers(egui::Modifiers::COMMAND, Key::Z);
    harness.step();
    settle(&mut harness);
    assert_eq!(latitude(&harness), Some(48.2));
    harness.get_by_label_contains("Europe/Vienna");
    harness.key_press_modifiers(egui::Modifiers::COMMAND | egui::Modifiers::SHIFT, Key::Z);
    harness.step();
    settle(&mut harness);
    assert_eq!(latitude(&harness), Some(-33.9));
}

/// A study of several whole days keeps the keys that it has, and no others are added.
#[test]
fn study_of_several_days_stays_as_it_is() {
    let (_folder, site) = small_site();
    let text = std::fs::read_to_string(&site).unwrap();
    let one_day = "date = 2026-03-21\nfrom = \"9:00\"\nto = \"17:00\"\n";
    assert!(text.contains(one_day));
    std::fs::write(&site, text.replace(one_day, "dates = [2026-03-20, 2026-03-22]\n")).unwrap();
    let harness = window(Some(&site));
    assert_eq!(value(&harness, "Study days"), "2026-03-20");
    let study = harness.state().site_file().study.clone();
    assert!(study.from.is_none() && study.to.is_none() && study.date.is_none(), "{study:?}");
}

/// The note about coordinates far from the place is in the panel before any study.
#[test]
fn plan_in_map_coordinates_is_told_on_opening() {
    let (folder, site) = small_site();
    let text = std::fs::read_to_string(&site).unwrap();
    let far = text.replace("cell = 2.0", "cell = 2.0\nregion = [625600, 483000, 625900, 483300]");
    let far_site = folder.path().join("far.toml");
    std::fs::write(&far_site, far).unwrap();
    let mut harness = window(Some(&far_site));
    harness.get_by_label_contains("the middle of the plan lies 791 km from the place");
    drop_file(&mut harness, &site);
    assert!(harness.query_by_label_contains("the middle of the plan").is_none());
}

/// A note that names a key of the site file names what sets it in the panel.
#[test]
fn notes_have_the_panels_labels() {
    let (folder, site) = small_site();
    let text = std::fs::read_to_string(&site).unwrap();
    let sunk = text.replace("path = \"works.glb\"", "path = \"works.glb\"\nposition = [0.0, 0.0, -2.0]");
    assert!(sunk != text && !text.contains("[ground]"), "{text}");
    let sunk_site = folder.path().join("sunk.toml");
    std::fs::write(&sunk_site, sunk).unwrap();
    let harness = window(Some(&sunk_site));
    harness.get_by_label_contains("\"Ground\" under Place sets it");
}

/// The command's notes about the models are in the panel; without notes it has no such section.
#[test]
fn notes_of_models_stand_in_the_panel() {
    let (folder, site) = small_site();
    let harness = window(Some(&site));
    assert!(harness.query_by_label("Notes").is_none());
    let mut model = crate::model::poses::tower(30.0);
    let option =
        serde_json::json!({"mesh": 0, "name": "option B", "extensions": {"KHR_node_visibility": {"visible": false}}});
    crate::model::push(&mut model.json["nodes"], option);
    std::fs::write(folder.path().join("works.glb"), model.glb()).unwrap();
    let harness = window(Some(&site));
    harness.get_by_label("Notes");
    harness.get_by_label_contains("works.glb has 1 node with a mesh that is hidden (KHR_node_visibility)");
    assert_eq!(harness.state().site_file().model.len(), 1);
}

/// A model that takes long to read: its progress is shown, and once it is cancelled the open site is as it was.
#[cfg(unix)]
#[test]
fn reading_a_dropped_model_can_be_cancelled() {
    let (folder, site) = small_site();
    // a reader that never ends; another process writes it, as none can be started that is still open in this one
    let program = folder.path().join("reader.sh");
    let script = "printf '#!/bin/sh\\nexec sleep 600\\n' > \"$0\" && chmod +x \"$0\"";
    assert!(std::process::Command::new("sh").args(["-c", script]).arg(&program).status().unwrap().success());
    let reading = gnomon::formats::ModelReader { program: Some(program), ..Default::default() };
    let path = site.clone();
    let mut harness = Harness::<App>::builder()
        .with_size(egui::vec2(1280.0, 720.0))
        .wgpu_setup(desktop::setup())
        .build_eframe(move |cc| App::new(cc, Some(&path)).expect("an adapter").reading_by(reading));
    settle(&mut harness);
    let before = harness.state().site_file().clone();
    let picture = harness.state().picture().unwrap();
    let slow = folder.path().join("slow.ifc");
    std::fs::write(
        &slow,
        "ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('IFC4'));\nENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n",
    )
    .unwrap();
    for answer in ["Open instead", "Add to the site"] {
        drop_file(&mut harness, &slow);
        click(&mut harness, answer);
        let begun = Instant::now();
        // how far it is, and for how long it takes
        let lasts = |harness: &Harness<'_, App>| {
            harness.query_by_label_contains("Reading model ").is_some()
                && named(harness, "Reading model ").0.ends_with(" s")
        };
        while !lasts(&harness) {
            harness.step();
            std::thread::sleep(Duration::from_millis(10));
            assert!(begun.elapsed() < Duration::from_secs(60), "{answer}: no progress is shown");
        }
        click(&mut harness, "Cancel");
        assert!(!harness.state().is_loading(), "{answer}");
        settle(&mut harness);
        assert!(harness.query_by_label_contains("Loading").is_none(), "{answer}");
        assert_eq!(harness.state().fault_and_notice(), [None, None], "{answer}");
        harness.get_by_label("Works");
        assert!(harness.state().picture().unwrap() == picture, "{answer}: another picture");
        assert!(*harness.state().site_file() == before && !harness.state().is_unsaved(), "{answer}");
    }
}
