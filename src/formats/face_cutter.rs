//! Faces in space → triangles that keep the winding: polygons of meshes, faces of city models, outlines of footprints.

use super::left_out::{LeftOutTally, counted};
use super::monotone;
use crate::message::{Message, message};
use earcut::Earcut;
use glam::{DVec2, DVec3};
use rustc_hash::FxHashSet;

/// The most corners of a face whose ears are clipped: that takes the square of them at worst. Larger ones are swept.
const MOST_CLIPPED: usize = 20_000;

/// The most corners of a face.
const MOST_CORNERS: usize = 400_000;

/// Cuts faces; one is kept for all of a file, so that its memory is taken once.
pub(super) struct FaceCutter {
    earcut: Earcut<f64>,
    flat: Vec<[f64; 2]>,
    holes: Vec<u32>,
    numbers: Vec<u32>,
    triangles: Vec<[u32; 3]>,
    /// Faces that cross themselves, whose triangles do not cover what they enclose.
    crossed: u64,
}

/// Why a face has no triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Uncut {
    /// Fewer than three corners, or all of them on a line.
    NoArea,
    /// It encloses as much to its left as to its right, though its corners are on no line.
    Crossing,
    /// A coordinate is infinite or NaN.
    NoPoint,
    /// More corners than a face may have.
    TooLarge,
    /// So many that it would be swept, which needs rings that neither cross nor touch.
    LargeAndCrossing,
}

impl Uncut {
    /// As a clause of what is left out.
    pub(super) fn why(self) -> &'static str {
        match self {
            Uncut::NoArea => "no area",
            Uncut::Crossing => "crosses itself, or runs back on itself",
            Uncut::NoPoint => "a coordinate is no number",
            Uncut::TooLarge => "more than 400,000 corners",
            Uncut::LargeAndCrossing => "more than 20,000 corners, and rings that cross or touch",
        }
    }
}

/// A face in triangles.
pub(super) struct CutFace<'a> {
    /// The indices of its corners, through all rings. They have the winding of the outer ring.
    pub triangles: &'a [[u32; 3]],
    /// Whether the triangles cover what the rings enclose. They do not where rings cross.
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

    /// The triangles of a face whose rings follow each other in `points` and end before `ends`; the first is the outer one.
    /// A ring may repeat its first point at its end.
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

    /// The triangles of a mesh's face; what has none is told. A triangle is not cut, and stays without area, too: whoever
    /// welds counts it.
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

    /// The triangles of a mesh's face of one ring.
    pub(super) fn polygon(&mut self, corners: &[DVec3], tally: &mut LeftOutTally) -> &[[u32; 3]] {
        self.triangles(corners, &[corners.len()], tally)
    }

    /// That faces cross themselves, where some do: no triangles of theirs are right.
    pub(super) fn crossing_note(&self) -> Option<Message> {
        let cross = if self.crossed == 1 { "crosses itself" } else { "cross themselves" };
        let faces = counted(self.crossed, "face");
        (self.crossed > 0).then(|| message![format!("has {faces} that {cross}, so what of them casts is a guess")])
    }

    /// Clips a face, seen from the side to which it is turned; gives whether its triangles cover what it encloses.
    fn clip(&mut self, points: &[DVec3], ends: &[usize], normal: DVec3) -> Result<bool, Uncut> {
        let [first, ..] = *points else { return Err(Uncut::NoArea) };
        let axes = seen_along(normal);
        self.flat.clear();
        self.flat.extend(points.iter().map(|&point| axes.map(|axis| (point - first)[axis])));
        if repeats(&self.flat) {
            // from the first corner to each side: right for one that runs around a convex polygon again and again
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
            // the ring runs counter-clockwise in these axes, and so must the triangles
            self.triangles.push(if area < 0.0 { [a, c, b] } else { [a, b, c] });
        }
        if self.triangles.is_empty() || !covered.is_finite() {
            return Err(without_area(points.get(..ends.first().copied().unwrap_or(0)).unwrap_or_default()));
        }
        let enclosed = self.enclosed(ends);
        Ok((covered - enclosed).abs() <= 1e-3 * enclosed)
    }

    /// Cuts a large face into triangles that cover what it encloses.
    fn sweep(&mut self, ends: &[usize]) -> Result<bool, Uncut> {
        let swept = monotone::triangles(&self.flat, ends).ok_or(Uncut::LargeAndCrossing)?;
        let at = |corner: u32| self.flat.get(corner as usize).map_or(DVec2::NAN, |&point| DVec2::from(point));
        let area = |&[a, b, c]: &[u32; 3]| (at(b) - at(a)).perp_dot(at(c) - at(a));
        let (covered, enclosed) = (swept.iter().map(area).sum::<f64>(), self.enclosed(ends));
        // no number is no proof either
        let is_exact = (covered - enclosed).abs() <= 1e-6 * enclosed;
        self.triangles.extend(swept);
        if is_exact { Ok(true) } else { Err(Uncut::LargeAndCrossing) }
    }

    /// Twice what the outer ring encloses, without the holes.
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

/// Twice the area of a flat ring, positive where it runs counter-clockwise.
pub(super) fn ring_area(ring: &[[f64; 2]]) -> f64 {
    let Some(&first) = ring.first() else { return 0.0 };
    let from = |&point: &[f64; 2]| DVec2::from(point) - DVec2::from(first);
    ring.windows(2).map(|pair| from(&pair[0]).perp_dot(from(&pair[1]))).sum()
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

/// Why a ring encloses nothing: all its corners are on a line, or what it encloses cancels.
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

/// The normal of a ring by Newell's method, as long as twice its area.
fn normal(ring: &[DVec3]) -> DVec3 {
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
