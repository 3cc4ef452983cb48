//! Files of programs that are known and not read, and the rules that all formats keep.

use super::building::*;
use gnomon::formats::FORMATS;

#[test]
fn files_of_other_programs_say_how_to_export() {
    for (name, head, words) in [
        ("house.skp", &b"\xFF\xFE\xFF\x0ES\0k\0e\0t\0c\0h\0U\0p\0"[..], &["SketchUp", "File > Export > 3D Model"][..]),
        ("house.3dm", b"3D Geometry File Format        7", &["Rhino", "File > Export Selected"]),
        ("house.rvt", b"\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1", &["Revit", "File > Export > IFC"]),
        ("house.rfa", b"", &["Revit", "File > Export > IFC"]),
        ("house.max", b"\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1", &["3ds Max", "as OBJ"]),
        ("house.pln", b"", &["Archicad", "File > Save As"]),
        ("house.dwg", b"AC1032", &["DWG", "as DXF"]),
        ("house.3ds", b"", &["3DS", "OBJ"]),
        ("house.fbx", b"Kaydara FBX Binary  \0", &["FBX", "File > Import > FBX"]),
        ("house.blend", b"BLENDER-v300", &["Blender", "File > Export > glTF 2.0"]),
        ("house.usdz", b"PK\x03\x04", &["USD", "File > Export > glTF 2.0"]),
        // the content goes before the name
        ("house.obj", b"AC1032", &["DWG"]),
        ("house", b"#usda 1.0", &["USD"]),
    ] {
        assert_refused(name, head, words);
        assert_refused(name, head, &["which Gnomon does not read"]);
    }
    assert_refused("house.txt", b"a house", &["of no format that Gnomon knows", "glTF", "OBJ", "DXF"]);
}

/// Endings lead to one format each, but for those of texts of many formats, which their content tells apart.
#[test]
fn no_ending_is_two_formats_own() {
    let endings = FORMATS.iter().flat_map(|format| format.endings()).copied();
    let mut endings: Vec<&str> = endings.filter(|ending| !["json", "xml"].contains(ending)).collect();
    let count = endings.len();
    endings.sort_unstable();
    endings.dedup();
    assert_eq!(endings.len(), count);
}
