//! Makes a closed volume from silhouette and caps, and bounds the number of volumes over one point.
//!
//! The volume of a mesh is the sum of the prisms behind its faces, each face turned towards the light: the **light
//! cap** is the faces themselves, the **walls** are extruded from the silhouette, and (unless the walls extend to
//! infinity) a **dark cap** closes their far ends. The count at a point is the number of faces that a ray to the light
//! crosses, for closed, open and crowded meshes alike. [`solid`] cuts volumes at the ground, for other programs.

pub mod solid;

use crate::mesh::Mesh;
use crate::silhouette::{DirectedEdge, SilhouetteFinder};
use glam::{DVec2, DVec3, DVec4};

/// One mesh's volume for one light, as indices of the mesh's vertices.
#[derive(Clone, Debug, Default)]
pub struct Volume {
    /// The edges from which walls are extruded, away from the light; an edge may be repeated.
    pub walls: Vec<DirectedEdge>,
    /// Faces, counter-clockwise seen from the light.
    pub light_cap: Vec<[u32; 3]>,
}

impl Volume {
    /// Finds the walls, and the light cap if it is needed, for a light relative to the mesh's origin.
    pub fn find(mesh: &Mesh, finder: &mut dyn SilhouetteFinder, local_light: DVec4, with_cap: bool) -> Volume {
        let mut walls = Vec::new();
        finder.find(mesh, local_light, &mut walls);
        let towards = |(&[a, b, c], facing): (&[u32; 3], bool)| if facing { [a, b, c] } else { [a, c, b] };
        let light_cap = match with_cap {
            true => mesh.faces.iter().zip(mesh.facing(local_light)).map(towards).collect(),
            false => Vec::new(),
        };
        Volume { walls, light_cap }
    }

    /// Returns the corners of a wall between its edge (`false`) and its far end (`true`), counter-clockwise seen from
    /// outside. If the far end is one point at infinity (the sun's), the second triangle has no area.
    pub fn wall([from, to]: DirectedEdge) -> [[(u32, bool); 3]; 2] {
        [[(from, false), (from, true), (to, true)], [(from, false), (to, true), (to, false)]]
    }
}

/// The cells per side of the grid of [`layers_bound`].
const BOUND_CELLS: usize = 512;

/// Returns an upper bound of the number of the mesh's faces that a ray to the sun can cross, which bounds the count of
/// its volume.
///
/// Seen from the sun, every face is counted in all cells of a coarse grid that its box touches; no ray crosses more
/// faces than its cell counts. A summed-area table makes this a few operations per face, however large it is.
pub fn layers_bound(mesh: &Mesh, to_sun: DVec3) -> u32 {
    if mesh.faces.len() < 2 {
        return mesh.faces.len() as u32;
    }
    let (across, along) = to_sun.normalize().any_orthonormal_pair();
    let seen: Vec<DVec2> =
        mesh.vertices.iter().map(|v| v.as_dvec3()).map(|v| DVec2::new(across.dot(v), along.dot(v))).collect();
    let box_of = |face: &[u32; 3]| {
        let [a, b, c] = face.map(|vertex| seen[vertex as usize]);
        (a.min(b).min(c), a.max(b).max(c))
    };
    let (low, high) = mesh
        .faces
        .iter()
        .map(box_of)
        .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), (face_low, face_high)| {
            (low.min(face_low), high.max(face_high))
        });
    // slightly more than the box, so that the last cell contains its border
    let scale = (BOUND_CELLS as f64 - 1e-3) / (high - low).max(DVec2::splat(1e-9));
    let side = BOUND_CELLS + 1;
    let mut counts = vec![0i32; side * side];
    for face in mesh.faces.iter() {
        let (face_low, face_high) = box_of(face);
        // rounding must not exclude a cell that a face touches
        let from = ((face_low - low) * scale - 1e-6).max(DVec2::ZERO).as_uvec2();
        let to = ((face_high - low) * scale + 1e-6).as_uvec2() + 1;
        let (left, top, right, bottom) = (from.x as usize, from.y as usize, to.x as usize, to.y as usize);
        counts[top * side + left] += 1;
        counts[top * side + right] -= 1;
        counts[bottom * side + left] -= 1;
        counts[bottom * side + right] += 1;
    }
    let mut above = vec![0i32; side];
    let mut most = 0;
    for row in counts.chunks_exact(side) {
        let mut in_row = 0;
        for (count, above) in row.iter().zip(&mut above) {
            in_row += count;
            *above += in_row;
            most = most.max(*above);
        }
    }
    most as u32
}
