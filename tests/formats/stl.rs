//! STL, as text and binary.

use super::building::*;
use gnomon::formats::Up;
use std::fmt::Write;

fn text(solids: &[&str]) -> String {
    let triangles = triangles_in(1.0, Up::Z);
    let mut text = String::new();
    for (solid, triangles) in solids.iter().zip(triangles.chunks(triangles.len().div_ceil(solids.len()))) {
        writeln!(text, "solid {solid}").unwrap();
        for corners in triangles {
            text.push_str("  facet normal 0 0 0\n    outer loop\n");
            for corner in corners {
                writeln!(text, "      vertex {:e} {} {}", corner.x, corner.y, corner.z).unwrap();
            }
            text.push_str("    endloop\n  endfacet\n");
        }
        writeln!(text, "endsolid {solid}").unwrap();
    }
    text
}

fn binary(header: &str) -> Vec<u8> {
    let triangles = triangles_in(1.0, Up::Z);
    let mut bytes = format!("{header:80}").into_bytes();
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for corners in triangles {
        bytes.extend([0; 12]);
        let numbers = corners.into_iter().flat_map(|corner| corner.to_array());
        bytes.extend(numbers.flat_map(|number| (number as f32).to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

#[test]
fn the_building_is_read() {
    for (bytes, name) in [
        (text(&["the house"]).into_bytes(), "the house"),
        (text(&[""]).to_uppercase().into_bytes(), "house"),
        (binary("made by a test"), "house"),
        // the size tells that it is no text
        (binary("solid house"), "house"),
    ] {
        let model = read_bytes("house.stl", &bytes);
        assert_is_building(&model);
        assert!(model.up == Up::Z && !model.up_is_said && model.notes.is_empty());
        assert_eq!(names(&model), [name]);
    }
}

#[test]
fn solids_are_parts_and_empty_ones_are_told() {
    let model = read_bytes("two.stl", text(&["north", ""]).as_bytes());
    assert_is_building(&model);
    assert_eq!(names(&model), ["north", "solid 2"]);
    let model = read_bytes("m.stl", format!("{}solid none\nendsolid\n", text(&["house"])).as_bytes());
    assert_eq!((names(&model), left_out(&model)), (vec!["house"], vec!["1 solid".to_owned()]));
}

#[test]
fn what_is_cut_off_is_told() {
    let whole = binary("");
    let refused = |bytes: &[u8], words: &[&str]| assert_refused("m.stl", bytes, words);
    refused(&whole[..whole.len() - 1], &["states 20 triangles, but has 19", "cut off"]);
    refused(b"", &["no STL"]);
    // one that promises fewer than it holds
    let mut fewer = whole.clone();
    fewer[80..84].copy_from_slice(&1_u32.to_le_bytes());
    let model = read_bytes("m.stl", &fewer);
    assert_eq!(triangles(&model).count(), 1);
    let told = model.notes[0].to_string();
    assert!(told.contains("states 1 triangle") && told.contains("950 more bytes, enough for 19 more"), "{told}");
    assert!(read_bytes("m.stl", &[&whole[..], &[0; 49]].concat()).notes.is_empty());
    let text = text(&["house"]);
    let facet = text.rfind("outer").unwrap();
    refused(&text.as_bytes()[..facet], &["is cut off in line"]);
    refused(text.replacen("vertex 5e0", "vertex west", 1).as_bytes(), &["line"]);
    refused(text.replacen("outer loop", "inner loop", 1).as_bytes(), &["line 3"]);
    let end = text.rfind("endsolid").unwrap();
    let model = read_bytes("m.stl", &text.as_bytes()[..end]);
    assert_is_building(&model);
    assert!(model.notes[0].to_string().contains("without `endsolid`"));
}

/// Map coordinates in single precision stand in steps.
#[test]
fn coarse_numbers_are_told() {
    let mut bytes = binary("");
    for triangle in 0..TRIANGLES {
        for corner in 0..3 {
            let at = 84 + 50 * triangle + 12 + 12 * corner;
            let east = f32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) + 2_600_000.0;
            bytes[at..at + 4].copy_from_slice(&east.to_le_bytes());
        }
    }
    let model = read_bytes("m.stl", &bytes);
    assert_eq!(model.parts[0].coarse[0].step_m, 0.25);
    assert!(read_bytes("m.stl", &binary("")).parts[0].coarse.is_empty());
}

#[test]
fn a_thousand_mutations_are_survived() {
    survive_mutations("house.stl", text(&["house"]).as_bytes());
    survive_mutations("house.stl", &binary(""));
}
