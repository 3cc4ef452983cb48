//! Patches under the sun, by rays from rectangles of texels: most rectangles lie wholly in the sun or wholly in the
//! shadow of one face, and need no ray of their own ([`crate::shadow::rays`]).

use super::fill::Scratch;
use super::query::{PatchJudgements, Sample};
use super::{PatchJudge, count};
use crate::mesh::patches::{Patch, Texel};
use crate::shadow::JUDGED_ABOVE_M;
use crate::shadow::rays::{CellSet, RasterFate, RayRaster, Shear};
use crate::shadow::registered::Raster;

impl PatchJudge<'_> {
    /// Adds the sun's weight to the texels of a patch that see it.
    pub(super) fn divide(
        &self,
        patch: &Patch,
        raster: &Raster,
        sample: &Sample,
        sums: &mut [u32],
        scratch: &mut Scratch,
    ) {
        let (tie, lift) = (self.tie(patch), raster.plane.truncate() * JUDGED_ABOVE_M);
        let texels = self.texels(patch);
        // a patch that is judged at a single point is a raster of one texel
        let (size, first) = match patch.alone {
            Some(_) => ([1, 1], texels[0]),
            None => ([patch.width, patch.height], Texel { column: 0, row: 0 }),
        };
        let origin = |column: u32, row: u32| {
            let texel = Texel { column: first.column + column as u16, row: first.row + row as u16 };
            self.sought.patches.point(patch, texel) + tie + lift
        };
        let Scratch { blocked, asked, .. } = scratch;
        let is_full = texels.len() as u64 == u64::from(size[0]) * u64::from(size[1]);
        if !is_full {
            asked.reset(size[0], size[1]);
            texels.iter().for_each(|texel| asked.add(texel.column.into(), texel.row.into()));
        }
        let from = RayRaster { size, plane: raster.plane, origin, asked: (!is_full).then_some(&*asked) };
        let (fate, rays) = self.rays.blocked_raster(&from, &Shear::along(sample.light.truncate()), blocked);
        let rectangle_texels = texels.len() as u64 - rays;
        count(self.counts, PatchJudgements { rays, rectangle_texels, ..PatchJudgements::default() });
        match fate {
            RasterFate::Blocked => {}
            RasterFate::Open => sums.iter_mut().for_each(|sum| *sum += sample.weight),
            RasterFate::Mixed if is_full => add_by_rows(blocked.cells(), size[0] as usize, sums, sample.weight),
            RasterFate::Mixed => {
                for (sum, texel) in sums.iter_mut().zip(texels) {
                    if !blocked.cells().has(texel.column.into(), texel.row.into()) {
                        *sum += sample.weight;
                    }
                }
            }
        }
    }
}

/// Adds a weight to the cells that are not blocked, of a raster that has them all.
fn add_by_rows(blocked: &CellSet, width: usize, sums: &mut [u32], weight: u32) {
    for (row, sums) in (0..).zip(sums.chunks_exact_mut(width)) {
        for (blocked, sums) in blocked.row(row).iter().zip(sums.chunks_mut(8)) {
            for (at, sum) in sums.iter_mut().enumerate() {
                *sum += if blocked >> at & 1 == 0 { weight } else { 0 };
            }
        }
    }
}
