//! Notes about footprints name the first of them and count the others.

use super::block::model_of;
use super::osm::houses;
use gnomon::formats::Model;
use serde_json::json;

fn texts(model: &Model) -> Vec<String> {
    model.notes.iter().map(ToString::to_string).collect()
}

#[test]
fn notes_name_the_footprints_that_they_are_about() {
    let storeys = |name: &str| json!({"building": "yes", "building:levels": 2, "name": name});
    let told = |names: &[&str]| {
        let houses = houses(&names.iter().map(|name| storeys(name)).collect::<Vec<_>>());
        texts(&model_of("a.geojson", houses.to_string())).concat()
    };
    assert!(
        told(&["Mill"]).contains("no height of 1 footprint (Mill): a storey is assumed to be 3 m"),
        "{}",
        told(&["Mill"])
    );
    let five = told(&["a", "b", "c", "d", "e"]);
    assert!(five.contains("5 footprints (a, b, c, d and 1 more)"), "{five}");
    let unread =
        model_of("a.geojson", houses(&[json!({"height": 3}), json!({"name": "Dom", "height": "tall"})]).to_string());
    let unread = texts(&unread).concat();
    assert!(unread.contains("has 1 footprint (Dom) without a height, left out"), "{unread}");
    assert!(unread.contains("has 1 height (of Dom) written otherwise"), "{unread}");
}
