//! Makes parts in the world from placed nodes and their meshes, and lists their see-through materials.

use super::accessor::Accessors;
use super::buffers::Buffers;
use super::coarse;
use super::document::Document;
use super::features::{self, FeatureKey, Features};
use super::instances::Instances;
use super::pose::{Pose, Skins};
use super::primitive::{self, MaterialGroup, MeshTriangles, PrimitiveTriangles};
use super::scene::PlacedNode;
use super::{Fault, MAX_COMPONENTS, MAX_TRIANGLES, SeeThrough};
use crate::formats::PartKind;
use crate::mesh::{Part, blocks};
use glam::DAffine3;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// The most values that may move the triangles of a model, counting each triangle's morph targets and joints. They take
/// no memory, but time.
const MAX_MOVES: u64 = 1_000_000_000;

/// The number of a vertex that the part does not have yet.
const ABSENT: u32 = u32::MAX;

/// The parts of a scene.
pub(super) struct BuiltScene {
    /// One part per node and material, in the order of the scene.
    pub parts: Vec<Part>,
    /// The kind of each part, if one of them is not a building.
    pub kinds: Vec<PartKind>,
    /// For each part, whether its heights are measured from the ground, if any part's are.
    pub from_ground: Vec<bool>,
    /// The see-through materials, each name once.
    pub see_through: Vec<SeeThrough>,
}

/// The work for a scene so far, to keep it within limits.
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
        for (primitive, pose) in group.primitives.iter().zip(poses) {
            let each = (primitive.triangles as u64).saturating_mul(pose.readers() as u64);
            self.moves = self.moves.saturating_add(each.saturating_mul(instances.count as u64));
        }
        if self.moves > MAX_MOVES { Err(Fault::TooManyMoves) } else { Ok(()) }
    }
}

/// Makes the parts of placed nodes; the result may be empty.
pub(super) fn build(
    document: &Document,
    buffers: &Buffers,
    features: &Features,
    placed: &[PlacedNode],
    told_step: f64,
) -> Result<BuiltScene, Fault> {
    let mut accessors = Accessors::new(document, buffers);
    // Several nodes may share a mesh, which is read once.
    let mut known: Vec<Option<MeshTriangles>> = document.meshes.iter().map(|_| None).collect();
    let mut skins = Skins::new(document);
    let mut builder = Builder { told_step, ..Builder::default() };
    let mut work = SceneWork::default();
    let mut built = SceneParts::default();
    for place in placed {
        let Some(mesh) = known.get_mut(place.mesh) else {
            continue; // `scene::place` has checked the index.
        };
        if mesh.is_none() {
            *mesh = Some(primitive::of_mesh(document, &mut accessors, features, place.mesh)?);
        }
        let Some(mesh) = mesh else { continue };
        if mesh.groups.is_empty() {
            continue;
        }
        let node = document.nodes.get(place.node);
        let instances = Instances::of(place.node, node, &mut accessors)?;
        let (own, node) = (node.map(|node| &node.own), document.node_name(place.node));
        for group in &mesh.groups {
            work.add_triangles(group, &instances)?;
            let open = |primitive| Pose::open(document, &mut accessors, &mut skins, place, primitive);
            let poses: Vec<Pose> = group.primitives.iter().map(open).collect::<Result<_, _>>()?;
            work.add_moves(group, &poses, &instances)?;
            let (part, keys) = builder.part(group, &poses, &instances, place.model_from_node)?;
            let material = document.material_name(group.material);
            let is_faded = group.material.is_some_and(|index| document.is_see_through(index, group.has_faded_vertices));
            for (feature, mut part) in features::split(part, &keys) {
                let feature = feature.map(|key| features.name(key));
                let object = feature.as_ref().unwrap_or(&node);
                part.name = if mesh.one_material { object.clone() } else { format!("{object}/{material}") };
                let names = feature.iter().chain([&node]).cloned().collect();
                part.aliases = match own.and_then(|own| own.aliases.clone()) {
                    Some(ours) => since_written(ours, group, &material, &node),
                    None => aliases(names, document.mesh_name(place.mesh).into_iter().chain([&*material])),
                };
                let (kind, is_from_ground) = own.map(|own| (own.kind, own.is_from_ground)).unwrap_or_default();
                built.from_ground.push(is_from_ground);
                built.add(part, kind, is_faded.then_some(&material))?;
            }
        }
    }
    Ok(built.finish())
}

/// The parts so far.
#[derive(Default)]
struct SceneParts {
    parts: Vec<Part>,
    kinds: Vec<PartKind>,
    from_ground: Vec<bool>,
    see_through: BTreeMap<String, Vec<usize>>,
}

impl SceneParts {
    /// Adds a part; `faded` is its material if that is see-through.
    fn add(&mut self, part: Part, kind: PartKind, faded: Option<&String>) -> Result<(), Fault> {
        if let Some(material) = faded {
            self.see_through.entry(material.clone()).or_default().push(self.parts.len());
        }
        self.parts.push(part);
        self.kinds.push(kind);
        if self.parts.len() > MAX_COMPONENTS { Err(Fault::TooManyComponents) } else { Ok(()) }
    }

    fn finish(self) -> BuiltScene {
        let see_through = self.see_through.into_iter();
        let see_through = see_through.map(|(material, parts)| SeeThrough { material, parts }).collect();
        let are_buildings = self.kinds.iter().all(|kind| *kind == PartKind::Building);
        let kinds = if are_buildings { Vec::new() } else { self.kinds };
        let is_one_from_ground = self.from_ground.contains(&true);
        let from_ground = if is_one_from_ground { self.from_ground } else { Vec::new() };
        BuiltScene { parts: self.parts, kinds, from_ground, see_through }
    }
}

/// The names that this program wrote into the file, without a material that another program has replaced since.
fn since_written(ours: Vec<String>, group: &MaterialGroup, material: &str, node: &str) -> Vec<String> {
    aliases(ours, group.material.map(|_| material).filter(|given| *given != node))
}

/// The names that select a part, each once.
fn aliases<'a>(mut aliases: Vec<String>, further: impl IntoIterator<Item = &'a str>) -> Vec<String> {
    for alias in further {
        if !aliases.iter().any(|known| known == alias) {
            aliases.push(alias.to_owned());
        }
    }
    aliases
}

/// Makes parts, with buffers that are reused.
#[derive(Default)]
struct Builder {
    /// For each vertex of the current primitive its index in the part; all [`ABSENT`] between primitives.
    ///
    /// Many primitives may each use a few of many shared vertices. Only those are read, and only those are reset.
    numbers: Vec<u32>,
    /// The vertices in the order of their new indices.
    used: Vec<u32>,
    /// Steps coarser than this get a note.
    told_step: f64,
}

/// The number of triangles that are read at once.
const AT_ONCE: usize = 1 << 14;

impl Builder {
    /// Adds all instances of a group, with the feature of each corner if features have names. There is a pose for each
    /// of its primitives.
    fn part(
        &mut self,
        group: &MaterialGroup,
        poses: &[Pose],
        instances: &Instances,
        model_from_node: DAffine3,
    ) -> Result<(Part, Vec<Option<FeatureKey>>), Fault> {
        let (mut part, mut keys) = (Part::default(), Vec::new());
        let has_features = group.primitives.iter().any(|primitive| primitive.features.is_some());
        for instance in 0..instances.count {
            let model_from_mesh = model_from_node * instances.get(instance)?;
            for (primitive, pose) in group.primitives.iter().zip(poses) {
                self.append(&mut part, primitive, pose, model_from_mesh)?;
                if has_features {
                    let key = |vertex: &u32| primitive.features?.of_vertex(*vertex as usize);
                    keys.extend(self.used.iter().map(key));
                }
                self.used.clear();
            }
        }
        Ok((part, keys))
    }

    /// Adds a primitive's triangles and the vertices that they use. `used` lists those afterwards.
    fn append(
        &mut self,
        part: &mut Part,
        primitive: &PrimitiveTriangles,
        pose: &Pose,
        model_from_mesh: DAffine3,
    ) -> Result<(), Fault> {
        let mirrors = pose.model_from_mesh(&model_from_mesh).matrix3.determinant() < 0.0;
        // cannot overflow: a part has at most three vertices per triangle
        let (first, first_triangle) = (part.positions.len() as u32, part.triangles.len());
        part.triangles.reserve(primitive.triangles);
        let pieces = (0..primitive.triangles.div_ceil(AT_ONCE))
            .into_par_iter()
            .map(|piece| primitive.corners(piece * AT_ONCE..((piece + 1) * AT_ONCE).min(primitive.triangles)));
        let pieces: Vec<Result<Vec<[u32; 3]>, Fault>> = pieces.collect();
        for piece in pieces {
            part.triangles.extend(piece?);
        }
        let triangles = &mut part.triangles[first_triangle..];
        if mirrors {
            triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        }
        self.number(triangles, primitive.positions.count, first);
        let stored = |vertex: u32| primitive.positions.vec3(vertex as usize);
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
            &primitive.positions,
            (&self.used, first),
            model_from_mesh,
            points,
            self.told_step,
        ));
        for (vertex, point) in self.used.iter().copied().zip(&part.positions[first as usize..]) {
            if !point.is_finite() {
                return Err(Fault::of_primitive(primitive.mesh, primitive.primitive, pose.problem(vertex as usize)));
            }
            if let Some(number) = self.numbers.get_mut(vertex as usize) {
                *number = ABSENT;
            }
        }
        Ok(())
    }

    /// Changes a primitive's triangles to refer to the part's vertices, which are added from `first` on in the order in
    /// which triangles use them, and lists these in `used`. `PrimitiveTriangles::corners` has checked the vertices.
    fn number(&mut self, triangles: &mut [[u32; 3]], vertices: usize, first: u32) {
        if self.numbers.len() < vertices {
            self.numbers.resize(vertices, ABSENT);
        }
        let (mut rest, mut others) = (&mut self.numbers[..vertices], triangles);
        let mut blocks = Vec::new();
        for block in blocks::blocks(others, vertices) {
            let (numbers, triangles);
            (numbers, rest) = std::mem::take(&mut rest).split_at_mut(block.vertices.len());
            (triangles, others) = std::mem::take(&mut others).split_at_mut(block.triangles.len());
            blocks.push((block.vertices.start as u32, numbers, triangles, Vec::new()));
        }
        blocks.par_iter_mut().for_each(|(before, numbers, triangles, used)| {
            for vertex in triangles.iter_mut().flatten() {
                let Some(number) = numbers.get_mut((*vertex - *before) as usize) else { continue };
                if *number == ABSENT {
                    *number = used.len() as u32;
                    used.push(*vertex);
                }
                *vertex = *number;
            }
        });
        for (_, _, _, used) in &blocks {
            self.used.extend_from_slice(used);
        }
        let mut added = first;
        let added = blocks.iter_mut().map(|(_, _, triangles, used)| {
            added += used.len() as u32;
            (triangles, added - used.len() as u32)
        });
        let added: Vec<(&mut &mut [[u32; 3]], u32)> = added.filter(|(_, added)| *added > 0).collect();
        added
            .into_par_iter()
            .for_each(|(triangles, added)| triangles.iter_mut().flatten().for_each(|vertex| *vertex += added));
    }
}
