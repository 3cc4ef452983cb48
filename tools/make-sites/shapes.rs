//! The shapes of which buildings are composed: outlines in plan, and solids drawn up, along or around them.

use super::solids::{Solid, hoop, loft};
use glam::{DVec2, DVec3, dvec2, dvec3};

/// The point of the unit circle after `turns` counter-clockwise turns from east.
pub(crate) fn on_circle(turns: f64) -> DVec2 {
    let quarters = 4.0 * (turns - turns.floor());
    let angle = (quarters - quarters.floor()) * std::f64::consts::FRAC_PI_2;
    // Taylor's series; the first term left out is below 1e-16 for a right angle.
    let (mut sin, mut cos, mut term) = (0.0, 0.0, 1.0);
    for power in 0..22 {
        let sign = if power % 4 < 2 { 1.0 } else { -1.0 };
        if power % 2 == 0 {
            cos += sign * term;
        } else {
            sin += sign * term;
        }
        term *= angle / f64::from(power + 1);
    }
    match quarters.floor() as i32 {
        0 => dvec2(cos, sin),
        1 => dvec2(-sin, cos),
        2 => dvec2(-cos, -sin),
        _ => dvec2(sin, -cos),
    }
}

/// A circle of `sides` points, counter-clockwise seen from above.
pub(crate) fn circle(centre: DVec3, radius: f64, sides: u32) -> Vec<DVec3> {
    (0..sides).map(|side| centre + (radius * on_circle(f64::from(side) / f64::from(sides))).extend(0.0)).collect()
}

/// A rectangle around `centre`, counter-clockwise seen from above.
pub(crate) fn rectangle(centre: DVec3, half: DVec2) -> Vec<DVec3> {
    [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
        .map(|(x, y)| centre + dvec3(x * half.x, y * half.y, 0.0))
        .to_vec()
}

/// An upright prism over a polygon.
pub(crate) fn prism(polygon: &[DVec2], bottom: f64, top: f64) -> Solid {
    loft(&[bottom, top].map(|z| polygon.iter().map(|point| point.extend(z)).collect()))
}

/// An upright wall with its outer and inner polygon of equally many points.
pub(crate) fn ring_wall(outer: &[DVec2], inner: &[DVec2], bottom: f64, top: f64) -> Solid {
    let at = |polygon: &[DVec2], z: f64| polygon.iter().map(|point| point.extend(z)).collect();
    hoop(&[at(outer, bottom), at(outer, top), at(inner, top), at(inner, bottom)])
}

/// A rectangle between its south-western and north-eastern corner.
pub(crate) fn rect(low: [f64; 2], high: [f64; 2]) -> Vec<DVec2> {
    let ([west, south], [east, north]) = (low, high);
    vec![dvec2(west, south), dvec2(east, south), dvec2(east, north), dvec2(west, north)]
}

/// A square around the origin.
pub(crate) fn square(half: f64) -> Vec<DVec2> {
    rect([-half, -half], [half, half])
}

/// A box between two opposite corners.
pub(crate) fn block(low: [f64; 3], high: [f64; 3]) -> Solid {
    prism(&rect([low[0], low[1]], [high[0], high[1]]), low[2], high[2])
}

/// A profile in the plane of `across` and up, drawn along a straight line: a hall, a roof, a gutter.
pub(crate) fn extrude(profile: &[DVec2], from: DVec3, to: DVec3, across: DVec3) -> Solid {
    loft(&[from, to].map(|end| profile.iter().map(|point| end + point.x * across + point.y * DVec3::Z).collect()))
}

/// A straight bar from `from` to `to`: `width` level, `depth` across it.
pub(crate) fn strut(from: DVec3, to: DVec3, width: f64, depth: f64) -> Solid {
    let along = to - from;
    let level = if along.x == 0.0 && along.y == 0.0 { DVec3::X } else { DVec3::Z.cross(along) };
    let side = level * (width / 2.0 / level.length());
    let across = along.cross(level);
    let up = across * (depth / 2.0 / across.length());
    loft(&[from, to].map(|end| vec![end - side - up, end + side - up, end + side + up, end - side + up]))
}

/// A round body on an upright axis; the profile gives radius and height from the bottom up.
pub(crate) fn lathe(foot: DVec3, profile: &[(f64, f64)], sides: u32) -> Solid {
    loft(&lathe_rings(foot, profile, sides))
}

/// As [`lathe`], with the profile going around to its first point: a chimney's tube, a rail.
pub(crate) fn lathe_hoop(foot: DVec3, profile: &[(f64, f64)], sides: u32) -> Solid {
    hoop(&lathe_rings(foot, profile, sides))
}

fn lathe_rings(foot: DVec3, profile: &[(f64, f64)], sides: u32) -> Vec<Vec<DVec3>> {
    profile.iter().map(|&(radius, z)| circle(foot + z * DVec3::Z, radius, sides)).collect()
}

/// A round pipe along a line of points; at each bend the section lies in the plane that halves it.
pub(crate) fn pipe(line: &[DVec3], radius: f64, sides: u32) -> Solid {
    let unit = |vector: DVec3| vector / vector.length();
    let pieces: Vec<DVec3> = line.windows(2).map(|ends| unit(ends[1] - ends[0])).collect();
    let level = if pieces[0].x == 0.0 && pieces[0].y == 0.0 { DVec3::X } else { unit(DVec3::Z.cross(pieces[0])) };
    let up = pieces[0].cross(level);
    let section = circle(DVec3::ZERO, radius, sides).into_iter();
    let mut rings = vec![section.map(|point| line[0] + point.x * level + point.y * up).collect::<Vec<_>>()];
    for (index, &piece) in pieces.iter().enumerate() {
        let next = pieces.get(index + 1).unwrap_or(&piece);
        let normal = piece + next;
        // Slid along the piece into the next bend's plane, the section neither twists nor thins.
        let slide = |&point: &DVec3| point + piece * ((line[index + 1] - point).dot(normal) / piece.dot(normal));
        let ring = rings[index].iter().map(slide).collect();
        rings.push(ring);
    }
    loft(&rings)
}

/// A row of equal things.
pub(crate) fn row(count: u32, from: DVec3, step: DVec3) -> impl Iterator<Item = DVec3> {
    (0..count).map(move |index| from + f64::from(index) * step)
}

/// A box on its foot: half its size in plan, and its height.
pub(crate) fn on_foot(foot: DVec3, half_x: f64, half_y: f64, height: f64) -> Solid {
    loft(&[0.0, height].map(|z| rectangle(foot + z * DVec3::Z, dvec2(half_x, half_y))))
}
