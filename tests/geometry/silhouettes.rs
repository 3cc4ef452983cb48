//! Silhouettes against a simple sum of directions, and volumes that close.

use super::{light, modelled, soup};
use crate::shared::scenes::cuboid;
use glam::{DVec4, dvec3, dvec4};
use gnomon::mesh::Mesh;
use gnomon::silhouette::brute_force::BruteForce;
use gnomon::silhouette::{DirectedEdge, ProcessorFinder, SilhouetteFinder, hextree};
use gnomon::volume::Volume;
use proptest::prelude::*;
use std::collections::{BTreeMap, HashMap, HashSet};
use std::hash::Hash;

/// Edges with their directed count, forwards minus backwards; those that cancel are left out.
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

/// Every other finder that works on the processor.
const KINDS: [ProcessorFinder; 5] = [
    ProcessorFinder::Hierarchy,
    ProcessorFinder::Hextree { depth: 0 },
    ProcessorFinder::Hextree { depth: 1 },
    ProcessorFinder::Hextree { depth: hextree::PAPER_DEPTH },
    ProcessorFinder::Hextree { depth: hextree::DEEPEST },
];

/// Whether two silhouettes have the same edges with the same directions and multiplicities.
fn equal(one: &[DirectedEdge], other: &[DirectedEdge]) -> bool {
    let sorted = |edges: &[DirectedEdge]| {
        let mut edges = edges.to_vec();
        edges.sort_unstable();
        edges
    };
    sorted(one) == sorted(other)
}

/// Whether an edge of multiplicity ±n is listed n times in a row.
fn in_rows(edges: &[DirectedEdge]) -> bool {
    let distinct: HashSet<_> = edges.iter().collect();
    edges.chunk_by(|a, b| a == b).count() == distinct.len()
}

/// Compares all finders with brute force, each for several lights in turn.
fn agree(name: &str, mesh: &Mesh, lights: &[DVec4]) {
    for kind in KINDS {
        let mut finder = kind.build(mesh);
        for &light in lights {
            let mut edges = Vec::new();
            let looked = finder.find(mesh, light, &mut edges);
            let truth = found(mesh, light);
            assert!(equal(&edges, &truth), "{name}: {kind:?} under {light}: {} not {}", edges.len(), truth.len());
            assert!(in_rows(&edges), "{name}: {kind:?} under {light}");
            assert!(looked.found <= looked.at && (looked.found == 0) == edges.is_empty(), "{name}: {looked:?}");
        }
    }
}

/// As many directed edges begin at each vertex as end there.
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

/// Suns and lamps all around a mesh of some size, some of them edge-on to upright walls and level roofs.
fn all_around(mesh: &Mesh) -> Vec<DVec4> {
    let (low, high) = mesh.bounds().unwrap();
    let size = (high - low).length();
    let mut lights: Vec<DVec4> =
        [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [0.6, 0.0, 0.8], [-0.7, 0.1, 0.02]]
            .map(|to_sun| glam::DVec3::from(to_sun).normalize().extend(0.0))
            .to_vec();
    for step in 0..6 {
        let turn = f64::from(step) * 1.1;
        let to_sun = dvec3(turn.sin(), turn.cos(), 0.1 + 0.3 * f64::from(step % 3));
        lights.push(to_sun.normalize().extend(0.0));
        lights.push((to_sun * size * (0.2 + 0.3 * f64::from(step))).extend(1.0));
    }
    lights
}

#[test]
fn all_finders_agree_on_the_sites_and_a_dome() {
    for name in ["tower", "industry", "headquarters"] {
        let folder = std::path::PathBuf::from(format!("sites/{name}"));
        let site = gnomon::site::Site::load(&folder, &gnomon::site::Overrides::default()).unwrap();
        let mesh = site.mesh.of_components(&site.casts);
        let lights = all_around(&mesh);
        agree(name, &mesh, if name == "headquarters" { &lights[5..9] } else { &lights });
    }
    let mesh = Mesh::build(vec![crate::shared::dome::dome()]).unwrap();
    assert!(mesh.faces.len() > 199_000);
    agree("dome", &mesh, &all_around(&mesh)[3..8]);
}

#[test]
fn the_hierarchy_looks_at_little() {
    let mut meshes = vec![("dome", Mesh::build(vec![crate::shared::dome::dome()]).unwrap())];
    for name in ["tower", "industry", "headquarters"] {
        let folder = std::path::PathBuf::from(format!("sites/{name}"));
        let site = gnomon::site::Site::load(&folder, &gnomon::site::Overrides::default()).unwrap();
        meshes.push((name, site.mesh.of_components(&site.casts)));
    }
    for (name, mesh) in meshes {
        let mut finder = ProcessorFinder::Hierarchy.build(&mesh);
        for light in all_around(&mesh).into_iter().filter(|light| light.w == 0.0 && light.z > 0.05) {
            let looked = finder.find(&mesh, light, &mut Vec::new());
            println!("{name}: {looked:?}, {:.1} a find", looked.at as f64 / looked.found as f64);
            assert!(looked.at <= 10 * looked.found, "{name} under {light}: {looked:?}");
        }
    }
}

#[test]
fn unequal_silhouettes_are_seen() {
    let mesh = Mesh::build(vec![cuboid("box", dvec3(-3.0, -4.0, 0.0), dvec3(3.0, 4.0, 7.0))]).unwrap();
    let edges = found(&mesh, dvec4(0.3, 0.4, 0.8, 0.0));
    assert!(equal(&edges, &edges.iter().rev().copied().collect::<Vec<_>>()));
    let mut turned = edges.clone();
    turned[3].reverse();
    assert!(!equal(&edges, &turned));
    assert!(!equal(&edges, &edges[1..]));
    turned.swap(0, 3);
    assert!(in_rows(&edges) && !in_rows(&turned));
}

#[test]
fn modelled_meshes_close() {
    for (name, mesh) in modelled() {
        agree(name, &mesh, &all_around(&mesh));
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
        agree("soup", &mesh, &[light]);
    }
}
