//! Whether a texel lies beside what is thinner than a texel: asked by rays from finer points.

use super::SoftTexture;
use super::query::raster;
use crate::mesh::patches::Texel;
use crate::shadow::JUDGED_ABOVE_M;
use crate::shadow::ray_cast::Shear;
use glam::DVec3;

/// So many points a texel's side are asked.
const FINE: u32 = 8;

impl SoftTexture {
    /// Whether all points around a texel see the sun alike: those of the texel, and of its neighbours that belong to the same
    /// patch.
    pub fn is_uniform_around(&self, patch: usize, texel: Texel, to_sun: DVec3) -> bool {
        let patch = &self.patches.list[patch];
        let cell = self.patches.cell;
        let Some(raster) = raster(patch, cell, to_sun.extend(0.0)) else { return true };
        let judge = self.judge(&[]);
        let shear = Shear::along(to_sun);
        let lift = judge.tie(patch) + raster.plane.truncate() * JUDGED_ABOVE_M;
        let near = |one: u16, other: u16| one.abs_diff(other) <= 1;
        let around = |other: &&Texel| near(other.column, texel.column) && near(other.row, texel.row);
        let step = |number: u32| ((f64::from(number) + 0.5) / f64::from(FINE) - 0.5) * cell;
        let mut lit = judge.texels(patch).iter().filter(around).flat_map(|texel| {
            let centre = self.patches.point(patch, *texel) + lift;
            let fine = (0..FINE * FINE).map(|number| (step(number % FINE), step(number / FINE)));
            fine.map(move |(right, down)| centre + patch.right * right + patch.down * down)
        });
        let is_lit = |point: DVec3| !judge.rays.blocked(point, &shear);
        let Some(first) = lit.next().map(is_lit) else { return true };
        lit.all(|point| is_lit(point) == first)
    }
}
