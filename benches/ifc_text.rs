//! Synthetic IFC files: walls with one opening each, and furniture as triangles, which a file has in a list of corner numbers
//! or, as exporters of IFC 2x3 write them, each as a face with a loop of its own.

use std::fmt::Write as _;

const HEAD: &str = "ISO-10303-21;
HEADER;
FILE_DESCRIPTION((''),'2;1');
FILE_NAME('','',(''),(''),'','','');
FILE_SCHEMA(('IFC4'));
ENDSEC;
DATA;
#1=IFCPROJECT('0000000000000000000001',$,'Project',$,$,$,$,(#8),#2);
#2=IFCUNITASSIGNMENT((#3));
#3=IFCSIUNIT(*,.LENGTHUNIT.,.MILLI.,.METRE.);
#4=IFCCARTESIANPOINT((0.,0.,0.));
#5=IFCAXIS2PLACEMENT3D(#4,$,$);
#6=IFCDIRECTION((0.,0.,1.));
#7=IFCLOCALPLACEMENT($,#5);
#8=IFCGEOMETRICREPRESENTATIONCONTEXT($,'Model',3,1.E-5,#5,$);
#9=IFCCARTESIANPOINT((0.,0.));
#10=IFCAXIS2PLACEMENT2D(#9,$);
#11=IFCBUILDING('0000000000000000000002',$,'Office',$,$,#7,$,$,.ELEMENT.,$,$,$);
#12=IFCBUILDINGSTOREY('0000000000000000000003',$,'Storey',$,$,#7,$,$,.ELEMENT.,0.);
#13=IFCRELAGGREGATES('0000000000000000000004',$,$,$,#1,(#11));
#14=IFCRELAGGREGATES('0000000000000000000005',$,$,$,#11,(#12));
";

/// Meridians and parallels of a piece of furniture: 960 triangles.
const AROUND: usize = 32;
const ABOVE: usize = 16;

/// How a file has the triangles of furniture.
#[derive(Clone, Copy)]
pub(crate) enum FurnitureAs {
    /// A list of corner numbers: some 27 bytes a triangle.
    FaceSet,
    /// A face with a loop: some 110 bytes a triangle.
    Brep,
}

/// A file with this many products: half of them are walls, with 12 triangles before they are cut, and half furniture.
pub(crate) fn ifc(products: usize, furniture_as: FurnitureAs) -> Vec<u8> {
    let (mut text, mut next) = (HEAD.to_owned(), 100);
    let mut contained = Vec::new();
    for unit in 0..products.div_ceil(2) {
        let (x, y, z) = (unit % 20 * 6000, unit / 20 % 20 * 6000, unit / 400 * 3000);
        contained.extend([
            wall(&mut text, &mut next, [x, y, z]),
            furniture(&mut text, &mut next, [x, y + 1500, z], furniture_as),
        ]);
    }
    let contained: Vec<String> = contained.iter().map(|product| format!("#{product}")).collect();
    let relation = format!("IFCRELCONTAINEDINSPATIALSTRUCTURE('{}',$,$,$,({}),#12)", guid(next), contained.join(","));
    record(&mut text, &mut next, &relation);
    text.push_str("ENDSEC;\nEND-ISO-10303-21;\n");
    text.into_bytes()
}

/// Writes a record, and gives its number.
fn record(text: &mut String, next: &mut usize, what: &str) -> usize {
    *next += 1;
    writeln!(text, "#{next}={what};").expect("a text");
    *next
}

fn guid(number: usize) -> String {
    format!("{number:022}")
}

/// Where something stands, millimetres.
fn placement(text: &mut String, next: &mut usize, [x, y, z]: [usize; 3]) -> usize {
    let point = record(text, next, &format!("IFCCARTESIANPOINT(({x}.,{y}.,{z}.))"));
    let axes = record(text, next, &format!("IFCAXIS2PLACEMENT3D(#{point},$,$)"));
    record(text, next, &format!("IFCLOCALPLACEMENT(#7,#{axes})"))
}

/// A product's shape.
fn shape(text: &mut String, next: &mut usize, kind: &str, item: usize) -> usize {
    let representation = record(text, next, &format!("IFCSHAPEREPRESENTATION(#8,'Body','{kind}',(#{item}))"));
    record(text, next, &format!("IFCPRODUCTDEFINITIONSHAPE($,$,(#{representation}))"))
}

fn extruded(text: &mut String, next: &mut usize, [width, depth, height]: [usize; 3]) -> usize {
    let profile = record(text, next, &format!("IFCRECTANGLEPROFILEDEF(.AREA.,$,#10,{width}.,{depth}.)"));
    let solid = record(text, next, &format!("IFCEXTRUDEDAREASOLID(#{profile},#5,#6,{height}.)"));
    shape(text, next, "SweptSolid", solid)
}

fn wall(text: &mut String, next: &mut usize, at: [usize; 3]) -> usize {
    let (place, body) = (placement(text, next, at), extruded(text, next, [5000, 300, 3000]));
    let wall = record(text, next, &format!("IFCWALL('{}',$,'Wall',$,$,#{place},#{body},$,$)", guid(*next)));
    let [x, y, z] = at;
    let (place, hole) = (placement(text, next, [x, y, z + 900]), extruded(text, next, [1200, 600, 1500]));
    let hole = record(text, next, &format!("IFCOPENINGELEMENT('{}',$,$,$,$,#{place},#{hole},$,$)", guid(*next)));
    record(text, next, &format!("IFCRELVOIDSELEMENT('{}',$,$,$,#{wall},#{hole})", guid(*next)));
    wall
}

/// A ball of triangles, 1 m across.
fn furniture(text: &mut String, next: &mut usize, at: [usize; 3], furniture_as: FurnitureAs) -> usize {
    let place = placement(text, next, at);
    let (points, triangles) = ball();
    let body = match furniture_as {
        FurnitureAs::FaceSet => face_set(text, next, &points, &triangles),
        FurnitureAs::Brep => brep(text, next, &points, &triangles),
    };
    record(text, next, &format!("IFCFURNITURE('{}',$,'Ball',$,$,#{place},#{body},$,$)", guid(*next)))
}

/// The coordinates of a ball's corners, and triangles by their numbers from 0 on.
fn ball() -> (Vec<String>, Vec<[usize; 3]>) {
    let mut points = vec!["(0.,0.,0.)".to_owned()];
    for parallel in 1..ABOVE {
        let (ring, height) = (std::f64::consts::PI * parallel as f64 / ABOVE as f64).sin_cos();
        for meridian in 0..AROUND {
            let (sin, cos) = (std::f64::consts::TAU * meridian as f64 / AROUND as f64).sin_cos();
            points.push(format!("({:.4},{:.4},{:.4})", 500.0 * ring * cos, 500.0 * ring * sin, 500.0 - 500.0 * height));
        }
    }
    points.push("(0.,0.,1000.)".to_owned());
    let number = |parallel: usize, meridian: usize| match parallel {
        0 => 0,
        ABOVE => points.len() - 1,
        _ => 1 + (parallel - 1) * AROUND + meridian % AROUND,
    };
    let mut triangles = Vec::new();
    for parallel in 0..ABOVE {
        for meridian in 0..AROUND {
            let [a, b] = [number(parallel, meridian), number(parallel, meridian + 1)];
            let [c, d] = [number(parallel + 1, meridian + 1), number(parallel + 1, meridian)];
            triangles.extend((a != b).then_some([a, c, b]));
            triangles.extend((c != d).then_some([a, d, c]));
        }
    }
    (points, triangles)
}

fn face_set(text: &mut String, next: &mut usize, points: &[String], triangles: &[[usize; 3]]) -> usize {
    let triangles: Vec<String> = triangles.iter().map(|[a, b, c]| format!("({},{},{})", a + 1, b + 1, c + 1)).collect();
    let list = record(text, next, &format!("IFCCARTESIANPOINTLIST3D(({}))", points.join(",")));
    let faces = record(text, next, &format!("IFCTRIANGULATEDFACESET(#{list},$,.T.,({}),$)", triangles.join(",")));
    shape(text, next, "Tessellation", faces)
}

fn brep(text: &mut String, next: &mut usize, points: &[String], triangles: &[[usize; 3]]) -> usize {
    let points: Vec<usize> =
        points.iter().map(|point| record(text, next, &format!("IFCCARTESIANPOINT({point})"))).collect();
    let mut faces = Vec::new();
    for corners in triangles {
        let [a, b, c] = corners.map(|corner| points[corner]);
        let ring = record(text, next, &format!("IFCPOLYLOOP((#{a},#{b},#{c}))"));
        let bound = record(text, next, &format!("IFCFACEOUTERBOUND(#{ring},.T.)"));
        faces.push(format!("#{}", record(text, next, &format!("IFCFACE((#{bound}))"))));
    }
    let shell = record(text, next, &format!("IFCCLOSEDSHELL(({}))", faces.join(",")));
    let solid = record(text, next, &format!("IFCFACETEDBREP(#{shell})"));
    shape(text, next, "Brep", solid)
}
