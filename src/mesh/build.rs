//! Builds a mesh from parts, welded, around one origin; and a mesh of some components of another mesh.

use super::together::CornerGroups;
use super::weld::{self, WeldedPart};
use super::{Component, CornerPrecision, Mesh, MeshError, Part, adjacency};
use glam::{DVec3, DVec4, Vec3};
use rayon::prelude::*;
use std::sync::{Arc, OnceLock};

/// The least number of corners for one task: models may have hundreds of thousands of parts with a dozen corners each.
const AT_ONCE: usize = 1 << 12;
/// The least number of parts for one task.
const PARTS_AT_ONCE: usize = 1 << 6;

impl Part {
    /// Refuses corners that are not finite, and triangles with indices out of range.
    fn check(&self) -> Result<(), MeshError> {
        if !self.positions.par_iter().with_min_len(AT_ONCE).all(|corner| corner.is_finite()) {
            return Err(MeshError::NoPoint(self.name.clone()));
        }
        let corners = self.positions.len();
        let triangles = self.triangles.par_iter().with_min_len(AT_ONCE);
        let missing = triangles.flatten_iter().find_any(|corner| **corner as usize >= corners);
        missing.map_or(Ok(()), |&corner| Err(MeshError::NoCorner { name: self.name.clone(), corner, corners }))
    }
}

impl Mesh {
    /// Welds each part separately, and computes planes and adjacency. The origin is the middle of what stands together.
    ///
    /// # Errors
    /// [`MeshError`]
    pub fn build(parts: Vec<Part>) -> Result<Mesh, MeshError> {
        Self::built(parts, None)
    }

    /// As [`Mesh::build`], around a given origin, such as another mesh's. Positions have the precision of `f32` at
    /// their distance from it: 0.06 mm at 1 km. An origin in whole metres adds no error of its own.
    ///
    /// # Errors
    /// [`MeshError`]; [`MeshError::FarFromOrigin`] beyond [`Mesh::FARTHEST_M`].
    pub fn build_around(parts: Vec<Part>, origin: DVec3) -> Result<Mesh, MeshError> {
        Self::built(parts, Some(origin))
    }

    fn built(parts: Vec<Part>, given: Option<DVec3>) -> Result<Mesh, MeshError> {
        let triangles: usize = parts.iter().map(|part| part.triangles.len()).sum();
        let corners: usize = parts.iter().map(|part| part.positions.len()).sum();
        if triangles.max(corners / 3) > Self::MOST_FACES {
            return Err(MeshError::TooLarge(triangles));
        }
        let checked = parts.par_iter().with_min_len(PARTS_AT_ONCE).map(Part::check);
        checked.find_first(Result::is_err).unwrap_or(Ok(()))?;
        let together = CornerGroups::of(&parts);
        let home = together.home().unwrap_or_default();
        let origin = given.unwrap_or(((home.0 + home.1) / 2.0).round());
        let reach = |part: &Part| {
            let reach = |&corner: &DVec3| (corner - origin).abs().max_element();
            let reach = part.positions.par_iter().with_min_len(AT_ONCE).map(reach).reduce(|| 0.0, f64::max);
            if origin.is_finite() { reach } else { f64::INFINITY }
        };
        let reaches: Vec<f64> = parts.par_iter().with_min_len(PARTS_AT_ONCE).map(reach).collect();
        if let Some((part, &reach)) = reaches.iter().enumerate().max_by(|one, other| one.1.total_cmp(other.1))
            && reach > Self::FARTHEST_M
        {
            let name = &parts[part].name;
            let (name, km) = (name.clone(), reach / 1000.0);
            return Err(match given {
                Some(_) => MeshError::FarFromOrigin { name, km },
                None => MeshError::TooWide { part, name, km },
            });
        }

        let weld = |part: Part| of_part(part, origin, &together);
        let welded: Vec<(Component, WeldedPart)> = parts.into_par_iter().map(weld).collect();
        let (mut vertices, mut faces) = (Vec::new(), Vec::new());
        let mut components = Vec::with_capacity(welded.len());
        let corners: usize = welded.iter().map(|(_, welded)| welded.vertices.len()).sum();
        for (component, welded) in welded {
            let (vertex, face) = (vertices.len() as u32, faces.len() as u32);
            if components.is_empty() {
                // often there is only one part
                (vertices, faces) = (welded.vertices, welded.faces);
                vertices.reserve_exact(corners - vertices.len());
                faces.reserve_exact(triangles - faces.len());
            } else {
                vertices.extend(welded.vertices);
                faces.extend(welded.faces.iter().map(|face| face.map(|corner| vertex + corner)));
            }
            components.push(Component {
                faces: face..faces.len() as u32,
                collapsed: welded.collapsed.iter().map(|line| line.map(|end| vertex + end)).collect(),
                ..component
            });
        }
        let home = [home.0, home.1].map(|corner| (corner - origin).as_vec3());
        Ok(Mesh::of((origin, home), vertices.into(), faces, components, OnceLock::new()))
    }

    fn of(
        (origin, home): (DVec3, [Vec3; 2]),
        vertices: Arc<Vec<Vec3>>,
        faces: Vec<[u32; 3]>,
        components: Vec<Component>,
        planes: OnceLock<Vec<DVec4>>,
    ) -> Mesh {
        let mut mesh = Mesh {
            origin,
            vertices,
            faces: faces.into(),
            planes: planes.into(),
            home,
            components,
            edges: Arc::default(),
            edge_first: Arc::default(),
            incidences: Arc::default(),
            blocks: Arc::default(),
        };
        adjacency::find(&mut mesh);
        mesh
    }

    /// Returns the mesh of some components. Planes stay those of the whole mesh.
    pub fn of_components(&self, keep: &[bool]) -> Mesh {
        let kept = self.components.iter().zip(keep).filter(|(_, keep)| **keep).map(|(component, _)| component.clone());
        self.taken(kept.collect(), |_| true)
    }

    /// Returns the mesh of some faces. Planes stay those of the whole mesh; components without faces are left out.
    pub fn of_faces(&self, keep: impl Fn(u32) -> bool) -> Mesh {
        let mut mesh = self.taken(self.components.clone(), keep);
        mesh.components.retain(|component| !component.faces.is_empty());
        mesh
    }

    fn taken(&self, mut components: Vec<Component>, keep: impl Fn(u32) -> bool) -> Mesh {
        let mut kept = Vec::new();
        for component in &mut components {
            let first = kept.len() as u32;
            kept.extend(component.faces.clone().filter(|&face| keep(face)));
            component.faces = first..kept.len() as u32;
        }
        if kept.len() == self.faces.len() {
            return Mesh { components, ..self.clone() };
        }
        let of_kept = |planes: &[DVec4]| kept.iter().map(|&face| planes[face as usize]).collect();
        let planes = if kept.is_empty() { Vec::new() } else { of_kept(self.planes()) };
        let faces = kept.iter().map(|&face| self.faces[face as usize]).collect();
        Mesh::of((self.origin, self.home), Arc::clone(&self.vertices), faces, components, planes.into())
    }
}

/// A welded part, and its future component.
fn of_part(part: Part, origin: DVec3, together: &CornerGroups) -> (Component, WeldedPart) {
    let welded = weld::weld(&part, origin, together);
    let Part { name, aliases, positions, coarse, .. } = part;
    let is_at_home = |run: &CornerPrecision| {
        let corners = &positions[run.corners.start as usize..run.corners.end as usize];
        corners.iter().any(|&corner| together.is_home(corner))
    };
    let at_home = coarse.into_iter().filter(is_at_home);
    let coarse = at_home.max_by(|one, other| one.step_m.total_cmp(&other.step_m));
    let flattened = welded.flattened;
    let component = Component {
        name,
        aliases,
        faces: 0..0,
        edges: 0..0,
        collapsed: [].into(),
        flattened,
        coarse,
        is_terrain: false,
    };
    (component, welded)
}
