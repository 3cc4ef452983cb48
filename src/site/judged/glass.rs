//! A piece of glass, or four corners → the rectangle of a pane.

use crate::mesh::Mesh;
use crate::message::{Message, message};
use glam::{DVec3, Vec3};

/// The greatest thickness of a pane, metres; it is also at most half as thick as wide and high.
const THICKEST_M: f64 = 0.25;
/// The greatest distance of a pane's corners from a plane and from a rectangle, metres.
const FLAT_M: f64 = 0.02;
/// The shortest side of a pane, metres.
const SHORTEST_M: f64 = 0.01;

/// The pane of a piece of glass.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pane {
    /// For each of its two faces, the corners as seen from that side: the lower edge's left and right end, then the
    /// upper edge's right and left end.
    pub(super) sides: [[DVec3; 4]; 2],
    /// The share of its rectangle that is glass.
    pub(super) share: f64,
}

/// The unit normal of a pane, towards the side from which its corners are counter-clockwise.
pub(super) fn outward(corners: &[DVec3; 4]) -> DVec3 {
    (corners[2] - corners[0]).cross(corners[3] - corners[1]).normalize_or_zero()
}

/// The rectangle around a flat piece, in the world frame; `None` if the piece is not flat.
pub(super) fn pane(mesh: &Mesh, faces: &[u32]) -> Option<Pane> {
    let corners = |face: &u32| mesh.corners(*face as usize).map(Vec3::as_dvec3);
    let vector = |face: &u32| {
        let [a, b, c] = corners(face);
        (b - a).cross(c - a)
    };
    let largest = faces.iter().map(vector).max_by(|one, other| one.length().total_cmp(&other.length()))?;
    let normal = largest.try_normalize()?;
    let (right, up) = axes(normal);
    let span = |axis: DVec3| {
        let on = || faces.iter().flat_map(corners).map(|corner| corner.dot(axis));
        [on().fold(f64::INFINITY, f64::min), on().fold(f64::NEG_INFINITY, f64::max)]
    };
    let [across, along, through] = [right, up, normal].map(span);
    let [width, height, thickness] = [across, along, through].map(|[low, high]| high - low);
    if width.min(height) < SHORTEST_M || thickness > THICKEST_M.min(width.min(height) / 2.0) {
        return None;
    }
    // the area of the front, or of the back if the file lacks the front
    let area = |sign: f64| -> f64 {
        let of = faces.iter().map(|face| sign * vector(face).dot(normal) / 2.0);
        of.filter(|area| *area > 0.0).sum()
    };
    let share = area(1.0).max(area(-1.0)) / (width * height);
    let at = |x: f64, y: f64, z: f64| mesh.origin + right * x + up * y + normal * z;
    let [[left, right], [low, high], [back, front]] = [across, along, through];
    let side =
        |left: f64, right: f64, z: f64| [at(left, low, z), at(right, low, z), at(right, high, z), at(left, high, z)];
    Some(Pane { sides: [side(left, right, front), side(right, left, back)], share })
}

/// The unit vectors to the right and upward in a plane, seen from its front.
fn axes(normal: DVec3) -> (DVec3, DVec3) {
    let upward = DVec3::Z - normal * normal.z;
    // the upper edge of a level pane is the northern one
    let up = if upward.length() > 1e-3 { upward } else { DVec3::Y - normal * normal.y }.normalize();
    (up.cross(normal), up)
}

/// The corners of a rectangle that were written in order around it, so that they begin at its lowest edge.
///
/// # Errors
/// A message that says why they are not a rectangle.
pub(super) fn rectangle(written: [[f64; 3]; 4]) -> Result<[DVec3; 4], Message> {
    const FARTHEST_M: f64 = 50_000.0;
    let corners = written.map(DVec3::from_array);
    let hint = "write metres east, north and up of the place";
    if let Some(at) = corners.iter().position(|corner| !corner.is_finite() || corner.abs().max_element() > FARTHEST_M) {
        return Err(message![format!("{} is not a point within 50 km of the place", corners[at]); hint]);
    }
    let sides: [f64; 4] = std::array::from_fn(|at| corners[at].distance(corners[(at + 1) % 4]));
    if let Some(at) = sides.iter().position(|side| *side < SHORTEST_M) {
        let what = format!("the corners {} and {} lie in one point", at + 1, (at + 1) % 4 + 1);
        return Err(message![what; "write four different ones"]);
    }
    // opposite corners of a rectangle have the same middle, and its diagonals have the same length
    let [across, along] = [corners[2] - corners[0], corners[3] - corners[1]];
    let middles = (corners[0] + corners[2]).distance(corners[1] + corners[3]) / 2.0;
    if middles > FLAT_M || (across.length() - along.length()).abs() > FLAT_M || outward(&corners) == DVec3::ZERO {
        let what = "the four corners are no rectangle, to 2 cm";
        return Err(message![what; "write them in their order around the glass, beginning at the sill"]);
    }
    let middle = |at: usize| corners[at].z + corners[(at + 1) % 4].z;
    // if two edges are equally low, the one that is written first
    let lowest = (1..4).fold(0, |lowest, at| if middle(at) < middle(lowest) - 1e-6 { at } else { lowest });
    Ok(std::array::from_fn(|at| corners[(at + lowest) % 4]))
}
