//! A small file of each format, damaged in a thousand ways: each is read or refused, and quickly.

use super::block::AT;
use super::files::b3dm;
use crate::formats::mutations::read_within_memory;
use crate::shared::memory::CountedThread;
use gnomon::formats::{ReadOptions, read};
use std::time::{Duration, Instant};

/// Numbers that are the same in every run.
struct Seeded(u64);

impl Seeded {
    fn next(&mut self, below: usize) -> usize {
        // splitmix64
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((mixed ^ (mixed >> 31)) % below.max(1) as u64) as usize
    }
}

/// One to four bytes are changed, taken out, doubled or cut off, or a number is made large.
pub(super) fn damaged(bytes: &[u8], seed: u64) -> Vec<u8> {
    let mut random = Seeded(seed);
    let mut bytes = bytes.to_vec();
    for _ in 0..=random.next(4) {
        let at = random.next(bytes.len());
        match random.next(6) {
            0 => bytes.truncate(at),
            1 => drop(bytes.drain(at..(at + random.next(20)).min(bytes.len()))),
            2 => {
                let copied = bytes[at..(at + random.next(40)).min(bytes.len())].to_vec();
                bytes.splice(at..at, copied);
            }
            3 => bytes.splice(at..at, *b"999999999").for_each(drop),
            4 => bytes.iter_mut().skip(at).take(4).for_each(|byte| *byte = 0xFF),
            _ => bytes.iter_mut().skip(at).take(1).for_each(|byte| *byte = random.next(256) as u8),
        }
    }
    bytes
}

/// A file and those beside it; the first is damaged.
fn survives(files: &[(&str, Vec<u8>)]) {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, bytes) in files {
        std::fs::write(folder.path().join(name), bytes).expect("written");
    }
    let path = folder.path().join(files[0].0);
    let options = ReadOptions { default_height_m: Some(5.0), ..ReadOptions::default() };
    read(&path, &options).unwrap_or_else(|error| panic!("undamaged it is read: {error}"));
    let mut refused = 0;
    let thread = CountedThread::new();
    for seed in 0..1000 {
        std::fs::write(&path, damaged(&files[0].1, seed)).expect("written");
        let start = Instant::now();
        match read_within_memory(&thread, &path, &options) {
            Ok(model) => {
                let is_whole = model.parts.iter().all(|part| {
                    let corners = part.positions.len() as u32;
                    part.positions.iter().all(|corner| corner.is_finite())
                        && part.triangles.as_flattened().iter().all(|&corner| corner < corners)
                });
                assert!(is_whole, "{}, seed {seed}", files[0].0);
            }
            Err(_) => refused += 1,
        }
        assert!(start.elapsed() < Duration::from_secs(1), "{}, seed {seed}", files[0].0);
    }
    assert!(refused > 0, "{}: nothing was damaged", files[0].0);
}

#[test]
fn cityjson() {
    let file = super::shapes::city(super::shapes::building(serde_json::json!([super::shapes::solid("2")])));
    survives(&[("a.city.json", file.to_string().into_bytes())]);
}

#[test]
fn citygml() {
    let file = super::citygml::city("urn:ogc:def:crs:EPSG::31467", &super::citygml::building(|corner| corner + AT));
    survives(&[("a.gml", file.into_bytes())]);
}

#[test]
fn geojson() {
    survives(&[("a.geojson", super::footprints::geojson().into_bytes())]);
}

#[test]
fn flatgeobuf() {
    survives(&[("a.fgb", super::footprints::flatgeobuf())]);
}

#[test]
fn shapefiles_and_their_tables() {
    let [shape, table, system] = super::footprints::shapefiles();
    survives(&[shape.clone(), table.clone(), system]);
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("houses.shp"), &shape.1).expect("written");
    let options = ReadOptions { default_height_m: Some(5.0), ..ReadOptions::default() };
    let thread = CountedThread::new();
    for seed in 0..1000 {
        std::fs::write(folder.path().join("houses.dbf"), damaged(&table.1, seed)).expect("written");
        let read = read_within_memory(&thread, &folder.path().join("houses.shp"), &options);
        assert!(read.is_ok(), "the table says too little, and the outline stands: {seed}");
    }
}

#[test]
fn tiles() {
    survives(&[("a.b3dm", b3dm(&super::tiles::gltf(""), "{\"RTC_CENTER\":[1,2,3]}"))]);
    let tileset = r#"{"asset":{"version":"1.0"},"geometricError":9,"root":{"transform":[1,0,0,0,0,1,0,0,0,0,1,0,5,6,7,1],
        "refine":"ADD","content":{"uri":"a.glb"},"children":[{"content":{"uri":"a.glb"}}]}}"#;
    survives(&[("tileset.json", tileset.into()), ("a.glb", super::tiles::gltf(""))]);
}
