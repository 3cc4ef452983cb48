//! Turns entities into triangles of their layer, and into inserts, and counts what is left out.

use super::drawing::{Drawing, DxfBlock, DxfInsert, LayerTriangles};
use super::faces::EntityFaces;
use super::fields::DxfFields;
use super::frame::world_from_object;
use super::group::{DxfGroup, DxfGroups};
use super::outline;
use super::polyline::{self, PolylineVertex};
use crate::formats::MAX_TRIANGLES;
use crate::formats::left_out::label;
use crate::message::{Message, message};
use glam::{DAffine3, DVec3};

/// Bodies whose shape is stored only for the ACIS kernel.
pub(super) const ACIS: &[&[u8]] = &[
    b"3DSOLID",
    b"REGION",
    b"BODY",
    b"SURFACE",
    b"EXTRUDEDSURFACE",
    b"LOFTEDSURFACE",
    b"REVOLVEDSURFACE",
    b"SWEPTSURFACE",
    b"PLANESURFACE",
    b"NURBSURFACE",
];

/// Why those are left out.
pub(super) const NO_ACIS: &str = "only CAD programs can read the shape: in AutoCAD, make a mesh with MESHSMOOTH";

/// Adds an entity to a block. Returns the first group of the next one.
pub(super) fn add<'a>(
    drawing: &mut Drawing,
    block: &mut DxfBlock,
    kind: &[u8],
    groups: &mut DxfGroups<'a>,
) -> Result<DxfGroup<'a>, Message> {
    let (fields, mut next) = DxfFields::read(groups)?;
    let mut vertices = Vec::new();
    // the entities that follow belong to these
    if kind == b"POLYLINE" || kind == b"INSERT" && fields.whole(66) == 1 {
        while matches!(next.bytes(), b"VERTEX" | b"ATTRIB" | b"SEQEND") {
            let (is_vertex, is_end) = (next.bytes() == b"VERTEX", next.bytes() == b"SEQEND");
            let (follower, behind) = DxfFields::read(groups)?;
            if is_vertex {
                vertices.push(PolylineVertex::of(&follower));
            }
            next = behind;
            if is_end {
                break;
            }
        }
    }
    let name = || label(&String::from_utf8_lossy(kind));
    if fields.whole(67) == 1 {
        drawing.left_out.add("entities of the paper space", "they are on the sheet");
    } else if fields.whole(60) == 1 {
        drawing.left_out.add(&name(), "invisible");
    } else if kind == b"INSERT" {
        let insert = insert(&fields, drawing);
        block.inserts.push(insert);
    } else if ACIS.contains(&kind) {
        drawing.left_out.add(&name(), NO_ACIS);
        drawing.acis += 1;
    } else {
        surface(drawing, block, kind, &fields, &vertices)?;
    }
    Ok(next)
}

fn surface(
    drawing: &mut Drawing,
    block: &mut DxfBlock,
    kind: &[u8],
    fields: &DxfFields,
    vertices: &[PolylineVertex],
) -> Result<(), Message> {
    let layer = drawing.layer(&fields.name(8));
    let mut found = LayerTriangles::default();
    let mut surface = EntityFaces::new(&mut found, &mut drawing.cutter, &mut drawing.left_out);
    let is_wide = |code: i32| fields.given(code).is_some_and(|width| width > 0.0);
    match kind {
        b"3DFACE" => surface.face(&[10, 11, 12, 13].map(|code| fields.point(code))),
        b"SOLID" | b"TRACE" => outline::filled(fields, &mut surface),
        b"LINE" | b"CIRCLE" | b"ARC" => outline::extruded(kind, fields, &mut surface),
        b"LWPOLYLINE" => {
            drawing.wide += u64::from(is_wide(43) || is_wide(40));
            polyline::light(fields, &mut surface);
        }
        b"POLYLINE" => {
            drawing.wide += u64::from(fields.whole(70) & (16 | 64) == 0 && (is_wide(40) || is_wide(41)));
            let missing = polyline::heavy(fields, vertices, &mut surface);
            drawing.left_out.add_many("faces of polyface meshes", "a vertex is not in the file", missing);
        }
        b"MESH" => {
            let missing = polyline::mesh(fields, &mut surface);
            drawing.left_out.add_many("faces of meshes", "a vertex is not in the file", missing);
        }
        _ => {
            drawing.left_out.add(&label(&String::from_utf8_lossy(kind)), "no surface");
            return Ok(());
        }
    }
    if found.triangles.is_empty() {
        let why = match kind {
            b"LINE" | b"CIRCLE" | b"ARC" | b"LWPOLYLINE" | b"POLYLINE" => "they have no thickness, and so no surface",
            _ => "no area",
        };
        drawing.left_out.add(&label(&String::from_utf8_lossy(kind)), why);
        return Ok(());
    }
    let is_outline = kind == b"LWPOLYLINE" || kind == b"POLYLINE" && fields.whole(70) & (16 | 64) == 0;
    drawing.lidless += u64::from(is_outline && fields.whole(70) & 1 != 0);
    drawing.triangles += found.triangles.len() as u64;
    if drawing.triangles > MAX_TRIANGLES {
        let what = format!("has more than {MAX_TRIANGLES} triangles");
        return Err(message![what; "export it in parts or with less detail"]);
    }
    block.of_layer(layer, found);
    Ok(())
}

fn insert(fields: &DxfFields, drawing: &mut Drawing) -> DxfInsert {
    let world_from_object = DAffine3::from_mat3(world_from_object(fields.extrusion()));
    let scale = |code: i32| fields.given(code).unwrap_or(1.0);
    let place = DAffine3::from_translation(fields.point(10)) * DAffine3::from_rotation_z(fields.real(50).to_radians());
    let turned = world_from_object * place;
    let count = |code: i32| fields.whole(code).clamp(1, 1 << 32) as u64;
    DxfInsert {
        layer: drawing.layer(&fields.name(8)),
        block: fields.name(2),
        world_from_block: turned * DAffine3::from_scale(DVec3::new(scale(41), scale(42), scale(43))),
        columns: count(70),
        rows: count(71),
        column_step: turned.transform_vector3(DVec3::X * fields.real(44)),
        row_step: turned.transform_vector3(DVec3::Y * fields.real(45)),
    }
}
