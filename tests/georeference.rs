//! Where models stand on Earth: by their coordinates, by their anchors, by what the user writes; and the place they
//! suggest.

mod doubts;
mod told;

use crate::shared::said;
use glam::DVec3;
use gnomon::formats::{Anchor, AnchorPoint, Coordinates, Model, ModelError, ReadOptions, Up};
use gnomon::mesh::{Mesh, Part};
use gnomon::site::file::SiteFile;
use gnomon::site::{Models, Overrides, Site, SiteError, WrittenSite};
use std::path::Path;
use tempfile::TempDir;

const STUDY: &str = "[study]\ndate = 2026-06-21\nfrom = \"10:00\"\nto = \"12:00\"\nstep = \"1h\"\n";

/// Where ETRS89 / UTM zone 32N has a point near Karlsruhe, by PROJ 9.5.1, and its longitude and latitude.
const UTM: [f64; 2] = [458874.0, 5438769.0];
const LONG_LAT: [f64; 2] = [8.436593400, 49.100393626];
/// The same point in other systems, and those 20 m east of it on the UTM map and 20 m east and 30 m north.
const GAUSS: [[f64; 2]; 3] = [[3458932.8557, 5440504.9850], [3458952.8638, 5440504.9852], [3458952.8635, 5440534.9972]];
const DEGREES: [[f64; 2]; 3] = [[8.436593400, 49.100393626], [8.436867376, 49.100394963], [8.436864323, 49.100664813]];
const WEB: [[f64; 2]; 3] = [[939157.2813, 6291913.2919], [939187.7802, 6291913.5192], [939187.4403, 6291959.3999]];
/// At 110 m above the ellipsoid.
const EARTH: [[f64; 3]; 3] = [
    [4138797.7568, 613865.7228, 4797959.3042],
    [4138794.7103, 613885.4972, 4797959.4015],
    [4138772.3043, 613881.9484, 4797979.0508],
];

fn folder(site: &str, models: &[&str]) -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("site.toml"), format!("{site}\n{STUDY}")).expect("a site file");
    for model in models {
        std::fs::write(folder.path().join(model), "").expect("a model");
    }
    folder
}

/// A sheet of one triangle.
fn sheet(corners: [DVec3; 3]) -> Model {
    let part =
        Part { name: "sheet".to_owned(), positions: corners.to_vec(), triangles: vec![[0, 1, 2]], ..Part::default() };
    Model { parts: vec![part], up: Up::Z, up_is_said: true, unit_m: Some(1.0), ..Model::default() }
}

/// 20 m to the east and 30 m to the north.
fn drawing() -> Model {
    sheet([DVec3::ZERO, DVec3::new(20.0, 0.0, 0.0), DVec3::new(20.0, 30.0, 0.0)])
}

fn on_map(crs: &str, corners: [[f64; 2]; 3], z: f64) -> Model {
    let corners = corners.map(|[x, y]| DVec3::new(x, y, z));
    // a format that is y up has its heights in z all the same
    Model { coordinates: Coordinates::Map(crs.to_owned()), unit_m: None, up: Up::Y, ..sheet(corners) }
}

fn map_anchor(north_deg: f64) -> Anchor {
    let at = AnchorPoint::Map {
        crs: "EPSG:25832".to_owned(),
        easting: UTM[0],
        northing: UTM[1],
        height: Some(110.0),
        scale: 1.0,
    };
    Anchor { said_by: "IfcMapConversion", at, north_rad: Some(north_deg.to_radians()) }
}

fn site_anchor([longitude_deg, latitude_deg]: [f64; 2], north_deg: Option<f64>) -> Anchor {
    let at = AnchorPoint::Geographic { latitude_deg, longitude_deg, elevation_m: Some(110.0) };
    Anchor { said_by: "IfcSite", at, north_rad: north_deg.map(f64::to_radians) }
}

fn anchored(anchors: Vec<Anchor>) -> Model {
    Model { anchors, ..drawing() }
}

fn load(site: &str, models: &[(&str, Model)]) -> Result<Site, SiteError> {
    let names: Vec<&str> = models.iter().map(|(name, _)| *name).collect();
    let folder = folder(site, &names);
    let read = |path: &Path, _: &ReadOptions| -> Result<Model, ModelError> {
        let named = models.iter().find(|(name, _)| path.ends_with(name));
        Ok(named.expect("a model of the test").1.clone())
    };
    Site::load_with(folder.path(), &Overrides::default(), read)
}

fn one(keys: &str, model: Model) -> Result<Site, SiteError> {
    load(&format!("{PLACE}[[model]]\npath = \"house.glb\"\n{keys}"), &[("house.glb", model)])
}

const PLACE: &str = "[place]\nlatitude = 49.100393626\nlongitude = 8.4365934\nelevation = 100.0\n";

/// The corners of a part, in the world, in the file's order.
fn corners(mesh: &Mesh, component: usize) -> Vec<DVec3> {
    let faces = mesh.components[component].faces.clone();
    faces.flat_map(|face| mesh.corners(face as usize)).map(|corner| mesh.origin + corner.as_dvec3()).collect()
}

#[track_caller]
fn assert_near(found: &[DVec3], wanted: &[DVec3], within: f64) {
    assert_eq!(found.len(), wanted.len());
    for (found, wanted) in found.iter().zip(wanted) {
        assert!(found.distance(*wanted) < within, "{found} is not {wanted}");
    }
}

/// UTM's north is 0.4259° west of true north there, and its metres are 0.99962 of a metre: by closed form.
fn true_drawing() -> [DVec3; 3] {
    let convergence = (-0.425_86_f64).to_radians();
    // k = 0.9996 (1 + ΔE² / 2R²), with the mean radius 6,381 km
    let scale = 0.9996 * (1.0 + 41_126.0_f64.powi(2) / (2.0 * 6_381_000.0_f64.powi(2)));
    [[0.0, 0.0], [20.0, 0.0], [20.0, 30.0]].map(|[east, north]: [f64; 2]| {
        let (sin, cos) = convergence.sin_cos();
        let at = DVec3::new(east * cos + north * sin, north * cos - east * sin, 0.0) / scale;
        at.with_z(10.0)
    })
}

#[test]
fn coordinates_of_any_map_stand_where_they_are() {
    let wanted = true_drawing();
    let utm = [[0.0, 0.0], [20.0, 0.0], [20.0, 30.0]].map(|[east, north]| [UTM[0] + east, UTM[1] + north]);
    for (crs, points) in [("EPSG:25832", utm), ("EPSG:31467", GAUSS), ("OGC:CRS84", DEGREES), ("EPSG:3857", WEB)] {
        let site = one("", on_map(crs, points, 110.0)).expect(crs);
        assert_near(&corners(&site.mesh, 0), &wanted, 0.002);
        assert!(
            said(&site.notes).iter().any(|note| note.contains("as its file says") && note.contains("`crs`")),
            "{:?}",
            site.notes
        );
    }
    let earth = Model { coordinates: Coordinates::Map("EPSG:4978".to_owned()), ..sheet(EARTH.map(DVec3::from_array)) };
    let site = one("", earth).expect("Earth-centred");
    assert_near(&corners(&site.mesh, 0), &wanted, 0.002);
    assert!(said(&site.notes).iter().any(|note| note.contains("above the ellipsoid")), "{:?}", site.notes);
    // the key says what the file does not, or says it otherwise; position moves what stands
    let local = Model { coordinates: Coordinates::Local, up: Up::Z, ..on_map("", GAUSS, 110.0) };
    let site = one("crs = \"EPSG:31467\"\nposition = [1.0, 2.0, -3.0]", local).expect("a crs");
    assert_near(&corners(&site.mesh, 0), &wanted.map(|at| at + DVec3::new(1.0, 2.0, -3.0)), 0.002);
    let site = one("crs = \"EPSG:31467\"", on_map("EPSG:25832", GAUSS, 110.0)).expect("a crs");
    assert_near(&corners(&site.mesh, 0), &wanted, 0.002);
    assert!(said(&site.notes).iter().any(|note| note.contains("25832") && note.contains("31467")), "{:?}", site.notes);
}

/// A terrain of one system and a building of another one meet within 2 cm: also kilometres from the place.
#[test]
fn a_terrain_and_a_building_of_two_grids_meet() {
    let far = "[place]\nlatitude = 49.15\nlongitude = 8.38\nelevation = 100.0\n";
    for place in [PLACE, far] {
        let site = format!("{place}[[model]]\npath = \"terrain.glb\"\n[[model]]\npath = \"house.glb\"\n");
        let utm = [[0.0, 0.0], [20.0, 0.0], [20.0, 30.0]].map(|[east, north]| [UTM[0] + east, UTM[1] + north]);
        let terrain = on_map("EPSG:25832", utm, 110.0);
        for other in
            [on_map("EPSG:31467", GAUSS, 110.0), on_map("EPSG:4326", DEGREES, 110.0), on_map("EPSG:3857", WEB, 110.0)]
        {
            let found = load(&site, &[("terrain.glb", terrain.clone()), ("house.glb", other)]).expect("both");
            assert_near(&corners(&found.mesh, 0), &corners(&found.mesh, 1), 0.02);
        }
        // an anchor of a map, too: the drawing has true metres, of which the map's are 0.4 per mille less
        let house =
            load(&site, &[("terrain.glb", terrain), ("house.glb", anchored(vec![map_anchor(0.0)]))]).expect("both");
        assert_near(&corners(&house.mesh, 0), &corners(&house.mesh, 1), 0.02);
    }
    let two = load(
        &format!("{PLACE}[[model]]\npath = \"a.glb\"\n[[model]]\npath = \"b.glb\"\n"),
        &[
            ("a.glb", on_map("EPSG:25832", [UTM, [UTM[0] + 20.0, UTM[1]], [UTM[0], UTM[1] + 20.0]], 110.0)),
            ("b.glb", on_map("EPSG:31467", GAUSS, 110.0)),
        ],
    );
    let notes = two.expect("both").notes;
    assert!(said(&notes).iter().any(|note| note.contains("their datums differ")), "{notes:?}");
}

/// north = θ − γ: a model drawn along the map's north is turned by the convergence, with its sign.
#[test]
fn an_anchor_turns_by_its_angle_less_the_convergence() {
    let unit = |site: &Site| (corners(&site.mesh, 0)[2] - corners(&site.mesh, 0)[1]).normalize();
    let along = |north_deg: f64| {
        // the file's north lies so far counter-clockwise of true north
        let (sin, cos) = (north_deg.to_radians()).sin_cos();
        DVec3::new(-sin, cos, 0.0)
    };
    for (keys, anchors, north) in [
        ("", vec![map_anchor(0.0)], 0.42586),
        ("", vec![map_anchor(30.0)], 30.42586),
        ("", vec![site_anchor(LONG_LAT, Some(50.0))], 50.0),
        ("", vec![site_anchor(LONG_LAT, None)], 0.0),
        // the place of one, the north of another
        (
            "",
            vec![
                site_anchor(LONG_LAT, None),
                Anchor { said_by: "TrueNorth", at: AnchorPoint::Nowhere, north_rad: Some(0.5) },
            ],
            0.5_f64.to_degrees(),
        ),
        (
            "",
            vec![Anchor { said_by: "TrueNorth", at: AnchorPoint::Nowhere, north_rad: Some(0.5) }],
            0.5_f64.to_degrees(),
        ),
        ("north = 10.0", vec![map_anchor(30.0)], 10.0),
        (
            "crs = \"EPSG:25832\"",
            vec![Anchor {
                at: AnchorPoint::Map {
                    crs: String::new(),
                    easting: UTM[0],
                    northing: UTM[1],
                    height: None,
                    scale: 1.0,
                },
                ..map_anchor(30.0)
            }],
            30.42586,
        ),
    ] {
        let site = one(keys, anchored(anchors.clone())).expect("a model");
        assert!(unit(&site).distance(along(north)) < 1e-5, "{keys} {anchors:?}: {}", unit(&site));
    }
    // a quarter of a turn: the file's north becomes west
    let turned = one("", anchored(vec![site_anchor(LONG_LAT, Some(90.0))])).expect("a model");
    assert_near(
        &corners(&turned.mesh, 0),
        &[DVec3::ZERO, DVec3::Y * 20.0, DVec3::new(-30.0, 20.0, 0.0)].map(|at| at.with_z(10.0)),
        0.001,
    );
}

#[test]
fn what_the_user_wrote_goes_before_the_file() {
    let site = one("position = [100.0, 0.0, 0.0]", anchored(vec![map_anchor(0.0)])).expect("a model");
    assert_near(&corners(&site.mesh, 0)[..1], &[DVec3::X * 100.0], 1e-4);
    assert!(said(&site.notes).iter().any(|note| note.contains("`position` says, 100 m from")), "{:?}", site.notes);
    let site = one("north = 3.0\nposition = [0.0, 0.0, 10.0]", anchored(vec![map_anchor(0.0)])).expect("a model");
    let told = said(&site.notes).concat();
    assert!(told.contains("3.00° by `north`") && told.contains("0.43° by its IfcMapConversion"), "{told}");
    assert!(!told.contains("from where"), "0.6 m are no other place: {told}");
    let near = one("north = 0.45\nposition = [0.0, 0.0, 10.0]", anchored(vec![map_anchor(0.0)])).expect("a model");
    assert!(!said(&near.notes).concat().contains("by `north`"), "{:?}", near.notes);
    // of map coordinates, too: plain metres, as in every other file
    let moved = one(
        "position = [-458874.0, -5438769.0, 0.0]",
        on_map("EPSG:25832", [UTM, [UTM[0] + 20.0, UTM[1]], [UTM[0], UTM[1] + 5.0]], 0.0),
    );
    let moved = moved.expect("moved");
    assert_near(&corners(&moved.mesh, 0), &[DVec3::ZERO, DVec3::X * 20.0, DVec3::Y * 5.0], 1e-4);
    assert!(said(&moved.notes).iter().any(|note| note.contains("taken as metres")), "{:?}", moved.notes);
    for (keys, model, word) in [
        ("north = 1.0\ncrs = \"EPSG:25832\"", on_map("EPSG:25832", [UTM; 3], 0.0), "north"),
        ("position = [0.0, 0.0, 1.0]", on_map("EPSG:4326", DEGREES, 0.0), "position"),
        ("crs = \"EPSG:1\"", drawing(), "crs"),
        ("crs = \"EPSG:25832\"", on_map("EPSG:4326", [[1e9, 2.0]; 3], 0.0), "crs"),
    ] {
        let told = one(keys, model).expect_err(keys).to_string();
        assert!(told.contains(&format!("[[model]] {word}")), "{keys}: {told}");
    }
}

#[test]
fn units_of_maps_are_theirs() {
    // New York's state plane: 300 ft are 91.44 m
    let place = "[place]\nlatitude = 40.7484\nlongitude = -73.9857\nelevation = 0.0\n[[model]]\npath = \"a.glb\"\n";
    let at = DVec3::new(988212.2372, 211939.2786, 0.0);
    let feet = [at, at + DVec3::X * 300.0, at + DVec3::new(0.0, 300.0, 100.0)];
    let long = 300.0 * 1200.0 / 3937.0;
    for (unit_m, coordinates, keys, high) in [
        // a drawing in no unit, and one in the other foot, are in the map's; heights as well
        (None, Coordinates::Local, "crs = \"EPSG:2263\"", 100.0 * 1200.0 / 3937.0),
        (Some(0.3048), Coordinates::Local, "crs = \"EPSG:2263\"", 30.48),
        // a format that says the map has heights in metres, or in the unit that it says, or in the system's
        (None, Coordinates::Map("EPSG:2263".to_owned()), "", 100.0),
        (Some(0.3048), Coordinates::Map("EPSG:2263".to_owned()), "", 30.48),
        (None, Coordinates::Map("EPSG:2263+6360".to_owned()), "", 100.0 * 1200.0 / 3937.0),
    ] {
        let model = Model { unit_m, coordinates, ..sheet(feet) };
        let site = load(&format!("{place}{keys}"), &[("a.glb", model)]).expect(keys);
        let found = corners(&site.mesh, 0);
        assert!((found[0].distance(found[1]) - long).abs() < 0.01, "{keys}: {}", found[0].distance(found[1]));
        assert!((found[2].z - found[0].z - high).abs() < 0.001, "{keys}: {}", found[2].z);
    }
    // millimetres of a UTM map
    let model = Model { unit_m: Some(0.001), ..sheet(true_sheet().map(|at| at * 1000.0)) };
    let site = one("crs = \"EPSG:25832\"", model).expect("millimetres");
    assert_near(&corners(&site.mesh, 0), &true_drawing(), 0.002);
    // an anchor is in metres, also on a map in feet
    let metres = [at.x, at.y].map(|feet| feet * 1200.0 / 3937.0);
    let point = AnchorPoint::Map {
        crs: "EPSG:2263".to_owned(),
        easting: metres[0],
        northing: metres[1],
        height: Some(0.0),
        scale: 1.0,
    };
    let site = load(place, &[("a.glb", anchored(vec![Anchor { at: point, ..map_anchor(0.0) }]))]).expect("New York");
    assert_near(&corners(&site.mesh, 0)[..1], &[DVec3::ZERO], 0.005);
    // a drawing in feet that stands on a map keeps its own size
    let anchor = Anchor {
        at: AnchorPoint::Map {
            crs: "EPSG:25832".to_owned(),
            easting: UTM[0],
            northing: UTM[1],
            height: None,
            scale: 1.0,
        },
        ..map_anchor(0.0)
    };
    let site = one("", Model { unit_m: Some(0.3048), ..anchored(vec![anchor]) }).expect("feet");
    let found = corners(&site.mesh, 0);
    assert!((found[0].distance(found[1]) - 6.096).abs() < 1e-4);
    assert!(
        said(&site.notes).iter().any(|note| note.contains("1 m on the map") && note.contains("0.3048")),
        "{:?}",
        site.notes
    );
}

fn true_sheet() -> [DVec3; 3] {
    [[0.0, 0.0], [20.0, 0.0], [20.0, 30.0]].map(|[east, north]| DVec3::new(UTM[0] + east, UTM[1] + north, 110.0))
}

/// A model that is drawn far from its zero stands on its map, scale and all.
#[test]
fn a_model_far_from_its_zero_is_converted_corner_by_corner() {
    let anchor = Anchor {
        at: AnchorPoint::Map { crs: "EPSG:25832".to_owned(), easting: 0.0, northing: 0.0, height: None, scale: 1.0 },
        ..map_anchor(0.0)
    };
    let site = one("", Model { anchors: vec![anchor], ..sheet(true_sheet()) }).expect("far");
    assert_near(&corners(&site.mesh, 0), &true_drawing(), 0.002);
}

#[test]
fn a_file_proposes_the_place() {
    let site = "[[model]]\npath = \"house.glb\"\n";
    let found = load(site, &[("house.glb", anchored(vec![site_anchor([8.4366, 49.1004], None)]))]).expect("a place");
    assert_eq!(
        (found.place.latitude_deg, found.place.longitude_deg, found.place.elevation_m),
        (49.1004, 8.4366, 110.0)
    );
    assert_eq!(found.place.time_zone.name(), "Europe/Berlin");
    assert!(
        said(&found.notes)[0].starts_with("place from house.glb, IfcSite: 49.1004 N 8.4366 E, 110.00 m"),
        "{:?}",
        found.notes
    );
    assert!(said(&found.notes)[0].contains("[place]"), "{:?}", found.notes);
    assert_near(&corners(&found.mesh, 0), &[DVec3::ZERO, DVec3::X * 20.0, DVec3::new(20.0, 30.0, 0.0)], 1e-3);
    // of a map's coordinates the middle, at the lowest point
    let found = load(site, &[("house.glb", on_map("EPSG:31467", GAUSS, 110.4))]).expect("a place");
    assert!((found.place.latitude_deg - 49.1005).abs() < 2e-4 && found.place.elevation_m == 110.0, "{:?}", found.place);
    // the first that is no program's own
    let boston = anchored(vec![site_anchor([-71.0598, 42.3584], None)]);
    let both = "[[model]]\npath = \"a.glb\"\n[[model]]\npath = \"b.glb\"\n";
    let found = load(both, &[("a.glb", boston.clone()), ("b.glb", anchored(vec![map_anchor(0.0)]))]).expect("a place");
    assert!((found.place.latitude_deg - LONG_LAT[1]).abs() < 1e-6, "{:?}", found.place);
    assert!(
        said(&found.notes).iter().any(|note| note.contains("a.glb") && note.contains("Boston")),
        "{:?}",
        found.notes
    );
    let alone = load(site, &[("house.glb", boston)]).expect("used, and doubted");
    assert!(said(&alone.notes).iter().any(|note| note.contains("Revit")), "{:?}", alone.notes);
}

#[test]
fn a_place_that_is_none_is_not_used() {
    let nothing = anchored(vec![site_anchor([0.0, 0.0], None)]);
    let told =
        load("[[model]]\npath = \"house.glb\"\n", &[("house.glb", nothing.clone())]).expect_err("no place").to_string();
    assert!(told.contains("no [place]"), "{told}");
    let site = one("", nothing).expect("the user's place");
    assert!(said(&site.notes).iter().any(|note| note.contains("0, 0")), "{:?}", site.notes);
    assert_near(&corners(&site.mesh, 0)[..1], &[DVec3::ZERO], 1e-6);
    // without a word of the Earth all is as it was
    let site = one("", drawing()).expect("a drawing");
    assert_eq!(said(&site.notes), [""; 0]);
    assert_near(&corners(&site.mesh, 0), &[DVec3::ZERO, DVec3::X * 20.0, DVec3::new(20.0, 30.0, 0.0)], 1e-6);
}

/// A bare model says its place itself.
#[test]
fn a_bare_model_needs_no_place_where_its_file_has_one() {
    let folder = folder("", &["house.glb"]);
    let path = folder.path().join("house.glb");
    let asked = Overrides {
        date: "2026-06-21".parse().ok(),
        from: "10:00".parse().ok(),
        to: "12:00".parse().ok(),
        step_secs: Some(3600),
        ..Overrides::default()
    };
    let site = Site::load_with(&path, &asked, |_, _| Ok(anchored(vec![map_anchor(0.0)]))).expect("a place");
    assert!((site.place.latitude_deg - LONG_LAT[1]).abs() < 1e-7, "{:?}", site.place);
    let none = Site::load_with(&path, &asked, |_, _| Ok(drawing())).expect_err("no place");
    assert!(matches!(none, SiteError::NoPlaceForModel { .. }) && none.is_wrong_use(), "{none}");
    let zero =
        Site::load_with(&path, &asked, |_, _| Ok(anchored(vec![site_anchor([0.0, 0.0], None)]))).expect_err("no place");
    assert!(zero.to_string().contains("0, 0") && zero.is_wrong_use(), "{zero}");
    let asked = Overrides { place: Some([49.2, 8.4366]), ..asked };
    let site = Site::load_with(&path, &asked, |_, _| Ok(anchored(vec![map_anchor(0.0)]))).expect("the user's");
    assert_eq!(site.place.latitude_deg, 49.2);
    assert!(said(&site.notes).iter().any(|note| note.contains("11.1 km from the place")), "{:?}", site.notes);
    assert!((corners(&site.mesh, 0)[0].y + 11080.0).abs() < 100.0, "{}", corners(&site.mesh, 0)[0]);
}

/// The place given by the user is used; a file far from it is reported, and a map's anchor stays where it is.
#[test]
fn sources_that_disagree_are_both_shown() {
    let two = anchored(vec![map_anchor(0.0), site_anchor([8.5, 49.1004], Some(5.0))]);
    let told = said(&one("", two).expect("both").notes).concat();
    assert!(told.contains("its IfcSite says otherwise: 4.6 km away") && told.contains("turned by 4.57°"), "{told}");
    let alike = anchored(vec![map_anchor(0.0), site_anchor(LONG_LAT, Some(0.45))]);
    assert!(!said(&one("", alike).expect("both").notes).concat().contains("otherwise"));
    let paris = "[place]\nlatitude = 48.8583\nlongitude = 2.2945\n[[model]]\npath = \"house.glb\"\n";
    let site = load(paris, &[("house.glb", anchored(vec![site_anchor(LONG_LAT, Some(50.0))]))]).expect("Paris");
    assert_near(&corners(&site.mesh, 0)[..1], &[DVec3::ZERO], 1e-3);
    assert!(said(&site.notes).concat().contains("stands at the place, though its IfcSite says"), "{:?}", site.notes);
    let site = load(paris, &[("house.glb", anchored(vec![map_anchor(0.0)]))]).expect("Paris");
    assert!(said(&site.notes).iter().any(|note| note.contains("450 km from the place")), "{:?}", site.notes);
    let high = "[place]\nlatitude = 49.100393626\nlongitude = 8.4365934\n[[model]]\npath = \"house.glb\"\n";
    let site = load(high, &[("house.glb", anchored(vec![map_anchor(0.0)]))]).expect("no elevation");
    assert!(said(&site.notes).concat().contains("the elevation of the place, 110"), "{:?}", site.notes);
}

/// The proposed place is written with a word of where it is from, and read back as the user's.
#[test]
fn a_proposed_place_is_written_with_its_source() {
    let folder = folder("# mine\n[[model]]\npath = \"house.glb\" # the house\n", &["house.glb"]);
    let written = WrittenSite::read(folder.path(), &Overrides::default()).expect("a site");
    let read = |_: &Path, _: &ReadOptions| Ok(anchored(vec![map_anchor(0.0)]));
    let models = Models::read(&written, read).expect("models");
    let mut site = written.site.clone();
    site.place = models.proposed_place().cloned();
    let text = site.to_toml_in(&written.text).expect("TOML");
    assert!(text.contains("\n\n# from house.glb, IfcMapConversion\n[place]\n"), "{text}");
    assert!(text.contains("# mine\n") && text.contains("# the house"), "{text}");
    let again = SiteFile::parse("site.toml", &text).expect("it reads");
    assert_eq!(
        again.place.as_ref().map(|place| (place.latitude, place.source.clone())),
        site.place.as_ref().map(|place| (place.latitude, None))
    );
    // of a bare model, and where a person has changed it since
    let bare = site.to_toml_in("").expect("TOML");
    assert!(bare.contains("\n\n# from house.glb, IfcMapConversion\n[place]\n"), "{bare}");
    site.place.as_mut().expect("a place").latitude = Some(50.0);
    assert!(!site.to_toml_in("").expect("TOML").contains("# from"));
    // the same models serve where the place stays, and no other place
    let mut now = WrittenSite { site, ..written.clone() };
    assert!(!models.are_those_of(&now), "they stand elsewhere");
    now.site.place = models.proposed_place().cloned();
    assert!(models.are_those_of(&now) && models.are_those_of(&written));
}

/// What `gnomon check` says of each.
#[test]
fn references_say_unit_axis_place_and_north() {
    let folder = folder("[[model]]\npath = \"house.glb\"\n", &["house.glb"]);
    let written = WrittenSite::read(folder.path(), &Overrides::default()).expect("a site");
    let anchors = vec![map_anchor(30.0), site_anchor(LONG_LAT, None)];
    let models = Models::read(&written, |_, _| Ok(anchored(anchors.clone()))).expect("models");
    let [model] = models.references() else { panic!("one") };
    assert_eq!((model.unit_m, model.unit_is_said, model.up, model.anchors.len()), (1.0, true, Up::Z, 2));
    assert_eq!(model.crs.as_deref(), Some("EPSG:25832 (ETRS89 / UTM zone 32N)"));
    assert_eq!(model.said_by.as_deref(), Some("IfcMapConversion"));
    let convergence = model.convergence_deg.expect("a map");
    assert!((convergence + 0.42586).abs() < 1e-4 && (model.north_deg - 30.0 + convergence).abs() < 1e-4);
    assert_eq!((model.stands, model.stands_by.as_str(), model.meridian_deg), (model.said, "IfcMapConversion", None));
    let at = model.stands.expect("a place").at;
    assert!((at.longitude_deg - LONG_LAT[0]).abs() < 1e-7 && at.height_m == 110.0);
    let models = Models::read(&written, |_, _| Ok(drawing())).expect("models");
    let [model] = models.references() else { panic!("one") };
    assert_eq!((model.crs.as_deref(), model.stands, model.convergence_deg, model.north_deg), (None, None, None, 0.0));
}

/// Footprints have no heights above the sea: the elevation is that of the next model that has one, in any order.
#[test]
fn heights_above_the_ground_say_no_elevation() {
    let footprints = Model { from_ground: vec![true], ..on_map("EPSG:31467", GAUSS, 0.0) };
    let city = on_map("EPSG:31467", GAUSS, 110.4);
    for files in [[("a.glb", footprints.clone()), ("b.glb", city.clone())], [("a.glb", city), ("b.glb", footprints)]] {
        let found = load("[[model]]\npath = \"a.glb\"\n[[model]]\npath = \"b.glb\"\n", &files).expect("a place");
        assert_eq!(found.place.elevation_m, 110.0);
        let low = found.mesh.bounds().expect("triangles").0.z;
        assert!(low.abs() < 0.01, "{low}: all stand on one ground");
    }
}
