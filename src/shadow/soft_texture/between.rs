//! Finds when texels change between two instants: bisects with one ray per texel and moment, starting at the
//! neighbour's change.

use super::query::raster;
use super::{PatchJudge, PatchJudgements, SoftTexture, count, work_of};
use crate::mesh::patches::Patch;
use crate::shadow::JUDGED_ABOVE_M;
use crate::shadow::ShadowError;
use crate::shadow::ray_cast::Shear;
use crate::shadow::soft_texture::Sample;
use glam::DVec3;
use rayon::prelude::*;

/// An instant, or a moment between two instants.
#[derive(Debug)]
pub struct Moment {
    /// The direction to the sun's centre.
    pub to_sun: DVec3,
    /// The seconds since the first instant for which a texel is as it was then, if it changes after this moment and
    /// before the next; for the last moment, all seconds.
    pub secs_before_change: u32,
}

/// The rays of a patch to the sun at one moment.
struct PatchRays {
    /// The offset from a texel's centre to where it is judged.
    lift: DVec3,
    shear: Shear,
}

impl SoftTexture {
    /// Returns 1 for each texel that sees the sun's centre, otherwise 0.
    ///
    /// # Errors
    /// [`ShadowError::Gpu`]
    pub fn seen(&mut self, to_sun: DVec3) -> Result<Vec<u8>, ShadowError> {
        let mut seen = vec![0; self.patches.texels.len()];
        self.add_to(&[Sample { light: to_sun.extend(0.0), weight: 1 }], &mut seen)?;
        Ok(seen.into_par_iter().map(|seen| seen as u8).collect())
    }

    /// Adds seconds to the texels that have seen the sun.
    pub fn add_seen(&mut self, seen: &[u8], secs: u32) {
        self.sums
            .par_iter_mut()
            .zip(seen)
            .with_min_len(1 << 14)
            .for_each(|(sum, seen)| *sum += u32::from(*seen) * secs);
    }

    /// Adds the seconds between two instants: all of them to texels that see the sun at both, and the part that the
    /// search finds to those that see it at one. The moments include the two instants.
    pub fn add_between(&mut self, [before, after]: [&[u8]; 2], moments: &[Moment]) {
        let [_, .., last] = moments else { return };
        let all_secs = last.secs_before_change;
        let mut sums = std::mem::take(&mut self.sums);
        let judge = self.judge();
        work_of(judge.sought.patches, &mut sums).into_par_iter().for_each(|(_, patch, sums)| {
            let texels = patch.texels.start as usize..patch.texels.end as usize;
            let (before, after) = (&before[texels.clone()], &after[texels]);
            let mut search = TexelSearch {
                judge: &judge,
                patch,
                moments,
                rays: Vec::new(),
                last: moments.len() / 2,
                shift: 0,
                cast: 0,
            };
            for (texel, (sum, ends)) in sums.iter_mut().zip(before.iter().zip(after)).enumerate() {
                *sum += match ends {
                    (0, 0) => 0,
                    (1, 1) => all_secs,
                    (before, _) => {
                        let secs = search.secs_before_change(texel, *before == 1);
                        if *before == 1 { secs } else { all_secs - secs }
                    }
                };
            }
            count(judge.counts, PatchJudgements { rays: search.cast, ..PatchJudgements::default() });
        });
        self.sums = sums;
    }
}

/// The search on one patch.
struct TexelSearch<'a> {
    judge: &'a PatchJudge<'a>,
    patch: &'a Patch,
    moments: &'a [Moment],
    /// For each moment, its rays once a texel needs them; `None` if the patch faces away from the sun.
    rays: Vec<Option<Option<PatchRays>>>,
    /// The moment after which the last texel changed, and its distance in moments from the one before it.
    last: usize,
    shift: isize,
    cast: u64,
}

impl TexelSearch<'_> {
    /// The seconds for which a texel that sees the sun at one end only is as it was at the first.
    fn secs_before_change(&mut self, texel: usize, is_lit_before: bool) -> u32 {
        let (mut from, mut to) = (0, self.moments.len() - 1);
        // starts where a shadow that moves evenly over the texels would be, then goes ever farther from there, until
        // the change is between two moments
        let guess = self.last.saturating_add_signed(self.shift);
        let (mut next, mut stride) = (guess.clamp(1, to.saturating_sub(1).max(1)), 1);
        while to - from > 1 {
            if self.is_lit(texel, next) == is_lit_before {
                from = next;
                next = if to + 1 == self.moments.len() { from + stride } else { to };
            } else {
                to = next;
                next = if from == 0 { to.saturating_sub(stride) } else { from };
            }
            stride *= 2;
            if next <= from || next >= to {
                next = from + (to - from) / 2;
            }
        }
        let shift = from as isize - self.last as isize;
        self.shift = if shift.unsigned_abs() < self.moments.len() / 4 { shift } else { 0 };
        self.last = from;
        self.moments[from].secs_before_change
    }

    fn is_lit(&mut self, texel: usize, moment: usize) -> bool {
        let TexelSearch { judge, patch, moments, rays, cast, .. } = self;
        rays.resize_with(moments.len(), || None);
        let rays = rays[moment].get_or_insert_with(|| {
            let raster = raster(patch, judge.sought.patches.cell, moments[moment].to_sun.extend(0.0))?;
            let lift = judge.tie(patch, &raster) + raster.plane.truncate() * JUDGED_ABOVE_M;
            Some(PatchRays { lift, shear: Shear::along(moments[moment].to_sun) })
        });
        let Some(PatchRays { lift, shear }) = rays else { return false };
        *cast += 1;
        let point = judge.sought.patches.point(patch, judge.texels(patch)[texel]);
        !judge.rays.blocked(point + *lift, shear)
    }
}
