//! Lamps and the sun's disc above a plate, against closed forms.

use super::Scene;
use crate::shared::dense::cuboid;
use glam::{DVec3, DVec4, dvec3};
use gnomon::mesh::patches::{MOST_TEXELS, Patch, Patches};
use gnomon::mesh::{Mesh, Part};
use gnomon::shadow::JUDGED_ABOVE_M;
use gnomon::shadow::soft_texture::{Choice, Fill, Painter, Sample, unoccluded};
use gnomon::sun::{SUN_DISC_RAD, disc};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// The corners of a square lamp at a height, that looks down.
fn square(middle: DVec3, side: f64) -> [DVec3; 4] {
    [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| middle + dvec3(x, y, 0.0) * (side / 2.0))
}

#[test]
fn the_unoccluded_factor_is_that_of_tables() {
    // J. Howell, A Catalog of Radiation Heat Transfer Configuration Factors, B-3: from an element to a rectangle
    // parallel to it, a corner of which stands above it; four of them are a square above its middle
    let corner = |x: f64, y: f64| {
        let (along, across) = ((1.0 + x * x).sqrt(), (1.0 + y * y).sqrt());
        (x / along * (y / along).atan() + y / across * (x / across).atan()) / TAU
    };
    for (side, height) in [(2.0, 1.0), (0.1, 3.0), (50.0, 0.5)] {
        let factor = unoccluded(DVec3::ZERO, DVec3::Z, &square(dvec3(0.0, 0.0, height), side));
        let half = side / 2.0 / height;
        assert!((factor - 4.0 * corner(half, half)).abs() < 1e-12, "{factor}");
    }
    // aside, by differences of such rectangles: the square from x = 1 to 3 and y = −1 to 1
    let aside = unoccluded(DVec3::ZERO, DVec3::Z, &square(dvec3(2.0, 0.0, 1.0), 2.0));
    assert!((aside - 2.0 * (corner(3.0, 1.0) - corner(1.0, 1.0))).abs() < 1e-12);
    // and by adding up samples, whichever way the corners run
    let mut square = square(dvec3(1.5, -0.5, 2.0), 1.0);
    let summed: f64 = (0..400 * 400)
        .map(|at| {
            let [x, y] = [at % 400, at / 400].map(|step| (f64::from(step) + 0.5) / 400.0 - 0.5);
            let to_point = dvec3(1.5 + x, -0.5 + y, 2.0);
            let cosine = to_point.normalize().z;
            cosine * cosine / (PI * to_point.length_squared()) / (400.0 * 400.0)
        })
        .sum();
    assert!((unoccluded(DVec3::ZERO, DVec3::Z, &square) - summed).abs() < 1e-7);
    square.reverse();
    assert!((unoccluded(DVec3::ZERO, DVec3::Z, &square) - summed).abs() < 1e-7);
}

/// A sheet whose border runs along y at x = 0, over all that is west of it, at a height.
fn sheet(height: f64) -> Part {
    Part {
        name: "sheet".into(),
        positions: [(-90.0, -90.0), (0.0, -90.0), (0.0, 90.0), (-90.0, 90.0)]
            .map(|(x, y)| dvec3(x, y, height))
            .to_vec(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Part::default()
    }
}

/// A plate that alone receives, under a sheet.
fn under_a_sheet(low: DVec3, high: DVec3, height: f64, cell: f64) -> Scene {
    let casters = Mesh::build(vec![cuboid("plate", low, high), sheet(height)]).expect("a mesh");
    let patches = Arc::new(Patches::of(&casters, &[true, false], cell, MOST_TEXELS));
    assert_eq!(patches.cell, cell);
    Scene { casters, patches }
}

fn plate(scene: &Scene) -> &Patch {
    scene.patches.list.iter().find(|it| it.component == 0 && it.normal().z > 0.5).expect("a plate")
}

fn painters() -> [Painter; 3] {
    [Painter::OnProcessor(Fill::Faces), Painter::OnProcessor(Fill::Silhouettes), Painter::OnGpu(super::gpu())]
}

#[test]
fn a_square_lamps_penumbra_is_as_wide_and_as_steep_as_geometry_says() {
    let (lamp_z, sheet_z, side, across) = (8.0, 3.0, 0.5, 16u32);
    let scene = under_a_sheet(dvec3(-2.0, -0.1, -0.1), dvec3(2.0, 0.1, 0.0), sheet_z, 0.004);
    // a grid, so that a texel's count is known
    let lights: Vec<DVec4> = (0..across * across)
        .map(|at| {
            let [x, y] =
                [at % across, at / across].map(|step| ((f64::from(step) + 0.5) / f64::from(across) - 0.5) * side);
            dvec3(x, y, lamp_z).extend(1.0)
        })
        .collect();
    let samples: Vec<_> = lights.iter().map(|&light| Sample { light, weight: 1 }).collect();
    let plate = plate(&scene);
    for painter in painters() {
        let on_gpu = matches!(painter, Painter::OnGpu(_));
        let sums = scene.sums(painter, Choice::Texture, &samples);
        let (mut first_light, mut first_whole) = (f64::INFINITY, f64::INFINITY);
        for (DVec3 { x, .. }, sum) in scene.of_patch(plate, &sums) {
            let seen = |light: &&DVec4| {
                let part = (sheet_z - JUDGED_ABOVE_M) / (lamp_z - JUDGED_ABOVE_M);
                x + (light.x - x) * part > 0.0
            };
            let expected = lights.iter().filter(seen).count() as u32;
            // a column of the lamp may appear a texel's rounding sooner or later on the adapter
            let slack = if on_gpu { across } else { 0 };
            assert!(sum.abs_diff(expected) <= slack, "{} of {expected} at {x}", sum);
            if sum > 0 {
                first_light = first_light.min(x);
            }
            if sum == across * across {
                first_whole = first_whole.min(x);
            }
        }
        // from the light's one border past the edge to its other; the grid's outermost points stand half a step inside
        let width = side * sheet_z / (lamp_z - sheet_z) * (1.0 - 1.0 / f64::from(across));
        assert!((first_whole - first_light - width).abs() < 0.006, "{first_light} to {first_whole}");
    }
}

#[test]
fn the_suns_disc_has_the_penumbra_that_distance_gives() {
    let height = 12.0;
    let scene = under_a_sheet(dvec3(-0.5, -0.01, -0.01), dvec3(0.5, 0.01, 0.0), height, 0.001);
    let points: Vec<DVec3> = disc(DVec3::Z, 256).collect();
    let samples: Vec<_> = points.iter().map(|point| Sample { light: point.extend(0.0), weight: 1 }).collect();
    let plate = plate(&scene);
    let width = 2.0 * height * (SUN_DISC_RAD / 2.0).tan();
    for painter in painters() {
        let sums = scene.sums(painter, Choice::Texture, &samples);
        let mut most_off: f64 = 0.0;
        for (DVec3 { x, .. }, sum) in scene.of_patch(plate, &sums) {
            // a uniform disc past a straight edge
            let past = (x / (width / 2.0)).clamp(-1.0, 1.0);
            let seen = 0.5 + (past * (1.0 - past * past).sqrt() + past.asin()) / PI;
            most_off = most_off.max((f64::from(sum) / 256.0 - seen).abs());
            if past.abs() == 1.0 {
                assert_eq!(sum, if past > 0.0 { 256 } else { 0 }, "at {x}");
            }
        }
        assert!(most_off < 0.02, "{most_off} of the sun off");
    }
}
