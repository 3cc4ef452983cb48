//! CityJSON and CityJSONSeq.

use super::block::{AT, Body, assert_is_block, difference, fault_of, left_out, model_of, names};
use super::shapes::{building, city, plain_model, solid, surfaces, vertices};
use glam::DVec3;
use gnomon::formats::{Coordinates, PartKind, Up};
use serde_json::{Value, json};

fn read(file: &Value) -> gnomon::formats::Model {
    model_of("a.json", file.to_string())
}

#[test]
fn a_solid_is_a_part_for_each_kind_of_surface() {
    let model = plain_model();
    assert_is_block(&model);
    assert_eq!(names(&model), ["Building b/GroundSurface", "Building b/RoofSurface", "Building b/WallSurface"]);
    assert_eq!(model.parts[1].aliases, ["b", "Building", "RoofSurface"]);
    assert_eq!(model.coordinates, Coordinates::Map("EPSG:25832".into()));
    assert_eq!((model.up, model.up_is_said, model.unit_m), (Up::Z, true, Some(1.0)));
    assert_eq!((model.left_out, model.notes), (vec![], vec![]));
}

#[test]
fn every_type_of_geometry_gives_the_building() {
    let all = surfaces();
    let mut halves = (all.clone(), all.clone());
    halves.0.as_array_mut().expect("faces").truncate(3);
    halves.1.as_array_mut().expect("faces").drain(..3);
    let geometries = [
        json!({"type": "MultiSurface", "lod": 2, "boundaries": all}),
        json!({"type": "CompositeSurface", "lod": "2", "boundaries": all}),
        json!({"type": "Solid", "lod": "1.3", "boundaries": [all]}),
        // an inner shell is one more list
        json!({"type": "Solid", "lod": "1.3", "boundaries": [halves.0, halves.1]}),
        json!({"type": "MultiSolid", "lod": "1.3", "boundaries": [[halves.0], [halves.1]]}),
        json!({"type": "CompositeSolid", "lod": "1.3", "boundaries": [[all]]}),
    ];
    for geometry in geometries {
        let model = read(&city(building(json!([geometry]))));
        assert_is_block(&model);
        assert_eq!(names(&model), ["Building b"]);
    }
}

#[test]
fn the_highest_solid_stands_there_and_the_others_are_told() {
    let flat = json!({"type": "MultiSurface", "lod": "0", "boundaries": [[[0, 1, 2, 3]]]});
    let open = json!({"type": "MultiSurface", "lod": "3", "boundaries": [[[0, 1, 2]]]});
    let low = json!({"type": "Solid", "lod": "1.2", "boundaries": [[[[0, 1, 2]]]]});
    let model = read(&city(building(json!([flat, open, solid("2.2"), low]))));
    assert_is_block(&model);
    assert_eq!(left_out(&model, "geometries"), 3);
    let model = read(&city(building(json!([flat, open]))));
    assert_eq!(model.parts[0].triangles.len(), 1, "without a solid the highest surfaces");
    let model = read(&city(building(json!([flat]))));
    assert!(model.notes[0].to_string().contains("LoD 0"), "{:?}", model.notes);
}

#[test]
fn parts_replace_what_the_building_says_itself() {
    let of = |own: Value, part: Value| {
        read(&city(json!({
            "whole": {"type": "Building", "geometry": [own], "children": ["piece"]},
            "piece": {"type": "BuildingPart", "geometry": [part], "parents": ["whole"], "attributes": {"name": "Nave"}},
        })))
    };
    let model = of(solid("1.2"), solid("2.2"));
    assert_is_block(&model);
    assert_eq!(left_out(&model, "Building"), 1);
    assert_eq!(model.parts[0].aliases, ["piece", "BuildingPart", "whole", "Nave", "GroundSurface"]);
    // parts that are less than their building do not hide it
    let sheet = json!({"type": "MultiSurface", "lod": "0", "boundaries": [[[0, 1, 2]]]});
    assert_eq!(left_out(&of(solid("2.2"), sheet), "Building"), 0);
}

#[test]
fn instances_stand_where_their_matrix_brings_them() {
    // mirrored in x, and moved so that it stands where the building does; the template is mirrored itself
    let mut mirrored = surfaces();
    for face in mirrored.as_array_mut().expect("faces") {
        face[0].as_array_mut().expect("a ring").reverse();
    }
    let corners: Vec<[f64; 3]> = super::block::corners().iter().map(|corner| [-corner.x, corner.y, corner.z]).collect();
    let mut file = city(json!({"t": {"type": "SolitaryVegetationObject", "geometry": [
        {"type": "GeometryInstance", "template": 0, "boundaries": [12],
         "transformationMatrix": [-1, 0, 0, 3, 0, 1, 0, 4, 0, 0, 1, 5, 0, 0, 0, 1]},
        {"type": "GeometryInstance", "template": 9, "boundaries": [12]},
    ]}}));
    file["geometry-templates"] = json!({
        "templates": [{"type": "Solid", "lod": "2", "boundaries": [mirrored]}], "vertices-templates": corners,
    });
    file["vertices"].as_array_mut().expect("vertices").push(json!([-3000, -4000, -5000]));
    let model = read(&file);
    assert_is_block(&model);
    assert_eq!(left_out(&model, "GeometryInstance"), 1);
}

#[test]
fn holes_are_open_in_whatever_plane() {
    // a wall of 10 × 8 m with a window of 2 × 3 m, and a sloped roof with one
    for [wide, high] in [[DVec3::X, DVec3::Z], [DVec3::Y, DVec3::Z], [DVec3::X, DVec3::new(0.0, 0.6, 0.8)]] {
        let at = |x: f64, y: f64| (wide * x + high * y).to_array();
        let outer = [at(0.0, 0.0), at(10.0, 0.0), at(10.0, 8.0), at(0.0, 8.0)];
        let hole = [at(2.0, 2.0), at(2.0, 5.0), at(4.0, 5.0), at(4.0, 2.0)];
        let vertices: Vec<[f64; 3]> = outer.into_iter().chain(hole).collect();
        let face = json!({"type": "MultiSurface", "lod": "2", "boundaries": [[[0, 1, 2, 3], [4, 5, 6, 7]]]});
        let mut file = city(building(json!([face])));
        file["vertices"] = json!(vertices);
        file.as_object_mut().expect("an object").remove("transform");
        let model = read(&file);
        let part = &model.parts[0];
        let area: f64 = part
            .triangles
            .iter()
            .map(|triangle| {
                let [a, b, c] = triangle.map(|corner| part.positions[corner as usize]);
                (b - a).cross(c - a).dot(wide.cross(high)) / 2.0
            })
            .sum();
        assert!((area - 74.0).abs() < 1e-9, "{area}: it faces where the outer ring does, without the hole");
    }
}

#[test]
fn kinds_of_objects_say_what_casts_and_what_does_not_stand_there() {
    let sheet = json!([{"type": "MultiSurface", "lod": "1", "boundaries": [[[0, 1, 2, 3]]]}]);
    let block = json!([{"type": "Solid", "lod": "1", "boundaries": [surfaces()]}]);
    let model = read(&city(json!({
        "water": {"type": "WaterBody", "geometry": sheet}, "road": {"type": "Road", "geometry": sheet},
        "land": {"type": "TINRelief", "geometry": sheet}, "lawn": {"type": "PlantCover", "geometry": sheet},
        "wood": {"type": "PlantCover", "geometry": block}, "kiosk": {"type": "+Kiosk", "geometry": block},
        "room": {"type": "BuildingRoom", "geometry": block},
        "dots": {"type": "CityFurniture", "geometry": [{"type": "MultiPoint", "lod": "1", "boundaries": [0, 1]}]},
    })));
    let kinds: Vec<_> =
        (0..model.parts.len()).map(|part| (model.parts[part].name.as_str(), model.kind(part))).collect();
    let expected = [
        ("Kiosk kiosk", PartKind::Building),
        ("TINRelief land", PartKind::Terrain),
        ("PlantCover lawn", PartKind::GroundCover),
        ("Road road", PartKind::GroundCover),
        ("WaterBody water", PartKind::GroundCover),
        ("PlantCover wood", PartKind::Building),
    ];
    assert_eq!(kinds, expected, "in the order of the file");
    assert_eq!((left_out(&model, "BuildingRoom"), left_out(&model, "MultiPoint")), (1, 1));
}

#[test]
fn closure_surfaces_and_damaged_faces_are_left_out_and_told() {
    let mut shape = solid("2");
    shape["semantics"]["surfaces"][1]["type"] = json!("ClosureSurface");
    shape["boundaries"][0][2] = json!([[0, 1, 999, 6]]);
    shape["boundaries"][0][3] = json!([[1, 1, 1]]);
    let model = read(&city(building(json!([shape]))));
    assert_eq!(left_out(&model, "ClosureSurface"), 1);
    assert_eq!(left_out(&model, "faces"), 2);
    assert_eq!(names(&model), ["Building b/GroundSurface", "Building b/WallSurface"]);
}

#[test]
fn a_sequence_is_as_the_whole_file() {
    let mut first = city(json!({}));
    first["vertices"] = json!([]);
    let feature = |id: &str| {
        json!({
            "type": "CityJSONFeature", "id": id, "vertices": vertices(),
            "CityObjects": {id: {"type": "Building", "geometry": [solid("2.2")]}},
        })
    };
    let one = model_of("a.city.jsonl", format!("{first}\n{}\n", feature("b")));
    assert_is_block(&one);
    let two = model_of("a.city.jsonl", format!("{first}\n{}\n{}\n", feature("b"), feature("c")));
    assert_eq!(two.parts.len(), 6);
    let headless = fault_of("a.city.jsonl", format!("{}\n", feature("b")));
    assert!(headless.contains("CityJSONFeature"), "{headless}");
}

#[test]
fn reference_systems_are_told_in_any_form() {
    let of = |text: &str| {
        let mut file = city(building(json!([solid("2")])));
        file["metadata"]["referenceSystem"] = json!(text);
        read(&file)
    };
    for (text, crs) in [
        ("urn:ogc:def:crs:EPSG::7415", "EPSG:7415"),
        ("https://www.opengis.net/def/crs/EPSG/0/7415", "EPSG:7415"),
        ("urn:ogc:def:crs,crs:EPSG::25832,crs:EPSG::5783", "EPSG:25832"),
        ("EPSG:2056", "EPSG:2056"),
        ("urn:adv:crs:ETRS89_UTM33*DE_DHHN2016_NH", "EPSG:25833"),
    ] {
        let model = of(text);
        assert_eq!((model.coordinates, model.notes.len()), (Coordinates::Map(crs.into()), 0), "{text}");
    }
    let doubted = of("urn:ogc:def:crs:EPSG::31467");
    assert!(doubted.notes[0].to_string().contains("northing"), "{:?}", doubted.notes);
    let mut file = city(building(json!([solid("2")])));
    file.as_object_mut().expect("an object").remove("metadata");
    assert_eq!(read(&file).coordinates, Coordinates::Local);
}

#[test]
fn coarse_steps_are_told_and_fine_ones_are_not() {
    assert!(plain_model().parts.iter().all(|part| part.coarse.is_empty()));
    let mut file = city(building(json!([solid("2")])));
    file["transform"]["scale"] = json!([0.01, 0.01, 0.01]);
    let coarse = read(&file);
    assert!(coarse.parts.iter().all(|part| part.coarse.len() == 1 && part.coarse[0].step_m == 0.01));
    assert!(difference(&coarse, AT).is_err());
    assert!(Body::of(&coarse, AT).is_like(&Body::of(&plain_model(), AT), 10.0));
}

#[test]
fn what_cannot_be_read_is_said_with_the_way_out() {
    let text = city(building(json!([solid("2")]))).to_string();
    let cut = fault_of("a.json", &text[..text.len() / 2]);
    assert!(cut.contains("is cut off"), "{cut}");
    let old = fault_of("a.json", text.replace("\"2.0\"", "\"0.9\""));
    assert!(old.contains("CityJSON 0.9"), "{old}");
    let empty = fault_of("a.json", city(json!({"r": {"type": "BuildingRoom", "geometry": [solid("2")]}})).to_string());
    assert!(empty.contains("1 BuildingRoom"), "{empty}");
    let negative = fault_of("a.json", text.replace("[[[5,4", "[[[-5,4"));
    assert!(negative.contains("line 1"), "{negative}");
}
