//! Sums the shaded time of a tile: the instants, and the times between them at which cells change.
//!
//! What a technique draws whole is drawn at every moment between two instants, so that nothing is missed. Cells that are
//! searched singly are searched only where the two instants differ, by halving.

use super::gaps::{Gap, Gaps};
use super::search_memory::{PARTS, STRIP};
use super::{StudyError, Wants, night};
use crate::gpu::Gpu;
use crate::profile::Shaded;
use crate::profile::accumulate::Sum;
use crate::shadow::{DifferingCells, DrawnMask, LightChange, ShadowError, SingleCells, Technique};
use crate::site::Site;
use crate::view::{Bits, Mask, Tile, View};
use std::ops::Range;
use std::sync::Arc;

/// Asks a listener between the moments of a gap whether the work goes on; an error ends it.
pub(super) type GoOn<'a> = dyn FnMut() -> Result<(), StudyError> + 'a;

/// The running sum of a tile.
pub(super) struct TileSum<'a> {
    site: &'a Site,
    gaps: Gaps<'a>,
    sum: Sum,
    /// The shadow at an instant that begins a gap, of those cells that are searched singly; and which instant it is.
    before: Option<(usize, Bits)>,
}

impl<'a> TileSum<'a> {
    /// A sum of zeros.
    pub(super) fn new(site: &'a Site, resolution_secs: u32, gpu: Option<Arc<Gpu>>, tile: &Tile) -> TileSum<'a> {
        let gaps = Gaps::new(site, resolution_secs);
        TileSum { site, gaps, sum: Sum::new(gpu, tile.size[0], tile.size[1]), before: None }
    }

    /// Continues from the sum of a number of instants.
    pub(super) fn begin_with(&mut self, shaded: &Shaded, instants: usize) {
        let by_day = self.site.track.instants[..instants].iter().filter(|instant| !instant.night);
        self.sum.begin_with(shaded, by_day.map(|instant| instant.weight_secs).sum());
    }

    /// Whether the time before an instant is searched.
    pub(super) fn searches_before(&self, at: usize) -> bool {
        self.gaps.before(at).is_some()
    }

    /// Adds an instant and the gap before it. Returns the instant's mask and its bits if they are wanted.
    ///
    /// # Errors
    /// [`StudyError::Interrupted`] within the gap if the listener ends the work; the sum is of no use then.
    pub(super) fn add(
        &mut self,
        at: usize,
        technique: &mut dyn Technique,
        wants: &Wants,
        go_on: &mut GoOn<'_>,
    ) -> Result<(Option<Mask>, Option<Bits>), StudyError> {
        let instant = &self.site.track.instants[at];
        if instant.night {
            return Ok((wants.masks.then(|| night(&View::Plan(self.site.grid))), None));
        }
        let single = self.gaps.touch(at).then(|| technique.single_cells()).flatten();
        if single != Some(SingleCells::All) {
            self.add_moments(at, technique, go_on)?;
        }
        let begun = match (&single, self.before.take()) {
            (Some(single), before) if self.gaps.before(at).is_some() => match before {
                Some((last, bits)) if last + 1 == at => Some(bits),
                // the study continues here
                _ => Some(single.of(&technique.draw(self.site.track.instants[at - 1].to_sun)?.bits()?)),
            },
            _ => None,
        };
        let drawn = technique.draw(instant.to_sun)?;
        let mask = wants.masks.then(|| drawn.read()).transpose()?;
        let bits = (wants.bits || single.is_some()).then(|| drawn.bits()).transpose()?;
        let (own_secs, among_secs) = (self.gaps.own_secs(at), self.gaps.secs_among_moments(at));
        match (&single, &bits) {
            (Some(single), Some(bits)) => {
                let after = single.of(bits);
                self.add_bits(&after, own_secs)?;
                self.add_bits(&bits.with(&after, |all, single| all & !single), among_secs)?;
                if let (Some(gap), Some(before)) = (self.gaps.before(at), begun) {
                    CellSearch { technique, gap, sum: &mut self.sum }.add_gap([&before, &after], go_on)?;
                }
                self.before = Some((at, after));
            }
            _ => self.sum.add(&drawn, among_secs)?,
        }
        Ok((mask, bits.filter(|_| wants.bits)))
    }

    /// Adds what is drawn whole at the moments of the gap before an instant.
    fn add_moments(
        &mut self,
        at: usize,
        technique: &mut dyn Technique,
        go_on: &mut GoOn<'_>,
    ) -> Result<(), StudyError> {
        for moment in self.gaps.before(at).iter().flat_map(Gap::moments) {
            let (to_sun, secs) = moment?;
            self.sum.add(&technique.draw_whole(to_sun)?, secs)?;
            go_on()?;
        }
        Ok(())
    }

    fn add_bits(&mut self, bits: &Bits, secs: u32) -> Result<(), ShadowError> {
        if secs > 0 { self.sum.add(&DrawnMask::Bits(bits), secs) } else { Ok(()) }
    }

    /// Adds a mask with a weight of its own, without a gap before it.
    pub(super) fn add_mask(&mut self, mask: &DrawnMask<'_>, secs: u32) -> Result<(), ShadowError> {
        self.sum.add(mask, secs)
    }

    /// The sum so far.
    pub(super) fn so_far(&mut self) -> Result<Shaded, ShadowError> {
        self.sum.so_far()
    }

    /// The sum.
    pub(super) fn finish(self) -> Result<Shaded, ShadowError> {
        self.sum.finish()
    }
}

/// So many cells are looked at before a listener is asked whether to go on: about what an instant takes.
const CELLS_AT_ONCE: usize = 1 << 22;
/// And no fewer rows, which are shared out among the processors.
const FEWEST_ROWS: usize = 1 << 8;
/// The rows that are searched at once.
fn parts([before, after]: [&Bits; 2]) -> Vec<Range<usize>> {
    let (width, height) = (before.width as usize, before.height as usize);
    let (most_rows, most) = ((CELLS_AT_ONCE / width).max(FEWEST_ROWS), width * height / PARTS);
    let in_strip = STRIP * before.in_row();
    let strips = before.words.chunks(in_strip).zip(after.words.chunks(in_strip));
    let differing = |(before, after): (&[u64], &[u64])| {
        before.iter().zip(after).map(|(before, after)| (before ^ after).count_ones() as usize).sum::<usize>()
    };
    let (mut parts, mut part, mut count) = (Vec::new(), 0..0, 0);
    for differing in strips.map(differing) {
        if !part.is_empty() && (count + differing > most || part.len() + STRIP > most_rows) {
            parts.push(part.clone());
            (part, count) = (part.end..part.end, 0);
        }
        count += differing;
        part.end = (part.end + STRIP).min(height);
    }
    parts.push(part);
    parts
}

/// The search for the times at which cells change in a gap.
struct CellSearch<'a> {
    technique: &'a mut dyn Technique,
    gap: Gap<'a>,
    sum: &'a mut Sum,
}

impl CellSearch<'_> {
    /// Adds the gap's seconds to cells that are in shadow at both ends, and to others as many as they are found to be.
    fn add_gap(&mut self, ends: [&Bits; 2], go_on: &mut GoOn<'_>) -> Result<(), StudyError> {
        self.sum.add_gap(ends, self.gap.secs())?;
        if ends[0].words == ends[1].words {
            return Ok(());
        }
        let suns = (0..=self.gap.steps()).map(|step| self.gap.sun_at(step)).collect::<Result<Vec<_>, _>>()?;
        let cells = DifferingCells { ends, suns: &suns };
        for rows in parts(ends) {
            let changes = self.technique.changes(&cells, rows)?;
            let shaded: Vec<(usize, u32)> = changes.iter().map(|change| self.shaded_secs(change)).collect();
            self.sum.add_in_gap(&shaded)?;
            go_on()?;
        }
        Ok(())
    }

    /// How long a cell is in shadow that changes.
    fn shaded_secs(&self, change: &LightChange) -> (usize, u32) {
        let before = self.gap.secs_before_change(change.moment);
        (change.number, if change.was_shaded { before } else { self.gap.secs() - before })
    }
}
