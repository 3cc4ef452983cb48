//! Polygons in space → triangles, as they are wound.

use earcut::Earcut;
use glam::{DVec2, DVec3};
use rustc_hash::FxHashSet;

/// The most corners of a polygon: clipping one takes the square of them at worst.
const MOST_CORNERS: usize = 20_000;

/// Cuts polygons; one is kept for all of a file, so that its memory is taken once.
pub(super) struct PolygonCutter {
    earcut: Earcut<f64>,
    flat: Vec<[f64; 2]>,
    numbers: Vec<u32>,
    triangles: Vec<[u32; 3]>,
    /// Polygons without triangles: fewer than three corners, or no area.
    pub empty: u64,
    /// Polygons of more corners than are cut.
    pub large: u64,
    /// Polygons that cross themselves, whose triangles do not cover what they enclose.
    pub crossed: u64,
}

impl PolygonCutter {
    pub(super) fn new() -> Self {
        Self {
            earcut: Earcut::new(),
            flat: Vec::new(),
            numbers: Vec::new(),
            triangles: Vec::new(),
            empty: 0,
            large: 0,
            crossed: 0,
        }
    }

    /// The triangles of a polygon, as numbers of its corners; none where it has no area. `holes` are the corners at which
    /// rings after the first begin.
    pub(super) fn cut(&mut self, corners: &[DVec3], holes: &[u32]) -> &[[u32; 3]] {
        self.triangles.clear();
        match *corners {
            // a triangle without area stays: whoever welds counts it
            [_, _, _] if holes.is_empty() => self.triangles.push([0, 1, 2]),
            [a, b, c, d] if holes.is_empty() => match convex([a, b, c, d]) {
                true => self.triangles.extend([[0, 1, 2], [0, 2, 3]]),
                false => self.clip(corners, holes),
            },
            [] | [_] | [_, _] => (),
            _ if corners.len() > MOST_CORNERS => {
                self.large += 1;
                return &[];
            }
            _ => self.clip(corners, holes),
        }
        self.empty += u64::from(self.triangles.is_empty());
        &self.triangles
    }

    fn clip(&mut self, corners: &[DVec3], holes: &[u32]) {
        let outer = holes.first().map_or(corners, |&hole| corners.get(..hole as usize).unwrap_or_default());
        let (Some(&first), normal) = (outer.first(), normal(outer)) else { return };
        if !(normal.is_finite() && normal.length_squared() > 0.0) {
            return;
        }
        // seen from the side to which it is turned, along the axis nearest to its normal
        let axes = seen_along(normal);
        self.flat.clear();
        self.flat.extend(corners.iter().map(|&corner| axes.map(|axis| (corner - first)[axis])));
        if repeats(&self.flat) {
            self.crossed += 1;
            // from the first corner to each side: right for one that runs around a convex polygon again and again
            let last = outer.len() as u32 - 1;
            self.triangles.extend((1..last).map(|corner| [0, corner, corner + 1]));
            return;
        }
        self.earcut.earcut_slice(&self.flat, holes, &mut self.numbers);
        let mut covered = 0.0;
        for &[a, b, c] in self.numbers.as_chunks().0 {
            let at = |number: u32| self.flat.get(number as usize).map_or(DVec2::NAN, |&point| DVec2::from(point));
            let area = (at(b) - at(a)).perp_dot(at(c) - at(a));
            covered += area.abs();
            self.triangles.push(if area < 0.0 { [a, c, b] } else { [a, b, c] });
        }
        let enclosed = self.enclosed(holes);
        self.crossed += u64::from((covered - enclosed).abs() > 1e-3 * enclosed);
    }

    /// Twice what the first ring encloses, without the others.
    fn enclosed(&self, holes: &[u32]) -> f64 {
        let ends = holes.iter().map(|&hole| hole as usize).chain([self.flat.len()]);
        let (mut begin, mut enclosed) = (0, 0.0);
        for end in ends {
            let ring = self.flat.get(begin..end).unwrap_or_default();
            let next = ring.iter().cycle().skip(1);
            let area: f64 = ring.iter().zip(next).map(|(a, b)| DVec2::from(*a).perp_dot(DVec2::from(*b))).sum();
            enclosed += if begin == 0 { area.abs() } else { -area.abs() };
            begin = end;
        }
        enclosed
    }
}

/// Whether a large polygon comes to its corners again and again, more than twice to each: clipping it would take the cube of
/// them. One that is cut open to its holes comes twice to some.
fn repeats(corners: &[[f64; 2]]) -> bool {
    const LARGE: usize = 200;
    let distinct = || corners.iter().map(|corner| corner.map(f64::to_bits)).collect::<FxHashSet<_>>().len();
    corners.len() > LARGE && 2 * distinct() < corners.len()
}

/// Whether the diagonal from the first to the third corner lies within, and both halves look to one side.
fn convex([a, b, c, d]: [DVec3; 4]) -> bool {
    let half = (b - a).cross(c - a);
    let other = (c - a).cross(d - a);
    half.dot(other) > 0.0 && (c - b).cross(d - b).dot((d - b).cross(a - b)) > 0.0
}

/// The normal of a ring by Newell's method, as long as twice its area.
pub(super) fn normal(ring: &[DVec3]) -> DVec3 {
    let Some(&first) = ring.first() else { return DVec3::ZERO };
    ring.windows(2)
        .map(|two| match *two {
            [a, b] => (a - first).cross(b - first),
            _ => DVec3::ZERO,
        })
        .sum()
}

/// The two axes in which what has this normal is seen most broadly and counter-clockwise.
fn seen_along(normal: DVec3) -> [usize; 2] {
    let along = normal.abs().max_position();
    let axes = [(along + 1) % 3, (along + 2) % 3];
    if normal[along] < 0.0 { [axes[1], axes[0]] } else { axes }
}
