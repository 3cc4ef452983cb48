//! A link does not lead out of a model's folder: a file that a model names is read only if it is really inside.

use base64::Engine as _;
use gnomon::formats::{self, Model, ReadOptions};
use std::os::unix::fs::symlink;
use std::path::Path;

/// Reads a model twice: with the file that it names beside it, and with a link there to the same file elsewhere.
fn both(model: (&str, &[u8]), named: (&str, &[u8])) -> [Result<Model, String>; 2] {
    [false, true].map(|is_linked| {
        let folder = tempfile::tempdir().expect("a folder");
        let inside = folder.path().join("in");
        std::fs::create_dir(&inside).expect("a folder");
        std::fs::write(inside.join(model.0), model.1).expect("written");
        let beside = inside.join(named.0);
        if is_linked {
            std::fs::write(folder.path().join("elsewhere"), named.1).expect("written");
            symlink("../elsewhere", beside).expect("a link");
        } else {
            std::fs::write(beside, named.1).expect("written");
        }
        read(&inside.join(model.0))
    })
}

fn read(path: &Path) -> Result<Model, String> {
    formats::read(path, &ReadOptions::default()).map_err(|error| error.to_string())
}

/// A triangle, as the bytes of a buffer.
fn triangle() -> Vec<u8> {
    [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
        .as_flattened()
        .iter()
        .flat_map(|n| n.to_le_bytes())
        .collect()
}

const GLTF: &str = r#"{"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"buffers":[{"uri":"a.bin","byteLength":36}],
    "bufferViews":[{"buffer":0,"byteLength":36}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}]}"#;

#[test]
fn buffers_of_gltf() {
    let [beside, linked] = both(("a.gltf", GLTF.as_bytes()), ("a.bin", &triangle()));
    assert_eq!(beside.expect("read").parts[0].triangles.len(), 1);
    let error = linked.expect_err("refused");
    assert!(error.contains("'a.bin', a link that leads out of the model's folder"), "{error}");
}

#[test]
fn a_link_within_the_folder_is_followed() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("a.gltf"), GLTF).expect("written");
    std::fs::create_dir(folder.path().join("data")).expect("a folder");
    std::fs::write(folder.path().join("data/b.bin"), triangle()).expect("written");
    symlink("data/b.bin", folder.path().join("a.bin")).expect("a link");
    assert!(read(&folder.path().join("a.gltf")).is_ok());
}

#[test]
fn materials_of_obj() {
    let text = b"mtllib a.mtl\nusemtl glass\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let [beside, linked] = both(("a.obj", text), ("a.mtl", b"newmtl glass\nd 0.4\n"));
    let (beside, linked) = (beside.expect("read"), linked.expect("read"));
    assert_eq!((beside.see_through.len(), linked.see_through.len()), (1, 0));
    let note = linked.notes[0].to_string();
    assert!(note.contains("a.mtl, which cannot be read"), "{note}");
}

#[test]
fn sidecars_of_grids() {
    let grid = b"ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2\n3 4\n";
    let [beside, linked] = both(("a.asc", grid), ("a.PRJ", b"EPSG:25832"));
    assert_eq!(beside.expect("read").coordinates, formats::Coordinates::Map("EPSG:25832".into()));
    let error = linked.expect_err("refused");
    assert!(error.contains("has a .prj beside it that is a link that leads out"), "{error}");
}

#[test]
fn contents_of_tiles() {
    let tileset = br#"{"asset":{"version":"1.1"},"geometricError":1,"root":{"boundingVolume":{},"geometricError":0,
        "children":[{"content":{"uri":"a.gltf"}},{"content":{"uri":"b.json"}}]}}"#;
    let inner = br#"{"asset":{"version":"1.1"},"geometricError":1,"root":{"content":{"uri":"a.gltf"}}}"#;
    let embedded = GLTF
        .replace("a.bin", &format!("data:;base64,{}", base64::engine::general_purpose::STANDARD.encode(triangle())));
    let [beside, linked] = both(("tileset.json", tileset), ("a.gltf", embedded.as_bytes()));
    assert_eq!(beside.expect("read").parts.len(), 1);
    let error = linked.expect_err("nothing is left");
    assert!(error.contains("a is a link that leads out of the model's folder"), "{error}");
    // a tileset that is named likewise: b.json is a link, and a.gltf not there
    let [beside, linked] = both(("tileset.json", tileset), ("b.json", inner));
    let [beside, linked] = [beside, linked].map(|read| read.expect_err("no content"));
    assert!(beside.contains("b.json") || beside.contains("a cannot be read"), "{beside}");
    assert_ne!(beside.matches("a cannot be read").count(), linked.matches("a cannot be read").count(), "{linked}");
}
