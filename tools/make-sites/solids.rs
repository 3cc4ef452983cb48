//! Closed, well-wound solids on a grid of 1/1024 m.
//!
//! A solid is drawn with `f64` and stored in whole grid steps, so that every check on it is exact and a file has the
//! same bytes on every system. Only `+ − × ÷ √` are used on the way, which IEEE 754 rounds equally everywhere; the
//! standard library's sine is that of the system and may differ in its last bit.

use glam::DVec3;
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
        let solid = Self { points: welded, triangles: kept };
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
                [a, b, c].contains(&other) || side(a, b, other) < 0 || side(b, c, other) < 0 || side(c, a, other) < 0
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
    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
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
