//! Finds when texels change between two instants: bisects with one ray per texel and moment, starting at the
//! neighbour's change.

use super::{PatchJudge, PatchJudgements, SoftTexture, count};
use crate::mesh::patches::{Patch, Texel};
use crate::shadow::changes::{ChangeSearch, OpenPoint};
use crate::shadow::soft_texture::Sample;
use crate::shadow::{JUDGED_ABOVE_M, ShadowError};
use glam::DVec3;
use rayon::prelude::*;
use std::ops::Range;

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
        let list = &judge.sought.patches.list[patches];
        let mut rest = match list {
            [first, .., last] => &mut sums[first.texels.start as usize..last.texels.end as usize],
            [only] => &mut sums[only.texels.start as usize..only.texels.end as usize],
            [] => &mut [],
        };
        let mut runs = Vec::new();
        let mut left = list;
        while !left.is_empty() {
            let (mut patches, mut texels) = (0, 0);
            while texels < RUN && patches < left.len() {
                texels += left[patches].texels.len();
                patches += 1;
            }
            let (run, later) = left.split_at(patches);
            let (sums, later_sums) = rest.split_at_mut(texels);
            runs.push((run, sums));
            (left, rest) = (later, later_sums);
        }
        runs.into_par_iter().for_each(|(patches, sums)| judge.add_between(patches, sums, gap));
        self.sums = sums;
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
        parts
    }
}

impl PatchJudge<'_> {
    /// The same, to the sums of patches that follow one another.
    fn add_between(&self, patches: &[Patch], sums: &mut [u32], gap: &TextureGap<'_, impl Fn(u32) -> u32>) {
        let Some(first) = patches.first().map(|patch| patch.texels.start as usize) else { return };
        let last_moment = gap.suns.len().saturating_sub(1) as u32;
        let all_secs = (gap.secs_before_change)(last_moment);
        let [before, after] = gap.ends.map(|seen| &seen[first..first + sums.len()]);
        let mut search = ChangeSearch::new(self.rays, gap.suns);
        let mut differ: Vec<(usize, Texel)> = Vec::new();
        for patch in patches {
            let texels = patch.texels.start as usize - first..patch.texels.end as usize - first;
            for (number, texel) in texels.zip(self.texels(patch)) {
                match [before[number], after[number]] {
                    [0, 0] => {}
                    [1, 1] => sums[number] += all_secs,
                    _ => differ.push((number, *texel)),
                }
            }
            differ.sort_unstable_by_key(|(_, texel)| (texel.row / SIDE, texel.column / SIDE, texel.row, texel.column));
            let square = |(_, texel): &(usize, Texel)| (texel.row / SIDE, texel.column / SIDE);
            for texels in differ.chunk_by(|one, other| square(one) == square(other)) {
                for (number, texel) in texels {
                    search.add(self.open(patch, *texel, *number, before[*number] == 0));
                }
                search.search();
            }
            differ.clear();
        }
        let (changes, rays) = search.finish();
        for change in changes {
            let secs = (gap.secs_before_change)(change.moment);
            sums[change.number] += if change.was_shaded { all_secs - secs } else { secs };
        }
        count(self.counts, PatchJudgements { rays, ..PatchJudgements::default() });
    }

    /// A texel that changes.
    fn open(&self, patch: &Patch, texel: Texel, number: usize, is_shaded: bool) -> OpenPoint {
        let normal = patch.plane.truncate();
        let place = self.sought.patches.point(patch, texel) + self.tie(patch);
        let lift = normal * JUDGED_ABOVE_M;
        OpenPoint { number, at: place + lift, normal, behind: patch.two_sided.then_some(place - lift), is_shaded }
    }
}
