//! The building: an L of 10 × 20 × 30 m off the centre, so that any mirrored or turned reading differs.

use glam::DVec3;
use gnomon::formats::{Model, ReadOptions, read};
use std::path::{Path, PathBuf};

/// Where its south-western corner is, in the files' own coordinates.
pub(super) const AT: DVec3 = DVec3::new(500_100.0, 5_400_200.0, 5.0);

/// Its corners in plan, counter-clockwise, around [`AT`].
pub(super) const PLAN: [[f64; 2]; 6] = [[0.0, 0.0], [10.0, 0.0], [10.0, 20.0], [6.0, 20.0], [6.0, 8.0], [0.0, 8.0]];

/// Its height.
pub(super) const HIGH: f64 = 30.0;

/// Its 12 corners around zero: those of the floor, then those of the roof.
pub(super) fn corners() -> Vec<DVec3> {
    let level = |z: f64| PLAN.iter().map(move |&[x, y]| DVec3::new(x, y, z));
    level(0.0).chain(level(HIGH)).collect()
}

/// Its faces as rings of corners, counter-clockwise seen from outside: floor, roof, walls.
pub(super) fn faces() -> Vec<(&'static str, Vec<usize>)> {
    let mut faces = vec![("GroundSurface", (0..6).rev().collect()), ("RoofSurface", (6..12).collect())];
    faces.extend((0..6).map(|a| ("WallSurface", vec![a, (a + 1) % 6, (a + 1) % 6 + 6, a + 6])));
    faces
}

/// A body as described by its triangles: corners in order, area, volume, and the centre of the volume.
#[derive(Debug)]
pub(super) struct Body {
    corners: Vec<[i64; 3]>,
    area: f64,
    volume: f64,
    middle: DVec3,
}

impl Body {
    /// The body of a model's triangles around a point.
    pub(super) fn of(model: &Model, around: DVec3) -> Self {
        let mut body = Body { corners: Vec::new(), area: 0.0, volume: 0.0, middle: DVec3::ZERO };
        for part in &model.parts {
            for triangle in &part.triangles {
                let [a, b, c] = triangle.map(|corner| part.positions[corner as usize] - around);
                let volume = a.dot(b.cross(c)) / 6.0;
                body.area += (b - a).cross(c - a).length() / 2.0;
                body.volume += volume;
                body.middle += (a + b + c) / 4.0 * volume;
                // to a tenth of a millimetre, which is what an Earth-centred f64 and our steps both hold
                body.corners
                    .extend([a, b, c].map(|corner| (corner * 1e4).round().to_array().map(|number| number as i64)));
            }
        }
        body.corners.sort_unstable();
        body.corners.dedup();
        body.middle /= body.volume;
        body
    }

    pub(super) fn volume(&self) -> f64 {
        self.volume
    }

    /// Whether it equals another body scaled by a factor.
    pub(super) fn is_like(&self, other: &Body, times: f64) -> bool {
        (self.volume / other.volume / times.powi(3) - 1.0).abs() < 1e-9
            && (self.middle / times).distance(other.middle) < 1e-6
    }
}

/// Returns an error if a model is not the building at a place.
pub(super) fn difference(model: &Model, at: DVec3) -> Result<(), String> {
    let body = Body::of(model, at);
    let mut corners: Vec<[i64; 3]> =
        corners().iter().map(|corner| (*corner * 1e4).round().to_array().map(|number| number as i64)).collect();
    corners.sort_unstable();
    let (plan, around) = (10.0 * 20.0 - 6.0 * 12.0, 2.0 * (10.0 + 20.0));
    let is_same = body.corners == corners
        && (body.area - (2.0 * plan + around * HIGH)).abs() < 1e-3
        && (body.volume - plan * HIGH).abs() < 1e-3
        && (body.middle.z - HIGH / 2.0).abs() < 1e-5;
    if is_same { Ok(()) } else { Err(format!("{body:?}")) }
}

/// Fails if a model is not the building at [`AT`].
#[track_caller]
pub(super) fn assert_is_block(model: &Model) {
    if let Err(body) = difference(model, AT) {
        panic!("this is not the building: {body}");
    }
}

/// A folder with one file.
pub(super) fn written(name: &str, bytes: impl AsRef<[u8]>) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).expect("written");
    (folder, path)
}

/// What a file of this content is read as.
pub(super) fn model_of(name: &str, bytes: impl AsRef<[u8]>) -> Model {
    let (_folder, path) = written(name, bytes);
    model_at(&path)
}

pub(super) fn model_at(path: &Path) -> Model {
    read(path, &ReadOptions::default()).unwrap_or_else(|error| panic!("{error}"))
}

/// Why a file of this content is refused.
pub(super) fn fault_of(name: &str, bytes: impl AsRef<[u8]>) -> String {
    let (_folder, path) = written(name, bytes);
    match read(&path, &ReadOptions::default()) {
        Ok(model) => panic!("{} parts were read", model.parts.len()),
        Err(error) => error.fault.to_string(),
    }
}

/// How many of a kind were left out.
pub(super) fn left_out(model: &Model, what: &str) -> u64 {
    model.left_out.iter().filter(|one| one.what == what).map(|one| one.count).sum()
}

pub(super) fn names(model: &Model) -> Vec<&str> {
    model.parts.iter().map(|part| part.name.as_str()).collect()
}

#[test]
fn a_building_that_is_mirrored_turned_or_inside_out_is_another() {
    let model = super::shapes::plain_model();
    assert_is_block(&model);
    let changed = |change: &dyn Fn(&mut gnomon::mesh::Part)| {
        let mut model = model.clone();
        model.parts.iter_mut().for_each(change);
        difference(&model, AT)
    };
    let moved = |change: fn(DVec3) -> DVec3| {
        changed(&|part| part.positions.iter_mut().for_each(|corner| *corner = AT + change(*corner - AT)))
    };
    assert!(moved(|corner| DVec3::new(10.0 - corner.x, corner.y, corner.z)).is_err(), "mirrored");
    assert!(moved(|corner| DVec3::new(10.0 - corner.x, 20.0 - corner.y, corner.z)).is_err(), "turned");
    assert!(moved(|corner| corner + DVec3::new(0.0, 0.0, 0.001)).is_err(), "a millimetre higher");
    assert!(changed(&|part| part.triangles.iter_mut().for_each(|corners| corners.swap(1, 2))).is_err(), "inside out");
    assert!(changed(&|part| part.triangles.truncate(part.triangles.len() - 1)).is_err(), "a triangle is missing");
}
