//! A study that is prepared but not yet run.

use super::machine::Machine;
use super::{SiteView, Stopwatch, Wants, fingerprint, subject_of};
use crate::message::Message;
use crate::profile::{Provenance, Unfinished};
use crate::site::Site;
use crate::view::{Tile, View};
use std::cell::OnceCell;
use std::fmt;

/// A prepared study that reports its sums tile by tile ([`Event::Tile`](super::Event::Tile),
/// [`Event::Summed`](super::Event::Summed)), so that memory need not hold all of them.
pub struct TiledStudy<'a> {
    pub(super) site: &'a Site,
    pub(super) wants: Wants,
    pub(super) machine: Machine,
    pub(super) tiles: Vec<Tile>,
    pub(super) number: OnceCell<u64>,
    /// The notes of the preparation, besides the site's own.
    pub(super) notes: Vec<Message>,
    pub(super) watch: Stopwatch,
}

impl TiledStudy<'_> {
    /// The study's fingerprint: a hash of everything that its result depends on.
    pub fn number(&self) -> u64 {
        *self.number.get_or_init(|| fingerprint::of(self.site, &self.drawn(), &self.tiles, &self.wants))
    }

    /// What draws the study.
    pub(super) fn drawn(&self) -> Provenance {
        self.machine.drawn_over(self.site, subject_of(self.site, &View::Plan(self.site.grid)))
    }

    /// The tiles in order.
    pub fn tiles(&self) -> &[Tile] {
        &self.tiles
    }

    pub(super) fn look(&self) -> SiteView<'_> {
        let TiledStudy { site, machine, .. } = self;
        SiteView { site, machine, view: View::Plan(site.grid), receivers: site.receivers }
    }

    /// Whether a state belongs to this study.
    pub fn is_of(&self, begun: &Unfinished) -> bool {
        let count = self.tiles.len() * self.site.track.instants.len();
        let tile = self.tiles.get(self.worked_on(begun.done));
        begun.study == self.number()
            && begun.statistics.is_some() == self.wants.statistics
            && begun.tiles == self.tiles.len()
            && begun.done <= count
            && tile.is_some_and(|tile| begun.shaded.len() == tile.cells())
    }

    /// The index of the tile that is in work after a number of instants, counted for each tile; the last tile until all
    /// of its instants are done and reported.
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
