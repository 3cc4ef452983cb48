//! Panes that lie close behind each other: double and triple glazing, and inner sashes, are one window.

use super::glass::{Pane, outward};
use glam::DVec3;

/// The greatest distance between two panes of one window, metres: box windows have two sashes that far apart.
const APART_M: f64 = 0.2;
/// The cosine of the greatest angle between two panes of one window, 2.5°.
const PARALLEL: f64 = 0.999;
/// The least part of the smaller pane that lies behind the other one.
const BEHIND: f64 = 0.5;

/// Joins the panes of one component that are one window. Returns each window, with its outermost faces, and how many
/// panes were joined with others.
pub(super) fn joined(panes: Vec<Pane>) -> (Vec<Pane>, usize) {
    let mut first: Vec<usize> = (0..panes.len()).collect();
    for [one, other] in near(&panes) {
        if is_one_window(&panes[one], &panes[other]) {
            let [a, b] = [one, other].map(|at| root(&mut first, at));
            first[a.max(b)] = a.min(b);
        }
    }
    let mut windows: Vec<(usize, Pane)> = Vec::new();
    let mut joined = 0;
    for (at, pane) in panes.into_iter().enumerate() {
        let of = root(&mut first, at);
        // the first pane of a window comes before its others
        match windows.binary_search_by_key(&of, |(first, _)| *first) {
            Ok(found) => {
                joined += 1;
                windows[found].1 = around(&windows[found].1, &pane);
            }
            Err(place) => windows.insert(place, (of, pane)),
        }
    }
    (windows.into_iter().map(|(_, pane)| pane).collect(), joined)
}

fn root(first: &mut [usize], mut at: usize) -> usize {
    while first[at] != at {
        first[at] = first[first[at]];
        at = first[at];
    }
    at
}

/// The pairs of panes that may be one window: their boxes lie near each other.
fn near(panes: &[Pane]) -> Vec<[usize; 2]> {
    let of = |pane: &Pane| {
        let corners = || pane.sides.iter().flatten();
        let low = corners().fold(DVec3::INFINITY, |low, at| low.min(*at));
        [low, corners().fold(DVec3::NEG_INFINITY, |high, at| high.max(*at))]
    };
    let boxes: Vec<[DVec3; 2]> = panes.iter().map(of).collect();
    let all = |end: usize| boxes.iter().map(move |of| of[end]);
    let size = all(1).fold(DVec3::NEG_INFINITY, DVec3::max) - all(0).fold(DVec3::INFINITY, DVec3::min);
    // sorted along the longest side of all, so that only neighbours are compared
    let axis = size.max_position();
    let mut order: Vec<usize> = (0..boxes.len()).collect();
    order.sort_by(|one, other| boxes[*one][0][axis].total_cmp(&boxes[*other][0][axis]));
    let mut pairs = Vec::new();
    for (at, one) in order.iter().enumerate() {
        let [low, high] = [boxes[*one][0] - APART_M, boxes[*one][1] + APART_M];
        let follow = order[at + 1..].iter().take_while(|other| boxes[**other][0][axis] <= high[axis]);
        let meets = |other: &&usize| boxes[**other][0].cmple(high).all() && boxes[**other][1].cmpge(low).all();
        pairs.extend(follow.filter(meets).map(|other| [*one, *other]));
    }
    pairs
}

fn is_one_window(one: &Pane, other: &Pane) -> bool {
    let normal = outward(&one.sides[0]);
    if normal.dot(outward(&other.sides[0])).abs() < PARALLEL {
        return false;
    }
    let [left, right, _, above] = one.sides[0];
    let axes = [(right - left).normalize_or_zero(), (above - left).normalize_or_zero()];
    let span = |pane: &Pane, axis: DVec3| {
        let along = || pane.sides.iter().flatten().map(|corner| corner.dot(axis));
        [along().fold(f64::INFINITY, f64::min), along().fold(f64::NEG_INFINITY, f64::max)]
    };
    // how far two panes overlap along an axis; negative if they lie apart
    let common = |axis: DVec3| {
        let [a, b] = [one, other].map(|pane| span(pane, axis));
        a[1].min(b[1]) - a[0].max(b[0])
    };
    let area = |pane: &Pane| axes.iter().map(|axis| span(pane, *axis)).map(|[low, high]| high - low).product::<f64>();
    let [across, along] = axes.map(|axis| common(axis).max(0.0));
    across * along >= BEHIND * area(one).min(area(other)) && common(normal) >= -APART_M
}

/// The window of two panes: its front is the foremost of their faces, and its back the hindmost.
fn around(one: &Pane, other: &Pane) -> Pane {
    let normal = outward(&one.sides[0]);
    let mut sides = one.sides;
    for side in other.sides {
        let is_front = outward(&side).dot(normal) > 0.0;
        let own = &mut sides[usize::from(!is_front)];
        let ahead = if is_front { normal } else { -normal };
        if side[0].dot(ahead) > own[0].dot(ahead) {
            *own = side;
        }
    }
    Pane { sides, share: one.share.min(other.share) }
}
