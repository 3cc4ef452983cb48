//! Finds a probe's intervals on several days: first the seconds that are certainly lit or dark, then exact rays for the
//! doubtful ones.

use super::face_tree::FaceTree;
use super::shade::{Shade, shades};
use super::sky_cells::SunCells;
use super::sun_path::{Second, SunPath};
use super::{Interval, IntervalBound, JudgedPoint};
use crate::mesh::Mesh;
use crate::shadow::ray_cast::{RayCaster, Shear};
use crate::sun::{Air, DayWindow, Instant, Place, SunError};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};

/// Several days, prepared once for all probes.
pub struct SearchedDays<'a> {
    /// The sun's path of each day, in order.
    pub paths: Vec<SunPath<'a>>,
    cells: SunCells,
}

impl<'a> SearchedDays<'a> {
    /// # Errors
    /// As for [`SunPath::new`].
    pub fn new(place: &'a Place, windows: &'a [DayWindow], air: Option<Air>) -> Result<SearchedDays<'a>, SunError> {
        let paths: Vec<_> =
            windows.par_iter().map(|window| SunPath::new(place, window, air)).collect::<Result<_, _>>()?;
        let cells = SunCells::new(&paths);
        Ok(SearchedDays { paths, cells })
    }
}

/// The search for the intervals of probes.
pub struct ProbeSearch {
    casters: Mesh,
    rays: RayCaster,
    tree: FaceTree,
    /// The number of probe-days that were decided second by second, because two answers disagreed.
    distrusted: AtomicUsize,
    /// The number of tests of faces against parts of the sky.
    tested: AtomicU64,
}

impl ProbeSearch {
    /// Prepares a search for probes judged at these points of the world.
    pub fn new(casters: Mesh, points: &[JudgedPoint]) -> ProbeSearch {
        let reach = points.iter().map(|at| (at.point - casters.origin).abs().max_element());
        let reach = reach.fold(0.0, f64::max);
        let (rays, tree) = rayon::join(|| RayCaster::new(&casters, reach), || FaceTree::new(&casters));
        ProbeSearch { casters, rays, tree, distrusted: AtomicUsize::new(0), tested: AtomicU64::new(0) }
    }

    /// Returns the names of the components that cast.
    pub fn components(&self) -> Vec<String> {
        self.casters.components.iter().map(|component| component.name.clone()).collect()
    }

    /// Returns the number of probe-days that were decided second by second, because polynomials and rays disagreed.
    #[cfg(feature = "test-hooks")]
    pub fn distrusted(&self) -> usize {
        self.distrusted.load(Ordering::Relaxed)
    }

    /// Returns the number of tests of faces against parts of the sky.
    #[cfg(feature = "test-hooks")]
    pub fn tested(&self) -> u64 {
        self.tested.load(Ordering::Relaxed)
    }

    /// Returns a probe's intervals on each of the days.
    ///
    /// # Errors
    /// As for [`SunPath::new`].
    pub fn intervals(&self, at: &JudgedPoint, days: &SearchedDays<'_>) -> Result<Vec<Vec<Interval>>, SunError> {
        if at.below_ground_m.is_some() {
            return Ok(vec![Vec::new(); days.paths.len()]);
        }
        let local = at.point - self.casters.origin;
        let (shades, tested) = shades(&self.tree, &days.cells, &days.paths, (local, at.normal));
        self.tested.fetch_add(tested, Ordering::Relaxed);
        days.paths.iter().zip(shades).map(|(path, shade)| self.of_day(at, path, shade)).collect()
    }

    /// A day's intervals. If the exact rays at their ends contradict them, every second is tested instead.
    fn of_day(&self, at: &JudgedPoint, path: &SunPath<'_>, shade: Shade) -> Result<Vec<Interval>, SunError> {
        let lit = self.lit(at, path, shade)?;
        if let Some(found) = self.bounded(at, path, &lit)? {
            return Ok(found);
        }
        self.distrusted.fetch_add(1, Ordering::Relaxed);
        let doubtful = path.up_secs.iter().flat_map(|up| up.clone()).collect();
        let lit = self.lit(at, path, Shade { dark: Vec::new(), doubtful })?;
        Ok(self.bounded(at, path, &lit)?.unwrap_or_default())
    }

    /// Runs of seconds in sunlight, first and last.
    fn lit(&self, at: &JudgedPoint, path: &SunPath<'_>, mut shade: Shade) -> Result<Vec<[Second; 2]>, SunError> {
        shade.dark.sort_unstable();
        shade.doubtful.sort_unstable();
        shade.doubtful.dedup();
        let mut lit = Vec::new();
        let mut dark = shade.dark.iter().peekable();
        for up in &path.up_secs {
            let mut first = *up.start();
            while first <= *up.end() {
                // skip dark runs that end before this one
                while dark.next_if(|run| run[1] < first).is_some() {}
                match dark.peek() {
                    Some(run) if run[0] <= first => first = run[1] + 1,
                    run => {
                        let last = run.map_or(*up.end(), |run| (run[0] - 1).min(*up.end()));
                        self.without_doubt(at, path, [first, last], &shade.doubtful, &mut lit)?;
                        first = last + 1;
                    }
                }
            }
        }
        Ok(lit)
    }

    /// Adds the lit seconds of a run: all except the doubtful ones that the exact ray finds dark.
    fn without_doubt(
        &self,
        at: &JudgedPoint,
        path: &SunPath<'_>,
        [mut first, last]: [Second; 2],
        doubtful: &[Second],
        lit: &mut Vec<[Second; 2]>,
    ) -> Result<(), SunError> {
        let from = doubtful.partition_point(|second| *second < first);
        for &second in doubtful[from..].iter().take_while(|second| **second <= last) {
            if self.blocked(at, &path.exact(second)?).is_some() {
                lit.extend((first < second).then_some([first, second - 1]));
                first = second + 1;
            }
        }
        lit.extend((first <= last).then_some([first, last]));
        Ok(())
    }

    /// Makes intervals of runs of lit seconds, with what blocks at their ends; `None` if an exact ray contradicts them.
    fn bounded(
        &self,
        at: &JudgedPoint,
        path: &SunPath<'_>,
        lit: &[[Second; 2]],
    ) -> Result<Option<Vec<Interval>>, SunError> {
        let asked = path.asked();
        let mut found = Vec::new();
        for &[first, last] in lit {
            for second in [first, last] {
                if self.is_dark_by_path(at, path, second) && self.blocked_at(at, path, second)?.is_some() {
                    return Ok(None);
                }
            }
            let before = match first == *asked.start() {
                true => Some(IntervalBound::Window),
                false => self.blocked_at(at, path, first - 1)?,
            };
            let after = match last == *asked.end() {
                true => Some(IntervalBound::Window),
                false => self.blocked_at(at, path, last + 1)?,
            };
            let (Some(before), Some(after)) = (before, after) else { return Ok(None) };
            let end = (last + 1).min(*asked.end());
            if first < end {
                found.push(Interval { start: path.time(first), end: path.time(end), before, after });
            }
        }
        Ok(Some(found))
    }

    /// Whether a ray in the direction of the path's polynomial meets a caster.
    fn is_dark_by_path(&self, at: &JudgedPoint, path: &SunPath<'_>, second: Second) -> bool {
        let Some(piece) = path.piece_at(second) else { return true };
        self.rays.blocked(at.point - self.casters.origin, &Shear::along(piece.to_sun(second)))
    }

    /// What blocks at a second, for the exact sun.
    fn blocked_at(
        &self,
        at: &JudgedPoint,
        path: &SunPath<'_>,
        second: Second,
    ) -> Result<Option<IntervalBound>, SunError> {
        if path.piece_at(second).is_none() {
            return Ok(Some(IntervalBound::Horizon));
        }
        Ok(self.blocked(at, &path.exact(second)?))
    }

    /// What blocks the sun from a probe; `None` in sunlight.
    fn blocked(&self, at: &JudgedPoint, instant: &Instant) -> Option<IntervalBound> {
        if instant.night {
            return Some(IntervalBound::Horizon);
        }
        if at.normal.is_some_and(|normal| normal.dot(instant.to_sun) <= 0.0) {
            return Some(IntervalBound::Behind);
        }
        if at.below_ground_m.is_some() {
            return Some(IntervalBound::Ground);
        }
        let (face, _) = self.rays.first_hit(at.point - self.casters.origin, instant.to_sun)?;
        Some(IntervalBound::Component(self.casters.components.partition_point(|component| component.faces.end <= face)))
    }

    /// The slow twin: finds a probe's intervals on a day by rays at the instants of a grid, and bisects between two
    /// that differ. Intervals shorter than the step may be missed; at a step of one second, none is.
    ///
    /// # Errors
    /// As for [`SunPath::new`].
    #[cfg(feature = "test-hooks")]
    pub fn by_grid(
        &self,
        at: &JudgedPoint,
        (place, window, air): (&Place, &DayWindow, Option<Air>),
        step: chrono::TimeDelta,
    ) -> Result<Vec<Interval>, SunError> {
        let delta_t_secs = crate::sun::delta_t_secs(window.from.to_utc())?;
        let sky = crate::sun::Sky { place, delta_t_secs, air };
        super::halving::by_grid(window, &sky, step, |instant| self.blocked(at, instant))
    }
}
