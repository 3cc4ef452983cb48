//! DXF, as text and binary.

use super::building::*;
use glam::DVec3;
use gnomon::formats::Up;

/// A file in the making: codes and values.
#[derive(Clone, Default)]
struct Groups(Vec<(i16, String)>);

impl Groups {
    fn put(mut self, code: i16, value: impl ToString) -> Self {
        self.0.push((code, value.to_string()));
        self
    }

    fn entity(self, kind: &str, layer: &str) -> Self {
        self.put(0, kind).put(8, layer)
    }

    fn point(self, code: i16, point: DVec3) -> Self {
        self.put(code, point.x).put(code + 10, point.y).put(code + 20, point.z)
    }

    fn and(mut self, more: Groups) -> Self {
        self.0.extend(more.0);
        self
    }

    fn text(&self) -> Vec<u8> {
        self.0.iter().map(|(code, value)| format!("{code:>3}\r\n{value}\r\n")).collect::<String>().into_bytes()
    }

    fn binary(&self, has_short_codes: bool) -> Vec<u8> {
        let mut bytes = b"AutoCAD Binary DXF\r\n\x1A\0".to_vec();
        for (code, value) in &self.0 {
            match has_short_codes {
                true => bytes.push(*code as u8),
                false => bytes.extend(code.to_le_bytes()),
            }
            match code {
                10..=59 | 210..=239 => bytes.extend(value.parse::<f64>().unwrap().to_le_bytes()),
                60..=79 => bytes.extend(value.parse::<i16>().unwrap().to_le_bytes()),
                90..=99 => bytes.extend(value.parse::<i32>().unwrap().to_le_bytes()),
                _ => bytes.extend(value.bytes().chain([0])),
            }
        }
        bytes
    }
}

fn drawing(blocks: Groups, entities: Groups) -> Groups {
    let layer = |name: &str, flags: i32, colour: i32| {
        Groups::default().put(0, "LAYER").put(2, name).put(70, flags).put(62, colour)
    };
    Groups::default()
        .put(0, "SECTION")
        .put(2, "HEADER")
        .put(9, "$INSUNITS")
        .put(70, 4)
        .put(0, "ENDSEC")
        .put(0, "SECTION")
        .put(2, "TABLES")
        .and(layer("HOUSE", 0, 7))
        .and(layer("COLD", 1, 7))
        .and(layer("DARK", 0, -7))
        .put(0, "ENDSEC")
        .put(0, "SECTION")
        .put(2, "BLOCKS")
        .and(blocks)
        .put(0, "ENDSEC")
        .put(0, "SECTION")
        .put(2, "ENTITIES")
        .and(entities)
        .put(0, "ENDSEC")
        .put(0, "EOF")
}

/// Faces of three or four corners, in millimetres.
fn face_entities(faces: &[Vec<DVec3>], layer: &str) -> Groups {
    faces.iter().fold(Groups::default(), |groups, face| {
        let corner = |at: usize| face[at.min(face.len() - 1)];
        let groups = groups.entity("3DFACE", layer);
        (0..4).fold(groups, |groups, at| groups.point(10 + at as i16, corner(at)))
    })
}

fn triangles_mm() -> Vec<Vec<DVec3>> {
    triangles_in(0.001, Up::Z).into_iter().map(|triangle| triangle.to_vec()).collect()
}

fn polyface(faces: &[Vec<DVec3>]) -> Groups {
    let (corners, faces) = indexed(faces);
    let head = Groups::default().entity("POLYLINE", "HOUSE").put(66, 1).put(70, 64).put(71, corners.len());
    let vertices =
        corners.iter().fold(head, |groups, corner| groups.entity("VERTEX", "HOUSE").point(10, *corner).put(70, 192));
    let faces = faces.iter().fold(vertices, |groups, face| {
        let groups = groups.entity("VERTEX", "HOUSE").point(10, DVec3::ZERO).put(70, 128);
        (0..).zip(face).fold(groups, |groups, (at, corner)| groups.put(71 + at, -(*corner as i64 + 1)))
    });
    faces.put(0, "SEQEND")
}

fn mesh(faces: &[Vec<DVec3>]) -> Groups {
    let (corners, faces) = indexed(faces);
    let head = Groups::default().entity("MESH", "HOUSE").put(71, 2).put(91, 0).put(92, corners.len());
    let vertices = corners.iter().fold(head, |groups, corner| groups.point(10, *corner));
    let length: usize = faces.iter().map(|face| face.len() + 1).sum();
    let faces = faces.iter().fold(vertices.put(93, length), |groups, face| {
        face.iter().fold(groups.put(90, face.len()), |groups, corner| groups.put(90, corner))
    });
    faces.put(94, 1).put(90, 0).put(90, 1).put(95, 0)
}

fn caps_and_outline() -> Groups {
    let plan = &faces_in(0.001, Up::Z)[0];
    let outline = Groups::default().entity("LWPOLYLINE", "HOUSE").put(90, 6).put(70, 1).put(38, 0).put(39, 30_000);
    let outline = plan.iter().fold(outline, |groups, corner| groups.put(10, corner.x).put(20, corner.y));
    let caps: Vec<Vec<DVec3>> = triangles_mm().into_iter().take(8).collect();
    outline.and(face_entities(&caps, "HOUSE"))
}

#[test]
fn the_building_is_read() {
    let quads = faces_in(0.001, Up::Z);
    for entities in
        [face_entities(&triangles_mm(), "HOUSE"), polyface(&triangles_mm()), mesh(&quads), caps_and_outline()]
    {
        let file = drawing(Groups::default(), entities);
        for bytes in [file.text(), file.binary(true), file.binary(false)] {
            let model = read_bytes("house.dxf", &bytes);
            assert_is_building(&model);
            assert!(model.up == Up::Z && model.up_is_said && model.unit_m == Some(0.001));
            assert_eq!(names(&model), ["HOUSE"]);
            assert!(model.left_out.is_empty(), "{:?}", model.left_out);
        }
    }
}

/// A building that is built mirrored and turned in a block, which the insert mirrors and turns back; within another block.
#[test]
fn blocks_are_placed() {
    let base = DVec3::new(100.0, 200.0, 0.0);
    // the insert scales by −2, 2 and 2, turns by a quarter, and moves
    let into_block = |corner: &DVec3| {
        let moved = *corner - DVec3::new(1000.0, 2000.0, 0.0);
        let turned = DVec3::new(moved.y, -moved.x, moved.z);
        DVec3::new(-turned.x, turned.y, turned.z) / 2.0 + base
    };
    let faces: Vec<Vec<DVec3>> =
        triangles_mm().iter().map(|face| face.iter().rev().map(into_block).collect()).collect();
    let begin = |name: &str, base: DVec3| Groups::default().put(0, "BLOCK").put(8, "0").put(2, name).point(10, base);
    let inner = begin("Shell", base).and(face_entities(&faces, "0")).put(0, "ENDBLK");
    let placed = Groups::default()
        .entity("INSERT", "0")
        .put(2, "SHELL")
        .point(10, DVec3::new(1000.0, 2000.0, 0.0))
        .put(41, -2)
        .put(42, 2)
        .put(43, 2)
        .put(50, 90);
    let outer = begin("Tower", DVec3::ZERO).and(placed).put(0, "ENDBLK");
    let insert = |layer: &str| Groups::default().entity("INSERT", layer).put(2, "Tower").point(10, DVec3::ZERO);
    let model = read_bytes("m.dxf", &drawing(inner.clone().and(outer.clone()), insert("HOUSE")).text());
    assert_is_building(&model);
    assert_eq!((names(&model), &model.parts[0].aliases), (vec!["Tower"], &vec!["Tower".to_owned(), "HOUSE".into()]));

    // rows and columns, and a layer that is frozen or off
    let array = insert("HOUSE").put(70, 3).put(71, 2).put(44, 50_000).put(45, -60_000);
    let model = read_bytes("m.dxf", &drawing(inner.clone().and(outer.clone()), array).text());
    assert_eq!(triangles(&model).count(), 6 * TRIANGLES);
    let high = triangles(&model).flatten().fold(DVec3::NEG_INFINITY, DVec3::max);
    let low = triangles(&model).flatten().fold(DVec3::INFINITY, DVec3::min);
    assert!(
        (high - DVec3::new(115.0, 27.0, 30.0)).length() < 1e-6 && (low - DVec3::new(5.0, -53.0, 0.0)).length() < 1e-6
    );
    let both = insert("HOUSE").and(insert("COLD")).and(insert("DARK"));
    let model = read_bytes("m.dxf", &drawing(inner.clone().and(outer), both).text());
    assert_is_building(&model);
    assert_eq!(left_out(&model), ["20 entities of the layer DARK", "1 entities of the layer COLD"]);

    // a block that contains itself, and more copies than there is memory for
    let loop_of = |name: &str| begin(name, DVec3::ZERO).and(insert("0")).put(0, "ENDBLK");
    assert_refused("m.dxf", &drawing(loop_of("Tower"), insert("0")).text(), &["block that contains itself", "TOWER"]);
    let many = Groups::default().entity("INSERT", "0").put(2, "Shell").put(70, 32_767).put(71, 32_767);
    assert_refused("m.dxf", &drawing(inner, many).text(), &["more than 100000000 triangles", "blocks counted"]);
}

#[test]
fn what_is_drawn_in_a_plane_has_its_axes() {
    // seen from the north: x runs to the west, y up
    let circle = Groups::default().entity("CIRCLE", "0").point(10, DVec3::new(-3.0, 4.0, 7.0)).put(40, 2).put(39, 5);
    let circle = circle.point(210, DVec3::Y);
    let model = read_bytes("m.dxf", &drawing(Groups::default(), circle).text());
    let corners: Vec<DVec3> = triangles(&model).flatten().map(|corner| corner * 1000.0).collect();
    assert!(corners.iter().all(|corner| (7.0 - 1e-9..=12.0 + 1e-9).contains(&corner.y)));
    let middle = DVec3::new(3.0, 0.0, 4.0);
    assert!(corners.iter().all(|corner| ((*corner * DVec3::new(1.0, 0.0, 1.0) - middle).length() - 2.0).abs() < 1e-9));
    // closed: no more looks one way than the other
    let sum: DVec3 = triangles(&model).map(|[a, b, c]| (b - a).cross(c - a)).sum();
    assert!(sum.length() < 1e-12);

    // half a circle of radius 1 over the x axis, and a solid whose corners cross
    let bulge = Groups::default().entity("LWPOLYLINE", "0").put(70, 0).put(39, 1);
    let bulge = bulge.put(10, 2).put(20, 0).put(42, 1).put(10, 0).put(20, 0);
    let model = read_bytes("m.dxf", &drawing(Groups::default(), bulge).text());
    let top = triangles(&model).flatten().fold(DVec3::NEG_INFINITY, DVec3::max) * 1000.0;
    assert!((top - DVec3::new(2.0, 1.0, 1.0)).length() < 1e-9, "{top}");
    let solid = [[0.0, 0.0], [2.0, 0.0], [0.0, 1.0], [2.0, 1.0]];
    let solid = (10..).zip(solid).fold(Groups::default().entity("SOLID", "0"), |groups, (code, [x, y])| {
        groups.point(code, DVec3::new(x, y, 0.0))
    });
    let model = read_bytes("m.dxf", &drawing(Groups::default(), solid).text());
    let area: f64 = triangles(&model).map(|[a, b, c]| (b - a).cross(c - a).z / 2.0).sum();
    assert!((area * 1e6 - 2.0).abs() < 1e-9);
}

#[test]
fn meshes_of_rows_and_columns_are_read() {
    let grid = Groups::default().entity("POLYLINE", "0").put(66, 1).put(70, 16).put(71, 3).put(72, 2);
    let vertices = (0..6).fold(grid, |groups, at| {
        let point = DVec3::new(f64::from(at % 2), -f64::from(at / 2), 0.0);
        groups.entity("VERTEX", "0").point(10, point).put(70, 64)
    });
    let model = read_bytes("m.dxf", &drawing(Groups::default(), vertices.put(0, "SEQEND")).text());
    assert_eq!(triangles(&model).count(), 4);
    let area: f64 = triangles(&model).map(|[a, b, c]| (b - a).cross(c - a).z / 2.0).sum();
    assert!((area * 1e6 - 2.0).abs() < 1e-9, "{area}");
}

#[test]
fn everything_left_out_is_told() {
    let solid = Groups::default().entity("3DSOLID", "0").put(1, "acis data");
    let line = Groups::default().entity("LINE", "0").point(10, DVec3::ZERO).point(11, DVec3::X);
    let others = ["TEXT", "HATCH", "LINE"].iter().fold(Groups::default(), |groups, kind| groups.entity(kind, "0"));
    let paper = Groups::default().entity("3DFACE", "0").put(67, 1);
    let hidden = face_entities(&triangles_mm()[..1], "0").put(60, 1);
    let lost = Groups::default().entity("INSERT", "0").put(2, "NOWHERE");
    let all = solid.clone().and(solid.clone()).and(line).and(others).and(paper).and(hidden).and(lost);
    let model = read_bytes("m.dxf", &drawing(Groups::default(), all.and(caps_and_outline())).text());
    assert_is_building(&model);
    let mut told = left_out(&model);
    told.sort();
    let expected =
        ["1 3DFACE", "1 HATCH", "1 INSERT", "1 TEXT", "1 entities of the paper space", "2 3DSOLID", "2 LINE"];
    assert_eq!(told, expected);
    assert!(model.notes[1].to_string().contains("1 closed outline with a thickness that has walls but no lid"));
    assert!(
        model.notes[0].to_string().contains("2 solids or surfaces of ACIS")
            && model.notes[0].to_string().contains("MESHSMOOTH")
    );
    assert_refused("m.dxf", &drawing(Groups::default(), solid).text(), &["1 solids or surfaces", "MESHSMOOTH", "STL"]);
}

#[test]
fn what_is_cut_off_is_told() {
    let whole = drawing(Groups::default(), face_entities(&triangles_mm(), "HOUSE"));
    let text = whole.text();
    assert_refused("m.dxf", &text[..text.len() / 2], &["cut off", "line"]);
    let binary = whole.binary(false);
    assert_refused("m.dxf", &binary[..binary.len() / 2], &["cut off", "byte"]);
    // the content tells the format
    assert_is_building(&read_bytes("m.txt", &text));
    assert_is_building(&read_bytes("m.txt", &binary));
}

#[test]
fn a_thousand_mutations_are_survived() {
    let file = drawing(Groups::default(), mesh(&faces_in(0.001, Up::Z)).and(polyface(&triangles_mm())));
    survive_mutations("house.dxf", &file.text());
    survive_mutations("house.dxf", &file.binary(false));
}
