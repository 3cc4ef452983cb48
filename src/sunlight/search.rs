//! Finds a probe's intervals on several days: first the seconds that are certainly lit or dark, then exact rays for the
//! doubtful ones.

use super::face_tree::FaceTree;
use super::shade::{Shade, shades};
use super::sky_cells::SunCells;
use super::sun_path::{ExactSun, Second, SunPath};
use super::wall_front::WallFront;
use super::{Interval, IntervalBound, JudgedPoint};
use crate::mesh::Mesh;
use crate::shadow::ray_cast::{RayCaster, Shear};
use crate::sun::{Air, DayWindow, Place, SunError};
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use rustc_hash::FxHashSet;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};

/// If there are no more days than this, the exact suns of their seconds are kept.
const MOST_DAYS_KEPT: usize = 16;

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
        let keeps = windows.len() <= MOST_DAYS_KEPT;
        let path = |window| {
            let path = SunPath::new(place, window, air)?;
            Ok(if keeps { path.keeping_suns() } else { path })
        };
        let paths: Vec<_> = windows.par_iter().map(path).collect::<Result<_, SunError>>()?;
        let cells = SunCells::new(&paths);
        Ok(SearchedDays { paths, cells })
    }
}

/// The search for the intervals of probes.
pub struct ProbeSearch {
    casters: Mesh,
    rays: RayCaster,
    /// The faces that cast, some of which another search may share.
    trees: Vec<Arc<FaceTree>>,
    /// The number of probe-days that were decided second by second, because two answers disagreed.
    distrusted: AtomicUsize,
    /// The number of tests of faces against parts of the sky.
    tested: AtomicU64,
}

/// The corners of each face.
fn corners(mesh: &Mesh) -> impl Iterator<Item = [Vec3; 3]> {
    (0..mesh.faces.len()).map(|face| mesh.corners(face))
}

fn bits(corners: [Vec3; 3]) -> [[u32; 3]; 3] {
    corners.map(|corner| corner.to_array().map(f32::to_bits))
}

fn rays(casters: &Mesh, points: &[JudgedPoint]) -> RayCaster {
    let reach = points.iter().map(|at| (at.point - casters.origin).abs().max_element());
    RayCaster::new(casters, reach.fold(0.0, f64::max))
}

/// A point as it is searched.
struct SearchedPoint {
    /// Relative to the casters' origin.
    local: DVec3,
    normal: Option<DVec3>,
    is_below_ground: bool,
    /// Relative to the casters' origin.
    front: Option<WallFront>,
}

impl ProbeSearch {
    /// Prepares a search for probes judged at these points of the world.
    pub fn new(casters: Mesh, points: &[JudgedPoint]) -> ProbeSearch {
        let faces = corners(&casters).collect::<Vec<_>>();
        let (rays, tree) = rayon::join(|| rays(&casters, points), || FaceTree::new(&faces));
        ProbeSearch {
            casters,
            rays,
            trees: vec![Arc::new(tree)],
            distrusted: AtomicUsize::new(0),
            tested: AtomicU64::new(0),
        }
    }

    /// Prepares the searches of two states. What casts in both is searched once for both, if the points are the same.
    pub fn two(states: [Mesh; 2], points: &[JudgedPoint]) -> [ProbeSearch; 2] {
        let [one, other] = &states;
        let of_other: FxHashSet<[[u32; 3]; 3]> = match one.origin == other.origin {
            true => corners(other).map(bits).collect(),
            false => FxHashSet::default(),
        };
        let (both, own): (Vec<_>, Vec<_>) = corners(one).partition(|face| of_other.contains(&bits(*face)));
        let in_both: FxHashSet<[[u32; 3]; 3]> = both.iter().copied().map(bits).collect();
        let of_other: Vec<_> = corners(other).filter(|face| !in_both.contains(&bits(*face))).collect();
        let both = Arc::new(FaceTree::new(&both));
        let search = |casters: Mesh, own: &[[Vec3; 3]]| ProbeSearch {
            rays: rays(&casters, points),
            casters,
            trees: vec![Arc::clone(&both), Arc::new(FaceTree::new(own))],
            distrusted: AtomicUsize::new(0),
            tested: AtomicU64::new(0),
        };
        let [one, other] = states;
        let (one, other) = rayon::join(|| search(one, &own), || search(other, &of_other));
        [one, other]
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
        self.intervals_before(at, None, days)
    }

    /// The same for a point inside a wall, from which only faces in front of the wall take the sun.
    ///
    /// # Errors
    /// As for [`SunPath::new`].
    pub fn intervals_before(
        &self,
        at: &JudgedPoint,
        wall: Option<WallFront>,
        days: &SearchedDays<'_>,
    ) -> Result<Vec<Vec<Interval>>, SunError> {
        if at.below_ground_m.is_some() {
            return Ok(vec![Vec::new(); days.paths.len()]);
        }
        let at = self.searched(at, wall);
        let first = self.first_shades(&at, days);
        self.finished(&at, first, days)
    }

    /// The same in two states, of which [`ProbeSearch::two`] made the searches.
    ///
    /// # Errors
    /// As for [`SunPath::new`].
    pub fn intervals_in_both(
        [one, other]: [&ProbeSearch; 2],
        at: [&JudgedPoint; 2],
        wall: Option<WallFront>,
        days: &SearchedDays<'_>,
    ) -> Result<[Vec<Vec<Interval>>; 2], SunError> {
        if at[0] != at[1] || at[0].below_ground_m.is_some() || !Arc::ptr_eq(&one.trees[0], &other.trees[0]) {
            return Ok([one.intervals_before(at[0], wall, days)?, other.intervals_before(at[1], wall, days)?]);
        }
        let at = one.searched(at[0], wall);
        let first = one.first_shades(&at, days);
        Ok([one.finished(&at, first.clone(), days)?, other.finished(&at, first, days)?])
    }

    /// The shade of the first tree, on each day.
    fn first_shades(&self, at: &SearchedPoint, days: &SearchedDays<'_>) -> Vec<Shade> {
        let (mut found, tested) =
            shades(&self.trees[0], &days.cells, &days.paths, (at.local, at.normal, at.front), &[]);
        self.tested.fetch_add(tested, Ordering::Relaxed);
        found.iter_mut().for_each(Shade::put_in_order);
        found
    }

    /// The intervals of each day, once the shade of the other trees is added.
    fn finished(
        &self,
        at: &SearchedPoint,
        mut found: Vec<Shade>,
        days: &SearchedDays<'_>,
    ) -> Result<Vec<Vec<Interval>>, SunError> {
        for tree in &self.trees[1..] {
            let known: Vec<Vec<[Second; 2]>> = found.iter().map(|shade| shade.dark.clone()).collect();
            let (more, tested) = shades(tree, &days.cells, &days.paths, (at.local, None, at.front), &known);
            self.tested.fetch_add(tested, Ordering::Relaxed);
            for (shade, more) in found.iter_mut().zip(more) {
                shade.add(more);
            }
        }
        days.paths.iter().zip(found).map(|(path, shade)| self.of_day(at, path, shade)).collect()
    }

    fn searched(&self, at: &JudgedPoint, wall: Option<WallFront>) -> SearchedPoint {
        SearchedPoint {
            local: at.point - self.casters.origin,
            normal: at.normal,
            is_below_ground: at.below_ground_m.is_some(),
            front: wall.map(|wall| wall.relative_to(self.casters.origin)),
        }
    }

    /// A day's intervals. If the exact rays at their ends contradict them, every second is tested instead.
    fn of_day(&self, at: &SearchedPoint, path: &SunPath<'_>, shade: Shade) -> Result<Vec<Interval>, SunError> {
        let lit = self.lit(at, path, &shade)?;
        if let Some(found) = self.bounded(at, path, &lit)? {
            return Ok(found);
        }
        self.distrusted.fetch_add(1, Ordering::Relaxed);
        let doubtful = path.up_secs.iter().flat_map(|up| up.clone()).collect();
        let lit = self.lit(at, path, &Shade { dark: Vec::new(), doubtful })?;
        Ok(self.bounded(at, path, &lit)?.unwrap_or_default())
    }

    /// Runs of seconds in sunlight, first and last.
    fn lit(&self, at: &SearchedPoint, path: &SunPath<'_>, shade: &Shade) -> Result<Vec<[Second; 2]>, SunError> {
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
        at: &SearchedPoint,
        path: &SunPath<'_>,
        [mut first, last]: [Second; 2],
        doubtful: &[Second],
        lit: &mut Vec<[Second; 2]>,
    ) -> Result<(), SunError> {
        let from = doubtful.partition_point(|second| *second < first);
        for &second in doubtful[from..].iter().take_while(|second| **second <= last) {
            if self.blocked(at, path.exact(second)?).is_some() {
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
        at: &SearchedPoint,
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
    fn is_dark_by_path(&self, at: &SearchedPoint, path: &SunPath<'_>, second: Second) -> bool {
        let Some(piece) = path.piece_at(second) else { return true };
        let shear = Shear::along(piece.to_sun(second));
        match at.front {
            None => self.rays.blocked(at.local, &shear),
            Some(front) => self.rays.blocked_of(at.local, &shear, |face| front.has(face)),
        }
    }

    /// What blocks at a second, for the exact sun.
    fn blocked_at(
        &self,
        at: &SearchedPoint,
        path: &SunPath<'_>,
        second: Second,
    ) -> Result<Option<IntervalBound>, SunError> {
        if path.piece_at(second).is_none() {
            return Ok(Some(IntervalBound::Horizon));
        }
        Ok(self.blocked(at, path.exact(second)?))
    }

    /// What blocks the sun from a probe; `None` in sunlight.
    fn blocked(&self, at: &SearchedPoint, sun: ExactSun) -> Option<IntervalBound> {
        if sun.night {
            return Some(IntervalBound::Horizon);
        }
        if at.normal.is_some_and(|normal| normal.dot(sun.to_sun) <= 0.0) {
            return Some(IntervalBound::Behind);
        }
        if at.is_below_ground {
            return Some(IntervalBound::Ground);
        }
        let (face, _) = match at.front {
            None => self.rays.first_hit(at.local, sun.to_sun)?,
            Some(front) => self.rays.first_hit_of(at.local, sun.to_sun, |face| front.has(face))?,
        };
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
        let at = self.searched(at, None);
        super::halving::by_grid(window, &sky, step, |instant| self.blocked(&at, instant.into()))
    }
}
