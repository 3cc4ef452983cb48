//! Reads polylines, some of which are meshes, and MESH.

use super::faces::EntityFaces;
use super::fields::DxfFields;
use super::frame::world_from_object;
use super::outline::{bulged, walls};
use glam::{DVec2, DVec3};

/// The flags of a polyline.
const CLOSED: i64 = 1;
const SMOOTHED: i64 = 4;
const IN_SPACE: i64 = 8;
const GRID: i64 = 16;
const CLOSED_ACROSS: i64 = 32;
const POLYFACE: i64 = 64;
/// The flags of its vertices.
const CONTROL_POINT: i64 = 16;
const OF_MESH: i64 = 64;
const OF_POLYFACE: i64 = 128;

pub(super) struct PolylineVertex {
    point: DVec3,
    bulge: f64,
    flags: i64,
    /// For a face of a polyface mesh: its vertices from 1, negative if the edge that follows is invisible.
    corners: [i64; 4],
}

impl PolylineVertex {
    pub(super) fn of(fields: &DxfFields) -> Self {
        Self {
            point: fields.point(10),
            bulge: fields.real(42),
            flags: fields.whole(70),
            corners: [71, 72, 73, 74].map(|code| fields.whole(code)),
        }
    }
}

/// LWPOLYLINE: a list of points and bulges.
pub(super) fn light(fields: &DxfFields, surface: &mut EntityFaces) {
    let mut points: Vec<(DVec2, f64)> = Vec::new();
    for group in &fields.groups {
        let number = || group.real().unwrap_or(0.0);
        match (group.code, points.last_mut()) {
            (10, _) => points.push((DVec2::new(number(), 0.0), 0.0)),
            (20, Some((point, _))) => point.y = number(),
            (42, Some((_, bulge))) => *bulge = number(),
            _ => (),
        }
    }
    raise(&points, fields.real(38), fields, surface);
}

fn raise(points: &[(DVec2, f64)], height: f64, fields: &DxfFields, surface: &mut EntityFaces) {
    let frame = world_from_object(fields.extrusion());
    let rise = frame * DVec3::Z * fields.real(39);
    if rise != DVec3::ZERO {
        let is_closed = fields.whole(70) & CLOSED != 0;
        walls(&bulged(points, is_closed, height, &frame), is_closed, rise, surface);
    }
}

/// POLYLINE: a line in a plane, or one of two kinds of mesh. Returns the number of faces with missing vertices.
pub(super) fn heavy(fields: &DxfFields, vertices: &[PolylineVertex], surface: &mut EntityFaces) -> u64 {
    let flags = fields.whole(70);
    if flags & POLYFACE != 0 {
        return polyface(vertices, surface);
    }
    if flags & GRID != 0 {
        grid(fields, vertices, surface);
    } else if flags & IN_SPACE == 0 {
        let drawn = vertices.iter().filter(|vertex| vertex.flags & CONTROL_POINT == 0);
        let points: Vec<(DVec2, f64)> = drawn.map(|vertex| (vertex.point.truncate(), vertex.bulge)).collect();
        raise(&points, fields.real(30), fields, surface);
    }
    0
}

fn polyface(vertices: &[PolylineVertex], surface: &mut EntityFaces) -> u64 {
    let points: Vec<DVec3> =
        vertices.iter().filter(|vertex| vertex.flags & OF_MESH != 0).map(|vertex| vertex.point).collect();
    let mut missing = 0;
    for face in vertices.iter().filter(|vertex| vertex.flags & (OF_MESH | OF_POLYFACE) == OF_POLYFACE) {
        let named = face.corners.iter().filter(|&&corner| corner != 0);
        let at = |corner: &i64| points.get(usize::try_from(corner.unsigned_abs()).ok()?.checked_sub(1)?).copied();
        match named.map(at).collect::<Option<Vec<DVec3>>>() {
            Some(corners) => surface.face(&corners),
            None => missing += 1,
        }
    }
    missing
}

/// A mesh of rows and columns; if it is smoothed, the finer ones.
fn grid(fields: &DxfFields, vertices: &[PolylineVertex], surface: &mut EntityFaces) {
    let flags = fields.whole(70);
    let is_smooth = flags & SMOOTHED != 0;
    let drawn = vertices.iter().filter(|vertex| !is_smooth || vertex.flags & CONTROL_POINT == 0);
    let points: Vec<DVec3> = drawn.map(|vertex| vertex.point).collect();
    let count = |plain: i32, smooth: i32| {
        usize::try_from(fields.whole(if is_smooth { smooth } else { plain })).unwrap_or(0).min(points.len())
    };
    let (rows, columns) = (count(71, 73), count(72, 74));
    let last = |count: usize, is_closed: bool| if is_closed { count } else { count.saturating_sub(1) };
    for row in 0..last(rows, flags & CLOSED != 0) {
        for column in 0..last(columns, flags & CLOSED_ACROSS != 0) {
            let at = |row: usize, column: usize| points.get((row % rows) * columns + column % columns).copied();
            let corners = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(down, across)| at(row + down, column + across));
            let [Some(a), Some(b), Some(c), Some(d)] = corners else { return };
            surface.face(&[a, b, c, d]);
        }
    }
}

/// MESH without smoothing: lists of vertices and faces. Returns the number of faces with missing vertices.
pub(super) fn mesh(fields: &DxfFields, surface: &mut EntityFaces) -> u64 {
    let (mut points, mut faces): (Vec<DVec3>, Vec<i64>) = (Vec::new(), Vec::new());
    // numbers belong to the list whose length came last
    let mut list = 0;
    for group in &fields.groups {
        match (group.code, points.last_mut()) {
            (92..=95, _) => list = group.code,
            (10, _) if list == 92 => points.push(DVec3::new(group.real().unwrap_or(0.0), 0.0, 0.0)),
            (20, Some(point)) if list == 92 => point.y = group.real().unwrap_or(0.0),
            (30, Some(point)) if list == 92 => point.z = group.real().unwrap_or(0.0),
            (90, _) if list == 93 => faces.push(group.whole().unwrap_or(-1)),
            _ => (),
        }
    }
    let (mut rest, mut missing) = (faces.as_slice(), 0);
    while let Some((&count, behind)) = rest.split_first() {
        let Some((face, behind)) = usize::try_from(count).ok().and_then(|count| behind.split_at_checked(count)) else {
            return missing + 1;
        };
        rest = behind;
        let at = |corner: &i64| points.get(usize::try_from(*corner).ok()?).copied();
        match face.iter().map(at).collect::<Option<Vec<DVec3>>>() {
            Some(corners) => surface.face(&corners),
            None => missing += 1,
        }
    }
    missing
}
