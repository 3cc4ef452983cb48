//! One building, which the test of each format writes in its own units and axes: an L of 10 × 20 × 30 m off the centre,
//! so that any mirrored or turned reading differs. The faces that are read are compared with those that were written.

use super::mutations::read_within_memory;
use crate::shared::memory::CountedThread;
use glam::DVec3;
use gnomon::formats::{self, LeftOut, Model, ReadOptions, Up};
use gnomon::site::Placement;
use std::collections::BTreeMap;
use std::path::Path;
use std::time::{Duration, Instant};

/// Corners of the plan, metres east and north, counter-clockwise.
const PLAN: [[f64; 2]; 6] = [[5.0, 7.0], [15.0, 7.0], [15.0, 17.0], [10.0, 17.0], [10.0, 27.0], [5.0, 27.0]];
const HEIGHT_M: f64 = 30.0;

/// Triangles of the building, however its faces are cut.
pub(crate) const TRIANGLES: usize = 20;

/// The faces, seen from outside counter-clockwise; metres, east, north and up. The first two have six corners, the others four.
pub(crate) fn faces() -> Vec<Vec<DVec3>> {
    let at = |[x, y]: [f64; 2], z: f64| DVec3::new(x, y, z);
    let top = PLAN.iter().map(|&corner| at(corner, HEIGHT_M)).collect();
    let bottom = PLAN.iter().rev().map(|&corner| at(corner, 0.0)).collect();
    let wall = |index: usize| {
        let (a, b) = (PLAN[index], PLAN[(index + 1) % PLAN.len()]);
        vec![at(a, 0.0), at(b, 0.0), at(b, HEIGHT_M), at(a, HEIGHT_M)]
    };
    [top, bottom].into_iter().chain((0..PLAN.len()).map(wall)).collect()
}

/// The same in a file's unit and with its up axis.
pub(crate) fn faces_in(unit_m: f64, up: Up) -> Vec<Vec<DVec3>> {
    let corner = |corner: DVec3| match up {
        Up::Z => corner / unit_m,
        Up::Y => DVec3::new(corner.x, corner.z, -corner.y) / unit_m,
    };
    faces().into_iter().map(|face| face.into_iter().map(corner).collect()).collect()
}

/// Each corner once, and the faces by their corners from 0.
pub(crate) fn indexed(faces: &[Vec<DVec3>]) -> (Vec<DVec3>, Vec<Vec<usize>>) {
    let mut corners: Vec<DVec3> = Vec::new();
    let mut number = |corner: DVec3| {
        corners.iter().position(|&known| known == corner).unwrap_or_else(|| {
            corners.push(corner);
            corners.len() - 1
        })
    };
    let faces = faces.iter().map(|face| face.iter().map(|&corner| number(corner)).collect()).collect();
    (corners, faces)
}

/// The faces as triangles, for formats that have nothing else: the L's caps are fans around the corner where it bends.
pub(crate) fn triangles_in(unit_m: f64, up: Up) -> Vec<[DVec3; 3]> {
    let bends = [3, 2].into_iter().chain([0; 6]);
    let fan = |(face, bend): (Vec<DVec3>, usize)| {
        let corner = move |at: usize| face[(bend + at) % face.len()];
        let count = if bend > 0 { 6 } else { 4 };
        (1..count - 1).map(|at| [corner(0), corner(at), corner(at + 1)]).collect::<Vec<_>>()
    };
    faces_in(unit_m, up).into_iter().zip(bends).flat_map(fan).collect()
}

/// Square millimetres of each plane's faces; a plane by its normal and its distance from the origin.
type Surfaces = BTreeMap<[i64; 4], i64>;

fn add(surfaces: &mut Surfaces, vector: DVec3, point: DVec3) {
    let Some(normal) = vector.try_normalize() else { return };
    let round = |value: f64| (value * 1000.0).round() as i64;
    let plane = [normal.x, normal.y, normal.z, normal.dot(point)].map(round);
    *surfaces.entry(plane).or_default() += (vector.length() * 1000.0).round() as i64;
}

fn surfaces(triangles: impl Iterator<Item = [DVec3; 3]>) -> Surfaces {
    let mut surfaces = Surfaces::new();
    for [a, b, c] in triangles {
        add(&mut surfaces, (b - a).cross(c - a) / 2.0, a);
    }
    surfaces
}

/// What is read of a file, standing where it does without a site.
pub(crate) fn read(path: &Path) -> Model {
    let model = formats::read(path, &ReadOptions::default()).unwrap_or_else(|error| panic!("{error}"));
    Placement::default().place(model)
}

/// What is read of a file of that name and content.
pub(crate) fn read_bytes(name: &str, bytes: &[u8]) -> Model {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    read(&path)
}

/// A file of that name and content must be refused, in all these words.
pub(crate) fn assert_refused(name: &str, bytes: &[u8], words: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    let error = formats::read(&path, &ReadOptions::default()).expect_err("it must be refused").to_string();
    for word in words {
        assert!(error.contains(word), "'{word}' is missing in: {error}");
    }
}

/// All triangles of a model.
pub(crate) fn triangles(model: &Model) -> impl Iterator<Item = [DVec3; 3]> {
    let of_part = |part: &gnomon::mesh::Part| {
        let corner = |vertex: u32| part.positions[vertex as usize];
        part.triangles.iter().map(|triangle| triangle.map(corner)).collect::<Vec<_>>()
    };
    model.parts.iter().flat_map(of_part)
}

/// Where the building's faces are, and how large; whoever has the same has the same masks.
fn expected() -> Surfaces {
    let mut expected = Surfaces::new();
    for face in faces() {
        let vector = face.windows(2).map(|two| (two[0] - face[0]).cross(two[1] - face[0]) / 2.0).sum();
        add(&mut expected, vector, face[0]);
    }
    expected
}

/// The model must be the building: each plane with as much surface, looking the same way.
pub(crate) fn assert_is_building(model: &Model) {
    assert_eq!(triangles(model).count(), TRIANGLES);
    assert_eq!(surfaces(triangles(model)), expected());
    let low = triangles(model).flatten().fold(DVec3::INFINITY, DVec3::min);
    let high = triangles(model).flatten().fold(DVec3::NEG_INFINITY, DVec3::max);
    assert!((low - DVec3::new(5.0, 7.0, 0.0)).length() < 1e-5 && (high - DVec3::new(15.0, 27.0, 30.0)).length() < 1e-5);
}

/// What was left out, as `count what`.
pub(crate) fn left_out(model: &Model) -> Vec<String> {
    model.left_out.iter().map(|LeftOut { what, count, .. }| format!("{count} {what}")).collect()
}

pub(crate) fn names(model: &Model) -> Vec<&str> {
    model.parts.iter().map(|part| part.name.as_str()).collect()
}

/// A thousand changes of a small file: none may end in a panic, take longer than a second, or more memory than it may.
pub(crate) fn survive_mutations(name: &str, whole: &[u8]) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    let mut state = 0x9E37_79B9_7F4A_7C15_u64;
    let mut random = move |below: usize| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state % below.max(1) as u64) as usize
    };
    let (mut read, mut refused) = (0, 0);
    let thread = CountedThread::new();
    for _ in 0..1000 {
        let mut bytes = whole.to_vec();
        for _ in 0..1 + random(4) {
            let at = random(bytes.len());
            match random(5) {
                0 => bytes[at] = random(256) as u8,
                1 => bytes[at] ^= 1 << random(8),
                2 => bytes.truncate(at.max(1)),
                3 => drop(bytes.drain(at..(at + random(20)).min(bytes.len()))),
                _ => {
                    let end = (at + random(20)).min(bytes.len());
                    let copied = bytes[at..end].to_vec();
                    bytes.splice(at..at, copied);
                }
            }
            if bytes.is_empty() {
                bytes.push(0);
            }
        }
        std::fs::write(&path, &bytes).unwrap();
        let started = Instant::now();
        match read_within_memory(&thread, &path, &ReadOptions::default()) {
            Ok(model) => {
                read += 1;
                assert!(model.parts.iter().flat_map(|part| &part.positions).all(|corner| corner.is_finite()));
            }
            Err(_) => refused += 1,
        }
        assert!(started.elapsed() < Duration::from_secs(1), "{name} takes too long");
    }
    assert!(read > 0 && refused > 0, "{name}: {read} read, {refused} refused");
}

/// The comparison must see a building that is mirrored, turned, moved or turned inside out.
#[test]
fn the_comparison_sees_other_buildings() {
    let own = || triangles_in(1.0, Up::Z).into_iter();
    let changed = |change: fn(DVec3) -> DVec3| surfaces(own().map(|triangle| triangle.map(change)));
    assert_eq!((changed(|corner| corner), own().count()), (expected(), TRIANGLES));
    for other in [
        changed(|corner| DVec3::new(-corner.x, corner.y, corner.z)),
        changed(|corner| DVec3::new(corner.y, corner.x, corner.z)),
        changed(|corner| DVec3::new(corner.x, -corner.z, corner.y)),
        changed(|corner| corner + DVec3::X * 0.01),
        surfaces(own().map(|[a, b, c]| [a, c, b])),
    ] {
        assert_ne!(other, expected());
    }
}
