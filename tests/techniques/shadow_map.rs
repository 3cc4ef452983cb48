//! Shadow maps: the levels of each filter, the bias, and casters outside the view.

use super::{draw, site};
use crate::shared::drawing::{gpu, plan, scene_of, to_sun};
use crate::shared::far_wrong::far_wrong;
use crate::shared::scenes::{cuboid, sheet};
use glam::{DVec3, dvec3};
use gnomon::choice::{Filter, MAP_SIZE, Receivers};
use gnomon::cli::Options;
use gnomon::mesh::Mesh;
use gnomon::message::Worded;
use gnomon::shadow::ray_cast::RayCast;
use gnomon::shadow::shadow_map::ShadowMap;
use gnomon::shadow::{Scene, ShadowError};
use gnomon::view::{Grid, View};
use std::collections::BTreeSet;

const FILTERS: [(Filter, u32); 4] =
    [(Filter::None, 1), (Filter::TwoByTwo, 4), (Filter::FastTwoByTwo, 4), (Filter::FastFourByFour, 16)];

#[test]
fn filters_have_their_levels_and_no_others() {
    let plate = [dvec3(-7.1, -5.3, 6.0), dvec3(6.2, -6.4, 6.0), dvec3(8.3, 5.1, 6.0), dvec3(-5.4, 7.2, 6.0)];
    let scene = scene_of(&Mesh::build(vec![sheet(plate)]).unwrap(), Receivers::Ground, 0.0);
    for (filter, comparisons) in FILTERS {
        let mut map = ShadowMap::new(gpu(), &scene, plan(20.0, 600), 256, filter).unwrap();
        let levels: BTreeSet<u8> = draw(&mut map, to_sun(200.0, 50.0)).share.into_iter().collect();
        let expected: BTreeSet<u8> =
            (0..=comparisons).map(|seen| (255.0 * f64::from(seen) / f64::from(comparisons)).round() as u8).collect();
        assert_eq!(levels, expected, "{filter:?}");
    }
}

/// The day's suns of a site, and lower ones down to 10°.
fn suns(of_day: &[DVec3]) -> Vec<DVec3> {
    of_day.iter().step_by(3).copied().chain([to_sun(112.0, 10.0), to_sun(250.3, 17.0)]).collect()
}

#[test]
fn the_default_bias_leaves_neither_acne_nor_detached_shadows_on_the_sites() {
    for name in ["tower", "industry", "headquarters"] {
        let (top, view, of_day) = site(name, 400);
        let ground = Scene { receivers: top.receivers.of_components(&[]), ..top.clone() };
        for (judged, scene) in [("top", top), ("ground", ground)] {
            for (filter, _) in FILTERS {
                let of = (MAP_SIZE, filter);
                let wrong = far_wrong(&gpu(), &scene, view, &suns(&of_day), of, None).unwrap();
                println!("{name}, {judged}, {filter:?}: {:.3}% far wrong, {wrong:?}", 100.0 * wrong.share());
                assert!(wrong.share() <= 0.005, "{name}, {judged}, {filter:?}: {wrong:?}");
            }
        }
    }
}

#[test]
fn too_small_a_bias_is_seen_as_acne_and_too_large_a_one_as_light() {
    // a slope, and a thin wall on the ground
    let slope = [dvec3(-20.0, -20.0, 2.0), dvec3(20.0, -20.0, 2.0), dvec3(20.0, 0.0, 14.0), dvec3(-20.0, 0.0, 14.0)];
    let wall = cuboid("wall", dvec3(-15.0, 10.0, 0.0), dvec3(15.0, 10.2, 8.0));
    let scene = scene_of(&Mesh::build(vec![sheet(slope), wall]).unwrap(), Receivers::Top, 0.0);
    let suns = [to_sun(160.0, 24.0), to_sun(75.0, 31.0)];
    for (filter, _) in FILTERS {
        let of = (256, filter);
        let measured = |bias| far_wrong(&gpu(), &scene, plan(30.0, 300), &suns, of, bias).unwrap();
        let (none, fitting, huge) = (measured(Some(-1.0)), measured(None), measured(Some(60.0)));
        println!("{filter:?}: bias -1: {none:?}; as it is: {fitting:?}; 60 texels: {huge:?}");
        assert!(fitting.share() <= 0.005, "{filter:?}: {fitting:?}");
        assert!(none.darker > 20 * fitting.darker.max(10), "{filter:?}: acne is not seen: {none:?}");
        assert!(huge.lighter > 20 * fitting.lighter.max(10), "{filter:?}: detached shadows are not seen: {huge:?}");
    }
}

/// In a coarse map, the texels of the ground at a wall's foot contain the wall's own face. The part of it behind a
/// cell, as seen from the sun, must not shade the cell; the part in front of it may, since no texel can distinguish
/// them.
#[test]
fn a_lit_wall_shades_no_ground_before_it() {
    let wall = cuboid("wall", dvec3(-12.0, 0.0, 0.0), dvec3(12.0, 1.0, 10.0));
    // without it the map would end where the wall does
    let post = cuboid("post", dvec3(30.0, -37.3, 0.0), dvec3(30.3, -37.0, 1.0));
    let scene = scene_of(&Mesh::build(vec![wall, post]).unwrap(), Receivers::Ground, 0.0);
    let grid = Grid { west: -40.0, north: 40.0, cell: 0.2, width: 400, height: 400 };
    let (sin, cos) = f64::to_radians(40.0).sin_cos();
    let mut map = ShadowMap::new(gpu(), &scene, View::Plan(grid), 18, Filter::None).unwrap();
    let (mask, texel) = (draw(&mut map, to_sun(180.0, 40.0)), map.texel_m(to_sun(180.0, 40.0)));
    let half = f64::from(texel[1]) / 2.0;
    // a point of the wall lies half a texel higher at most, and before the cell if it is cot(40°) as high as that is far
    let most = half / (sin + cos * cos / sin);
    let darkest = (0..mask.share.len()).filter(|&at| mask.share[at] == 0).map(|at| {
        let centre = grid.centre(at as u32 % grid.width, at as u32 / grid.width);
        if centre.x.abs() < 10.0 { -centre.y } else { 0.0 }
    });
    let darkest = darkest.fold(0.0, f64::max);
    println!("texels of {texel:?} m; dark up to {darkest:.2} m before the wall, {most:.2} m expected");
    // without the rule it would be as far as half a texel is on the ground
    assert!(half > 0.6 && darkest <= most + 0.1 && most + 0.4 < half / sin, "{darkest} m instead of {most}");
}

#[test]
fn casters_outside_of_the_view_are_not_forgotten() {
    let mesh = Mesh::build(vec![cuboid("tower", dvec3(-5.0, -5.0, 0.0), dvec3(5.0, 5.0, 90.0))]).unwrap();
    let scene = scene_of(&mesh, Receivers::Top, 0.0);
    // north of the tower, which the view does not show
    let view = View::Plan(Grid { west: -30.0, north: 130.0, cell: 0.25, width: 240, height: 240 });
    let (mut map, mut truth) =
        (ShadowMap::new(gpu(), &scene, view, 1024, Filter::None).unwrap(), RayCast::new(scene.clone(), view, None));
    for sun in [to_sun(180.0, 40.0), to_sun(171.0, 33.0), to_sun(185.0, 12.0)] {
        let (drawn, right) = (draw(&mut map, sun), draw(&mut truth, sun));
        let dark = right.share.iter().filter(|share| **share == 0).count();
        let wrong = drawn.share.iter().zip(&right.share).filter(|(one, other)| one != other).count();
        assert!(dark > 2000 && wrong * 50 < dark, "{wrong} wrong of {dark} dark cells");
        // the map holds what can shade the view, and no more
        assert!(map.texel_m(sun).iter().all(|texel| *texel < 0.1), "{:?}", map.texel_m(sun));
    }
}

#[test]
fn a_map_that_no_adapter_draws_is_refused() {
    let scene = scene_of(&Mesh::build(vec![]).unwrap(), Receivers::Top, 0.0);
    let refused = ShadowMap::new(gpu(), &scene, plan(5.0, 20), 1 << 20, Filter::None).err();
    let Some(error @ ShadowError::MapTooLarge { .. }) = refused else { panic!("not refused") };
    assert!(error.in_words(&Options).contains("--map-size"), "{error}");
}

#[test]
fn without_casters_or_far_from_them_all_is_light() {
    let nothing = scene_of(&Mesh::build(vec![]).unwrap(), Receivers::Top, 0.0);
    let tower = Mesh::build(vec![cuboid("tower", dvec3(-5.0, -5.0, 0.0), dvec3(5.0, 5.0, 9.0))]).unwrap();
    let far = View::Plan(Grid { west: 5000.0, north: 5000.0, cell: 1.0, width: 30, height: 30 });
    for (scene, view) in [(nothing, plan(10.0, 30)), (scene_of(&tower, Receivers::Top, 0.0), far)] {
        for (filter, _) in FILTERS {
            let mut map = ShadowMap::new(gpu(), &scene, view, 256, filter).unwrap();
            assert!(draw(&mut map, to_sun(140.0, 30.0)).share.iter().all(|share| *share == 255), "{filter:?}");
        }
    }
}

/// A filter blurs an edge equally to both sides: if the four maps of 2×2 were drawn off to one side, this test would
/// show it. (An edge along a row of texels can be half a texel off; with these suns there is none.)
#[test]
fn no_filter_moves_an_edge() {
    let plate = [dvec3(-7.1, -5.3, 6.0), dvec3(6.2, -6.4, 6.0), dvec3(8.3, 5.1, 6.0), dvec3(-5.4, 7.2, 6.0)];
    let scene = scene_of(&Mesh::build(vec![sheet(plate)]).unwrap(), Receivers::Ground, 0.0);
    let view = plan(16.0, 1000);
    let View::Plan(grid) = view else { panic!("a plan") };
    for sun in [to_sun(200.0, 50.0), to_sun(163.0, 44.0)] {
        let corners = plate.map(|corner| (corner - sun * (corner.z / sun.z)).truncate());
        for (filter, _) in FILTERS {
            let mut map = ShadowMap::new(gpu(), &scene, view, 256, filter).unwrap();
            let mask = draw(&mut map, sun);
            let texel = f64::from(map.texel_m(sun).into_iter().fold(0.0, f32::max)) / sun.z;
            for index in 0..4 {
                let (from, to) = (corners[index], corners[(index + 1) % 4]);
                let along = (to - from).normalize();
                let (reach, length) = (4.0 * texel, from.distance(to));
                // what of a band around the edge is dark, away from the corners: half of it
                let (mut dark, mut cells) = (0.0, 0);
                for (at, share) in mask.share.iter().enumerate() {
                    let centre = grid.centre(at as u32 % grid.width, at as u32 / grid.width) - from;
                    let (on, beside) = (centre.dot(along), centre.perp_dot(along));
                    if on > reach && on < length - reach && beside.abs() < reach {
                        dark += 1.0 - f64::from(*share) / 255.0;
                        cells += 1;
                    }
                }
                let moved = (2.0 * dark / f64::from(cells) - 1.0) * reach / texel;
                println!("{filter:?}, edge {index}: moved by {moved:.3} texels, {cells} cells");
                assert!(cells > 1000 && moved.abs() < 0.1, "{filter:?}, edge {index}: moved by {moved} texels");
            }
        }
    }
}
