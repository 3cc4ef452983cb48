//! Rings of points → triangles: the flat faces of city models and the outlines of footprints.

use earcut::Earcut;
use glam::{DVec2, DVec3};

/// The most corners of one face; a face with more is no building's, and would take the time of thousands.
const MOST_CORNERS: usize = 200_000;

/// Cuts faces into triangles; one is kept for all faces of a file, so that its memory is taken once.
pub(super) struct FaceCutter {
    earcut: Earcut<f64>,
    flat: Vec<[f64; 2]>,
    holes: Vec<u32>,
    corners: Vec<u32>,
}

/// Why a face has no triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Uncut {
    /// Fewer than three corners, or all in a line.
    NoArea,
    /// A coordinate is infinite or no number.
    NoPoint,
    /// More corners than a face may have.
    TooLarge,
}

impl Uncut {
    /// As a clause of what is left out.
    pub(super) fn why(self) -> &'static str {
        match self {
            Uncut::NoArea => "no area",
            Uncut::NoPoint => "a coordinate is no number",
            Uncut::TooLarge => "more than 200,000 corners",
        }
    }
}

/// A face in triangles.
pub(super) struct CutFace<'a> {
    /// Corners of the triangles, three by three, numbered through all rings; they turn as the outer ring does.
    pub corners: &'a [u32],
    /// Whether the triangles cover what the rings enclose; they do not where rings cross.
    pub is_exact: bool,
}

impl FaceCutter {
    pub(super) fn new() -> Self {
        Self { earcut: Earcut::new(), flat: Vec::new(), holes: Vec::new(), corners: Vec::new() }
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
        let normal = normal_of(outer);
        let Some(first) = outer.first().filter(|_| outer.len() > 2 && normal.length_squared() > 0.0) else {
            return Err(Uncut::NoArea);
        };
        if points.len() == 3 {
            self.corners.clear();
            self.corners.extend([0, 1, 2]);
            return Ok(CutFace { corners: &self.corners, is_exact: true });
        }
        let axes = dominant(normal);
        self.flat.clear();
        self.flat.extend(points.iter().map(|&point| {
            let [x, y] = axes.map(|axis| (point - first)[axis]);
            [x, y]
        }));
        self.holes.clear();
        self.holes.extend(ends[..ends.len().saturating_sub(1)].iter().map(|&end| end as u32));
        self.earcut.earcut_slice(&self.flat, &self.holes, &mut self.corners);
        let covered: f64 = self.corners.chunks_exact(3).map(|corners| self.area_of(corners)).sum();
        let enclosed = self.enclosed(ends);
        if self.corners.is_empty() || !covered.is_finite() {
            return Err(Uncut::NoArea);
        }
        // the ring runs counter-clockwise in these axes, and so must the triangles
        if covered < 0.0 {
            self.corners.chunks_exact_mut(3).for_each(|corners| corners.swap(1, 2));
        }
        let is_exact = (covered.abs() - enclosed).abs() <= 1e-3 * enclosed;
        Ok(CutFace { corners: &self.corners, is_exact })
    }

    /// Twice the area of a triangle, positive where it runs counter-clockwise.
    fn area_of(&self, corners: &[u32]) -> f64 {
        let at = |corner: u32| self.flat.get(corner as usize).map(|&point| DVec2::from(point));
        let &[a, b, c] = corners else { return f64::NAN };
        match (at(a), at(b), at(c)) {
            (Some(a), Some(b), Some(c)) => (b - a).perp_dot(c - a),
            _ => f64::NAN,
        }
    }

    /// Twice what the outer ring encloses, without the holes.
    fn enclosed(&self, ends: &[usize]) -> f64 {
        let mut start = 0;
        let mut enclosed = 0.0;
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

/// The normal of a ring by Newell's method, as long as twice its area.
fn normal_of(ring: &[DVec3]) -> DVec3 {
    let Some(&first) = ring.first() else { return DVec3::ZERO };
    ring.windows(2).map(|pair| (pair[0] - first).cross(pair[1] - first)).sum()
}

/// The axes of the plane that a ring is seen in most broadly and counter-clockwise.
fn dominant(normal: DVec3) -> [usize; 2] {
    let size = normal.abs();
    let (axes, along) = if size.z >= size.x && size.z >= size.y {
        ([0, 1], normal.z)
    } else if size.x >= size.y {
        ([1, 2], normal.x)
    } else {
        ([2, 0], normal.y)
    };
    if along < 0.0 { [axes[1], axes[0]] } else { axes }
}
