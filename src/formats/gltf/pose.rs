//! Poses a mesh without animation: with its default morph weights (glTF 2.0, 3.7.2.2), and the joints of its skin at
//! rest (3.7.3). Positions are morphed first, then skinned.
//!
//! Most meshes have neither, and are read without a check for every vertex.

use super::Fault;
use super::accessor::Accessors;
use super::document::Document;
use super::primitive::PrimitiveTriangles;
use super::reader::Reader;
use super::scene::{NodeTransforms, PlacedNode, affine};
use glam::{DAffine3, DVec3};
use gltf::json::accessor::{ComponentType, Type};
use gltf::json::mesh::{Primitive, Semantic};
use gltf::json::validation::Checked;
use std::sync::Arc;

/// The tolerance for the last row 0, 0, 0, 1 of an inverse bind matrix: exporters invert in `f32`.
const BIND_SLACK: f64 = 1e-4;

/// What moves the vertices of a primitive besides its node.
#[derive(Default)]
pub(super) struct Pose<'a> {
    /// Displacements with their weights.
    targets: Vec<(f64, Reader<'a>)>,
    skin: Option<PrimitiveSkin<'a>>,
}

/// The joints of a skin: for each, the transform from the mesh's units to the world.
type Joints = Arc<[DAffine3]>;

/// What bends a primitive: joints, and how much each moves a vertex.
struct PrimitiveSkin<'a> {
    joints: Joints,
    /// Sets of four joints and four weights for each vertex; at least one set.
    sets: Vec<(Reader<'a>, Reader<'a>)>,
}

impl<'a> Pose<'a> {
    /// The pose of a node's primitive. Without joints it stands by its node, whatever skin that has.
    pub(super) fn open(
        document: &Document,
        accessors: &mut Accessors<'a, '_>,
        skins: &mut Skins<'a>,
        place: &PlacedNode,
        triangles: &PrimitiveTriangles<'a>,
    ) -> Result<Self, Fault> {
        let weights = document.weights(place.node, place.mesh);
        let mesh = document.meshes.get(triangles.mesh);
        let primitive = mesh.and_then(|mesh| mesh.primitives.get(triangles.primitive));
        let skin = place.skin.filter(|_| primitive.is_some_and(has_joints));
        let is_posed = skin.is_some() || weights.iter().any(|weight| *weight != 0.0);
        let Some(primitive) = primitive.filter(|_| is_posed) else {
            return Ok(Self::default());
        };
        let skin = match skin {
            Some(skin) => {
                let joints = skins.get(place.node, skin, accessors)?;
                Some(PrimitiveSkin { joints, sets: sets(accessors, triangles, primitive)? })
            }
            None => None,
        };
        Ok(Self { targets: targets(accessors, triangles, primitive, weights)?, skin })
    }

    /// Whether the vertices stay as they are stored.
    pub(super) fn is_plain(&self) -> bool {
        self.targets.is_empty() && self.skin.is_none()
    }

    /// The transform that scales and turns the mesh: its node's, or with a skin that of the first joint, which
    /// represents all.
    pub(super) fn model_from_mesh<'b>(&'b self, model_from_node: &'b DAffine3) -> &'b DAffine3 {
        self.skin.as_ref().and_then(|skin| skin.joints.first()).unwrap_or(model_from_node)
    }

    /// The number of accessors that are read for each vertex.
    pub(super) fn readers(&self) -> usize {
        self.targets.len() + self.skin.as_ref().map_or(0, |skin| 2 * skin.sets.len())
    }

    /// The position of a vertex stored at `stored`. Not finite if it refers to a joint that the skin does not have.
    pub(super) fn point(&self, stored: DVec3, vertex: usize, model_from_mesh: &DAffine3) -> DVec3 {
        let moved = |at: DVec3, (weight, target): &(f64, Reader)| at + *weight * target.vec3(vertex);
        let morphed = self.targets.iter().fold(stored, moved);
        match &self.skin {
            Some(skin) => skin.point(morphed, vertex),
            None => model_from_mesh.transform_point3(morphed),
        }
    }

    /// Why a vertex has no valid position, as the predicate of a sentence.
    pub(super) fn problem(&self, vertex: usize) -> String {
        let unknown = self.skin.as_ref().and_then(|skin| Some((skin.unknown_joint(vertex)?, skin.joints.len())));
        match unknown {
            Some((joint, count)) => format!("has the joint {joint} at vertex {vertex}, but its skin has only {count}"),
            None => format!("has a position that is not finite at vertex {vertex}"),
        }
    }
}

impl PrimitiveSkin<'_> {
    /// The position of a vertex as the weighted mean of its joints. Weights are divided by their sum, which is 1 except
    /// for rounding. A vertex without weights follows its first joint, as in viewers.
    fn point(&self, at: DVec3, vertex: usize) -> DVec3 {
        let by = |joint: usize| self.joints.get(joint).map_or(DVec3::NAN, |joint| joint.transform_point3(at));
        let (mut point, mut sum) = (DVec3::ZERO, 0.0);
        for (joint, weight) in self.influences(vertex).filter(|(_, weight)| *weight != 0.0) {
            point += weight * by(joint);
            sum += weight;
        }
        if sum == 0.0 { self.influences(vertex).next().map_or(DVec3::NAN, |(joint, _)| by(joint)) } else { point / sum }
    }

    /// The joints of a vertex with their weights.
    fn influences(&self, vertex: usize) -> impl Iterator<Item = (usize, f64)> {
        self.sets.iter().flat_map(move |(joints, weights)| {
            let (joints, weights): ([f64; 4], [f64; 4]) = (joints.numbers(vertex), weights.numbers(vertex));
            joints.map(|joint| joint as usize).into_iter().zip(weights)
        })
    }

    /// A joint of the vertex that the skin does not have.
    fn unknown_joint(&self, vertex: usize) -> Option<usize> {
        self.influences(vertex).map(|(joint, _)| joint).find(|joint| *joint >= self.joints.len())
    }
}

/// The morph targets with a weight other than 0 that have positions.
fn targets<'a>(
    accessors: &mut Accessors<'a, '_>,
    triangles: &PrimitiveTriangles,
    primitive: &Primitive,
    weights: &[f32],
) -> Result<Vec<(f64, Reader<'a>)>, Fault> {
    let mut targets = Vec::new();
    for (target, &weight) in primitive.targets.iter().flatten().zip(weights).filter(|(_, weight)| **weight != 0.0) {
        let Some(positions) = target.positions else { continue };
        let what = || format!("a morph target of primitive {} of mesh {}", triangles.primitive, triangles.mesh);
        let reader = accessors.get(positions.value(), what)?;
        if reader.shape != Type::Vec3 || reader.component == ComponentType::U32 {
            return Err(Fault::of_primitive(
                triangles.mesh,
                triangles.primitive,
                "has a morph target of a type that glTF does not allow",
            ));
        }
        check_count("a morph target", &reader, triangles)?;
        targets.push((weight.into(), reader));
    }
    Ok(targets)
}

/// Whether its vertices have joints.
fn has_joints(primitive: &Primitive) -> bool {
    primitive.attributes.keys().any(|semantic| matches!(semantic, Checked::Valid(Semantic::Joints(_))))
}

/// All sets of joints and weights of a primitive.
fn sets<'a>(
    accessors: &mut Accessors<'a, '_>,
    triangles: &PrimitiveTriangles,
    primitive: &Primitive,
) -> Result<Vec<(Reader<'a>, Reader<'a>)>, Fault> {
    let fault = |problem: String| Fault::of_primitive(triangles.mesh, triangles.primitive, problem);
    let user = || format!("primitive {} of mesh {}", triangles.primitive, triangles.mesh);
    let mut sets = Vec::new();
    for (semantic, joints) in &primitive.attributes {
        let Checked::Valid(Semantic::Joints(number)) = semantic else { continue };
        let Some(weights) = primitive.attributes.get(&Checked::Valid(Semantic::Weights(*number))) else {
            return Err(fault(format!("has JOINTS_{number} and no WEIGHTS_{number}")));
        };
        let (joints, weights) = (accessors.get(joints.value(), user)?, accessors.get(weights.value(), user)?);
        use ComponentType::{F32, U8, U16};
        let fit = matches!(joints.component, U8 | U16) && matches!(weights.component, F32 | U8 | U16);
        if !fit || joints.normalized || [joints.shape, weights.shape] != [Type::Vec4; 2] {
            return Err(fault("has joints or weights of a type that glTF does not allow".into()));
        }
        check_count("joints", &joints, triangles)?;
        check_count("weights", &weights, triangles)?;
        sets.push((joints, weights));
    }
    Ok(sets)
}

fn check_count(what: &str, reader: &Reader, triangles: &PrimitiveTriangles) -> Result<(), Fault> {
    let (has, needs) = (reader.count, triangles.positions.count);
    if has == needs {
        return Ok(());
    }
    Err(Fault::of_primitive(
        triangles.mesh,
        triangles.primitive,
        format!("has {what} for {has} vertices, but has {needs} vertices"),
    ))
}

/// The skins of a file. Each is read when it is first used.
pub(super) struct Skins<'a> {
    document: &'a Document,
    worlds: Option<NodeTransforms<'a>>,
    known: Vec<Option<Joints>>,
}

impl<'a> Skins<'a> {
    pub(super) fn new(document: &'a Document) -> Self {
        let known = document.skins.iter().map(|_| None).collect();
        Self { document, worlds: None, known }
    }

    /// A skin by its index. The transform of the node that uses it is ignored (3.7.3.3).
    fn get(&mut self, node: usize, index: usize, accessors: &mut Accessors<'a, '_>) -> Result<Joints, Fault> {
        let count = self.known.len();
        let (Some(known), Some(skin)) = (self.known.get_mut(index), self.document.skins.get(index)) else {
            return Err(Fault::NoSuch { user: format!("node {node}"), what: "skin", index, count });
        };
        if self.document.nodes.get(node).is_some_and(|node| node.extensions.instancing.is_some()) {
            let problem = "has a skin and instances, and glTF does not define where those stand".into();
            return Err(Fault::Node { node, problem });
        }
        if let Some(joints) = known {
            return Ok(Arc::clone(joints));
        }
        let fault = |problem: String| Fault::Skin { skin: index, problem };
        let bind = match skin.inverse_bind_matrices {
            Some(matrices) => Some(accessors.get(matrices, || format!("skin {index}"))?),
            None => None,
        };
        if skin.joints.is_empty() {
            return Err(fault("has no joints".into()));
        }
        if let Some(bind) = bind {
            if bind.shape != Type::Mat4 || bind.component != ComponentType::F32 {
                return Err(fault("has inverse bind matrices of a type that glTF does not allow".into()));
            }
            if bind.count < skin.joints.len() {
                let problem = format!("has {} joints, but inverse bind matrices for {}", skin.joints.len(), bind.count);
                return Err(fault(problem));
            }
        }
        let worlds = match &mut self.worlds {
            Some(worlds) => worlds,
            None => self.worlds.insert(NodeTransforms::new(self.document)?),
        };
        let mut joints = Vec::with_capacity(skin.joints.len());
        for (number, &joint) in skin.joints.iter().enumerate() {
            let model_from_joint = worlds.get(joint, || format!("skin {index}"))?;
            let joint_from_mesh = match bind {
                Some(bind) => affine(bind.numbers(number), BIND_SLACK),
                None => Some(DAffine3::IDENTITY),
            };
            let model_from_mesh = joint_from_mesh.map(|joint_from_mesh| model_from_joint * joint_from_mesh);
            let Some(model_from_mesh) = model_from_mesh.filter(DAffine3::is_finite) else {
                return Err(fault(format!(
                    "has an inverse bind matrix at joint {number} that is not a valid transform"
                )));
            };
            joints.push(model_from_mesh);
        }
        Ok(Arc::clone(known.insert(joints.into())))
    }
}
