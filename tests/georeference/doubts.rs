//! Messages about georeferences that are probably mistakes, or that are not used.

use super::{
    LONG_LAT, PLACE, STUDY, UTM, anchored, assert_near, corners, drawing, folder, load, map_anchor, on_map, one, sheet,
    site_anchor, true_drawing, true_sheet,
};
use crate::shared::said;
use glam::DVec3;
use gnomon::crs::Crs;
use gnomon::formats::{Anchor, AnchorPoint, Model, ModelError, ReadOptions, Up};
use gnomon::site::{Models, Overrides, Site, WrittenSite, load_mesh};
use std::path::Path;

/// A triangle of PLY, z up.
const PLY: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
     element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n10 0 0\n0 10 5\n3 0 1 2\n";

fn told(site: &Site) -> String {
    said(&site.notes).join("\n")
}

/// An anchor of UTM's zone 32.
fn anchor_at(easting: f64, northing: f64) -> Anchor {
    let at = AnchorPoint::Map { crs: "EPSG:25832".to_owned(), easting, northing, height: None, scale: 1.0 };
    Anchor { at, ..map_anchor(0.0) }
}

#[test]
fn an_anchor_outside_of_its_map_is_told() {
    for [easting, northing] in [[UTM[1], UTM[0]], [15.0, 0.0], [UTM[0] / 1000.0, 12.0]] {
        let place = "[[model]]\npath = \"house.glb\"\n";
        let site = load(place, &[("house.glb", anchored(vec![anchor_at(easting, northing)]))]).expect("a place");
        assert!(told(&site).contains("far outside of that map"), "{easting} {northing}: {}", told(&site));
        // what else the file says is the better word
        let two = anchored(vec![anchor_at(easting, northing), site_anchor(LONG_LAT, Some(0.0))]);
        let site = load(place, &[("house.glb", two)]).expect("a place");
        assert!((site.place.latitude_deg - LONG_LAT[1]).abs() < 1e-6, "{:?}", site.place);
    }
    let site = one("", anchored(vec![map_anchor(0.0)])).expect("inside");
    assert!(!told(&site).contains("outside"), "{}", told(&site));
    // coordinates that the user takes for a map's
    let keys = "[[model]]\npath = \"house.glb\"\ncrs = \"EPSG:25832\"\n";
    let site = load(keys, &[("house.glb", drawing())]).expect("off Africa");
    assert!(told(&site).contains("far outside of that map"), "{}", told(&site));
}

#[test]
fn maps_reach_as_far_as_they_are_used() {
    let far = |crs: &str, x: f64, y: f64| Crs::read(crs).expect(crs).is_far_outside(DVec3::new(x, y, 0.0));
    // all of Norway is mapped in zone 33, Kirkenes 15° beside its meridian; Lisbon; the Scilly Isles; Zürich; Sydney
    for (crs, x, y) in [
        ("EPSG:25833", 1_060_000.0, 7_780_000.0),
        ("EPSG:25832", UTM[0], UTM[1]),
        ("EPSG:3763", -87_000.0, -105_000.0),
        ("EPSG:27700", 90_000.0, 10_000.0),
        ("EPSG:2056", 2_683_000.0, 1_247_000.0),
        ("EPSG:28992", 121_000.0, 487_000.0),
        ("EPSG:5514", -743_000.0, -1_043_000.0),
        ("EPSG:7856", 334_000.0, 6_251_000.0),
        ("EPSG:3857", 0.0, 0.0),
    ] {
        assert!(!far(crs, x, y), "{crs} {x} {y}");
    }
    assert!(far("EPSG:27700", 12.0, 30.0) && far("EPSG:2056", 0.0, 0.0) && far("EPSG:25832", UTM[1], UTM[0]));
    assert!(far("EPSG:3857", 3.0e7, 0.0), "beyond the date line nothing comes back");
}

/// Coordinates of a map without its name.
#[test]
fn coordinates_like_a_maps_ask_for_crs_first() {
    let [east, north] = UTM;
    let far = || sheet([[0.0, 0.0], [20.0, 0.0], [0.0, 20.0]].map(|[x, y]| DVec3::new(east + x, north + y, 0.0)));
    let site = one("", far()).expect("far away");
    let told = told(&site);
    let [crs, position] = ["`crs = ", "`position`"].map(|key| told.find(key));
    assert!(crs.is_some() && crs < position, "{told}");
    // and `gnomon check` of the file alone
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("far.ply");
    std::fs::write(
        &path,
        PLY.replace("0 0 0\n", "458874 5438769 0\n")
            .replace("10 0 0", "458884 5438769 0")
            .replace("0 10 5", "458874 5438779 5"),
    )
    .expect("a model");
    let mesh = load_mesh(&path, &Overrides::default()).expect("a mesh");
    let told = said(&mesh.notes).join("\n");
    assert!(told.contains("from their own zero") && told.contains("`crs = "), "{told}");
}

/// If the place's elevation is not given, it is that of a file, so that its model fits those without heights.
#[test]
fn an_elevation_that_nobody_wrote_is_a_files() {
    let place = "[place]\nlatitude = 49.100393626\nlongitude = 8.4365934\n";
    let models = "[[model]]\npath = \"plain.glb\"\n[[model]]\npath = \"house.glb\"\n";
    let both = [("plain.glb", drawing()), ("house.glb", anchored(vec![map_anchor(0.0)]))];
    let site = load(&format!("{place}{models}"), &both).expect("both");
    assert_eq!(site.place.elevation_m, 110.0);
    for component in [0, 1] {
        assert!(corners(&site.mesh, component).iter().all(|corner| corner.z.abs() < 0.01), "{component}");
    }
    assert!(told(&site).contains("house.glb gives the elevation of the place, 110"), "{}", told(&site));
    // what is written counts
    let site = load(&format!("{place}elevation = 0.0\n{models}"), &both).expect("written");
    assert_eq!((site.place.elevation_m, corners(&site.mesh, 1)[0].z.round()), (0.0, 110.0));
    assert!(!told(&site).contains("the elevation of the place"), "{}", told(&site));
}

/// Without a site file no key is named; with several models the wrong one is named.
#[test]
fn of_bare_models_the_one_at_fault_is_named() {
    let folder = folder("", &["near.glb", "far.glb"]);
    let [near, far] = ["near.glb", "far.glb"].map(|name| folder.path().join(name));
    let asked = Overrides { beside: vec![far.clone()], ..Overrides::default() };
    let written = WrittenSite::read(&near, &asked).expect("two models");
    let sydney = AnchorPoint::Map {
        crs: "EPSG:7856".to_owned(),
        easting: 334_000.0,
        northing: 6_251_000.0,
        height: None,
        scale: 1.0,
    };
    let there = anchored(vec![Anchor { at: sydney, ..map_anchor(0.0) }]);
    let read = |path: &Path, _: &ReadOptions| -> Result<Model, ModelError> {
        Ok(if path.ends_with("far.glb") { there.clone() } else { anchored(vec![map_anchor(0.0)]) })
    };
    let told = Models::read(&written, read).expect_err("on the other side of the Earth").to_string();
    assert!(told.starts_with(&format!("{}: by its IfcMapConversion", far.display())), "{told}");
    assert!(told.contains("write `position = [0.0, 0.0, 0.0]` under [[model]] in a site file"), "{told}");
}

/// Two houses beside the meridian of 180°, some 20 m to its west and to its east.
#[test]
fn what_lies_across_180_degrees_stands_together() {
    let house = |west: f64| [[west, -17.0], [west + 0.0001, -17.0], [west, -16.9999]];
    let corners = [house(179.9998), house(-179.9999)].concat();
    let positions = corners.iter().map(|[x, y]| DVec3::new(*x, *y, 5.0)).collect();
    let mut model = on_map("OGC:CRS84", [[0.0; 2]; 3], 0.0);
    (model.parts[0].positions, model.parts[0].triangles) = (positions, vec![[0, 1, 2], [3, 4, 5]]);
    let keys = "[[model]]\npath = \"house.glb\"\n";
    for place in ["", "[place]\nlatitude = -17.0\nlongitude = 179.99\n"] {
        let folder = folder(&format!("{place}{keys}"), &["house.glb"]);
        let written = WrittenSite::read(folder.path(), &Overrides::default()).expect("a site");
        let models = Models::read(&written, |_, _| Ok(model.clone())).expect("models");
        let at = models.references()[0].stands.expect("a place").at;
        assert!(at.longitude_deg.abs() > 179.9998 && (at.latitude_deg + 17.0).abs() < 0.001, "{place}: {at:?}");
    }
    let site = load(keys, &[("house.glb", model)]).expect("a place");
    let (low, high) = site.mesh.bounds().expect("triangles");
    assert!((high.x - low.x) < 45.0, "{low} {high}");
}

/// A file's point on a map in feet, without its unit.
#[test]
fn a_map_in_another_unit_than_is_assumed_is_told() {
    let at = |crs: &str, easting: f64, northing: f64| {
        let at = AnchorPoint::Map { crs: crs.to_owned(), easting, northing, height: None, scale: 1.0 };
        vec![Anchor { at, ..map_anchor(0.0) }]
    };
    let note = |anchors: Vec<Anchor>, assumed_map_unit_m: Option<f64>| {
        let house = Model { assumed_map_unit_m, ..anchored(anchors) };
        let site = load("[[model]]\npath = \"house.glb\"\n", &[("house.glb", house)]).expect("a place");
        said(&site.notes).into_iter().find(|note| note.contains("MapUnit"))
    };
    let new_york = || at("EPSG:2263", 300_000.0, 60_000.0);
    let told = note(new_york(), Some(1.0)).expect("a note");
    assert!(told.contains("300000, 60000") && told.contains("taken to be 1 m; that of EPSG:2263"), "{told}");
    assert!(told.contains("0.3048006 m"), "{told}");
    // in the map's unit, in a unit that is said, and on a map in metres there is no doubt
    assert_eq!(note(new_york(), Some(0.3048)), None);
    assert_eq!(note(new_york(), None), None);
    assert_eq!(note(at("EPSG:25832", UTM[0], UTM[1]), Some(1.0)), None);
}

/// Where a file says another map of its anchor, the user's counts; a note shows both, and all that names the map says whose
/// word it is.
#[test]
fn a_map_that_contradicts_the_files_is_told() {
    let keys = |crs: &str| format!("[[model]]\npath = \"house.glb\"\ncrs = \"{crs}\"\n");
    let of = |crs: &str| load(&keys(crs), &[("house.glb", anchored(vec![map_anchor(0.0)]))]).expect(crs);
    let site = of("EPSG:25833");
    let told = told(&site);
    for part in [
        "stands in EPSG:25832",
        "says EPSG:25833",
        "km from there",
        "place from house.glb, IfcMapConversion with `crs`",
    ] {
        assert!(told.contains(part), "{part}: {told}");
    }
    assert!(told.contains("stands where its IfcMapConversion with `crs` says in EPSG:25833"), "{told}");
    // zone 33 is 6° farther east
    assert!((site.place.longitude_deg - LONG_LAT[0] - 6.0).abs() < 1e-6, "{:?}", site.place);
    // two systems that have it at one point contradict nothing; neither does the same one
    for one in ["EPSG:25832", "EPSG:32632"] {
        let site = of(one);
        assert!(!said(&site.notes).join("\n").contains("that is taken"), "{one}: {:?}", site.notes);
    }
}

/// A model without a place, beside one whose file has a place, is positioned there by chance.
#[test]
fn a_model_without_a_place_beside_one_that_has_it_is_told() {
    let models = "[[model]]\npath = \"town.glb\"\n[[model]]\npath = \"house.glb\"\n";
    let town = || on_map("EPSG:25832", [UTM, [UTM[0] + 20.0, UTM[1]], [UTM[0], UTM[1] + 30.0]], 0.0);
    let unplaced = |site: &str, town: Model, house: Model| {
        let site = load(site, &[("town.glb", town), ("house.glb", house)]).expect(site);
        said(&site.notes).into_iter().find(|note| note.contains("gives no place"))
    };
    let note = unplaced(models, town(), drawing()).expect("a note");
    let wanted = "house.glb gives no place: its zero stands at the middle of town.glb, with its y to the north";
    assert!(note.starts_with(wanted) && note.contains("`position`") && note.contains("`north`"), "{note}");
    let house = || anchored(vec![map_anchor(0.0)]);
    let note = unplaced(models, house(), Model { up: Up::Y, ..drawing() }).expect("a note");
    assert!(note.contains("the zero of town.glb, with its −z to the north"), "{note}");
    // its file says which way north is, and not where it is
    let north = Anchor { said_by: "TrueNorth", at: AnchorPoint::Nowhere, north_rad: Some(0.5) };
    let note = unplaced(models, town(), anchored(vec![north])).expect("a note");
    assert!(note.contains("the middle of town.glb;") || note.contains("the middle of town.glb:"), "{note}");
    // where somebody has chosen the place, or the model's, nothing is left to chance
    assert_eq!(unplaced(&format!("{PLACE}{models}"), town(), drawing()), None);
    assert_eq!(unplaced(&format!("{models}position = [0.0, 0.0, 0.0]\n"), town(), drawing()), None);
    assert_eq!(unplaced(models, town(), house()), None);
}

/// A map without a name gives no place, but its north is still compared with the other one.
#[test]
fn norths_are_compared_without_the_map() {
    let unnamed = |north_deg: f64| {
        let at = AnchorPoint::Map { crs: String::new(), easting: 5e5, northing: 5e6, height: None, scale: 1.0 };
        anchored(vec![Anchor { at, ..map_anchor(north_deg) }, site_anchor(LONG_LAT, Some(0.0))])
    };
    let site = one("", unnamed(50.0)).expect("50°");
    assert!(told(&site).contains("IfcMapConversion says otherwise, by 50.00°"), "{}", told(&site));
    let site = one("", unnamed(3.0)).expect("3°");
    assert!(!told(&site).contains("otherwise"), "{}", told(&site));
}

#[test]
fn keys_that_contradict_the_file_are_told() {
    let site = one("scale = 0.001\nup = \"y\"\n", drawing()).expect("millimetres");
    assert!(told(&site).contains("has a unit of 0.001 m by `scale`, and of 1 m by its file"), "{}", told(&site));
    assert!(told(&site).contains("has y up by `up`, and z by its file"), "{}", told(&site));
    let site =
        one("scale = 0.001\nup = \"y\"\n", Model { unit_m: None, up_is_said: false, ..drawing() }).expect("unsaid");
    assert!(!told(&site).contains("by its file"), "{}", told(&site));
}

#[test]
fn keys_without_a_use_are_told() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("sheet.ply"), PLY).expect("a model");
    let keys = "scene = 0\nterrain_error = 0.5\ndefault_height = 3.0\n";
    let text = format!("{PLACE}[[model]]\npath = \"sheet.ply\"\n{keys}{STUDY}");
    std::fs::write(folder.path().join("site.toml"), text).expect("a site file");
    let site = Site::load(folder.path(), &Overrides::default()).expect("a site");
    for key in ["scene", "terrain_error", "default_height"] {
        assert!(told(&site).contains(&format!("sheet.ply has no use for `{key}`")), "{key}: {}", told(&site));
    }
}

/// A file whose name says nothing is recognised as a model by its content.
#[test]
fn a_model_without_an_ending_is_a_model() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("noending");
    std::fs::write(&path, PLY).expect("a model");
    assert!(WrittenSite::read(&path, &Overrides::default()).expect("a model").is_bare_model());
    let asked = Overrides { beside: vec![path.clone()], ..Overrides::default() };
    assert_eq!(WrittenSite::read(&path, &asked).expect("two").site.model.len(), 2);
    let mesh = load_mesh(&path, &Overrides::default()).expect("a mesh");
    assert_eq!(mesh.models[0].format, "PLY");
    // a site file stays one
    let path = folder.path().join("site.toml");
    std::fs::write(&path, "[[model]]\npath = \"noending\"\n").expect("a site file");
    assert!(!WrittenSite::read(&path, &Overrides::default()).expect("a site").is_bare_model());
}

/// `scale` says what a unit is, and not that the model leaves its map: the file's own unit changes nothing.
#[test]
fn the_files_own_unit_as_scale_changes_no_corner() {
    for unit_m in [1.0, 0.001] {
        let at =
            AnchorPoint::Map { crs: "EPSG:25832".to_owned(), easting: 0.0, northing: 0.0, height: None, scale: unit_m };
        let model = || {
            let anchors = vec![Anchor { at: at.clone(), ..map_anchor(0.0) }];
            Model { anchors, unit_m: Some(unit_m), ..sheet(true_sheet().map(|corner| corner / unit_m)) }
        };
        let own = one("", model()).expect("its own unit");
        assert_near(&corners(&own.mesh, 0), &true_drawing(), 0.002);
        let said = one(&format!("scale = {unit_m:?}"), model()).expect("the same unit, said");
        assert_eq!(corners(&said.mesh, 0), corners(&own.mesh, 0), "{unit_m}");
    }
}

/// A model that stands far from the others is asked for its reference system only if it has none.
#[test]
fn crs_is_only_proposed_to_a_model_without_one() {
    let at = |east: f64| {
        on_map(
            "EPSG:25832",
            [[0.0, 0.0], [20.0, 0.0], [20.0, 30.0]].map(|[x, y]| [UTM[0] + east + x, UTM[1] + y]),
            110.0,
        )
    };
    let hint = |keys: &str, far: Model| {
        let tables = ["one.glb", "two.glb", "far.glb"].map(|name| format!("[[model]]\npath = \"{name}\"\n"));
        let models = [("one.glb", at(0.0)), ("two.glb", at(30.0)), ("far.glb", far)];
        let site = load(&format!("{PLACE}{}{keys}", tables.concat()), &models).expect("a site");
        let notes = said(&site.notes);
        let note = notes.iter().find(|note| note.contains("from everything else"));
        note.unwrap_or_else(|| panic!("{notes:?}")).clone()
    };
    let placed = hint("", at(100_000.0));
    assert!(!placed.contains("`crs") && placed.contains("`position`"), "{placed}");
    let unplaced = hint("position = [100000.0, 0.0, 0.0]\n", drawing());
    assert!(unplaced.contains("write `crs"), "{unplaced}");
}
