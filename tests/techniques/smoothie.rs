//! Smoothies: the penumbra's width against the closed form, corners without seams, hard contact, and no more light than
//! the map alone gives.

use super::{draw, site};
use crate::shared::drawing::{gpu, scene_of, to_sun};
use crate::shared::scenes::{cuboid, joined, sheet};
use glam::{DVec2, DVec3, dvec2, dvec3};
use gnomon::choice::{Filter, Receivers};
use gnomon::mesh::Mesh;
use gnomon::shadow::ray_cast::RayCast;
use gnomon::shadow::shadow_map::ShadowMap;
use gnomon::shadow::smoothie::Smoothie;
use gnomon::shadow::{DrawnMask, Scene};
use gnomon::silhouette::ProcessorFinder;
use gnomon::sun::SUN_DISC_RAD;
use gnomon::view::{Grid, Mask, View};

const SIDE: u32 = 700;

/// A square of the ground around a point, with a width in metres.
fn around(middle: DVec2, side_m: f64) -> View {
    let cell = side_m / f64::from(SIDE);
    View::Plan(Grid { west: middle.x - side_m / 2.0, north: middle.y + side_m / 2.0, cell, width: SIDE, height: SIDE })
}

fn smoothie(scene: &Scene, view: View, width_m: Option<f64>) -> Smoothie {
    Smoothie::new(gpu(), scene.clone(), view, ProcessorFinder::Hierarchy, 2048, width_m).unwrap()
}

/// The share at a place of a plan's mask.
fn at(mask: &Mask, view: View, place: DVec2) -> u8 {
    let View::Plan(grid) = view else { panic!("a plan") };
    let (column, row) = ((place.x - grid.west) / grid.cell, (grid.north - place.y) / grid.cell);
    mask.share[row as usize * mask.width as usize + column as usize]
}

/// The length in metres of the part of a line on which some of the sun is seen, but not all.
fn soft_length(mask: &Mask, view: View, from: DVec2, to: DVec2) -> f64 {
    let steps = 4000;
    let soft = (0..steps).filter(|&step| {
        let place = from.lerp(to, (f64::from(step) + 0.5) / f64::from(steps));
        !matches!(at(mask, view, place), 0 | 255)
    });
    soft.count() as f64 / f64::from(steps) * from.distance(to)
}

/// The width of the sun's penumbra at a distance behind an edge.
fn width(behind: f64) -> f64 {
    2.0 * behind * (SUN_DISC_RAD / 2.0).tan()
}

fn wall(height: f64) -> Scene {
    let wall = cuboid("wall", dvec3(-40.0, -0.4, 0.0), dvec3(40.0, 0.0, height));
    scene_of(&Mesh::build(vec![wall]).unwrap(), Receivers::Top, 0.0)
}

#[test]
fn the_penumbra_of_a_walls_top_is_as_wide_as_the_disc_demands() {
    for (height, altitude) in [(12.0, 15.0), (30.0, 15.0), (30.0, 22.0), (30.0, 40.0), (45.0, 65.0)] {
        let scene = wall(height);
        let (sin, tan) = (f64::sin(f64::to_radians(altitude)), f64::tan(f64::to_radians(altitude)));
        let expected = width(height / sin) / sin;
        let edge = dvec2(1.3, height / tan);
        let view = around(edge, 4.0 * expected);
        let mask = draw(&mut smoothie(&scene, view, None), to_sun(180.0, altitude));
        let reach = dvec2(0.0, 1.9 * expected);
        let found = soft_length(&mask, view, edge - reach, edge + reach);
        println!("{height} m at {altitude}°: {found:.3} m instead of {expected:.3}");
        assert!((found / expected - 1.0).abs() < 0.1, "{height} m at {altitude}°: {found} instead of {expected}");
        // a disc's falloff past a straight edge: by the closed form less than a fifth at a quarter of the way
        for part in [0.25, 0.5, 0.75] {
            let x: f64 = 2.0 * part - 1.0;
            let seen = 0.5 + (x * (1.0 - x * x).sqrt() + x.asin()) / std::f64::consts::PI;
            let drawn = f64::from(at(&mask, view, edge + dvec2(0.0, part * expected))) / 255.0;
            assert!((drawn - seen).abs() < 0.025, "{height} m at {altitude}°, at {part}: {drawn} instead of {seen}");
        }
        // all of it lies outside of the hard shadow
        assert_eq!(at(&mask, view, edge - dvec2(0.0, 0.05 * expected)), 0);
        assert!(at(&mask, view, edge + dvec2(0.0, 0.9 * expected)) > 200);
    }
}

#[test]
fn along_an_upright_edge_the_penumbra_grows_from_a_hard_contact() {
    let scene = wall(60.0);
    let (azimuth, altitude) = (200.0_f64, 30.0_f64);
    // the shadow of the wall's eastern end runs away from the sun
    let (sin, cos) = azimuth.to_radians().sin_cos();
    let (away, across) = (dvec2(-sin, -cos), dvec2(cos, -sin) * -1.0);
    let corner = dvec2(40.0, -0.4);
    for distance in [0.05, 4.0, 15.0, 40.0, 80.0] {
        let expected = width(distance / altitude.to_radians().cos());
        let middle = corner + away * distance;
        let view = around(middle, (4.0 * expected).max(0.1));
        let mask = draw(&mut smoothie(&scene, view, None), to_sun(azimuth, altitude));
        let reach = across * (1.9 * expected).max(0.04);
        let found = soft_length(&mask, view, middle - reach, middle + reach);
        println!("{distance} m from the wall: {:.1} mm instead of {:.1}", found * 1e3, expected * 1e3);
        let near_enough = (found / expected - 1.0).abs() < 0.1;
        assert!(near_enough || expected < 1e-3 && found < 2e-3, "{distance} m: {found} instead of {expected}");
    }
}

/// The largest difference of neighbours on a circle, of points a hundredth of a radius apart.
fn largest_jump(mask: &Mask, view: View, middle: DVec2, radius: f64) -> u8 {
    let steps = 640;
    let share = |step: usize| {
        let angle = std::f64::consts::TAU * step as f64 / steps as f64;
        at(mask, view, middle + DVec2::from_angle(angle) * radius)
    };
    (0..steps).map(|step| share(step).abs_diff(share(step + 1))).max().unwrap()
}

/// Scenes whose corner's shadow falls on a point of the ground: a box's corner, an inner corner, a roof's tip, and the
/// point in which two boxes touch, at which four silhouette edges meet.
fn corners() -> Vec<(&'static str, Mesh, DVec3)> {
    let (low, high) = (dvec3(-10.0, -10.0, 20.0), dvec3(0.0, 0.0, 22.0));
    let box_at = |low: DVec3, high: DVec3| cuboid("boxes", low, high);
    let tip = [dvec3(-6.0, -2.0, 24.0), dvec3(0.0, 0.0, 22.0), dvec3(-6.0, 2.0, 24.0), dvec3(-6.0, 0.0, 24.0)];
    let step = dvec3(10.0, 10.0, 0.0);
    vec![
        ("a corner", vec![box_at(low, high)], high),
        (
            "an inner corner",
            vec![joined(vec![
                box_at(low, high),
                box_at(dvec3(0.0, -10.0, 20.0), dvec3(10.0, 0.0, 22.0)),
                box_at(dvec3(-10.0, 0.0, 20.0), dvec3(0.0, 10.0, 22.0)),
            ])],
            high,
        ),
        ("a tip", vec![sheet(tip)], tip[1]),
        ("two boxes that touch", vec![joined(vec![box_at(low, high), box_at(low + step, high + step)])], high),
    ]
    .into_iter()
    .map(|(name, parts, corner)| (name, Mesh::build(parts).unwrap(), corner))
    .collect()
}

#[test]
fn corners_of_any_number_of_edges_have_no_seams() {
    for (name, mesh, corner) in corners() {
        let scene = scene_of(&mesh, Receivers::Ground, 0.0);
        let mut seen = 0;
        for sun in [to_sun(225.0, 62.0), to_sun(200.0, 50.0), to_sun(110.0, 55.0)] {
            let shadow = (corner - sun * (corner.z / sun.z)).truncate();
            let soft = width(corner.z / sun.z);
            let view = around(shadow, 5.0 * soft);
            let mask = draw(&mut smoothie(&scene, view, None), sun);
            let hard = draw(&mut smoothie(&scene, view, Some(1e-9)), sun);
            for share in [0.3, 0.5, 0.8] {
                let jump = largest_jump(&mask, view, shadow, share * soft);
                assert!(jump <= 24, "{name}, sun {sun}, {share} of the width: {jump}");
            }
            // the same is seen to fail on the hard shadow
            seen += usize::from(largest_jump(&hard, view, shadow, 0.5 * soft) > 100);
        }
        assert!(seen >= 1, "{name}: the corner's shadow is seen for {seen} suns");
    }
}

/// Against another technique's shader: where all four texels around a cell shade it, whatever their weights, no sun is left;
/// and all of the sun is seen only where none of the four that weigh anything shades it. And against its own map, filtered
/// alike but without smoothies, in every cell.
#[test]
fn it_is_never_lighter_than_its_map() {
    for name in ["tower", "industry", "headquarters"] {
        let (scene, view, suns) = site(name, 400);
        let [mut soft, mut bare] = [None, Some(1e-9)].map(|width| smoothie(&scene, view, width));
        let mut map = ShadowMap::new(gpu(), &scene, view, 2048, Filter::FastTwoByTwo).unwrap();
        for &sun in suns.iter().step_by(4) {
            let (soft, bare, map) = (draw(&mut soft, sun), draw(&mut bare, sun), draw(&mut map, sun));
            let lighter = soft.share.iter().zip(&bare.share).filter(|(soft, bare)| soft > bare).count();
            let darker = soft.share.iter().zip(&bare.share).filter(|(soft, bare)| soft < bare).count();
            assert!(lighter == 0 && darker > 100, "{name}: {lighter} lighter, {darker} darker");
            let dark = || map.share.iter().zip(&soft.share).filter(|(map, _)| **map == 0);
            let wrong = dark().filter(|(_, soft)| **soft > 0).count();
            assert!(wrong == 0 && dark().count() > 1000, "{name}: {wrong} of {} see some sun", dark().count());
            // a weight below half a level of the mask weighs nothing
            let lit = map.share.iter().zip(&soft.share).filter(|(map, soft)| **map < 255 && **soft == 255).count();
            let partial = map.share.iter().filter(|share| !matches!(share, 0 | 255)).count();
            assert!(lit * 50 <= partial, "{name}: {lit} of {partial} see all of the sun");
        }
    }
}

#[test]
fn on_the_sites_it_holds_all_of_the_discs_shadow() {
    for (name, most) in [("tower", 0.03), ("industry", 0.02), ("headquarters", 0.02)] {
        let (scene, view, suns) = site(name, 400);
        let mut soft = smoothie(&scene, view, None);
        let mut truth = RayCast::new(scene.clone(), view, Some(32));
        for &sun in suns.iter().step_by(4) {
            let (drawn, right) = (draw(&mut soft, sun), draw(&mut truth, sun));
            let pairs = || drawn.share.iter().zip(&right.share);
            let cells = drawn.share.len() as f64;
            let lighter = pairs().filter(|(drawn, right)| **drawn > right.saturating_add(127)).count() as f64 / cells;
            let mean = pairs().map(|(drawn, right)| f64::from(drawn.abs_diff(*right)) / 255.0).sum::<f64>() / cells;
            println!("{name}: {:.3}% far too light, {:.3}% off in the mean", 100.0 * lighter, 100.0 * mean);
            assert!(lighter < 0.004 && mean < most, "{name}: {lighter} {mean}");
        }
    }
}

/// A plate above a table that covers half of the ground.
fn two_receivers() -> Scene {
    let plate = [dvec3(-30.0, -30.0, 10.0), dvec3(0.0, -30.0, 10.0), dvec3(0.0, 30.0, 10.0), dvec3(-30.0, 30.0, 10.0)];
    let table = cuboid("table", dvec3(-30.0, 0.0, 0.0), dvec3(30.0, 30.0, 5.0));
    scene_of(&Mesh::build(vec![sheet(plate), table]).unwrap(), Receivers::Top, 0.0)
}

/// How wide the plate's penumbra is on the ground and on the table, from west to east.
fn on_both(drawn: DrawnMask<'_>, view: View, edges: [DVec2; 2], reach: f64) -> [f64; 2] {
    let mask = drawn.read().unwrap();
    edges.map(|edge| soft_length(&mask, view, edge - dvec2(reach, 0.0), edge + dvec2(reach, 0.0)))
}

#[test]
fn the_remap_makes_one_edge_as_soft_as_each_receiver_demands() {
    use gnomon::shadow::Technique;
    let scene = two_receivers();
    let sun = to_sun(270.0, 60.0);
    let onto = |z: f64, y: f64| dvec2((10.0 - z) * sun.x.abs() / sun.z, y);
    // where the shadow of the plate's edge falls, east of it
    let edges = [onto(0.0, -0.3), onto(5.0, 0.9)];
    let view = around((edges[0] + edges[1]) / 2.0, 4.0);
    let mut technique = smoothie(&scene, view, None);
    let [ground, table] = on_both(technique.draw(sun).unwrap(), view, edges, 0.4);
    let expected = [10.0, 5.0].map(|fall| width(fall / sun.z) / sun.z);
    assert!((ground / expected[0] - 1.0).abs() < 0.1, "{ground} instead of {}", expected[0]);
    assert!((table / expected[1] - 1.0).abs() < 0.1, "{table} instead of {}", expected[1]);
    // without it, both are as wide as the smoothie
    technique.force_linear(true);
    let [ground, table] = on_both(technique.draw(sun).unwrap(), view, edges, 0.4);
    assert!((ground / table - 1.0).abs() < 0.1, "{ground} and {table}");
}

#[test]
fn a_width_by_hand_bounds_the_penumbra() {
    let scene = wall(30.0);
    let view = around(dvec2(1.3, 30.0), 1.2);
    // the sun's own would be 0.39 m across the rays
    let mask = draw(&mut smoothie(&scene, view, Some(0.1)), to_sun(180.0, 45.0));
    let found = soft_length(&mask, view, dvec2(1.3, 29.5), dvec2(1.3, 30.5));
    let expected = 0.1 * 2.0_f64.sqrt();
    assert!((found / expected - 1.0).abs() < 0.1, "{found} instead of {expected}");
    // what is wider than the sun makes it changes nothing
    let of_disc = draw(&mut smoothie(&scene, view, None), to_sun(180.0, 45.0));
    for huge in [5.0, 1e6, 1e30] {
        let drawn = draw(&mut smoothie(&scene, view, Some(huge)), to_sun(180.0, 45.0));
        assert!(drawn == of_disc, "a width of {huge} m is not bounded by the sun's");
    }
}

#[test]
fn a_lamps_penumbra_follows_the_papers_remap() {
    let scene = two_receivers();
    let lamp = dvec3(-0.4, 0.3, 20.0);
    // on the ray past the plate's edge: b = 10, and r = 20 on the ground, 15 on the table
    let onto = |z: f64, y: f64| dvec2(lamp.x + (0.0 - lamp.x) * (20.0 - z) / 10.0, y);
    let edges = [onto(0.0, -1.0), onto(5.0, 1.2)];
    let view = around(dvec2(0.0, 0.1), 4.0);
    let mut technique = smoothie(&scene, view, None);
    let t = 0.03;
    let [ground, table] = on_both(technique.draw_lamp(lamp, t).unwrap(), view, edges, 1.0);
    // t · (1 − b/r) in the plane a metre before the lamp, r times as far on the receiver
    let expected = [t * (1.0 - 10.0 / 20.0) * 20.0, t * (1.0 - 10.0 / 15.0) * 15.0];
    println!("{ground} {table} instead of {expected:?}");
    assert!((ground / expected[0] - 1.0).abs() < 0.1, "{ground} instead of {}", expected[0]);
    assert!((table / expected[1] - 1.0).abs() < 0.1, "{table} instead of {}", expected[1]);
    // and its shadow lies where the lamp throws it
    let mask = technique.draw_lamp(lamp, 1e-9).unwrap().read().unwrap();
    // west of 0 the plate itself is seen
    for (edge, expected) in edges.iter().zip([200, 100]) {
        let share = |step: u32| at(&mask, view, *edge + dvec2(f64::from(step) * 0.002 - 0.4, 0.0));
        let dark = (0..400).filter(|&step| share(step) < 128).count();
        assert!(dark.abs_diff(expected) <= 6, "{dark} of 400 instead of {expected}");
    }
}

/// A plate casts its penumbra onto a table, and under the table is a slab whose smoothies, seen from the sun, cross
/// those of the plate. They are behind a blocker, and must not darken the table.
#[test]
fn smoothies_behind_a_blocker_are_discarded() {
    let sun = to_sun(180.0, 50.0);
    // where a point casts its shadow at another height
    let thrown = |y: f64, from: f64, to: f64| y - sun.y / sun.z * (from - to);
    let plate = |z: f64, north: f64, east: f64| {
        let corner = |x: f64, y: f64| dvec3(x, y, z);
        sheet([corner(-8.0, north - 6.0), corner(east, north - 6.0), corner(east, north), corner(-8.0, north)])
    };
    let above = plate(25.0, 0.0, 8.0);
    let edge = thrown(0.0, 25.0, 5.0);
    // beyond the table's eastern end the ground is seen: the slab is high enough above it to have smoothies
    let table = cuboid("table", dvec3(-9.0, edge - 8.0, 4.9), dvec3(0.6, edge + 4.0, 5.0));
    let under = plate(3.0, thrown(edge + 0.05, 5.0, 3.0), 0.5);
    let view = around(dvec2(0.3, edge), 1.4);
    let of = |parts: Vec<gnomon::mesh::Part>| {
        let scene = scene_of(&Mesh::build(parts).unwrap(), Receivers::Top, 0.0);
        draw(&mut smoothie(&scene, view, None), sun)
    };
    let alone = of(vec![above.clone(), table.clone()]);
    let soft = soft_length(&alone, view, dvec2(0.2, edge - 0.3), dvec2(0.2, edge + 0.6));
    assert!(soft > 0.15, "{soft} m of penumbra on the table");
    let with_slab = of(vec![above, table, under]);
    // (the map's depth reaches further down with the slab, and rounds otherwise)
    let differ = alone.share.iter().zip(&with_slab.share).filter(|(one, other)| one.abs_diff(**other) > 3).count();
    assert_eq!(differ, 0, "cells of the table and the ground behind it");
}

/// A roof casts, and glass under it only receives: the widths of the penumbra on the glass and on the ground beyond it
/// do not affect each other.
#[test]
fn behind_what_only_receives_the_penumbra_is_as_wide_as_there() {
    let roof = cuboid("roof", dvec3(-20.0, -20.0, 20.0), dvec3(20.0, 0.0, 20.3));
    let glass = cuboid("glass", dvec3(-20.0, -20.0, 17.0), dvec3(20.0, 40.0, 17.1));
    let mesh = Mesh::build(vec![roof, glass]).unwrap();
    let (altitude, casts) = (f64::to_radians(50.0), [true, false]);
    let casters = mesh.of_components(&casts);
    let onto = |z: f64| dvec2(1.3, (20.3 - z) / altitude.tan());
    // the plan looks through what does not receive: the ground alone, and the glass from above
    for (z, receivers) in [(0.0, casters.clone()), (17.1, mesh.clone())] {
        let (drawn_width, truth) = {
            let (edge, fall) = (onto(z), 20.3 - z);
            let expected = width(fall / altitude.sin()) / altitude.sin();
            let view = around(edge, 4.0 * expected);
            let scene = Scene { casters: casters.clone(), receivers, ground: 0.0 };
            let mask = draw(&mut smoothie(&scene, view, None), to_sun(180.0, 50.0));
            let reach = dvec2(0.0, 1.9 * expected);
            (soft_length(&mask, view, edge - reach, edge + reach), expected)
        };
        assert!((drawn_width / truth - 1.0).abs() < 0.1, "at {z} m: {drawn_width} instead of {truth}");
    }
    // from below the glass a camera sees the ground behind it, as seen from the sun: as wide as by rays to the disc
    let camera = gnomon::view::Camera {
        eye: dvec3(0.0, onto(0.0).y + 4.0, 3.0),
        target: onto(0.0).extend(0.0),
        up: DVec3::Z,
        fov_rad: 0.2,
        width: 60,
        height: 400,
    };
    let view = View::Camera(camera);
    let scene = Scene { casters, receivers: mesh, ground: 0.0 };
    let soft = |mask: Mask| mask.share.iter().filter(|share| !matches!(**share, 0 | 255)).count() as f64;
    let drawn = soft(draw(&mut smoothie(&scene, view, None), to_sun(180.0, 50.0)));
    let truth = soft(draw(&mut RayCast::new(scene, view, Some(256)), to_sun(180.0, 50.0)));
    println!("{drawn} soft cells instead of {truth}");
    assert!(truth > 2000.0 && (drawn / truth - 1.0).abs() < 0.1, "{drawn} soft cells instead of {truth}");
}
