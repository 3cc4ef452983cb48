//! `gnomon convert`: the written model equals the one that was read.

use super::ifc::house::house;
use crate::model::Model as Written;
use crate::shared::program::{done, fails, gnomon, site, stderr};
use glam::DVec3;
use gnomon::deliver::Sink;
use gnomon::deliver::conversion::convert;
use gnomon::formats::{self, AnchorPoint, Model, ReadOptions};
use gnomon::message::PlainWords;
use gnomon::site::{LoadedMesh, ModelReference, Overrides, PlacedModel, Placement, load_mesh, load_model};
use serde_json::{Value, json};
use std::fs;
use std::ops::ControlFlow;
use std::path::Path;

fn read(file: &Path) -> Model {
    formats::read(file, &ReadOptions::default()).unwrap()
}

/// Every corner of every triangle, part by part, where it stands.
fn corners(model: &Model) -> Vec<(String, Vec<DVec3>)> {
    let placed = Placement::default().place(model.clone());
    let of = |part: &gnomon::mesh::Part| {
        let corners = part.triangles.iter().flatten().map(|corner| part.positions[*corner as usize]);
        (part.name.clone(), corners.collect())
    };
    placed.parts.iter().map(of).collect()
}

/// The JSON of a GLB.
fn document(bytes: &[u8]) -> Value {
    let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    serde_json::from_slice(&bytes[20..20 + length]).unwrap()
}

#[test]
fn glb_of_a_model_gives_the_same_triangles() {
    let folder = site();
    let told = done(folder.path(), "convert tower.glb out.glb");
    assert!(told.starts_with("out.glb\n1 component, 12 triangles\ntower.glb: glTF"), "{told}");
    let [before, after] = ["tower.glb", "out.glb"].map(|file| corners(&read(&folder.path().join(file))));
    assert_eq!(before, after, "to the bit, near the zero");
    let report: Value = serde_json::from_str(&done(folder.path(), "convert tower.glb out.glb --json")).unwrap();
    assert_eq!((&report["triangles"], &report["model"]["format"]), (&json!(12), &json!("glTF")));
}

#[test]
fn model_far_from_its_zero_keeps_its_corners() {
    let folder = tempfile::tempdir().unwrap();
    let mut model = Written::triangle();
    model.json["nodes"] = json!([{"mesh": 0, "name": "far", "translation": [4_468_503.25, 120.5, -5_333_317.75]}]);
    fs::write(folder.path().join("far.glb"), model.glb()).unwrap();
    done(folder.path(), "convert far.glb out.glb");
    let [before, after] = ["far.glb", "out.glb"].map(|file| corners(&read(&folder.path().join(file))).remove(0));
    assert_eq!(before.0, after.0);
    for (one, other) in before.1.iter().zip(&after.1) {
        assert!(one.distance(*other) < 1e-6, "{one} became {other}");
    }
}

/// Other axes and units become glTF's, and what glTF has no word for stands in `extras`.
#[test]
fn axes_units_and_names_are_brought_along() {
    let folder = site();
    let out = folder.path().join("out.glb");
    let mut placed: PlacedModel = load_model(&folder.path().join("tower.glb"), &Overrides::default()).unwrap();
    let north_rad = Some(50_f64.to_radians());
    let at = AnchorPoint::Geographic { latitude_deg: 49.1, longitude_deg: 8.4, elevation_m: Some(110.0) };
    placed.model.anchors = vec![formats::Anchor { said_by: "IfcSite", at, north_rad }];
    placed.model.kinds = vec![formats::PartKind::GroundCover];
    placed.model.parts[0].aliases = vec!["tower".to_owned(), "Ground floor".to_owned()];
    let written = convert(&placed, &out, &PlainWords, Sink::Memory, &mut |_| ControlFlow::Continue(())).unwrap();
    let document = document(&written.written.files[0].1);
    let ours = json!({"aliases": ["tower", "Ground floor"], "kind": "ground cover"});
    assert_eq!(document["nodes"][0]["extras"]["gnomon"], ours);
    let scene = &document["scenes"][0]["extras"]["gnomon"];
    let north = scene["anchors"][0]["north"].as_f64().unwrap();
    assert!((north - 50.0).abs() < 1e-9, "{scene}");
    assert_eq!((&scene["anchors"][0]["latitude"], &scene["source"]), (&json!(49.1), &json!("tower.glb")));
    assert!(!out.exists(), "in memory");
    // and the reader takes names and kind back
    fs::write(&out, &written.written.files[0].1).unwrap();
    let back = read(&out);
    assert_eq!(back.kind(0), formats::PartKind::GroundCover);
    assert_eq!(back.parts[0].aliases, ["tower", "Ground floor"]);
    // what nobody has said of the tower is not said now
    assert!(back.unit_m.is_none() && !back.up_is_said, "{:?}", back.unit_m);
    // the placement has turned it upright already: −10 m of z are 10 m north
    let told = done(folder.path(), "convert tower.glb turned.glb --up z");
    assert!(told.contains("turned.glb"), "{told}");
    let [as_y, as_z] = ["tower.glb", "turned.glb"].map(|file| corners(&read(&folder.path().join(file))).remove(0).1);
    let upright = |at: &DVec3| DVec3::new(at.x, -at.z, at.y);
    assert_eq!(as_y, as_z.iter().map(upright).collect::<Vec<_>>(), "what was up is north");
}

/// Every triangle where it stands around its place.
fn standing(loaded: &LoadedMesh) -> Vec<[DVec3; 3]> {
    let mesh = &loaded.mesh;
    let corner = |at: u32| mesh.origin + mesh.vertices[at as usize].as_dvec3();
    mesh.faces.iter().map(|face| face.map(corner)).collect()
}

/// Converts a file, and compares the model read from the GLB with the one read from the file; returns the report about
/// the GLB.
#[track_caller]
fn comes_back(name: &str, text: &str) -> (Model, ModelReference) {
    let folder = tempfile::tempdir().unwrap();
    let [file, out] = [name, "out.glb"].map(|name| folder.path().join(name));
    fs::write(&file, text).unwrap();
    done(folder.path(), &format!("convert {name} out.glb"));
    let [before, after] = [&file, &out].map(|file| load_mesh(file, &Overrides::default()).unwrap());
    let [ours, theirs] = [&after, &before].map(standing);
    assert_eq!(ours.len(), theirs.len());
    // welding may begin a triangle at another corner
    let is_one = |one: &[DVec3; 3], other: &[DVec3; 3]| {
        (0..3).any(|turn| (0..3).all(|at| one[at].distance(other[(at + turn) % 3]) < 1e-3))
    };
    for triangle in &theirs {
        assert!(ours.iter().any(|one| is_one(one, triangle)), "{triangle:?} is not among {ours:?}");
    }
    let (was, is) = (&before.references[0], after.references[0].clone());
    let (at, there) = (was.stands.unwrap().at, is.stands.unwrap().at);
    let apart = (at.latitude_deg - there.latitude_deg).abs().max((at.longitude_deg - there.longitude_deg).abs());
    assert!(apart < 1e-8, "{at:?} became {there:?}");
    assert!((was.north_deg - is.north_deg).abs() < 1e-6, "{} became {}", was.north_deg, is.north_deg);
    assert!(is.unit_is_said && is.up_is_said && is.said_by.as_deref() == Some("gnomon"), "{is:?}");
    let [read_before, read_after] = [&file, &out].map(|file| read(file));
    let names =
        |model: &Model| model.parts.iter().map(|part| (part.name.clone(), part.aliases.clone())).collect::<Vec<_>>();
    assert_eq!(names(&read_after), names(&read_before));
    assert_eq!(read_after.kinds, read_before.kinds);
    assert_eq!(read_after.from_ground, read_before.from_ground);
    let glass = |model: &Model| {
        let mut found: Vec<_> = model.see_through.iter().map(|it| (it.material.clone(), it.parts.clone())).collect();
        found.sort();
        found
    };
    assert_eq!(glass(&read_after), glass(&read_before));
    (read_after, is)
}

/// A metre of web Mercator is two thirds of one near Karlsruhe: the file has metres.
#[test]
fn models_on_maps_stand_in_metres_around_their_place() {
    let outline = [[939157.25, 6291913.25], [939187.75, 6291913.25], [939187.75, 6291959.5], [939157.25, 6291913.25]];
    let collection = |corners: Value| {
        json!({
            "type": "FeatureCollection",
            "crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::3857"}},
            "features": [{
                "type": "Feature", "properties": {"height": 12.0, "name": "shed"},
                "geometry": {"type": "Polygon", "coordinates": [corners]},
            }],
        })
    };
    let (model, said) = comes_back("map.geojson", &collection(json!(outline)).to_string());
    assert!(model.stands_on_ground() && !said.stands.unwrap().has_height, "its height is that of any ground");
    let corners = [[8.4365934, 49.1003936], [8.4368674, 49.100395], [8.4368643, 49.1006648], [8.4365934, 49.1003936]];
    let mut degrees = collection(json!(corners));
    degrees.as_object_mut().unwrap().remove("crs");
    comes_back("degrees.geojson", &degrees.to_string());
    let high = outline.map(|[x, y]| [x, y, 110.0]);
    // one of each stands by its own heights
    let mut mixed = collection(json!(outline));
    let mut other = collection(json!(high))["features"][0].take();
    other["properties"]["name"] = json!("hall");
    mixed["features"].as_array_mut().unwrap().push(other);
    let (model, said) = comes_back("mixed.geojson", &mixed.to_string());
    assert_eq!((model.from_ground.clone(), model.stands_on_ground()), (vec![true, false], false));
    assert!((said.stands.unwrap().at.height_m - 110.0).abs() < 1e-9, "that of the hall: {said:?}");
    let (model, said) = comes_back("high.geojson", &collection(json!(high)).to_string());
    let stands = said.stands.unwrap();
    assert!(stands.has_height && (stands.at.height_m - 110.0).abs() < 1e-9, "{said:?}");
    let corners = || model.parts[0].positions.iter();
    let (low, most) =
        corners().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, most), at| (low.min(at.x), most.max(at.x)));
    // 30.5 m of the map are 20 m there
    assert!((most - low - 20.0).abs() < 0.1, "{} m wide", most - low);
}

#[test]
fn local_model_keeps_its_place_north_and_glass() {
    let (model, said) = comes_back("house.ifc", &house(""));
    assert!((said.north_deg - 50.0).abs() < 1e-6 && said.stands.unwrap().has_height, "{said:?}");
    assert_eq!(model.see_through.len(), 1, "the window's glass");
    assert!(model.kinds.contains(&formats::PartKind::GroundCover), "the plot");
}

#[test]
fn site_is_no_model() {
    let folder = site();
    for given in ["site.toml", "."] {
        let words = ["convert reads one model", "name a model file"];
        fails(folder.path(), &format!("convert {given} out.glb"), 2, &words);
    }
}

#[test]
fn inputs_are_not_written_over() {
    let folder = site();
    let before = fs::read(folder.path().join("tower.glb")).unwrap();
    let refused = gnomon(folder.path(), "convert tower.glb tower.glb");
    assert!(!refused.status.success() && stderr(&refused).contains("tower.glb"), "{}", stderr(&refused));
    assert_eq!(fs::read(folder.path().join("tower.glb")).unwrap(), before);
    fails(folder.path(), "convert tower.glb tower.gltf", 2, &["name a .glb file", "tower.gltf"]);
    fails(folder.path(), "convert none.glb out.glb", 1, &["none.glb"]);
}
