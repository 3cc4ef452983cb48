//! A piece of glass, or four corners → the rectangle of a pane.

use crate::mesh::Mesh;
use crate::message::{Message, message};
use glam::{DVec3, Vec3};

/// No pane is thicker, metres; nor than half of its width and height.
const THICKEST_M: f64 = 0.25;
/// Corners that lie farther out of a plane, or of a rectangle, make no pane, metres.
const FLAT_M: f64 = 0.02;
/// The shortest side of a pane, metres.
const SHORTEST_M: f64 = 0.01;

/// A pane of some piece.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pane {
    /// Of its two faces the corners as they are seen from there: the lower edge's left and right end, the upper edge's right
    /// and left end.
    pub(super) sides: [[DVec3; 4]; 2],
    /// Which part of its rectangle is glass.
    pub(super) share: f64,
}

/// The direction to which a pane looks whose corners are seen counter-clockwise.
pub(super) fn outward(corners: &[DVec3; 4]) -> DVec3 {
    (corners[2] - corners[0]).cross(corners[3] - corners[1]).normalize_or_zero()
}

/// The rectangle around a flat piece, in the world frame; none of a piece that is not flat.
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
    // the area in front, or behind where the front is not in the file
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

/// The unit vectors to the right and upward in a plane, for who looks at its front.
fn axes(normal: DVec3) -> (DVec3, DVec3) {
    let upward = DVec3::Z - normal * normal.z;
    // a pane that lies level has its head in the north
    let up = if upward.length() > 1e-3 { upward } else { DVec3::Y - normal * normal.y }.normalize();
    (up.cross(normal), up)
}

/// The corners of a rectangle that somebody wrote in their order around it, beginning at its lowest edge.
///
/// # Errors
/// Why they make no rectangle.
pub(super) fn rectangle(written: [[f64; 3]; 4]) -> Result<[DVec3; 4], Message> {
    const FARTHEST_M: f64 = 50_000.0;
    let corners = written.map(DVec3::from_array);
    let hint = "write metres east, north and up of the place";
    if let Some(at) = corners.iter().position(|corner| !corner.is_finite() || corner.abs().max_element() > FARTHEST_M) {
        return Err(message![format!("{} is no point within 50 km", corners[at]); hint]);
    }
    let sides: [f64; 4] = std::array::from_fn(|at| corners[at].distance(corners[(at + 1) % 4]));
    if let Some(at) = sides.iter().position(|side| *side < SHORTEST_M) {
        let what = format!("the corners {} and {} lie in one point", at + 1, (at + 1) % 4 + 1);
        return Err(message![what; "write four different ones"]);
    }
    // of a rectangle the corners opposite to each other have one middle, and its diagonals one length
    let [across, along] = [corners[2] - corners[0], corners[3] - corners[1]];
    let middles = (corners[0] + corners[2]).distance(corners[1] + corners[3]) / 2.0;
    if middles > FLAT_M || (across.length() - along.length()).abs() > FLAT_M || outward(&corners) == DVec3::ZERO {
        let what = "the four corners are no rectangle, to 2 cm";
        return Err(message![what; "write them in their order around the glass, beginning at the sill"]);
    }
    let middle = |at: usize| corners[at].z + corners[(at + 1) % 4].z;
    // of two edges of one height the first that is written
    let lowest = (1..4).fold(0, |lowest, at| if middle(at) < middle(lowest) - 1e-6 { at } else { lowest });
    Ok(std::array::from_fn(|at| corners[(at + lowest) % 4]))
}
