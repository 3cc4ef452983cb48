//! Makes walls of outlines with a thickness.

use super::faces::EntityFaces;
use super::fields::DxfFields;
use super::frame::world_from_object;
use glam::{DMat3, DVec2, DVec3};
use std::f64::consts::TAU;

/// The angle of one straight piece of an arc. With a radius of 10 m it is off by at most 2.4 mm.
const PIECE_RAD: f64 = TAU / 144.0;

/// A line, circle or arc with a thickness: a wall. A circle also has ends.
pub(super) fn extruded(kind: &[u8], fields: &DxfFields, surface: &mut EntityFaces) {
    let frame = world_from_object(fields.extrusion());
    let rise = frame * DVec3::Z * fields.real(39);
    if rise == DVec3::ZERO {
        return;
    }
    if kind == b"LINE" {
        // the one entity whose points are in world coordinates
        return walls(&[fields.point(10), fields.point(11)], false, rise, surface);
    }
    let (middle, radius) = (fields.point(10), fields.real(40));
    let is_circle = kind == b"CIRCLE";
    let from = if is_circle { 0.0 } else { fields.real(50).to_radians() };
    let angle = if is_circle { TAU } else { (fields.real(51).to_radians() - from).rem_euclid(TAU) };
    let pieces = pieces(angle);
    let count = if is_circle { pieces } else { pieces + 1 };
    let at = |piece: u32| {
        let along = DVec2::from_angle(from + angle * f64::from(piece) / f64::from(pieces));
        frame * (middle + (along * radius).extend(0.0))
    };
    let points: Vec<DVec3> = (0..count).map(at).collect();
    walls(&points, is_circle, rise, surface);
    if is_circle {
        ends(&points, rise, surface);
    }
}

/// A solid or trace: four corners, the last two swapped. With a thickness, it is a prism.
pub(super) fn filled(fields: &DxfFields, surface: &mut EntityFaces) {
    let frame = world_from_object(fields.extrusion());
    let fourth = if fields.given(13).is_some() { 13 } else { 12 };
    let corners = [10, 11, fourth, 12].map(|code| frame * fields.point(code));
    let rise = frame * DVec3::Z * fields.real(39);
    if rise == DVec3::ZERO {
        return surface.face(&corners);
    }
    walls(&corners, true, rise, surface);
    ends(&corners, rise, surface);
}

fn ends(points: &[DVec3], rise: DVec3, surface: &mut EntityFaces) {
    let top: Vec<DVec3> = points.iter().map(|&point| point + rise).collect();
    let bottom: Vec<DVec3> = points.iter().rev().copied().collect();
    surface.face(&top);
    surface.face(&bottom);
}

/// The walls over consecutive points.
pub(super) fn walls(points: &[DVec3], is_closed: bool, rise: DVec3, surface: &mut EntityFaces) {
    let close = points.last().zip(points.first()).filter(|_| is_closed && points.len() > 2);
    let pairs = points.windows(2).filter_map(|two| Some((two.first()?, two.last()?)));
    for (&a, &b) in pairs.chain(close).filter(|(a, b)| a != b) {
        surface.face(&[a, b, b + rise, a + rise]);
    }
}

/// Converts points of a plane to the world, and arcs to points. Each point has the bulge of the segment after it: the
/// tangent of a quarter of the arc's angle.
pub(super) fn bulged(points: &[(DVec2, f64)], is_closed: bool, height: f64, frame: &DMat3) -> Vec<DVec3> {
    let mut straight: Vec<DVec2> = Vec::with_capacity(points.len());
    for (index, &(point, bulge)) in points.iter().enumerate() {
        straight.push(point);
        let next = points.get(index + 1).or(points.first().filter(|_| is_closed));
        if let Some(&(next, _)) = next.filter(|_| bulge != 0.0) {
            arc(point, next, bulge, &mut straight);
        }
    }
    straight.iter().map(|point| *frame * point.extend(height)).collect()
}

fn arc(from: DVec2, to: DVec2, bulge: f64, into: &mut Vec<DVec2>) {
    let angle = 4.0 * bulge.atan();
    let middle = (from + to) / 2.0 + (to - from).perp() * (1.0 - bulge * bulge) / (4.0 * bulge);
    let pieces = pieces(angle);
    let at =
        |piece: u32| middle + DVec2::from_angle(angle * f64::from(piece) / f64::from(pieces)).rotate(from - middle);
    if middle.is_finite() {
        into.extend((1..pieces).map(at));
    }
}

fn pieces(angle: f64) -> u32 {
    ((angle.abs() / PIECE_RAD).ceil() as u32).clamp(1, 144)
}
