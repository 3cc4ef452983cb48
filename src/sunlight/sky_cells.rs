//! A tree over the suns of several days: each cell is a range of days and times of day, and is halved. One tree serves
//! all probes.

use super::sun_path::{MOST_OFF_RAD, SLOT_SECS, SunPath, SunPiece};
use glam::DVec3;
use std::ops::Range;

/// A pyramid around all suns of a cell, with its apex at the probe.
pub(super) struct SunPyramid {
    /// The directions of its four corners.
    pub(super) corners: [DVec3; 4],
    /// The inward normals of its four sides.
    pub(super) sides: [DVec3; 4],
    /// The tangent of half its opening angle.
    pub(super) half: f64,
    /// Its axis. The direction of time is perpendicular to it.
    pub(super) axis: DVec3,
    pub(super) along: DVec3,
}

/// A range of days and a range of slots.
pub(super) struct SunCell {
    pub(super) days: Range<usize>,
    pub(super) slots: Range<i32>,
    /// `None` if the suns are too far apart for a pyramid.
    pub(super) pyramid: Option<SunPyramid>,
    /// The two halves; empty for a single slot of a single day.
    pub(super) halves: Vec<u32>,
}

/// The tree.
pub(super) struct SunCells {
    pub(super) cells: Vec<SunCell>,
    /// The cell of all days; `None` if the sun is never up.
    pub(super) root: Option<u32>,
}

impl SunCells {
    /// The tree for the paths of some days.
    pub(super) fn new(paths: &[SunPath<'_>]) -> SunCells {
        let slots = |path: &SunPath<'_>| Some((path.pieces.first()?.first, path.pieces.last()?.last));
        let ends = paths.iter().filter_map(slots);
        let whole = ends.reduce(|(first, last), (other, end)| (first.min(other), last.max(end)));
        let mut cells = SunCells { cells: Vec::new(), root: None };
        if let Some((first, last)) = whole {
            cells.root = cells.add(paths, 0..paths.len(), first.div_euclid(SLOT_SECS)..last.div_euclid(SLOT_SECS) + 1);
        }
        cells
    }

    /// Adds a cell and its halves; `None` if the sun is not up in it.
    fn add(&mut self, paths: &[SunPath<'_>], days: Range<usize>, slots: Range<i32>) -> Option<u32> {
        let hull = hull(&paths[days.clone()], &slots);
        if hull.is_empty() {
            return None;
        }
        let (pyramid, [across, down]) =
            SunPyramid::around(&hull).map_or((None, [f64::INFINITY; 2]), |(it, size)| (Some(it), size));
        let cuts_time = slots.len() > 1 && (days.len() == 1 || pyramid.is_none() || across > down);
        let mut halves = Vec::new();
        if cuts_time {
            let middle = slots.start + (slots.end - slots.start) / 2;
            halves.extend(self.add(paths, days.clone(), slots.start..middle));
            halves.extend(self.add(paths, days.clone(), middle..slots.end));
        } else if days.len() > 1 {
            let middle = days.start + days.len() / 2;
            halves.extend(self.add(paths, days.start..middle, slots.clone()));
            halves.extend(self.add(paths, middle..days.end, slots.clone()));
        }
        self.cells.push(SunCell { days, slots, pyramid, halves });
        Some(self.cells.len() as u32 - 1)
    }
}

/// Points whose convex hull contains the suns of some days and slots, in order of time within each day.
fn hull(paths: &[SunPath<'_>], slots: &Range<i32>) -> Vec<DVec3> {
    let within = |path: &&SunPath<'_>| {
        let from = path.pieces.partition_point(|piece| piece.first < slots.start * SLOT_SECS);
        let to = path.pieces.partition_point(|piece| piece.first < slots.end * SLOT_SECS);
        path.pieces[from..to].iter().flat_map(SunPiece::hull).collect::<Vec<_>>()
    };
    paths.iter().flat_map(|path| within(&path)).collect()
}

impl SunPyramid {
    /// A pyramid around directions, in which those of a day are consecutive, with its width along and across time.
    fn around(directions: &[DVec3]) -> Option<(SunPyramid, [f64; 2])> {
        /// No direction may be farther from the axis than 60°: this is the cosine.
        const NARROW: f64 = 0.5;
        let axis = directions.iter().sum::<DVec3>().try_normalize()?;
        if directions.iter().any(|direction| direction.dot(axis) < NARROW) {
            return None;
        }
        let step = directions[directions.len().min(6) - 1] - directions[0];
        let along = step.reject_from_normalized(axis).try_normalize().unwrap_or(axis.any_orthonormal_vector());
        let across = axis.cross(along);
        let extent = |side: DVec3| {
            let on = |direction: &DVec3| direction.dot(side) / direction.dot(axis);
            let low = directions.iter().map(on).fold(f64::INFINITY, f64::min) - MOST_OFF_RAD;
            let high = directions.iter().map(on).fold(f64::NEG_INFINITY, f64::max) + MOST_OFF_RAD;
            [low, high]
        };
        let ([west, east], [south, north]) = (extent(along), extent(across));
        let corner = |x: f64, y: f64| axis + along * x + across * y;
        let pyramid = SunPyramid {
            corners: [corner(west, south), corner(east, south), corner(east, north), corner(west, north)],
            sides: [along - axis * west, axis * east - along, across - axis * south, axis * north - across],
            half: (east - west).max(north - south) / 2.0,
            axis,
            along,
        };
        Some((pyramid, [east - west, north - south]))
    }
}
