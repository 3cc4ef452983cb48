//! Malicious files: no panic, no hang, and no more memory than the size of the file justifies.

use super::*;
use proptest::prelude::*;

/// A small file with most of what is read: indices, instances, a sparse accessor, a tree.
fn rich() -> Model {
    let mut model = Model::triangle();
    let indices = model.accessor("SCALAR", U8, 3, &[0, 1, 2]);
    let shifts = model.f32s("VEC3", &[0.0, 0.0, 0.0, 5.0, 0.0, 0.0]);
    let (at, values) = (model.view(&[1]), model.view(&[0; 12]));
    model.json["accessors"][0]["sparse"] = json!({
        "count": 1,
        "indices": {"bufferView": at, "componentType": U8},
        "values": {"bufferView": values},
    });
    model.primitive()["indices"] = json!(indices);
    let (joints, weights) = (model.accessor("VEC4", U8, 3, &[0; 12]), model.f32s("VEC4", &[0.25; 12]));
    let bind: Vec<u8> = (0..16).flat_map(|at| f32::from(u8::from(at % 5 == 0)).to_le_bytes()).collect();
    let bind = model.accessor("MAT4", F32, 1, &bind);
    let attributes = json!({"POSITION": 0, "JOINTS_0": joints, "WEIGHTS_0": weights});
    let posed = json!({"weights": [0.5], "primitives": [{"attributes": attributes, "targets": [{"POSITION": 0}]}]});
    push(&mut model.json["meshes"], posed);
    model.json["skins"] = json!([{"joints": [1], "inverseBindMatrices": bind}]);
    model.json["scenes"] = json!([{"nodes": [1, 2]}]);
    model.json["nodes"] = json!([
        {"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": shifts}}}},
        {"children": [0, 3], "rotation": [0, 0, 0, 1]},
        {"mesh": 1, "skin": 0, "weights": [1]},
        {"mesh": 1, "skin": 0, "extensions": {"KHR_node_visibility": {"visible": false}}},
    ]);
    model
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, ..ProptestConfig::default() })]

    #[test]
    fn flipped_and_cut_bytes_never_panic(
        flips in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..6),
        cut in prop::option::of(any::<prop::sample::Index>()),
    ) {
        let mut bytes = rich().glb();
        for (at, value) in flips {
            let at = at.index(bytes.len());
            bytes[at] = value;
        }
        if let Some(cut) = cut {
            bytes.truncate(cut.index(bytes.len()));
        }
        if let Ok(parts) = load_bytes("model.glb", &bytes) {
            prop_assert!(!parts.is_empty());
            for part in parts {
                let count = part.positions.len() as u32;
                prop_assert!(part.triangles.iter().flatten().all(|&vertex| vertex < count));
                prop_assert!(part.positions.iter().all(|point| point.is_finite()));
            }
        }
    }

    /// Only digits are changed, which are sizes and indices; so the JSON stays valid and the later checks are reached.
    #[test]
    fn changed_digits_never_panic(changes in prop::collection::vec((any::<prop::sample::Index>(), b'0'..=b'9'), 1..5)) {
        let mut bytes = rich().glb();
        let end = bytes.len() - rich().bytes.len() - 8;
        let digits: Vec<usize> = (20..end).filter(|&at| bytes[at].is_ascii_digit()).collect();
        for (at, digit) in changes {
            bytes[digits[at.index(digits.len())]] = digit;
        }
        let _ = load_bytes("model.glb", &bytes);
    }
}

/// The model can be read before it is damaged.
#[test]
fn a_rich_model_is_read() {
    let parts = rich().load().unwrap();
    assert_eq!(parts.iter().map(|part| part.triangles.len()).collect::<Vec<_>>(), [2, 1]);
}

#[test]
fn a_tree_of_100_000_levels_is_read() {
    let mut model = Model::triangle();
    let last = 100_000;
    let mut nodes: Vec<Value> =
        (0..last).map(|node| json!({"children": [node + 1], "translation": [0, 1, 0]})).collect();
    nodes.push(json!({"mesh": 0}));
    model.json["nodes"] = json!(nodes);
    assert_eq!(model.part().positions[0], DVec3::new(0.0, 0.0, f64::from(last)));

    // each of them a joint
    let (joints, weights) = (model.accessor("VEC4", U8, 3, &[0; 12]), model.f32s("VEC4", &[1.0; 12]));
    let attributes = &mut model.primitive()["attributes"];
    (attributes["JOINTS_0"], attributes["WEIGHTS_0"]) = (json!(joints), json!(weights));
    model.json["skins"] = json!([{"joints": (0..last).rev().collect::<Vec<_>>()}]);
    model.json["nodes"][last as usize]["skin"] = json!(0);
    assert_eq!(model.part().positions[0], DVec3::new(0.0, 0.0, f64::from(last)));
}

#[test]
fn counts_that_the_file_does_not_hold_are_refused() {
    for count in [4_000_000_000_u64, u64::MAX, u64::MAX / 12] {
        let mut model = Model::triangle();
        model.json["accessors"][0]["count"] = json!(count);
        model.refused(&["accessor 0 reads bytes"]);
        model.json["accessors"][0].as_object_mut().unwrap().remove("bufferView");
        model.refused(&["accessor 0", "no bytes to hold them"]);
        let (indices, values) = (model.view(&[0]), model.view(&[0; 12]));
        model.json["accessors"][0]["count"] = json!(3);
        model.json["accessors"][0]["sparse"] = json!({
            "count": count,
            "indices": {"bufferView": indices, "componentType": U8},
            "values": {"bufferView": values},
        });
        model.refused(&["accessor 0 reads bytes"]);
    }
    for (key, holder) in [("byteOffset", "buffer 0"), ("byteLength", "buffer 0"), ("byteStride", "buffer view 0")] {
        let mut model = Model::triangle();
        model.json["accessors"][0]["count"] = json!(4);
        model.json["bufferViews"][0]["byteLength"] = json!(48);
        model.json["bufferViews"][0][key] = json!(u64::MAX);
        model.refused(&["accessor 0 reads bytes", holder]);
    }
}

#[test]
fn triangles_are_counted_before_they_are_made() {
    let mut model = Model::triangle();
    let zeros = json!({"componentType": F32, "type": "VEC3", "count": 1_000_000});
    let zeros = push(&mut model.json["accessors"], zeros);
    model.primitive()["attributes"]["POSITION"] = json!(zeros);
    model.primitive()["mode"] = json!(5);
    model.json["nodes"][0]["extensions"] = json!({"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": zeros}}});
    model.refused(&["more than 100000000 triangles", "less detail"]);
}

#[test]
fn names_that_would_be_copied_everywhere_are_refused() {
    let mut model = Model::triangle();
    model.json["meshes"][0]["name"] = json!("x".repeat(1001));
    model.refused(&["mesh 0", "1001 bytes", "shorten it"]);
}

#[test]
fn many_buffers_in_one_file_cost_it_once() {
    let folder = tempfile::tempdir().unwrap();
    let mut model = Model::triangle();
    std::fs::write(folder.path().join("all.bin"), vec![0; 10_000_000]).unwrap();
    let count = 1000;
    model.json["buffers"] = json!(vec![json!({"byteLength": 10_000_000, "uri": "all.bin"}); count]);
    let view = |buffer: usize| json!({"buffer": buffer, "byteLength": 36});
    let accessor = |view: usize| json!({"bufferView": view, "componentType": F32, "type": "VEC3", "count": 3});
    model.json["bufferViews"] = (0..count).map(view).collect();
    model.json["accessors"] = (0..count).map(accessor).collect();
    let primitives: Value = (0..count).map(|accessor| json!({"attributes": {"POSITION": accessor}})).collect();
    model.json["meshes"] = json!([{"primitives": primitives}]);
    let path = folder.path().join("model.gltf");
    std::fs::write(&path, model.gltf().to_string()).unwrap();
    assert_eq!(load_path(&path).unwrap()[0].triangles.len(), count);
}
