//! What a horizontal plane hides of the models' upper side, and whether that is terrain.

use super::extent::Bounds;
use crate::mesh::scan::{by_rows, spans, wholes};
use crate::mesh::{Component, Mesh};
use glam::{DVec2, DVec3, Vec3Swizzles as _};

/// A surface no farther below the ground than this still lies on it, metres: receivers are judged this far above
/// themselves.
pub(super) const ON_GROUND_M: f64 = 0.001;

/// The number of sample points along the longer side of the models' plan.
const POINTS: f64 = 256.0;
/// The offset of the first sample point, in spacings, chosen so that none lies on an edge of a regular model.
pub(super) const FIRST: f64 = 0.381_966;
/// The least hidden share of the plan that gets a note.
const LEAST_SHARE: f64 = 0.005;
/// The least share of the models' plan that terrain covers, seen from above.
const TERRAIN_SHARE: f64 = 0.25;
/// The greatest share of terrain that may have two faces above each other (three, for a block that is partly above the
/// plane).
const OVERLAP_SHARE: f64 = 0.1;

/// The part of the models' upper side that lies below a plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct BuriedShare {
    /// The component with the largest hidden part.
    pub(super) component: usize,
    /// The hidden share of everything that is seen from above.
    pub(super) of_plan: f64,
    /// The hidden share of what is seen of that component.
    pub(super) of_component: f64,
    /// Whether its node is terrain: a sheet that is at least a quarter of what is seen.
    pub(super) is_terrain: bool,
}

/// The sample points of a node; its components, one for each of its materials, count together.
#[derive(Clone, Copy, Default)]
struct PointCounts {
    faces: usize,
    covered: usize,
    seen: usize,
    buried: usize,
}

/// The part of what is seen of all models from above that a plane at a level hides; `None` if it is negligible.
pub(super) fn buried(mesh: &Mesh, bounds: Bounds, level: f64) -> Option<BuriedShare> {
    let low = bounds.low.truncate();
    let size = bounds.high.truncate() - low;
    let apart = size.max_element() / POINTS;
    let [columns, rows] = size.to_array().map(|side| (side / apart).ceil().max(1.0) as usize);
    // the highest face at each point, and the last component that covered it
    let mut highest = vec![(f64::NEG_INFINITY, 0); columns * rows];
    let mut last = vec![usize::MAX; columns * rows];
    let node_of = nodes(&mesh.components);
    let mut of_nodes = vec![PointCounts::default(); node_of.last().map_or(0, |last| last + 1)];
    let (mut buried, mut seen) = (vec![0; mesh.components.len()], vec![0; mesh.components.len()]);
    for (index, (component, &node)) in mesh.components.iter().zip(&node_of).enumerate() {
        for face in component.faces.clone() {
            let corners = mesh.corners(face as usize).map(|corner| mesh.origin + corner.as_dvec3());
            let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
            // vertical: it is not seen from above
            if normal.z.abs() <= 1e-9 * normal.length() {
                continue;
            }
            let height = |at: DVec2| corners[0].z - normal.xy().dot(at - corners[0].xy()) / normal.z;
            let mut in_points = corners.map(|corner: DVec3| (corner.xy() - low) / apart - FIRST);
            in_points.sort_unstable_by(|one, other| by_rows(*one, *other));
            spans(in_points, 0..rows, |row, from, to| {
                for column in wholes([from, to], 0..columns) {
                    let point = row * columns + column;
                    let z = height(low + (DVec2::new(column as f64, row as f64) + FIRST) * apart);
                    of_nodes[node].faces += 1;
                    of_nodes[node].covered += usize::from(std::mem::replace(&mut last[point], node) != node);
                    if z > highest[point].0 {
                        highest[point] = (z, index);
                    }
                }
            });
        }
    }
    for (z, component) in highest.into_iter().filter(|(z, _)| z.is_finite()) {
        let is_buried = usize::from(z < level - ON_GROUND_M);
        buried[component] += is_buried;
        seen[component] += 1;
        of_nodes[node_of[component]].seen += 1;
        of_nodes[node_of[component]].buried += is_buried;
    }
    let of_all = |of: fn(&PointCounts) -> usize| of_nodes.iter().map(of).sum::<usize>();
    let (all, hidden) = (of_all(|count| count.seen).max(1), of_all(|count| count.buried));
    let (node, most) = of_nodes.iter().enumerate().max_by_key(|(_, count)| count.buried)?;
    let component = (0..buried.len()).filter(|&at| node_of[at] == node).max_by_key(|&at| buried[at])?;
    let share = |part: usize, of: usize| part as f64 / of.max(1) as f64;
    let of_plan = share(hidden, all);
    let layers = most.faces as f64 / most.covered.max(1) as f64;
    // a block of earth has an underside, as a cellar does, but that is wholly below the plane
    let is_in_part = share(most.buried, most.seen) <= 1.0 - OVERLAP_SHARE;
    let is_sheet = layers <= 1.0 + OVERLAP_SHARE || is_in_part && layers <= 2.0 + OVERLAP_SHARE;
    (of_plan >= LEAST_SHARE).then(|| BuriedShare {
        component,
        of_plan,
        of_component: share(buried[component], seen[component]),
        is_terrain: share(most.seen, all) >= TERRAIN_SHARE && is_sheet,
    })
}

/// For each component, the index of its node. Components of one node with several materials are consecutive.
fn nodes(components: &[Component]) -> Vec<usize> {
    let node = |component: &Component| component.aliases.first().filter(|node| **node != component.name).cloned();
    let mut number = 0;
    let after_the_first = components.windows(2).map(|pair| {
        let is_same = node(&pair[0]).is_some_and(|first| node(&pair[1]) == Some(first));
        number += usize::from(!is_same);
        number
    });
    components.first().map(|_| 0).into_iter().chain(after_the_first).collect()
}
