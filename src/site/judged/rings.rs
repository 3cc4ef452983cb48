//! Borders in plan: whether they bound areas, and their direction.

use crate::message::{Message, message};
use glam::DVec2;

/// Corners and sides that are nearer to each other than this touch, metres.
const TOUCH_M: f64 = 1e-6;
/// The greatest distance of a corner from the place, metres: farther away, the sun's direction differs, and a larger
/// number is a map's coordinate.
const FARTHEST_M: f64 = 50_000.0;
/// The most corners of one area's borders.
const MOST_CORNERS: usize = 20_000;

/// A border, with its corners' numbers in the order that was written, from 1.
#[derive(Clone, Debug)]
pub(super) struct CheckedRing {
    /// Counter-clockwise as an outer border, clockwise as a hole.
    pub(super) corners: Vec<DVec2>,
    /// The number of each corner.
    pub(super) numbers: Vec<usize>,
    /// Whether it was written in the opposite direction.
    pub(super) is_reversed: bool,
}

/// One side of a border.
#[derive(Clone, Copy)]
struct RingSide {
    ring: usize,
    index: usize,
    from: DVec2,
    to: DVec2,
}

/// The borders of one area as they are meant: those within an even number of others are outer borders, and the others
/// are holes.
///
/// # Errors
/// A message that says what is wrong, and names the corner.
pub(super) fn checked(written: &[Vec<DVec2>]) -> Result<Vec<CheckedRing>, Message> {
    let count: usize = written.iter().map(Vec::len).sum();
    if count > MOST_CORNERS {
        let what = format!("has {count} corners");
        return Err(message![what; format!("draw it with at most {MOST_CORNERS}")]);
    }
    let is_alone = written.len() == 1;
    let of = |index: usize| if is_alone { String::new() } else { format!("of border {} ", index + 1) };
    let mut rings = Vec::with_capacity(written.len());
    for (index, corners) in written.iter().enumerate() {
        rings.push(ring(corners, &of(index))?);
    }
    if rings.is_empty() {
        return Err(message!["has no corners"; "write at least three"]);
    }
    if let Some(meeting) = meeting(&rings) {
        return Err(crossing(&rings, meeting, &of));
    }
    for index in 0..rings.len() {
        let at = rings[index].corners[0];
        let around = |(other, ring): (usize, &CheckedRing)| other != index && is_within(at, &ring.corners);
        let depth = rings.iter().enumerate().filter(|&(other, ring)| around((other, ring))).count();
        let is_outer = depth % 2 == 0;
        let ring = &mut rings[index];
        if (signed_area(&ring.corners) > 0.0) != is_outer {
            ring.corners.reverse();
            ring.numbers.reverse();
            ring.is_reversed = true;
        }
    }
    Ok(rings)
}

/// Why corners bound no area, if they do not.
#[cfg(feature = "desktop")]
pub(crate) fn border_fault(corners: &[DVec2]) -> Option<Message> {
    checked(&[corners.to_vec()]).err()
}

/// The corners of one border without repeats.
fn ring(written: &[DVec2], of: &str) -> Result<CheckedRing, Message> {
    if let Some(at) = written.iter().position(|corner| !corner.is_finite() || corner.abs().max_element() > FARTHEST_M) {
        let what = format!(
            "has a corner, number {} {of}at {}, that is not a point within 50 km of the place",
            at + 1,
            written[at]
        );
        return Err(message![what; "write metres east and north of the place, for example [12.0, -3.0]"]);
    }
    let mut ring = CheckedRing { corners: Vec::new(), numbers: Vec::new(), is_reversed: false };
    for (index, corner) in written.iter().enumerate() {
        if ring.corners.last().is_none_or(|last| last.distance(*corner) > TOUCH_M) {
            ring.corners.push(*corner);
            ring.numbers.push(index + 1);
        }
    }
    while ring.corners.len() > 1 && ring.corners[0].distance(ring.corners[ring.corners.len() - 1]) <= TOUCH_M {
        ring.corners.pop();
        ring.numbers.pop();
    }
    if ring.corners.len() < 3 {
        let corners = if ring.corners.len() == 1 { "corner" } else { "corners" };
        let what = format!("has {} {corners} {of}that lie apart", ring.corners.len());
        return Err(message![what; "write at least three"]);
    }
    let first = ring.corners[0];
    let farthest =
        ring.corners.iter().fold(first, |far, at| if first.distance(*at) > first.distance(far) { *at } else { far });
    let way = (farthest - first).normalize();
    if ring.corners.iter().all(|corner| (*corner - first).perp_dot(way).abs() <= TOUCH_M) {
        let what = format!("has no area: all corners {of}lie on one line");
        return Err(message![what; "write the corners around an area"]);
    }
    Ok(ring)
}

/// Twice the area, positive if counter-clockwise; relative to the first corner, so that far areas are as exact as near
/// ones.
fn signed_area(corners: &[DVec2]) -> f64 {
    let first = corners[0];
    corners.windows(2).map(|pair| (pair[0] - first).perp_dot(pair[1] - first)).sum()
}

/// Whether a point lies within a border.
fn is_within(at: DVec2, corners: &[DVec2]) -> bool {
    let mut is_within = false;
    for index in 0..corners.len() {
        let (a, b) = (corners[index], corners[(index + 1) % corners.len()]);
        if (a.y > at.y) != (b.y > at.y) && at.x < a.x + (at.y - a.y) / (b.y - a.y) * (b.x - a.x) {
            is_within = !is_within;
        }
    }
    is_within
}

/// Finds two sides that cross or touch, or of which one turns back on the other.
fn meeting(rings: &[CheckedRing]) -> Option<[RingSide; 2]> {
    let mut sides: Vec<RingSide> = Vec::new();
    for (ring, of) in rings.iter().enumerate() {
        let next = |index: usize| of.corners[(index + 1) % of.corners.len()];
        sides.extend((0..of.corners.len()).map(|index| RingSide {
            ring,
            index,
            from: of.corners[index],
            to: next(index),
        }));
    }
    // sorted by their western ends, so that only sides beside each other are compared
    sides.sort_unstable_by(|one, other| west(one).total_cmp(&west(other)));
    for (at, one) in sides.iter().enumerate() {
        let east = one.from.x.max(one.to.x) + TOUCH_M;
        for other in sides[at + 1..].iter().take_while(|other| west(other) <= east) {
            let lies_beside = one.from.y.max(one.to.y) + TOUCH_M < other.from.y.min(other.to.y)
                || other.from.y.max(other.to.y) + TOUCH_M < one.from.y.min(one.to.y);
            if lies_beside {
                continue;
            }
            let count = rings[one.ring].corners.len();
            let follows = |first: &RingSide, then: &RingSide| (first.index + 1) % count == then.index;
            let meets = match one.ring == other.ring {
                // in a triangle each side follows both others
                true if follows(one, other) => turns_back(one, other),
                true if follows(other, one) => turns_back(other, one),
                _ => distance(one, other) <= TOUCH_M,
            };
            if meets {
                return Some([*one, *other]);
            }
        }
    }
    None
}

fn west(side: &RingSide) -> f64 {
    side.from.x.min(side.to.x)
}

/// Whether a side turns back along the one before it.
fn turns_back(first: &RingSide, then: &RingSide) -> bool {
    to_side(then.to, first) <= TOUCH_M || to_side(first.from, then) <= TOUCH_M
}

fn to_side(at: DVec2, side: &RingSide) -> f64 {
    let along = side.to - side.from;
    let share = ((at - side.from).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    at.distance(side.from + along * share)
}

/// The distance between two sides; 0 if they cross.
fn distance(one: &RingSide, other: &RingSide) -> f64 {
    let beside = |side: &RingSide, at: DVec2| (side.to - side.from).perp_dot(at - side.from);
    let parts = |side: &RingSide, of: &RingSide| (beside(side, of.from) > 0.0) != (beside(side, of.to) > 0.0);
    if parts(one, other) && parts(other, one) {
        return 0.0;
    }
    let ends = [to_side(one.from, other), to_side(one.to, other), to_side(other.from, one), to_side(other.to, one)];
    ends.into_iter().fold(f64::INFINITY, f64::min)
}

/// The message that two sides meet.
fn crossing(rings: &[CheckedRing], [one, other]: [RingSide; 2], of: &dyn Fn(usize) -> String) -> Message {
    let side = |side: &RingSide| {
        let ring = &rings[side.ring];
        let ends = [side.index, (side.index + 1) % ring.numbers.len()].map(|at| ring.numbers[at]);
        format!("between the corners {} and {} {}", ends[0], ends[1], of(side.ring)).trim_end().to_owned()
    };
    let mut sides = [one, other];
    sides.sort_by_key(|side| (side.ring, side.index));
    let itself = if one.ring == other.ring { "crosses or touches itself" } else { "has borders that cross or touch" };
    let what = format!("{itself}: the side {} meets that {}", side(&sides[0]), side(&sides[1]));
    message![what; "write the corners in their order around the area, and holes and parts apart from each other"]
}
