//! GeoJSON, FlatGeobuf and shapefiles: the building as a footprint.

use super::block::{AT, HIGH, PLAN, assert_is_block, fault_of, left_out, model_at, model_of, names, written};
use super::files::{Field, Ring, dbase, f64s, flatbuffer, shapefile, shapefile_of, text, u32s};
use gnomon::formats::{Coordinates, Model, ReadOptions, Up, read};
use serde_json::{Value, json};

/// The building's outline on its map, closed, counter-clockwise.
pub(super) fn outline() -> Ring {
    PLAN.iter().chain(&PLAN[..1]).map(|&[x, y]| [AT.x + x, AT.y + y]).collect()
}

/// A file of GeoJSON that names its map, as older programs write it.
pub(super) fn collection(features: &[Value]) -> Value {
    json!({
        "type": "FeatureCollection", "name": "houses",
        "crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::25832"}}, "features": features,
    })
}

pub(super) fn feature(rings: &[Ring], properties: Value) -> Value {
    json!({"type": "Feature", "properties": properties, "geometry": {"type": "Polygon", "coordinates": rings}})
}

/// The building as GeoJSON: its floor's height is that of its corners.
pub(super) fn geojson() -> String {
    let corners: Vec<[f64; 3]> = outline().iter().map(|&[x, y]| [x, y, AT.z]).collect();
    let properties = json!({"height": HIGH, "name": "L", "building": "apartments"});
    let mut feature = feature(&[], properties);
    feature["geometry"]["coordinates"] = json!([corners]);
    collection(&[feature]).to_string()
}

/// The building as a shapefile's three files.
pub(super) fn shapefiles() -> [(&'static str, Vec<u8>); 3] {
    let clockwise: Ring = outline().into_iter().rev().collect();
    [
        ("houses.shp", shapefile(15, &[vec![clockwise]], AT.z)),
        ("houses.dbf", dbase(&["NAME", "HEIGHT", "building_l"], &[&["L", "30 m", "2"]])),
        ("houses.prj", b"PROJCS[\"ETRS_1989_UTM_Zone_32N\"]".to_vec()),
    ]
}

/// The building as FlatGeobuf.
pub(super) fn flatgeobuf() -> Vec<u8> {
    let column = |name: &str, kind: u8| vec![text(name), Field::Inline(vec![kind])];
    let header = [
        text("houses"),
        Field::None,
        Field::Inline(vec![6]),
        Field::None,
        Field::None,
        Field::None,
        Field::None,
        Field::Tables(vec![column("other", 11), column("height", 10), column("building", 11)]),
        Field::Inline(1_u64.to_le_bytes().to_vec()),
        Field::Inline(16_u16.to_le_bytes().to_vec()),
        Field::Table(vec![text("EPSG"), Field::Inline(25832_i32.to_le_bytes().to_vec())]),
    ];
    let mut properties = vec![0, 0, 2, 0, 0, 0, b'h', b'i', 1, 0];
    properties.extend(HIGH.to_le_bytes());
    properties.extend([2, 0, 3, 0, 0, 0, b'y', b'e', b's']);
    let ring = outline();
    let heights = vec![AT.z; ring.len()];
    let polygon = vec![u32s(&[]), f64s(ring.as_flattened()), f64s(&heights)];
    let geometry = vec![
        Field::None,
        Field::None,
        Field::None,
        Field::None,
        Field::None,
        Field::None,
        Field::Inline(vec![6]),
        Field::Tables(vec![polygon]),
    ];
    let feature = [Field::Table(geometry), Field::List(properties.len() as u32, properties)];
    let mut file = b"fgb\x03fgb\0".to_vec();
    file.extend(flatbuffer(&header));
    // the index has one box
    file.extend([0; 40]);
    file.extend(flatbuffer(&feature));
    file
}

#[test]
fn each_format_gives_the_building() {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, bytes) in shapefiles() {
        std::fs::write(folder.path().join(name), bytes).expect("written");
    }
    let shape = model_at(&folder.path().join("houses.shp"));
    let format = gnomon::formats::FORMATS.iter().find(|format| format.name() == "Shapefile").expect("shapefiles");
    let beside = ["houses.dbf", "houses.prj"].map(|name| folder.path().join(name));
    assert_eq!(format.named_by(&folder.path().join("houses.shp")), beside);
    assert_eq!(shape.coordinates, Coordinates::Map("PROJCS[\"ETRS_1989_UTM_Zone_32N\"]".into()));
    let (json, flat) = (model_of("a.json", geojson()), model_of("a.fgb", flatgeobuf()));
    for model in [&json, &flat] {
        assert_eq!(model.coordinates, Coordinates::Map("EPSG:25832".into()));
    }
    for (model, aliases) in [
        (&shape, ["L", "houses"].as_slice()),
        (&json, &["L", "apartments", "houses"]),
        (&flat, &["building", "houses"]),
    ] {
        assert_is_block(model);
        assert_eq!((model.up, model.up_is_said, model.unit_m), (Up::Z, true, Some(1.0)));
        assert_eq!((&model.left_out, &model.notes), (&vec![], &vec![]));
        assert_eq!(model.parts[0].aliases, aliases);
    }
}

#[test]
fn rings_may_turn_either_way_and_repeat_points() {
    let mut backwards: Ring = outline().into_iter().rev().collect();
    backwards.insert(2, backwards[2]);
    let mut corners: Vec<Value> = backwards.iter().map(|&[x, y]| json!([x, y, AT.z, 77])).collect();
    corners.pop();
    let mut file = feature(&[], json!({"height": "30"}));
    file["geometry"]["coordinates"] = json!([corners]);
    assert_is_block(&model_of("a.geojson", collection(&[file]).to_string()));
}

/// The volume of all blocks.
pub(super) fn volume(model: &Model) -> f64 {
    let corner = |part: &gnomon::mesh::Part, at: u32| part.positions[at as usize] - AT;
    let of = |part: &gnomon::mesh::Part| {
        part.triangles
            .iter()
            .map(|&[a, b, c]| corner(part, a).dot(corner(part, b).cross(corner(part, c))) / 6.0)
            .sum::<f64>()
    };
    model.parts.iter().map(of).sum()
}

/// A square with its corner at a distance from [`AT`].
pub(super) fn square(x: f64, y: f64, side: f64) -> Ring {
    let corners = [[0.0, 0.0], [side, 0.0], [side, side], [0.0, side], [0.0, 0.0]];
    corners.map(|[dx, dy]| [AT.x + x + dx, AT.y + y + dy]).to_vec()
}

#[test]
fn holes_are_courts_in_every_format() {
    let hole: Ring = square(2.0, 2.0, 3.0);
    let json = feature(&[square(0.0, 0.0, 10.0), hole.clone()], json!({"height": 2}));
    assert!((volume(&model_of("a.geojson", collection(&[json]).to_string())) - 182.0).abs() < 1e-6);
    // outlines run clockwise, holes against them; the court is the first outline's, though it is written behind the second
    let turned = |ring: Ring| ring.into_iter().rev().collect::<Ring>();
    let rings = vec![turned(square(0.0, 0.0, 10.0)), turned(square(50.0, 0.0, 10.0)), hole];
    let (folder, path) = written("a.shp", shapefile(5, &[rings], 0.0));
    std::fs::write(folder.path().join("a.dbf"), dbase(&["height"], &[&["2"]])).expect("written");
    let model = model_at(&path);
    assert_eq!(model.parts.len(), 1);
    assert!((volume(&model) - 382.0).abs() < 1e-6, "{}", volume(&model));
    assert!(model.notes[0].to_string().contains(".prj"), "{:?}", model.notes);
}

#[test]
fn what_is_no_polygon_is_told() {
    let point = json!({"type": "Feature", "properties": {}, "geometry": {"type": "Point", "coordinates": [1, 2]}});
    let line = json!({"type": "Feature", "properties": null, "geometry": {"type": "LineString", "coordinates": [[1, 2], [3, 4]]}});
    let empty = json!({"type": "Feature", "properties": {"height": 3}, "geometry": null});
    let flat = feature(&[vec![[1.0, 1.0], [2.0, 1.0], [3.0, 1.0], [1.0, 1.0]]], json!({"height": 3}));
    let bow = feature(&[vec![[0.0, 0.0], [4.0, 4.0], [4.0, 0.0], [0.0, 4.0], [0.0, 0.0]]], json!({"height": 3}));
    let many = json!({"type": "Feature", "properties": {"height": 4}, "geometry": {"type": "GeometryCollection", "geometries": [
        {"type": "Point", "coordinates": [1, 2]},
        {"type": "MultiPolygon", "coordinates": [[square(0.0, 0.0, 1.0)], [square(5.0, 0.0, 2.0)]]},
    ]}});
    let model = model_of("a.geojson", collection(&[point, line, empty, flat, bow, many]).to_string());
    assert_eq!(names(&model), ["footprint 6"]);
    assert!((volume(&model) - 20.0).abs() < 1e-6);
    let counts = ["Point", "LineString", "features", "polygons"].map(|what| left_out(&model, what));
    assert_eq!(counts, [2, 1, 1, 2], "{:?}", model.left_out);
    let polygons = model.left_out.iter().filter(|left| left.what == "polygons").map(|left| left.why.as_str());
    assert_eq!(polygons.collect::<Vec<_>>(), ["crosses itself, or runs back on itself", "no area"]);
}

#[test]
fn coordinates_without_a_system_are_degrees_where_they_can_be() {
    let degrees =
        json!({"type": "Polygon", "coordinates": [[[7.0, 50.0], [7.001, 50.0], [7.001, 50.001], [7.0, 50.0]]]});
    let (_folder, path) = written("a.geojson", degrees.to_string());
    let options = ReadOptions { default_height_m: Some(9.0), ..ReadOptions::default() };
    let model = read(&path, &options).expect("a model");
    assert_eq!(model.coordinates, Coordinates::Map("EPSG:4326".into()));
    let mut file = collection(&[feature(&[square(0.0, 0.0, 1.0)], json!({"height": 3}))]);
    file.as_object_mut().expect("an object").remove("crs");
    let model = model_of("a.geojson", file.to_string());
    assert_eq!(model.coordinates, Coordinates::Local);
    assert!(model.notes[0].to_string().contains("crs"), "{:?}", model.notes);
}

#[test]
fn bodies_of_multipatch_stand_as_they_are() {
    let corners = super::block::corners();
    let faces = super::block::faces();
    let mut record = 31_u32.to_le_bytes().to_vec();
    record.extend([0; 32]);
    let rings: Vec<Vec<usize>> = faces.into_iter().map(|(_, ring)| ring).collect();
    let points: Vec<usize> = rings.concat();
    record.extend((rings.len() as u32).to_le_bytes());
    record.extend((points.len() as u32).to_le_bytes());
    let mut first = 0_u32;
    for ring in &rings {
        record.extend(first.to_le_bytes());
        first += ring.len() as u32;
    }
    rings.iter().for_each(|_| record.extend(2_u32.to_le_bytes()));
    for &point in &points {
        let place = corners[point] + AT;
        record.extend(place.x.to_le_bytes());
        record.extend(place.y.to_le_bytes());
    }
    record.extend([0; 16]);
    points.iter().for_each(|&point| record.extend((corners[point].z + AT.z).to_le_bytes()));
    assert_is_block(&model_of("a.shp", shapefile_of(31, vec![record])));
}

#[test]
fn damaged_files_are_said() {
    let cut = fault_of("a.fgb", &flatgeobuf()[..flatgeobuf().len() - 9]);
    assert!(cut.contains("is cut off"), "{cut}");
    let shape = &shapefiles()[0].1;
    assert!(fault_of("a.shp", &shape[..shape.len() - 9]).contains("is cut off"));
    let json = geojson();
    assert!(fault_of("a.geojson", &json[..json.len() - 9]).contains("is cut off"));
    // counts that no file of this size can have
    let mut huge = shape.clone();
    huge[100 + 8 + 40..][..4].copy_from_slice(&u32::MAX.to_le_bytes());
    assert!(fault_of("a.shp", huge).contains("is cut off"));
}

/// A ring on both sides of the meridian of 180° is a house, and not a belt around the Earth; so is a part of it that lies on
/// one side alone.
#[test]
fn a_ring_across_180_degrees_is_a_house() {
    let ring = |west: f64, east: f64| -> Value {
        let corners = [[west, -17.0], [east, -17.0], [east, -16.9998], [west, -16.9998], [west, -17.0]];
        json!({"type": "Polygon", "coordinates": [corners]})
    };
    let feature =
        |geometry: Value, properties: Value| json!({"type": "Feature", "properties": properties, "geometry": geometry});
    let house = feature(ring(179.9999, -179.9999), json!({"height": 10, "building": "yes", "name": "hall"}));
    let west = feature(ring(179.9999, 180.0), json!({"height": 10, "building:part": "yes", "name": "west"}));
    let east = feature(ring(-180.0, -179.9999), json!({"height": 12, "building:part": "yes", "name": "east"}));
    let elsewhere = feature(ring(-0.0001, 0.0001), json!({"height": 5, "building": "yes", "name": "greenwich"}));
    let read = |features: &[&Value]| {
        let text = json!({"type": "FeatureCollection", "features": features}).to_string();
        model_of("a.geojson", text.as_bytes())
    };
    let width = |model: &Model, part: usize| {
        let along = || model.parts[part].positions.iter().map(|corner| corner.x);
        along().fold(f64::NEG_INFINITY, f64::max) - along().fold(f64::INFINITY, f64::min)
    };
    let model = read(&[&house, &elsewhere]);
    assert!((width(&model, 0) - 0.0002).abs() < 1e-9 && (width(&model, 1) - 0.0002).abs() < 1e-9, "{model:?}");
    // parts replace the outline in which they lie
    let parts = read(&[&house, &west, &east]);
    let names: Vec<&str> = parts.parts.iter().map(|part| part.name.as_str()).collect();
    assert_eq!(names, ["west", "east"]);
    // numbers of a map are no degrees
    let mut metres = collection(&[house]);
    metres["features"][0]["geometry"] = ring(100.0, 400.0);
    assert_eq!(width(&model_of("b.geojson", metres.to_string().as_bytes()), 0), 300.0);
}
