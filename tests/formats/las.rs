//! LAS and LAZ: measured points by their classes, and files that say more than they hold.

use super::mutations::survives;
use super::terrain::{above, notes, read};
use crate::shared::memory::CountedThread;
use glam::DVec2;
use gnomon::formats::{Coordinates, Model, PartKind, ReadOptions};

/// Points over a plane that rises to the east, with a block of building points 6 m above it.
fn points(is_compressed: bool, classify: bool) -> Vec<u8> {
    written(is_compressed, classify, 10_000)
}

/// The first of them, which are so few that most of the file is its heads.
fn few_points(is_compressed: bool) -> Vec<u8> {
    written(is_compressed, true, 250)
}

fn written(is_compressed: bool, classify: bool, count: u32) -> Vec<u8> {
    let mut header = las::Builder::from((1, 4));
    header.point_format = las::point::Format::new(6).unwrap();
    header.point_format.is_compressed = is_compressed;
    let scale = las::Transform { scale: 0.001, offset: 0.0 };
    header.transforms = las::Vector { x: scale, y: scale, z: scale };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(if is_compressed { "points.laz" } else { "points.las" });
    let mut writer = las::Writer::from_path(&path, header.into_header().unwrap()).unwrap();
    for at in 0..count {
        let (x, y) = (f64::from(at % 100) * 0.5, f64::from(at / 100) * 0.5);
        let is_building = (20.0..30.0).contains(&x) && (10.0..20.0).contains(&y);
        let z = 50.0 + 0.1 * x + if is_building { 6.0 } else { 0.0 };
        let class = if !classify {
            1
        } else if is_building {
            6
        } else {
            2
        };
        let classification = las::point::Classification::new(class).unwrap();
        writer
            .write_point(las::Point { x, y, z, classification, gps_time: Some(0.0), ..las::Point::default() })
            .unwrap();
    }
    writer.close().unwrap();
    std::fs::read(path).unwrap()
}

#[test]
fn measured_points_become_ground_and_what_is_asked() {
    for is_compressed in [false, true] {
        let name = if is_compressed { "points.laz" } else { "points.las" };
        let model = read(name, points(is_compressed, true), &ReadOptions::default()).unwrap();
        assert_eq!(model.parts.len(), 1);
        let ground = &model.parts[0];
        for (x, y) in [(5.0, 5.0), (25.0, 15.0), (45.0, 40.0)] {
            let found = above(ground, DVec2::new(x, y)).unwrap();
            // below the building the heights of its neighbours
            let slack = if x == 25.0 { 1.0 } else { 0.2 };
            assert!((found - 50.0 - 0.1 * x).abs() < slack, "{found} at {x}");
        }
        let building = model.left_out.iter().find(|left| left.what.contains("building")).unwrap();
        assert_eq!(building.count, 400);
        assert!(building.why.contains("classes = [\"building\"]"), "{}", building.why);
        let options = ReadOptions { point_classes: vec!["building".to_owned()], ..ReadOptions::default() };
        let model = read(name, points(is_compressed, true), &options).unwrap();
        assert_eq!((model.parts.len(), model.kind(1)), (2, PartKind::Building));
        assert!(model.parts[1].aliases.iter().any(|alias| alias == "building"), "{:?}", model.parts[1].aliases);
        let top = above(&model.parts[1], DVec2::new(25.2, 15.2)).unwrap();
        assert!((top - 58.5).abs() < 0.2, "{top}");
        assert!(above(&model.parts[1], DVec2::new(15.0, 15.0)).is_none());
    }
    let told = notes(&read("points.las", points(false, true), &ReadOptions::default()).unwrap());
    assert!(told.contains("over cells of 1 unit of its map;"), "{told}");
    let told = notes(&read("points.las", points(false, false), &ReadOptions::default()).unwrap());
    assert!(told.contains("no points classified as ground"), "{told}");
}

#[test]
fn cut_points_are_refused() {
    let whole = points(false, true);
    let told = read("points.las", &whole[..whole.len() / 2], &ReadOptions::default()).expect_err("it is cut");
    assert!(told.contains("cut off") || told.contains("cannot be read"), "{told}");
}

/// A point of a class.
fn point([x, y, z]: [f64; 3], class: u8) -> las::Point {
    let classification = las::point::Classification::new(class).unwrap();
    las::Point { x, y, z, classification, ..las::Point::default() }
}

/// A file of points, in one of the formats of the standard.
fn file_of(format: u8, records: Vec<las::Vlr>, points: impl IntoIterator<Item = las::Point>) -> Vec<u8> {
    let mut header = las::Builder::from((1, 4));
    header.point_format = las::point::Format::new(format).unwrap();
    let scale = las::Transform { scale: 0.001, offset: 0.0 };
    header.transforms = las::Vector { x: scale, y: scale, z: scale };
    header.evlrs = records;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("points.las");
    let mut writer = las::Writer::from_path(&path, header.into_header().unwrap()).unwrap();
    let las::point::Format { has_gps_time, has_color, .. } = las::point::Format::new(format).unwrap();
    for point in points {
        let (gps_time, color) = (has_gps_time.then_some(0.0), has_color.then(las::Color::default));
        writer.write_point(las::Point { gps_time, color, ..point }).unwrap();
    }
    writer.close().unwrap();
    std::fs::read(path).unwrap()
}

/// 50 × 50 m of flat ground at 10 m, of a class.
fn flat(class: u8) -> impl Iterator<Item = las::Point> {
    (0..2500).map(move |at| point([f64::from(at % 50), f64::from(at / 50), 10.0], class))
}

fn count(model: &Model, what: &str) -> Option<u64> {
    model.left_out.iter().find(|left| left.what == what).map(|left| left.count)
}

#[test]
fn what_stands_beyond_the_ground_is_left_out() {
    let options = ReadOptions { point_classes: vec!["building".to_owned()], ..ReadOptions::default() };
    let far = |y: u32| point([200.0, f64::from(y), 30.0], 6);
    let near = point([25.0, 25.0, 20.0], 6);
    let model =
        read("some.las", file_of(6, Vec::new(), flat(2).chain((0..50).map(far)).chain([near])), &options).unwrap();
    assert_eq!(count(&model, "points of class building"), Some(50), "{:?}", model.left_out);
    assert_eq!(model.parts.len(), 2);
    // one block and no wall at the border
    assert!(model.parts[1].positions.iter().all(|at| (20.0..30.0).contains(&at.x)), "{:?}", model.parts[1].positions);
    let model = read("none.las", file_of(6, Vec::new(), flat(2).chain((0..50).map(far))), &options).unwrap();
    assert_eq!((model.parts.len(), count(&model, "points of class building")), (1, Some(50)));
}

/// Points that a program marked as deleted are no ground, in both ways to mark them.
#[test]
fn withheld_points_are_left_out() {
    for format in [0, 1, 3, 6, 7] {
        // every other one, 20 m above the ground
        let deleted = (0..2500).step_by(2).map(|at| {
            let at = point([f64::from(at % 50), f64::from(at / 50), 30.0], 2);
            las::Point { is_withheld: true, ..at }
        });
        let model = read("points.las", file_of(format, Vec::new(), flat(2).chain(deleted)), &ReadOptions::default());
        let model = model.unwrap();
        assert_eq!(count(&model, "points"), Some(1250), "format {format}: {:?}", model.left_out);
        assert!(model.parts[0].positions.iter().all(|at| (at.z - 10.0).abs() < 0.1), "format {format}");
    }
}

#[test]
fn noise_and_points_that_are_nowhere_are_counted() {
    let noise = [7, 7, 18].map(|class| point([25.0, 25.0, -40.0], class));
    let bytes = file_of(6, Vec::new(), flat(2).chain(noise));
    let model = read("noise.las", &bytes, &ReadOptions::default()).unwrap();
    assert_eq!(count(&model, "points of noise"), Some(3), "{:?}", model.left_out);
    // with a step of 1e308, whole numbers above 1 have no finite height
    let mut beyond = bytes;
    beyond[Z_STEP..Z_STEP + 8].copy_from_slice(&1e308_f64.to_le_bytes());
    let told = read("beyond.las", &beyond, &ReadOptions::default()).expect_err("nothing is left");
    assert!(told.contains("without finite coordinates"), "{told}");
}

/// The ground of an unclassified file is made of all its points, so that none is left out.
#[test]
fn points_that_become_ground_are_not_left_out() {
    for class in [1, 5, 6] {
        let model = read("points.las", file_of(6, Vec::new(), flat(class)), &ReadOptions::default()).unwrap();
        assert!(notes(&model).contains("no points classified as ground"), "{}", notes(&model));
        assert!(model.left_out.is_empty(), "{:?}", model.left_out);
    }
}

/// The map is found in any of the extended records, and no length of theirs is believed.
#[test]
fn the_map_of_a_later_record_is_read() {
    let record = |user: &str, number, data: &[u8]| las::Vlr {
        user_id: user.to_owned(),
        record_id: number,
        description: String::new(),
        data: data.to_vec(),
    };
    let other = || record("another", 2112, b"no map");
    // projected, in EPSG:25832
    let keys: Vec<u8> =
        [1_u16, 1, 0, 2, 1024, 0, 1, 1, 3072, 0, 1, 25832].iter().flat_map(|it| it.to_le_bytes()).collect();
    let with_keys = file_of(6, vec![other(), other(), record("LASF_Projection", 34735, &keys)], flat(2));
    let model = read("keys.las", &with_keys, &ReadOptions::default()).unwrap();
    assert_eq!(model.coordinates, Coordinates::Map("EPSG:25832".to_owned()));
    let wkt = b"PROJCS[\"one\",AUTHORITY[\"EPSG\",\"25832\"]]\0";
    let mut with_wkt = file_of(6, vec![other(), record("LASF_Projection", 2112, wkt)], flat(2));
    let model = read("wkt.las", &with_wkt, &ReadOptions::default()).unwrap();
    assert!(matches!(&model.coordinates, Coordinates::Map(map) if map.starts_with("PROJCS[\"one\"")));
    // the length of the second record
    let second = with_wkt.len() - wkt.len() - 60 + 20;
    for (length, words) in [(u64::MAX, "it says its map in"), (1 << 20, "end beyond its end")] {
        with_wkt[second..second + 8].copy_from_slice(&length.to_le_bytes());
        let told = read("wkt.las", &with_wkt, &ReadOptions::default()).expect_err(words);
        assert!(told.contains(words), "{told}");
    }
    let mut many = with_keys;
    many[EXTENDED_AT + 8..EXTENDED_AT + 12].copy_from_slice(&[255; 4]);
    let told = read("many.las", &many, &ReadOptions::default()).expect_err("more than any file has");
    assert!(told.contains("4294967295 extended records"), "{told}");
}

/// The numbers of a header by which a decoder takes memory.
const POINTS_AT: usize = 96;
const RECORD_LENGTH: usize = 105;
/// The length of a step of z.
const Z_STEP: usize = 147;
const EXTENDED_AT: usize = 235;
const POINTS: usize = 247;

fn word(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap())
}

/// Kilobytes that speak of gigabytes: each is refused before its decoder believes it.
#[test]
fn sizes_beyond_the_file_are_refused() {
    let (plain, packed) = (points(false, true), points(true, true));
    let start = word(&packed, POINTS_AT) as usize;
    let table = word(&packed, start) as usize;
    // behind the place of the table, the first point and the number of points
    let layers = start + 8 + 30 + 4;
    let record = packed.windows(14).position(|bytes| bytes == b"laszip encoded").expect("how it is packed") + 52;
    let vast = u32::MAX.to_le_bytes();
    let many = 90_000_000_u64.to_le_bytes();
    let cases: [(&[u8], usize, &[u8], &str); 14] = [
        (&packed, layers, &vast, "a chunk that is longer than the file"),
        (&packed, layers + 32, &vast, "a chunk that is longer than the file"),
        (&packed, table + 4, &vast, "4294967295 chunks of points"),
        (&packed, start, &vast, "names what lies beyond its end"),
        (&packed, start, &[0; 8], "cut off"),
        (&packed, POINTS, &many, "it says that it has 90000000 points"),
        (&packed, POINTS, &[255; 8], "a model may have 100000000"),
        (&packed, RECORD_LENGTH, &[255, 255], "points of 65535 bytes each"),
        (&packed, RECORD_LENGTH, &[31, 0], "how its points are packed"),
        // no items, and a way of packing that these items do not have
        (&packed, record + 32, &[0, 0], "how its points are packed"),
        (&packed, record, &[1, 0], "how its points are packed"),
        (&plain, POINTS, &many, "it has 10000 of 90000000 points"),
        (&plain, EXTENDED_AT, &[80, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0], "extended records end beyond its end"),
        (&plain, POINTS_AT, &vast, "its points begin beyond its end"),
    ];
    let thread = CountedThread::new();
    for (whole, at, new, words) in cases {
        let mut bytes = whole.to_vec();
        bytes[at..at + new.len()].copy_from_slice(new);
        let (told, most) = thread.run(|| read("points.laz", &bytes, &ReadOptions::default()).expect_err(words));
        assert!(told.contains(words), "{told}");
        assert!(most < 64 << 20, "{words}: {most} bytes");
    }
    // a count that a shorter table cannot hold
    let mut fewer = packed.clone();
    fewer[record + 12..record + 16].copy_from_slice(&5000_u32.to_le_bytes());
    let told = read("points.laz", &fewer, &ReadOptions::default()).expect_err("half of them are in no chunk");
    assert!(told.contains("5000 of its 10000 points are in none of its chunks"), "{told}");
}

#[test]
fn mutations_are_survived() {
    for (ending, bytes) in [("las", few_points(false)), ("laz", few_points(true))] {
        let [read, errors] = survives(ending, &bytes);
        assert!(read > 10 && errors > 2, ".{ending}: {read} were read, and there were {errors} different errors");
    }
}
