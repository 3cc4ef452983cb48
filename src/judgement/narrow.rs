//! What is left of an area without the parts that are too narrow to count.
//!
//! The area is shrunk by half of the width and grown again: what is narrower vanishes, and all else comes back as it was.
//! Corners are kept, down to 45°; the tip of a sharper one is cut off.

use glam::DVec2;
use i_overlay::core::{fill_rule::FillRule, overlay_rule::OverlayRule};
use i_overlay::float::single::SingleFloatOverlay;
use i_overlay::mesh::outline::offset::OutlineOffset;
use i_overlay::mesh::style::{LineJoin, OutlineStyle};
use std::f64::consts::FRAC_PI_4;

/// A width that is measured to a millimetre is not narrow because of its rounding.
const MEASURED_M: f64 = 1e-3;

/// The part of an area that rounding may leave out.
const ROUNDING: f64 = 1e-6;

/// Rings in the form of the crate that cuts them.
type Contours = Vec<Vec<[f64; 2]>>;

/// The borders of an area's parts that are at least this wide, and the square metres of the others. Borders are
/// counter-clockwise and holes clockwise, before and after. An area without a narrow part stays as it is.
pub(super) fn wide_rings(rings: &[Vec<DVec2>], least_m: f64) -> (Vec<Vec<DVec2>>, f64) {
    let whole: Contours = rings.iter().map(|ring| ring.iter().map(|corner| corner.to_array()).collect()).collect();
    let half = (least_m - MEASURED_M) / 2.0;
    if half <= 0.0 {
        return (rings.to_vec(), 0.0);
    }
    let by = |offset: f64| OutlineStyle::new(offset).line_join(LineJoin::Miter(FRAC_PI_4));
    let grown: Contours = flat(flat(whole.outline(&by(-half))).outline(&by(half)));
    let wide = flat(grown.overlay(&whole, OverlayRule::Intersect, FillRule::NonZero));
    let narrow_m2 = size_m2(&whole) - size_m2(&wide);
    match narrow_m2 <= ROUNDING * size_m2(&whole) {
        true => (rings.to_vec(), 0.0),
        false => (unflat(wide), narrow_m2),
    }
}

/// The borders of several rings together, which may overlap.
pub(super) fn union(rings: &[Vec<DVec2>]) -> Vec<Vec<DVec2>> {
    combined(rings, &[], OverlayRule::Subject)
}

/// What lies within both of two sets of rings.
pub(super) fn within_both(one: &[Vec<DVec2>], other: &[Vec<DVec2>]) -> Vec<Vec<DVec2>> {
    combined(one, other, OverlayRule::Intersect)
}

fn combined(one: &[Vec<DVec2>], other: &[Vec<DVec2>], rule: OverlayRule) -> Vec<Vec<DVec2>> {
    let [one, other] = [one, other].map(|rings| -> Contours {
        rings.iter().map(|ring| ring.iter().map(|corner| corner.to_array()).collect()).collect()
    });
    unflat(flat(one.overlay(&other, rule, FillRule::NonZero)))
}

fn flat(shapes: Vec<Contours>) -> Contours {
    shapes.into_iter().flatten().collect()
}

fn unflat(contours: Contours) -> Vec<Vec<DVec2>> {
    contours.into_iter().map(|ring| ring.into_iter().map(DVec2::from_array).collect()).collect()
}

fn size_m2(contours: &Contours) -> f64 {
    let cross = |[a, b]: [[f64; 2]; 2]| DVec2::from_array(a).perp_dot(DVec2::from_array(b)) / 2.0;
    contours
        .iter()
        .map(|ring| (0..ring.len()).map(|at| cross([ring[at], ring[(at + 1) % ring.len()]])).sum::<f64>())
        .sum()
}
