//! A caster's face as the sun sees it.

use glam::{DVec2, DVec3, Vec3Swizzles};

/// A caster's face as it falls along the sun.
pub(super) struct FallingFace {
    /// Where they fall, and their heights.
    pub(super) corners: [DVec3; 3],
    /// From where to where its heights reach.
    low: f64,
    high: f64,
    /// Per side a linear function that is nowhere below 0 on the face: factors of column and row, and a constant.
    sides: [DVec3; 3],
    /// The height over it, in the same way.
    height: DVec3,
}

impl FallingFace {
    /// None where the sun sees it from its edge: then it shades nothing.
    pub(super) fn new(vertices: [u32; 3], corners: [DVec3; 3]) -> Option<FallingFace> {
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a);
        if normal.z == 0.0 {
            return None;
        }
        let side = |from: usize, to: usize| {
            // from the lower vertex to the higher, whichever face asks, so that neighbours find the same but for its sign
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
        // nearly edge-on the height over it wavers, but not beyond its corners
        let over = of(&self.height).min(self.high).max(self.low);
        (one >= 0.0) & (other >= 0.0) & (third >= 0.0) & (over > height)
    }
}
