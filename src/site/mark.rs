//! A hash of all models, by which the window notices that they changed.

use crate::mesh::Mesh;
use rustc_hash::FxBuildHasher;
use std::hash::BuildHasher;
use std::sync::{Arc, OnceLock};

/// The hash of a mesh, names included; it is computed when it is first asked for.
#[derive(Clone, Debug, Default)]
pub(super) struct ModelsMark(Arc<OnceLock<u64>>);

impl ModelsMark {
    /// The hash of the mesh that this belongs to.
    pub(super) fn of(&self, mesh: &Mesh) -> u64 {
        *self.0.get_or_init(|| hash(mesh))
    }
}

fn hash(mesh: &Mesh) -> u64 {
    let names = mesh.components.iter().map(|component| (&component.name, &component.faces));
    FxBuildHasher.hash_one((
        bytemuck::cast_slice::<_, u8>(&mesh.vertices),
        bytemuck::cast_slice::<_, u8>(&mesh.faces),
        mesh.origin.to_array().map(f64::to_bits),
        names.collect::<Vec<_>>(),
    ))
}
