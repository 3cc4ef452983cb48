//! What is read, and where it is placed.

use super::*;
use gnomon::formats::Up;
use std::f64::consts::FRAC_PI_2;

const FLAT: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

#[test]
fn y_up_becomes_z_up_and_minus_z_becomes_north() {
    let part = Model::triangle().part();
    assert_eq!(corners(&part), [FLAT]);
    assert_eq!(normal(&part), DVec3::Z);
}

#[test]
fn a_placement_scales_then_turns_then_moves() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.glb");
    std::fs::write(&path, Model::triangle().glb()).unwrap();
    // True north lies 90° clockwise of the model's north, so the model's north points west.
    let placement = Placement {
        north_rad: Some(FRAC_PI_2),
        position: Some(DVec3::new(100.0, 200.0, 5.0)),
        scale: Some(2.0),
        ..Placement::default()
    };
    let parts = load(&path, &placement).unwrap().parts;
    assert_eq!(corners(&parts[0]), [[[100.0, 200.0, 5.0], [100.0, 202.0, 5.0], [98.0, 200.0, 5.0]]]);
    assert!(normal(&parts[0]).z > 0.0);
}

#[test]
fn a_glb_reads_its_binary_chunk_and_skips_others() {
    let model = Model::triangle();
    assert_eq!(corners(&load_bytes("model.glb", &model.glb()).unwrap()[0]), [FLAT]);

    let mut bytes = model.glb();
    bytes.extend(b"\x04\0\0\0MORE1234");
    let length = bytes.len() as u32;
    bytes[8..12].copy_from_slice(&length.to_le_bytes());
    bytes.extend(b"what follows the container is nobody's");
    assert_eq!(corners(&load_bytes("model.glb", &bytes).unwrap()[0]), [FLAT]);
}

#[test]
fn a_byte_order_mark_is_skipped() {
    let text = format!("\u{feff}{}", Model::triangle().gltf());
    assert_eq!(corners(&load_bytes("model.gltf", text.as_bytes()).unwrap()[0]), [FLAT]);
}

#[test]
fn buffers_lie_beside_the_model_under_percent_encoded_names() {
    let folder = tempfile::tempdir().unwrap();
    let mut model = Model::triangle();
    std::fs::create_dir(folder.path().join("data")).unwrap();
    // More bytes than stated do no harm.
    let bytes = [&model.bytes[..], b"and more"].concat();
    std::fs::write(folder.path().join("data/the walls.bin"), bytes).unwrap();
    model.json["buffers"] = json!([{"byteLength": model.bytes.len(), "uri": "./data/the%20walls.bin"}]);
    let path = folder.path().join("model.gltf");
    std::fs::write(&path, model.gltf().to_string()).unwrap();
    assert_eq!(corners(&load_path(&path).unwrap()[0]), [FLAT]);
}

#[test]
fn nodes_move_turn_and_scale_their_children() {
    let mut model = Model::triangle();
    let half = std::f64::consts::FRAC_1_SQRT_2;
    model.json["nodes"] = json!([
        {"mesh": 0, "scale": [2, 2, 2]},
        // A quarter turn about glTF's y is a quarter turn about z here; its length does not matter.
        {"children": [0], "rotation": [0, 3.0 * half, 0, 3.0 * half]},
        {"children": [1], "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 10, 20, -30, 1]},
    ]);
    assert_eq!(corners(&model.part()), [[[10.0, 30.0, 20.0], [10.0, 32.0, 20.0], [8.0, 30.0, 20.0]]]);
}

#[test]
fn transforms_keep_millimetres_at_map_coordinates() {
    let mut model = Model::triangle();
    model.json["nodes"] = json!([{"mesh": 0, "translation": [2_680_000.123, 400.0, -1_250_000.456]}]);
    let [[first, ..]] = corners(&model.part())[..] else { panic!("one triangle") };
    assert_eq!(first, [2_680_000.123, 1_250_000.456, 400.0]);
}

#[test]
fn mirrored_nodes_stay_counter_clockwise_from_outside() {
    for scale in [[-1, 1, 1], [1, 1, -1], [-1, -1, -1]] {
        let mut model = Model::triangle();
        model.json["nodes"] = json!([{"mesh": 0, "scale": scale}]);
        let outward = f64::from(scale[1]);
        assert_eq!(normal(&model.part()), DVec3::Z * outward, "{scale:?}");
    }
}

#[test]
fn the_default_scene_is_read() {
    let mut model = Model::triangle();
    model.json["nodes"] = json!([{"mesh": 0, "name": "a"}, {"mesh": 0, "name": "b"}, {"children": [0]}]);
    let names = |model: &Model| -> Vec<String> { model.load().unwrap().into_iter().map(|part| part.name).collect() };
    assert_eq!(names(&model), ["b", "a"], "all root nodes where there is no scene");
    model.json["scenes"] = json!([{"nodes": [1]}, {"nodes": [2]}, {}]);
    assert_eq!(names(&model), ["b"], "the first where the file names none");
    model.json["scene"] = json!(1);
    assert_eq!(names(&model), ["a"]);
    model.json["scene"] = json!(2);
    model.refused(&["no triangles"]);
}

/// Five points in a zigzag, indexed 0 to 4.
fn zigzag(mode: u32, indices: &[u8]) -> Model {
    let mut model = Model::new();
    let points = [0., 0., 0., 0., 0., -1., 1., 0., 0., 1., 0., -1., 2., 0., 0.];
    let positions = model.f32s("VEC3", &points);
    let indices = model.accessor("SCALAR", U8, indices.len(), indices);
    let primitive = json!({"attributes": {"POSITION": positions}, "indices": indices, "mode": mode});
    model.json["meshes"] = json!([{"primitives": [primitive]}]);
    model.json["nodes"] = json!([{"mesh": 0}]);
    model
}

#[test]
fn triangles_strips_and_fans_are_read() {
    let triangles = zigzag(4, &[0, 2, 1, 1, 2, 3, 0]).part();
    assert_eq!(triangles.triangles, [[0, 1, 2], [2, 1, 3]]);
    assert_eq!(normal(&triangles), DVec3::Z * 2.0);
    // Every other triangle of a strip is turned; one that only joins two strips is left out.
    let strip = zigzag(5, &[1, 0, 3, 2, 4, 4]).part();
    assert_eq!(strip.triangles.len(), 3);
    assert_eq!(normal(&strip), DVec3::Z * 3.0);
    let fan = zigzag(6, &[0, 2, 3, 1]).part();
    assert_eq!(fan.triangles.len(), 2);
    assert_eq!(normal(&fan), DVec3::Z * 2.0);
}

#[test]
fn points_and_lines_cast_nothing() {
    for mode in 0..4 {
        zigzag(mode, &[0, 1, 2, 3]).refused(&["no triangles"]);
    }
    let mut model = zigzag(4, &[0, 2, 1]);
    push(&mut model.json["meshes"][0]["primitives"], json!({"attributes": {}, "mode": 1}));
    assert_eq!(model.part().triangles.len(), 1);
}

#[test]
fn indices_have_one_two_or_four_bytes() {
    for (component, bytes) in
        [(U8, vec![0, 1, 2]), (U16, vec![0, 0, 1, 0, 2, 0]), (U32, vec![0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0])]
    {
        let mut model = Model::triangle();
        let indices = model.accessor("SCALAR", component, 3, &bytes);
        model.primitive()["indices"] = json!(indices);
        assert_eq!(corners(&model.part()), [FLAT], "{component}");
    }
}

#[test]
fn only_the_vertices_in_use_are_kept() {
    let part = zigzag(4, &[2, 4, 3]).part();
    assert_eq!(part.positions.len(), 3);
}

/// Vertices get their numbers in the order in which triangles use them, in long lists as in short ones, whether the list
/// can be cut into blocks or not.
#[test]
fn vertices_are_numbered_as_triangles_use_them() {
    const COUNT: u32 = 90_000;
    // a zigzag of which every seventh vertex is skipped; `tied` joins its ends
    let zigzag =
        || (0..COUNT - 9).filter(|first| first % 7 != 0).map(|first| [first + 8, first + 1, first + 1 + first % 5]);
    let tied = || [[COUNT - 1, 0, 7]].into_iter().chain(zigzag());
    for (triangles, mirror) in [(zigzag().collect::<Vec<_>>(), 1), (tied().collect(), 1), (tied().collect(), -1)] {
        let mut model = Model::new();
        let positions: Vec<f32> = (0..COUNT).flat_map(|at| [at as f32, (at % 11) as f32, 0.0]).collect();
        let positions = model.f32s("VEC3", &positions);
        let bytes: Vec<u8> = triangles.iter().flatten().flat_map(|vertex| vertex.to_le_bytes()).collect();
        let indices = model.accessor("SCALAR", U32, triangles.len() * 3, &bytes);
        model.json["meshes"] = json!([{"primitives": [{"attributes": {"POSITION": positions}, "indices": indices}]}]);
        model.json["nodes"] = json!([{"mesh": 0, "scale": [mirror, 1, 1]}]);

        let part = model.part();
        let (mut number, mut used) = (std::collections::HashMap::new(), Vec::new());
        for (triangle, found) in triangles.iter().zip(&part.triangles) {
            let [a, b, c] = *triangle;
            let expected = if mirror < 0 { [a, c, b] } else { [a, b, c] };
            let expected = expected.map(|vertex| {
                *number.entry(vertex).or_insert_with(|| {
                    used.push(vertex);
                    used.len() as u32 - 1
                })
            });
            assert_eq!(*found, expected, "triangle {triangle:?}");
        }
        assert_eq!(part.triangles.len(), triangles.len());
        let x: Vec<u32> = part.positions.iter().map(|position| position.x.abs() as u32).collect();
        assert!(x == used, "the vertices are others than those in use");
    }
}

#[test]
fn interleaved_vertices_are_read() {
    let mut model = Model::triangle();
    let numbers: [f32; 18] = [0., 0., 0., 9., 9., 9., 1., 0., 0., 9., 9., 9., 0., 0., -1., 9., 9., 9.];
    let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
    let view = model.view(&bytes);
    model.json["bufferViews"][view]["byteStride"] = json!(24);
    model.json["accessors"][0]["bufferView"] = json!(view);
    assert_eq!(corners(&model.part()), [FLAT]);
    // The last element may end before its stride does.
    model.json["bufferViews"][view]["byteLength"] = json!(60);
    assert_eq!(corners(&model.part()), [FLAT]);
}

#[test]
fn sparse_values_stand_for_stored_ones_or_zeros() {
    let mut model = Model::triangle();
    let indices = model.view(&[1, 2]);
    let values: Vec<u8> = [5_f32, 0., 0., 0., 0., -5.].iter().flat_map(|number| number.to_le_bytes()).collect();
    let values = model.view(&values);
    model.json["accessors"][0]["sparse"] = json!({
        "count": 2,
        "indices": {"bufferView": indices, "componentType": U8},
        "values": {"bufferView": values},
    });
    let large = [[[0.0, 0.0, 0.0], [5.0, 0.0, 0.0], [0.0, 5.0, 0.0]]];
    assert_eq!(corners(&model.part()), large);
    model.json["accessors"][0].as_object_mut().unwrap().remove("bufferView");
    assert_eq!(corners(&model.part()), large);
}

#[test]
fn an_accessor_without_a_view_is_zeros() {
    let mut model = Model::triangle();
    model.json["accessors"][0].as_object_mut().unwrap().remove("bufferView");
    assert_eq!(corners(&model.part()), [[[0.0; 3]; 3]]);
}

#[test]
fn quantized_positions_are_read() {
    for (component, normalized, bytes, one) in [
        (I8, false, vec![0, 0, 0, 0, 127, 0, 0, 0, 0, 0, 129, 0], 127.0),
        (I8, true, vec![0, 0, 0, 0, 127, 0, 0, 0, 0, 0, 128, 0], 1.0),
        (I16, true, vec![0, 0, 0, 0, 0, 0, 0, 0, 255, 127, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 128, 0, 0], 1.0),
    ] {
        let mut model = Model::triangle();
        let stride = bytes.len() / 3;
        let positions = model.accessor("VEC3", component, 3, &bytes);
        model.json["bufferViews"][positions]["byteStride"] = json!(stride);
        model.json["accessors"][positions]["normalized"] = json!(normalized);
        model.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
        model.primitive()["attributes"]["POSITION"] = json!(positions);
        assert_eq!(corners(&model.part()), [FLAT.map(|corner| corner.map(|value| value * one))], "{component}");
    }
    for (component, normalized, one) in [(U8, false, 255.0), (U8, true, 1.0), (U16, false, 65535.0), (U16, true, 1.0)] {
        let mut model = Model::triangle();
        let size = if component == U8 { 1 } else { 2 };
        let mut bytes = vec![0; 9 * size];
        bytes[3 * size..4 * size].fill(255); // x of the second
        bytes[7 * size..8 * size].fill(255); // y of the third
        let positions = model.accessor("VEC3", component, 3, &bytes);
        model.json["accessors"][positions]["normalized"] = json!(normalized);
        model.primitive()["attributes"]["POSITION"] = json!(positions);
        let [[_, second, third]] = corners(&model.part())[..] else { panic!("one triangle") };
        assert_eq!((second, third), ([one, 0.0, 0.0], [0.0, 0.0, one]), "{component} {normalized}");
    }
}

#[test]
fn instances_are_copies_in_one_part() {
    let mut model = Model::triangle();
    let translation = model.f32s("VEC3", &[10.0, 0.0, 0.0, 20.0, 0.0, 0.0]);
    // None, and a half turn about y, the axis that points up.
    let rotation = model.accessor("VEC4", I8, 2, &[0, 0, 0, 127, 0, 127, 0, 0]);
    model.json["accessors"][rotation]["normalized"] = json!(true);
    let scale = model.f32s("VEC3", &[1.0, 1.0, 1.0, 2.0, 2.0, -2.0]);
    let attributes = json!({"TRANSLATION": translation, "ROTATION": rotation, "SCALE": scale});
    model.json["nodes"] = json!([{
        "mesh": 0,
        "translation": [0, 3, 0],
        "extensions": {"EXT_mesh_gpu_instancing": {"attributes": attributes}},
    }]);
    model.json["extensionsRequired"] = json!(["EXT_mesh_gpu_instancing"]);
    let part = model.part();
    let first = [[10.0, 0.0, 3.0], [11.0, 0.0, 3.0], [10.0, 1.0, 3.0]];
    let second = [[20.0, 0.0, 3.0], [20.0, 2.0, 3.0], [18.0, 0.0, 3.0]];
    assert_eq!(corners(&part), [first, second]);
    assert_eq!(normal(&part), DVec3::Z * 5.0, "the mirrored copy faces up as well");
}

#[test]
fn what_does_not_cast_may_be_missing_broken_or_unknown() {
    let mut model = Model::triangle();
    model.json["textures"] = json!([{"extensions": {"KHR_texture_basisu": {"source": 7}}}, 3]);
    model.json["images"] = json!([{"uri": "missing.png"}, {}]);
    model.json["samplers"] = json!("broken");
    model.json["cameras"] = json!([{}]);
    model.json["animations"] = json!([{"channels": 1}]);
    model.json["skins"] = json!([{"joints": [99]}]);
    model.json["materials"] = json!([{"name": "wall", "pbrMetallicRoughness": {"baseColorTexture": {"index": 12}}}]);
    model.json["nodes"][0]["skin"] = json!(0);
    model.json["nodes"][0]["camera"] = json!(99);
    model.primitive()["material"] = json!(0);
    model.primitive()["extras"] = json!("a text");
    model.json["extensionsRequired"] =
        json!(["KHR_texture_basisu", "EXT_texture_webp", "KHR_materials_unlit", "KHR_lights_punctual"]);
    assert_eq!(corners(&model.part()), [FLAT]);
}

#[test]
fn a_model_that_is_z_up_has_its_y_in_the_north() {
    let mut model = Model::new();
    let positions = model.f32s("VEC3", &[1.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 3.0]);
    model.json["meshes"] = json!([{"primitives": [{"attributes": {"POSITION": positions}}]}]);
    model.json["nodes"] = json!([{"mesh": 0}]);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.glb");
    std::fs::write(&path, model.glb()).unwrap();
    let placed = |north_rad: f64| {
        let placement =
            Placement { up: Some(Up::Z), north_rad: Some(north_rad), scale: Some(10.0), ..Placement::default() };
        load(&path, &placement).unwrap().parts[0].positions.clone()
    };
    assert_eq!(placed(0.0), [DVec3::X * 10.0, DVec3::Y * 20.0, DVec3::Z * 30.0]);
    // true north lies a quarter clockwise of the model's +y: what was in its north is in the west
    let turned = placed(FRAC_PI_2);
    assert!(turned[1].distance(DVec3::NEG_X * 20.0) < 1e-9 && turned[2].distance(DVec3::Z * 30.0) < 1e-9, "{turned:?}");
}
