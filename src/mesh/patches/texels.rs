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
        let texels = covered(mesh, patch, faces, cell);
        if !texels.is_empty() {
            return (texels, None);
        }
        let (texel, point) = alone(mesh, patch, faces, cell);
        (vec![texel], Some(point))
    };
    let found: Vec<_> = patches.list.par_iter().map(of).collect();
    for (patch, (texels, alone)) in patches.list.iter_mut().zip(found) {
        let first = patches.texels.len() as u32;
        patches.texels.extend(texels);
        patch.texels = first..patches.texels.len() as u32;
        patch.alone = alone;
    }
}

/// A point in texels, with centres at whole numbers.
pub(super) fn place(patch: &Patch, point: DVec3, cell: f64) -> DVec2 {
    let from_corner = (point - patch.corner) / cell;
    DVec2::new(from_corner.dot(patch.right), from_corner.dot(patch.down)) - 0.5
}

fn covered(mesh: &Mesh, patch: &Patch, faces: &[u32], cell: f64) -> Vec<Texel> {
    let mut bits = Coverage::empty(patch.width, patch.height);
    for &face in faces {
        bits.cover(mesh.corners(face as usize).map(|corner| place(patch, corner.as_dvec3(), cell)));
    }
    let mut texels = Vec::new();
    for row in 0..patch.height {
        let in_row = (0..patch.width).filter(|&column| bits.get(column, row));
        texels.extend(in_row.map(|column| Texel { column: column as u16, row: row as u16 }));
    }
    texels
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
