//! EXT_mesh_gpu_instancing: many copies of one node's mesh.

use super::Fault;
use super::accessor::Accessors;
use super::document::{Instancing, Node};
use super::reader::Reader;
use super::scene::unit;
use glam::{DAffine3, DQuat, DVec3};
use gltf::json::accessor::{ComponentType, Type};

/// The copies of a node's mesh; without the extension, a single one.
pub(super) struct Instances<'a> {
    /// The number of instances.
    pub count: usize,
    node: usize,
    translation: Option<Reader<'a>>,
    rotation: Option<Reader<'a>>,
    scale: Option<Reader<'a>>,
}

impl<'a> Instances<'a> {
    /// The copies of a node's mesh: those of the extension, otherwise one.
    pub(super) fn of(number: usize, node: Option<&Node>, accessors: &mut Accessors<'a, '_>) -> Result<Self, Fault> {
        match node.and_then(|node| node.extensions.instancing.as_ref()) {
            Some(asked) => Self::open(number, asked, accessors),
            None => Ok(Self::one(number)),
        }
    }

    /// A single copy.
    fn one(node: usize) -> Self {
        Self { count: 1, node, translation: None, rotation: None, scale: None }
    }

    /// The copies of the extension.
    fn open(node: usize, asked: &Instancing, accessors: &mut Accessors<'a, '_>) -> Result<Self, Fault> {
        let mut instances = Self { count: 0, ..Self::one(node) };
        let mut first = None;
        for (name, &index) in &asked.attributes {
            let reader = accessors.get(index, || format!("instancing of node {node}"))?;
            if *first.get_or_insert(reader.count) != reader.count {
                return Err(Fault::of_accessor(
                    index,
                    format!("has {} instances, but other attributes have a different number", reader.count),
                ));
            }
            let is_f32 = reader.component == ComponentType::F32;
            let is_small = matches!(reader.component, ComponentType::I8 | ComponentType::I16);
            let (slot, fits) = match name.as_str() {
                "TRANSLATION" => (&mut instances.translation, is_f32 && reader.shape == Type::Vec3),
                "SCALE" => (&mut instances.scale, is_f32 && reader.shape == Type::Vec3),
                "ROTATION" => {
                    let fits = is_f32 || is_small && reader.normalized;
                    (&mut instances.rotation, fits && reader.shape == Type::Vec4)
                }
                _ => continue, // colours, numbers and the like
            };
            if !fits {
                return Err(Fault::of_accessor(index, format!("has a type that instances do not allow for {name}")));
            }
            *slot = Some(reader);
        }
        let Some(count) = first else {
            return Err(Fault::Node { node, problem: "has instances without attributes".into() });
        };
        Ok(Self { count, ..instances })
    }

    /// The transform from an instance to its node.
    pub(super) fn get(&self, index: usize) -> Result<DAffine3, Fault> {
        let translation = self.translation.map_or(DVec3::ZERO, |reader| reader.vec3(index));
        let scale = self.scale.map_or(DVec3::ONE, |reader| reader.vec3(index));
        let stored = self.rotation.map_or(DQuat::IDENTITY, |reader| DQuat::from_array(reader.numbers(index)));
        match unit(stored) {
            Some(rotation) if translation.is_finite() && scale.is_finite() => {
                Ok(DAffine3::from_scale_rotation_translation(scale, rotation, translation))
            }
            _ => Err(Fault::Node {
                node: self.node,
                problem: format!("has a transform that is not finite, or a rotation of length 0, at instance {index}"),
            }),
        }
    }
}
