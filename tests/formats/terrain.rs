//! Terrain: rasters are simplified within the requested error, and each format is placed where its file says.

use super::mutations::survives;
use crate::shared::memory::CountedThread;
use glam::{DVec2, DVec3};
use gnomon::formats::{self, Coordinates, Model, PartKind, ReadOptions};
use gnomon::mesh::Part;
use std::fmt::Write as _;
use tiff::encoder::{TiffEncoder, colortype};
use tiff::tags::Tag;

const COLUMNS: usize = 70;
const ROWS: usize = 45;

/// Hills, and a lake without heights.
fn height(column: usize, row: usize) -> Option<f64> {
    let (x, y) = (column as f64, row as f64);
    let is_lake = (x - 40.0).powi(2) + (y - 20.0).powi(2) < 36.0;
    (!is_lake).then(|| 100.0 + 8.0 * (x / 9.0).sin() * (y / 13.0).cos() + if column > 55 { 5.0 } else { 0.0 })
}

fn ascii_grid(head: &str) -> String {
    let mut text = head.to_owned();
    for row in 0..ROWS {
        for column in 0..COLUMNS {
            write!(text, "{} ", height(column, row).map_or(-9999.0, |height| (height * 100.0).round() / 100.0))
                .unwrap();
        }
        text.push('\n');
    }
    text
}

fn head() -> String {
    format!("ncols {COLUMNS}\nnrows {ROWS}\nxllcorner 1000\nyllcorner 2000\ncellsize 2\nNODATA_value -9999\n")
}

pub(super) fn read(name: &str, bytes: impl AsRef<[u8]>, options: &ReadOptions) -> Result<Model, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    formats::read(&path, options).map_err(|error| error.fault.to_string())
}

pub(super) fn notes(model: &Model) -> String {
    model.notes.iter().map(|note| format!("{note}\n")).collect()
}

/// The height of a sheet above a point of its plan.
pub(super) fn above(part: &Part, at: DVec2) -> Option<f64> {
    part.triangles.iter().find_map(|triangle| {
        let [a, b, c] = triangle.map(|corner| part.positions[corner as usize]);
        let area = (b - a).truncate().perp_dot((c - a).truncate());
        let share = |one: DVec3, other: DVec3| (one.truncate() - at).perp_dot(other.truncate() - at) / area;
        let shares = [share(b, c), share(c, a), share(a, b)];
        shares.iter().all(|share| *share >= -1e-9).then(|| shares[0] * a.z + shares[1] * b.z + shares[2] * c.z)
    })
}

/// Where a sample of the test's raster stands, as its head says.
fn place(column: usize, row: usize) -> DVec2 {
    DVec2::new(1001.0 + 2.0 * column as f64, 2001.0 + 2.0 * (ROWS - 1 - row) as f64)
}

#[test]
fn every_height_lies_within_the_error_that_is_asked() {
    for error in [0.0, 0.05, 0.5, 3.0] {
        let options = ReadOptions { terrain_error_m: error, ..ReadOptions::default() };
        let model = read("hills.asc", ascii_grid(&head()), &options).unwrap();
        let part = &model.parts[0];
        let mut farthest = 0.0_f64;
        for row in 0..ROWS {
            for column in 0..COLUMNS {
                let found = above(part, place(column, row));
                match height(column, row) {
                    Some(height) if found.is_some() => farthest = farthest.max((height - found.unwrap()).abs()),
                    // a cell whose neighbours have no heights may stand alone
                    Some(_) => assert!(is_by_the_lake(column, row), "{column} {row}"),
                    None => assert!(found.is_none(), "the lake has no ground: {column} {row}"),
                }
            }
        }
        // heights are written to the centimetre, and kept in single precision
        assert!(farthest <= error + 0.0051, "{farthest} of {error}");
        let full = 2 * (COLUMNS - 1) * (ROWS - 1);
        assert_eq!(part.triangles.len() < full / 2, error > 0.0, "{} of {full} at {error}", part.triangles.len());
    }
}

fn is_by_the_lake(column: usize, row: usize) -> bool {
    (-1..=1).any(|across| {
        (-1..=1).any(|down| height(column.wrapping_add_signed(across), row.wrapping_add_signed(down)).is_none())
    })
}

/// A sheet has no cracks: no corner lies within another triangle's side.
#[test]
fn thinned_sheets_have_no_cracks_and_look_up() {
    for error in [0.05, 0.5] {
        let options = ReadOptions { terrain_error_m: error, ..ReadOptions::default() };
        let model = read("hills.asc", ascii_grid(&head()), &options).unwrap();
        let part = &model.parts[0];
        for triangle in &part.triangles {
            let corners = triangle.map(|corner| part.positions[corner as usize].truncate());
            assert!((corners[1] - corners[0]).perp_dot(corners[2] - corners[0]) > 0.0, "it looks up");
            for side in 0..3 {
                let (from, to) = (corners[side], corners[(side + 1) % 3]);
                let inside = |point: &DVec3| {
                    let along = (point.truncate() - from).dot(to - from) / (to - from).length_squared();
                    let off = (point.truncate() - from).perp_dot(to - from).abs();
                    off < 1e-6 && along > 1e-6 && along < 1.0 - 1e-6
                };
                assert!(!part.positions.iter().any(inside), "a corner hangs in a side from {from} to {to}");
            }
        }
    }
}

#[test]
fn a_grid_is_terrain_where_its_head_says() {
    let model = read("hills.asc", ascii_grid(&head()), &ReadOptions::default()).unwrap();
    assert_eq!((model.kind(0), model.coordinates.clone()), (PartKind::Terrain, Coordinates::Local));
    assert!(notes(&model).contains("109 cells without a height"), "{}", notes(&model));
    for (side, words) in [("1", " 1 unit apart"), ("2", " 2 units apart")] {
        let head = head().replacen("cellsize 2", &format!("cellsize {side}"), 1);
        let told = notes(&read("hills.asc", ascii_grid(&head), &ReadOptions::default()).unwrap());
        assert!(told.contains(words), "{told}");
    }
    let centre = head().replace("xllcorner", "xllcenter").replace("yllcorner", "yllcenter");
    let moved = read("hills.asc", ascii_grid(&centre), &ReadOptions::default()).unwrap();
    let low = |model: &Model| model.parts[0].positions.iter().fold(DVec3::INFINITY, |low, point| low.min(*point));
    assert_eq!((low(&model).truncate() - low(&moved).truncate()), DVec2::ONE, "half a cell");
    assert_eq!(low(&model).truncate(), DVec2::new(1001.0, 2001.0));
}

#[test]
fn a_grid_without_terrain_is_refused_with_the_way_out() {
    let refused = |rows: &str, heights: &str| {
        let text = format!("ncols 2\nnrows {rows}\nxllcorner 0\nyllcorner 0\ncellsize 1\nnodata_value -9\n{heights}\n");
        read("hills.asc", &text, &ReadOptions::default()).expect_err("no terrain")
    };
    let empty = refused("2", "-9 -9\n-9 -9");
    assert!(empty.contains("has no heights in any of its 4 cells; export the part"), "{empty}");
    let line = refused("1", "3 4");
    assert!(line.contains("has 2 heights, but no three next to each other; export a larger part"), "{line}");
}

#[test]
fn a_damaged_grid_is_refused() {
    let text = ascii_grid(&head());
    let refused = |text: &str| read("hills.asc", text, &ReadOptions::default()).expect_err("it is damaged");
    assert!(refused(&text[..text.len() / 2]).contains("cut off"));
    assert!(refused(&format!("{text} 1")).contains("more than"));
    assert!(refused(&text.replace("nrows 45", "nrows 4000000000")).contains("a terrain may have"));
    assert!(refused(&text.replace("nrows 45", "nrows 100000")).contains("cut off"));
    assert!(refused(&text.replacen("cellsize 2", "cellsize 0", 1)).contains("cells of 0"));
    assert!(refused(&text.replace("cellsize 2\n", "")).contains("cellsize"));
    assert!(refused("ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 x 4").contains("\"x\""));
}

/// GeoTIFF of the hills: what lies beside the numbers.
struct Tags<'a> {
    keys: &'a [u16],
    no_data: Option<&'a str>,
    rows_per_strip: u32,
}

fn geotiff(tags: &Tags, number: impl Fn(Option<f64>) -> f32) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let mut tiff = TiffEncoder::new(&mut bytes).unwrap();
    let mut image = tiff.new_image::<colortype::Gray32Float>(COLUMNS as u32, ROWS as u32).unwrap();
    image.rows_per_strip(tags.rows_per_strip).unwrap();
    let directory = image.encoder();
    directory.write_tag(Tag::Unknown(33550), &[2.0, 2.0, 0.0][..]).unwrap();
    let north = 2000.0 + 2.0 * ROWS as f64;
    directory.write_tag(Tag::Unknown(33922), &[0.0, 0.0, 0.0, 1000.0, north, 0.0][..]).unwrap();
    directory.write_tag(Tag::Unknown(34735), tags.keys).unwrap();
    if let Some(none) = tags.no_data {
        directory.write_tag(Tag::Unknown(42113), none).unwrap();
    }
    let numbers: Vec<f32> = (0..COLUMNS * ROWS).map(|at| number(height(at % COLUMNS, at / COLUMNS))).collect();
    image.write_data(&numbers).unwrap();
    bytes.into_inner()
}

/// Projected, cells, EPSG:25832, heights in metres.
const METRES: [u16; 20] = [1, 1, 0, 4, 1024, 0, 1, 1, 1025, 0, 1, 1, 3072, 0, 1, 25832, 4099, 0, 1, 9001];

#[test]
fn a_geotiff_lies_where_its_tags_say() {
    let plain = read("hills.asc", ascii_grid(&head()), &ReadOptions::default()).unwrap();
    for (no_data, rows_per_strip) in [(Some("-1"), 7), (None, 45)] {
        let none = no_data.map_or(-9999.0, |none: &str| none.parse().unwrap());
        let tags = Tags { keys: &METRES, no_data, rows_per_strip };
        let bytes = geotiff(&tags, |height| height.map_or(none, |height| ((height * 100.0).round() / 100.0) as f32));
        let model = read("hills.tif", bytes, &ReadOptions::default()).unwrap();
        assert_eq!(model.coordinates, Coordinates::Map("EPSG:25832".to_owned()));
        assert_eq!(model.parts[0].triangles, plain.parts[0].triangles);
        assert_eq!(model.parts[0].positions, plain.parts[0].positions);
        assert_eq!(notes(&model).contains("does not say which number"), no_data.is_none(), "{}", notes(&model));
    }
    // of points: half a cell further to the north-west
    let mut keys = METRES;
    keys[11] = 2;
    let bytes =
        geotiff(&Tags { keys: &keys, no_data: Some("-1"), rows_per_strip: 9 }, |height| height.unwrap_or(-1.0) as f32);
    let model = read("hills.tif", bytes, &ReadOptions::default()).unwrap();
    let low = |model: &Model| model.parts[0].positions.iter().fold(DVec3::INFINITY, |low, point| low.min(*point));
    assert_eq!(low(&model).truncate() - low(&plain).truncate(), DVec2::new(-1.0, 1.0));
}

#[test]
fn heights_in_feet_become_metres() {
    let mut keys = METRES;
    keys[19] = 9003;
    let bytes = geotiff(&Tags { keys: &keys, no_data: Some("-1"), rows_per_strip: 9 }, |height| {
        height.map_or(-1.0, |height| (height * 3937.0 / 1200.0) as f32)
    });
    let model = read("hills.tif", bytes, &ReadOptions::default()).unwrap();
    let foot = 1200.0 / 3937.0;
    // in the file's unit, so that `scale` replaces it and converts nothing twice
    assert_eq!(model.unit_m, Some(foot));
    let found = above(&model.parts[0], place(10, 10)).unwrap() * foot;
    assert!((found - height(10, 10).unwrap()).abs() < 0.1001, "{found}");
}

/// Heights of a GeoTIFF with these keys: their unit, and what the notes say of it.
fn unit_by(keys: &[[u16; 4]]) -> (Option<f64>, String) {
    let mut directory = vec![1, 1, 0, keys.len() as u16];
    directory.extend(keys.iter().flatten());
    let tags = Tags { keys: &directory, no_data: None, rows_per_strip: 9 };
    let model =
        read("hills.tif", geotiff(&tags, |height| height.unwrap_or(-9999.0) as f32), &ReadOptions::default()).unwrap();
    (model.unit_m, notes(&model))
}

#[test]
fn the_unit_of_heights_is_the_files_then_the_systems_then_the_maps() {
    let foot = 1200.0 / 3937.0;
    let unsaid = "does not say the unit of its heights";
    let in_metres = [[1024, 0, 1, 1], [3072, 0, 1, 25832]];
    let (unit, told) = unit_by(&in_metres);
    assert!(unit == Some(1.0) && told.contains(&format!("{unsaid}; they are taken as metres\n")), "{unit:?} {told}");
    let (unit, told) = unit_by(&[[1024, 0, 1, 1], [3072, 0, 1, 2263]]);
    assert!((unit.unwrap() / foot - 1.0).abs() < 1e-9, "{unit:?}");
    assert!(told.contains(&format!("{unsaid}; they are taken as feet, as its coordinates are")), "{told}");
    // a vertical system in metres on a map in feet, and one in feet on a map in metres
    for (map, vertical, expected) in [(2263, 5703, 1.0), (25832, 6360, foot), (25832, 8228, 0.3048)] {
        let (unit, told) = unit_by(&[[1024, 0, 1, 1], [3072, 0, 1, map], [4096, 0, 1, vertical]]);
        assert!(unit == Some(expected) && !told.contains(unsaid), "{unit:?} {told}");
    }
    // a datum of the first GeoTIFF says no unit
    let (unit, told) = unit_by(&[[1024, 0, 1, 1], [3072, 0, 1, 2263], [4096, 0, 1, 5103]]);
    assert!(unit.unwrap() < 0.31 && told.contains(unsaid), "{unit:?} {told}");
    // of no map: of whichever is said later
    let (unit, told) = unit_by(&[]);
    assert!(unit.is_none() && told.contains(unsaid) && told.contains("`crs`"), "{unit:?} {told}");
}

#[test]
fn a_grid_on_a_map_in_feet_has_its_heights_in_feet() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("hills.asc");
    std::fs::write(&path, ascii_grid(&head())).unwrap();
    std::fs::write(folder.path().join("hills.prj"), "EPSG:2263").unwrap();
    let model = formats::read(&path, &ReadOptions::default()).unwrap();
    assert!((model.unit_m.unwrap() / (1200.0 / 3937.0) - 1.0).abs() < 1e-9, "{:?}", model.unit_m);
    let found = above(&model.parts[0], place(10, 10)).unwrap();
    // 0.1 m are the terrain's error
    assert!((found - height(10, 10).unwrap()).abs() < 0.4, "{found}");
    assert!(notes(&model).contains("they are taken as feet, as its coordinates are"), "{}", notes(&model));
}

#[test]
fn a_picture_is_no_terrain() {
    let mut bytes = std::io::Cursor::new(Vec::new());
    TiffEncoder::new(&mut bytes).unwrap().write_image::<colortype::Gray8>(2, 2, &[1, 2, 3, 4]).unwrap();
    let told = read("photo.tif", bytes.into_inner(), &ReadOptions::default()).expect_err("it lies nowhere");
    assert!(told.contains("does not say where it lies"), "{told}");
}

/// A GeoTIFF of 8 bits, 3 × 3, that lies somewhere, with GDAL's metadata and z of its scale and tie point.
fn small<C: colortype::ColorType<Inner = u8>>(metadata: &str, [scale, height]: [f64; 2]) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let mut tiff = TiffEncoder::new(&mut bytes).unwrap();
    let mut image = tiff.new_image::<C>(3, 3).unwrap();
    let directory = image.encoder();
    directory.write_tag(Tag::Unknown(33550), &[2.0, 2.0, scale][..]).unwrap();
    directory.write_tag(Tag::Unknown(33922), &[0.0, 0.0, 0.0, 1000.0, 2000.0, height][..]).unwrap();
    directory.write_tag(Tag::Unknown(34735), &METRES[..]).unwrap();
    directory.write_tag(Tag::Unknown(42112), metadata).unwrap();
    image.write_data(&vec![10; 9 * C::BITS_PER_SAMPLE.len()]).unwrap();
    bytes.into_inner()
}

#[test]
fn a_picture_that_lies_somewhere_is_refused_and_a_grey_one_doubted() {
    let told = read("a.tif", small::<colortype::RGB8>("", [0.0; 2]), &ReadOptions::default()).expect_err("a picture");
    assert!(told.contains("is a picture (RGB) and not terrain"), "{told}");
    let grey = read("a.tif", small::<colortype::Gray8>("", [0.0; 2]), &ReadOptions::default()).unwrap();
    assert!(notes(&grey).contains("numbers of 8 bits"), "{}", notes(&grey));
}

#[test]
fn numbers_become_heights_as_the_tags_say() {
    let metadata = "<GDALMetadata><Item name=\"OFFSET\" sample=\"0\" role=\"offset\">1000</Item>\
                    <Item name=\"SCALE\" sample=\"0\" role=\"scale\">0.5</Item></GDALMetadata>";
    for (metadata, z, expected) in [("", [0.0; 2], 10.0), (metadata, [0.0; 2], 1005.0), ("", [0.5, 50.0], 55.0)] {
        let model = read("a.tif", small::<colortype::Gray8>(metadata, z), &ReadOptions::default()).unwrap();
        assert_eq!(model.parts[0].positions[0].z, expected);
        assert_eq!(notes(&model).contains("times a number plus"), expected != 10.0, "{}", notes(&model));
    }
    let told = read("a.tif", small::<colortype::Gray8>("", [0.0, 50.0]), &ReadOptions::default()).expect_err("unclear");
    assert!(told.contains("tie point at the height 50"), "{told}");
}

#[test]
fn usual_numbers_for_no_height_are_none_with_a_note() {
    for none in [-9999.0, -32768.0, -32767.0, -99999.0, 9999.0, 3.4e38, -3.4e38] {
        let tags = Tags { keys: &METRES, no_data: None, rows_per_strip: 9 };
        let bytes = geotiff(&tags, |height| height.unwrap_or(none) as f32);
        let model = read("hills.tif", bytes, &ReadOptions::default()).unwrap();
        assert!(model.parts[0].positions.iter().all(|at| (80.0..120.0).contains(&at.z)), "{none}");
        assert!(notes(&model).contains("which number means no height; taken as missing:"), "{}", notes(&model));
    }
    let heads = head().replace("NODATA_value -9999\n", "");
    assert!(
        notes(&read("a.asc", ascii_grid(&heads), &ReadOptions::default()).unwrap()).contains("taken as missing: -9999")
    );
}

const LAND: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<LandXML xmlns="http://www.landxml.org/schema/LandXML-1.2" version="1.2">
<Units><Imperial linearUnit="USSurveyFoot"/></Units><CoordinateSystem epsgCode="2225"/>
<Surfaces><Surface name="Existing ground"><Definition surfType="TIN">
<Pnts><P id="7">20 10 100</P><P id="8">20 30 110</P><P id="9">50 10 120</P></Pnts>
<Faces><F>7 9 8</F><F i="1">7 8 9</F></Faces></Definition></Surface>
<Surface name="Without"><Definition surfType="grid"/></Surface></Surfaces></LandXML>"#;

#[test]
fn landxml_is_northing_easting_and_height() {
    let model = read("ground.xml", LAND, &ReadOptions::default()).unwrap();
    let part = &model.parts[0];
    assert_eq!((part.name.as_str(), model.kind(0)), ("Existing ground", PartKind::Terrain));
    assert_eq!(model.coordinates, Coordinates::Map("EPSG:2225".to_owned()));
    let foot = 1200.0 / 3937.0;
    let corners = part.triangles[0].map(|corner| part.positions[corner as usize]);
    let expected = [DVec3::new(10.0, 20.0, 100.0), DVec3::new(30.0, 20.0, 110.0), DVec3::new(10.0, 50.0, 120.0)];
    assert_eq!((corners, model.unit_m), (expected, Some(foot)), "turned to look up");
    let left_out: Vec<_> = model.left_out.iter().map(|left| (left.what.as_str(), left.count)).collect();
    assert_eq!(left_out, [("hidden faces", 1), ("surfaces without triangles", 1)]);
    let local =
        read("ground.xml", LAND.replace("<CoordinateSystem epsgCode=\"2225\"/>", ""), &ReadOptions::default()).unwrap();
    assert_eq!((local.unit_m, local.parts[0].positions[0].z), (Some(foot), 100.0));
    let unsaid = LAND.replace("<Imperial linearUnit=\"USSurveyFoot\"/>", "");
    let unsaid = read("ground.xml", unsaid, &ReadOptions::default()).unwrap();
    assert!((unsaid.unit_m.unwrap() / foot - 1.0).abs() < 1e-9, "{:?}", unsaid.unit_m);
    assert!(notes(&unsaid).contains("they are taken as feet, as its coordinates are"), "{}", notes(&unsaid));
    let refused =
        |from: &str, to: &str| read("ground.xml", LAND.replace(from, to), &ReadOptions::default()).expect_err(to);
    assert!(refused("7 9 8", "7 9 5").contains("some of which are missing"));
    assert!(refused("20 10 100", "20 10").contains("northing, easting and height in point 7"));
    assert!(refused("</Pnts>", "</Points>").contains("damaged at byte"));
}

/// `terrain_error` is metres, also where `scale` says that the file's unit is another one than it says.
#[test]
fn the_error_is_in_metres_whatever_a_unit_is() {
    let part = |scale: Option<f64>, terrain_error_m: f64| {
        let options = ReadOptions { scale, terrain_error_m, ..ReadOptions::default() };
        read("hills.asc", ascii_grid(&head()), &options).unwrap()
    };
    let corners = |model: &Model| model.parts[0].positions.len();
    let [plain, coarse] = [part(None, 0.1), part(None, 1.0)];
    assert!(corners(&coarse) < corners(&plain));
    // of heights in units of ten metres a metre is a tenth of a unit
    let scaled = part(Some(10.0), 1.0);
    assert_eq!(scaled.parts[0].positions, plain.parts[0].positions);
    assert!(notes(&scaled).contains("that lie within 1 m of them"), "{}", notes(&scaled));
}

#[test]
fn the_samples_are_as_far_apart_as_their_map_says() {
    let told = |prj: &str| {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("hills.asc"), ascii_grid(&head())).unwrap();
        std::fs::write(folder.path().join("hills.prj"), prj).unwrap();
        notes(&formats::read(&folder.path().join("hills.asc"), &ReadOptions::default()).unwrap())
    };
    for (prj, unit) in [("EPSG:25832", "m"), ("EPSG:2263", "ft"), ("EPSG:4326", "degrees"), ("", "units")] {
        assert!(told(prj).contains(&format!("heights 2 {unit} apart")), "{prj}: {}", told(prj));
    }
}

/// A GeoTIFF of some kilobytes that says hundred million heights.
#[test]
fn rasters_beyond_the_file_are_refused() {
    // in one strip, so that there are as many as there should be
    let tags = Tags { keys: &METRES, no_data: None, rows_per_strip: 100_000 };
    let tif = geotiff(&tags, |height| height.unwrap_or(0.0) as f32);
    let wide = |side: u32, tif: &mut Vec<u8>| {
        for tag in [256_u16, 257] {
            // a number of 32 or of 16 bits
            let entry = |kind: u8| [&tag.to_le_bytes()[..], &[kind, 0, 1, 0, 0, 0]].concat();
            let find = |kind| tif.windows(8).position(|bytes| bytes == entry(kind));
            let at = find(4).or_else(|| find(3)).expect("the raster's size");
            tif[at + 2] = 4;
            tif[at + 8..at + 12].copy_from_slice(&side.to_le_bytes());
        }
    };
    let thread = CountedThread::new();
    for (side, words) in
        [(9_900, "says that it has 9900 × 9900 heights"), (70_000, "a terrain may have at most 100000000")]
    {
        let mut bytes = tif.clone();
        wide(side, &mut bytes);
        let (told, most) = thread.run(|| read("vast.tif", &bytes, &ReadOptions::default()).expect_err(words));
        assert!(told.contains(words), "{told}");
        assert!(most < 64 << 20, "{most} bytes");
    }
    let strip = ascii_grid(&head().replace("ncols 70", "ncols 50000000").replace("nrows 45", "nrows 1"));
    let told = read("strip.asc", strip, &ReadOptions::default()).expect_err("a strip");
    assert!(told.contains("has 50000000 × 1 heights, which is a strip"), "{told}");
}

/// Files with flipped numbers: none takes long or all memory, and none crashes the program.
#[test]
fn mutations_end_well() {
    let tif = geotiff(&Tags { keys: &METRES, no_data: Some("-1"), rows_per_strip: 9 }, |height| {
        height.unwrap_or(-1.0) as f32
    });
    for (ending, bytes) in [("tif", tif), ("asc", ascii_grid(&head()).into_bytes()), ("xml", LAND.as_bytes().to_vec())]
    {
        let [read, errors] = survives(ending, &bytes);
        assert!(read > 10 && errors > 2, ".{ending}: {read} were read, and there were {errors} different errors");
    }
}
