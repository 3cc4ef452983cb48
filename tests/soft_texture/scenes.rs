//! Small scenes: casters that pass through the receiver, touch it, or are curved; and comparisons that must fail.

use super::{Scene, differing, weighed};
use crate::shared::dense::{cuboid, prism, to_sun};
use glam::{DVec3, DVec4, dvec3};
use gnomon::mesh::Part;
use gnomon::shadow::JUDGED_ABOVE_M;
use gnomon::shadow::registered::{Raster, RasterProjection};
use gnomon::shadow::soft_texture::{Choice, Fill, Painter, Sample};

const EVERY: [Choice; 2] = [Choice::Texture, Choice::Auto];

/// Many suns, and two lamps, one of them among the things.
fn samples() -> Vec<Sample> {
    let suns = [(95.0, 12.0), (140.0, 38.0), (181.3, 51.0), (223.0, 40.0), (262.0, 9.0), (305.0, 3.0), (17.0, 65.0)];
    let suns = suns.map(|(azimuth, altitude)| to_sun(azimuth, altitude).extend(0.0));
    let lamps = [dvec3(-14.0, -9.0, 17.0), dvec3(1.3, -4.1, 5.2)].map(|lamp| lamp.extend(1.0));
    weighed(suns.into_iter().chain(lamps))
}

/// A house with a balcony through its wall, a beam through its roof, a basement wall through the lawn, and a fence.
fn house(cell: f64) -> Scene {
    let mut fence = cuboid("fence", dvec3(-9.0, -8.0, 0.0), dvec3(9.0, -7.9, 1.6));
    // an open part of it alone
    fence.triangles.truncate(6);
    let mut beam = Part { name: "beam".into(), ..Part::default() };
    prism(&mut beam, [dvec3(1.0, 0.5, 2.0), dvec3(3.1, 2.4, 9.0)], 5, [0.3, 0.2]);
    Scene::of(
        vec![
            cuboid("lawn", dvec3(-13.0, -12.0, -0.5), dvec3(12.0, 13.0, 0.0)),
            cuboid("house", dvec3(-5.0, -3.0, 0.0), dvec3(5.0, 4.0, 6.0)),
            cuboid("balcony", dvec3(-2.5, -5.1, 2.9), dvec3(1.7, -2.2, 3.1)),
            cuboid("rail", dvec3(-2.5, -5.1, 3.1), dvec3(1.7, -5.05, 4.0)),
            cuboid("basement", dvec3(7.0, -6.0, -3.0), dvec3(7.6, 5.0, 1.1)),
            cuboid("annexe", dvec3(5.0, -1.0, 0.0), dvec3(6.5, 2.0, 2.4)),
            beam,
            fence,
        ],
        cell,
    )
}

#[test]
fn fills_agree_with_rays_where_things_pass_through_the_receiver() {
    let scene = house(0.23);
    assert!(scene.patches.list.iter().any(|patch| patch.two_sided), "the fence is a sheet");
    scene.check(&samples(), &EVERY);
}

#[test]
fn the_adapter_differs_at_edges_alone() {
    let scene = house(0.23);
    let differing = scene.check_adapter(&samples(), Choice::Texture);
    assert!(differing * 1000 < scene.patches.texels.len(), "{differing} texels differ");
    scene.check_adapter(&samples(), Choice::Auto);
}

#[test]
fn a_wrong_texel_is_seen() {
    let scene = house(0.5);
    let truth = scene.rays(&samples());
    let mut wrong = truth.clone();
    wrong[77] ^= 1;
    assert_eq!(differing(&truth, &wrong), [77]);
    // a twentieth of a texel aside some texels lie on the other side of an edge
    let aside = scene.moved([0.05, 0.0]).filled(Fill::Silhouettes, &samples());
    assert!(!differing(&truth, &aside).is_empty());
    // and a caster that is left out is missed
    let mut less = Scene { casters: scene.casters.of_faces(|face| face != 14), patches: scene.patches.clone() };
    assert!(!differing(&truth, &less.filled(Fill::Faces, &samples())).is_empty());
    less.casters = scene.casters.clone();
    assert!(differing(&truth, &less.filled(Fill::Faces, &samples())).is_empty());
}

#[test]
#[should_panic(expected = "far from any edge")]
fn what_is_wrong_far_from_an_edge_is_seen_on_the_adapter() {
    // a sun half a degree aside
    let scene = house(0.5);
    let mut aside = samples();
    aside[1].light = to_sun(140.5, 38.0).extend(0.0);
    let drawn = scene.sums(Painter::OnGpu(super::gpu()), Choice::Texture, &aside);
    scene.check_at_edges(&samples(), Choice::Texture, &drawn);
}

#[test]
fn convex_bodies_never_shade_themselves() {
    let mut body = Part { name: "body".into(), ..Part::default() };
    prism(&mut body, [dvec3(0.0, 0.0, 0.0), dvec3(0.7, -0.4, 5.0)], 96, [2.0, 1.1]);
    let scene = Scene::of(vec![body], 0.11);
    assert!(scene.patches.list.len() >= 98);
    for sample in samples().into_iter().filter(|sample| sample.light.w == 0.0) {
        for painter in
            [Painter::OnProcessor(Fill::Faces), Painter::OnProcessor(Fill::Silhouettes), Painter::OnGpu(super::gpu())]
        {
            let sums = scene.sums(painter, Choice::Texture, &[sample]);
            for patch in &scene.patches.list {
                let towards = patch.normal().dot(sample.light.truncate());
                let lit = sums[patch.texels.start as usize..patch.texels.end as usize].iter().filter(|sum| **sum > 0);
                if towards > 0.01 {
                    assert_eq!(lit.count(), patch.texels.len(), "{towards}");
                } else if towards <= 0.0 {
                    assert_eq!(lit.count(), 0, "{towards}");
                }
            }
        }
    }
}

#[test]
fn no_light_comes_through_a_wall_that_touches() {
    // a wall that stands on the floor, one that stands in it, and the sun low behind both
    for foot in [0.0, -0.3] {
        let scene = Scene::of(
            vec![
                cuboid("floor", dvec3(0.0, 0.0, -0.5), dvec3(6.0, 6.0, 0.0)),
                cuboid("wall", dvec3(0.0, 2.0, foot), dvec3(6.0, 2.02, 3.0)),
            ],
            0.01,
        );
        let samples = weighed([dvec3(0.05, -1.0, 0.2), dvec3(-0.02, -1.0, 0.8)].map(|sun| sun.normalize().extend(0.0)));
        for painter in
            [Painter::OnProcessor(Fill::Faces), Painter::OnProcessor(Fill::Silhouettes), Painter::OnGpu(super::gpu())]
        {
            let sums = scene.sums(painter, Choice::Texture, &samples);
            let floor =
                scene.patches.list.iter().find(|it| it.normal().z > 0.5 && it.plane.w.abs() < 3.0 && it.area_m2 > 30.0);
            let floor = floor.expect("the floor");
            let mut behind = 0;
            for (point, sum) in scene.of_patch(floor, &sums) {
                if (2.021..4.0).contains(&point.y) && (1.0..5.0).contains(&point.x) {
                    assert_eq!(sum, 0, "light at {point}");
                    behind += 1;
                } else if point.y < 1.999 && (1.0..5.0).contains(&point.x) {
                    assert_eq!(sum, 3, "shadow at {point}");
                }
            }
            assert!(behind > 10_000);
        }
    }
}

#[test]
fn samples_register() {
    let scene = house(0.31);
    let together = scene.filled(Fill::Silhouettes, &samples());
    let mut alone = vec![0; together.len()];
    for sample in samples() {
        let one = scene.filled(Fill::Silhouettes, &[sample]);
        alone.iter_mut().zip(one).for_each(|(sum, more)| *sum += more);
    }
    assert_eq!(differing(&together, &alone), Vec::<usize>::new());
    // a receiver's corners are the raster's corners, whichever sample looks
    let corner = dvec3(3.0, -2.0, 1.0);
    let (right, down) = (dvec3(0.6, 0.8, 0.0), dvec3(0.0, 0.0, -1.0));
    let normal = down.cross(right);
    let plane = normal.extend(-normal.dot(corner));
    let raster = Raster { corner, right, down, cell: 0.25, plane };
    for light in
        [dvec3(9.0, -7.0, 4.0).extend(1.0), dvec3(9.0, -7.5, 11.0).extend(1.0), dvec3(0.7, -0.7, 0.1).extend(0.0)]
    {
        let light = if plane.dot(light) > 0.0 { light } else { DVec4::from((-light.truncate(), light.w)) };
        let onto = RasterProjection::new(&raster, light).expect("a light in front");
        for (columns, rows) in [(0.0, 0.0), (40.0, 0.0), (40.0, 12.0), (0.0, 12.0)] {
            let place = onto.place(corner + right * (columns * 0.25) + down * (rows * 0.25));
            assert!((place.at.z - 1.0).abs() < 1e-12 && place.height.abs() < 1e-12);
            // centres are whole numbers, and ties are broken by a ten-thousandth
            assert!((place.at.x - (columns - 0.5)).abs() < 2e-4 && (place.at.y - (rows - 0.5)).abs() < 2e-4);
        }
    }
    assert!(RasterProjection::new(&raster, -normal.extend(0.0)).is_none(), "a light behind the receiver");
}

#[test]
fn the_projection_is_herfs() {
    // M. Herf's paper, section 3.2, with its cross products
    let (b, e_x, e_y) = (dvec3(1.0, 2.0, 0.5), dvec3(8.0, 0.0, 0.0), dvec3(0.0, 3.0, 4.0));
    let a = dvec3(2.0, -3.0, 9.0);
    let e_w = b - a;
    let (n_x, n_y, n_w) = (e_w.cross(e_y), e_x.cross(e_w), e_y.cross(e_x));
    let [alpha_x, alpha_y, alpha_w] = [1.0 / n_x.dot(e_x), 1.0 / n_y.dot(e_y), 1.0 / n_w.dot(e_w)];
    let normal = e_x.cross(e_y).normalize();
    let plane = normal.extend(-normal.dot(b));
    let cell = 0.5;
    let raster = Raster { corner: b, right: e_x.normalize(), down: e_y.normalize(), cell, plane };
    let onto = RasterProjection::new(&raster, a.extend(1.0)).expect("a lamp in front");
    for point in [dvec3(2.0, 1.0, 3.0), dvec3(-4.0, 2.0, 5.0), dvec3(7.0, 7.0, 7.0), dvec3(1.0, 2.0, -1.0)] {
        let w = alpha_w * n_w.dot(point - a);
        let x = alpha_x * n_x.dot(point - b) / w * e_x.length() / cell;
        let y = alpha_y * n_y.dot(point - b) / w * e_y.length() / cell;
        let place = onto.place(point);
        assert!((place.at.z - w).abs() < 1e-12);
        assert!(
            (place.at.x / place.at.z - (x - 0.5)).abs() < 2e-4 && (place.at.y / place.at.z - (y - 0.5)).abs() < 2e-4
        );
    }
}

#[test]
fn what_lies_within_the_millimetre_shades_nothing() {
    for (above, shades) in [(0.9 * JUDGED_ABOVE_M, false), (1.1 * JUDGED_ABOVE_M, true)] {
        let mut sheet = Part { name: "sheet".into(), ..Part::default() };
        sheet.positions = [(1.0, 1.0), (3.0, 1.0), (3.0, 3.0), (1.0, 3.0)].map(|(x, y)| dvec3(x, y, above)).to_vec();
        sheet.triangles = vec![[0, 1, 2], [0, 2, 3]];
        let scene = Scene::of(vec![cuboid("floor", dvec3(0.0, 0.0, -1.0), dvec3(4.0, 4.0, 0.0)), sheet], 0.1);
        let sample = [Sample { light: DVec3::new(0.3, -0.4, 0.8).normalize().extend(0.0), weight: 1 }];
        let floor = scene.patches.list.iter().find(|it| it.component == 0 && it.normal().z > 0.5).expect("a floor");
        for painter in
            [Painter::OnProcessor(Fill::Faces), Painter::OnProcessor(Fill::Silhouettes), Painter::OnGpu(super::gpu())]
        {
            let sums = scene.sums(painter, Choice::Texture, &sample);
            let dark = sums[floor.texels.start as usize..floor.texels.end as usize].iter().filter(|sum| **sum == 0);
            assert_eq!(dark.count(), if shades { 400 } else { 0 });
        }
    }
}
