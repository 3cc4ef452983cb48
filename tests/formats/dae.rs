//! Collada.

use super::building::*;
use super::zip::zipped;
use glam::DVec3;
use gnomon::formats::Up;
use std::fmt::Write;

const HEAD: &str = "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n\
                    <!DOCTYPE COLLADA [<!ENTITY a \"aaaaaaaaaa\"><!ENTITY b \"&a;&a;&a;\">]>\n\
                    <COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\">";

const MATERIALS: &str = r##"<library_effects><effect id="e"><profile_COMMON><technique><lambert>
    <transparent opaque="A_ONE"><color>1 1 1 0.4</color></transparent><transparency><float>1</float></transparency>
    </lambert></technique></profile_COMMON></effect></library_effects>
    <library_materials><material id="m1" name="Brick"/><material id="m2" name="Glass &amp; &b;">
    <instance_effect url="#e"/></material></library_materials>"##;

/// A geometry with these faces; the first two as a list of polygons, the others as polygons of their own.
fn geometry(faces: &[Vec<DVec3>]) -> String {
    let (corners, faces) = indexed(faces);
    let numbers: Vec<String> = corners.iter().flat_map(|corner| corner.to_array()).map(|it| it.to_string()).collect();
    let mut text = format!(
        "<library_geometries><geometry id=\"g\" name=\"shell\"><mesh><source id=\"s\"><float_array id=\"a\" count=\"{}\">{}\
         </float_array><technique_common><accessor source=\"#a\" count=\"{}\" stride=\"3\"/></technique_common></source>\
         <vertices id=\"v\"><input semantic=\"POSITION\" source=\"#s\"/></vertices>",
        numbers.len(),
        numbers.join(" "),
        corners.len()
    );
    let inputs = "<input semantic=\"NORMAL\" source=\"#n\" offset=\"0\"/><input semantic=\"VERTEX\" source=\"#v\" offset=\"1\"/>";
    let corners = |face: &[usize]| face.iter().map(|corner| format!("0 {corner} ")).collect::<String>();
    let counts: Vec<String> = faces[..2].iter().map(|face| face.len().to_string()).collect();
    let listed: String = faces[..2].iter().map(|face| corners(face)).collect();
    write!(
        text,
        "<polylist material=\"one\" count=\"2\">{inputs}<vcount>{}</vcount><p>{listed}</p></polylist>",
        counts.join(" ")
    )
    .unwrap();
    write!(text, "<polygons material=\"two\">{inputs}").unwrap();
    for face in &faces[2..] {
        write!(text, "<p>{}</p>", corners(face)).unwrap();
    }
    text + "</polygons></mesh></geometry></library_geometries>"
}

/// A component of a library that is mirrored, turned and moved where it stands, as SketchUp writes them.
fn document(unit: &str, axis: &str, faces: &[Vec<DVec3>], place: &str) -> String {
    let bound = "<bind_material><technique_common><instance_material symbol=\"one\" target=\"#m1\"/>\
                 <instance_material symbol=\"two\" target=\"#m2\"/></technique_common></bind_material>";
    format!(
        "{HEAD}<asset>{unit}{axis}</asset>{MATERIALS}{}<library_nodes><node id=\"c\" name=\"House\">\
         <instance_geometry url=\"#g\">{bound}</instance_geometry></node></library_nodes>\
         <library_visual_scenes><visual_scene id=\"vs\"><node id=\"i\" name=\"instance 1\">{place}<instance_node url=\"#c\"/>\
         </node></visual_scene></library_visual_scenes><scene><instance_visual_scene url=\"#vs\"/></scene></COLLADA>",
        geometry(faces)
    )
}

/// In inches, y up and turned by a quarter.
fn building() -> String {
    let turned = |corner: &DVec3| DVec3::new(-corner.z, corner.y, corner.x) - DVec3::Y * 5.0;
    let faces: Vec<Vec<DVec3>> = faces_in(0.0254, Up::Y).iter().map(|face| face.iter().map(turned).collect()).collect();
    let place = "<translate>0 5 0</translate><rotate>0 1 0 90</rotate>";
    document("<unit name=\"inch\" meter=\"0.0254\"/>", "<up_axis>Y_UP</up_axis>", &faces, place)
}

#[test]
fn the_building_is_read() {
    let model = read_bytes("house.dae", building().as_bytes());
    assert_is_building(&model);
    assert!(model.up == Up::Y && model.up_is_said && model.unit_m == Some(0.0254));
    // no entity is expanded
    assert_eq!(names(&model), ["House/Brick", "House/Glass &amp; &b;"]);
    assert_eq!(model.parts[0].aliases, ["House", "instance 1", "shell", "Brick"]);
    assert_eq!((model.see_through.len(), &model.see_through[0].parts), (1, &vec![1]));
    assert!(model.left_out.is_empty() && model.notes.is_empty());
}

#[test]
fn units_axes_and_matrices_are_the_files_own() {
    // mirrored, and mirrored back by its matrix
    let mirrored: Vec<Vec<DVec3>> = faces_in(0.01, Up::Z)
        .iter()
        .map(|face| face.iter().rev().map(|corner| DVec3::new(-corner.x, corner.y, corner.z - 7.0)).collect())
        .collect();
    let place = "<matrix>-1 0 0 0  0 1 0 0  0 0 1 7  0 0 0 1</matrix>";
    let up = "<up_axis>Z_UP</up_axis>";
    let model = read_bytes("house.dae", document("<unit meter=\"0.01\"/>", up, &mirrored, place).as_bytes());
    assert_is_building(&model);
    assert!(model.up == Up::Z && model.up_is_said);
    // x up: its y points to the left
    let x_up: Vec<Vec<DVec3>> = faces_in(1.0, Up::Y)
        .iter()
        .map(|face| face.iter().map(|corner| DVec3::new(corner.y, -corner.x, corner.z)).collect())
        .collect();
    assert_is_building(&read_bytes("house.dae", document("", "<up_axis>X_UP</up_axis>", &x_up, "").as_bytes()));
    let model = read_bytes("house.dae", document("", "", &faces_in(1.0, Up::Y), "").as_bytes());
    assert_is_building(&model);
    assert!(!model.up_is_said && model.unit_m.is_none() && model.notes.is_empty());
    // a unit without a length is told
    for unit in ["<unit name=\"inch\"/>", "<unit meter=\"0\"/>"] {
        let model = read_bytes("house.dae", document(unit, up, &faces_in(1.0, Up::Z), "").as_bytes());
        assert_is_building(&model);
        let told = model.notes[0].to_string();
        assert!(model.unit_m.is_none() && told.contains(unit) && told.contains("taken as metres"), "{told}");
    }
}

#[test]
fn encodings_do_not_matter() {
    let text = building();
    let utf16: Vec<u8> = format!("\u{FEFF}{text}").encode_utf16().flat_map(u16::to_be_bytes).collect();
    assert_is_building(&read_bytes("house.dae", &utf16));
    assert_is_building(&read_bytes("house.dae", format!("\u{FEFF}{text}").as_bytes()));
    // the content tells the format
    assert_is_building(&read_bytes("house.xml", text.as_bytes()));
}

#[test]
fn strips_fans_and_holes_are_read() {
    let head = document("", "<up_axis>Z_UP</up_axis>", &faces_in(1.0, Up::Z), "");
    let swap = |primitives: &str| {
        let (begin, end) = (head.find("<polylist").unwrap(), head.find("</mesh>").unwrap());
        read_bytes("m.dae", format!("{}{primitives}{}", &head[..begin], &head[end..]).as_bytes())
    };
    let area = |model: &gnomon::formats::Model| -> f64 {
        triangles(model).map(|[a, b, c]| (b - a).cross(c - a).z / 2.0).sum()
    };
    let input = "<input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/>";
    // the top's corners are 0 to 5
    let strip = swap(&format!("<tristrips>{input}<p>0 1 3 2</p><p>0 3 5 4</p></tristrips>"));
    assert_eq!((triangles(&strip).count(), area(&strip)), (4, 150.0));
    let fan = swap(&format!("<trifans>{input}<p>3 4 5 0 1 2</p></trifans>"));
    assert_eq!((triangles(&fan).count(), area(&fan)), (4, 150.0));
    // in the whole rectangle around it, a triangle of 12.5 square metres
    let hole = swap(&format!(
        "<polygons>{input}<ph><p>0 1 2 3 4 5</p><h>0 3 5</h></ph></polygons><lines>{input}<p>0 1</p></lines>"
    ));
    assert_eq!(left_out(&hole), ["1 line sets"]);
    assert!(area(&hole) > 0.0);
}

#[test]
fn what_is_wrong_is_told() {
    let text = building();
    let refused = |text: &str, words: &[&str]| assert_refused("m.dae", text.as_bytes(), words);
    refused(&text[..text.len() - "</COLLADA>".len()], &["cut off"]);
    refused(&text.replace("</technique_common>", "</technique>"), &["damaged XML at byte"]);
    refused(&text.replace("<p>0 0 ", "<p>0 900 "), &["`shell` with vertex 900, but there are only 12"]);
    refused(&text.replace("<p>0 0 ", "<p>0 -1 "), &["`-1`"]);
    refused(&text.replace("<vcount>6", "<vcount>600"), &["fewer corners than it states"]);
    refused("<html/>", &["not Collada", "`html`"]);
    refused(&text.replace("<rotate>0 1 0 90", "<rotate>0 1 90"), &["`House`", "with matrices"]);
    refused(&text.replace("#c\"/>", "#i\"/>"), &["nodes that contain themselves"]);
    let deep = format!("{}{}", "<node>".repeat(200), "</node>".repeat(200));
    refused(&text.replace("<library_nodes>", &format!("<library_nodes>{deep}")), &["nodes nested more than 100 deep"]);
    // each stands for ten of the next
    let many: String = (0..30)
        .map(|at| format!("<node id=\"n{at}\">{}</node>", format!("<instance_node url=\"#n{}\"/>", at + 1).repeat(10)))
        .collect();
    let many = text.replace("<library_nodes>", &format!("<library_nodes>{many}")).replace("#c\"/>", "#n0\"/>");
    refused(&many, &["more nodes than can be placed"]);
    let elsewhere =
        text.replace("</visual_scene>", "<node><instance_node url=\"../other.dae#c\"/></node></visual_scene>");
    assert_eq!(left_out(&read_bytes("m.dae", elsewhere.as_bytes())), ["1 nodes of other files"]);
}

#[test]
fn a_thousand_mutations_are_survived() {
    survive_mutations("house.dae", building().as_bytes());
}

#[test]
fn a_zipped_document_is_the_document() {
    let text = building();
    let alone = zipped(&[("house.dae", text.as_bytes())]);
    // its first entry tells the format, whatever the file is called
    assert_is_building(&read_bytes("house.zip", &alone));
    let manifest = b"<?xml version=\"1.0\"?><dae_root>./models/house.dae#vs</dae_root>";
    let files = [("manifest.xml", &manifest[..]), ("other.dae", b"<COLLADA/>"), ("models/house.dae", text.as_bytes())];
    let model = read_bytes("house.zae", &zipped(&files));
    assert_is_building(&model);
    let notes: Vec<String> = model.notes.iter().map(ToString::to_string).collect();
    assert!(
        notes[0].starts_with("is an archive of several models; models/house.dae is read, not other.dae"),
        "{notes:?}"
    );
    // without a manifest, or with one that names what is not there, the first
    let named = |manifest: &[u8]| {
        let files = [("house.dae", text.as_bytes()), ("manifest.xml", manifest), ("other.dae", &b"<COLLADA/>"[..])];
        assert_is_building(&read_bytes("house.zae", &zipped(&files)));
    };
    named(b"<dae_root>../house.dae</dae_root>");
    named(b"<dae_root>");
    // what stands in another document of the archive is not followed
    let linked = text.replace("url=\"#c\"", "url=\"other.dae#c\"");
    let both = linked.replace("</visual_scene>", "<node><instance_node url=\"#c\"/></node></visual_scene>");
    let model = read_bytes("house.zae", &zipped(&[("house.dae", both.as_bytes()), ("other.dae", text.as_bytes())]));
    assert_eq!(left_out(&model), ["1 nodes of other files"]);
}

#[test]
fn bombs_and_broken_archives_are_refused() {
    let refused = |files: &[(&str, &[u8])], words: &[&str]| assert_refused("house.zae", &zipped(files), words);
    refused(&[("a.dae", &vec![b' '; 200 << 20])], &["more than 100 times as many", "open the .dae within"]);
    refused(&[("a.obj", b"v 0 0 0")], &["no .dae in it", "Collada"]);
    refused(
        &[("manifest.xml", &vec![b' '; 8 << 20]), ("a.dae", building().as_bytes())],
        &["more than 100 times as many"],
    );
    let good = zipped(&[("house.dae", building().as_bytes())]);
    assert_refused("house.zae", &good[..good.len() - 30], &["its directory cannot be read"]);
    survive_mutations("house.zae", &good);
}
