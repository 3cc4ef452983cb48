//! The parts of an area that keep demands.
//!
//! A triangle counts where its corners agree. Where they differ the border passes through it. Such triangles are split
//! until points at random in them are enough to know the part: with as many points a random sum is nearer to the
//! truth than bounds from both sides are. Only corners decide what is split, so that the points stay random. Where few
//! triangles are left, half of each counts, and the error is half of their sum.

use super::super::StudyError;
use super::border_points::{error_factor, points_in};
use super::judging::Steps;
use super::samples::{AreaSpot, AreaSums, Leaf, Samples, SpotFunction, spread};

/// The number of times in which those triangles are split, too, in which a number may pass 0.
const NEAR_PASSES: usize = 2;
/// The most times that points are drawn.
const ROUNDS: u32 = 8;
/// The most points that are drawn in a triangle. If more were needed, splitting it takes fewer.
const MOST_EACH: usize = 3;

/// What is asked of the parts of an area.
pub(super) struct PartsAsked<'a> {
    /// The number of parts: of each, a point's number is at least 0.
    pub(super) numbers: usize,
    /// The error that is good enough, square metres, unless it takes too many points.
    pub(super) good_m2: f64,
    pub(super) most_points: usize,
    /// Whether these sums are enough for a verdict.
    pub(super) is_decided: &'a dyn Fn(&AreaSums) -> Result<bool, StudyError>,
}

impl Samples {
    /// The size of each part, with its error.
    pub(super) fn parts(
        &mut self,
        asked: &PartsAsked<'_>,
        value: SpotFunction<'_>,
        steps: &mut Steps<'_, '_>,
    ) -> Result<AreaSums, StudyError> {
        self.ask(value, steps)?;
        for _ in 0..NEAR_PASSES {
            self.split_where(value, steps, |three| is_open(three) || is_near(three))?;
        }
        let mut good_m2 = asked.good_m2;
        let mut round = 0u32;
        loop {
            let factor = error_factor(asked.numbers, round);
            let error_m2 = |samples: &Samples| {
                let errors = (0..asked.numbers).map(|number| samples.open(number).error_m2(factor, 1));
                errors.fold(0.0, f64::max)
            };
            while error_m2(self) > good_m2 * (MOST_EACH as f64).sqrt() && self.spots.len() <= asked.most_points {
                self.split_where(value, steps, is_open)?;
            }
            let needed = (error_m2(self) / good_m2).powi(2).ceil();
            let each = if needed <= MOST_EACH as f64 { (needed as usize).max(1) } else { 1 };
            let sums = self.drawn(asked.numbers, (factor, each, round), value, steps)?;
            round += 1;
            if round == ROUNDS || self.spots.len() > asked.most_points || (asked.is_decided)(&sums)? {
                return Ok(sums);
            }
            good_m2 /= 4.0;
        }
    }

    /// Splits those triangles of which one number's corners are so.
    fn split_where(
        &mut self,
        value: SpotFunction<'_>,
        steps: &mut Steps<'_, '_>,
        is_split: impl Fn([f64; 3]) -> bool,
    ) -> Result<(), StudyError> {
        let leaves = std::mem::take(&mut self.leaves);
        let (split, whole): (Vec<Leaf>, Vec<Leaf>) =
            leaves.into_iter().partition(|leaf| self.any_number(leaf, &is_split));
        self.leaves = whole;
        for leaf in split {
            for corners in self.quarters(leaf.corners) {
                self.leaves.push(Leaf { corners, m2: leaf.m2 / 4.0, changed: Vec::new() });
            }
        }
        self.ask(value, steps)
    }

    fn any_number(&self, leaf: &Leaf, is: impl Fn([f64; 3]) -> bool) -> bool {
        let numbers = self.values[leaf.corners[0] as usize].len();
        (0..numbers).any(|number| is(self.of_leaf(leaf.corners, number)))
    }

    /// The triangles through which a part's border passes.
    fn open(&self, number: usize) -> OpenTriangles {
        let mut open = OpenTriangles::default();
        for leaf in self.leaves.iter().filter(|leaf| is_open(self.of_leaf(leaf.corners, number))) {
            open.add(leaf.m2);
        }
        open
    }

    /// Draws points in the triangles of the borders, and adds up the parts.
    fn drawn(
        &mut self,
        numbers: usize,
        (factor, each, round): (f64, usize, u32),
        value: SpotFunction<'_>,
        steps: &mut Steps<'_, '_>,
    ) -> Result<AreaSums, StudyError> {
        let is_halved: Vec<bool> = (0..numbers).map(|number| self.open(number).is_halved(factor, each)).collect();
        let is_drawn =
            |leaf: &Leaf| (0..numbers).any(|number| !is_halved[number] && is_open(self.of_leaf(leaf.corners, number)));
        let drawn: Vec<bool> = self.leaves.iter().map(is_drawn).collect();
        let first = self.spots.len();
        for (leaf, _) in self.leaves.iter().zip(&drawn).filter(|(_, drawn)| **drawn) {
            let [a, b, c] = leaf.corners.map(|corner| self.spots[corner as usize]);
            let points = points_in([a.at, b.at, c.at], round.into(), each);
            self.spots.extend(points.map(|at| AreaSpot { at, normal: a.normal }));
        }
        self.ask(value, steps)?;
        let of = |number: usize| -> (f64, f64) {
            let (mut sum, mut spot) = (0.0, first);
            for (leaf, drawn) in self.leaves.iter().zip(&drawn) {
                let three = self.of_leaf(leaf.corners, number);
                let points = spot..spot + if *drawn { each } else { 0 };
                spot = points.end;
                sum += leaf.m2
                    * match is_open(three) {
                        true if is_halved[number] => 0.5,
                        true => points.filter(|spot| self.values[*spot][number] >= 0.0).count() as f64 / each as f64,
                        false => f64::from(u8::from(three[0] >= 0.0)),
                    };
            }
            (sum, self.open(number).error_m2(factor, each))
        };
        let (sums, errors) = (0..numbers).map(of).unzip();
        Ok(AreaSums { sums, errors })
    }
}

/// The sizes of the triangles through which a border passes: their sum, and that of their squares.
#[derive(Clone, Copy, Debug, Default)]
struct OpenTriangles {
    m2: f64,
    squares: f64,
}

impl OpenTriangles {
    fn add(&mut self, m2: f64) {
        self.m2 += m2;
        self.squares += m2 * m2;
    }

    /// The error with this many points drawn in each.
    fn error_m2(&self, factor: f64, each: usize) -> f64 {
        (self.m2 / 2.0).min(self.random_m2(factor, each))
    }

    fn random_m2(&self, factor: f64, each: usize) -> f64 {
        factor * (self.squares / each as f64).sqrt()
    }

    /// Whether half of each is known as well as points in them would tell.
    fn is_halved(&self, factor: f64, each: usize) -> bool {
        self.m2 / 2.0 <= self.random_m2(factor, each)
    }
}

/// Whether a border passes through a triangle: its corners do not all have the same side of 0.
fn is_open(three: [f64; 3]) -> bool {
    three.iter().any(|value| *value >= 0.0) && three.iter().any(|value| *value < 0.0)
}

/// Whether the number would pass 0 if it changed again by as much as it does in the triangle.
fn is_near(three: [f64; 3]) -> bool {
    let nearest = three.iter().map(|value| value.abs()).fold(f64::INFINITY, f64::min);
    nearest <= spread(three)
}

/// A part of triangles, for tests: where a number is at least 0.
#[cfg(feature = "test-hooks")]
#[derive(Clone, Copy, Debug)]
pub struct MeasuredPart {
    /// Its size, square metres.
    pub m2: f64,
    /// The error of that, ± square metres.
    pub error_m2: f64,
    /// The number of points at which the number was asked.
    pub points: usize,
}

/// Measures the part of triangles where a number is at least 0, as parts of areas are measured.
///
/// # Errors
/// None.
#[cfg(feature = "test-hooks")]
pub fn measured_part(
    triangles: &[crate::judgement::PartTriangle],
    (longest_m, good_m2): (f64, f64),
    at: chrono::DateTime<crate::sun::Zone>,
    number: impl Fn(glam::DVec3) -> f64 + Sync,
) -> Result<MeasuredPart, StudyError> {
    let mut on_event = |_: super::super::Event<'_>| std::ops::ControlFlow::Continue(());
    let mut steps = Steps::new(&mut on_event, 1, at)?;
    let mut samples = Samples::new(triangles, longest_m);
    let asked = PartsAsked { numbers: 1, good_m2, most_points: usize::MAX, is_decided: &|_| Ok(true) };
    let sums = samples.parts(&asked, &|spot| Ok(vec![number(spot.at)]), &mut steps)?;
    Ok(MeasuredPart { m2: sums.sums[0], error_m2: sums.errors[0], points: samples.spots.len() })
}
