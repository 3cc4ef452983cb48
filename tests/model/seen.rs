//! Visibility: hidden nodes, scenes, materials that let light pass, and the notes about them.

use super::*;
use crate::shared::said;
use gnomon::formats::SceneName;
use gnomon::formats::{Model as Read, ModelError};

fn read(model: &Model, scene: Option<SceneName>) -> Result<Read, ModelError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.glb");
    std::fs::write(&path, model.glb()).unwrap();
    load(&path, &Placement { scene, ..Placement::default() })
}

fn names(read: &Read) -> Vec<&str> {
    read.parts.iter().map(|part| part.name.as_str()).collect()
}

fn hidden(visible: bool) -> Value {
    json!({"KHR_node_visibility": {"visible": visible}})
}

#[test]
fn hidden_nodes_are_not_there() {
    let mut model = Model::triangle();
    model.json["nodes"] = json!([
        {"mesh": 0, "name": "tower"},
        {"mesh": 0, "name": "option B", "extensions": hidden(false)},
    ]);
    for required in [json!(null), json!(["KHR_node_visibility"])] {
        model.json["extensionsRequired"] = required;
        if model.json["extensionsRequired"].is_null() {
            model.json.as_object_mut().unwrap().remove("extensionsRequired");
        }
        let read = read(&model, None).unwrap();
        assert_eq!(names(&read), ["tower"]);
        assert_eq!(
            said(&read.notes),
            ["has 1 node with a mesh that is hidden (KHR_node_visibility) and left out, at \"option B\""]
        );
    }
    model.json["nodes"][1]["extensions"] = hidden(true);
    let read = read(&model, None).unwrap();
    assert_eq!(names(&read), ["tower", "option B"]);
    assert!(read.notes.is_empty());
}

/// A hidden node hides everything below it, even nodes that say they are visible.
#[test]
fn hiding_is_inherited() {
    let mut model = Model::triangle();
    let group = |name: &str, first: usize| json!({"name": name, "children": [first, first + 1]});
    model.json["nodes"] = json!([group("options", 2), group("site", 4), {"mesh": 0}, {"children": [6]},
        {"mesh": 0, "name": "tower"}, {"mesh": 0, "name": "shed", "extensions": hidden(false)},
        {"mesh": 0, "name": "deep", "extensions": hidden(true)}]);
    model.json["nodes"][0]["extensions"] = hidden(false);
    let read = read(&model, None).unwrap();
    assert_eq!(names(&read), ["tower"]);
    let told =
        "has 3 nodes with a mesh that are hidden (KHR_node_visibility) and left out, at \"options\" and \"shed\"";
    assert_eq!(said(&read.notes), [told]);
    model.json["nodes"][1]["extensions"] = hidden(false);
    model.refused(&["no triangles", "hidden (KHR_node_visibility)", "show them, and export the model again"]);
}

#[test]
fn many_names_are_cut_short() {
    let mut model = Model::triangle();
    let nodes = |count: usize| -> Vec<Value> {
        (0..count).map(|node| json!({"mesh": 0, "name": format!("n{node}"), "extensions": hidden(node == 0)})).collect()
    };
    model.json["nodes"] = json!(nodes(6));
    let told = |model: &Model| said(&read(model, None).unwrap().notes)[0].clone();
    assert!(told(&model).ends_with("at \"n1\", \"n2\", \"n3\", \"n4\" and \"n5\""), "{}", told(&model));
    model.json["nodes"] = json!(nodes(9));
    assert!(told(&model).ends_with("at \"n1\", \"n2\", \"n3\", \"n4\" and 4 more"), "{}", told(&model));
}

/// Three scenes of a node each; the second is the default one, and the third has no name.
fn scenes() -> Model {
    let mut model = Model::triangle();
    model.json["nodes"] = json!([{"mesh": 0, "name": "a"}, {"mesh": 0, "name": "b"}, {"mesh": 0, "name": "c"}]);
    model.json["scenes"] =
        json!([{"nodes": [0], "name": "existing"}, {"nodes": [1], "name": "Fac\u{327}ade"}, {"nodes": [2]}]);
    model.json["scene"] = json!(1);
    model
}

#[test]
fn a_scene_is_chosen_by_name_or_number() {
    let name = |name: &str| Some(SceneName::Name(name.to_owned()));
    let number = |number: u64| Some(SceneName::Number(number));
    let model = scenes();
    let chosen = [
        (None, "b"),
        (name("existing"), "a"),
        (name("Fa\u{e7}ade"), "b"),
        (name("Fac\u{327}ade"), "b"),
        (number(0), "a"),
        (number(2), "c"),
    ];
    for (scene, node) in chosen {
        let is_asked = scene.is_some();
        let read = read(&model, scene.clone()).unwrap();
        assert_eq!(names(&read), [node], "{scene:?}");
        assert_eq!(read.notes.is_empty(), is_asked, "who has asked knows it");
    }
    let told = "has 3 scenes, of which \"Fa\u{e7}ade\" (1) is read; `scene` under [[model]] in a site file selects another, by name \
                or number: \"existing\" (0) and 2";
    assert_eq!(said(&read(&model, None).unwrap().notes), [told]);
    let mut one = model;
    one.json["scenes"][0]["name"] = json!(42);
    one.json["scenes"].as_array_mut().unwrap().truncate(1);
    one.json["scene"] = json!(0);
    assert!(read(&one, None).unwrap().notes.is_empty(), "there is no other");
}

#[test]
fn scenes_that_are_not_there_are_refused() {
    let refused = |model: &Model, scene: SceneName, words: &[&str]| {
        let told = read(model, Some(scene)).expect_err("no such scene").to_string();
        words.iter().for_each(|word| assert!(told.contains(word), "'{word}' is missing in: {told}"));
    };
    let all = "\"existing\" (0), \"Fa\u{e7}ade\" (1) and 2";
    refused(&scenes(), SceneName::Name("proposed".into()), &["model.glb", "no scene \"proposed\"", all]);
    refused(&scenes(), SceneName::Number(3), &["no scene 3", all]);
    refused(&Model::triangle(), SceneName::Number(0), &["has no scenes", "leave `scene` out"]);
    let mut twice = scenes();
    twice.json["scenes"][2]["name"] = json!("existing");
    let told = "several scenes \"existing\": \"existing\" (0) and \"existing\" (2); write the number";
    refused(&twice, SceneName::Name("existing".into()), &[told]);
    let mut empty = scenes();
    empty.json["scenes"][1]["nodes"] = json!([]);
    refused(&empty, SceneName::Number(1), &["no triangles in that scene"]);
    empty.refused(&["no triangles in its default scene", "`scene` under [[model]]", "\"existing\" (0) and 2"]);
}

/// Whether light passes the only part, by its material.
fn is_seen_through(material: Value) -> bool {
    let mut model = Model::triangle();
    model.json["materials"] = json!([material]);
    model.primitive()["material"] = json!(0);
    let read = read(&model, None).unwrap();
    assert!(read.see_through.iter().all(|it| it.parts == [0] && it.material == "glass"));
    read.see_through.len() == 1
}

#[test]
fn materials_that_light_passes_are_known() {
    let with = |mode: &str, pbr: Value| json!({"name": "glass", "alphaMode": mode, "pbrMetallicRoughness": pbr});
    let extended = |extension: &str, value: Value| json!({"name": "glass", "alphaMode": "BLEND", "extensions": {extension: value}});
    let (faded, textured) = (json!({"baseColorFactor": [1, 1, 1, 0.4]}), json!({"baseColorTexture": {"index": 7}}));
    for mode in ["BLEND", "MASK"] {
        assert!(is_seen_through(with(mode, faded.clone())), "{mode}, by its factor");
        assert!(is_seen_through(with(mode, textured.clone())), "{mode}, by its texture");
        // many exporters blend everything
        assert!(!is_seen_through(with(mode, json!({"baseColorFactor": [0.2, 0.2, 0.2, 1]}))), "{mode}, and opaque");
        assert!(!is_seen_through(with(mode, Value::Null)), "{mode}, and opaque");
    }
    assert!(!is_seen_through(with("OPAQUE", faded.clone())), "its alpha does not count");
    assert!(!is_seen_through(json!({"name": "glass", "pbrMetallicRoughness": textured})));
    assert!(is_seen_through(extended("KHR_materials_transmission", json!({"transmissionFactor": 0.9}))));
    assert!(!is_seen_through(extended("KHR_materials_transmission", json!({}))), "without a factor it is 0");
    let older = "KHR_materials_pbrSpecularGlossiness";
    assert!(is_seen_through(extended(older, json!({"diffuseFactor": [1, 1, 1, 0.5]}))));
    assert!(!is_seen_through(extended(older, json!({"diffuseFactor": [1, 1, 1, 1]}))));
    // nonsense casts, and is no reason to refuse a model
    assert!(!is_seen_through(json!({"name": "glass", "alphaMode": 7, "pbrMetallicRoughness": [], "extensions": 1})));
}

/// Colours of four numbers have an alpha.
#[test]
fn colours_of_vertices_make_a_material_fade() {
    let mut model = Model::triangle();
    model.json["materials"] = json!([{"name": "leaves", "alphaMode": "BLEND"}]);
    model.primitive()["material"] = json!(0);
    for (kind, faded) in [("VEC3", false), ("VEC4", true)] {
        let colours = model.f32s(kind, &[0.5; 12][..if faded { 12 } else { 9 }]);
        model.primitive()["attributes"]["COLOR_0"] = json!(colours);
        assert_eq!(read(&model, None).unwrap().see_through.len(), usize::from(faded), "{kind}");
    }
}

/// Everything that does not affect shapes may be required, broken or missing.
#[test]
fn harmless_extensions_and_textures_are_read_past() {
    let mut model = Model::triangle();
    let required = ["KHR_texture_basisu", "KHR_materials_unlit", "KHR_lights_punctual", "CESIUM_primitive_outline"];
    model.json["extensionsRequired"] = json!(required);
    model.json["images"] = json!([{"uri": "missing.ktx2"}, {"bufferView": 99}]);
    model.json["textures"] = json!([{"source": 17}]);
    model.json["materials"] =
        json!([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 40}}, "normalTexture": {"index": 9}}]);
    model.primitive()["material"] = json!(0);
    let read = read(&model, None).unwrap();
    assert_eq!(read.parts.len(), 1);
    let told = "requires KHR_texture_basisu, KHR_materials_unlit, KHR_lights_punctual and CESIUM_primitive_outline, which \
                change no shape, and so no shadow";
    assert_eq!(said(&read.notes), [told]);
    model.json["extensionsRequired"] = json!(["KHR_materials_unlit", "AGI_articulations"]);
    model.refused(&["AGI_articulations", "export it without"]);
}

/// Names are in one normal form, however the file composes letters.
#[test]
fn names_are_composed() {
    let mut model = Model::triangle();
    model.json["materials"] = json!([{"name": "be\u{301}ton"}]);
    model.primitive()["material"] = json!(0);
    model.json["meshes"][0]["name"] = json!("mu\u{308}hle");
    model.json["nodes"][0]["name"] = json!("Fac\u{327}ade");
    let part = model.part();
    assert_eq!(part.name, "Fa\u{e7}ade");
    assert_eq!(part.aliases, ["Fa\u{e7}ade", "m\u{fc}hle", "b\u{e9}ton"]);
}
