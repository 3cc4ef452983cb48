//! When points change between two instants: by halving, with rays in beams.
//!
//! Points that lie beside each other are searched together, at most as many as a beam has rays. At the middle moment
//! their rays are parallel and go through the tree as one beam ([`super::rays`]); whether a point has changed by then
//! decides in which half it is searched further. Points must be near each other: with 512 points together, the last
//! halvings had wide beams of points far apart, and the search took ten times as long.

use super::rays::{RayCaster, Shear};
use crate::view::Bits;
use arrayvec::ArrayVec;
use glam::DVec3;
use rayon::prelude::*;
use std::ops::Range;

/// The rows of a plan that one task searches: a row of squares, so that also a small part of a plan in which every cell
/// changes is shared out.
const BAND: usize = SIDE;
/// The side of the squares of cells that are searched together, with as many cells as a beam has rays.
const SIDE: usize = 8;
/// The number of cells in a square.
const SQUARE: usize = SIDE * SIDE;

/// A point that is in shadow at only one of two instants. Its places are relative to the casters' origin.
pub(super) struct OpenPoint {
    /// Its number among the searched points.
    pub(super) number: usize,
    /// Where it is judged.
    pub(super) at: DVec3,
    /// The normal of the side on which it is judged.
    pub(super) normal: DVec3,
    /// Where it is judged while the sun is on the other side; `None` if it is in shadow then.
    pub(super) behind: Option<DVec3>,
    /// Whether it is in shadow at the first instant.
    pub(super) is_shaded: bool,
}

/// The time at which a point changed between two instants.
#[doc(hidden)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LightChange {
    /// The point's number; cells of a plan are counted along the rows.
    pub number: usize,
    /// Whether it was in shadow at the first instant.
    pub was_shaded: bool,
    /// The last moment at which it was as at the first instant, counted from that.
    pub moment: u32,
}

/// Cells that are in shadow at only one of two instants.
#[doc(hidden)]
#[derive(Clone, Copy, Debug)]
pub struct DifferingCells<'a> {
    /// The shadow at both instants.
    pub ends: [&'a Bits; 2],
    /// The directions to the sun at the moments, from one instant to the other.
    pub suns: &'a [DVec3],
}

impl DifferingCells<'_> {
    /// When the cells of some rows change. `judged` returns where a cell, given by row and column, is judged, and the
    /// normal there.
    pub(super) fn search(
        &self,
        rows: Range<usize>,
        rays: &RayCaster,
        judged: impl Fn(usize, usize) -> Option<(DVec3, DVec3)> + Sync,
    ) -> Vec<LightChange> {
        let (width, end) = (self.ends[0].width as usize, rows.end);
        let bands: Vec<usize> = rows.step_by(BAND).collect();
        let of_band = |first: &usize| {
            let mut search = ChangeSearch::new(rays, self.suns);
            self.each_square(*first..(*first + BAND).min(end), |cells| {
                for (row, column, is_shaded) in cells {
                    if let Some((at, normal)) = judged(row, column) {
                        search.add(OpenPoint { number: row * width + column, at, normal, behind: None, is_shaded });
                    }
                }
                search.search();
            });
            search.finish().0
        };
        bands.par_iter().map(of_band).collect::<Vec<_>>().concat()
    }

    /// Calls back for the cells that differ, square by square: row, column, and whether the cell is in shadow at the
    /// first instant.
    fn each_square(&self, rows: Range<usize>, mut tell: impl FnMut(ArrayVec<(usize, usize, bool), SQUARE>)) {
        let [before, after] = self.ends;
        let in_row = before.in_row();
        for first in rows.clone().step_by(SIDE) {
            for word in 0..in_row {
                let rows = first..(first + SIDE).min(rows.end);
                let words = |row: usize| [before.words[row * in_row + word], after.words[row * in_row + word]];
                let differ: ArrayVec<[u64; 2], SIDE> =
                    rows.clone().map(words).map(|[before, after]| [before, before ^ after]).collect();
                let any = differ.iter().fold(0, |any, [_, differ]| any | differ);
                for west in (0..64).step_by(SIDE).filter(|west| any >> west & 0xff != 0) {
                    let mut cells = ArrayVec::new();
                    for (row, [before, differ]) in rows.clone().zip(&differ) {
                        let columns = (west..west + SIDE).filter(|bit| differ >> bit & 1 == 1);
                        cells.extend(columns.map(|bit| (row, word * 64 + bit, before >> bit & 1 == 1)));
                    }
                    tell(cells);
                }
            }
        }
    }
}

/// The search for changes of points that are added one after the other, neighbours together.
pub(super) struct ChangeSearch<'a> {
    rays: &'a RayCaster,
    suns: &'a [DVec3],
    open: ArrayVec<OpenPoint, { RayCaster::MOST_RAYS }>,
    found: Vec<LightChange>,
    cast: u64,
}

impl<'a> ChangeSearch<'a> {
    /// `suns` are the directions at the moments, from one instant to the other.
    pub(super) fn new(rays: &'a RayCaster, suns: &'a [DVec3]) -> ChangeSearch<'a> {
        ChangeSearch { rays, suns, open: ArrayVec::new(), found: Vec::new(), cast: 0 }
    }

    /// Adds a point, which should lie beside those that were added since the last search.
    pub(super) fn add(&mut self, point: OpenPoint) {
        if self.open.is_full() {
            self.search();
        }
        self.open.push(point);
    }

    /// Searches the points that were added.
    pub(super) fn search(&mut self) {
        let open = std::mem::take(&mut self.open);
        let all: ArrayVec<u8, { RayCaster::MOST_RAYS }> = (0..open.len() as u8).collect();
        self.halve(&open, &all, [0, self.suns.len().saturating_sub(1)]);
    }

    /// The changes, and the number of rays that were cast.
    pub(super) fn finish(self) -> (Vec<LightChange>, u64) {
        (self.found, self.cast)
    }

    /// Finds in which half each of some points changes, which change between two moments.
    fn halve(&mut self, open: &[OpenPoint], asked: &[u8], [from, to]: [usize; 2]) {
        if to - from < 2 {
            self.found.extend(asked.iter().map(|at| open[usize::from(*at)].changed(from)));
            return;
        }
        let middle = from + (to - from) / 2;
        let shaded = self.shaded(open, asked, self.suns[middle]);
        let (mut earlier, mut later) = (ArrayVec::<u8, SQUARE>::new(), ArrayVec::<u8, SQUARE>::new());
        for (bit, &at) in asked.iter().enumerate() {
            let has_changed = (shaded >> bit & 1 == 1) != open[usize::from(at)].is_shaded;
            if has_changed { earlier.push(at) } else { later.push(at) }
        }
        for (asked, ends) in [(earlier, [from, middle]), (later, [middle, to])] {
            if !asked.is_empty() {
                self.halve(open, &asked, ends);
            }
        }
    }

    /// Whether each of some points is in shadow, as a bit for each.
    fn shaded(&mut self, open: &[OpenPoint], asked: &[u8], to_sun: DVec3) -> u64 {
        let mut shaded = 0;
        let mut origins = ArrayVec::<DVec3, { RayCaster::MOST_RAYS }>::new();
        let mut bits = ArrayVec::<u8, { RayCaster::MOST_RAYS }>::new();
        for (bit, &at) in (0..).zip(asked) {
            match open[usize::from(at)].judged(to_sun) {
                Some(judged) => {
                    origins.push(judged);
                    bits.push(bit);
                }
                None => shaded |= 1 << bit,
            }
        }
        self.cast += origins.len() as u64;
        let blocked = self.rays.blocked_beam(&origins, &Shear::along(to_sun));
        (0..).zip(bits).fold(shaded, |shaded, (ray, bit)| shaded | (blocked >> ray & 1) << bit)
    }
}

impl OpenPoint {
    /// Where it is judged; `None` if its side faces away from the sun.
    fn judged(&self, to_sun: DVec3) -> Option<DVec3> {
        let facing = self.normal.dot(to_sun);
        if facing > 0.0 { Some(self.at) } else { self.behind.filter(|_| facing < 0.0) }
    }

    fn changed(&self, moment: usize) -> LightChange {
        LightChange { number: self.number, was_shaded: self.is_shaded, moment: moment as u32 }
    }
}
