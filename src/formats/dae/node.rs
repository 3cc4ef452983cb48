//! Reads nodes: their transforms, and what is below them.

use super::document::{DaeDocument, DaeNode, GeometryInstance};
use super::xml::{DaeXml, attribute, local_id};
use crate::formats::left_out::label;
use crate::message::{Message, message};
use glam::{DAffine3, DMat3, DVec3};
use quick_xml::events::BytesStart;

/// How deeply nodes may be nested.
pub(super) const MOST_DEPTH: usize = 100;

impl DaeNode {
    /// Reads the current element as a node, with everything below it. Returns its index.
    pub(super) fn read(
        xml: &mut DaeXml,
        element: &BytesStart,
        document: &mut DaeDocument,
        depth: usize,
    ) -> Result<usize, Message> {
        if depth > MOST_DEPTH {
            let what = format!("has nodes nested more than {MOST_DEPTH} deep");
            return Err(message![what; "dissolve some of its groups, and export it again"]);
        }
        let id = attribute(element, "id");
        let name = label(&attribute(element, "name").or_else(|| id.clone()).unwrap_or_default());
        let mut node = DaeNode {
            name,
            parent_from_node: DAffine3::IDENTITY,
            children: Vec::new(),
            instances: Vec::new(),
            geometries: Vec::new(),
            is_astray: false,
        };
        xml.children(|xml, name, element| match name {
            "node" => {
                node.children.push(Self::read(xml, element, document, depth + 1)?);
                Ok(())
            }
            _ => node.element(xml, name, element, document),
        })?;
        let number = document.nodes.len();
        document.nodes.push(node);
        if let Some(id) = id {
            document.node_of.insert(id, number);
        }
        Ok(number)
    }

    /// Reads a transform of the node, or something instantiated at it.
    fn element(
        &mut self,
        xml: &mut DaeXml,
        name: &str,
        element: &BytesStart,
        document: &mut DaeDocument,
    ) -> Result<(), Message> {
        match name {
            "matrix" | "translate" | "rotate" | "scale" => {
                let step = transform(name, &xml.numbers()?);
                self.parent_from_node *= step.unwrap_or(DAffine3::IDENTITY);
                self.is_astray |= step.is_none();
                Ok(())
            }
            "skew" | "lookat" => {
                self.is_astray = true;
                xml.skip()
            }
            "instance_node" => {
                match local_id(element, "url") {
                    Some(id) => self.instances.push(id),
                    None => document.left_out.add("nodes of other files", "other files are not read"),
                }
                xml.skip()
            }
            "instance_geometry" => match local_id(element, "url") {
                Some(geometry) => {
                    let materials = materials(xml)?;
                    self.geometries.push(GeometryInstance { geometry, materials });
                    Ok(())
                }
                None => {
                    document.left_out.add("geometries of other files", "other files are not read");
                    xml.skip()
                }
            },
            "instance_controller" => {
                document.left_out.add("skinned and morphed meshes", "joints and morphs of Collada are not read");
                xml.skip()
            }
            _ => xml.skip(),
        }
    }
}

/// The materials bound in the current instance.
fn materials(xml: &mut DaeXml) -> Result<Vec<(String, String)>, Message> {
    let mut materials = Vec::new();
    xml.each("bind_material", |xml, _| {
        xml.each("technique_common", |xml, _| {
            xml.each("instance_material", |xml, element| {
                materials.extend(attribute(element, "symbol").zip(local_id(element, "target")));
                xml.skip()
            })
        })
    })?;
    Ok(materials)
}

/// One step of a node's transform; `None` if it has the wrong number of values.
fn transform(kind: &str, numbers: &[f64]) -> Option<DAffine3> {
    Some(match (kind, numbers) {
        ("matrix", &[a, b, c, x, d, e, f, y, g, h, i, z, _, _, _, _]) => {
            let linear = DMat3::from_cols(DVec3::new(a, d, g), DVec3::new(b, e, h), DVec3::new(c, f, i));
            DAffine3::from_mat3_translation(linear, DVec3::new(x, y, z))
        }
        ("translate", &[x, y, z]) => DAffine3::from_translation(DVec3::new(x, y, z)),
        ("scale", &[x, y, z]) => DAffine3::from_scale(DVec3::new(x, y, z)),
        ("rotate", &[x, y, z, degrees]) => match DVec3::new(x, y, z).try_normalize() {
            Some(axis) => DAffine3::from_axis_angle(axis, degrees.to_radians()),
            None => DAffine3::IDENTITY,
        },
        _ => return None,
    })
}
