//! What stands on a plot: rules about lines around it count the shadow of the building there, and not that of neighbours.

use crate::mesh::Component;
use crate::rules::{ResolvedRule, RuleReceiver};
use crate::site::{JudgedPlot, JudgedSite, JudgedState};
use glam::DVec2;

/// The site with only what stands on its plot casting, if the rule is about lines around that; and how many components
/// cast there no longer.
pub(super) fn casting_on_plot(site: &JudgedSite, rule: &ResolvedRule) -> Option<(JudgedSite, usize)> {
    let plot = site.plot.as_ref().filter(|_| matches!(rule.receiver, RuleReceiver::Lines { .. }))?;
    let mut site_on_plot = site.clone();
    let mut left_out = vec![false; site.now.mesh.components.len()];
    for state in std::iter::once(&mut site_on_plot.now).chain(&mut site_on_plot.before) {
        let stands: Vec<bool> =
            state.mesh.components.iter().map(|component| stands_on(state, component, plot)).collect();
        for (at, (casts, stands)) in state.casts.iter_mut().zip(stands).enumerate() {
            if *casts && !stands {
                *casts = false;
                left_out.get_mut(at).into_iter().for_each(|left_out| *left_out = true);
            }
        }
    }
    Some((site_on_plot, left_out.into_iter().filter(|left_out| *left_out).count()))
}

/// Whether a corner of a component lies above the plot.
fn stands_on(state: &JudgedState, component: &Component, plot: &JudgedPlot) -> bool {
    component.faces.clone().any(|face| {
        let corners = state.mesh.corners(face as usize);
        corners.iter().any(|corner| is_within((state.mesh.origin + corner.as_dvec3()).truncate(), &plot.border))
    })
}

/// Whether a point lies within a border, or on it.
fn is_within(at: DVec2, border: &[DVec2]) -> bool {
    /// The tolerance at the border, metres: models end there exactly, up to rounding.
    const NEAR_M: f64 = 0.01;
    let sides = || (0..border.len()).map(|side| [border[side], border[(side + 1) % border.len()]]);
    let crosses =
        |[a, b]: [DVec2; 2]| (a.y > at.y) != (b.y > at.y) && at.x < a.x + (at.y - a.y) / (b.y - a.y) * (b.x - a.x);
    let is_near = |[a, b]: [DVec2; 2]| {
        let along = ((at - a).dot(b - a) / (b - a).length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
        at.distance(a.lerp(b, along)) <= NEAR_M
    };
    sides().filter(|side| crosses(*side)).count() % 2 == 1 || sides().any(is_near)
}
