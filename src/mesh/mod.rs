//! What stands there: welded, indexed triangles with named components and edge adjacency.

use glam::{DVec3, DVec4, Vec3};
use std::ops::Range;

/// One component as a model file gives it: triangles of one node and one material, before welding.
#[derive(Clone, Debug, Default)]
pub struct Part {
    /// `node/material`, or `node` where the node has one material.
    pub name: String,
    /// The names by which `casts` and `receives` may mean it: of its node, mesh and material.
    pub aliases: Vec<String>,
    /// Metres in the world frame.
    pub positions: Vec<DVec3>,
    /// Counter-clockwise seen from outside (mirroring transforms already undone).
    pub triangles: Vec<[u32; 3]>,
}

/// A named part of the mesh, a run of its faces. Adjacency never crosses it.
#[derive(Clone, Debug)]
pub struct Component {
    /// `node/material`, or `node` where the node has one material.
    pub name: String,
    /// The names by which `casts` and `receives` may mean it: of its node, mesh and material.
    pub aliases: Vec<String>,
    /// Its faces.
    pub faces: Range<u32>,
    /// Its edges.
    pub edges: Range<u32>,
}

/// Welded triangles with planes and adjacency, `f32` around `origin`.
#[derive(Clone, Debug)]
pub struct Mesh {
    /// World position of the local origin, whole metres.
    pub origin: DVec3,
    /// Metres around `origin`.
    pub vertices: Vec<Vec3>,
    /// Three vertices a face, counter-clockwise seen from outside; grouped by component.
    pub faces: Vec<[u32; 3]>,
    /// Per face the unit plane (n, −n·p) around `origin`; all zero where the face has no area.
    pub planes: Vec<DVec4>,
    /// The parts.
    pub components: Vec<Component>,
}

/// Why there is no mesh.
#[derive(Debug, thiserror::Error)]
pub enum MeshError {}

impl Mesh {
    /// One component a part, in their order. A stand-in: neither welds nor finds planes.
    ///
    /// # Errors
    /// None yet.
    pub fn build(parts: Vec<Part>) -> Result<Mesh, MeshError> {
        let mut mesh = Mesh {
            origin: DVec3::ZERO,
            vertices: Vec::new(),
            faces: Vec::new(),
            planes: Vec::new(),
            components: Vec::new(),
        };
        for part in parts {
            let base = mesh.vertices.len() as u32;
            let first = mesh.faces.len() as u32;
            mesh.vertices
                .extend(part.positions.iter().map(|position| position.as_vec3()));
            mesh.faces.extend(
                part.triangles
                    .iter()
                    .map(|face| face.map(|corner| corner + base)),
            );
            mesh.components.push(Component {
                name: part.name,
                aliases: part.aliases,
                faces: first..mesh.faces.len() as u32,
                edges: 0..0,
            });
        }
        Ok(mesh)
    }
}
