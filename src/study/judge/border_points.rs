//! Points at random in the triangles of a border, and how far a sum over them may be off.
//!
//! Each triangle of the border counts as a whole or not at all, as its point does. Over all possible points the mean of
//! such a sum is the exact one, whatever the border's shape. Hoeffding (1963), *Probability inequalities for sums of
//! bounded random variables*, bounds its distance from its mean: a sum of independent terms, of which term i is 0 or at
//! most aᵢ, is farther off than t with a probability of at most 2·exp(−2t² / Σaᵢ²).
//!
//! The points are random as digits of a hash are: of the corners, so that every run and every machine has the same ones.

use crate::judgement::ERROR_ODDS;
use glam::DVec3;

/// The error of a sum, as a multiple of the root of the sum of its terms' squares, if this many sums are to keep theirs
/// together, whatever the number of rounds in which they are drawn, with a probability of all but [`ERROR_ODDS`]. The
/// first round has half of these odds, and each other one half of what the one before it has.
pub(super) fn error_factor(sums: usize, round: u32) -> f64 {
    let odds = ERROR_ODDS / 2f64.powi(round as i32 + 1) / sums.max(1) as f64;
    ((2.0 / odds).ln() / 2.0).sqrt()
}

/// Points in a triangle, each anywhere in it with the same probability. Another `round` has others.
pub(super) fn points_in(corners: [DVec3; 3], round: u64, count: usize) -> impl Iterator<Item = DVec3> {
    let [a, b, c] = corners;
    let coordinates = corners.into_iter().flat_map(|corner| corner.to_array());
    let mut state = coordinates.fold(mixed(round), |state, of| mixed(state ^ of.to_bits()));
    let mut next = move || {
        state = state.wrapping_add(GOLDEN);
        // the upper 53 bits, as many as a number has
        (mixed(state) >> 11) as f64 / (1u64 << 53) as f64
    };
    (0..count).map(move |_| {
        let [mut along, mut across] = [next(), next()];
        if along + across > 1.0 {
            [along, across] = [1.0 - along, 1.0 - across];
        }
        a + (b - a) * along + (c - a) * across
    })
}

/// The step of SplitMix64.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// The hash of SplitMix64 (Steele, Lea and Flood 2014, *Fast splittable pseudorandom number generators*).
fn mixed(of: u64) -> u64 {
    let of = (of ^ (of >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let of = (of ^ (of >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    of ^ (of >> 31)
}
