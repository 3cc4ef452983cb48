//! Morph targets and skins without animation, as in glTF 2.0, sections 3.7.2.2 and 3.7.3.

use super::*;

/// A tower of 10 × 10 m on the ground, with a height in units.
pub(crate) fn tower(height: f32) -> Model {
    let mut model = Model::new();
    let corner = |i: usize| [(i & 1) as f32 * 10.0 - 5.0, (i >> 2) as f32 * height, (i >> 1 & 1) as f32 * -10.0 + 5.0];
    let positions = model.f32s("VEC3", &(0..8).flat_map(corner).collect::<Vec<_>>());
    let sides: [[u8; 4]; 6] = [[4, 5, 7, 6], [0, 2, 3, 1], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let indices: Vec<u8> = sides.iter().flat_map(|[a, b, c, d]| [*a, *b, *c, *a, *c, *d]).collect();
    let indices = model.accessor("SCALAR", U8, 36, &indices);
    model.json["meshes"] = json!([{"primitives": [{"attributes": {"POSITION": positions}, "indices": indices}]}]);
    model.json["nodes"] = json!([{"mesh": 0, "name": "tower"}]);
    model
}

/// The box around a part: its low and its high corner, to the micrometre.
fn bounds(part: &Part) -> [[f64; 3]; 2] {
    let round = |point: DVec3| point.to_array().map(|value| (value * 1e6).round() / 1e6 + 0.0);
    let low = part.positions.iter().copied().reduce(DVec3::min).unwrap();
    let high = part.positions.iter().copied().reduce(DVec3::max).unwrap();
    [round(low), round(high)]
}

/// The same box of a tower at the origin with this height.
fn standing(height: f64) -> [[f64; 3]; 2] {
    [[-5.0, -5.0, 0.0], [5.0, 5.0, height]]
}

/// A tower of 10 m with a target that raises its top by 20 m, and one that moves it 1 m to the east.
pub(crate) fn morphing() -> Model {
    let mut model = tower(10.0);
    let raise = |i: usize| [0.0, if i > 3 { 20.0 } else { 0.0 }, 0.0];
    let up = model.f32s("VEC3", &(0..8).flat_map(raise).collect::<Vec<_>>());
    let east = model.f32s("VEC3", &(0..8).flat_map(|_| [1.0, 0.0, 0.0]).collect::<Vec<_>>());
    model.primitive()["targets"] = json!([{"POSITION": up}, {"POSITION": east}]);
    model
}

/// A tower whose skin has one joint, node 1, beside its own node.
pub(crate) fn skinned(scale: f32, joint: Value) -> Model {
    let mut model = tower(30.0);
    for number in model.bytes[..96].as_chunks_mut().0 {
        *number = (f32::from_le_bytes(*number) * scale).to_le_bytes();
    }
    let joints = model.accessor("VEC4", U8, 8, &[0; 32]);
    let weights = model.f32s("VEC4", &[1.0, 0.0, 0.0, 0.0].repeat(8));
    let attributes = &mut model.primitive()["attributes"];
    (attributes["JOINTS_0"], attributes["WEIGHTS_0"]) = (json!(joints), json!(weights));
    model.json["nodes"] = json!([{"mesh": 0, "skin": 0, "name": "tower"}, joint]);
    model.json["skins"] = json!([{"joints": [1]}]);
    model
}

#[test]
fn default_weights_morph_a_mesh() {
    let mut model = morphing();
    assert_eq!(bounds(&model.part()), standing(10.0), "without weights all are 0");
    model.json["meshes"][0]["weights"] = json!([1, 0]);
    assert_eq!(bounds(&model.part()), standing(30.0), "those of the mesh");
    model.json["nodes"][0]["weights"] = json!([0.5, -2]);
    assert_eq!(bounds(&model.part()), [[-7.0, -5.0, 0.0], [3.0, 5.0, 20.0]], "those of the node go before");
    model.json["nodes"][0]["weights"] = json!([0, 0]);
    assert_eq!(bounds(&model.part()), standing(10.0));
    let normals_alone = json!([{"NORMAL": 2}, {}]);
    model.json["nodes"][0]["weights"] = json!([1, 1]);
    model.primitive()["targets"] = normals_alone;
    assert_eq!(bounds(&model.part()), standing(10.0), "what says nothing of positions moves none");
}

/// Two nodes of one mesh: each has its own weights.
#[test]
fn weights_are_a_nodes_own() {
    let mut model = morphing();
    model.json["nodes"] = json!([{"mesh": 0, "weights": [1, 0]}, {"mesh": 0}, {"mesh": 0, "weights": [0, 1]}]);
    let parts = model.load().unwrap();
    let found: Vec<_> = parts.iter().map(bounds).collect();
    assert_eq!(found, [standing(30.0), standing(10.0), [[-4.0, -5.0, 0.0], [6.0, 5.0, 10.0]]]);
}

/// Displacements of whole numbers, normalised or not, as KHR_mesh_quantization allows them; and sparse ones.
#[test]
fn morph_targets_may_be_small_or_sparse() {
    let mut model = morphing();
    model.json["meshes"][0]["weights"] = json!([1, 0]);
    let lifted = |lift: [u8; 4]| (0..8).flat_map(|i| if i > 3 { lift } else { [0; 4] }).collect::<Vec<u8>>();
    let bytes = model.accessor("VEC3", I8, 8, &lifted([0, 20, 0, 0]));
    model.json["bufferViews"][4]["byteStride"] = json!(4);
    model.primitive()["targets"][0]["POSITION"] = json!(bytes);
    assert_eq!(bounds(&model.part()), standing(30.0));
    model.json["accessors"][bytes]["normalized"] = json!(true);
    model.json["meshes"][0]["weights"] = json!([127, 0]);
    assert_eq!(bounds(&model.part()), standing(30.0), "20 of 127, 127 times");

    let mut model = morphing();
    model.json["nodes"][0]["weights"] = json!([1]);
    let (at, values) = (model.view(&[4, 5, 6, 7]), model.json["accessors"].as_array().unwrap().len());
    let lifts = model.f32s("VEC3", &[0.0, 20.0, 0.0].repeat(4));
    assert_eq!(lifts, values);
    let lifts = model.json["accessors"][lifts]["bufferView"].clone();
    let sparse = json!({"componentType": F32, "type": "VEC3", "count": 8, "sparse": {
        "count": 4, "indices": {"bufferView": at, "componentType": U8}, "values": {"bufferView": lifts},
    }});
    let sparse = push(&mut model.json["accessors"], sparse);
    model.primitive()["targets"][0]["POSITION"] = json!(sparse);
    assert_eq!(bounds(&model.part()), standing(30.0), "zeros but for four");
}

/// The mesh is in centimetres, and its joint scales by 0.01.
#[test]
fn a_skin_stands_as_its_joints_do() {
    let model = skinned(100.0, json!({"scale": [0.01, 0.01, 0.01]}));
    assert_eq!(bounds(&model.part()), standing(30.0));
    // 3.7.3.3: neither the node's own transform nor that of its parents counts
    let mut model = skinned(1.0, json!({}));
    model.json["nodes"][0]["translation"] = json!([50, 0, 0]);
    push(&mut model.json["nodes"], json!({"children": [0], "translation": [0, 7, 0], "scale": [3, 3, 3]}));
    assert_eq!(bounds(&model.part()), standing(30.0));
    // those of the joint's parents do, also where it does not stand in the scene
    let mut model = skinned(1.0, json!({"translation": [0, 0, -3]}));
    push(&mut model.json["nodes"], json!({"children": [1], "translation": [10, 2, 0]}));
    assert_eq!(bounds(&model.part()), [[5.0, -2.0, 2.0], [15.0, 8.0, 32.0]]);
    model.json["scenes"] = json!([{"nodes": [0]}]);
    assert_eq!(bounds(&model.part()), [[5.0, -2.0, 2.0], [15.0, 8.0, 32.0]]);
}

/// Nothing is bound to the skin, so the mesh stands where its node does, however broken the skin is.
#[test]
fn a_mesh_without_joints_has_no_skin() {
    let mut model = skinned(1.0, json!({"scale": [3, 3, 3]}));
    model.primitive()["attributes"] = json!({"POSITION": 0});
    model.json["nodes"][0]["translation"] = json!([50, 0, 0]);
    model.json["skins"][0]["joints"] = json!([99]);
    assert_eq!(bounds(&model.part()), [[45.0, -5.0, 0.0], [55.0, 5.0, 30.0]]);
}

#[test]
fn a_skin_is_placed_as_its_model_is() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.glb");
    std::fs::write(&path, skinned(100.0, json!({"scale": [0.01, 0.01, 0.01]})).glb()).unwrap();
    let position = DVec3::new(100.0, 200.0, 5.0);
    let part = &load(&path, &Placement { position: Some(position), scale: Some(2.0), ..Placement::default() })
        .unwrap()
        .parts[0];
    assert_eq!(bounds(part), [[90.0, 190.0, 5.0], [110.0, 210.0, 65.0]]);
}

/// A joint 30 m up moves the tower's top; one that was turned after the mesh was bound moves the rest.
#[test]
fn inverse_bind_matrices_and_weights_blend() {
    let mut model = skinned(1.0, json!({"translation": [0, 10, 0]}));
    let down = |by: f32| [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., -by, 0., 1.];
    let bind = model.accessor("MAT4", F32, 1, &down(10.0).iter().flat_map(|n| n.to_le_bytes()).collect::<Vec<_>>());
    model.json["skins"][0]["inverseBindMatrices"] = json!(bind);
    assert_eq!(bounds(&model.part()), standing(30.0), "as it was bound");
    model.json["nodes"][1]["translation"] = json!([0, 14, 0]);
    let lifted = [[-5.0, -5.0, 4.0], [5.0, 5.0, 34.0]];
    assert_eq!(bounds(&model.part()), lifted, "its joint has moved by 4 m");

    // half by each of two joints, in two sets: of u8 and u16, with weights of floats and of u16
    let mut model = skinned(1.0, json!({"translation": [0, 8, 0]}));
    model.json["skins"][0]["joints"] = json!([1, 2]);
    push(&mut model.json["nodes"], json!({}));
    let halves = model.f32s("VEC4", &[0.5, 0.0, 0.0, 0.0].repeat(8));
    let second = model.accessor("VEC4", U16, 8, &[0, 0, 1, 0, 0, 0, 0, 0].repeat(8));
    let others = model.accessor("VEC4", U16, 8, &[0, 0, 0, 128, 0, 0, 0, 0].repeat(8));
    model.json["accessors"][others]["normalized"] = json!(true);
    let attributes = &mut model.primitive()["attributes"];
    attributes["WEIGHTS_0"] = json!(halves);
    (attributes["JOINTS_1"], attributes["WEIGHTS_1"]) = (json!(second), json!(others));
    let [[.., low], [.., high]] = bounds(&model.part());
    // 32768 of 65535 is a little more than a half, and the sum is brought to 1
    assert!((low - 4.0).abs() < 1e-4 && (high - low - 30.0).abs() < 1e-5, "{low} to {high}");
}

#[test]
fn weights_are_brought_to_a_sum_of_1() {
    for weight in [0.25_f32, 1.0, 3.0, 0.0] {
        let mut model = skinned(1.0, json!({"translation": [0, 8, 0]}));
        let weights = model.f32s("VEC4", &[weight, 0.0, 0.0, 0.0].repeat(8));
        model.primitive()["attributes"]["WEIGHTS_0"] = json!(weights);
        assert_eq!(bounds(&model.part()), [[-5.0, -5.0, 8.0], [5.0, 5.0, 38.0]], "{weight}");
    }
}

/// Morphed first, in the mesh's own units, and skinned then.
#[test]
fn a_skin_moves_what_is_morphed() {
    let mut model = skinned(100.0, json!({"scale": [0.01, 0.01, 0.01]}));
    let raise = |i: usize| [0.0, if i > 3 { 1000.0 } else { 0.0 }, 0.0];
    let up = model.f32s("VEC3", &(0..8).flat_map(raise).collect::<Vec<_>>());
    model.primitive()["targets"] = json!([{"POSITION": up}]);
    model.json["meshes"][0]["weights"] = json!([1]);
    assert_eq!(bounds(&model.part()), standing(40.0));
}

/// A joint that mirrors turns no face inside out.
#[test]
fn mirroring_joints_stay_counter_clockwise_from_outside() {
    let volume = |part: &Part| -> f64 {
        let of = |[a, b, c]: [DVec3; 3]| a.dot(b.cross(c)) / 6.0;
        part.triangles.iter().map(|triangle| of(triangle.map(|vertex| part.positions[vertex as usize]))).sum()
    };
    for scale in [[1, 1, 1], [-1, 1, 1], [-1, -1, -1]] {
        let model = skinned(1.0, json!({"scale": scale}));
        assert!((volume(&model.part()) - 3000.0).abs() < 1e-6, "{scale:?}");
    }
}

#[test]
fn targets_that_do_not_fit_are_refused() {
    let with = |change: &dyn Fn(&mut Model)| {
        let mut model = morphing();
        model.json["meshes"][0]["weights"] = json!([1, 0]);
        change(&mut model);
        model
    };
    with(&|model| model.primitive()["targets"][0]["POSITION"] = json!(99))
        .refused(&["morph target of primitive 0 of mesh 0", "accessor 99"]);
    with(&|model| model.primitive()["targets"][0]["POSITION"] = json!(1))
        .refused(&["primitive 0 of mesh 0", "morph target of a type"]);
    let fewer = |model: &mut Model| {
        let few = model.f32s("VEC3", &[0.0; 21]);
        model.primitive()["targets"][0]["POSITION"] = json!(few);
    };
    with(&fewer).refused(&["has a morph target for 7 vertices, but has 8 vertices"]);
    with(&|model| model.json["meshes"][0]["weights"] = json!([1e38, 0])).part();
    let endless = |model: &mut Model| model.bytes[164..168].copy_from_slice(&f32::INFINITY.to_le_bytes());
    let mut model = with(&|_| ());
    let at = model.json["bufferViews"][2]["byteOffset"].as_u64().unwrap() as usize;
    assert_eq!(at, 132, "the target's first number");
    endless(&mut model);
    model.refused(&["vertex 2", "not finite"]);
    // what has no weight is not even looked at
    let mut model = morphing();
    model.primitive()["targets"][0]["POSITION"] = json!(99);
    assert_eq!(bounds(&model.part()), standing(10.0));
}

#[test]
fn skins_without_a_pose_are_refused() {
    let with = |change: &dyn Fn(&mut Model)| {
        let mut model = skinned(1.0, json!({}));
        change(&mut model);
        model
    };
    with(&|model| model.json["nodes"][0]["skin"] = json!(4)).refused(&["node 0", "skin 4", "only 1"]);
    with(&|model| model.json["skins"][0]["joints"] = json!([9])).refused(&["skin 0", "node 9", "only 2"]);
    with(&|model| model.json["skins"][0]["joints"] = json!([])).refused(&["skin 0", "no joints"]);
    with(&|model| model.json["skins"][0]["inverseBindMatrices"] = json!(99)).refused(&["skin 0", "accessor 99"]);
    with(&|model| model.json["skins"][0]["inverseBindMatrices"] = json!(0))
        .refused(&["skin 0", "inverse bind matrices of a type"]);
    let matrices = |numbers: [f32; 16], joints: usize| {
        with(&|model| {
            let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
            let bind = model.accessor("MAT4", F32, 1, &bytes);
            model.json["skins"][0] = json!({"joints": vec![1; joints], "inverseBindMatrices": bind});
        })
    };
    let identity = [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1.];
    matrices(identity, 1).part();
    matrices(identity, 2).refused(&["skin 0", "2 joints, but inverse bind matrices for 1"]);
    matrices([0.0; 16], 1).refused(&["skin 0", "joint 0"]);
    matrices(identity.map(|number| number * f32::NAN), 1).refused(&["skin 0", "joint 0"]);
    with(&|model| model.json["nodes"][1]["rotation"] = json!([0, 0, 0, 0])).refused(&["node 1", "rotation"]);
    with(&|model| model.json["nodes"][1]["children"] = json!([1])).refused(&["node 1", "its own ancestor"]);
}

#[test]
fn joints_that_do_not_fit_are_refused() {
    let with = |change: &dyn Fn(&mut Model)| {
        let mut model = skinned(1.0, json!({}));
        change(&mut model);
        model
    };
    let attribute = |name: &str, value: Value| with(&|model| model.primitive()["attributes"][name] = value.clone());
    attribute("JOINTS_1", json!(2)).refused(&["JOINTS_1 and no WEIGHTS_1"]);
    attribute("JOINTS_0", json!(3)).refused(&["joints or weights of a type"]);
    attribute("WEIGHTS_0", json!(0)).refused(&["joints or weights of a type"]);
    let few = |model: &mut Model| {
        let joints = model.accessor("VEC4", U8, 7, &[0; 28]);
        model.primitive()["attributes"]["JOINTS_0"] = json!(joints);
    };
    with(&few).refused(&["joints for 7 vertices, but has 8 vertices"]);
    let unknown = |weight: f32| {
        with(&|model| {
            let joints = model.accessor("VEC4", U8, 8, &[0, 5, 0, 0].repeat(8));
            let weights = model.f32s("VEC4", &[1.0, weight, 0.0, 0.0].repeat(8));
            let attributes = &mut model.primitive()["attributes"];
            (attributes["JOINTS_0"], attributes["WEIGHTS_0"]) = (json!(joints), json!(weights));
        })
    };
    unknown(0.5).refused(&["the joint 5 at vertex", "but its skin has only 1"]);
    assert_eq!(bounds(&unknown(0.0).part()), standing(30.0), "what has no weight moves nothing");
    let instanced = |model: &mut Model| {
        let shifts = model.f32s("VEC3", &[0.0; 6]);
        let attributes = json!({"attributes": {"TRANSLATION": shifts}});
        model.json["nodes"][0]["extensions"] = json!({"EXT_mesh_gpu_instancing": attributes});
    };
    with(&instanced).refused(&["node 0", "a skin and instances"]);
}

/// A file that needs no memory may still need endless time.
#[test]
fn moves_are_counted_before_they_are_made() {
    let mut model = Model::triangle();
    let count = 1_000_000;
    let zeros = push(&mut model.json["accessors"], json!({"componentType": F32, "type": "VEC3", "count": count}));
    let targets: Value = (0..1001).map(|_| json!({"POSITION": zeros})).collect();
    *model.primitive() = json!({"attributes": {"POSITION": zeros}, "mode": 5, "targets": targets});
    model.json["meshes"][0]["weights"] = json!(vec![1; 1001]);
    model.refused(&["morphs or skins too much", "export it as it stands"]);
}
