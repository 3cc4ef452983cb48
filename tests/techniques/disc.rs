//! Ray casting to the sun's disc, against the closed form of a straight edge.

use super::draw;
use crate::shared::drawing::{plan, scene_of, to_sun};
use crate::shared::scenes::cuboid;
use glam::{DVec3, dvec3};
use gnomon::choice::Receivers;
use gnomon::mesh::Mesh;
use gnomon::shadow::ray_cast::RayCast;
use gnomon::sun::{SUN_DISC_RAD, disc};
use gnomon::view::{Grid, View};
use std::f64::consts::PI;

#[test]
fn points_fill_the_disc_evenly() {
    let centre = to_sun(140.0, 30.0);
    for samples in [1, 16, 100, 256] {
        let angles: Vec<f64> = disc(centre, samples).map(|point| point.angle_between(centre)).collect();
        assert_eq!(angles.len(), samples as usize);
        let radius = SUN_DISC_RAD / 2.0;
        assert!(angles.iter().all(|angle| *angle < radius));
        // half the radius holds a quarter of the disc
        let inner = angles.iter().filter(|angle| **angle < radius / 2.0).count() as f64;
        assert!((inner - f64::from(samples) / 4.0).abs() <= 1.0, "{inner} of {samples}");
        let middle: DVec3 = disc(centre, samples).sum::<DVec3>() / f64::from(samples);
        assert!(samples == 1 || middle.normalize().angle_between(centre) < 0.15 * radius);
    }
    assert!(disc(centre, 64).eq(disc(centre, 64)), "the same points each time");
}

/// How much of a disc is seen past a straight edge, `x` radii from the disc's middle towards the covered side.
fn past_edge(x: f64) -> f64 {
    let x = x.clamp(-1.0, 1.0);
    0.5 + (x * (1.0 - x * x).sqrt() + x.asin()) / PI
}

#[test]
fn the_penumbra_of_a_long_wall_is_that_of_a_disc() {
    let (height, altitude) = (25.0, 35.0_f64);
    let mesh = Mesh::build(vec![cuboid("wall", dvec3(-300.0, -1.0, 0.0), dvec3(300.0, 0.0, height))]).unwrap();
    let scene = scene_of(&mesh, Receivers::Ground, 0.0);
    // the shadow's edge lies north of the wall; a metre around it in cells of 5 mm
    let edge = height / altitude.to_radians().tan();
    let view = View::Plan(Grid { west: -0.01, north: edge + 0.5, cell: 0.005, width: 4, height: 200 });
    let mask = draw(&mut RayCast::new(scene, view, Some(512)), to_sun(180.0, altitude));
    let mut soft = 0;
    for row in 0..200 {
        let north = edge + 0.5 - (row as f64 + 0.5) * 0.005;
        // the altitude at which the wall's top stands, seen from there
        let top = (height / north).atan();
        let expected = past_edge((altitude.to_radians() - top) / (SUN_DISC_RAD / 2.0));
        let share = f64::from(mask.share[row * 4 + 1]) / 255.0;
        assert!((share - expected).abs() < 0.02, "row {row}: {share} instead of {expected}");
        soft += usize::from(share > 0.02 && share < 0.98);
    }
    assert!(soft > 80, "{soft} cells in the penumbra");
}

#[test]
fn without_samples_the_sun_is_a_point() {
    let mesh = Mesh::build(vec![cuboid("box", dvec3(-5.0, -5.0, 0.0), dvec3(5.0, 5.0, 20.0))]).unwrap();
    let scene = scene_of(&mesh, Receivers::Top, 0.0);
    let [point, of_disc] = [None, Some(64)]
        .map(|samples| draw(&mut RayCast::new(scene.clone(), plan(40.0, 400), samples), to_sun(215.0, 30.0)));
    assert!(point.share.iter().all(|share| matches!(share, 0 | 255)));
    let soft = of_disc.share.iter().filter(|share| !matches!(share, 0 | 255)).count();
    let differ = of_disc.share.iter().zip(&point.share).filter(|(one, other)| (**one > 127) != (**other > 127)).count();
    assert!(soft > 100 && differ * 3 < soft, "{soft} soft cells, {differ} on the other side of half the sun");
}
