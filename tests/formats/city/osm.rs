//! What OpenStreetMap's keys say about a footprint: its height, and what it is.

use super::block::{AT, left_out, model_of, names, written};
use super::footprints::{collection, feature, square, volume};
use gnomon::formats::{Model, ReadOptions, read};
use gnomon::message::{Field, Message, MessagePart};
use serde_json::{Value, json};

/// One footprint of 1 m² for each of some properties.
pub(super) fn houses(properties: &[Value]) -> Value {
    let each = properties
        .iter()
        .enumerate()
        .map(|(at, properties)| feature(&[square(3.0 * at as f64, 0.0, 1.0)], properties.clone()));
    collection(&each.collect::<Vec<_>>())
}

/// The bottom and the top of the house with these properties; none if it was left out.
fn reach(properties: Value) -> Option<(f64, f64)> {
    let model = model_of("a.geojson", houses(&[properties, json!({"height": 1, "name": "other"})]).to_string());
    let own = model.parts.iter().find(|part| part.name != "other")?;
    let heights = own.positions.iter().map(|corner| corner.z);
    Some(heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), z| (low.min(z), high.max(z))))
}

fn high(properties: Value) -> Option<f64> {
    reach(properties).map(|(_, high)| (high * 1e6).round() / 1e6)
}

#[test]
fn lengths_are_read_as_people_write_them() {
    for (text, metres) in [
        ("12", 12.0),
        ("12 m", 12.0),
        ("12m", 12.0),
        ("12.5", 12.5),
        ("12,5", 12.5),
        (" 7 metres ", 7.0),
        ("40'", 12.192),
        ("40'6\"", 12.3444),
        ("40′6″", 12.3444),
        ("40 ft", 12.192),
        ("1e1", 10.0),
    ] {
        assert_eq!(high(json!({"height": text})), Some(metres), "{text}");
    }
    for text in ["tall", "12 km", "-3", "0", "5000", "12;15", "NaN", "inf", "", "3 cm", "40'13\"", "1,200", "12,500 m"]
    {
        assert_eq!(high(json!({"height": text})), None, "{text}");
    }
    assert_eq!(high(json!({"height": "0,500"})), Some(0.5));
    assert_eq!(high(json!({"height": 8})), Some(8.0));
    assert_eq!(high(json!({"height": null})), None);
}

#[test]
fn heights_come_in_the_stated_order() {
    let all = json!({"height": "9", "building:height": "8", "building:levels": "2"});
    let without = |keys: &[&str]| {
        let mut left = all.clone();
        keys.iter().for_each(|key| drop(left.as_object_mut().expect("properties").remove(*key)));
        high(left)
    };
    assert_eq!(without(&[]), Some(9.0));
    assert_eq!(without(&["height"]), Some(8.0));
    assert_eq!(without(&["height", "building:height"]), Some(6.0));
    assert_eq!(high(json!({"levels": 3})), Some(9.0));
    assert_eq!(high(json!({"building_levels": "2.5"})), Some(7.5));
    // a height that is none does not hide the next
    assert_eq!(high(json!({"height": "high", "building:levels": "2"})), Some(6.0));
    assert_eq!(high(json!({"other_tags": "\"roof:shape\"=>\"flat\",\"building:levels\"=>\"4\""})), Some(12.0));
}

#[test]
fn the_bottom_is_said_in_metres_or_storeys() {
    assert_eq!(reach(json!({"height": 9, "min_height": "4 m"})), Some((4.0, 9.0)));
    assert_eq!(reach(json!({"height": 9, "building:min_level": 2})), Some((6.0, 9.0)));
    assert_eq!(reach(json!({"height": 9, "min_height": 1, "building:min_level": 2})), Some((1.0, 9.0)));
    assert_eq!(reach(json!({"height": 9, "min_height": 9})), None, "nothing is left of it");
}

#[test]
fn guesses_are_told_with_how_many() {
    let texts = |model: &Model| model.notes.iter().map(ToString::to_string).collect::<Vec<_>>();
    let properties = [
        json!({"building:levels": 2}),
        json!({"levels": 2}),
        json!({"height": 3}),
        json!({"name": "low"}),
        json!({"height": "tall"}),
        json!({"height": 3, "min_height": 5}),
    ];
    let file = houses(&properties).to_string();
    let model = model_of("a.geojson", &file);
    let notes = texts(&model);
    assert!(notes[0].contains("no height of 2 footprints") && notes[0].contains("assumed to be 3 m high"), "{notes:?}");
    assert!(
        notes.iter().any(|note| note.contains("1 height (of ") && note.contains(") written otherwise")),
        "{notes:?}"
    );
    assert!(model.notes.iter().any(names_the_field), "{:?}", model.notes);
    assert_eq!(left_out(&model, "footprints"), 3);
    let (_folder, path) = written("a.geojson", &file);
    let options = ReadOptions { default_height_m: Some(11.0), ..ReadOptions::default() };
    let model = read(&path, &options).expect("a model");
    assert_eq!((model.parts.len(), left_out(&model, "footprints")), (5, 1));
    let notes = texts(&model);
    assert!(notes.iter().any(|note| note.contains("2 footprints") && note.contains("11 m")), "{notes:?}");
}

/// Unreadable values are reported, whether or not there is a substitute.
#[test]
fn heights_and_bottoms_that_cannot_be_read_are_told() {
    let notes = |properties: Value| {
        let other = json!({"height": 1, "name": "other"});
        let model = model_of("a.geojson", houses(&[properties, other]).to_string());
        model.notes.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
    };
    for (key, text) in
        [("min_height", "x"), ("min_height", "-2"), ("min_height", "1,200"), ("building:min_level", "2;3")]
    {
        let told = notes(json!({"name": "house", "height": 9, key: text}));
        assert!(told.contains("has 1 bottom (of house) that cannot be read"), "{key} {text}: {told}");
    }
    for (key, text) in [("building:levels", "2;3"), ("building:levels", "3+1"), ("height", "1,200"), ("levels", "0")] {
        let told = notes(json!({"name": "house", key: text}));
        assert!(told.contains("1 height (of house) written otherwise"), "{key} {text}: {told}");
    }
    for (key, text) in [("min_height", "0"), ("building:min_level", "0"), ("building:levels", "2")] {
        assert_eq!(notes(json!({"name": "house", "height": 9, key: text})), "", "{key} {text}");
    }
}

/// Whether a hint names the field for the heights of all models.
fn names_the_field(message: &Message) -> bool {
    message.hint.iter().any(|piece| matches!(piece, MessagePart::Where(Field::DefaultHeight, _)))
}

#[test]
fn a_file_without_heights_is_refused_with_the_field_that_helps() {
    let (_folder, path) = written("a.geojson", houses(&[json!({}), json!({"name": "a"})]).to_string());
    let error = read(&path, &ReadOptions::default()).expect_err("no heights");
    let gnomon::formats::ModelFault::Unusable(message) = error.fault else { panic!("{error}") };
    assert!(names_the_field(&message), "{message:?}");
    assert!(message.to_string().starts_with("has 2 footprints"), "{message}");
}

#[test]
fn parts_replace_an_outline_that_they_cover() {
    let part = |x: f64, y: f64, side: f64, height: f64| {
        feature(&[square(x, y, side)], json!({"building:part": "yes", "height": height}))
    };
    let outline = feature(&[square(0.0, 0.0, 20.0)], json!({"building": "church", "height": 50, "name": "Dom"}));
    let other = feature(&[square(100.0, 0.0, 1.0)], json!({"building": "yes", "height": 1}));
    let quarters = [
        part(0.0, 0.0, 10.0, 50.0),
        part(10.0, 0.0, 10.0, 9.0),
        part(0.0, 10.0, 10.0, 9.0),
        part(10.0, 10.0, 10.0, 9.0),
    ];
    let mut all = vec![outline.clone(), other];
    all.extend(quarters.clone());
    let model = model_of("a.geojson", collection(&all).to_string());
    assert_eq!(left_out(&model, "outlines"), 1);
    assert!((volume(&model) - 7701.0).abs() < 1e-3, "{}", volume(&model));
    assert!(names(&model).contains(&"building 3"), "{:?}", names(&model));
    assert!(model.parts[1].aliases.contains(&"building:part".to_owned()));
    // a quarter is not the whole: both stand, and it is said
    let model = model_of("a.geojson", collection(&[outline.clone(), quarters[0].clone()]).to_string());
    assert_eq!((model.parts.len(), left_out(&model, "outlines")), (2, 0));
    assert!(model.notes.iter().any(|note| note.to_string().contains("only in part")), "{:?}", model.notes);
    // a part without a height does not get the one for all: its building's is known
    let unsaid = feature(&[square(0.0, 0.0, 20.0)], json!({"building:part": "yes"}));
    let (_folder, path) = written("a.geojson", collection(&[outline.clone(), unsaid]).to_string());
    let options = ReadOptions { default_height_m: Some(3.0), ..ReadOptions::default() };
    let model = read(&path, &options).expect("a model");
    assert_eq!((names(&model), left_out(&model, "building:part")), (vec!["Dom"], 1));
    // and parts of another building replace nothing
    let model = model_of("a.geojson", collection(&[outline, part(40.0, 0.0, 20.0, 9.0)]).to_string());
    assert_eq!((model.parts.len(), model.notes.len()), (2, 0));
}

#[test]
fn what_is_no_building_is_left_out_where_buildings_are_told() {
    let properties = [
        json!({"building": "yes", "height": 3, "addr:street": "Weg", "addr:housenumber": "7"}),
        json!({"landuse": "grass"}),
        json!({"building": "no", "height": 3}),
        json!({"man_made": "chimney", "height": 40, "id": "w1"}),
        json!({"building": "garage", "height": 3, "location": "underground"}),
    ];
    let model = model_of("a.geojson", houses(&properties).to_string());
    assert_eq!(names(&model), ["Weg 7", "footprint w1"]);
    assert_eq!(left_out(&model, "features"), 3);
    // where no building is told, all are
    let model = model_of("a.geojson", houses(&[json!({"landuse": "grass", "height": 2})]).to_string());
    assert_eq!(model.parts.len(), 1);
    assert!(model.parts[0].positions.iter().all(|corner| corner.x >= AT.x));
}
