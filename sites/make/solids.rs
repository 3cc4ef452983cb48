//! Closed, well-wound solids on a grid of 1/1024 m.
//!
//! A solid is drawn with `f64` and kept in whole grid steps, so that every check on it is exact and a file has the
//! same bytes on every system. Only `+ − × ÷ √` are used on the way, which IEEE 754 rounds equally everywhere; the
//! sine of the standard library is the system's own and may differ in its last bit.

use glam::{DVec2, DVec3, dvec2, dvec3};
use std::collections::HashMap;

/// Grid steps in a metre: a power of two, so that a step is exact in `f32` up to 16 km from the origin.
pub(crate) const STEPS: f64 = 1024.0;

/// Grid steps east, north, up.
pub(crate) type Point = [i32; 3];

/// A closed surface, counter-clockwise seen from outside.
#[derive(Clone, Debug)]
pub(crate) struct Solid {
    pub(crate) points: Vec<Point>,
    pub(crate) triangles: Vec<[u32; 3]>,
}

impl Solid {
    /// Welds equal points, drops what the weld made flat, and turns the surface outwards.
    fn new(points: &[Point], triangles: &[[u32; 3]]) -> Self {
        let mut index_of = HashMap::new();
        let mut welded = Vec::new();
        let mut weld = |corner: u32| {
            let point = points[corner as usize];
            *index_of.entry(point).or_insert_with(|| {
                welded.push(point);
                welded.len() as u32 - 1
            })
        };
        let mut kept: Vec<[u32; 3]> = triangles
            .iter()
            .map(|triangle| triangle.map(&mut weld))
            .filter(|[a, b, c]| a != b && b != c && c != a)
            .collect();
        if volume(&welded, &kept) < 0 {
            kept.iter_mut().for_each(|triangle| triangle.reverse());
        }
        let solid = Self {
            points: welded,
            triangles: kept,
        };
        solid.assert_sound();
        solid
    }

    /// Every edge joins exactly two triangles that run along it in opposite directions, every triangle has an area,
    /// and the whole has a volume.
    fn assert_sound(&self) {
        let mut edges = HashMap::new();
        for &[a, b, c] in &self.triangles {
            for edge in [[a, b], [b, c], [c, a]] {
                *edges.entry(edge).or_insert(0) += 1;
            }
            let corners = [a, b, c].map(|corner| self.points[corner as usize]);
            assert_ne!(area(corners), [0; 3], "a triangle without area: {corners:?}");
        }
        for (&[a, b], &count) in &edges {
            let ends = [self.points[a as usize], self.points[b as usize]];
            assert_eq!(count, 1, "{count} triangles run along {ends:?}");
            assert!(edges.contains_key(&[b, a]), "nothing closes the edge {ends:?}");
        }
        assert!(volume(&self.points, &self.triangles) > 0, "a solid without volume");
    }
}

/// Metres to the nearest grid point.
pub(crate) fn on_grid(metres: DVec3) -> Point {
    (metres * STEPS).to_array().map(|steps| steps.round() as i32)
}

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
    (0..sides)
        .map(|side| centre + (radius * on_circle(f64::from(side) / f64::from(sides))).extend(0.0))
        .collect()
}

/// A rectangle around `centre`, counter-clockwise seen from above.
pub(crate) fn rectangle(centre: DVec3, half: DVec2) -> Vec<DVec3> {
    [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
        .map(|(x, y)| centre + dvec3(x * half.x, y * half.y, 0.0))
        .to_vec()
}

/// Skins rings of equally many points one after the other and closes the two ends. A ring may shrink to a line or a
/// point (a ridge, an apex).
pub(crate) fn loft(rings: &[Vec<DVec3>]) -> Solid {
    let (points, mut triangles) = skin(rings, false);
    let count = rings[0].len();
    let last = (points.len() - count) as u32;
    let first_cap = triangulate(&points[..count]);
    let last_cap = triangulate(&points[last as usize..]);
    triangles.extend(first_cap.iter().map(|&[a, b, c]| [c, b, a]));
    triangles.extend(last_cap.iter().map(|cap| cap.map(|corner| corner + last)));
    Solid::new(&points, &triangles)
}

/// Skins rings of equally many points around to the first again: a tube, a wall around a court, a rail around a roof.
pub(crate) fn hoop(rings: &[Vec<DVec3>]) -> Solid {
    let (points, triangles) = skin(rings, true);
    Solid::new(&points, &triangles)
}

fn skin(rings: &[Vec<DVec3>], around: bool) -> (Vec<Point>, Vec<[u32; 3]>) {
    let count = rings[0].len() as u32;
    let points: Vec<Point> = rings.iter().flatten().map(|&point| on_grid(point)).collect();
    assert_eq!(points.len(), rings.len() * rings[0].len(), "rings of different lengths");
    let steps = rings.len() as u32 - u32::from(!around);
    let mut triangles = Vec::new();
    for ring in 0..steps {
        let here = ring * count;
        let there = (ring + 1) % rings.len() as u32 * count;
        for side in 0..count {
            let next = (side + 1) % count;
            triangles.push([here + side, here + next, there + next]);
            triangles.push([here + side, there + next, there + side]);
        }
    }
    (points, triangles)
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
    loft(&[from, to].map(|end| {
        profile
            .iter()
            .map(|point| end + point.x * across + point.y * DVec3::Z)
            .collect()
    }))
}

/// A straight bar from `from` to `to`: `width` level, `depth` across it.
pub(crate) fn strut(from: DVec3, to: DVec3, width: f64, depth: f64) -> Solid {
    let along = to - from;
    let level = if along.x == 0.0 && along.y == 0.0 {
        DVec3::X
    } else {
        DVec3::Z.cross(along)
    };
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
    profile
        .iter()
        .map(|&(radius, z)| circle(foot + z * DVec3::Z, radius, sides))
        .collect()
}

/// A round pipe along a line of points; at each bend the section lies in the plane that halves it.
pub(crate) fn pipe(line: &[DVec3], radius: f64, sides: u32) -> Solid {
    let unit = |vector: DVec3| vector / vector.length();
    let pieces: Vec<DVec3> = line.windows(2).map(|ends| unit(ends[1] - ends[0])).collect();
    let level = if pieces[0].x == 0.0 && pieces[0].y == 0.0 {
        DVec3::X
    } else {
        unit(DVec3::Z.cross(pieces[0]))
    };
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

/// Cuts a simple, nearly flat polygon into triangles by its ears; equal neighbours count once.
fn triangulate(ring: &[Point]) -> Vec<[u32; 3]> {
    let mut left: Vec<u32> = (0..ring.len() as u32).collect();
    left.dedup_by_key(|corner| ring[*corner as usize]);
    while left.len() > 1 && ring[left[0] as usize] == ring[*left.last().unwrap() as usize] {
        left.pop();
    }
    if left.len() < 3 {
        return Vec::new();
    }
    let at = |corner: u32| ring[corner as usize];
    let normal = left.windows(2).fold([0; 3], |sum, pair| {
        let part = area([at(left[0]), at(pair[0]), at(pair[1])]);
        std::array::from_fn(|axis| sum[axis] + part[axis])
    });
    let side = |a: u32, b: u32, c: u32| dot(area([at(a), at(b), at(c)]), normal);
    let mut triangles = Vec::new();
    let mut start = 0;
    while left.len() > 3 {
        let count = left.len();
        // Going on behind the last ear spreads the triangles instead of fanning all of them from one corner.
        let ear = (0..count).map(|offset| (start + offset) % count).find(|&here| {
            let [a, b, c] = [(here + count - 1) % count, here, (here + 1) % count].map(|slot| left[slot]);
            let is_free = |&other: &u32| {
                [a, b, c].contains(&other)
                    || side(a, b, other) < 0
                    || side(b, c, other) < 0
                    || side(c, a, other) < 0
            };
            side(a, b, c) > 0 && left.iter().all(is_free)
        });
        let here = ear.expect("a simple polygon has an ear");
        triangles.push([left[(here + count - 1) % count], left[here], left[(here + 1) % count]]);
        left.remove(here);
        start = here;
    }
    triangles.push([left[0], left[1], left[2]]);
    triangles
}

/// Twice the directed area of a triangle, exact.
fn area([a, b, c]: [Point; 3]) -> [i128; 3] {
    let edge = |to: Point| -> [i128; 3] { std::array::from_fn(|axis| i128::from(to[axis]) - i128::from(a[axis])) };
    let (u, v) = (edge(b), edge(c));
    [
        u[1] * v[2] - u[2] * v[1],
        u[2] * v[0] - u[0] * v[2],
        u[0] * v[1] - u[1] * v[0],
    ]
}

/// Six times the volume, exact.
fn volume(points: &[Point], triangles: &[[u32; 3]]) -> i128 {
    let six_fold = |&[a, b, c]: &[u32; 3]| {
        let corners = [a, b, c].map(|corner| points[corner as usize]);
        dot(area(corners), corners[0].map(i128::from))
    };
    triangles.iter().map(six_fold).sum()
}

fn dot(a: [i128; 3], b: [i128; 3]) -> i128 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
