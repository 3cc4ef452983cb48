//! PLY, as text and as binary in either byte order.

use super::building::*;
use gnomon::formats::Up;

/// The building as vertices and polygons, with properties that nobody reads among them.
fn building(format: &str, end: &str) -> Vec<u8> {
    let (corners, faces) = indexed(&faces_in(1.0, Up::Z));
    let header = [
        "ply",
        &format!("format {format} 1.0"),
        "comment by a test",
        &format!("element vertex {}", corners.len()),
        "property uchar red",
        "property float x",
        "property double y",
        "property float z",
        &format!("element face {}", faces.len()),
        "property list ushort float texcoord",
        "property list uchar int vertex_indices",
        "end_header",
        "",
    ]
    .join(end);
    let mut bytes = header.into_bytes();
    let mut put = |little: &[u8], text: String| match format {
        "ascii" => bytes.extend(text.into_bytes()),
        "binary_little_endian" => bytes.extend(little),
        _ => bytes.extend(little.iter().rev()),
    };
    for corner in corners {
        put(&[7], "7 ".into());
        put(&(corner.x as f32).to_le_bytes(), format!("{} ", corner.x));
        put(&corner.y.to_le_bytes(), format!("{} ", corner.y));
        put(&(corner.z as f32).to_le_bytes(), format!("{}{end}", corner.z));
    }
    for face in faces {
        put(&2_u16.to_le_bytes(), "2 ".into());
        put(&0.5_f32.to_le_bytes(), "0.5 ".into());
        put(&0.5_f32.to_le_bytes(), "0.5 ".into());
        put(&[face.len() as u8], format!("{} ", face.len()));
        for corner in face {
            put(&(corner as i32).to_le_bytes(), format!("{corner} "));
        }
        put(&[], end.into());
    }
    bytes
}

#[test]
fn the_building_is_read() {
    for format in ["ascii", "binary_little_endian", "binary_big_endian"] {
        for end in ["\n", "\r\n", "\r"] {
            let model = read_bytes("house.ply", &building(format, end));
            assert_is_building(&model);
            assert!(model.up == Up::Z && !model.up_is_said);
            assert_eq!(names(&model), ["house"]);
        }
    }
}

#[test]
fn strips_end_at_minus_one() {
    let header = "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n\
                  element tristrips 1\nproperty list int int vertex_indices\nend_header\n";
    let body = "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n8 0 1 2 3 -1 2 3 4\n";
    let model = read_bytes("m.ply", format!("{header}{body}").as_bytes());
    assert_eq!(triangles(&model).count(), 3);
    assert!(triangles(&model).all(|[a, b, c]| (b - a).cross(c - a).z > 0.0), "all look up");
}

#[test]
fn what_is_wrong_is_told() {
    let whole = building("binary_little_endian", "\n");
    let refused = |bytes: &[u8], words: &[&str]| assert_refused("m.ply", bytes, words);
    refused(&whole[..whole.len() - 1], &["cut off", "8 elements of the kind `face`"]);
    let text = String::from_utf8(building("ascii", "\n")).unwrap();
    refused(text.replace("element vertex 12", "element vertex 4000000000").as_bytes(), &["4000000000 elements"]);
    refused(text.replace("property float x", "property float q").as_bytes(), &["without x, y and z"]);
    refused(text.replace("property float x", "property quad x").as_bytes(), &["`property quad x`"]);
    refused(text.replace("ascii", "morse").as_bytes(), &["morse"]);
    refused(text.replace("end_header", "").as_bytes(), &["header without an end"]);
    refused(text.replace("element face 8", "element face 0").as_bytes(), &["a cloud of 12 points"]);
    refused(text.replacen("6 0 1", "6 0 77", 1).as_bytes(), &["vertex 77, but there are only 12"]);
}

#[test]
fn a_thousand_mutations_are_survived() {
    survive_mutations("house.ply", &building("ascii", "\n"));
    survive_mutations("house.ply", &building("binary_big_endian", "\n"));
}
