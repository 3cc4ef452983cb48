//! `gnomon convert`: what was read is what is written.

use crate::model::Model as Written;
use crate::shared::program::{done, fails, gnomon, site, stderr};
use glam::DVec3;
use gnomon::deliver::Sink;
use gnomon::deliver::conversion::convert;
use gnomon::formats::{self, AnchorPoint, Model, ReadOptions};
use gnomon::message::PlainWords;
use gnomon::site::{Overrides, PlacedModel, Placement, load_model};
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
    let ours = json!({"aliases": ["Ground floor"], "kind": "ground cover"});
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
    assert!(back.parts[0].aliases.iter().any(|alias| alias == "Ground floor"), "{:?}", back.parts[0].aliases);
    // the placement has turned it upright already: −10 m of z are 10 m north
    let told = done(folder.path(), "convert tower.glb turned.glb --up z");
    assert!(told.contains("turned.glb"), "{told}");
    let [as_y, as_z] = ["tower.glb", "turned.glb"].map(|file| corners(&read(&folder.path().join(file))).remove(0).1);
    let upright = |at: &DVec3| DVec3::new(at.x, -at.z, at.y);
    assert_eq!(as_y, as_z.iter().map(upright).collect::<Vec<_>>(), "what was up is north");
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
