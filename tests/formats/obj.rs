//! Wavefront OBJ and its MTL.

use super::building::*;
use gnomon::formats::{FORMATS, Up};
use std::fmt::Write;

fn building(unit_m: f64, up: Up) -> String {
    let (corners, faces) = indexed(&faces_in(unit_m, up));
    let mut text = String::from("# a building\nmtllib house.mtl\no House\ng shell walls\nusemtl Brick\n");
    for corner in corners {
        writeln!(text, "v {} {} {} 0.5 0.5 0.5", corner.x, corner.y, corner.z).unwrap();
    }
    for face in faces {
        let corners: Vec<String> = face.iter().map(|corner| format!("{}/1/1", corner + 1)).collect();
        writeln!(text, "f {}", corners.join(" ")).unwrap();
    }
    text
}

#[test]
fn the_building_is_read() {
    let model = read_bytes("house.obj", building(1.0, Up::Y).as_bytes());
    assert_is_building(&model);
    assert!(!model.up_is_said && model.unit_m.is_none());
    assert_eq!(names(&model), ["House/shell walls"]);
    assert_eq!(model.parts[0].aliases, ["House/shell walls", "House", "shell walls", "shell", "walls", "Brick"]);
    assert!(model.notes[0].to_string().contains("house.mtl, which cannot be read"), "{:?}", model.notes);
}

#[test]
fn encodings_lines_and_numbers_do_not_matter() {
    let text = building(1.0, Up::Y);
    let utf16 = |unit: fn(u16) -> [u8; 2], mark: bool| {
        let marked = if mark { format!("\u{FEFF}{text}") } else { text.clone() };
        marked.encode_utf16().flat_map(unit).collect::<Vec<u8>>()
    };
    let continued = text.replace("f ", "f \\\r\n  ").replace(" 0.5 0.5 0.5", "");
    let windows = text.replace('\n', "\r\n").replace(' ', "  \t");
    let signed = text.replace(" 15 ", " +1.5e1 ").replace(" 5 ", " 5. ").replace(" 30 ", " .3E+02 ");
    for bytes in [
        utf16(u16::to_le_bytes, true),
        utf16(u16::to_be_bytes, true),
        utf16(u16::to_le_bytes, false),
        utf16(u16::to_be_bytes, false),
        format!("\u{FEFF}{text}").into_bytes(),
        continued.into_bytes(),
        windows.into_bytes(),
        text.replace('\n', "\r").into_bytes(),
        signed.into_bytes(),
    ] {
        assert_is_building(&read_bytes("house.obj", &bytes));
    }
}

#[test]
fn corners_may_be_counted_backwards() {
    let (corners, faces) = indexed(&faces_in(1.0, Up::Y));
    let mut text = String::new();
    for face in faces {
        for &corner in &face {
            writeln!(text, "v {} {} {}", corners[corner].x, corners[corner].y, corners[corner].z).unwrap();
        }
        let back: Vec<String> = (1..=face.len()).rev().map(|back| format!("-{back}")).collect();
        writeln!(text, "f {}", back.join(" ")).unwrap();
    }
    assert_is_building(&read_bytes("house.obj", text.as_bytes()));
}

#[test]
fn a_part_is_a_group_and_a_material_and_glass_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let text = "mtllib all mine.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\ng a\nusemtl Glass\nf 1 2 3\nusemtl Oak\nf 1 3 2\ng b\n\
                f 1 2 3\nusemtl Leaf\ng a\nusemtl Glass\nf 2 3 1\nusemtl Dark\nf 1 2 3\nl 1 2\np 1\nf 1 2\n";
    let library =
        "newmtl Oak\nd 1.0\nTr 0.5\nnewmtl Glass\nTr 0.7\nnewmtl Leaf\nmap_d leaf.png\nnewmtl Dark\nd -halo 0.3\n";
    std::fs::write(folder.path().join("m.obj"), text).unwrap();
    std::fs::write(folder.path().join("all mine.mtl"), library).unwrap();
    let path = folder.path().join("m.obj");
    let model = read(&path);
    assert_eq!(names(&model), ["a/Glass", "a/Oak", "b", "a/Dark"]);
    assert_eq!(model.parts[0].triangles.len(), 2);
    let told: Vec<_> = model.see_through.iter().map(|one| (one.material.as_str(), one.parts.clone())).collect();
    assert_eq!(told, [("Dark", vec![3]), ("Glass", vec![0])]);
    assert_eq!(left_out(&model), ["1 faces", "1 lines", "1 points"]);
    assert!(model.notes.is_empty(), "{:?}", model.notes);
    let obj = FORMATS.iter().find(|format| format.name() == "OBJ").unwrap();
    let named: Vec<_> = obj.named_by(&path).iter().map(|file| file.file_name().unwrap().to_owned()).collect();
    assert!(named.contains(&"all mine.mtl".into()) && named.contains(&"leaf.png".into()), "{named:?}");
}

/// A material library outside the model's folder is not read.
#[test]
fn libraries_elsewhere_are_not_read() {
    let folder = tempfile::tempdir().unwrap();
    let inner = folder.path().join("inner");
    std::fs::create_dir(&inner).unwrap();
    std::fs::write(folder.path().join("out.mtl"), "newmtl Glass\nd 0.1\n").unwrap();
    let absolute = folder.path().join("out.mtl").display().to_string();
    for library in ["../out.mtl", "..\\out.mtl", absolute.as_str()] {
        let text = format!("mtllib {library}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl Glass\nf 1 2 3\n");
        std::fs::write(inner.join("m.obj"), text).unwrap();
        let model = read(&inner.join("m.obj"));
        assert!(model.see_through.is_empty() && model.notes.len() == 1, "{library}");
    }
}

#[test]
fn what_is_wrong_is_told_with_its_line() {
    let refused = |text: &str, words: &[&str]| assert_refused("m.obj", text.as_bytes(), words);
    refused("v 0 0 0\nv 1,5 0 0\n", &["`1,5`", "line 2", "decimal points"]);
    refused("v 0 0\n", &["fewer than three numbers in line 1"]);
    refused("v 0 0 wall\n", &["`wall`", "line 1"]);
    refused("v 0 0 inf\n", &["`inf`"]);
    refused("v 0 0 0\nv 1 0 0\nf 1 2 3\n", &["vertex 3", "there are 2 vertices", "line 3"]);
    for corner in ["0", "-4", "x", "99999999999999999999"] {
        refused(&format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 {corner}\n"), &["line 4", corner]);
    }
    refused("# nothing\n", &["no triangles"]);
    let model = read_bytes("m.obj", b"v 0 0 0\nv 3.1+e2 0 0\nv 0 1 0\nf 1 2 3\n");
    assert!(model.notes[0].to_string().contains("line 2: `3.1+e2`"), "{:?}", model.notes);
}

/// A star that crosses itself has no correct result, and a note says so.
#[test]
fn polygons_that_cross_themselves_are_told() {
    let star = "v 0 0 0\nv 4 4 0\nv 0 4 0\nv 4 0 0\nv 2 6 0\nf 1 2 3 4 5\n";
    let model = read_bytes("star.obj", star.as_bytes());
    assert!(model.notes.iter().any(|note| note.to_string().contains("crosses itself")), "{:?}", model.notes);
    let around: String = (0..4000).map(|corner| format!(" {}", corner % 4 + 1)).collect();
    let started = std::time::Instant::now();
    let round = format!("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf{around}\n");
    assert_eq!(read_bytes("m.obj", round.as_bytes()).notes.len(), 1);
    assert!(started.elapsed().as_secs() < 1, "{:?}", started.elapsed());
    let flat = read_bytes("m.obj", b"v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nv 0 1 0\nf 1 2 3 4\nf 1 2 5\n");
    assert_eq!(left_out(&flat), ["1 faces"]);
}

#[test]
fn a_thousand_mutations_are_survived() {
    survive_mutations("house.obj", building(1.0, Up::Y).as_bytes());
}
