//! Places the nodes of a scene. Trees may have any depth, so nothing here recurses.

use super::Fault;
use super::document::{Document, Node};
use crate::formats::SceneName;
use crate::formats::composed;
use crate::message::few;
use glam::{DAffine3, DMat3, DQuat, DVec3};

/// A node with a mesh, and its transform.
pub(super) struct PlacedNode {
    /// The index of the node.
    pub node: usize,
    /// The index of the mesh, which is in range.
    pub mesh: usize,
    /// The index of the skin, if it has one.
    pub skin: Option<usize>,
    /// The transform from the node's units to metres in the world.
    pub model_from_node: DAffine3,
}

/// The nodes of a scene, and those hidden in it (KHR_node_visibility).
pub(super) struct SceneContents {
    /// The visible nodes with a mesh, parents before children and siblings in file order.
    pub placed: Vec<PlacedNode>,
    /// The number of hidden nodes with a mesh.
    pub hidden: usize,
    /// The nodes that hide themselves and everything below them.
    pub hiding: Vec<usize>,
    /// The index of the scene, if the file has scenes.
    pub scene: Option<usize>,
}

/// Places the nodes of the requested scene, otherwise of the file's default one.
pub(super) fn place(document: &Document, asked: Option<&SceneName>) -> Result<SceneContents, Fault> {
    let parents = parents(document)?;
    check_cycles(&parents)?;
    let scene = number(document, asked)?;
    // each with the node above it that hides it, if there is one
    let mut open: Vec<(usize, DAffine3, Option<usize>)> = Vec::new();
    for root in roots(document, &parents, scene)?.into_iter().rev() {
        open.push((root, DAffine3::IDENTITY, None));
    }
    let mut standing = SceneContents { placed: Vec::new(), hidden: 0, hiding: Vec::new(), scene };
    // each node has at most one parent and there are no cycles, so each is visited once
    while let Some((index, model_from_parent, hiding)) = open.pop() {
        let Some(node) = document.nodes.get(index) else {
            continue; // `parents` and `roots` have checked the index.
        };
        let model_from_node = below(model_from_parent, node, index)?;
        let hiding = hiding.or((!node.is_visible()).then_some(index));
        if let Some(mesh) = node.mesh {
            if mesh >= document.meshes.len() {
                return Err(Fault::NoSuch {
                    user: format!("node {index}"),
                    what: "mesh",
                    index: mesh,
                    count: document.meshes.len(),
                });
            }
            match hiding {
                None => standing.placed.push(PlacedNode { node: index, mesh, skin: node.skin, model_from_node }),
                Some(hiding) => {
                    standing.hidden += 1;
                    // nodes below a hidden one are consecutive
                    if standing.hiding.last() != Some(&hiding) {
                        standing.hiding.push(hiding);
                    }
                }
            }
        }
        open.extend(node.children.iter().rev().map(|&child| (child, model_from_node, hiding)));
    }
    Ok(standing)
}

/// The transforms of single nodes, in the scene or not.
pub(super) struct NodeTransforms<'a> {
    document: &'a Document,
    parents: Vec<Option<usize>>,
    known: Vec<Option<DAffine3>>,
}

impl<'a> NodeTransforms<'a> {
    /// For a document whose scene [`place`] has found.
    pub(super) fn new(document: &'a Document) -> Result<Self, Fault> {
        let parents = parents(document)?;
        let known = vec![None; parents.len()];
        Ok(Self { document, parents, known })
    }

    /// The transform from a node to the world; `user` says what needs it.
    pub(super) fn get(&mut self, node: usize, user: impl Fn() -> String) -> Result<DAffine3, Fault> {
        if node >= self.parents.len() {
            return Err(no_such_node(self.document, user(), node));
        }
        // climb to the nearest known ancestor, then descend
        let (mut climbed, mut next) = (Vec::new(), Some(node));
        let mut model_from_node = DAffine3::IDENTITY;
        while let Some(index) = next {
            if let Some(known) = self.known.get(index).copied().flatten() {
                model_from_node = known;
                break;
            }
            climbed.push(index);
            next = self.parents.get(index).copied().flatten();
        }
        for index in climbed.into_iter().rev() {
            if let (Some(node), Some(known)) = (self.document.nodes.get(index), self.known.get_mut(index)) {
                model_from_node = below(model_from_node, node, index)?;
                *known = Some(model_from_node);
            }
        }
        Ok(model_from_node)
    }
}

/// The transform from a node to the world.
fn below(model_from_parent: DAffine3, node: &Node, index: usize) -> Result<DAffine3, Fault> {
    let model_from_node = model_from_parent * local(node, index)?;
    match model_from_node.is_finite() {
        true => Ok(model_from_node),
        false => Err(fault(index, "has coordinates that are too large, as its parents' transforms multiply")),
    }
}

/// For each node, its parent.
fn parents(document: &Document) -> Result<Vec<Option<usize>>, Fault> {
    let mut parents = vec![None; document.nodes.len()];
    for (index, node) in document.nodes.iter().enumerate() {
        for &child in &node.children {
            let Some(parent) = parents.get_mut(child) else {
                return Err(no_such_node(document, format!("node {index}"), child));
            };
            if let Some(other) = parent.replace(index) {
                return Err(fault(child, format!("is a child of node {other} and again of node {index}")));
            }
        }
    }
    Ok(parents)
}

/// Follows every node's ancestors once, to find cycles.
fn check_cycles(parents: &[Option<usize>]) -> Result<(), Fault> {
    let mut walk_of = vec![None; parents.len()];
    for start in 0..parents.len() {
        let mut next = Some(start);
        while let Some(index) = next {
            match walk_of.get_mut(index) {
                Some(walk @ None) => *walk = Some(start),
                Some(Some(walk)) if *walk == start => {
                    return Err(fault(index, "is its own ancestor"));
                }
                _ => break, // an earlier walk went on from here and found an end
            }
            next = parents.get(index).copied().flatten();
        }
    }
    Ok(())
}

/// The index of the requested scene, otherwise of the file's default one, otherwise of its first; `None` without
/// scenes.
fn number(document: &Document, asked: Option<&SceneName>) -> Result<Option<usize>, Fault> {
    let count = document.scenes.len();
    let Some(asked) = asked else {
        return match document.scene {
            Some(index) if index >= count => {
                Err(Fault::NoSuch { user: "the file".into(), what: "scene", index, count })
            }
            Some(index) => Ok(Some(index)),
            None => Ok((count > 0).then_some(0)),
        };
    };
    let is_it = |&index: &usize| match asked {
        SceneName::Number(number) => index as u64 == *number,
        SceneName::Name(name) => document.scene_name(index).is_some_and(|own| *own == composed(name)),
    };
    let found: Vec<usize> = (0..count).filter(is_it).collect();
    match found.as_slice() {
        [] if count == 0 => Err(Fault::Scene("has no scenes; leave `scene` out".into())),
        [] => Err(Fault::Scene(format!("has no scene {asked}; it has {}", scenes(document, 0..count)))),
        [index] => Ok(Some(*index)),
        several => {
            let several = scenes(document, several.iter().copied());
            Err(Fault::Scene(format!("has several scenes {asked}: {several}; write the number of one")))
        }
    }
}

/// The names of scenes with their indices, for a message.
pub(super) fn scenes(document: &Document, indices: impl IntoIterator<Item = usize>) -> String {
    let told = |index: usize| match document.scene_name(index) {
        Some(name) => format!("\"{name}\" ({index})"),
        None => index.to_string(),
    };
    few(indices.into_iter().map(told).collect())
}

/// The roots of a scene, or of the file if it has no scenes.
fn roots(document: &Document, parents: &[Option<usize>], scene: Option<usize>) -> Result<Vec<usize>, Fault> {
    let Some((number, scene)) = scene.and_then(|number| Some((number, document.scenes.get(number)?))) else {
        return Ok((0..parents.len()).filter(|&node| parents.get(node) == Some(&None)).collect());
    };
    let mut listed = vec![false; parents.len()];
    for &root in &scene.nodes {
        let (Some(parent), Some(listed)) = (parents.get(root), listed.get_mut(root)) else {
            return Err(no_such_node(document, format!("scene {number}"), root));
        };
        if let Some(parent) = parent {
            return Err(fault(root, format!("is a root of scene {number} and a child of node {parent}")));
        }
        if std::mem::replace(listed, true) {
            return Err(fault(root, format!("is listed twice by scene {number}")));
        }
    }
    Ok(scene.nodes.clone())
}

/// The transform from a node to its parent. A matrix takes priority over translation, rotation and scale, although glTF
/// does not allow both.
fn local(node: &Node, index: usize) -> Result<DAffine3, Fault> {
    let local = if let Some(matrix) = node.matrix.as_deref() {
        let Some(matrix) = affine(*matrix, 1e-6) else {
            return Err(fault(index, "has a matrix whose last row is not 0, 0, 0, 1"));
        };
        matrix
    } else {
        let translation = DVec3::from(node.translation.unwrap_or([0.0; 3]));
        let scale = DVec3::from(node.scale.unwrap_or([1.0; 3]));
        let rotation = DQuat::from_array(node.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]));
        let Some(rotation) = unit(rotation) else {
            return Err(fault(index, "has a rotation of length 0"));
        };
        DAffine3::from_scale_rotation_translation(scale, rotation, translation)
    };
    if !local.is_finite() {
        return Err(fault(index, "has a transform that is not finite"));
    }
    Ok(local)
}

/// A matrix in column-major order; `None` if its last row differs from 0, 0, 0, 1 by more than `slack`.
pub(super) fn affine(matrix: [f64; 16], slack: f64) -> Option<DAffine3> {
    let [a, b, c, a0, d, e, f, d0, g, h, i, g0, x, y, z, one] = matrix;
    // a matrix written in row-major order has its translation here
    if [a0, d0, g0, one - 1.0].iter().any(|value| value.abs() > slack) {
        return None;
    }
    let linear = DMat3::from_cols(DVec3::new(a, b, c), DVec3::new(d, e, f), DVec3::new(g, h, i));
    Some(DAffine3::from_mat3_translation(linear, DVec3::new(x, y, z)))
}

/// The rotation of a stored quaternion; `None` if it has no length or is not finite.
pub(super) fn unit(rotation: DQuat) -> Option<DQuat> {
    let length = rotation.length();
    (length.is_finite() && length > 0.0).then(|| rotation / length)
}

fn fault(node: usize, problem: impl Into<String>) -> Fault {
    Fault::Node { node, problem: problem.into() }
}

fn no_such_node(document: &Document, user: String, index: usize) -> Fault {
    Fault::NoSuch { user, what: "node", index, count: document.nodes.len() }
}
