//! 3D Tiles.

use super::block::{corners, difference, faces, fault_of, left_out, model_at, model_of, written};
use super::files::{b3dm, glb};
use glam::{DMat4, DVec3};
use gnomon::formats::{Coordinates, FORMATS, Model, Up};
use serde_json::{Value, json};
use std::path::Path;

/// The building around zero as glTF: x east, y up, −z north.
pub(super) fn gltf(extension: &str) -> Vec<u8> {
    let corners = corners();
    let mut triangles = Vec::new();
    for (_, ring) in faces() {
        // the floor and roof are cut by hand: from the corner that sees all others
        let fan = match ring.len() {
            6 => ring.iter().position(|corner| corner % 6 == 4).map_or(0, |at| at),
            _ => 0,
        };
        for next in 1..ring.len() - 1 {
            for at in [fan, fan + next, fan + next + 1] {
                let corner = corners[ring[at % ring.len()]];
                triangles.push([corner.x as f32, corner.z as f32, -corner.y as f32]);
            }
        }
    }
    glb(&triangles, extension)
}

/// Where on the Earth the building stands: its axes are turned there.
fn world() -> DMat4 {
    DMat4::from_translation(DVec3::new(3_900_000.0, 300_000.0, 5_020_000.0))
        * DMat4::from_rotation_z(1.2)
        * DMat4::from_rotation_y(0.7)
}

/// The building as a tile has it, brought back.
fn assert_stands(model: &Model, world: DMat4) {
    let mut model = model.clone();
    let back = world.inverse();
    for corner in model.parts.iter_mut().flat_map(|part| &mut part.positions) {
        *corner = (back.transform_point3(*corner) * 1e6).round() / 1e6;
    }
    if let Err(body) = difference(&model, DVec3::ZERO) {
        panic!("this is not the building: {body}");
    }
}

pub(super) fn tileset(root: Value) -> String {
    json!({"asset": {"version": "1.0"}, "geometricError": 100, "root": root}).to_string()
}

fn tile(content: &str) -> Value {
    json!({"boundingVolume": {"box": []}, "geometricError": 0, "content": {"uri": content}})
}

/// Files in a folder, of which the first is read.
pub(super) fn folder_of(files: &[(&str, &[u8])]) -> (tempfile::TempDir, std::path::PathBuf) {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, bytes) in files {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap_or(Path::new(""))).expect("a folder");
        std::fs::write(path, bytes).expect("written");
    }
    let path = folder.path().join(files[0].0);
    (folder, path)
}

pub(super) fn read(files: &[(&str, &[u8])]) -> Model {
    let (_folder, path) = folder_of(files);
    model_at(&path)
}

#[test]
fn transforms_are_applied_column_by_column_to_what_stands_upright() {
    let mut root = tile("a%20b.b3dm");
    root["transform"] = json!(world().to_cols_array());
    let model = read(&[("tileset.json", tileset(root).as_bytes()), ("a b.b3dm", &b3dm(&gltf(""), ""))]);
    assert_stands(&model, world());
    assert_eq!((model.coordinates, model.up), (Coordinates::Map("EPSG:4978".into()), Up::Z));
    assert_eq!((model.left_out, model.notes), (vec![], vec![]));
    assert_eq!(model.parts[0].name, "a b/tower");
}

#[test]
fn centers_are_points_of_the_tile_and_not_turned_with_its_model() {
    let center = DVec3::new(3_900_000.0, 300_000.0, 5_020_000.0);
    let there = DMat4::from_translation(center);
    let table = json!({"BATCH_LENGTH": 0, "RTC_CENTER": center.to_array()}).to_string();
    let alone = model_of("a.b3dm", b3dm(&gltf(""), &table));
    assert_stands(&alone, there);
    assert_eq!(alone.coordinates, Coordinates::Map("EPSG:4978".into()));
    let rtc = format!(
        ",\"extensionsRequired\":[\"CESIUM_RTC\"],\"extensions\":{{\"CESIUM_RTC\":{{\"center\":{:?}}}}}",
        center.to_array()
    );
    assert_stands(&model_of("a.b3dm", b3dm(&gltf(&rtc), "")), there);
    let alone = fault_of("a.glb", gltf(&rtc));
    assert!(alone.contains("CESIUM_RTC"), "a glTF without its tile stands nowhere: {alone}");
    let nowhere = model_of("a.b3dm", b3dm(&gltf(""), ""));
    assert_eq!((nowhere.coordinates, nowhere.notes.len()), (Coordinates::Local, 1));
}

#[test]
fn mirrored_tiles_are_turned_right_side_out() {
    let mirrored = DMat4::from_scale(DVec3::new(-1.0, 1.0, 1.0));
    let mut root = tile("a.glb");
    root["transform"] = json!(mirrored.to_cols_array());
    let model = read(&[("tileset.json", tileset(root).as_bytes()), ("a.glb", &gltf(""))]);
    let volume: f64 = model.parts[0]
        .triangles
        .iter()
        .map(|triangle| {
            let [a, b, c] = triangle.map(|corner| model.parts[0].positions[corner as usize]);
            a.dot(b.cross(c)) / 6.0
        })
        .sum();
    assert!((volume - 3840.0).abs() < 1e-6, "{volume}");
}

#[test]
fn only_the_finest_tiles_stand_there() {
    let (fine, coarse) = (gltf(""), glb(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], ""));
    let root = |refine: &str| {
        let mut root = tile("coarse.glb");
        root["refine"] = json!(refine);
        root["children"] = json!([tile("sub/inner.json")]);
        tileset(root)
    };
    let mut inner = tile("x.glb");
    inner["children"] = json!([tile("fine.glb")]);
    let inner = tileset(inner);
    let files = |text: &str| {
        read(&[
            ("tileset.json", text.as_bytes()),
            ("coarse.glb", &coarse),
            ("sub/inner.json", inner.as_bytes()),
            ("sub/fine.glb", &fine),
        ])
    };
    let model = files(&root("REPLACE"));
    assert_stands(&model, DMat4::IDENTITY);
    assert_eq!(left_out(&model, "tiles"), 2);
    let model = files(&root("ADD"));
    assert_eq!(model.parts.len(), 2, "the coarse one is added to; the inner tileset's x.glb is not in the folder");
    assert_eq!(left_out(&model, "contents"), 1);
}

#[test]
fn nothing_outside_of_the_folder_is_read() {
    let (folder, _) = folder_of(&[("outside.glb", &gltf("")), ("in/a.glb", &gltf(""))]);
    let uris =
        ["../outside.glb", "/etc/hostname", "https://tiles.example/a.glb", "a.glb", "..%2Foutside.glb", "data:x"];
    let mut root = json!({"boundingVolume": {}, "geometricError": 0});
    root["children"] = json!(uris.map(tile));
    let path = folder.path().join("in/tileset.json");
    std::fs::write(&path, tileset(root)).expect("written");
    let model = model_at(&path);
    assert_eq!((model.parts.len(), left_out(&model, "contents")), (1, 5));
    let format = FORMATS.iter().find(|format| format.name() == "3D Tiles").expect("3D Tiles");
    assert_eq!(format.named_by(&path), [folder.path().join("in/a.glb")]);
}

#[test]
fn implicit_tilings_other_contents_and_circles_are_told() {
    let mut implicit = tile("{level}.glb");
    implicit["implicitTiling"] =
        json!({"subdivisionScheme": "QUADTREE", "subtreeLevels": 2, "subtrees": {"uri": "gone/{level}.subtree"}});
    let mut root = json!({"boundingVolume": {}, "geometricError": 0});
    root["children"] = json!([implicit, tile("a.glb"), tile("b.pnts"), tile("tileset.json"), tile("c.b3dm")]);
    let (folder, path) = folder_of(&[
        ("tileset.json", tileset(root).as_bytes()),
        ("a.glb", &gltf("")),
        ("b.pnts", b"pnts...."),
        ("c.b3dm", b"b3dm"),
    ]);
    let model = model_at(&path);
    assert!(left_out(&model, "lists of tiles") >= 1 && left_out(&model, "pnts") >= 1, "{:?}", model.left_out);
    assert!(left_out(&model, "tilesets") >= 1, "it names itself: {:?}", model.left_out);
    assert!(model.notes[0].to_string().contains("c is cut off"), "{:?}", model.notes);
    drop(folder);
    let (_folder, path) = written("tileset.json", tileset(tile("gone.glb")));
    let fault =
        |path: &std::path::Path| gnomon::formats::read(path, &Default::default()).expect_err("nothing").to_string();
    let error = fault(&path);
    assert!(error.contains("copy the whole folder") && error.contains("gone cannot be read"), "{error}");
    let (_folder, path) = written("tileset.json", tileset(tile("tileset.json")));
    assert!(fault(&path).contains("(1 tileset: tilesets are nested too deeply)"), "{}", fault(&path));
    let (_folder, path) = written("tileset.json", tileset(tile("../a.glb")));
    assert!(fault(&path).contains("the address is outside of the tileset's folder"), "{}", fault(&path));
}
