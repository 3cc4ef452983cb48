//! The slopes of the sun at consecutive seconds, for the question which of a place's rays through a wall is the lowest.
//!
//! A wall stands across one of the axes, at a distance from the place. A ray meets it at the height of that distance times
//! the sun's slope along the axis, and as far aside as the distance times its slope across. While that slope only rises or
//! only falls, the rays that meet a piece of the wall are those of consecutive seconds, and the least of their slopes
//! upward is looked up in a table.

use glam::DVec3;

/// The slopes of the sun at consecutive seconds, towards each side.
#[derive(Clone, Debug)]
pub struct SunSlopes {
    /// The first second.
    first: i64,
    /// East, west, north and south.
    sides: [SideSlopes; 4],
}

/// The slopes towards one side, while the sun stands on that side.
#[derive(Clone, Debug)]
struct SideSlopes {
    runs: Vec<SlopeRun>,
}

/// The slopes towards one side in some spells.
#[derive(Clone, Debug)]
pub(super) struct SpellSlopes<'a> {
    side: &'a SideSlopes,
    /// Pairs of indices, in order of time.
    spells: &'a [[usize; 2]],
    /// The least slope upward.
    pub(super) least_up: f64,
    /// The least and the greatest slope across.
    across: [f64; 2],
}

/// Seconds in which the slope across only rises, or only falls.
#[derive(Clone, Debug)]
struct SlopeRun {
    first: usize,
    across: Vec<f64>,
    is_rising: bool,
    /// The least slope upward among 1, 2, 4, … seconds from each on.
    least_up: Vec<Vec<f64>>,
}

impl SunSlopes {
    /// The slopes of the directions to the sun at each second from the first on. A sun that is not up has none.
    pub fn of(first: i64, to_sun: &[DVec3]) -> SunSlopes {
        let sides = [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)];
        SunSlopes { first, sides: sides.map(|(axis, sign)| SideSlopes::of(to_sun, axis, sign)) }
    }

    /// The slopes in some spells along an axis, 0 for east and 1 for north, and against it; `None` where there are none.
    pub(super) fn in_spells<'a>(&'a self, axis: usize, spells: &'a [[usize; 2]]) -> [Option<SpellSlopes<'a>>; 2] {
        [&self.sides[2 * axis], &self.sides[2 * axis + 1]].map(|side| SpellSlopes::of(side, spells))
    }

    /// The indices of a spell's seconds.
    pub(super) fn indices(&self, [start, end]: [i64; 2]) -> [usize; 2] {
        [start, end].map(|secs| (secs - self.first).max(0) as usize)
    }
}

impl SideSlopes {
    fn of(to_sun: &[DVec3], axis: usize, sign: f64) -> SideSlopes {
        let slopes = |sun: &DVec3| -> Option<[f64; 2]> {
            let along = sign * sun[axis];
            (along > 0.0 && sun.z > 0.0).then(|| [sun[1 - axis] / along, sun.z / along])
        };
        let mut runs: Vec<(SlopeRun, Vec<f64>)> = Vec::new();
        let mut goes_on = false;
        for (second, sun) in to_sun.iter().enumerate() {
            let Some([across, up]) = slopes(sun) else {
                goes_on = false;
                continue;
            };
            match runs.last_mut().filter(|(run, _)| goes_on && run.takes(across)) {
                Some((run, ups)) => {
                    run.is_rising = across >= run.across[0];
                    run.across.push(across);
                    ups.push(up);
                }
                None => {
                    let run = SlopeRun { first: second, across: vec![across], is_rising: true, least_up: Vec::new() };
                    runs.push((run, vec![up]));
                }
            }
            goes_on = true;
        }
        let with_table = |(run, ups): (SlopeRun, Vec<f64>)| SlopeRun { least_up: table(ups), ..run };
        SideSlopes { runs: runs.into_iter().map(with_table).collect() }
    }
}

impl<'a> SpellSlopes<'a> {
    fn of(side: &'a SideSlopes, spells: &'a [[usize; 2]]) -> Option<SpellSlopes<'a>> {
        let all = [f64::NEG_INFINITY, f64::INFINITY];
        let mut of = SpellSlopes { side, spells, least_up: f64::INFINITY, across: [f64::INFINITY, f64::NEG_INFINITY] };
        for run in &side.runs {
            for [start, end] in run.meeting(all, spells) {
                of.least_up = of.least_up.min(run.least_up(start, end));
                for across in [run.across[start], run.across[end - 1]] {
                    of.across = [of.across[0].min(across), of.across[1].max(across)];
                }
            }
        }
        of.least_up.is_finite().then_some(of)
    }

    /// The least slope upward among the seconds whose slope across lies between two values; `None` if there is none.
    pub(super) fn least(&self, across: [f64; 2]) -> Option<f64> {
        if across[0] > self.across[1] || across[1] < self.across[0] {
            return None;
        }
        let of_run = |run: &SlopeRun| {
            run.meeting(across, self.spells).map(|[start, end]| run.least_up(start, end)).reduce(f64::min)
        };
        self.side.runs.iter().filter_map(of_run).reduce(f64::min)
    }
}

impl SlopeRun {
    /// Whether the slope goes on as before; the second one decides how.
    fn takes(&self, across: f64) -> bool {
        let last = self.across[self.across.len() - 1];
        self.across.len() == 1 || if self.is_rising { across >= last } else { across <= last }
    }

    /// The seconds of the run in which the slope across lies between two values, as far as they are in some spells: pairs
    /// of indices within the run.
    fn meeting(&self, [low, high]: [f64; 2], spells: &[[usize; 2]]) -> impl Iterator<Item = [usize; 2]> {
        let all = &self.across;
        let [start, end] = match self.is_rising {
            true => [all.partition_point(|across| *across < low), all.partition_point(|across| *across <= high)],
            false => [all.partition_point(|across| *across > high), all.partition_point(|across| *across >= low)],
        };
        let [from, to] = [start + self.first, end + self.first];
        let first = spells.partition_point(|[_, end]| *end <= from);
        let meeting = spells[first..].iter().take_while(move |[start, _]| *start < to);
        let within = move |[start, end]: &[usize; 2]| [(*start).max(from) - self.first, (*end).min(to) - self.first];
        meeting.map(within).filter(|[start, end]| start < end)
    }

    fn least_up(&self, start: usize, end: usize) -> f64 {
        let level = (end - start).ilog2() as usize;
        let least = &self.least_up[level];
        least[start].min(least[end - (1 << level)])
    }
}

/// The least of 1, 2, 4, … numbers from each on.
fn table(ups: Vec<f64>) -> Vec<Vec<f64>> {
    let mut levels = vec![ups];
    let mut wide = 1;
    while 2 * wide <= levels[0].len() {
        let last = &levels[levels.len() - 1];
        levels.push((0..=levels[0].len() - 2 * wide).map(|at| last[at].min(last[at + wide])).collect());
        wide *= 2;
    }
    levels
}
