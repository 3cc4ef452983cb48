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
pub(super) struct SideSlopes {
    runs: Vec<SlopeRun>,
    /// The least slope upward at all.
    pub(super) least_up: f64,
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

    /// The slopes along an axis, 0 for east and 1 for north, or against it.
    pub(super) fn side(&self, axis: usize, is_along: bool) -> &SideSlopes {
        &self.sides[2 * axis + usize::from(!is_along)]
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
        let least_up = runs.iter().flat_map(|(_, ups)| ups).copied().fold(f64::INFINITY, f64::min);
        let with_table = |(run, ups): (SlopeRun, Vec<f64>)| SlopeRun { least_up: table(ups), ..run };
        SideSlopes { runs: runs.into_iter().map(with_table).collect(), least_up }
    }

    /// The least slope upward among the seconds of some spells whose slope across lies between two values; `None` if there is
    /// none. Spells are pairs of indices, in order of time.
    pub(super) fn least(&self, across: [f64; 2], spells: &[[usize; 2]]) -> Option<f64> {
        self.runs.iter().filter_map(|run| run.least(across, spells)).reduce(f64::min)
    }
}

impl SlopeRun {
    /// Whether the slope goes on as before; the second one decides how.
    fn takes(&self, across: f64) -> bool {
        let last = self.across[self.across.len() - 1];
        self.across.len() == 1 || if self.is_rising { across >= last } else { across <= last }
    }

    fn least(&self, [low, high]: [f64; 2], spells: &[[usize; 2]]) -> Option<f64> {
        let all = &self.across;
        let [start, end] = match self.is_rising {
            true => [all.partition_point(|across| *across < low), all.partition_point(|across| *across <= high)],
            false => [all.partition_point(|across| *across > high), all.partition_point(|across| *across >= low)],
        };
        let [from, to] = [start + self.first, end + self.first];
        let first = spells.partition_point(|[_, end]| *end <= from);
        let meeting = spells[first..].iter().take_while(|[start, _]| *start < to);
        let least = |spell: &[usize; 2]| {
            let [start, end] = [spell[0].max(from) - self.first, spell[1].min(to) - self.first];
            let level = end.checked_sub(start)?.checked_ilog2()? as usize;
            let least = &self.least_up[level];
            Some(least[start].min(least[end - (1 << level)]))
        };
        meeting.filter_map(least).reduce(f64::min)
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
