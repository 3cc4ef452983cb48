//! Lays points on components: one in the middle of each piece, or a row along walls.

use crate::mesh::patches::{MOST_TEXELS, Patch, Patches};
use crate::mesh::{Component, Mesh, lowest};
use crate::view::Probe;
use glam::{DVec3, Vec3};
use rustc_hash::FxHashSet;

/// How points are laid on components.
#[derive(Clone, Copy, Debug)]
pub(super) enum PointLayout {
    /// One in the middle of each piece.
    Pieces,
    /// On upright faces, at this spacing and this height, metres in the world frame.
    Row { spacing: f64, height: f64 },
}

/// Returns the points on the chosen components, at most a few more than `most`. Each comes with the normal of what may
/// be its outer side, and none has the name of a point in `beside`.
pub(super) fn lay(
    mesh: &Mesh,
    chosen: &[bool],
    layout: PointLayout,
    (most, beside): (usize, &[Probe]),
) -> Vec<Vec<Probe>> {
    let mut laid: Vec<Vec<Probe>> = Vec::new();
    let named = mesh.components.iter().zip(chosen).filter(|(_, chosen)| **chosen).map(|(component, _)| component);
    match layout {
        PointLayout::Pieces => {
            for component in named {
                let sides = pieces(mesh, component).into_iter().filter_map(|faces| sides_of(mesh, &faces));
                laid.extend(named_after(component, sides.take(most + 1).collect()));
                if laid.len() > most {
                    break;
                }
            }
        }
        PointLayout::Row { spacing, height } => {
            let patches = Patches::of(mesh, chosen, spacing.max(0.25), MOST_TEXELS);
            for (index, component) in mesh.components.iter().enumerate() {
                let mut rows = Vec::new();
                for patch in &patches.list[patches.of_component(index as u32)] {
                    rows.extend(row(mesh, &patches, patch, [spacing, height], most));
                    if laid.len() + rows.len() > most {
                        break;
                    }
                }
                laid.extend(named_after(component, rows));
            }
        }
    }
    tell_apart(&mut laid, beside);
    laid
}

/// Makes points of sides, named after the component, and numbered if there are several.
fn named_after(component: &Component, points: Vec<Vec<[DVec3; 2]>>) -> Vec<Vec<Probe>> {
    let count = points.len();
    let of_point = |(index, sides): (usize, Vec<[DVec3; 2]>)| {
        let name = if count == 1 { component.name.clone() } else { format!("{} {}", component.name, index + 1) };
        sides.into_iter().map(|[point, normal]| Probe { name: name.clone(), point, normal: Some(normal) }).collect()
    };
    points.into_iter().enumerate().map(of_point).collect()
}

/// Numbers points that have the same name as others or as those in `beside`.
fn tell_apart(laid: &mut [Vec<Probe>], beside: &[Probe]) {
    let mut taken: FxHashSet<String> = beside.iter().map(|probe| probe.name.clone()).collect();
    for sides in laid {
        let Some(first) = sides.first() else { continue };
        let plain = first.name.clone();
        let mut name = plain.clone();
        let mut number = 2;
        while !taken.insert(name.clone()) {
            name = format!("{plain} ({number})");
            number += 1;
        }
        sides.iter_mut().for_each(|side| side.name.clone_from(&name));
    }
}

/// The pieces of a component: faces that are connected by edges.
pub(super) fn pieces(mesh: &Mesh, component: &Component) -> Vec<Vec<u32>> {
    let first = component.faces.start;
    let mut above: Vec<u32> = (0..component.faces.len() as u32).collect();
    for edge in component.edges.clone() {
        for pair in mesh.faces_at(edge as usize).windows(2) {
            let [one, other] = [pair[0], pair[1]].map(|incidence| lowest(&mut above, incidence.face() - first));
            above[one.max(other) as usize] = one.min(other);
        }
    }
    let mut of_root = vec![Vec::new(); above.len()];
    for face in 0..above.len() as u32 {
        of_root[lowest(&mut above, face) as usize].push(face + first);
    }
    of_root.retain(|piece| !piece.is_empty());
    of_root
}

/// The middle of a piece's front and of its back, each with its normal; `None` for a piece without area.
fn sides_of(mesh: &Mesh, faces: &[u32]) -> Option<Vec<[DVec3; 2]>> {
    let corners = |face: &u32| mesh.corners(*face as usize).map(Vec3::as_dvec3);
    let vector = |face: &u32| {
        let [a, b, c] = corners(face);
        (b - a).cross(c - a)
    };
    let normal =
        faces.iter().map(vector).max_by(|one, other| one.length().total_cmp(&other.length()))?.try_normalize()?;
    let (across, along) = normal.any_orthonormal_pair();
    let middle_of = |axis: DVec3| {
        let on = || faces.iter().flat_map(corners).map(|corner| corner.dot(axis));
        [on().fold(f64::INFINITY, f64::min), on().fold(f64::NEG_INFINITY, f64::max)]
    };
    let middle = |[low, high]: [f64; 2]| (low + high) / 2.0;
    let centre = mesh.origin + across * middle(middle_of(across)) + along * middle(middle_of(along));
    let [back, front] = middle_of(normal);
    Some(vec![[centre + normal * front, normal], [centre + normal * back, -normal]])
}

/// Points along an upright patch at a height above the ground.
pub(super) fn row(
    mesh: &Mesh,
    patches: &Patches,
    patch: &Patch,
    [spacing, height]: [f64; 2],
    most: usize,
) -> Vec<Vec<[DVec3; 2]>> {
    /// A patch is upright if it leans by less than 6°: this is the sine.
    const UPRIGHT: f64 = 0.1;
    let normal = patch.plane.truncate();
    if normal.z.abs() > UPRIGHT {
        return Vec::new();
    }
    let level = height - mesh.origin.z;
    // the intervals along the patch in which it has faces at that height
    let mut runs: Vec<[f64; 2]> = Vec::new();
    for face in &patches.faces[patch.faces.start as usize..patch.faces.end as usize] {
        let corners = mesh.corners(*face as usize).map(Vec3::as_dvec3);
        let mut run = [f64::INFINITY, f64::NEG_INFINITY];
        for side in 0..3 {
            let [from, to] = [corners[side], corners[(side + 1) % 3]];
            if (from.z < level) != (to.z < level) {
                let on = from.lerp(to, (level - from.z) / (to.z - from.z)).dot(patch.right);
                run = [run[0].min(on), run[1].max(on)];
            }
        }
        runs.extend((run[0] < run[1]).then_some(run));
    }
    runs.sort_unstable_by(|one, other| one[0].total_cmp(&other[0]));
    let mut joined: Vec<[f64; 2]> = Vec::new();
    for [from, to] in runs {
        match joined.last_mut() {
            Some(last) if from <= last[1] + 1e-3 => last[1] = last[1].max(to),
            _ => joined.push([from, to]),
        }
    }
    // the patch's point at that height whose position along the patch is 0
    let across = patch.right.cross(normal);
    let foot = -normal * patch.plane.w;
    let foot = foot + across * ((level - foot.z) / across.z) - patch.right * foot.dot(patch.right);
    let mut points = Vec::new();
    for [from, to] in joined {
        let count = (((to - from) / spacing + 1e-6) as usize).clamp(1, most + 1);
        let first = (from + to) / 2.0 - spacing * (count - 1) as f64 / 2.0;
        for index in 0..count {
            let point = mesh.origin + foot + patch.right * (first + spacing * index as f64);
            let mut sides = vec![[point, normal]];
            sides.extend(patch.two_sided.then_some([point, -normal]));
            points.push(sides);
        }
        if points.len() > most {
            break;
        }
    }
    points
}
