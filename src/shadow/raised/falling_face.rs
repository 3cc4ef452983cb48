//! A caster's face, projected along the sun.

use glam::{DVec2, DVec3, Vec3Swizzles};

/// A caster's face, projected along the sun.
pub(super) struct FallingFace {
    /// The projected corners, with their heights.
    pub(super) corners: [DVec3; 3],
    /// The range of its heights.
    low: f64,
    high: f64,
    /// For each side a linear function that is never negative on the face: factors of column and row, and a constant.
    sides: [DVec3; 3],
    /// Its height as such a function.
    height: DVec3,
}

impl FallingFace {
    /// `None` if the sun sees it edge-on: then it shades nothing.
    pub(super) fn new(vertices: [u32; 3], corners: [DVec3; 3]) -> Option<FallingFace> {
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a);
        if normal.z == 0.0 {
            return None;
        }
        let side = |from: usize, to: usize| {
            // always from the lower vertex to the higher, so that neighbours compute the same up to the sign
            let is_turned = vertices[from] > vertices[to];
            let [start, end] = if is_turned { [corners[to], corners[from]] } else { [corners[from], corners[to]] };
            let across = DVec2::new(start.y - end.y, end.x - start.x);
            let line = across.extend(-across.dot(start.xy()));
            if is_turned == (normal.z > 0.0) { -line } else { line }
        };
        let slope = -normal.xy() / normal.z;
        Some(FallingFace {
            corners,
            low: a.z.min(b.z).min(c.z),
            high: a.z.max(b.z).max(c.z),
            sides: [side(0, 1), side(1, 2), side(2, 0)],
            height: slope.extend(a.z - slope.dot(a.xy())),
        })
    }

    #[inline]
    pub(super) fn shades(&self, column: f64, row: f64, height: f64) -> bool {
        let of = |line: &DVec3| line.x * column + line.y * row + line.z;
        let [one, other, third] = [of(&self.sides[0]), of(&self.sides[1]), of(&self.sides[2])];
        // for nearly edge-on faces the height is inaccurate, but stays within its corners'
        let over = of(&self.height).min(self.high).max(self.low);
        (one >= 0.0) & (other >= 0.0) & (third >= 0.0) & (over > height)
    }
}
