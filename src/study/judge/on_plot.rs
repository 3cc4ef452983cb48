//! What stands on a plot: rules about lines around it count the shadow of the building there, and not that of neighbours.

use crate::mesh::Component;
use crate::rules::{ResolvedRule, RuleError, RuleNeed, RuleReceiver};
use crate::site::{JudgedPlot, JudgedSite, JudgedState};
use glam::DVec2;

/// A site in which only what stands on its plot casts.
pub(super) struct SiteOnPlot {
    pub(super) site: JudgedSite,
    /// The names of the components that cast there no longer.
    pub(super) left_out: Vec<String>,
}

/// The site with only what stands on its plot casting, if the rule is about lines around that.
///
/// # Errors
/// [`RuleError::Needs`] if nothing stands there: no shadow of nothing would be a verdict.
pub(super) fn casting_on_plot(site: &JudgedSite, rule: &ResolvedRule) -> Result<Option<SiteOnPlot>, RuleError> {
    let is_about_lines = matches!(rule.receiver, RuleReceiver::Lines { .. });
    let Some(plot) = site.plot.as_ref().filter(|_| is_about_lines) else { return Ok(None) };
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
    if !site_on_plot.now.casts.contains(&true) {
        let needs = vec![RuleNeed::without_key("a building on the plot: nothing that casts stands within its border")];
        return Err(RuleError::Needs { rule: rule.id.clone(), needs });
    }
    let named = site.now.mesh.components.iter().zip(left_out).filter(|(_, left_out)| *left_out);
    let left_out = named.map(|(component, _)| format!("\"{}\"", component.name)).collect();
    Ok(Some(SiteOnPlot { site: site_on_plot, left_out }))
}

/// Whether a part of a component lies above the plot, also where all of its corners lie beside it.
fn stands_on(state: &JudgedState, component: &Component, plot: &JudgedPlot) -> bool {
    component.faces.clone().any(|face| {
        let corners = state.mesh.corners(face as usize);
        overlaps(corners.map(|corner| (state.mesh.origin + corner.as_dvec3()).truncate()), &plot.border)
    })
}

/// Whether a triangle seen from above, which may be a line, has a point within a border or on it.
fn overlaps(triangle: [DVec2; 3], border: &[DVec2]) -> bool {
    let [a, b, c] = triangle;
    let around = |at: DVec2| {
        let turns = [(a, b), (b, c), (c, a)].map(|(from, to)| (to - from).perp_dot(at - from));
        turns.iter().all(|turn| *turn > 0.0) || turns.iter().all(|turn| *turn < 0.0)
    };
    let sides = || (0..border.len()).map(|side| [border[side], border[(side + 1) % border.len()]]);
    let cross = |[a, b]: [DVec2; 2], [c, d]: [DVec2; 2]| {
        let side = |from: DVec2, to: DVec2, at: DVec2| (to - from).perp_dot(at - from);
        side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
    };
    triangle.iter().any(|corner| is_within(*corner, border))
        || border.iter().any(|corner| around(*corner))
        || sides().any(|side| [[a, b], [b, c], [c, a]].into_iter().any(|edge| cross(edge, side)))
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
