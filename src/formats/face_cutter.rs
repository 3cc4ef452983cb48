//! Cuts faces in space into triangles that keep the winding: polygons of meshes, faces of city models, outlines of
//! footprints.

use super::left_out::{LeftOutTally, counted};
use super::monotone;
use crate::message::{Message, message};
use earcut::Earcut;
use glam::{DVec2, DVec3};
use rustc_hash::FxHashSet;

/// The most corners of a face that is cut by ear clipping, which takes quadratic time at worst. Larger faces are swept.
const MOST_CLIPPED: usize = 20_000;

/// The most corners of a face.
const MOST_CORNERS: usize = 400_000;

/// Cuts faces. One is used for a whole file, so that its buffers are reused.
pub(super) struct FaceCutter {
    earcut: Earcut<f64>,
    flat: Vec<[f64; 2]>,
    holes: Vec<u32>,
    numbers: Vec<u32>,
    triangles: Vec<[u32; 3]>,
    /// The number of faces that cross themselves, whose triangles do not cover what they enclose.
    crossed: u64,
}

/// Why a face could not be cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Uncut {
    /// Fewer than three corners, or all of them on a line.
    NoArea,
    /// It encloses equal areas on its left and right, although its corners are not on a line.
    Crossing,
    /// A coordinate is infinite or NaN.
    NoPoint,
    /// More corners than a face may have.
    TooLarge,
    /// So many corners that it must be swept, which needs rings that neither cross nor touch.
    LargeAndCrossing,
}

impl Uncut {
    /// The reason as a clause for the list of what was left out.
    pub(super) fn why(self) -> &'static str {
        match self {
            Uncut::NoArea => "no area",
            Uncut::Crossing => "crosses itself, or runs back on itself",
            Uncut::NoPoint => "a coordinate is not a number",
            Uncut::TooLarge => "more than 400,000 corners",
            Uncut::LargeAndCrossing => "more than 20,000 corners, and rings that cross or touch",
        }
    }
}

/// The triangles of a face.
pub(super) struct CutFace<'a> {
    /// Indices into the corners of all rings, with the winding of the outer ring.
    pub triangles: &'a [[u32; 3]],
    /// Whether the triangles cover what the rings enclose. They do not if rings cross.
    pub is_exact: bool,
}

impl FaceCutter {
    pub(super) fn new() -> Self {
        Self {
            earcut: Earcut::new(),
            flat: Vec::new(),
            holes: Vec::new(),
            numbers: Vec::new(),
            triangles: Vec::new(),
            crossed: 0,
        }
    }

    /// Cuts a face whose rings are consecutive in `points` and end at `ends`; the first is the outer one. A ring may
    /// repeat its first point at its end.
    pub(super) fn cut(&mut self, points: &[DVec3], ends: &[usize]) -> Result<CutFace<'_>, Uncut> {
        let outer = points.get(..ends.first().copied().unwrap_or(0)).unwrap_or_default();
        if points.len() > MOST_CORNERS {
            return Err(Uncut::TooLarge);
        }
        if !points.iter().all(|point| point.is_finite()) {
            return Err(Uncut::NoPoint);
        }
        let normal = normal(outer);
        if outer.len() < 3 || !(normal.is_finite() && normal.length_squared() > 0.0) {
            return Err(without_area(outer));
        }
        self.triangles.clear();
        let is_exact = match *points {
            [_, _, _] => {
                self.triangles.push([0, 1, 2]);
                true
            }
            [a, b, c, d] if outer.len() == 4 && convex([a, b, c, d]) => {
                self.triangles.extend([[0, 1, 2], [0, 2, 3]]);
                true
            }
            _ => self.clip(points, ends, normal)?,
        };
        self.crossed += u64::from(!is_exact);
        Ok(CutFace { triangles: &self.triangles, is_exact })
    }

    /// Cuts a face of a mesh; a face without triangles is counted. A triangle is kept even without area, since welding
    /// counts it.
    pub(super) fn triangles(&mut self, points: &[DVec3], ends: &[usize], tally: &mut LeftOutTally) -> &[[u32; 3]] {
        if points.len() == 3 && ends.len() == 1 {
            self.triangles.clear();
            self.triangles.push([0, 1, 2]);
            return &self.triangles;
        }
        match self.cut(points, ends) {
            Ok(cut) => cut.triangles,
            Err(uncut) => {
                tally.add("faces", uncut.why());
                &[]
            }
        }
    }

    /// Cuts a face of a mesh with a single ring.
    pub(super) fn polygon(&mut self, corners: &[DVec3], tally: &mut LeftOutTally) -> &[[u32; 3]] {
        self.triangles(corners, &[corners.len()], tally)
    }

    /// A note if faces cross themselves, as their triangles cannot be right.
    pub(super) fn crossing_note(&self) -> Option<Message> {
        let cross = if self.crossed == 1 { "crosses itself" } else { "cross themselves" };
        let faces = counted(self.crossed, "face");
        (self.crossed > 0).then(|| message![format!("has {faces} that {cross}, so what of them casts is a guess")])
    }

    /// Cuts a face by ear clipping, seen from its front. Returns whether its triangles cover what it encloses.
    fn clip(&mut self, points: &[DVec3], ends: &[usize], normal: DVec3) -> Result<bool, Uncut> {
        let [first, ..] = *points else { return Err(Uncut::NoArea) };
        let axes = seen_along(normal);
        self.flat.clear();
        self.flat.extend(points.iter().map(|&point| axes.map(|axis| (point - first)[axis])));
        if repeats(&self.flat) {
            // a fan from the first corner: right for a ring around a convex polygon, even several times around
            let last = (ends.first().copied().unwrap_or(0) as u32).saturating_sub(1);
            self.triangles.extend((1..last).map(|corner| [0, corner, corner + 1]));
            return Ok(false);
        }
        if points.len() > MOST_CLIPPED {
            return self.sweep(ends);
        }
        self.holes.clear();
        self.holes.extend(ends[..ends.len().saturating_sub(1)].iter().map(|&end| end as u32));
        self.earcut.earcut_slice(&self.flat, &self.holes, &mut self.numbers);
        let mut covered = 0.0;
        for &[a, b, c] in self.numbers.as_chunks().0 {
            let at = |number: u32| self.flat.get(number as usize).map_or(DVec2::NAN, |&point| DVec2::from(point));
            let area = (at(b) - at(a)).perp_dot(at(c) - at(a));
            covered += area.abs();
            // the ring is counter-clockwise in these axes, and so must the triangles be
            self.triangles.push(if area < 0.0 { [a, c, b] } else { [a, b, c] });
        }
        if self.triangles.is_empty() || !covered.is_finite() {
            return Err(without_area(points.get(..ends.first().copied().unwrap_or(0)).unwrap_or_default()));
        }
        let enclosed = self.enclosed(ends);
        Ok((covered - enclosed).abs() <= 1e-3 * enclosed)
    }

    /// Cuts a large face by a sweep. Returns whether the triangles cover what it encloses.
    fn sweep(&mut self, ends: &[usize]) -> Result<bool, Uncut> {
        let swept = monotone::triangles(&self.flat, ends).ok_or(Uncut::LargeAndCrossing)?;
        let at = |corner: u32| self.flat.get(corner as usize).map_or(DVec2::NAN, |&point| DVec2::from(point));
        let area = |&[a, b, c]: &[u32; 3]| (at(b) - at(a)).perp_dot(at(c) - at(a));
        let (covered, enclosed) = (swept.iter().map(area).sum::<f64>(), self.enclosed(ends));
        // false for NaN
        let is_exact = (covered - enclosed).abs() <= 1e-6 * enclosed;
        self.triangles.extend(swept);
        if is_exact { Ok(true) } else { Err(Uncut::LargeAndCrossing) }
    }

    /// Twice the area of the outer ring without the holes.
    fn enclosed(&self, ends: &[usize]) -> f64 {
        let (mut start, mut enclosed) = (0, 0.0);
        for &end in ends {
            let area = ring_area(self.flat.get(start..end).unwrap_or_default()).abs();
            enclosed += if start == 0 { area } else { -area };
            start = end;
        }
        enclosed
    }
}

/// Twice the area of a flat ring, positive if it is counter-clockwise.
pub(super) fn ring_area(ring: &[[f64; 2]]) -> f64 {
    let Some(&first) = ring.first() else { return 0.0 };
    let from = |&point: &[f64; 2]| DVec2::from(point) - DVec2::from(first);
    ring.windows(2).map(|pair| from(&pair[0]).perp_dot(from(&pair[1]))).sum()
}

/// Whether a large polygon visits each corner more than twice on average: clipping it would take cubic time. A polygon
/// that is cut open to its holes visits some corners twice.
fn repeats(corners: &[[f64; 2]]) -> bool {
    const LARGE: usize = 200;
    let distinct = || corners.iter().map(|corner| corner.map(f64::to_bits)).collect::<FxHashSet<_>>().len();
    corners.len() > LARGE && 2 * distinct() < corners.len()
}

/// Whether the diagonal from the first to the third corner lies inside, and both halves face the same way.
fn convex([a, b, c, d]: [DVec3; 4]) -> bool {
    let half = (b - a).cross(c - a);
    let other = (c - a).cross(d - a);
    half.dot(other) > 0.0 && (c - b).cross(d - b).dot((d - b).cross(a - b)) > 0.0
}

/// Why a ring encloses nothing: its corners are on a line, or its areas cancel.
fn without_area(ring: &[DVec3]) -> Uncut {
    const NARROW: f64 = 1e-9;
    let Some(&first) = ring.first() else { return Uncut::NoArea };
    let from_first = || ring.iter().map(|&corner| corner - first);
    let far = from_first().fold(
        DVec3::ZERO,
        |far, corner| {
            if corner.length_squared() > far.length_squared() { corner } else { far }
        },
    );
    let is_off = |corner: DVec3| far.cross(corner).length() > NARROW * far.length_squared();
    if from_first().any(is_off) { Uncut::Crossing } else { Uncut::NoArea }
}

/// The normal of a ring by Newell's method; its length is twice the area.
fn normal(ring: &[DVec3]) -> DVec3 {
    let Some(&first) = ring.first() else { return DVec3::ZERO };
    ring.windows(2)
        .map(|two| match *two {
            [a, b] => (a - first).cross(b - first),
            _ => DVec3::ZERO,
        })
        .sum()
}

/// The two axes in which a face with this normal appears largest and counter-clockwise.
fn seen_along(normal: DVec3) -> [usize; 2] {
    let along = normal.abs().max_position();
    let axes = [(along + 1) % 3, (along + 2) % 3];
    if normal[along] < 0.0 { [axes[1], axes[0]] } else { axes }
}
