//! The models of the sample sites equal what their generator writes, and have what their sites promise.

#[path = "../tools/make-sites/main.rs"]
mod make;

use glam::{DMat4, DVec3, dvec3};
use std::collections::{HashMap, HashSet};
use std::path::PathBuf;

const STEPS: f64 = 1024.0;

/// Site file, triangles in its model, triangles that cast.
const COUNTS: [(&str, usize, usize); 4] = [
    ("tower/site.toml", 11_376, 11_188),
    ("industry/site.toml", 13_616, 13_588),
    ("headquarters/site.toml", 183_354, 183_354),
    ("headquarters/facade-and-concrete.toml", 183_354, 146_414),
];

fn on_disk(path: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("sites").join(path)
}

/// What one node shows in one material.
struct Part {
    names: [String; 3],
    mesh: usize,
    is_mirrored: bool,
    /// World frame: x east, y north, z up.
    positions: Vec<DVec3>,
    /// Counter-clockwise from outside, the mirror undone.
    triangles: Vec<[u32; 3]>,
}

fn parts(glb: &[u8]) -> Vec<Part> {
    let glb = gltf::Gltf::from_slice(glb).expect("a glTF file");
    let blob = glb.blob.as_deref().expect("a binary chunk");
    let mut parts = Vec::new();
    for root in glb.default_scene().expect("a scene").nodes() {
        add_parts(&root, DMat4::IDENTITY, blob, &mut parts);
    }
    parts
}

fn add_parts(node: &gltf::Node, world_from_parent: DMat4, blob: &[u8], parts: &mut Vec<Part>) {
    let parent_from_node = DMat4::from_cols_array_2d(&node.transform().matrix().map(|column| column.map(f64::from)));
    let world_from_node = world_from_parent * parent_from_node;
    let is_mirrored = world_from_node.determinant() < 0.0;
    if let Some(mesh) = node.mesh() {
        for primitive in mesh.primitives() {
            let positions = primitive.get(&gltf::Semantic::Positions).expect("positions");
            let positions = read::<4>(&positions, blob).map(f32::from_le_bytes).collect::<Vec<_>>();
            let corners = primitive.indices().expect("indices");
            let corners: Vec<u32> = match corners.data_type() {
                gltf::accessor::DataType::U16 => {
                    read::<2>(&corners, blob).map(|bytes| u16::from_le_bytes(bytes).into()).collect()
                }
                _ => read::<4>(&corners, blob).map(u32::from_le_bytes).collect(),
            };
            let to_world = |point: [f32; 3]| {
                let up_is_y =
                    world_from_node.transform_point3(dvec3(point[0].into(), point[1].into(), point[2].into()));
                dvec3(up_is_y.x, -up_is_y.z, up_is_y.y)
            };
            let mut triangles = corners.as_chunks::<3>().0.to_vec();
            if is_mirrored {
                triangles.iter_mut().for_each(|triangle| triangle.reverse());
            }
            let names = [node.name(), mesh.name(), primitive.material().name()];
            parts.push(Part {
                names: names.map(|name| name.expect("a name").to_owned()),
                mesh: mesh.index(),
                is_mirrored,
                positions: positions.as_chunks::<3>().0.iter().copied().map(to_world).collect(),
                triangles,
            });
        }
    }
    for child in node.children() {
        add_parts(&child, world_from_node, blob, parts);
    }
}

/// The numbers of an accessor, each of `N` bytes.
fn read<'a, const N: usize>(accessor: &gltf::Accessor, blob: &'a [u8]) -> impl Iterator<Item = [u8; N]> + 'a {
    let start = accessor.view().expect("a buffer view").offset() + accessor.offset();
    let bytes = &blob[start..start + accessor.count() * accessor.size()];
    bytes.as_chunks::<N>().0.iter().copied()
}

/// The solids of a part: triangles that hang together by their corners.
fn solids(triangles: &[[u32; 3]]) -> Vec<Vec<[u32; 3]>> {
    let mut leader: HashMap<u32, u32> = HashMap::new();
    fn find(leader: &mut HashMap<u32, u32>, corner: u32) -> u32 {
        let next = *leader.entry(corner).or_insert(corner);
        if next == corner {
            return corner;
        }
        let found = find(leader, next);
        leader.insert(corner, found);
        found
    }
    for &[a, b, c] in triangles {
        for other in [b, c] {
            let (one, two) = (find(&mut leader, a), find(&mut leader, other));
            leader.insert(one, two);
        }
    }
    let mut solids: HashMap<u32, Vec<[u32; 3]>> = HashMap::new();
    for &triangle in triangles {
        solids.entry(find(&mut leader, triangle[0])).or_default().push(triangle);
    }
    solids.into_values().collect()
}

/// What keeps a surface from being closed, well wound and turned outwards.
fn faults(positions: &[DVec3], solid: &[[u32; 3]]) -> Vec<String> {
    let mut faults = Vec::new();
    let mut edges = HashSet::new();
    let mut volume = 0.0;
    let anchor = positions[solid[0][0] as usize];
    for &[a, b, c] in solid {
        let [p, q, r] = [a, b, c].map(|corner| positions[corner as usize] - anchor);
        if (q - p).cross(r - p) == DVec3::ZERO {
            faults.push(format!("no area at {p}"));
        }
        volume += p.dot(q.cross(r));
        for edge in [(a, b), (b, c), (c, a)] {
            if !edges.insert(edge) {
                faults.push(format!("two triangles run along {edge:?}"));
            }
        }
    }
    for &(a, b) in &edges {
        if !edges.contains(&(b, a)) {
            faults.push(format!("nothing closes {:?}", (a, b)));
        }
    }
    if volume <= 0.0 {
        faults.push(format!("six times the volume is {volume}"));
    }
    faults
}

#[test]
fn the_files_are_what_the_maker_draws() {
    for (path, bytes) in make::files() {
        let found = std::fs::read(on_disk(path)).unwrap_or_default();
        assert!(found == bytes, "sites/{path} is not what `cargo run --example make-sites` writes");
        assert!(bytes.len() < 5 << 20, "{path} has {} bytes", bytes.len());
    }
}

#[test]
fn the_models_have_the_promised_triangles() {
    for (site, total, casting) in COUNTS {
        let path = on_disk(site);
        let text = std::fs::read_to_string(&path).expect("a site file");
        let file: toml::Table = text.parse().expect("a TOML file");
        let model = &file["model"][0];
        let glb = path.with_file_name(model["path"].as_str().expect("a path"));
        let parts = parts(&std::fs::read(glb).expect("a model"));
        let names: Option<Vec<&str>> = model
            .get("casts")
            .map(|names| names.as_array().expect("a list").iter().filter_map(|name| name.as_str()).collect());
        for name in names.iter().flatten() {
            let is_known = parts.iter().any(|part| part.names.iter().any(|known| known == name));
            assert!(is_known, "{site}: nothing is named {name}");
        }
        let casts = |part: &&Part| {
            let is_named = |names: &Vec<&str>| part.names.iter().any(|name| names.contains(&name.as_str()));
            names.as_ref().is_none_or(is_named)
        };
        let count: usize = parts.iter().map(|part| part.triangles.len()).sum();
        assert_eq!(count, total, "{site}: triangles");
        let count: usize = parts.iter().filter(casts).map(|part| part.triangles.len()).sum();
        assert_eq!(count, casting, "{site}: triangles that cast");
        let readme = std::fs::read_to_string(path.with_file_name("README.md")).expect("a README");
        for count in [total, casting] {
            let written = format!("{},{:03}", count / 1000, count % 1000);
            assert!(readme.contains(&written), "the README of {site} does not say {written}");
        }
    }
}

#[test]
fn every_solid_is_closed_and_turned_outwards() {
    for (path, bytes) in make::models() {
        for part in parts(&bytes) {
            for solid in solids(&part.triangles) {
                let faults = faults(&part.positions, &solid);
                assert!(faults.is_empty(), "{path}, {}: {faults:?}", part.names.join("/"));
            }
        }
    }
}

#[test]
fn a_fault_is_seen() {
    let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let whole = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    assert!(faults(&corners, &whole).is_empty());
    assert!(!faults(&corners, &whole[1..]).is_empty(), "open");
    let inside_out = whole.map(|[a, b, c]| [c, b, a]);
    assert!(!faults(&corners, &inside_out).is_empty(), "inside out");
    let mut one_flipped = whole;
    one_flipped[2].reverse();
    assert!(!faults(&corners, &one_flipped).is_empty(), "one triangle flipped");
    let flat = [corners[0], corners[1], corners[1] * 2.0, corners[3]];
    assert!(!faults(&flat, &whole).is_empty(), "without area");
}

/// So that sums, welds and planes are the same on every system.
#[test]
fn coordinates_lie_on_the_grid() {
    for (path, bytes) in make::models() {
        for part in parts(&bytes) {
            let off = part.positions.iter().find(|&&point| (point * STEPS).fract() != DVec3::ZERO);
            assert!(off.is_none(), "{path}, {}: {off:?}", part.names.join("/"));
            let below = part.positions.iter().find(|point| point.z < 0.0);
            assert!(below.is_none(), "{path}, {}: {below:?} lies below the ground", part.names.join("/"));
        }
    }
}

/// What exporters do, and readers get wrong.
#[test]
fn each_model_mirrors_and_reuses() {
    for (path, bytes) in make::models() {
        let parts = parts(&bytes);
        assert!(parts.iter().any(|part| part.is_mirrored), "{path}: no mirrored node");
        let is_reused =
            |part: &Part| parts.iter().any(|other| other.mesh == part.mesh && other.names[0] != part.names[0]);
        assert!(parts.iter().any(is_reused), "{path}: no mesh is used twice");
        let names: HashSet<_> = parts.iter().map(|part| [&part.names[0], &part.names[2]]).collect();
        assert_eq!(names.len(), parts.len(), "{path}: two components share a name");
    }
}
