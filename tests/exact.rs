//! Stencil shadow volumes against ray casting, as the design defines exactness, and both against closed forms.

mod beams;
mod cameras;
mod compare;
mod counts;
pub(crate) mod dirty;

use crate::shared::drawing::{day, gpu, plan, scene_of, to_sun};
use crate::shared::scenes::*;
use glam::{DVec3, dvec3};
use gnomon::choice::Receivers;
use gnomon::mesh::{Mesh, Part};
use gnomon::shadow::ray_cast::RayCast;
use gnomon::shadow::stencil::Stencil;
use gnomon::shadow::{Scene, Technique};
use gnomon::silhouette::ProcessorFinder;
use gnomon::site::{Overrides, Site};
use gnomon::verification::Difference;
use gnomon::view::{Camera, Mask, View};

/// For each sun the stencil's mask, the truth's, and how they differ.
fn masks(scene: &Scene, view: View, suns: &[DVec3]) -> Vec<(Mask, Mask, Difference)> {
    let mut stencil = Stencil::new(gpu(), scene.clone(), view, ProcessorFinder::BruteForce).unwrap();
    let mut truth = RayCast::new(scene.clone(), view, None);
    let both = |&sun: &DVec3| {
        let [drawn, cast] =
            [&mut stencil as &mut dyn Technique, &mut truth].map(|it| it.draw(sun).unwrap().read().unwrap());
        let mut difference = Difference::between(&drawn, &cast);
        difference.except_thin(&mut truth, view, sun).unwrap();
        (drawn, cast, difference)
    };
    suns.iter().map(both).collect()
}

/// Holds stencil against ray casting for several suns; `edge_share` is what part of the edge cells may differ.
fn agree(name: &str, scene: &Scene, view: View, suns: &[DVec3], edge_share: f64) {
    let mut total = Difference::default();
    masks(scene, view, suns).into_iter().for_each(|(_, _, difference)| total.add(difference));
    println!("{name}: {total}");
    assert!(total.edge_cells > 0, "{name}: no shadow edge in view");
    assert!(total.holds(edge_share), "{name}: {total}");
}

#[test]
fn small_solids_agree_with_ray_casting() {
    for (name, parts) in small() {
        let mesh = Mesh::build(parts).unwrap();
        for receivers in [Receivers::Ground, Receivers::Top] {
            let edge_share = if receivers == Receivers::Top { 0.01 } else { 0.005 };
            agree(
                &format!("{name} {receivers:?}"),
                &scene_of(&mesh, receivers, 0.0),
                plan(40.371_93, 700),
                &day(),
                edge_share,
            );
        }
    }
}

#[test]
fn the_sites_agree_with_ray_casting() {
    for name in ["tower", "industry", "headquarters"] {
        for receivers in [Receivers::Ground, Receivers::Top] {
            let asked = Overrides { receivers: Some(receivers), size: Some(703), ..Overrides::default() };
            let site = Site::load(std::path::Path::new(&format!("sites/{name}")), &asked).unwrap();
            let all = site.mesh.of_components(&site.receives);
            let scene =
                Scene { casters: site.mesh.of_components(&site.casts), ..scene_of(&all, receivers, site.ground.level) };
            let instants = site.track.instants.iter().filter(|instant| !instant.night);
            let suns: Vec<DVec3> = instants.map(|instant| instant.to_sun).step_by(3).collect();
            let edge_share = if receivers == Receivers::Top { 0.01 } else { 0.005 };
            agree(&format!("{name} {receivers:?}"), &scene, View::Plan(site.grid), &suns, edge_share);
            // the site's own cells, on whose centres walls stand in long rows
            let own = Overrides { receivers: Some(receivers), ..Overrides::default() };
            let grid = Site::load(std::path::Path::new(&format!("sites/{name}")), &own).unwrap().grid;
            agree(&format!("{name} {receivers:?}, own cells"), &scene, View::Plan(grid), &suns[1..2], edge_share);
        }
        let site = Site::load(std::path::Path::new(&format!("sites/{name}")), &Overrides::default()).unwrap();
        let scene = Scene {
            casters: site.mesh.of_components(&site.casts),
            ..scene_of(&site.mesh, Receivers::Top, site.ground.level)
        };
        let camera = Camera { width: 640, height: 400, ..site.camera };
        let suns: Vec<DVec3> = site.track.instants.iter().map(|instant| instant.to_sun).step_by(4).collect();
        agree(&format!("{name} camera"), &scene, View::Camera(camera), &suns, 0.01);
    }
}

#[test]
fn a_box_casts_height_over_tangent() {
    let (height, altitude) = (20.0, 33.0f64);
    let mesh = Mesh::build(vec![cuboid("box", dvec3(-5.0, -5.0, 0.0), dvec3(5.0, 5.0, height))]).unwrap();
    let scene = scene_of(&mesh, Receivers::Ground, 0.0);
    let view = plan(50.0, 1000);
    for (drawn, truth, _) in masks(&scene, view, &[to_sun(180.0, altitude)]) {
        for mask in [drawn, truth] {
            // the column through the box's middle, north of its northern wall (sun in the south)
            let dark = (0..450).filter(|row| mask.share[row * 1000 + 500] == 0).count();
            let expected = height / altitude.to_radians().tan() / 0.1;
            assert!((dark as f64 - expected).abs() <= 1.0, "{dark} cells, not {expected:.1}");
        }
    }
}

#[test]
fn a_slab_in_the_ground_plane_leaves_the_ground_lit() {
    let slab = cuboid("slab", dvec3(-5.0, -5.0, -0.4), dvec3(5.0, 5.0, 0.0005));
    let mesh = Mesh::build(vec![slab]).unwrap();
    for receivers in [Receivers::Ground, Receivers::Top] {
        for (drawn, truth, _) in masks(&scene_of(&mesh, receivers, 0.0), plan(10.0, 200), &day()) {
            assert!(drawn.share.iter().all(|&share| share == 255), "stencil, {receivers:?}");
            assert!(truth.share.iter().all(|&share| share == 255), "ray casting, {receivers:?}");
        }
    }
}

#[test]
fn what_faces_away_is_in_shadow_whatever_its_winding() {
    // a roof that leans away from a low sun, wound both ways
    for flip in [false, true] {
        let mut roof = Part {
            name: "roof".into(),
            positions: vec![dvec3(-8.0, 0.0, 9.0), dvec3(8.0, 0.0, 9.0), dvec3(8.0, 9.0, 3.0), dvec3(-8.0, 9.0, 3.0)],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            ..Part::default()
        };
        if flip {
            roof.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        }
        let mesh = Mesh::build(vec![roof]).unwrap();
        for (drawn, truth, _) in masks(&scene_of(&mesh, Receivers::Top, 0.0), plan(10.0, 100), &[to_sun(180.0, 20.0)]) {
            for mask in [drawn, truth] {
                assert_eq!(mask.share[30 * 100 + 50], 0);
                assert_eq!(mask.share[80 * 100 + 50], 255);
            }
        }
    }
}
