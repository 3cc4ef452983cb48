//! Which nodes stand in the default scene, and where. Trees may be as deep as the file likes: nothing here recurses.

use super::Fault;
use super::document::{Document, Node};
use glam::{DAffine3, DMat3, DQuat, DVec3};

/// A node with a mesh, and where it stands.
pub(super) struct Placed {
    /// The node's number.
    pub node: usize,
    /// The mesh's number; there is such a mesh.
    pub mesh: usize,
    /// Metres in the world from the node's own units.
    pub world_from_node: DAffine3,
}

/// The nodes with a mesh of the default scene, parents before children and siblings in the file's order.
pub(super) fn place(document: &Document, world_from_model: DAffine3) -> Result<Vec<Placed>, Fault> {
    let parents = parents(document)?;
    check_cycles(&parents)?;
    let mut open: Vec<(usize, DAffine3)> = Vec::new();
    for root in roots(document, &parents)?.into_iter().rev() {
        open.push((root, world_from_model));
    }
    let mut placed = Vec::new();
    // Each node has at most one parent and no tree bites its tail, so each is met once.
    while let Some((index, world_from_parent)) = open.pop() {
        let Some(node) = document.nodes.get(index) else {
            continue; // `parents` and `roots` have checked the index.
        };
        let world_from_node = world_from_parent * local(node, index)?;
        if !world_from_node.is_finite() {
            return Err(fault(index, "lies beyond all numbers, as its parents' transforms multiply"));
        }
        if let Some(mesh) = node.mesh {
            if mesh >= document.meshes.len() {
                return Err(Fault::NoSuch {
                    user: format!("node {index}"),
                    what: "mesh",
                    index: mesh,
                    count: document.meshes.len(),
                });
            }
            placed.push(Placed { node: index, mesh, world_from_node });
        }
        open.extend(node.children.iter().rev().map(|&child| (child, world_from_node)));
    }
    Ok(placed)
}

/// Per node its parent.
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

/// Follows every node's ancestors once.
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

/// The roots of the file's scene, of the first scene, or all there are.
fn roots(document: &Document, parents: &[Option<usize>]) -> Result<Vec<usize>, Fault> {
    let number = document.scene.unwrap_or(0);
    let Some(scene) = document.scenes.get(number) else {
        if let Some(index) = document.scene {
            return Err(Fault::NoSuch { user: "the file".into(), what: "scene", index, count: document.scenes.len() });
        }
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

/// Parent from node. A matrix goes before translation, rotation and scale, though glTF allows only one of both.
fn local(node: &Node, index: usize) -> Result<DAffine3, Fault> {
    let local = if let Some(matrix) = node.matrix.as_deref() {
        let [a, b, c, a0, d, e, f, d0, g, h, i, g0, x, y, z, one] = *matrix;
        // A matrix that was written row by row has its translation here.
        if [a0, d0, g0, one - 1.0].iter().any(|value| value.abs() > 1e-6) {
            return Err(fault(index, "has a matrix whose last row is not 0, 0, 0, 1"));
        }
        let linear = DMat3::from_cols(DVec3::new(a, b, c), DVec3::new(d, e, f), DVec3::new(g, h, i));
        DAffine3::from_mat3_translation(linear, DVec3::new(x, y, z))
    } else {
        let translation = DVec3::from(node.translation.unwrap_or([0.0; 3]));
        let scale = DVec3::from(node.scale.unwrap_or([1.0; 3]));
        let rotation = DQuat::from_array(node.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]));
        let Some(rotation) = unit(rotation) else {
            return Err(fault(index, "has a rotation of no length"));
        };
        DAffine3::from_scale_rotation_translation(scale, rotation, translation)
    };
    if !local.is_finite() {
        return Err(fault(index, "has a transform that is not finite"));
    }
    Ok(local)
}

/// The rotation that a stored quaternion means; none where it has no length or is not finite.
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
