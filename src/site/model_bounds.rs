//! The box around a model.

use crate::formats::Model;
use glam::DVec3;
use rayon::prelude::*;

/// The box around the images of a model's corners under `of`; `None` without corners.
pub(super) fn bounds(model: &Model, of: impl Fn(DVec3) -> DVec3 + Sync) -> Option<[DVec3; 2]> {
    let none = [DVec3::INFINITY, DVec3::NEG_INFINITY];
    let wider = |[low, high]: [DVec3; 2], corner: &DVec3| {
        let at = of(*corner);
        [low.min(at), high.max(at)]
    };
    let both = |one: [DVec3; 2], other: [DVec3; 2]| [one[0].min(other[0]), one[1].max(other[1])];
    let corners = model.parts.par_iter().flat_map(|part| part.positions.par_iter());
    let found = corners.fold(|| none, wider).reduce(|| none, both);
    (found[0].is_finite() && found[1].is_finite()).then_some(found)
}
