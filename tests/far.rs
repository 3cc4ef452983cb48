//! Requests far from the place, usually in map coordinates by mistake, are reported before the study.

use crate::shared::said;
use gnomon::site::{Overrides, Site, load_probes};
use gnomon::study::{self, Event, Wants};
use std::ops::ControlFlow;
use std::path::PathBuf;

/// A house of the works near Vienna, with further lines of a site file.
fn site(lines: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::copy("sites/industry/industry.glb", folder.path().join("works.glb")).expect("a model");
    let site = folder.path().join("site.toml");
    let text = "[place]\nlatitude = 48.2\nlongitude = 16.37\n[[model]]\npath = \"works.glb\"\n[study]\ndate = 2026-03-21\n\
                from = \"11:00\"\nto = \"12:00\"\nstep = \"1h\"\n";
    std::fs::write(&site, format!("{text}{lines}\n")).expect("a site file");
    (folder, site)
}

/// The notes on such a site.
fn notes(lines: &str) -> Vec<String> {
    let (_folder, site) = site(lines);
    said(&Site::load(&site, &Overrides::default()).expect("a site").notes)
}

const REST: &str = "is in map coordinates, write it in metres east and north of the place";

#[test]
fn plan_in_map_coordinates_is_told_before_the_study() {
    assert_eq!(notes(""), [""; 0]);
    // as the map of Austria has them
    let (_folder, path) = site("[plan]\nregion = [625600, 483000, 625900, 483300]\ncell = 10");
    let site = Site::load(&path, &Overrides::default()).expect("a site");
    assert_eq!(site.notes.len(), 1, "{:?}", site.notes);
    let note = &said(&site.notes)[0];
    assert!(note.starts_with("the middle of the plan lies 791 km from the place;"), "{note}");
    assert!(note.contains("if `region` ") && note.ends_with(REST), "{note}");
    let mut heard = Vec::new();
    study::run(&site, &Wants::default(), &mut |event| {
        match event {
            Event::Note(note) => heard.push(note.to_string()),
            Event::Started { .. } => heard.push("begins".to_owned()),
            _ => {}
        }
        ControlFlow::Continue(())
    })
    .expect("a study");
    assert_eq!(heard[0], *note);
    assert_eq!(heard.last().map(String::as_str), Some("begins"));
}

#[test]
fn only_what_is_farther_than_a_town_reaches_is_told() {
    for (km, count) in [(49, 0), (51, 1)] {
        let [west, east] = [km * 1000 - 100, km * 1000 + 100];
        let told = notes(&format!("[plan]\nregion = [{west}, -100, {east}, 100]\ncell = 10"));
        assert_eq!(told.len(), count, "{told:?}");
    }
}

#[test]
fn camera_in_map_coordinates_is_told() {
    let told = notes("[camera]\neye = [1500000, 5200000, 100]\ntarget = [0, 0, 0]");
    assert_eq!(told.len(), 1, "{told:?}");
    assert!(told[0].starts_with("the camera stands 5412 km from the place") && told[0].contains("`eye`"), "{told:?}");
}

#[test]
fn probe_in_map_coordinates_is_told() {
    let near = "[[probe]]\nname = \"kitchen\"\npoint = [10, 10, 2]\n";
    let (_folder, path) = site(&format!("{near}[[probe]]\nname = \"bath\"\npoint = [1500000, 5200000, 2]"));
    let told = said(&load_probes(&path, &Overrides::default()).expect("probes").notes);
    assert_eq!(told.len(), 1, "{told:?}");
    assert!(told[0].starts_with("the probe 'bath' lies 5412 km from the place"), "{told:?}");
    assert!(told[0].contains("`point`") && told[0].ends_with(REST), "{told:?}");
    let (_folder, path) = site(near);
    assert!(load_probes(&path, &Overrides::default()).expect("probes").notes.is_empty());
}

/// Where the models are far away, too, it is they that are in map coordinates.
#[test]
fn models_in_map_coordinates_are_told_alone() {
    let (_folder, path) = site("");
    let text = std::fs::read_to_string(&path).expect("a site file");
    let moved = text.replace("works.glb\"", "works.glb\"\nposition = [625600, 483000, 0]");
    std::fs::write(&path, moved).expect("a site file");
    let told = said(&Site::load(&path, &Overrides::default()).expect("a site").notes);
    assert_eq!(told.len(), 1, "{told:?}");
    assert!(told[0].contains("`position`"), "{told:?}");
}
