//! `gnomon check`: several files, complete lists, and what other commands say about the same models.

use crate::shared::program::{PLACE, STUDY, done, fails, gnomon, site, stderr};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// A triangle near the place of Paris, in UTM zone 31, at 60 m.
const LAND: &str = r#"<?xml version="1.0"?><LandXML xmlns="http://www.landxml.org/schema/LandXML-1.2" version="1.2">
<Units><Metric linearUnit="meter"/></Units><CoordinateSystem epsgCode="32631"/>
<Surfaces><Surface name="ground"><Definition surfType="TIN"><Pnts><P id="1">5411900 448100 60</P>
<P id="2">5411900 448400 60</P><P id="3">5412200 448100 60</P></Pnts><Faces><F>1 2 3</F></Faces></Definition></Surface>
</Surfaces></LandXML>"#;

const FOOTPRINT: &str = r#"{"type": "Feature", "properties": {"building": "yes"}, "geometry": {"type": "Polygon",
"coordinates": [[[2.29, 48.85], [2.291, 48.85], [2.291, 48.851], [2.29, 48.85]]]}}"#;

fn json(folder: &Path, arguments: &str) -> Value {
    serde_json::from_str(&done(folder, arguments)).expect("JSON")
}

#[test]
fn several_models_are_checked_as_one_site_and_several_sites_one_by_one() {
    let folder = site();
    let models = json(folder.path(), "check tower.glb open.glb --json");
    let names: Vec<_> = models["models"].as_array().unwrap().iter().map(|model| &model["name"]).collect();
    assert_eq!(names, ["tower.glb", "open.glb"]);
    assert_eq!(models["components"].as_array().unwrap().len(), 2);
    fs::copy(folder.path().join("site.toml"), folder.path().join("other.toml")).unwrap();
    let each = json(folder.path(), "check site.toml other.toml open.glb --json");
    let components: Vec<_> = each.as_array().unwrap().iter().map(|one| one["components"][0]["name"].clone()).collect();
    assert_eq!(components.len(), 3);
    let alone = json(folder.path(), "check other.toml --json");
    assert_eq!(each[1], alone, "as it would be alone");
    let table = done(folder.path(), "check site.toml other.toml");
    let once = done(folder.path(), "check site.toml");
    assert_eq!(table, format!("site.toml\n{once}\nother.toml\n{once}"));
    fails(folder.path(), "check tower.glb missing.glb", 1, &["missing.glb: there is no such file"]);
}

#[test]
fn all_names_are_listed_where_that_is_asked() {
    let folder = site();
    let mut text = String::new();
    for number in 0..40 {
        let x = 10 * number;
        text.push_str(&format!("o part-{number}\nv {x} 0 0\nv {} 0 0\nv {x} 5 0\nf -3 -2 -1\n", x + 4));
    }
    fs::write(folder.path().join("parts.obj"), text).unwrap();
    let (cut, whole) = (done(folder.path(), "check parts.obj"), done(folder.path(), "check parts.obj --all"));
    for (name, is_cut) in [("\"part-0\" (1)", false), ("\"part-9\" (1)", true)] {
        assert!(cut.contains(name) != is_cut && whole.contains(name), "{name}: {cut}");
    }
    // a row a part that is not clean, too
    assert!(cut.contains("more; --all lists all") && !whole.contains("more;"), "{whole}");
    let rows = |table: &str| table.lines().filter(|line| line.starts_with("part-")).count();
    assert!(rows(&cut) < 40 && rows(&whole) == 40, "{whole}");
    fails(folder.path(), "check parts.obj --all --json", 2, &["--all", "--json"]);
}

#[test]
fn a_model_without_an_ending_is_converted() {
    let folder = site();
    fs::copy(folder.path().join("tower.glb"), folder.path().join("tower")).unwrap();
    done(folder.path(), "convert tower out.glb");
    assert!(folder.path().join("out.glb").is_file());
    fails(folder.path(), "convert site.toml out.glb", 2, &["site.toml is not a model"]);
}

/// Of a model alone, the option is its own height and that of all: the hint names it once.
#[test]
fn the_hint_on_heights_of_a_model_alone_names_the_option_once() {
    let folder = site();
    let high = FOOTPRINT.replacen("\"yes\"", "\"yes\", \"height\": 9", 1);
    fs::write(folder.path().join("town.geojson"), format!("{high}\n{FOOTPRINT}")).unwrap();
    let report = json(folder.path(), "check town.geojson --json");
    let notes = report["notes"].as_array().expect("notes");
    let hint = notes.iter().filter_map(Value::as_str).find(|note| note.contains("without a height")).expect("a note");
    assert!(hint.ends_with("set --default-height for this one"), "{hint}");
}

#[test]
fn footprints_without_heights_are_told_once() {
    let folder = site();
    fs::write(folder.path().join("town.geojson"), FOOTPRINT).unwrap();
    fails(folder.path(), "check town.geojson", 1, &["but no height of any of them", "--default-height"]);
    let told = stderr(&gnomon(folder.path(), "check town.geojson"));
    assert_eq!(told.matches("has 1 footprint").count(), 1, "{told}");
}

/// The sun is that of studies, also if a model's file has the place's elevation.
#[test]
fn sun_and_studies_have_one_elevation() {
    let folder = site();
    let text = format!("{PLACE}[[model]]\npath = \"land.xml\"\n{STUDY}");
    fs::write(folder.path().join("hill.toml"), &text).unwrap();
    fs::write(folder.path().join("land.xml"), LAND).unwrap();
    let study =
        json(folder.path(), "shadow hill.toml --at 2026-09-18T12:00 --engine cpu --size 20 --mask m.png --json");
    let sun = json(folder.path(), "sun hill.toml --json");
    assert_eq!((&study["place"], &sun["place"]["elevation"]), (&sun["place"], &60.0.into()));
    let told = stderr(&gnomon(folder.path(), "sun hill.toml"));
    assert!(told.contains("land.xml gives the elevation of the place, 60.00 m"), "{told}");
    let place = json(
        folder.path(),
        "sun land.xml --place 48.8583,2.2945 --date 2026-09-18 --from 10:00 --to 12:00 --step 1h --json",
    );
    assert_eq!(place["place"]["elevation"], 60.0, "--place says none either");
    // what cannot be read takes the sun from nobody, and is told
    fs::write(folder.path().join("land.xml"), "<LandXML>").unwrap();
    let told = stderr(&gnomon(folder.path(), "sun hill.toml"));
    assert!(told.contains("elevation of the place is taken as 0") && told.contains("land.xml"), "{told}");
    assert_eq!(json(folder.path(), "sun hill.toml --json")["place"]["elevation"], 0.0);
}

/// A key that leaves parts of a file out, by the names that `gnomon check` lists.
#[test]
fn layers_say_what_is_read() {
    let folder = site();
    let parts = |z: f64, name: &str| format!("o {name}\nv 0 {z} 0\nv 9 {z} 0\nv 0 {z} -9\nf -3 -2 -1\n");
    let text = [("walls", 1.0), ("roof", 5.0), ("chairs", 0.5)].map(|(name, z)| parts(z, name)).concat();
    fs::write(folder.path().join("house.obj"), text).unwrap();
    let site = |layers: &str| {
        let text = format!("{PLACE}[[model]]\npath = \"house.obj\"\nlayers = {layers}\n{STUDY}");
        fs::write(folder.path().join("layers.toml"), text).unwrap();
    };
    let read = |layers: &str| {
        site(layers);
        let report = json(folder.path(), "check layers.toml --json");
        let names: Vec<_> = report["components"].as_array().unwrap().iter().map(|part| part["name"].clone()).collect();
        (names, report["model"]["left_out"].clone())
    };
    let (names, left_out) = read("[\"walls\", \"roof\"]");
    assert_eq!(names, ["walls", "roof"]);
    assert_eq!((&left_out[0]["count"], &left_out[0]["what"]), (&1.into(), &"components".into()));
    assert_eq!(read("[\"!chairs\"]").0, ["walls", "roof"]);
    assert_eq!(
        read("[\"walls\", \"roof\", \"chairs\"]"),
        (["walls", "roof", "chairs"].map(Value::from).to_vec(), Value::Array(vec![]))
    );
    site("[\"chair\"]");
    fails(folder.path(), "check layers.toml", 1, &["[[model]] layers", "\"chair\"", "nearest is \"chairs\""]);
    site("[]");
    fails(folder.path(), "check layers.toml", 1, &["[[model]] layers", "leaves nothing of the model"]);
}
