//! When texels change between two instants: patch by patch, searched as cells of a plan are ([`crate::shadow::changes`]).

use super::{PatchJudge, PatchJudgements, SoftTexture, count};
use crate::mesh::patches::{Patch, Texel};
use crate::shadow::changes::{ChangeSearch, OpenPoint};
use crate::shadow::soft_texture::Sample;
use crate::shadow::{JUDGED_ABOVE_M, ShadowError};
use glam::DVec3;
use rayon::prelude::*;
use std::ops::Range;

/// One task searches patches of so many texels, or a larger one.
const RUN: usize = 1 << 12;
/// Texels are searched in squares of so many a side, as many as a beam has rays.
const SIDE: u16 = 8;

/// The time between two instants.
pub struct TextureGap<'a, S> {
    /// Which texels see the sun at its ends.
    pub ends: [&'a [u8]; 2],
    /// To the sun at the moments, from the one instant to the other.
    pub suns: &'a [DVec3],
    /// For how many seconds since the first instant a texel is as it was then that changes after a moment, and before the
    /// next one; of the last one all seconds.
    pub secs_before_change: S,
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

    /// Adds the seconds between two instants to the texels of some patches: all of them to those that see the sun at both, and
    /// to those that see it at one of them the part that they are found to.
    pub fn add_between(&mut self, patches: Range<usize>, gap: &TextureGap<'_, impl Fn(u32) -> u32 + Sync>) {
        let mut sums = std::mem::take(&mut self.sums);
        let judge = self.judge(&[]);
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

    /// The patches in parts that take about as long as an instant of so many texels, or of one larger patch.
    pub fn parts(&self, texels: usize) -> Vec<Range<usize>> {
        let mut parts = Vec::new();
        let (mut first, mut so_far) = (0, 0);
        for (at, patch) in self.patches.list.iter().enumerate() {
            so_far += patch.texels.len();
            if so_far >= texels || at + 1 == self.patches.list.len() {
                parts.push(first..at + 1);
                (first, so_far) = (at + 1, 0);
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
