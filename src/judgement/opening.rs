//! The points where a window is judged, and the opening through which a point inside sees the sun.

use crate::rules::{RuleReceiver, WindowPoint};
use crate::site::JudgedWindow;
use glam::DVec3;

/// The least height of a point above the sill, metres: a lower one would lie on the sill itself.
const ABOVE_BOARD_M: f64 = 0.001;

/// A wall thinner than this has no reveal, metres.
const FLAT_M: f64 = 1e-6;

/// The points where a window is judged.
#[derive(Clone, Debug)]
pub struct WindowSpot {
    /// Its points; it is lit while all of them are.
    pub points: Vec<DVec3>,
    /// The opening, if the point is inside the wall.
    pub through: Option<Opening>,
}

/// An opening of a wall, as it is seen from a point inside.
#[derive(Clone, Debug)]
pub struct Opening {
    /// Its corners in the wall's outer plane, in the order of the window's corners.
    pub corners: [DVec3; 4],
    /// The unit normal, away from the room.
    pub outward: DVec3,
}

impl Opening {
    /// The normals of the planes through a point and the opening's sides: what lies in front of all of them, and of the
    /// wall, is seen through the opening.
    pub fn planes_from(&self, point: DVec3) -> Vec<DVec3> {
        let middle = self.corners.iter().sum::<DVec3>() / 4.0 - point;
        if self.outward.dot(middle) < FLAT_M {
            // in the outer plane itself the opening hides nothing
            return vec![self.outward];
        }
        let side = |at: usize| {
            let [from, to] = [self.corners[at] - point, self.corners[(at + 1) % 4] - point];
            let normal = from.cross(to).normalize_or_zero();
            if normal.dot(middle) < 0.0 { -normal } else { normal }
        };
        // a point in line with a side sees along it, so that side hides nothing
        (0..4).map(side).filter(|normal| *normal != DVec3::ZERO).collect()
    }

    /// The distance of the wall's outer plane from the origin, along the normal, metres.
    pub fn plane_m(&self) -> f64 {
        self.outward.dot(self.corners[0])
    }
}

/// What a rule needs of a window and the site does not have, each as a part of a sentence and its key.
pub fn needed_of_window(receiver: &RuleReceiver, window: &JudgedWindow) -> Vec<[&'static str; 2]> {
    let RuleReceiver::Window { at, floor_m, .. } = receiver else { return Vec::new() };
    let mut needed = Vec::new();
    if *floor_m > 0.0 && window.floor.is_none() {
        needed.push(["the height of the floor", "floor"]);
    }
    if *at == WindowPoint::MiddleInside && window.inner_m.is_none() {
        needed.push(["how far the wall's inner plane lies behind the glass", "inner"]);
    }
    needed
}

/// The points where a rule judges a window; `None` if it does not judge windows, or if the site lacks what it needs.
pub fn window_spot(receiver: &RuleReceiver, window: &JudgedWindow) -> Option<WindowSpot> {
    let RuleReceiver::Window { at, floor_m, sill_m, .. } = receiver else { return None };
    let [left, right, head_right, head_left] = window.corners;
    let (sill, head) = ((left + right) / 2.0, (head_left + head_right) / 2.0);
    let up = (head - sill).normalize_or(DVec3::Z);
    let is_middle = matches!(at, WindowPoint::MiddleInside | WindowPoint::MiddleOutside);
    let is_raised = *floor_m > 0.0 || *sill_m > 0.0;
    let least_z = match window.floor {
        Some(floor) if *floor_m > 0.0 => (floor + floor_m).max(sill.z + sill_m),
        None if *floor_m > 0.0 => return None,
        _ => sill.z + sill_m,
    };
    // upward within the plane of the glass, which may lean
    let raised = |from: DVec3| if up.z > 1e-6 { from + up * ((least_z - from.z).max(0.0) / up.z) } else { from };
    let on_glass = |sill_point: DVec3, middle: DVec3| match (is_middle, is_raised) {
        (true, false) => middle,
        // a rule that counts from both floor and sill means the lowest point that both allow
        (true, true) | (false, true) => raised(sill_point),
        (false, false) => sill_point,
    };
    let middle = on_glass(sill, (sill + head) / 2.0);
    let outside = window.outward * window.reveal_m;
    let opening = || Opening { corners: window.corners.map(|corner| corner + outside), outward: window.outward };
    let above_board = up * ABOVE_BOARD_M;
    Some(match at {
        WindowPoint::MiddleInside => {
            WindowSpot { points: vec![middle - window.outward * window.inner_m?], through: Some(opening()) }
        }
        WindowPoint::SillInside => WindowSpot { points: vec![middle + above_board], through: Some(opening()) },
        WindowPoint::MiddleOutside => WindowSpot { points: vec![middle + outside], through: None },
        WindowPoint::SillMiddle => WindowSpot { points: vec![middle + above_board + outside], through: None },
        WindowPoint::SillEnds => {
            let ends = [left, right].map(|end| on_glass(end, end) + above_board + outside);
            WindowSpot { points: ends.to_vec(), through: None }
        }
    })
}
