//! IFC: positions and names of shapes, and what is said about everything else.

mod archive;
mod hostile;
pub(super) mod house;
mod place;
#[cfg(unix)]
mod stopped;

use glam::DVec3;
use gnomon::formats::{self, LeftOut, Model, PartKind, ReadOptions, Up};
use gnomon::mesh::Part;
use house::{HEAD, house};

/// What a file of these bytes gives.
fn read_as(name: &str, bytes: &[u8]) -> Result<Model, String> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).expect("written");
    let read = formats::read(&path, &ReadOptions::default());
    read.map_err(|error| error.to_string().replace(&path.display().to_string(), name))
}

/// What a file gives that must be read, its corners in metres.
fn read(text: &str) -> Model {
    let mut model = read_as("house.ifc", text.as_bytes()).expect("read");
    let unit_m = model.unit_m.unwrap_or(1.0);
    model.parts.iter_mut().flat_map(|part| &mut part.positions).for_each(|corner| *corner *= unit_m);
    model
}

/// The part of that name.
fn part<'a>(model: &'a Model, name: &str) -> &'a Part {
    let names: Vec<&str> = model.parts.iter().map(|part| part.name.as_str()).collect();
    model.parts.iter().find(|part| part.name == name).unwrap_or_else(|| panic!("no {name} in {names:?}"))
}

/// The volume of a closed part; negative where it is inside out.
fn volume(part: &Part) -> f64 {
    let from = part.positions[0];
    let corner = |at: u32| part.positions[at as usize] - from;
    let sixfold = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(corner);
        a.cross(b).dot(c)
    };
    part.triangles.iter().map(sixfold).sum::<f64>() / 6.0
}

fn bounds(part: &Part) -> (DVec3, DVec3) {
    let start = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    part.positions.iter().fold(start, |(low, high), &at| (low.min(at), high.max(at)))
}

#[track_caller]
fn lies(part: &Part, low: [f64; 3], high: [f64; 3]) {
    let (is_low, is_high) = bounds(part);
    let apart = (is_low - DVec3::from(low)).abs().max((is_high - DVec3::from(high)).abs()).max_element();
    assert!(apart < 1e-5, "{} lies from {is_low} to {is_high}", part.name);
}

fn notes(model: &Model) -> String {
    model.notes.iter().map(|note| note.to_string()).collect::<Vec<_>>().join("\n")
}

fn left_out<'a>(model: &'a Model, what: &str) -> Option<&'a LeftOut> {
    model.left_out.iter().find(|left| left.what == what)
}

/// As any other format: so that `scale` replaces the file's unit, and does not shrink the model a second time.
#[test]
fn corners_and_steps_are_in_the_unit_of_the_file() {
    let of = |text: &str, scale| {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("house.ifc");
        std::fs::write(&path, text).expect("written");
        formats::read(&path, &ReadOptions { scale, ..ReadOptions::default() }).expect("read")
    };
    let model = of(&house(""), None);
    assert_eq!((model.up, model.up_is_said, model.unit_m), (Up::Z, true, Some(0.001)));
    let (low, high) = bounds(part(&model, "IfcWall/Brick"));
    let apart = (low - DVec3::new(5e3, -3e3, 0.0)).abs().max((high - DVec3::new(15e3, 17e3, 30e3)).abs());
    assert!(apart.max_element() < 0.01, "{low} to {high}");
    assert!(model.parts.iter().all(|part| part.coarse.is_empty()), "steps of some thousandths of a millimetre");
    // whoever takes a millimetre for ten metres has steps of some centimetres
    let large = of(&house(""), Some(10.0));
    let coarse = &part(&large, "IfcWall/Brick").coarse;
    assert!(!coarse.is_empty() && coarse.iter().all(|run| (1e-4..1e-2).contains(&run.step_m)), "{coarse:?}");
    let metres = house("").replace(".MILLI.,.METRE.", "$,.METRE.");
    assert_eq!(of(&metres, None).unit_m, Some(1.0));
}

#[test]
fn shapes_stand_where_the_file_has_them() {
    let model = read(&house(""));
    let block = part(&model, "IfcWall/Brick");
    lies(block, [5.0, -3.0, 0.0], [15.0, 17.0, 30.0]);
    // the L is 10 × 10 and 4 × 10 m; its opening takes a pocket of 2 × 2 × 3
    assert!((volume(block) - (140.0 * 30.0 - 12.0)).abs() < 1e-2, "{}", volume(block));
    // neither mirrored nor turned: the arm is in the north-east, the pocket in the south
    let at = |x: f64, y: f64, z: f64| block.positions.iter().any(|at| at.distance(DVec3::new(x, y, z)) < 1e-5);
    assert!(at(11.0, 17.0, 30.0) && at(11.0, 7.0, 0.0) && !at(5.0, 17.0, 30.0));
    assert!(at(8.0, -1.0, 1.0) && at(10.0, -3.0, 4.0));
    let window = part(&model, "IfcWindow/Glass");
    lies(window, [8.0, -3.0, 1.1], [10.0, -2.9, 4.0]);
    assert!((volume(window) - 2.0 * 0.1 * 2.9).abs() < 1e-6);
}

#[test]
fn parts_are_products_by_material_with_storey_layer_and_name() {
    let model = read(&house(""));
    let names: Vec<&str> = model.parts.iter().map(|part| part.name.as_str()).collect();
    assert_eq!(names, ["IfcSite", "IfcWall/Brick", "IfcWindow/Oak", "IfcWindow/Glass", "IfcColumn/Steel"]);
    let aliases = |name: &str| part(&model, name).aliases.join(", ");
    assert_eq!(aliases("IfcWindow/Glass"), "IfcWindow, Glass, Window 1, Ground floor");
    // a material names what has no style, and the layer is a group
    assert_eq!(aliases("IfcColumn/Steel"), "IfcColumn, Steel, Column 1, Ground floor, Structure");
    assert_eq!(aliases("IfcSite"), "Plot");
    let kinds: Vec<PartKind> = (0..model.parts.len()).map(|part| model.kind(part)).collect();
    assert_eq!(kinds[0], PartKind::GroundCover);
    assert!(kinds[1..].iter().all(|kind| *kind == PartKind::Building));
    let passed: Vec<(&str, &[usize])> =
        model.see_through.iter().map(|it| (it.material.as_str(), it.parts.as_slice())).collect();
    assert_eq!(passed, [("Glass", &[3][..])]);
}

#[test]
fn a_window_without_a_style_is_not_of_glass_by_the_readers_own_colours() {
    let text =
        house("").replace("#212=IFCSTYLEDITEM(#207,(#213),$);", "").replace("#210=IFCSTYLEDITEM", "#210=IFCROOTX");
    let model = read(&text);
    assert!(model.see_through.is_empty(), "{:?}", model.see_through);
    assert_eq!(part(&model, "IfcWindow").triangles.len(), 24);
    // a translucent style without a name has a name nevertheless
    let model = read(&house("").replace("IFCSURFACESTYLE('Glass'", "IFCSURFACESTYLE($"));
    assert_eq!(part(&model, "IfcWindow/translucent").aliases[1], "translucent");
    assert_eq!(model.see_through[0].material, "translucent");
}

#[test]
fn what_does_not_stand_there_is_counted_by_type() {
    let model = read(&house(""));
    let told: Vec<(&str, u64)> = model.left_out.iter().map(|left| (left.what.as_str(), left.count)).collect();
    assert_eq!(told, [("IfcOpeningElement", 1), ("IfcSpace", 1), ("IfcVirtualElement", 1)]);
    assert!(model.left_out.iter().all(|left| left.why == "not built"));
    assert_eq!(notes(&model), "has 4 products with a shape");
}

#[test]
fn products_whose_shape_cannot_be_built_are_told_with_it() {
    let lost = "
#500=IFCCOLUMN('0000000000000000000020',$,'Odd',$,$,#20,#501,$,$);
#501=IFCPRODUCTDEFINITIONSHAPE($,$,(#502));
#502=IFCSHAPEREPRESENTATION(#10,'Body','SweptSolid',(#503));
#503=IFCEXTRUDEDAREASOLID(#504,#6,#7,3000.);
#504=IFCARBITRARYOPENPROFILEDEF(.CURVE.,$,#101);
#510=IFCBEAM('0000000000000000000021',$,'Line',$,$,#20,#511,$,$);
#511=IFCPRODUCTDEFINITIONSHAPE($,$,(#512));
#512=IFCSHAPEREPRESENTATION(#10,'Axis','Curve2D',(#101));
#520=IFCFUTURETHING('0000000000000000000022',$,'New',$,$,#20,#511,$);";
    let model = read(&house(lost));
    let notes = notes(&model);
    let told = "has 4 products with a shape; 2 further products have no geometry (IfcBeam 1, IfcColumn 1)";
    assert!(notes.starts_with(told), "{notes}");
    let why = |what| left_out(&model, what).map(|left| left.why.as_str());
    let shape = "shape that could not be built (IfcExtrudedAreaSolid of IfcArbitraryOpenProfileDef)";
    assert_eq!(why("IfcColumn"), Some(shape));
    assert_eq!(why("IfcBeam"), Some("only lines, boxes or points"));
    assert_eq!(why("IFCFUTURETHING"), Some("of a type that the reader does not know"));
}

#[test]
fn layers_that_are_off_are_left_out_and_told() {
    for (on, frozen) in [(".F.", ".F."), (".T.", ".T."), (".F.", ".U.")] {
        let text = house("").replace("$,.T.,.F.,.F.,());", &format!("$,{on},{frozen},.F.,());"));
        let model = read(&text);
        assert!(model.parts.iter().all(|part| !part.name.starts_with("IfcColumn")));
        let left = left_out(&model, "layer \"Structure\"").expect("told");
        assert_eq!((left.count, left.why.as_str()), (1, "switched off or frozen in the file"));
        assert_eq!(notes(&model), "has 3 products with a shape");
    }
    // a piece of a product, and what lies on a layer that is shown as well
    let off = |what: &str| house(&format!("#700=IFCPRESENTATIONLAYERWITHSTYLE('Off',$,({what}),$,.F.,.F.,.F.,());"));
    let model = read(&off("#207"));
    assert!(model.parts.iter().all(|part| part.name != "IfcWindow/Glass"));
    assert_eq!(left_out(&model, "layer \"Off\"").map(|left| left.count), Some(1));
    assert!(left_out(&read(&off("#405")), "layer \"Off\"").is_none());
    // where everything is off, the error says so
    let all = house("").replace("(#405),$,.T.,.F.,.F.,());", "(#105,#205,#306,#405),$,.F.,.F.,.F.,());");
    let error = read_as("house.ifc", all.as_bytes()).expect_err("nothing stands there");
    let told = ["has no triangles", "layer \"Structure\": switched off or frozen in the file", "1 IfcSpace: not built"];
    assert!(told.iter().all(|told| error.contains(told)), "{error}");
    let unknown = house("").replace("$,.T.,.F.,.F.,());", "$,.U.,.U.,.F.,());");
    assert_eq!(read(&unknown).parts.len(), 5);
}

#[test]
fn shapes_of_the_old_name_appear() {
    let text = house("").replace("#104=IFCPRODUCTDEFINITIONSHAPE", "#104= IFCPRODUCTREPRESENTATION ");
    let model = read(&text.replace("'Block'", "'=IFCPRODUCTREPRESENTATION('"));
    let block = part(&model, "IfcWall/Brick");
    assert!((volume(block) - 4188.0).abs() < 1e-2, "{}", volume(block));
    assert!(block.aliases.contains(&"=IFCPRODUCTREPRESENTATION(".to_owned()), "{:?}", block.aliases);
    assert!(notes(&model).contains("calls shapes IFCPRODUCTREPRESENTATION (1)"), "{}", notes(&model));
}

#[test]
fn a_file_without_a_unit_is_told() {
    let model = read(&house("").replace("IFCUNITASSIGNMENT((#3,#4))", "IFCUNITASSIGNMENT((#4))"));
    assert_eq!(model.unit_m, None);
    lies(part(&model, "IfcWall/Brick"), [5000.0, -3000.0, 0.0], [15000.0, 17000.0, 30000.0]);
    assert!(notes(&model).contains("gives no unit of length, so its numbers are taken as metres"));
}

#[test]
fn far_coordinates_and_a_turned_site_come_back_to_the_millimetre() {
    let near = read(&house(""));
    // 3,500 km from the file's zero, turned a quarter, in a file whose reader takes both away
    let placed = "#20=IFCLOCALPLACEMENT($,#800);\n#800=IFCAXIS2PLACEMENT3D(#801,#7,#802);\n\
        #801=IFCCARTESIANPOINT((690123456.7,3500123456.7,123456.7));\n#802=IFCDIRECTION((0.,1.,0.));";
    let far = read(&house("").replace("#20=IFCLOCALPLACEMENT($,#6);", placed));
    let shift = DVec3::new(690123.4567, 3500123.4567, 123.4567);
    for (near, far) in near.parts.iter().zip(&far.parts) {
        let turned = near.positions.iter().map(|at| DVec3::new(-at.y, at.x, at.z) + shift);
        let turned = Part { positions: turned.collect(), ..near.clone() };
        let ((low, high), (far_low, far_high)) = (bounds(&turned), bounds(far));
        let apart = (low - far_low).abs().max((high - far_high).abs()).max_element();
        assert!(apart < 1e-4, "{} is {apart} m off", near.name);
    }
}

#[test]
fn a_mapped_mirror_is_not_inside_out() {
    let more = "
#900=IFCCOLUMN('0000000000000000000030',$,'Mirrored',$,$,#20,#901,$,$);
#901=IFCPRODUCTDEFINITIONSHAPE($,$,(#902));
#902=IFCSHAPEREPRESENTATION(#10,'Body','MappedRepresentation',(#903));
#903=IFCMAPPEDITEM(#904,#905);
#904=IFCREPRESENTATIONMAP(#6,#105);
#905=IFCCARTESIANTRANSFORMATIONOPERATOR3D(#906,$,#5,1.,$);
#906=IFCDIRECTION((-1.,0.,0.));";
    let model = read(&house(more));
    let mirrored = model.parts.iter().find(|part| part.aliases.contains(&"Mirrored".to_owned())).expect("there");
    lies(mirrored, [-15.0, -3.0, 0.0], [-5.0, 17.0, 30.0]);
    assert!((volume(mirrored) - 4200.0).abs() < 1e-2, "{}", volume(mirrored));
}

#[test]
fn other_steps_and_empty_files_are_refused() {
    let cad = HEAD.replace("IFC4", "AUTOMOTIVE_DESIGN");
    let error = read_as("part.step", cad.as_bytes()).expect_err("no IFC");
    assert!(error.contains("is a STEP or IGES file, which Gnomon does not read"), "{error}");
    let empty = format!("{HEAD}ENDSEC;\nEND-ISO-10303-21;\n");
    let error = read_as("house.ifc", empty.as_bytes()).expect_err("no records");
    assert!(error.contains("has no records that can be read"), "{error}");
    let bare = format!("{HEAD}#1=IFCPROJECT('x',$,$,$,$,$,$,(),$);\nENDSEC;\nEND-ISO-10303-21;\n");
    let error = read_as("house.ifc", bare.as_bytes()).expect_err("no shapes");
    assert!(error.contains("has no triangles"), "{error}");
    let circle = house("").replace("#20=IFCLOCALPLACEMENT($,#6);", "#20=IFCLOCALPLACEMENT(#20,#6);");
    let error = read_as("house.ifc", circle.as_bytes()).expect_err("no shape");
    assert!(error.contains("has no product with a shape; 4 products have no geometry ("), "{error}");
    assert!(error.contains("cannot build these shapes"), "{error}");
    // the content decides, and a mark at its start is none of it
    let marked = format!("\u{feff}{}", house(""));
    assert_eq!(read_as("house.txt", marked.as_bytes()).expect("read").parts.len(), 5);
}

#[test]
fn a_file_that_is_cut_off_is_refused_wherever_it_is_cut() {
    let text = house("");
    let whole = text.trim_end();
    let first = whole.find("#24=").expect("a record");
    let ends = [first, first + 9, whole.len() / 2, whole.rfind("ENDSEC").expect("an end"), whole.len() - 1];
    for end in ends {
        let error = read_as("house.ifc", &whole.as_bytes()[..end]).expect_err("cut off");
        assert!(error.contains("is cut off: its end is missing; copy or export it again"), "{end}: {error}");
    }
    let without = whole.replace("\nENDSEC;\nEND-ISO", "\nEND-ISO");
    assert!(read_as("house.ifc", without.as_bytes()).expect_err("no end of its data").contains("is cut off"));
    // what stands behind the end, or between its words, takes nothing away
    for end in ["ENDSEC; END-ISO-10303-21 ;\r\n\0\x1a", "endsec;\n/* all */\nend-iso-10303-21;/* ; */\n"] {
        let text = whole.replace("ENDSEC;\nEND-ISO-10303-21;", end);
        assert_eq!(read(&text).parts.len(), 5, "{end:?}");
    }
}

#[test]
fn records_that_cannot_be_read_are_counted_with_what_they_mean() {
    let text = house("#99999999999999=IFCWALL('x',$,$,$,$,#20,#104,$,$);\n");
    let notes = notes(&read(&text));
    let told = "has 1 record that cannot be read, so what it describes is missing; export it again";
    assert!(notes.contains(told), "{notes}");
}

#[test]
fn shapes_whose_records_are_missing_are_told_as_that() {
    let lost = |text: &str| read_as("house.ifc", text.as_bytes()).expect_err("nothing to see");
    let bodies = ["105", "205", "306", "405"];
    let record = |id: &str| format!("#{id}=IFCSHAPEREPRESENTATION");
    let without = |text: String, id: &&str| text.replace(&record(id), &record(&format!("9{id}")));
    let missing = lost(&bodies.iter().fold(house(""), without));
    assert!(missing.contains("has no product with a shape; 4 products have no geometry ("), "{missing}");
    assert!(missing.contains("the records of their shapes are missing"), "{missing}");
    let axes = ["(#103)", "(#206,#207)", "(#307)", "(#406)"].iter().fold(house(""), |text, items| {
        ["SweptSolid", "SurfaceModel"]
            .iter()
            .fold(text, |text, kind| text.replace(&format!("'Body','{kind}',{items}"), "'Axis','Curve2D',(#101)"))
    });
    let axes = lost(&axes);
    assert!(axes.contains("only lines, boxes or points"), "{axes}");
}

#[test]
fn what_is_no_ifc_is_told_whatever_it_is_called() {
    let wide: Vec<u8> = "\u{feff}ISO-10303-21;".encode_utf16().flat_map(u16::to_le_bytes).collect();
    let step = HEAD.replace("IFC4", "AUTOMOTIVE_DESIGN");
    for bytes in [b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".as_slice(), b"some text", &wide, step.as_bytes()] {
        let error = read_as("house.ifc", bytes).expect_err("no IFC");
        assert!(error.contains("is no IFC file"), "{error}");
    }
}
