//! Finds the seconds at which several polynomials of time are all positive: certainly, certainly not, or so close to 0
//! that the exact ray decides.

use super::sun_path::{DEGREE, Polynomial, Second, SunPiece};
use glam::DVec3;

/// What is known about some seconds.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Sureness {
    Above,
    Doubtful,
}

/// A halfspace whose boundary passes through the probe, and its uncertainty: the part of a sun's distance from the
/// boundary that may be error.
#[derive(Clone, Copy)]
pub(super) struct Halfspace {
    pub(super) normal: DVec3,
    /// Besides the error of the direction itself.
    pub(super) slack: f64,
}

/// A polynomial and its bounds.
#[derive(Clone, Copy)]
struct BoundedPolynomial {
    of: Polynomial<f64>,
    /// A value this close to 0 may have either sign.
    tolerance: f64,
    /// An eighth of the greatest second derivative.
    bulge: f64,
}

impl BoundedPolynomial {
    const ZERO: BoundedPolynomial = BoundedPolynomial { of: [0.0; DEGREE + 1], tolerance: 0.0, bulge: 0.0 };

    fn new(halfspace: &Halfspace, piece: &SunPiece) -> BoundedPolynomial {
        let of = piece.to_sun.map(|part| halfspace.normal.dot(part));
        let curved = of.iter().enumerate().map(|(power, part)| (power * power.saturating_sub(1)) as f64 * part.abs());
        let tolerance = piece.off_rad * halfspace.normal.length() + halfspace.slack;
        BoundedPolynomial { of, tolerance, bulge: curved.sum::<f64>() / 8.0 }
    }

    fn at(&self, unit: f64) -> f64 {
        self.of.iter().rev().fold(0.0, |sum, part| sum * unit + part)
    }

    /// Bounds of the values within a run of `units`, whose values at the ends are given.
    fn range(&self, [first, last]: [f64; 2], units: f64) -> [f64; 2] {
        let bulge = self.bulge * units * units;
        // if the chord is steeper than the bulge is at its ends, there is no extremum between them
        let bulge = if (last - first).abs() >= 4.0 * bulge { 0.0 } else { bulge };
        [first.min(last) - bulge, first.max(last) + bulge]
    }
}

/// Returns the runs of seconds of a piece in which all are positive, and those in which they may be.
pub(super) fn sift<const N: usize>(
    halfspaces: &[Halfspace; N],
    piece: &SunPiece,
    [first, last]: [Second; 2],
    found: &mut impl FnMut(Sureness, Second, Second),
) {
    let units = f64::from(last - first) / piece.unit_secs;
    let mut bounded = [BoundedPolynomial::ZERO; N];
    let mut values = [[0.0; N]; 2];
    for (number, halfspace) in halfspaces.iter().enumerate() {
        let function = BoundedPolynomial::new(halfspace, piece);
        let ends = [first, last].map(|second| function.at(piece.unit(second)));
        // most faces that are tried are missed, and one side tells
        if function.range(ends, units)[1] < -function.tolerance {
            return;
        }
        bounded[number] = function;
        [values[0][number], values[1][number]] = ends;
    }
    split(&bounded, piece, ([first, last], values), found);
}

fn split<const N: usize>(
    bounded: &[BoundedPolynomial; N],
    piece: &SunPiece,
    ([first, last], values): ([Second; 2], [[f64; N]; 2]),
    found: &mut impl FnMut(Sureness, Second, Second),
) {
    let units = f64::from(last - first) / piece.unit_secs;
    let mut all_above = true;
    let mut cut = None;
    for (index, function) in bounded.iter().enumerate() {
        let ends = [values[0][index], values[1][index]];
        let [low, high] = function.range(ends, units);
        if high < -function.tolerance {
            return;
        }
        all_above &= low > function.tolerance;
        if ends[0] * ends[1] < 0.0 {
            cut = Some(ends[0] / (ends[0] - ends[1]));
        }
    }
    if all_above {
        return found(Sureness::Above, first, last);
    }
    if first == last {
        return found(Sureness::Doubtful, first, last);
    }
    let length = f64::from(last - first);
    let middle = (first + (cut.unwrap_or(0.5) * length) as Second).clamp(first, last - 1);
    let at = |second: Second| bounded.each_ref().map(|function| function.at(piece.unit(second)));
    split(bounded, piece, ([first, middle], [values[0], at(middle)]), found);
    split(bounded, piece, ([middle + 1, last], [at(middle + 1), values[1]]), found);
}

/// Returns the seconds of a piece in which the values may all have the same sign, for a probe in a face's plane.
pub(super) fn sift_flat(
    halfspaces: &[Halfspace; 3],
    piece: &SunPiece,
    [first, last]: [Second; 2],
    found: &mut impl FnMut(Second),
) {
    let units = f64::from(last - first) / piece.unit_secs;
    let mut signs = [false; 2];
    for function in halfspaces.each_ref().map(|halfspace| BoundedPolynomial::new(halfspace, piece)) {
        let ends = [first, last].map(|second| function.at(piece.unit(second)));
        let [low, high] = function.range(ends, units);
        signs[0] |= high < -function.tolerance;
        signs[1] |= low > function.tolerance;
    }
    if signs == [true; 2] {
        return;
    }
    if first == last {
        return found(first);
    }
    let middle = first + (last - first) / 2;
    sift_flat(halfspaces, piece, [first, middle], found);
    sift_flat(halfspaces, piece, [middle + 1, last], found);
}
