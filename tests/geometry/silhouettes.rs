//! Silhouettes against the sum of directions written plainly, and volumes that close.

use super::{light, modelled, soup};
use crate::exact::scenes::cuboid;
use glam::{DVec4, dvec3, dvec4};
use gnomon::mesh::Mesh;
use gnomon::silhouette::brute_force::BruteForce;
use gnomon::silhouette::{DirectedEdge, SilhouetteFinder};
use gnomon::volume::Volume;
use proptest::prelude::*;
use std::collections::{BTreeMap, HashMap, HashSet};
use std::hash::Hash;

/// Edges with how often they are run along less how often against; those that cancel are left out.
pub(crate) fn sums<V: Copy + Ord + Hash>(edges: impl IntoIterator<Item = [V; 2]>) -> BTreeMap<[V; 2], i32> {
    let mut sums: HashMap<[V; 2], i32> = HashMap::new();
    for [from, to] in edges {
        if from < to {
            *sums.entry([from, to]).or_default() += 1;
        } else {
            *sums.entry([to, from]).or_default() -= 1;
        }
    }
    sums.into_iter().filter(|(_, sum)| *sum != 0).collect()
}

fn sides<V: Copy>([a, b, c]: [V; 3]) -> [[V; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

/// Face by face, each turned towards the light.
pub(crate) fn naive(mesh: &Mesh, facing: &[bool]) -> BTreeMap<[u32; 2], i32> {
    let turned = |(&[a, b, c], &facing): (&[u32; 3], &bool)| if facing { [a, b, c] } else { [a, c, b] };
    sums(mesh.faces.iter().zip(facing).map(turned).flat_map(sides))
}

fn found(mesh: &Mesh, light: DVec4) -> Vec<DirectedEdge> {
    let mut edges = Vec::new();
    BruteForce.find(mesh, light, &mut edges);
    edges
}

/// Every vertex is left as often as it is reached.
fn balanced(edges: &[DirectedEdge]) -> bool {
    let mut balance: HashMap<u32, i32> = HashMap::new();
    for &[from, to] in edges {
        *balance.entry(from).or_default() += 1;
        *balance.entry(to).or_default() -= 1;
    }
    balance.values().all(|balance| *balance == 0)
}

/// The volume's triangles with a dark cap; `true` marks the far end.
fn triangles(volume: &Volume) -> Vec<[(u32, bool); 3]> {
    let walls = volume.walls.iter().flat_map(|&edge| Volume::wall(edge));
    let light_cap = volume.light_cap.iter().map(|face| face.map(|vertex| (vertex, false)));
    let dark_cap = volume.light_cap.iter().map(|&[a, b, c]| [a, c, b].map(|vertex| (vertex, true)));
    walls.chain(light_cap).chain(dark_cap).collect()
}

fn check(name: &str, mesh: &Mesh, light: DVec4) {
    let facing = mesh.facing(light);
    let edges = found(mesh, light);
    let sums_found = sums(edges.iter().copied());
    assert_eq!(sums_found, naive(mesh, &facing), "{name}");
    let length: i32 = sums_found.values().map(|sum| sum.abs()).sum();
    assert_eq!(edges.len(), length as usize, "{name}: nothing is found that cancels");
    assert!(balanced(&edges), "{name}");

    let volume = Volume::find(mesh, &mut BruteForce, light, true);
    let whole = triangles(&volume);
    assert!(sums(whole.iter().copied().flat_map(sides)).is_empty(), "{name}: the volume is open");
    if !edges.is_empty() {
        // and none of it holds when something is missing or turned
        assert_ne!(sums(edges[1..].iter().copied()), naive(mesh, &facing));
        assert!(!balanced(&edges[1..]));
        assert!(!sums(whole[1..].iter().copied().flat_map(sides)).is_empty());
        let mut other = facing;
        other[0] = !other[0];
        assert_ne!(sums_found, naive(mesh, &other));
    }
}

#[test]
fn a_box_shows_six_edges_twice() {
    let mesh = Mesh::build(vec![cuboid("box", dvec3(-3.0, -4.0, 0.0), dvec3(3.0, 4.0, 7.0))]).unwrap();
    for sun in [dvec4(0.3, 0.4, 0.8, 0.0), dvec4(-0.7, 0.1, 0.2, 0.0), dvec4(0.2, -0.5, -0.4, 0.0)] {
        let edges = sums(found(&mesh, sun));
        assert_eq!(edges.len(), 6);
        assert!(edges.values().all(|sum| sum.abs() == 2));
        check("box", &mesh, sun);
    }
    // straight from above: one face's border; the walls are edge-on
    let above = sums(found(&mesh, DVec4::Z));
    assert_eq!(above.values().map(|sum| sum.abs()).sum::<i32>() % 2, 0);
    check("box from above", &mesh, DVec4::Z);
}

#[test]
fn a_lamp_sees_one_two_or_three_sides_of_a_box() {
    let mesh = Mesh::build(vec![cuboid("box", dvec3(-3.0, -4.0, -2.0), dvec3(3.0, 4.0, 2.0))]).unwrap();
    // before one side, before two, before a corner; far away as the sun; inside there is no outline at all
    let lamps = [([0.5, 0.2, 2.5], 4), ([0.5, 4.5, 2.5], 6), ([3.5, 4.5, 2.5], 6), ([3e5, 4e5, 8e5], 6), ([0.5; 3], 0)];
    for (at, length) in lamps {
        let lamp = glam::DVec3::from(at).extend(1.0);
        let edges = sums(found(&mesh, lamp));
        assert_eq!(edges.len(), length, "lamp at {at:?}");
        assert!(edges.values().all(|sum| sum.abs() == 2));
        check("box", &mesh, lamp);
    }
    let far = found(&mesh, dvec4(3e5, 4e5, 8e5, 1.0));
    assert_eq!(sums(far.iter().copied()), sums(found(&mesh, dvec4(3.0, 4.0, 8.0, 0.0))));
    assert_ne!(sums(far), sums(found(&mesh, dvec4(3.5, 4.5, -2.5, 1.0))));
}

#[test]
fn a_sheet_shows_its_border_from_both_sides() {
    let corners = [dvec3(0.0, 0.0, 5.0), dvec3(4.0, 0.0, 5.0), dvec3(4.0, 3.0, 5.0), dvec3(0.0, 3.0, 5.0)];
    let mesh = Mesh::build(vec![super::part(corners.to_vec(), vec![[0, 1, 2], [0, 2, 3]])]).unwrap();
    let border: HashSet<DirectedEdge> = [[0, 1], [1, 2], [2, 3], [3, 0]].into();
    let turned: HashSet<DirectedEdge> = border.iter().map(|&[from, to]| [to, from]).collect();
    // around the mesh's origin, which is near its middle
    let lights = [
        (dvec4(0.3, 0.2, 0.9, 0.0), &border),
        (dvec4(0.3, 0.2, -0.9, 0.0), &turned),
        (dvec4(0.1, 0.1, 0.5, 1.0), &border),
        (dvec4(7.0, -9.0, -30_000.0, 1.0), &turned),
    ];
    for (light, expected) in lights {
        let edges = found(&mesh, light);
        assert_eq!(edges.len(), 4);
        assert_eq!(&edges.into_iter().collect::<HashSet<_>>(), expected, "light {light}");
        check("sheet", &mesh, light);
    }
    assert_ne!(border, turned);
}

#[test]
fn modelled_meshes_close() {
    for (name, mesh) in modelled() {
        for light in [dvec4(0.31, 0.22, 0.83, 0.0), dvec4(-0.8, 0.1, 0.05, 0.0), dvec4(3.1, -2.2, 9.4, 1.0)] {
            check(name, &mesh, light);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn any_mesh_under_any_light_closes(mesh in soup(), light in light()) {
        check("soup", &mesh, light);
    }
}
