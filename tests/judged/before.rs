//! `[before]`: the state with which the site is compared.

use super::{HEAD, fails, fails_in, folder, judged, notes, open, write};
use gnomon::site::{JudgedState, Overrides, Site};

fn casting(state: &JudgedState) -> Vec<&str> {
    let components = state.mesh.components.iter().zip(&state.casts);
    components.filter(|(_, casts)| **casts).map(|(component, _)| component.name.as_str()).collect()
}

#[test]
fn components_stand_before_or_after() {
    let site = judged("[before]\nabsent = \"tower\"\ndemolished = [\"barn\"]\n[[window]]\ncomponent = \"glass\"");
    let before = site.before.as_ref().expect("a state before");
    assert_eq!(casting(&site.now), ["house", "terrace", "tower"]);
    assert_eq!(casting(before), ["house", "terrace", "barn"]);
    assert!(std::sync::Arc::ptr_eq(&site.now.mesh, &before.mesh));
    assert_eq!(site.now.ground, before.ground);
    assert!(notes(&site).contains("1 component is demolished by [before]"), "{}", notes(&site));
    fails("[before]", &["site or absent or demolished in [before]"]);
    fails("[before]\nabsent = [\"towr\"]", &["[before] absent", "\"towr\"", "\"tower\""]);
    fails("[before]\ndemolished = [\"bar\"]", &["[before] demolished", "\"bar\"", "\"barn\""]);
    fails("[before]\nabsent = \"barn\"\ndemolished = \"barn\"", &["[before] absent", "\"barn\"", "demolished, too"]);
    fails("[before]\nsite = \"a.toml\"\nabsent = \"barn\"", &["[before] absent", "`site`"]);
    fails("[before]\nsite = \"a.toml\"", &["[before] site", "a.toml", "no file"]);
}

/// What is demolished shades no other study, either.
#[test]
fn what_is_demolished_casts_in_no_study() {
    let folder = folder("[before]\ndemolished = \"barn\"");
    let text = std::fs::read_to_string(folder.path().join("site.toml")).unwrap();
    let study = text.replace("date = 2026-03-21", "date = 2026-03-21\nfrom = \"9:00\"\nto = \"10:00\"\nstep = \"1h\"");
    write(&folder, "site.toml", &study);
    let site = Site::load(folder.path(), &Overrides::default()).unwrap();
    let barn = site.mesh.components.iter().position(|component| component.name == "barn").unwrap();
    assert!(!site.casts[barn] && !site.receives[barn]);
    assert_eq!(site.casts.iter().filter(|casts| !**casts).count(), 1);
    let told: String = site.notes.iter().map(ToString::to_string).collect();
    assert!(told.contains("demolished by [before]") && told.contains("\"barn\""), "{told}");
}

#[test]
fn another_site_is_the_state_before() {
    let folder = folder("[before]\nsite = \"old.toml\"\n[[window]]\ncomponent = \"glass\"");
    let old = HEAD.replace("up = \"z\"", "up = \"z\"\ncasts = [\"!tower\"]");
    write(&folder, "old.toml", &old);
    let site = open(folder.path());
    let before = site.before.as_ref().expect("a state before");
    // glass that lets the sun through does so in both
    assert_eq!(casting(&site.now), ["house", "terrace", "barn", "tower"]);
    assert_eq!(casting(before), ["house", "terrace", "barn"]);
    // without a place it stands in that of the first
    let models = &old[old.find("[[model]]").unwrap()..];
    write(&folder, "old.toml", models);
    assert!(open(folder.path()).before.is_some());
    write(&folder, "old.toml", &old.replace("latitude = 48.2", "latitude = 48.3"));
    fails_in(folder.path(), &["old.toml", "[place] latitude", "the same place"]);
    write(&folder, "old.toml", &old.replace("elevation = 165.0", ""));
    assert_eq!(open(folder.path()).place.elevation_m, 165.0);
    write(&folder, "old.toml", &old.replace("elevation = 165.0", "elevation = 100.0"));
    fails_in(folder.path(), &["old.toml", "[place] elevation", "the same place"]);
    write(&folder, "old.toml", &old.replace("level = 0.0", "level = 1.0"));
    fails_in(folder.path(), &["old.toml", "[ground] level", "1 m", "the same level"]);
    write(&folder, "old.toml", &old.replace("[ground]\nlevel = 0.0", ""));
    let site = open(folder.path());
    assert_eq!((site.now.ground.level, site.before.unwrap().ground.level), (0.0, 0.0));
    write(&folder, "old.toml", "[[[");
    fails_in(folder.path(), &["old.toml", "line 1"]);
}

/// Where nobody says a height, both stand on the ground of the state before, as in a comparison.
#[test]
fn both_states_have_one_ground() {
    let folder = folder("[before]\nsite = \"old.toml\"");
    let without = HEAD.replace("[ground]\nlevel = 0.0", "");
    let cellar = super::Drawing::default().object("pit").block([0.0, 0.0, -4.0], [9.0, 9.0, -1.0]);
    write(&folder, "pit.obj", &cellar.text);
    write(&folder, "old.toml", &without.replace("town.obj", "pit.obj"));
    write(&folder, "site.toml", &format!("{without}[before]\nsite = \"old.toml\""));
    let site = open(folder.path());
    assert_eq!((site.now.ground.level, site.before.unwrap().ground.level), (-4.0, -4.0));
}
