//! The cache of models: the same model comes back for exactly the same file and request, and damaged entries are not
//! used.

use crate::shared::program::{names, site};
use glam::DVec3;
use gnomon::formats::{
    self, Anchor, AnchorPoint, Coordinates, Format, LeftOut, Model, ModelCache, PartKind, ReadOptions, SeeThrough, Up,
};
use gnomon::mesh::{CornerPrecision, Part};
use gnomon::message::{Field, Message, MessagePart};
use std::fs;
use std::path::Path;
use std::time::{Duration, SystemTime};

/// A model in which every field has a value.
fn full() -> Model {
    let part = |name: &str, at: f64| Part {
        name: name.to_owned(),
        aliases: vec![name.to_owned(), "storey é".to_owned()],
        positions: vec![DVec3::new(at, 0.1 + 0.2, -1.0 / 3.0), DVec3::X, DVec3::new(5e6, 1e-300, -0.0)],
        triangles: vec![[0, 1, 2], [2, 1, 0]],
        coarse: vec![CornerPrecision { corners: 0..2, step_m: 0.1 + 0.2, is_float: true }],
    };
    let place = AnchorPoint::Geographic { latitude_deg: 0.1 + 0.2, longitude_deg: 1.0 / 3.0, elevation_m: None };
    let map = AnchorPoint::Map {
        crs: "EPSG:25832".to_owned(),
        easting: 500_000.123_456_789,
        northing: f64::INFINITY,
        height: Some(-0.7),
        scale: 0.9996,
    };
    let hint = vec![
        MessagePart::Where(
            Field::Place,
            vec![MessagePart::Set(Field::Place, "1,2".into()), MessagePart::Key(Field::Up)],
        ),
        MessagePart::At { file: "a".to_owned(), table: "[b]".to_owned(), key: "c".to_owned() },
    ];
    Model {
        format: "glTF",
        parts: vec![part("wall", 0.1), part("road", 1e7 / 3.0)],
        kinds: vec![PartKind::Terrain, PartKind::GroundCover],
        up: Up::Z,
        up_is_said: true,
        unit_m: Some(0.304_8),
        coordinates: Coordinates::Map("EPSG:25832".to_owned()),
        from_ground: vec![true, false],
        anchors: vec![
            Anchor { said_by: "IfcSite", at: place, north_rad: Some(0.1 + 0.2) },
            Anchor { said_by: "IfcMapConversion", at: map, north_rad: None },
            Anchor { said_by: "TrueNorth", at: AnchorPoint::Nowhere, north_rad: Some(f64::MIN_POSITIVE) },
        ],
        assumed_map_unit_m: Some(0.1 + 0.2),
        left_out: vec![LeftOut { what: "IfcSpace".to_owned(), count: 7, why: "not built".to_owned() }],
        notes: vec![Message { what: vec!["is odd".into(), MessagePart::Field(Field::Ground)], hint }],
        see_through: vec![SeeThrough { material: "glass".to_owned(), parts: vec![1] }],
    }
}

fn format_of(file: &Path) -> &'static dyn Format {
    formats::by_ending(file).unwrap()
}

fn cache(folder: &Path) -> ModelCache {
    ModelCache { folder: folder.join("cache"), most_bytes: ModelCache::MOST_BYTES }
}

#[test]
fn same_model_comes_back_to_the_bit() {
    let folder = site();
    let (cache, file) = (cache(folder.path()), folder.path().join("tower.glb"));
    let entry = cache.entry(format_of(&file), &file, &ReadOptions::default()).unwrap();
    assert!(entry.read().is_none(), "nothing is kept yet");
    entry.keep(&full()).unwrap();
    assert_eq!(format!("{:?}", entry.read().unwrap()), format!("{:?}", full()));
    assert_eq!(names(cache.folder.clone()).len(), 1, "nothing is left of the writing");
}

#[test]
fn another_file_or_request_is_another_entry() {
    let folder = site();
    let (cache, file) = (cache(folder.path()), folder.path().join("tower.glb"));
    let entry = |options: &ReadOptions| cache.entry(format_of(&file), &file, options).unwrap();
    entry(&ReadOptions::default()).keep(&full()).unwrap();
    assert!(entry(&ReadOptions::default()).read().is_some());
    let others = [
        ReadOptions { default_height_m: Some(9.0), ..ReadOptions::default() },
        ReadOptions { scale: Some(1.0), ..ReadOptions::default() },
        ReadOptions { scene: Some(gnomon::formats::SceneName::Number(1)), ..ReadOptions::default() },
    ];
    for other in others {
        assert!(entry(&other).read().is_none(), "{other:?}");
    }
    let mut bytes = fs::read(&file).unwrap();
    let last = bytes.len() - 1;
    bytes[last] ^= 1;
    fs::write(&file, bytes).unwrap();
    assert!(entry(&ReadOptions::default()).read().is_none(), "another content");
    // a file of the same content is the same, wherever it lies
    let twin = folder.path().join("twin.glb");
    fs::copy(folder.path().join("open.glb"), &twin).unwrap();
    let of = |file: &Path| cache.entry(format_of(file), file, &ReadOptions::default()).unwrap();
    of(&twin).keep(&full()).unwrap();
    assert!(of(&folder.path().join("open.glb")).read().is_some());
}

/// A `.gltf` is its buffers as well.
#[test]
fn named_files_count() {
    let folder = site();
    let (cache, file) = (cache(folder.path()), folder.path().join("model.gltf"));
    let buffer = folder.path().join("model.bin");
    fs::write(&file, "{\"asset\": {\"version\": \"2.0\"}, \"buffers\": [{\"uri\": \"model.bin\", \"byteLength\": 3}]}")
        .unwrap();
    fs::write(&buffer, b"abc").unwrap();
    let entry = || cache.entry(format_of(&file), &file, &ReadOptions::default()).unwrap();
    entry().keep(&full()).unwrap();
    assert!(entry().read().is_some());
    fs::write(&buffer, b"abd").unwrap();
    assert!(entry().read().is_none(), "another buffer");
    fs::remove_file(&buffer).unwrap();
    assert!(entry().read().is_none(), "no buffer");
}

#[test]
fn damaged_entry_is_ignored_and_removed() {
    let folder = site();
    let (cache, file) = (cache(folder.path()), folder.path().join("tower.glb"));
    let entry = cache.entry(format_of(&file), &file, &ReadOptions::default()).unwrap();
    entry.keep(&full()).unwrap();
    let path = cache.folder.join(&names(cache.folder.clone())[0]);
    let whole = fs::read(&path).unwrap();
    let mut damaged: Vec<Vec<u8>> = (0..whole.len()).step_by(7).map(|cut| whole[..cut].to_vec()).collect();
    damaged.extend((0..whole.len()).map(|at| {
        let mut bytes = whole.clone();
        bytes[at] ^= 1 << (at % 8);
        bytes
    }));
    for bytes in damaged {
        fs::write(&path, &bytes).unwrap();
        assert!(entry.read().is_none(), "{} of {} bytes", bytes.len(), whole.len());
        assert!(!path.exists(), "it is removed");
    }
    fs::write(&path, whole).unwrap();
    assert!(entry.read().is_some(), "what is whole is read");
}

#[test]
fn oldest_entries_make_room() {
    let folder = site();
    let file = folder.path().join("tower.glb");
    let mut cache = cache(folder.path());
    let entry = |cache: &ModelCache, step: f64| {
        let options = ReadOptions { scale: Some(step), ..ReadOptions::default() };
        let entry = cache.entry(format_of(&file), &file, &options).unwrap();
        let found = entry.read().is_some();
        entry.keep(&full()).unwrap();
        found
    };
    entry(&cache, 1.0);
    let name = names(cache.folder.clone()).remove(0);
    let first = fs::File::options().write(true).open(cache.folder.join(&name)).unwrap();
    first.set_modified(SystemTime::UNIX_EPOCH + Duration::from_secs(1)).unwrap();
    let size = first.metadata().unwrap().len();
    // something else that lies there is nobody's to remove
    fs::write(cache.folder.join("note.txt"), vec![0; 10 * size as usize]).unwrap();
    cache.most_bytes = 2 * size + size / 2;
    entry(&cache, 2.0);
    assert!(cache.folder.join(&name).exists(), "two have room");
    entry(&cache, 3.0);
    assert!(!cache.folder.join(&name).exists(), "the oldest goes");
    assert!(cache.folder.join("note.txt").exists());
    assert!(entry(&cache, 3.0), "the newest stays");
    // one that is larger than all may be is not kept
    cache.most_bytes = 10;
    assert!(!entry(&cache, 4.0) && !entry(&cache, 4.0));
}

#[test]
fn cache_that_cannot_be_written_is_an_error() {
    let folder = site();
    let file = folder.path().join("tower.glb");
    let cache = ModelCache { folder: file.join("below-a-file"), most_bytes: ModelCache::MOST_BYTES };
    let entry = cache.entry(format_of(&file), &file, &ReadOptions::default()).unwrap();
    assert!(entry.read().is_none() && entry.keep(&full()).is_err());
}

/// What leads out of the model's folder is not read, and so no input that a cache would look at.
#[test]
fn gltf_names_only_what_lies_beside_it() {
    let folder = site();
    let file = folder.path().join("named.gltf");
    let uris = ["a.bin", "data/b%20c.png", "../out.png", "data/../../out.bin", "/etc/hosts", "C:/x.png", "data:,x"];
    let images: Vec<_> = uris.iter().map(|uri| serde_json::json!({"uri": uri})).collect();
    fs::write(&file, serde_json::json!({"asset": {"version": "2.0"}, "images": images}).to_string()).unwrap();
    let named = format_of(&file).named_by(&file);
    assert_eq!(named, [folder.path().join("a.bin"), folder.path().join("data/b c.png")]);
}
