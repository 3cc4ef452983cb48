//! One house, which each format has in its own units, axes and coordinates: the masks of all are equal, cell for cell.

use super::building::indexed;
use glam::{DVec3, dvec3};
use gnomon::crs::{GeodeticPoint, LocalFrame};
use gnomon::mesh::{Mesh, Part};
use gnomon::shadow::ray_cast::RayCast;
use gnomon::shadow::{Scene, Technique};
use gnomon::site::{Overrides, Site};
use gnomon::sun::Position;
use gnomon::view::{Grid, View};
use serde_json::{Value, json};
use std::fmt::Write;

/// The flat part, an L: metres east and north, counter-clockwise.
const PLAN: [[f64; 2]; 6] = [[5.0, 7.0], [15.0, 7.0], [15.0, 17.0], [10.0, 17.0], [10.0, 27.0], [5.0, 27.0]];
const HIGH_M: f64 = 6.0;
/// The wing to the east of it: from where to where it reaches, and its gable, metres north and up, which looks east.
const WING: [f64; 2] = [15.0, 25.0];
const GABLE: [[f64; 2]; 5] = [[7.0, 0.0], [15.0, 0.0], [15.0, 4.0], [11.0, 7.0], [7.0, 4.0]];
/// Of the twin without a gable, for a format whose roofs are flat.
const FLAT: [[f64; 2]; 4] = [[7.0, 0.0], [15.0, 0.0], [15.0, 4.0], [7.0, 4.0]];

const PLACE: [f64; 2] = [49.0, 8.0];
const SUNS: [[f64; 2]; 3] = [[97.3, 23.1], [181.7, 48.9], [241.3, 17.7]];
const GRID: Grid = Grid { west: -30.13, north: 60.07, cell: 0.413, width: 200, height: 190 };

/// Faces seen from outside counter-clockwise; metres, east, north and up.
type Solid = Vec<Vec<DVec3>>;

/// A prism over an outline that is counter-clockwise seen against the way that it is drawn out.
fn prism(outline: &[DVec3], way: DVec3) -> Solid {
    let end: Vec<DVec3> = outline.iter().map(|corner| *corner + way).collect();
    let side = |at: usize| {
        let next = (at + 1) % outline.len();
        vec![outline[at], outline[next], end[next], end[at]]
    };
    let mut faces: Solid = (0..outline.len()).map(side).collect();
    faces.push(outline.iter().rev().copied().collect());
    faces.push(end);
    faces
}

/// The two parts of the house.
fn solids(gable: &[[f64; 2]]) -> [Solid; 2] {
    let plan: Vec<DVec3> = PLAN.iter().map(|[x, y]| dvec3(*x, *y, 0.0)).collect();
    let wing: Vec<DVec3> = gable.iter().map(|[y, z]| dvec3(WING[0], *y, *z)).collect();
    [prism(&plan, DVec3::Z * HIGH_M), prism(&wing, DVec3::X * (WING[1] - WING[0]))]
}

/// A face as triangles: a fan around a corner that sees all others.
fn fan(face: &[DVec3]) -> Vec<[DVec3; 3]> {
    let normal: DVec3 = (1..face.len() - 1).map(|at| (face[at] - face[0]).cross(face[at + 1] - face[0])).sum();
    let around = |start: usize| {
        let corner = |at: usize| face[(start + at) % face.len()];
        (1..face.len() - 1).map(|at| [corner(0), corner(at), corner(at + 1)]).collect::<Vec<_>>()
    };
    let sees_all = |fan: &Vec<[DVec3; 3]>| fan.iter().all(|[a, b, c]| (*b - *a).cross(*c - *a).dot(normal) > 0.0);
    (0..face.len()).map(around).find(sees_all).expect("a corner that sees all")
}

/// The faces of both parts, in other units and axes.
fn faces(gable: &[[f64; 2]], to_file: impl Fn(DVec3) -> DVec3) -> Solid {
    let faces = solids(gable).into_iter().flatten();
    faces.map(|face| face.into_iter().map(&to_file).collect()).collect()
}

fn obj(gable: &[[f64; 2]], to_file: impl Fn(DVec3) -> DVec3) -> String {
    let (corners, faces) = indexed(&faces(gable, to_file));
    let mut text = String::new();
    corners.iter().for_each(|at| writeln!(text, "v {} {} {}", at.x, at.y, at.z).unwrap());
    for face in faces {
        let numbers: Vec<String> = face.iter().map(|corner| (corner + 1).to_string()).collect();
        writeln!(text, "f {}", numbers.join(" ")).unwrap();
    }
    text
}

fn stl(to_file: impl Fn(DVec3) -> DVec3) -> String {
    let mut text = "solid house\n".to_owned();
    for triangle in faces(&GABLE, to_file).iter().flat_map(|face| fan(face)) {
        text.push_str("facet normal 0 0 0\nouter loop\n");
        triangle.iter().for_each(|at| writeln!(text, "vertex {} {} {}", at.x, at.y, at.z).unwrap());
        text.push_str("endloop\nendfacet\n");
    }
    text + "endsolid house\n"
}

fn ply(to_file: impl Fn(DVec3) -> DVec3) -> String {
    let (corners, faces) = indexed(&faces(&GABLE, to_file));
    let mut text = format!(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\n\
         element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        corners.len(),
        faces.len()
    );
    corners.iter().for_each(|at| writeln!(text, "{} {} {}", at.x, at.y, at.z).unwrap());
    for face in faces {
        let numbers: Vec<String> = face.iter().map(usize::to_string).collect();
        writeln!(text, "{} {}", face.len(), numbers.join(" ")).unwrap();
    }
    text
}

fn dae(to_file: impl Fn(DVec3) -> DVec3) -> String {
    let (corners, faces) = indexed(&faces(&GABLE, to_file));
    let numbers: Vec<String> = corners.iter().flat_map(|at| at.to_array()).map(|it| it.to_string()).collect();
    let counts: Vec<String> = faces.iter().map(|face| face.len().to_string()).collect();
    let of_faces: Vec<String> = faces.concat().iter().map(usize::to_string).collect();
    format!(
        "<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\"><asset>\
         <unit name=\"inch\" meter=\"0.0254\"/><up_axis>Y_UP</up_axis></asset><library_geometries>\
         <geometry id=\"g\"><mesh><source id=\"s\"><float_array id=\"a\" count=\"{}\">{}</float_array>\
         <technique_common><accessor source=\"#a\" count=\"{}\" stride=\"3\"/></technique_common></source>\
         <vertices id=\"v\"><input semantic=\"POSITION\" source=\"#s\"/></vertices><polylist count=\"{}\">\
         <input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><vcount>{}</vcount><p>{}</p></polylist></mesh></geometry>\
         </library_geometries><library_visual_scenes><visual_scene id=\"w\"><node><instance_geometry url=\"#g\"/></node>\
         </visual_scene></library_visual_scenes><scene><instance_visual_scene url=\"#w\"/></scene></COLLADA>",
        numbers.len(),
        numbers.join(" "),
        corners.len(),
        counts.len(),
        counts.join(" "),
        of_faces.join(" ")
    )
}

fn dxf(to_file: impl Fn(DVec3) -> DVec3) -> String {
    // 6: metres
    let mut text = "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n6\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n".to_owned();
    for [a, b, c] in faces(&GABLE, to_file).iter().flat_map(|face| fan(face)) {
        text.push_str("0\n3DFACE\n8\nwalls\n");
        for (code, at) in [a, b, c, c].iter().enumerate() {
            let [x, y, z] = [10, 20, 30].map(|axis| axis + code);
            writeln!(text, "{x}\n{}\n{y}\n{}\n{z}\n{}", at.x, at.y, at.z).unwrap();
        }
    }
    text + "0\nENDSEC\n0\nEOF\n"
}

/// Whole millimetres of a map whose zero is 500 km to the west.
fn cityjson(gable: &[[f64; 2]]) -> String {
    let mut vertices: Vec<[i64; 3]> = Vec::new();
    let mut objects = serde_json::Map::new();
    for (name, solid) in ["flat", "wing"].iter().zip(solids(gable)) {
        let (corners, faces) = indexed(&solid);
        let first = vertices.len();
        vertices.extend(corners.iter().map(|at| (*at * 1000.0).round().to_array().map(|number| number as i64)));
        let shell: Vec<Value> =
            faces.iter().map(|face| json!([face.iter().map(|at| at + first).collect::<Vec<_>>()])).collect();
        objects.insert(
            (*name).to_owned(),
            json!({"type": "Building", "geometry": [{"type": "Solid", "lod": "2", "boundaries": [shell]}]}),
        );
    }
    json!({
        "type": "CityJSON", "version": "2.0", "CityObjects": objects, "vertices": vertices,
        "transform": {"scale": [0.001, 0.001, 0.001], "translate": [500_000.0, 0.0, 0.0]},
    })
    .to_string()
}

/// Longitudes and latitudes of the flat twin.
fn geojson() -> String {
    let place = GeodeticPoint { latitude_deg: PLACE[0], longitude_deg: PLACE[1], height_m: 0.0 };
    let frame = LocalFrame::around(place).expect("a place");
    let feature = |outline: &[[f64; 2]], height: f64| {
        let ring: Vec<[f64; 2]> = outline
            .iter()
            .chain([&outline[0]])
            .map(|[x, y]| {
                let at = frame.on_earth(dvec3(*x, *y, 0.0)).expect("near the place");
                [at.longitude_deg, at.latitude_deg]
            })
            .collect();
        json!({
            "type": "Feature", "properties": {"building": "yes", "height": height},
            "geometry": {"type": "Polygon", "coordinates": [ring]},
        })
    };
    let [west, east] = WING;
    let [south, north, eaves] = [FLAT[0][0], FLAT[1][0], FLAT[2][1]];
    let wing = [[west, south], [east, south], [east, north], [west, north]];
    json!({"type": "FeatureCollection", "features": [feature(&PLAN, HIGH_M), feature(&wing, eaves)]}).to_string()
}

/// The masks of the site, one per sun.
fn masks(mesh: &Mesh) -> Vec<Vec<u8>> {
    let scene = Scene { casters: mesh.clone(), receivers: mesh.clone(), ground: 0.0 };
    let mut technique = RayCast::new(scene, View::Plan(GRID), None);
    let draw = |[azimuth_deg, altitude_deg]: [f64; 2]| {
        let to_sun = Position { azimuth_deg, altitude_deg }.to_sun();
        technique.draw(to_sun).expect("rays").read().expect("a mask").share
    };
    SUNS.map(draw).to_vec()
}

/// Those of the house itself, without a file; as it is, or mirrored.
fn expected(gable: &[[f64; 2]], to_file: fn(DVec3) -> DVec3) -> Vec<Vec<u8>> {
    let triangles: Vec<[DVec3; 3]> = faces(gable, to_file).iter().flat_map(|face| fan(face)).collect();
    let numbers = (0..triangles.len() as u32).map(|at| [3 * at, 3 * at + 1, 3 * at + 2]).collect();
    let part = Part { name: "house".to_owned(), positions: triangles.concat(), triangles: numbers, ..Part::default() };
    masks(&Mesh::build(vec![part]).expect("a mesh"))
}

/// In how many cells a file's masks differ from those of the house.
fn differing(name: &str, text: &str, keys: &str, wanted: &[Vec<u8>]) -> usize {
    let folder = tempfile::tempdir().expect("a folder");
    let site = format!(
        "[place]\nlatitude = {}\nlongitude = {}\nelevation = 0.0\n[[model]]\npath = \"{name}\"\n{keys}\n\
         [ground]\nlevel = 0.0\n[study]\ndate = 2026-06-21\nfrom = \"10:00\"\nto = \"11:00\"\nstep = \"1h\"\n",
        PLACE[0], PLACE[1]
    );
    std::fs::write(folder.path().join(name), text).expect("a model");
    std::fs::write(folder.path().join("site.toml"), site).expect("a site file");
    let site = Site::load(folder.path(), &Overrides::default()).unwrap_or_else(|error| panic!("{name}: {error}"));
    let found = masks(&site.mesh);
    found.iter().flatten().zip(wanted.iter().flatten()).filter(|(found, wanted)| found != wanted).count()
}

fn y_up(at: DVec3) -> DVec3 {
    dvec3(at.x, at.z, -at.y)
}

#[test]
fn one_house_has_one_mask_in_every_format() {
    let wanted = expected(&GABLE, |at| at);
    let dark = wanted.iter().flatten().filter(|share| **share == 0).count();
    assert!(dark > 5000, "{dark} cells in shadow");
    let tm = "crs = \"+proj=tmerc +lat_0=49 +lon_0=8 +k=1 +x_0=500000 +y_0=0 +datum=WGS84 +units=m\"";
    let files = [
        ("house.obj", obj(&GABLE, |at| y_up(at) * 100.0), "up = \"y\"\nscale = 0.01"),
        ("house.stl", stl(|at| at * 1000.0), "up = \"z\"\nscale = 0.001"),
        ("house.ply", ply(|at| at / 0.3048), "up = \"z\"\nscale = 0.3048"),
        ("house.dae", dae(|at| y_up(at) / 0.0254), ""),
        ("house.dxf", dxf(|at| at), ""),
        ("house.city.json", cityjson(&GABLE), tm),
        #[cfg(feature = "ifc")]
        ("house.ifc", ifc::text(), ""),
        #[cfg(feature = "ifc")]
        ("house.ifc", ifc::text(), "scale = 0.001"),
    ];
    for (name, text, keys) in files {
        assert_eq!(differing(name, &text, keys, &wanted), 0, "{name}");
    }
    let flat = expected(&FLAT, |at| at);
    for (name, text, keys) in [
        ("flat.obj", obj(&FLAT, |at| at), "up = \"z\"\nscale = 1.0"),
        ("flat.city.json", cityjson(&FLAT), tm),
        ("flat.geojson", geojson(), ""),
    ] {
        assert_eq!(differing(name, &text, keys, &flat), 0, "{name}");
    }
}

/// The comparison sees a wrong unit, a wrong axis, a mirrored house, and one that is moved by a finger's breadth.
#[test]
fn another_house_has_other_masks() {
    let wanted = expected(&GABLE, |at| at);
    for (text, keys) in [
        (obj(&GABLE, |at| at), "up = \"z\"\nscale = 1.01"),
        (obj(&GABLE, y_up), "up = \"z\"\nscale = 1.0"),
        (obj(&GABLE, |at| at), "up = \"z\"\nscale = 1.0\nposition = [0.02, 0.0, 0.0]"),
        (obj(&GABLE, |at| at), "up = \"z\"\nscale = 1.0\nnorth = 0.2"),
        (obj(&FLAT, |at| at), "up = \"z\"\nscale = 1.0"),
    ] {
        assert!(differing("other.obj", &text, keys, &wanted) > 0, "{keys}");
    }
    assert_ne!(expected(&GABLE, |at| dvec3(20.0 - at.x, at.y, at.z)), wanted);
}

#[cfg(feature = "ifc")]
mod ifc {
    //! The house as IFC: in millimetres, extruded, and turned 30° from true north.

    use super::*;

    /// From true north to the file's own: its `TrueNorth` says the way back.
    fn turned(at: DVec3) -> DVec3 {
        let (sin, cos) = 30.0_f64.to_radians().sin_cos();
        dvec3(at.x * cos + at.y * sin, at.y * cos - at.x * sin, at.z)
    }

    /// Records of points, closed to a line; the first is number `first`, and the line follows the last.
    fn polyline(first: usize, points: &[[f64; 2]]) -> String {
        let mut text = String::new();
        for (at, [x, y]) in points.iter().enumerate() {
            writeln!(text, "#{}=IFCCARTESIANPOINT(({x:.9},{y:.9}));", first + at).unwrap();
        }
        let all: Vec<String> = (0..=points.len()).map(|at| format!("#{}", first + at % points.len())).collect();
        writeln!(text, "#{}=IFCPOLYLINE(({}));", first + points.len(), all.join(",")).unwrap();
        text
    }

    fn vector(number: usize, kind: &str, at: DVec3) -> String {
        format!("#{number}={kind}(({:.9},{:.9},{:.9}));\n", at.x, at.y, at.z)
    }

    pub(super) fn text() -> String {
        let plan = PLAN.map(|[x, y]| turned(dvec3(x, y, 0.0) * 1000.0)).map(|at| [at.x, at.y]);
        let gable = GABLE.map(|corner| corner.map(|metres| metres * 1000.0));
        let mut text = "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\n\
            FILE_SCHEMA(('IFC4'));\nENDSEC;\nDATA;\n\
            #1=IFCPROJECT('0000000000000000000001',$,'Project',$,$,$,$,(#10),#2);\n\
            #2=IFCUNITASSIGNMENT((#3,#4));\n#3=IFCSIUNIT(*,.LENGTHUNIT.,.MILLI.,.METRE.);\n\
            #4=IFCSIUNIT(*,.PLANEANGLEUNIT.,$,.RADIAN.);\n#5=IFCCARTESIANPOINT((0.,0.,0.));\n\
            #6=IFCAXIS2PLACEMENT3D(#5,$,$);\n#7=IFCDIRECTION((0.,0.,1.));\n\
            #10=IFCGEOMETRICREPRESENTATIONCONTEXT($,'Model',3,1.E-5,#6,#11);\n\
            #11=IFCDIRECTION((0.5,0.866025403784439));\n#20=IFCLOCALPLACEMENT($,#6);\n\
            #21=IFCSITE('0000000000000000000002',$,'Plot',$,$,#20,$,$,.ELEMENT.,$,$,$,$,$);\n\
            #22=IFCBUILDING('0000000000000000000003',$,'House',$,$,#20,$,$,.ELEMENT.,$,$,$);\n\
            #23=IFCBUILDINGSTOREY('0000000000000000000004',$,'Ground floor',$,$,#20,$,$,.ELEMENT.,0.);\n\
            #24=IFCRELAGGREGATES('0000000000000000000005',$,$,$,#1,(#21));\n\
            #25=IFCRELAGGREGATES('0000000000000000000006',$,$,$,#21,(#22));\n\
            #26=IFCRELAGGREGATES('0000000000000000000007',$,$,$,#22,(#23));\n\
            #27=IFCRELCONTAINEDINSPATIALSTRUCTURE('0000000000000000000008',$,$,$,(#100,#200),#23);\n\
            #100=IFCWALL('0000000000000000000009',$,'Flat',$,$,#20,#104,$,$);\n\
            #102=IFCARBITRARYCLOSEDPROFILEDEF(.AREA.,$,#126);\n#103=IFCEXTRUDEDAREASOLID(#102,#6,#7,6000.);\n\
            #104=IFCPRODUCTDEFINITIONSHAPE($,$,(#105));\n\
            #105=IFCSHAPEREPRESENTATION(#10,'Body','SweptSolid',(#103));\n\
            #200=IFCWALL('0000000000000000000010',$,'Wing',$,$,#20,#204,$,$);\n\
            #202=IFCARBITRARYCLOSEDPROFILEDEF(.AREA.,$,#225);\n#203=IFCEXTRUDEDAREASOLID(#202,#206,#7,10000.);\n\
            #204=IFCPRODUCTDEFINITIONSHAPE($,$,(#205));\n\
            #205=IFCSHAPEREPRESENTATION(#10,'Body','SweptSolid',(#203));\n\
            #206=IFCAXIS2PLACEMENT3D(#207,#208,#209);\n"
            .to_owned();
        text.push_str(&vector(207, "IFCCARTESIANPOINT", turned(DVec3::X * WING[0] * 1000.0)));
        // the gable's plane: drawn out to the east, north and up its axes
        text.push_str(&vector(208, "IFCDIRECTION", turned(DVec3::X)));
        text.push_str(&vector(209, "IFCDIRECTION", turned(DVec3::Y)));
        text.push_str(&polyline(120, &plan));
        text.push_str(&polyline(220, &gable));
        text + "ENDSEC;\nEND-ISO-10303-21;\n"
    }
}
