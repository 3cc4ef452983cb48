//! 3D Tiles with implicit tiling.

use super::block::left_out;
use super::features::batched_file;
use super::files::glb;
use super::mutations::damaged;
use super::tiles::{folder_of, read, tileset};
use crate::formats::mutations::read_within_memory;
use crate::shared::memory::CountedThread;
use gnomon::formats::{FORMATS, Model, ReadOptions};
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::time::{Duration, Instant};

/// A list of tiles: its JSON, and bits behind it.
fn subtree(document: &Value, binary: &[u8]) -> Vec<u8> {
    let text = document.to_string();
    let mut file = b"subt\x01\0\0\0".to_vec();
    file.extend((text.len() as u64).to_le_bytes());
    file.extend((binary.len() as u64).to_le_bytes());
    file.extend(text.as_bytes());
    file.extend(binary);
    file
}

fn triangle() -> Vec<u8> {
    glb(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], "")
}

/// A tree whose contents are called by level and place.
fn tree(scheme: &str, refine: &str, subtree_levels: u32, levels: u32) -> String {
    let contents = if scheme == "OCTREE" { "{level}-{x}-{y}-{z}.glb" } else { "{level}-{x}-{y}.glb" };
    tileset(json!({"boundingVolume": {}, "geometricError": 1, "refine": refine, "content": {"uri": contents},
        "implicitTiling": {"subdivisionScheme": scheme, "subtreeLevels": subtree_levels, "availableLevels": levels,
            "subtrees": {"uri": "s{level}-{x}-{y}.subtree"}}}))
}

fn names(model: &Model) -> BTreeSet<&str> {
    model.parts.iter().map(|part| part.name.split('/').next().unwrap_or_default()).collect()
}

/// The root, its first and last child (0, 0) and (1, 1), and below the last one another list.
fn lists() -> [Vec<u8>; 2] {
    let first = json!({
        "buffers": [{"byteLength": 3}],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 1}, {"buffer": 0, "byteOffset": 1, "byteLength": 2}],
        "tileAvailability": {"bitstream": 0}, "contentAvailability": [{"bitstream": 0}],
        "childSubtreeAvailability": {"bitstream": 1}});
    // the last child's second child: x = 3, y = 2 of level 2
    let first = subtree(&first, &[0b1_0011, 0, 0b0010_0000]);
    let second = json!({"tileAvailability": {"constant": 1}, "contentAvailability": [{"constant": 1}],
        "childSubtreeAvailability": {"constant": 0}});
    [first, second.to_string().into_bytes()]
}

#[test]
fn the_finest_tiles_of_a_tree_stand_there() {
    let [first, second] = lists();
    let one = triangle();
    let tree = |refine| tree("QUADTREE", refine, 2, 4);
    let files = |tree: &str| {
        read(&[
            ("tileset.json", tree.as_bytes()),
            ("s0-0-0.subtree", &first),
            ("s2-3-2.subtree", &second),
            ("0-0-0.glb", &one),
            ("1-0-0.glb", &one),
            ("1-1-1.glb", &one),
            ("2-3-2.glb", &one),
            ("3-6-4.glb", &one),
            ("3-7-4.glb", &one),
            ("3-6-5.glb", &one),
            ("3-7-5.glb", &one),
        ])
    };
    let finest = files(&tree("REPLACE"));
    assert_eq!(names(&finest), BTreeSet::from(["1-0-0", "3-6-4", "3-7-4", "3-6-5", "3-7-5"]));
    assert_eq!(left_out(&finest, "tiles"), 3);
    let all = files(&tree("ADD"));
    assert_eq!((names(&all).len(), all.left_out.len()), (8, 0));
}

#[test]
fn the_lists_are_the_models_own_files() {
    let [first, second] = lists();
    let text = tree("QUADTREE", "REPLACE", 2, 4);
    let (folder, path) = folder_of(&[
        ("tileset.json", text.as_bytes()),
        ("s0-0-0.subtree", &first),
        ("s2-3-2.subtree", &second),
        ("1-0-0.glb", &triangle()),
    ]);
    let format = FORMATS.iter().find(|format| format.name() == "3D Tiles").expect("3D Tiles");
    let named = format.named_by(&path);
    for name in ["s0-0-0.subtree", "s2-3-2.subtree", "1-0-0.glb", "3-7-5.glb"] {
        assert!(named.contains(&folder.path().join(name)), "{name} is missing in {named:?}");
    }
}

#[test]
fn an_octree_has_heights_and_levels_end() {
    let list = json!({"tileAvailability": {"constant": 1}, "contentAvailability": [{"constant": 1}],
        "childSubtreeAvailability": {"constant": 1}});
    let list = list.to_string().into_bytes();
    let mut files: Vec<(String, Vec<u8>)> = vec![
        ("tileset.json".into(), tree("OCTREE", "REPLACE", 1, 2).into_bytes()),
        ("s0-0-0.subtree".into(), list.clone()),
    ];
    for place in 0..8 {
        let [x, y, z] = [place & 1, place >> 1 & 1, place >> 2];
        files.push((format!("s1-{x}-{y}.subtree"), list.clone()));
        files.push((format!("1-{x}-{y}-{z}.glb"), triangle()));
    }
    let files: Vec<(&str, &[u8])> = files.iter().map(|(name, bytes)| (name.as_str(), bytes.as_slice())).collect();
    let model = read(&files);
    assert_eq!((model.parts.len(), left_out(&model, "tiles"), left_out(&model, "contents")), (8, 1, 0));
}

#[test]
fn several_contents_of_a_tile_stand_there() {
    let mut root: Value = serde_json::from_str(&tree("QUADTREE", "REPLACE", 1, 1)).expect("JSON");
    root["root"]["contents"] = json!([{"uri": "a{level}.glb"}, {"uri": "b{level}.glb"}]);
    root["root"].as_object_mut().expect("a tile").remove("content");
    let list = json!({"tileAvailability": {"constant": 1}, "contentAvailability": [{"constant": 0}, {"constant": 1}],
        "childSubtreeAvailability": {"constant": 0}})
    .to_string();
    let one = triangle();
    let model = read(&[
        ("tileset.json", root.to_string().as_bytes()),
        ("s0-0-0.subtree", list.as_bytes()),
        ("a0.glb", &one),
        ("b0.glb", &one),
    ]);
    assert_eq!(names(&model), BTreeSet::from(["b0"]));
}

#[test]
fn a_tree_that_never_ends_is_refused_soon() {
    let list = json!({"tileAvailability": {"constant": 1}, "contentAvailability": [],
        "childSubtreeAvailability": {"constant": 1}});
    let mut text: Value = serde_json::from_str(&tree("OCTREE", "ADD", 1, 30)).expect("JSON");
    text["root"]["implicitTiling"]["subtrees"]["uri"] = json!("s.subtree");
    let refused = |levels: u32, words: &str| {
        let mut text = text.clone();
        text["root"]["implicitTiling"]["subtreeLevels"] = json!(levels);
        let files = [("tileset.json", text.to_string()), ("s.subtree", list.to_string())];
        let files: Vec<(&str, &[u8])> = files.iter().map(|(name, text)| (*name, text.as_bytes())).collect();
        let (_folder, path) = folder_of(&files);
        let started = Instant::now();
        let error = gnomon::formats::read(&path, &ReadOptions::default()).expect_err("refused").to_string();
        assert!(error.contains(words), "{error}");
        assert!(started.elapsed() < Duration::from_secs(30), "it is followed for too long");
    };
    refused(1, "more subtree files than can be read");
    refused(20, "more than 1000000 tiles");
    refused(40, "no content in its folder");
}

#[test]
fn damaged_lists_and_tables_are_survived() {
    let [first, second] = lists();
    let text = tree("QUADTREE", "REPLACE", 2, 4);
    let table = json!({"name": ["Town hall", "Church"]});
    let (folder, path) = folder_of(&[
        ("tileset.json", text.as_bytes()),
        ("s2-3-2.subtree", &second),
        ("1-0-0.glb", &batched_file([0.0, 1.0], &table)),
    ]);
    let (list, tile) = (folder.path().join("s0-0-0.subtree"), folder.path().join("1-0-0.glb"));
    let mut refused = 0;
    let thread = CountedThread::new();
    for seed in 0..1000 {
        std::fs::write(&list, if seed % 2 == 0 { damaged(&first, seed) } else { first.clone() }).expect("written");
        let whole = batched_file([0.0, 1.0], &table);
        std::fs::write(&tile, if seed % 2 == 1 { damaged(&whole, seed) } else { whole }).expect("written");
        let started = Instant::now();
        refused += u32::from(read_within_memory(&thread, &path, &ReadOptions::default()).is_err());
        assert!(started.elapsed() < Duration::from_secs(1), "seed {seed}");
    }
    assert!((1..1000).contains(&refused), "{refused} of 1000 refused");
}
