//! Placed nodes and their meshes → parts in the world, and which of their materials are see-through.

use super::accessor::Accessors;
use super::buffers::Buffers;
use super::coarse;
use super::document::Document;
use super::instances::Instances;
use super::pose::{Pose, Skins};
use super::primitive::{self, MaterialGroup, MeshTriangles, PrimitiveTriangles};
use super::scene::PlacedNode;
use super::{Fault, MAX_COMPONENTS, MAX_TRIANGLES, SeeThrough};
use crate::formats::PartKind;
use crate::mesh::Part;
use glam::DAffine3;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// The most numbers that may move the triangles of a model, each triangle's morph targets and joints counted: they cost
/// no memory, but time.
const MAX_MOVES: u64 = 1_000_000_000;

/// A vertex that the part does not have yet.
const ABSENT: u32 = u32::MAX;

/// What stands there.
pub(super) struct BuiltScene {
    /// One part per node and material, in the order of the scene.
    pub parts: Vec<Part>,
    /// The kind of each part, if one of them is not a building.
    pub kinds: Vec<PartKind>,
    /// The see-through materials, each name once.
    pub see_through: Vec<SeeThrough>,
}

/// What a scene costs so far, held to what it may.
#[derive(Default)]
struct SceneWork {
    triangles: u64,
    moves: u64,
}

impl SceneWork {
    fn add_triangles(&mut self, group: &MaterialGroup, instances: &Instances) -> Result<(), Fault> {
        self.triangles = self.triangles.saturating_add(group.triangles().saturating_mul(instances.count as u64));
        if self.triangles > MAX_TRIANGLES { Err(Fault::TooManyTriangles) } else { Ok(()) }
    }

    fn add_moves(&mut self, group: &MaterialGroup, poses: &[Pose], instances: &Instances) -> Result<(), Fault> {
        for (surface, pose) in group.surfaces.iter().zip(poses) {
            let each = (surface.triangles as u64).saturating_mul(pose.readers() as u64);
            self.moves = self.moves.saturating_add(each.saturating_mul(instances.count as u64));
        }
        if self.moves > MAX_MOVES { Err(Fault::TooManyMoves) } else { Ok(()) }
    }
}

/// Makes the parts of placed nodes; there may be none.
pub(super) fn build(
    document: &Document,
    buffers: &Buffers,
    placed: &[PlacedNode],
    told_step: f64,
) -> Result<BuiltScene, Fault> {
    let mut accessors = Accessors::new(document, buffers);
    // Many nodes may share a mesh; what it says is read once.
    let mut known: Vec<Option<MeshTriangles>> = document.meshes.iter().map(|_| None).collect();
    let mut skins = Skins::new(document);
    let mut builder = Builder { told_step, ..Builder::default() };
    let mut work = SceneWork::default();
    let (mut parts, mut kinds) = (Vec::new(), Vec::new());
    let mut see_through = BTreeMap::<String, Vec<usize>>::new();
    for place in placed {
        let Some(surfaces) = known.get_mut(place.mesh) else {
            continue; // `scene::place` has checked the index.
        };
        if surfaces.is_none() {
            *surfaces = Some(primitive::surfaces(document, &mut accessors, place.mesh)?);
        }
        let Some(surfaces) = surfaces else { continue };
        if surfaces.groups.is_empty() {
            continue;
        }
        let node = document.nodes.get(place.node);
        let instances = Instances::of(place.node, node, &mut accessors)?;
        let (own, node) = (node.map(|node| &node.own), document.node_name(place.node));
        for group in &surfaces.groups {
            work.add_triangles(group, &instances)?;
            let open = |surface| Pose::open(document, &mut accessors, &mut skins, place, surface);
            let poses: Vec<Pose> = group.surfaces.iter().map(open).collect::<Result<_, _>>()?;
            work.add_moves(group, &poses, &instances)?;
            let mut part = builder.part(group, &poses, &instances, place.model_from_node)?;
            if part.triangles.is_empty() {
                continue;
            }
            let material = document.material_name(group.material);
            part.name = if surfaces.one_material { node.clone() } else { format!("{node}/{material}") };
            part.aliases = match own.and_then(|own| own.aliases.clone()) {
                Some(ours) => since_written(ours, group, &material, &node),
                None => aliases(vec![node.clone()], document.mesh_name(place.mesh).into_iter().chain([&*material])),
            };
            kinds.push(own.map(|own| own.kind).unwrap_or_default());
            if group.material.is_some_and(|index| document.is_see_through(index, group.has_faded_vertices)) {
                see_through.entry(material).or_default().push(parts.len());
            }
            parts.push(part);
            if parts.len() > MAX_COMPONENTS {
                return Err(Fault::TooManyComponents);
            }
        }
    }
    let see_through = see_through.into_iter().map(|(material, parts)| SeeThrough { material, parts }).collect();
    if kinds.iter().all(|kind| *kind == PartKind::Building) {
        kinds.clear();
    }
    Ok(BuiltScene { parts, kinds, see_through })
}

/// The names that this program wrote, and the material that another program has given a part since.
fn since_written(ours: Vec<String>, group: &MaterialGroup, material: &str, node: &str) -> Vec<String> {
    aliases(ours, group.material.map(|_| material).filter(|given| *given != node))
}

/// The names by which a part may be meant, each once.
fn aliases<'a>(mut aliases: Vec<String>, further: impl IntoIterator<Item = &'a str>) -> Vec<String> {
    for alias in further {
        if !aliases.iter().any(|known| known == alias) {
            aliases.push(alias.to_owned());
        }
    }
    aliases
}

/// Makes parts; holds what is reused between them.
#[derive(Default)]
struct Builder {
    /// Per vertex of the primitive at hand its number in the part; all [`ABSENT`] between primitives.
    ///
    /// Many primitives may each use a few of many shared vertices: only those are read, and only those are forgotten.
    numbers: Vec<u32>,
    /// Vertices in the order of their numbers.
    used: Vec<u32>,
    /// Coarser steps of numbers get a note.
    told_step: f64,
}

/// Triangles that are read in one go.
const AT_ONCE: usize = 1 << 14;

impl Builder {
    /// All instances of a group; there is a pose for each of its surfaces.
    fn part(
        &mut self,
        group: &MaterialGroup,
        poses: &[Pose],
        instances: &Instances,
        model_from_node: DAffine3,
    ) -> Result<Part, Fault> {
        let mut part = Part::default();
        for instance in 0..instances.count {
            let model_from_mesh = model_from_node * instances.get(instance)?;
            for (surface, pose) in group.surfaces.iter().zip(poses) {
                self.append(&mut part, surface, pose, model_from_mesh)?;
            }
        }
        Ok(part)
    }

    /// Adds a primitive's triangles, and the vertices that they use.
    fn append(
        &mut self,
        part: &mut Part,
        surface: &PrimitiveTriangles,
        pose: &Pose,
        model_from_mesh: DAffine3,
    ) -> Result<(), Fault> {
        let mirrors = pose.model_from_mesh(&model_from_mesh).matrix3.determinant() < 0.0;
        if self.numbers.len() < surface.positions.count {
            self.numbers.resize(surface.positions.count, ABSENT);
        }
        // Fits: no part has more than three vertices a triangle.
        let first = part.positions.len() as u32;
        part.triangles.reserve(surface.triangles);
        for begin in (0..surface.triangles).step_by(AT_ONCE) {
            for [a, b, c] in surface.corners(begin..(begin + AT_ONCE).min(surface.triangles))? {
                let triangle = if mirrors { [a, c, b] } else { [a, b, c] };
                part.triangles.push(triangle.map(|vertex| self.number(vertex, first)));
            }
        }
        let stored = |vertex: u32| surface.positions.vec3(vertex as usize);
        let used = self.used.par_iter().with_min_len(AT_ONCE);
        if pose.is_plain() {
            part.positions.par_extend(used.map(|&vertex| model_from_mesh.transform_point3(stored(vertex))));
        } else {
            let point = |&vertex: &u32| pose.point(stored(vertex), vertex as usize, &model_from_mesh);
            part.positions.par_extend(used.map(point));
        }
        let points = &part.positions[first as usize..];
        let model_from_mesh = pose.model_from_mesh(&model_from_mesh);
        part.coarse.extend(coarse::corners(
            &surface.positions,
            (&self.used, first),
            model_from_mesh,
            points,
            self.told_step,
        ));
        for (vertex, point) in self.used.drain(..).zip(&part.positions[first as usize..]) {
            if !point.is_finite() {
                return Err(Fault::of_primitive(surface.mesh, surface.primitive, pose.problem(vertex as usize)));
            }
            if let Some(number) = self.numbers.get_mut(vertex as usize) {
                *number = ABSENT;
            }
        }
        Ok(())
    }

    /// A vertex's number in the part, to which the primitive's are added from `first` on.
    fn number(&mut self, vertex: u32, first: u32) -> u32 {
        let Some(number) = self.numbers.get_mut(vertex as usize) else {
            return first; // `PrimitiveTriangles::corners` has checked the vertex.
        };
        if *number == ABSENT {
            *number = first + self.used.len() as u32;
            self.used.push(vertex);
        }
        *number
    }
}
