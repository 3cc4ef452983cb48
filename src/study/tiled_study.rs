//! A study that is prepared but not yet run.

use super::machine::Machine;
use super::tile_sum::TileSum;
use super::{SiteView, Stopwatch, StudyError, Wants, fingerprint, subject_of};
use crate::message::Message;
use crate::profile::{Provenance, Shaded, Unfinished};
use crate::site::Site;
use crate::sun;
use crate::view::{Tile, View};
use std::cell::OnceCell;
use std::fmt;
use std::ops::ControlFlow;

/// A study that is prepared, with its sums tile by tile ([`Event::Tile`](super::Event::Tile),
/// [`Event::Summed`](super::Event::Summed)), so that not all of them are in memory.
pub struct TiledStudy<'a> {
    pub(super) site: &'a Site,
    pub(super) wants: Wants,
    pub(super) machine: Machine,
    pub(super) tiles: Vec<Tile>,
    pub(super) number: OnceCell<u64>,
    /// What was noted while it was prepared, beside the site's own notes.
    pub(super) notes: Vec<Message>,
    pub(super) watch: Stopwatch,
}

impl TiledStudy<'_> {
    /// The study's fingerprint: a number made of everything that its result depends on.
    pub fn number(&self) -> u64 {
        *self.number.get_or_init(|| fingerprint::of(self.site, &self.drawn(), &self.tiles, &self.wants))
    }

    /// What draws.
    pub(super) fn drawn(&self) -> Provenance {
        self.machine.drawn_over(self.site, subject_of(self.site, &View::Plan(self.site.grid)))
    }

    /// The tiles, in their order.
    pub fn tiles(&self) -> &[Tile] {
        &self.tiles
    }

    /// A part of the study, for a program that shares the work out: the shaded time of one of the tiles at some of the
    /// instants, which may come from another process. What changes between two instants of the track is the later one's.
    /// Sums of instants that make up the track add up to the tile's own to the bit, and [`paste`](super::paste) puts tiles
    /// together. Where the device fails, so does this.
    ///
    /// # Errors
    /// [`StudyError::OtherTile`] for a tile of another study; [`StudyError::Shadow`], where drawing failed.
    pub fn sum(&self, tile: Tile, instants: &[sun::Instant]) -> Result<Shaded, StudyError> {
        if !self.tiles.contains(&tile) {
            return Err(StudyError::OtherTile);
        }
        let mut technique = self.look().technique_of(tile)?;
        let mut sum = TileSum::new(self.site, self.drawn().resolution_secs, self.machine.gpu(), &tile);
        let track = &self.site.track.instants;
        for instant in instants.iter().filter(|instant| !instant.night) {
            let at = track.binary_search_by_key(&instant.time, |own| own.time);
            match at.ok().filter(|at| track[*at].weight_secs == instant.weight_secs) {
                Some(at) => {
                    drop(sum.add(at, technique.as_mut(), &Wants::default(), &mut |_| ControlFlow::Continue(()))?)
                }
                None => sum.add_mask(&technique.draw(instant.to_sun)?, instant.weight_secs)?,
            }
        }
        Ok(sum.finish()?)
    }

    pub(super) fn look(&self) -> SiteView<'_> {
        let TiledStudy { site, machine, .. } = self;
        SiteView { site, machine, view: View::Plan(site.grid), receivers: site.receivers }
    }

    /// Whether a state was left by this study.
    pub fn is_of(&self, begun: &Unfinished) -> bool {
        let count = self.tiles.len() * self.site.track.instants.len();
        let tile = self.tiles.get(self.worked_on(begun.done));
        begun.study == self.number()
            && begun.statistics.is_some() == self.wants.statistics
            && begun.tiles == self.tiles.len()
            && begun.done <= count
            && tile.is_some_and(|tile| begun.shaded.len() == tile.cells())
    }

    /// The tile that is worked on after so many instants, those of each tile counted: the last one until all of its
    /// instants are done and told.
    pub(crate) fn worked_on(&self, done: usize) -> usize {
        done.saturating_sub(1) / self.site.track.instants.len().max(1)
    }
}

impl fmt::Debug for TiledStudy<'_> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter
            .debug_struct("TiledStudy")
            .field("wants", &self.wants)
            .field("tiles", &self.tiles)
            .finish_non_exhaustive()
    }
}
