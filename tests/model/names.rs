//! Components, and the names by which a site file can refer to them.

use super::*;

/// Two triangles of `wall`, one of material 1, which has no name, one of none, and lines.
fn house() -> Model {
    let mut model = Model::triangle();
    let primitive = |more: Value| {
        let mut primitive = json!({"attributes": {"POSITION": 0}});
        primitive.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
        primitive
    };
    model.json["materials"] = json!([{"name": "wall"}, {}, {"name": "line"}]);
    model.json["meshes"] = json!([{"name": "house", "primitives": [
        primitive(json!({"material": 0})),
        primitive(json!({"material": 1})),
        primitive(json!({"material": 0})),
        primitive(json!({})),
        primitive(json!({"material": 2, "mode": 1})),
    ]}]);
    model
}

fn names(model: &Model) -> Vec<(String, Vec<String>)> {
    model.load().unwrap().into_iter().map(|part| (part.name, part.aliases)).collect()
}

fn named(name: &str, aliases: &[&str]) -> (String, Vec<String>) {
    (name.to_owned(), aliases.iter().map(|alias| alias.to_string()).collect())
}

#[test]
fn a_component_is_a_node_and_a_material() {
    let mut model = house();
    model.json["nodes"] = json!([{"mesh": 0, "name": "north house"}]);
    assert_eq!(
        names(&model),
        [
            named("north house/wall", &["north house", "house", "wall"]),
            named("north house/material 1", &["north house", "house", "material 1"]),
            named("north house/default", &["north house", "house", "default"]),
        ]
    );
    let parts = model.load().unwrap();
    assert_eq!(parts[0].triangles.len(), 2, "primitives of one material are merged");
}

#[test]
fn one_material_needs_no_second_name() {
    let mut model = house();
    model.json["meshes"][0]["primitives"].as_array_mut().unwrap().truncate(1);
    model.json["nodes"] = json!([{"mesh": 0, "name": "shed"}]);
    assert_eq!(names(&model), [named("shed", &["shed", "house", "wall"])]);
}

#[test]
fn unnamed_nodes_are_called_after_their_mesh_or_number() {
    let mut model = Model::triangle();
    model.json["nodes"] = json!([{}, {"mesh": 0, "name": ""}]);
    assert_eq!(names(&model), [named("node 1", &["node 1", "default"])]);
    model.json["meshes"][0]["name"] = json!("roof");
    assert_eq!(names(&model), [named("roof", &["roof", "default"])]);
}

#[test]
fn nodes_of_one_name_stay_apart() {
    let mut model = Model::triangle();
    model.json["nodes"] = json!([{"mesh": 0, "name": "tree"}, {"mesh": 0, "name": "tree"}]);
    let tree = named("tree", &["tree", "default"]);
    assert_eq!(names(&model), [tree.clone(), tree]);
}
