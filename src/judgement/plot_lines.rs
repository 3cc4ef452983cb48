//! Lines at distances from a plot's deemed border.

use crate::rules::{Band, CornerRule, DeemedBoundary};
use crate::site::JudgedPlot;
use glam::DVec2;
use std::f64::consts::PI;

/// A corner that turns by more than this, radians, is rounded even if lines are to go straight on: they would meet far
/// away.
const LONGEST_MITRE: f64 = 0.75 * PI;

/// A place around a plot.
#[derive(Clone, Copy, Debug)]
pub struct PlotSpot {
    /// Its position in plan.
    pub at: DVec2,
    /// The height by which the plane is raised there, metres.
    pub raised_m: f64,
}

/// One side of the deemed border.
#[derive(Clone, Copy, Debug)]
struct DeemedSide {
    from: DVec2,
    to: DVec2,
    raised_m: f64,
}

/// The border from which distances are measured: the plot's border, moved outward where a road adjoins.
#[derive(Clone, Debug)]
pub struct DeemedBorder {
    sides: Vec<DeemedSide>,
    corners: CornerRule,
}

impl DeemedBorder {
    /// Of a plot, by a law or where it is.
    pub fn of(plot: &JudgedPlot, deemed: Option<DeemedBoundary>, corners: CornerRule) -> DeemedBorder {
        let count = plot.border.len();
        let adjoining = |at: usize| plot.sides.get(at).copied().unwrap_or_default();
        let moved = |at: usize| {
            let [from, to] = [plot.border[at], plot.border[(at + 1) % count]];
            let outward = -(to - from).normalize_or_zero().perp();
            let by = outward * deemed.map_or(0.0, |law| law.outward_m(adjoining(at).road_m));
            [from + by, to + by]
        };
        let raised = |at: usize| deemed.map_or(0.0, |law| law.raised_m(adjoining(at).neighbour_higher_m));
        let mut sides: Vec<DeemedSide> = Vec::new();
        let meeting = |before: usize, after: usize| meet(moved(before), moved(after));
        for at in 0..count {
            let (before, after) = ((at + count - 1) % count, (at + 1) % count);
            let [from, to] = moved(at);
            let from = meeting(before, at).unwrap_or(from);
            let end = meeting(at, after);
            sides.push(DeemedSide { from, to: end.unwrap_or(to), raised_m: raised(at) });
            if end.is_none() {
                // sides in one line that are moved by different distances make a step
                let next = moved(after)[0];
                sides.push(DeemedSide { from: to, to: next, raised_m: raised(at).min(raised(after)) });
            }
        }
        sides.retain(|side| side.from.distance(side.to) > 1e-9);
        DeemedBorder { sides, corners }
    }

    /// Its corners, for reports.
    pub fn corners(&self) -> Vec<DVec2> {
        self.sides.iter().map(|side| side.from).collect()
    }

    /// How far outside a place lies, metres; negative inside. Beside a corner that lines go round this is the distance from
    /// it; where they go straight on, that of the line which is farther.
    pub fn distance_m(&self, at: DVec2) -> f64 {
        let (away, _) = self.nearest(at);
        if self.is_inside(at) { -away } else { away }
    }

    /// How far a place lies from the border, and in which direction that grows.
    fn nearest(&self, at: DVec2) -> (f64, DVec2) {
        let count = self.sides.len();
        let of = |number: usize| {
            let (side, next) = (&self.sides[number], &self.sides[(number + 1) % count]);
            let foot = foot(side, at);
            let plain = (at.distance(foot), (at - foot).normalize_or(outward(side)));
            let turn = (side.to - side.from).angle_to(next.to - next.from);
            let is_beside_corner = part(side, at) >= 1.0 && part(next, at) <= 0.0 && turn > 0.0 && turn < LONGEST_MITRE;
            if !is_beside_corner || self.corners == CornerRule::Round {
                return plain;
            }
            let [one, other] = [side, next].map(|side| ((at - side.to).dot(outward(side)), outward(side)));
            if one.0 >= other.0 { one } else { other }
        };
        let nearer = |one: (f64, DVec2), other: (f64, DVec2)| if other.0 < one.0 { other } else { one };
        // a side beyond whose beginning a place lies leaves it to the side before
        let is_own = |number: &usize| {
            let before = &self.sides[(number + count - 1) % count];
            part(&self.sides[*number], at) > 0.0 || part(before, at) < 1.0
        };
        (0..count).filter(is_own).map(of).fold((f64::INFINITY, DVec2::ZERO), nearer)
    }

    /// A place, with the plane's raise at the nearest side; beside a corner the lesser of two.
    pub fn spot(&self, at: DVec2) -> PlotSpot {
        let nearest = self.sides.iter().map(|side| away(side, at)).fold(f64::INFINITY, f64::min);
        let near = self.sides.iter().filter(|side| away(side, at) <= nearest + 1e-6);
        let raised_m = near.map(|side| side.raised_m).fold(f64::INFINITY, f64::min);
        PlotSpot { at, raised_m: if raised_m.is_finite() { raised_m } else { 0.0 } }
    }

    /// Whether a place lies in a band.
    pub fn is_in(&self, band: Band, at: DVec2) -> bool {
        let distance = self.distance_m(at);
        distance >= band.from_m - 1e-6 && distance <= band.to_m + 1e-6
    }

    /// Moves a place that lies slightly inside a band's inner line onto it; other places stay.
    pub fn onto(&self, band: Band, at: DVec2) -> DVec2 {
        let (away, outward) = self.nearest(at);
        let lacking = band.from_m - if self.is_inside(at) { -away } else { away };
        if lacking > 0.0 && !self.is_inside(at) { at + outward * lacking } else { at }
    }

    /// The greatest distance between places on a line at a distance from the border.
    pub fn spacing_m(distance_m: f64, least_m: f64) -> f64 {
        least_m.max(distance_m * 0.05)
    }

    /// The places of a band, on its inner line and on lines further out, up to this distance. Each is at most
    /// `spacing_m` from the next one along a line near the border, and farther out at most a part of the distance.
    pub fn spots(&self, band: Band, reach_m: f64, spacing_m: f64) -> Vec<PlotSpot> {
        let mut spots = Vec::new();
        let far = band.to_m.min(band.from_m.max(reach_m));
        let mut distance = band.from_m;
        loop {
            spots.extend(self.line(distance, DeemedBorder::spacing_m(distance, spacing_m)));
            if distance >= far {
                return spots;
            }
            distance = (distance + (distance * 0.1).max(spacing_m)).min(far);
        }
    }

    /// The places on the line at a distance.
    fn line(&self, distance: f64, spacing: f64) -> Vec<PlotSpot> {
        let mut found = Vec::new();
        let mut add = |at: DVec2| {
            // no line lies in front of a reflex corner
            if self.distance_m(at) >= distance - 1e-6 {
                found.push(self.spot(at));
            }
        };
        for (number, side) in self.sides.iter().enumerate() {
            let outward_m = outward(side) * distance;
            along([side.from + outward_m, side.to + outward_m], spacing, &mut add);
            let next = &self.sides[(number + 1) % self.sides.len()];
            let [one, other] = [side, next].map(|side| side.to - side.from);
            let turn = one.angle_to(other);
            if turn <= 1e-9 || distance <= 0.0 {
                continue;
            }
            let next_outward = outward(next) * distance;
            let mitre =
                meet([side.from + outward_m, side.to + outward_m], [next.from + next_outward, next.to + next_outward]);
            match (self.corners, mitre) {
                (CornerRule::Mitred, Some(tip)) if turn < LONGEST_MITRE => {
                    along([side.to + outward_m, tip], spacing, &mut add);
                    along([tip, next.from + next_outward], spacing, &mut add);
                }
                _ => {
                    let steps = (turn * distance / spacing).ceil().clamp(1.0, 1e4);
                    for step in 0..=steps as usize {
                        let angle = turn * step as f64 / steps;
                        add(side.to + DVec2::from_angle(angle).rotate(outward_m));
                    }
                }
            }
        }
        found
    }
}

/// The ends of a line, and places between them.
fn along([from, to]: [DVec2; 2], spacing: f64, add: &mut impl FnMut(DVec2)) {
    let steps = (from.distance(to) / spacing).ceil().clamp(1.0, 1e5);
    for step in 0..=steps as usize {
        add(from.lerp(to, step as f64 / steps));
    }
}

/// The point where two lines meet; `None` if they are parallel.
fn meet([from, to]: [DVec2; 2], [other_from, other_to]: [DVec2; 2]) -> Option<DVec2> {
    let (one, other) = (to - from, other_to - other_from);
    let cross = one.perp_dot(other);
    if cross.abs() <= 1e-6 * one.length() * other.length() {
        return None;
    }
    Some(from + one * ((other_from - from).perp_dot(other) / cross))
}

/// The position of a place along a side, 0 to 1 between its ends.
fn part(side: &DeemedSide, at: DVec2) -> f64 {
    let along = side.to - side.from;
    (at - side.from).dot(along) / along.length_squared()
}

fn foot(side: &DeemedSide, at: DVec2) -> DVec2 {
    side.from + (side.to - side.from) * part(side, at).clamp(0.0, 1.0)
}

fn outward(side: &DeemedSide) -> DVec2 {
    -(side.to - side.from).normalize().perp()
}

fn away(side: &DeemedSide, at: DVec2) -> f64 {
    at.distance(foot(side, at))
}

impl DeemedBorder {
    fn is_inside(&self, at: DVec2) -> bool {
        let mut inside = false;
        for DeemedSide { from, to, .. } in &self.sides {
            if (from.y > at.y) != (to.y > at.y) {
                let x = from.x + (at.y - from.y) / (to.y - from.y) * (to.x - from.x);
                inside ^= at.x < x;
            }
        }
        inside
    }
}
