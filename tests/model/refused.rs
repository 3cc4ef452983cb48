//! What is refused, and whether the error names the cause and a way out.

use super::*;

/// The triangle after one change of its JSON.
fn changed(change: impl Fn(&mut Value)) -> Model {
    let mut model = Model::triangle();
    change(&mut model.json);
    model
}

#[test]
fn what_is_not_gltf_is_refused() {
    assert_refused(
        load_bytes("house.glb", b"o house\nv 0 0 0\n"),
        &["house.glb", "is not glTF", "copy or export it again"],
    );
    assert_refused(load_bytes("empty.glb", b""), &["is not glTF"]);
}

#[test]
fn missing_files_and_folders_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    assert_refused(load_path(folder.path()), &["not a file"]);
    assert_refused(load_path(&folder.path().join("none.glb")), &["none.glb", "cannot be read"]);
}

#[test]
fn damaged_containers_are_refused() {
    let whole = Model::triangle().glb();
    let with = |range: std::ops::Range<usize>, bytes: &[u8]| {
        let mut glb = whole.clone();
        glb[range].copy_from_slice(bytes);
        load_bytes("model.glb", &glb)
    };
    assert_refused(load_bytes("model.glb", &whole[..9]), &["header has 9 of 12 bytes", "cut off"]);
    assert_refused(load_bytes("model.glb", &whole[..whole.len() - 1]), &["states", "cut off"]);
    assert_refused(with(4..8, &1_u32.to_le_bytes()), &["glTF 1.0", "export it as glTF 2.0"]);
    assert_refused(with(8..12, &u32::MAX.to_le_bytes()), &["states 4294967295 bytes"]);
    assert_refused(with(8..12, &3_u32.to_le_bytes()), &["states 3 bytes"]);
    assert_refused(with(8..12, &16_u32.to_le_bytes()), &["chunk's header has 4 of 8 bytes"]);
    assert_refused(with(12..16, &0xffff_u32.to_le_bytes()), &["a chunk states 65535 bytes"]);
    assert_refused(with(16..20, b"BIN\0"), &["first chunk is not JSON"]);
}

#[test]
fn json_that_is_not_gltf_2_is_refused() {
    assert_refused(load_bytes("model.gltf", b"{\"asset\": "), &["JSON is damaged", "line 1"]);
    assert_refused(load_bytes("model.gltf", b"{}"), &["asset"]);
    let old = br#"{"asset": {"version": "1.0"}, "nodes": {}}"#;
    assert_refused(load_bytes("model.gltf", old), &["glTF 1.0", "export it as glTF 2.0"]);
    changed(|json| json["nodes"][0]["mesh"] = json!("house")).refused(&["JSON is damaged"]);
    changed(|json| json["nodes"][0]["mesh"] = json!(-1)).refused(&["JSON is damaged"]);
}

#[test]
fn indices_that_lead_nowhere_are_refused() {
    changed(|json| json["scene"] = json!(3)).refused(&["scene 3", "only 0", "export it again"]);
    changed(|json| json["scenes"] = json!([{"nodes": [9]}])).refused(&["scene 0", "node 9"]);
    changed(|json| json["nodes"][0]["children"] = json!([9])).refused(&["node 0", "node 9"]);
    changed(|json| json["nodes"][0]["mesh"] = json!(9)).refused(&["node 0", "mesh 9"]);
    changed(|json| json["accessors"][0]["bufferView"] = json!(9)).refused(&["accessor 0", "buffer view 9"]);
    changed(|json| json["bufferViews"][0]["buffer"] = json!(9)).refused(&["buffer view 0", "buffer 9"]);
    for (key, what) in [("indices", "accessor 9"), ("material", "material 9")] {
        changed(|json| json["meshes"][0]["primitives"][0][key] = json!(9)).refused(&["primitive 0 of mesh 0", what]);
    }
    changed(|json| json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(9))
        .refused(&["primitive 0 of mesh 0", "accessor 9"]);
}

#[test]
fn ranges_beyond_their_bytes_are_refused() {
    changed(|json| json["accessors"][0]["count"] = json!(4))
        .refused(&["accessor 0 reads bytes 0–48 of buffer view 0, which holds 36", "export it again"]);
    changed(|json| json["accessors"][0]["byteOffset"] = json!(1)).refused(&["bytes 1–37 of buffer view 0"]);
    changed(|json| json["bufferViews"][0]["byteOffset"] = json!(8))
        .refused(&["bytes 8–44 of buffer 0, which holds 36"]);
    changed(|json| json["bufferViews"][0]["byteStride"] = json!(8)).refused(&["accessor 0", "overlap"]);
    changed(|json| json["bufferViews"][0]["byteStride"] = json!(0)).refused(&["accessor 0", "overlap"]);
}

#[test]
fn trees_that_are_none_are_refused() {
    let nodes = |nodes: Value| changed(|json| json["nodes"] = nodes.clone());
    nodes(json!([{"children": [1]}, {"children": [0]}])).refused(&["node 0", "its own ancestor"]);
    nodes(json!([{"children": [0], "mesh": 0}])).refused(&["node 0", "its own ancestor"]);
    nodes(json!([{"children": [2]}, {"children": [2]}, {"mesh": 0}])).refused(&["node 2", "of node 0", "of node 1"]);
    nodes(json!([{"children": [1, 1]}, {"mesh": 0}])).refused(&["node 1", "again"]);
    let scene = |scene: Value| {
        changed(|json| {
            json["nodes"] = json!([{"children": [1]}, {"mesh": 0}]);
            json["scenes"] = json!([{"nodes": scene}]);
        })
    };
    scene(json!([0, 1])).refused(&["node 1", "root of scene 0", "child of node 0"]);
    scene(json!([0, 0])).refused(&["node 0", "listed twice"]);
}

#[test]
fn transforms_without_a_meaning_are_refused() {
    let node = |key: &str, value: Value| changed(|json| json["nodes"][0][key] = value.clone());
    node("rotation", json!([0, 0, 0, 0])).refused(&["node 0", "rotation"]);
    node("matrix", json!([1, 0, 0, 5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1])).refused(&["node 0", "last row"]);
    node("scale", json!([1, 2])).refused(&["JSON is damaged"]);
    changed(|json| {
        json["nodes"] = json!([{"mesh": 0, "scale": [1e300, 1, 1]}, {"children": [0], "scale": [1e300, 1, 1]}])
    })
    .refused(&["node 0", "coordinates that are too large"]);
}

#[test]
fn positions_that_are_missing_or_no_numbers_are_refused() {
    changed(|json| json["meshes"][0]["primitives"][0]["attributes"] = json!({"NORMAL": 0}))
        .refused(&["primitive 0 of mesh 0", "no positions"]);
    changed(|json| json["accessors"][0]["type"] = json!("VEC2")).refused(&["positions of a type"]);
    changed(|json| json["accessors"][0]["componentType"] = json!(U32)).refused(&["positions of a type"]);
    changed(|json| json["accessors"][0]["componentType"] = json!(5124)).refused(&["accessor 0", "type"]);
    changed(|json| json["meshes"][0]["primitives"][0]["mode"] = json!(7)).refused(&["primitive 0", "mode"]);
    for number in [f32::NAN, f32::INFINITY] {
        let mut model = Model::triangle();
        model.bytes[12..16].copy_from_slice(&number.to_le_bytes());
        model.refused(&["vertex 1", "not finite"]);
    }
}

#[test]
fn indices_beyond_the_vertices_are_refused() {
    let with = |component: u32, bytes: &[u8]| {
        let mut model = Model::triangle();
        let indices = model.accessor("SCALAR", component, 3, bytes);
        model.primitive()["indices"] = json!(indices);
        model
    };
    with(U8, &[0, 1, 3]).refused(&["vertex 3 of 3 in triangle 0", "out of range"]);
    with(U8, &[0, 1, 255]).refused(&["vertex 255", "glTF forbids"]);
    with(U16, &[0, 0, 1, 0, 255, 255]).refused(&["vertex 65535", "glTF forbids"]);
    with(I8, &[0, 1, 2]).refused(&["indices of a type"]);
}

#[test]
fn sparse_tables_out_of_order_or_range_are_refused() {
    for indices in [[1, 1], [2, 1], [1, 3]] {
        let mut model = Model::triangle();
        let indices = model.view(&indices);
        let values = model.view(&[0; 24]);
        model.json["accessors"][0]["sparse"] = json!({
            "count": 2,
            "indices": {"bufferView": indices, "componentType": U8},
            "values": {"bufferView": values},
        });
        model.refused(&["accessor 0", "sparse index"]);
    }
}

#[test]
fn damaged_compression_is_refused() {
    let draco = json!({"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {"POSITION": 0}}});
    let mut model = Model::triangle();
    model.primitive()["extensions"] = draco;
    assert_eq!(model.part().triangles.len(), 1, "the plain copy is read");
    model.json["accessors"][0] = json!({"componentType": F32, "type": "VEC3", "count": 4_000_000_000_u64});
    model.refused(&["primitive 0 of mesh 0", "cannot be unpacked", "Draco"]);
    model.primitive()["extensions"]["KHR_draco_mesh_compression"]["bufferView"] = json!(9);
    model.refused(&["primitive 0 of mesh 0 refers to buffer view 9"]);

    let meshopt = json!({"EXT_meshopt_compression": {"buffer": 1}});
    let mut model = changed(|json| json["bufferViews"][0]["extensions"] = meshopt.clone());
    assert_eq!(model.part().triangles.len(), 1, "the plain copy is read");
    let placeholder = json!({"byteLength": 36, "extensions": {"EXT_meshopt_compression": {"fallback": true}}});
    model.json["buffers"] = json!([placeholder]);
    model.refused(&["buffer view 0", "does not say where its bytes are", "meshopt", "without mesh compression"]);
}

#[test]
fn unknown_required_extensions_are_refused() {
    changed(|json| json["extensionsRequired"] = json!(["ACME_curved_walls"]))
        .refused(&["ACME_curved_walls", "export it without"]);
}

#[test]
fn buffers_outside_the_folder_are_refused() {
    let at = |uri: &str| changed(|json| json["buffers"] = json!([{"byteLength": 36, "uri": uri}]));
    for uri in ["../walls.bin", "data/../../walls.bin", "/etc/passwd", "%2e%2e/walls.bin", "%2fetc/x"] {
        at(uri).refused(&["buffer 0", "outside the model's folder"]);
    }
    for uri in ["data\\walls.bin", "..\\walls.bin", "data%5Cwalls.bin"] {
        at(uri).refused(&["buffer 0", "separated by /, not by a backslash"]);
    }
    for uri in
        ["http://example.com/x.bin", "https://example.com/x.bin", "file:///etc/passwd", "//host/x.bin", "C:/x.bin"]
    {
        at(uri).refused(&["buffer 0", "nothing is fetched"]);
    }
    at("missing.bin").refused(&["buffer 0", "missing.bin", "put it beside the model"]);
    at("data:application/octet-stream;base64,@@@@").refused(&["buffer 0", "base64"]);
    at("data:application/octet-stream,abc").refused(&["buffer 0", "not base64"]);
    at("%ff.bin").refused(&["buffer 0", "UTF-8"]);
    changed(|json| json["buffers"] = json!([{"byteLength": 36}])).refused(&["buffer 0", "neither"]);
}

#[test]
fn instances_without_a_meaning_are_refused() {
    let with = |attributes: Value| {
        let mut model = Model::triangle();
        model.f32s("VEC3", &[0.0; 6]);
        model.f32s("VEC3", &[0.0; 3]);
        model.f32s("VEC4", &[0.0; 8]);
        model.json["nodes"][0]["extensions"] = json!({"EXT_mesh_gpu_instancing": {"attributes": attributes}});
        model
    };
    with(json!({})).refused(&["node 0", "without attributes"]);
    with(json!({"TRANSLATION": 9})).refused(&["node 0", "accessor 9"]);
    with(json!({"TRANSLATION": 1, "SCALE": 2})).refused(&["accessor 1", "2 instances"]);
    with(json!({"TRANSLATION": 3})).refused(&["accessor 3", "TRANSLATION"]);
    with(json!({"ROTATION": 3})).refused(&["node 0", "instance 0", "rotation"]);
}
