//! Finds the judged texels of a patch: those whose centres lie in one of its faces or on an edge.

use super::{Patch, Patches, Texel};
use crate::mesh::Mesh;
use crate::mesh::planes::area_vector;
use crate::mesh::scan::Coverage;
use glam::{DVec2, DVec3};
use rayon::prelude::*;

/// Sets the texels of all patches.
pub(super) fn find(mesh: &Mesh, patches: &mut Patches) {
    let (cell, faces) = (patches.cell, &patches.faces);
    let of = |patch: &Patch| {
        let faces = &faces[patch.faces.start as usize..patch.faces.end as usize];
        let bits = covered(mesh, patch, faces, cell);
        match bits.count() {
            0 => FoundTexels::Alone(alone(mesh, patch, faces, cell)),
            count => FoundTexels::Covered(bits, count),
        }
    };
    let found: Vec<FoundTexels> = patches.list.par_iter().map(of).collect();
    // bits take a thirtieth of the texels' memory, which is then filled in place
    let mut first = 0;
    for (patch, found) in patches.list.iter_mut().zip(&found) {
        patch.texels = first..first + found.count() as u32;
        patch.alone = found.point();
        first = patch.texels.end;
    }
    patches.texels = vec![Texel { column: 0, row: 0 }; first as usize];
    let mut rest = &mut patches.texels[..];
    let mut runs = Vec::with_capacity(found.len());
    for found in &found {
        let (texels, after) = rest.split_at_mut(found.count());
        rest = after;
        runs.push((found, texels));
    }
    runs.into_par_iter().for_each(|(found, texels)| found.write(texels));
}

/// The texels of a patch: covered cells and their number, or the only texel with its point.
enum FoundTexels {
    Covered(Coverage, usize),
    Alone((Texel, DVec3)),
}

impl FoundTexels {
    fn count(&self) -> usize {
        if let FoundTexels::Covered(_, count) = self { *count } else { 1 }
    }

    fn point(&self) -> Option<DVec3> {
        if let FoundTexels::Alone((_, point)) = self { Some(*point) } else { None }
    }

    /// Writes as many texels as there are, row by row.
    fn write(&self, texels: &mut [Texel]) {
        match self {
            FoundTexels::Alone((texel, _)) => texels[0] = *texel,
            FoundTexels::Covered(bits, _) => {
                for (texel, (column, row)) in texels.iter_mut().zip(bits.cells()) {
                    *texel = Texel { column: column as u16, row: row as u16 };
                }
            }
        }
    }
}

/// A point in texels, with centres at whole numbers.
pub(super) fn place(patch: &Patch, point: DVec3, cell: f64) -> DVec2 {
    let from_corner = (point - patch.corner) / cell;
    DVec2::new(from_corner.dot(patch.right), from_corner.dot(patch.down)) - 0.5
}

fn covered(mesh: &Mesh, patch: &Patch, faces: &[u32], cell: f64) -> Coverage {
    let mut bits = Coverage::empty(patch.width, patch.height);
    for &face in faces {
        bits.cover(mesh.corners(face as usize).map(|corner| place(patch, corner.as_dvec3(), cell)));
    }
    bits
}

/// The middle of the largest face, projected to the patch's plane, and the texel that contains it.
fn alone(mesh: &Mesh, patch: &Patch, faces: &[u32], cell: f64) -> (Texel, DVec3) {
    let size = |face: u32| area_vector(mesh, face).length();
    let largest = faces.iter().copied().max_by(|&one, &other| size(one).total_cmp(&size(other))).unwrap_or(faces[0]);
    let [a, b, c] = mesh.corners(largest as usize).map(|corner| corner.as_dvec3());
    let middle = (a + b + c) / 3.0;
    let point = middle - patch.normal() * patch.plane.dot(middle.extend(1.0));
    let at = (place(patch, point, cell) + 0.5).floor();
    let within = |at: f64, count: u32| at.clamp(0.0, f64::from(count - 1)) as u16;
    (Texel { column: within(at.x, patch.width), row: within(at.y, patch.height) }, point)
}
