//! Stencil shadow volumes against ray casting, as the design defines exactness, and both against closed forms.

mod compare;
pub(crate) mod scenes;

use compare::{Difference, compare};
use glam::{DVec3, dvec3};
use gnomon::gpu::Gpu;
use gnomon::mesh::{Mesh, Part};
use gnomon::shadow::ray_cast::RayCast;
use gnomon::shadow::stencil::Stencil;
use gnomon::shadow::{Scene, Technique};
use gnomon::silhouette::Kind;
use gnomon::site::{Overrides, Receivers, Site};
use gnomon::view::{Camera, Grid, Mask, Surface, View};
use scenes::*;
use std::sync::{Arc, OnceLock};

/// The adapter for all tests. None is a failure, never a skip.
pub(crate) fn gpu() -> Arc<Gpu> {
    static GPU: OnceLock<Arc<Gpu>> = OnceLock::new();
    Arc::clone(GPU.get_or_init(|| Arc::new(Gpu::open().expect("the tests need a graphics adapter: run tests/run.sh"))))
}

fn masks(scene: &Scene, view: View, suns: &[DVec3]) -> Vec<(Mask, Mask)> {
    let mut stencil = Stencil::new(gpu(), scene.clone(), view, Kind::BruteForce).unwrap();
    let mut truth = RayCast::new(scene.clone(), view);
    suns.iter()
        .map(|&sun| (stencil.draw(sun).unwrap().read().unwrap(), truth.draw(sun).unwrap().read().unwrap()))
        .collect()
}

/// Holds stencil against ray casting for several suns; `edge_share` is what part of the edge cells may differ.
fn agree(name: &str, scene: &Scene, view: View, suns: &[DVec3], edge_share: f64) {
    let mut total = Difference::default();
    for ((drawn, truth), &sun) in masks(scene, view, suns).into_iter().zip(suns) {
        let mut difference = compare(&drawn, &truth);
        except_thin(&mut difference, scene, view, sun);
        total.add(difference);
    }
    println!("{name}: {total}");
    assert!(total.edge_cells > 0, "{name}: no shadow edge in view");
    assert!(total.holds(edge_share), "{name}: {total}");
}

/// Drops the cells at which a shadow or a sunlit spot thinner than a cell lies, which the design excepts: the
/// neighbourhood in the truth, cast again in finer cells, is not uniform.
fn except_thin(difference: &mut Difference, scene: &Scene, view: View, sun: DVec3) {
    let truth = |view: View| RayCast::new(scene.clone(), view).draw(sun).unwrap().read().unwrap();
    let uniform = |shares: Vec<u8>| shares.iter().all(|&share| share == shares[0]);
    match view {
        _ if difference.other_at.is_empty() => (),
        View::Plan(grid) => difference.other_at.retain(|&(column, row)| {
            let corner = grid.centre(column, row) + glam::dvec2(-1.5, 1.5) * grid.cell;
            let fine = Grid { west: corner.x, north: corner.y, cell: grid.cell / 8.0, width: 24, height: 24 };
            uniform(truth(View::Plan(fine)).share)
        }),
        View::Camera(camera) => {
            let fine = truth(View::Camera(Camera { width: camera.width * 5, height: camera.height * 5, ..camera }));
            difference.other_at.retain(|&(column, row)| {
                let rows = (row.max(1) - 1) * 5..((row + 2) * 5).min(fine.height);
                let columns = (column.max(1) - 1) * 5..((column + 2) * 5).min(fine.width);
                let at = |row: u32| columns.clone().map(move |column| (row * camera.width * 5 + column) as usize);
                uniform(rows.flat_map(at).map(|at| fine.share[at]).collect())
            });
        }
    }
    difference.other_differ = difference.other_at.len() as u64;
}

pub(crate) fn scene_of(mesh: &Mesh, receivers: Receivers, ground: f64) -> Scene {
    let none = vec![false; mesh.components.len()];
    let receivers = match receivers {
        Receivers::Top => mesh.clone(),
        Receivers::Ground => mesh.of_components(&none),
    };
    Scene { casters: mesh.clone(), receivers, ground }
}

pub(crate) fn plan(half: f64, cells: u32) -> View {
    View::Plan(Grid { west: -half, north: half, cell: 2.0 * half / f64::from(cells), width: cells, height: cells })
}

pub(crate) fn to_sun(azimuth_deg: f64, altitude_deg: f64) -> DVec3 {
    let (azimuth, altitude) = (azimuth_deg.to_radians(), altitude_deg.to_radians());
    dvec3(azimuth.sin() * altitude.cos(), azimuth.cos() * altitude.cos(), altitude.sin())
}

pub(crate) fn day() -> Vec<DVec3> {
    [(95.3, 3.1), (130.7, 24.4), (171.2, 51.9), (214.6, 38.8), (263.1, 9.7)].map(|(az, alt)| to_sun(az, alt)).to_vec()
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
                Scene { casters: site.mesh.of_components(&site.casts), ..scene_of(&all, receivers, site.ground) };
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
            ..scene_of(&site.mesh, Receivers::Top, site.ground)
        };
        let camera = Camera { width: 640, height: 400, ..site.camera };
        let suns: Vec<DVec3> = site.track.instants.iter().map(|instant| instant.to_sun).step_by(4).collect();
        agree(&format!("{name} camera"), &scene, View::Camera(camera), &suns, 0.01);
    }
}

#[test]
fn cameras_inside_and_outside_of_shadows_agree_with_ray_casting() {
    let mesh = Mesh::build(vec![cuboid("tower", dvec3(-6.0, -6.0, 0.0), dvec3(6.0, 6.0, 30.0))]).unwrap();
    let scene = scene_of(&mesh, Receivers::Top, 0.0);
    let sun = to_sun(180.0, 40.0);
    let mut kinds = [0, 0];
    for step in 0..16 {
        // walks from the light through the shadow behind the tower and out again
        let eye = dvec3(-40.0 + 5.0 * f64::from(step), 20.0, 2.0);
        let target = dvec3(0.0, 0.0, 6.0);
        let camera = Camera { eye, target, up: DVec3::Z, fov_rad: 1.2, width: 320, height: 200 };
        let z_fail = gnomon::shadow::stencil::near_clip_volume_touched(&camera, sun, &scene.casters);
        kinds[usize::from(z_fail)] += 1;
        let (drawn, truth) = masks(&scene, View::Camera(camera), &[sun]).remove(0);
        let difference = compare(&drawn, &truth);
        assert!(difference.holds(0.02), "eye {eye}: {difference}");
    }
    assert!(kinds[0] > 2 && kinds[1] > 2, "both ways of counting must occur: {kinds:?}");
}

#[test]
fn the_count_is_never_wrong() {
    for plates in [127, 128, 129, 255, 256, 257, 512] {
        for thickness in [0.0, 0.004] {
            let mesh = Mesh::build(vec![stack(plates, thickness)]).unwrap();
            let scene = scene_of(&mesh, Receivers::Ground, 0.0);
            let (drawn, truth) = masks(&scene, plan(10.0, 100), &[to_sun(200.0, 70.0)]).remove(0);
            let below = drawn.share[50 * 100 + 52];
            assert_eq!(below, 0, "{plates} plates of {thickness} m let the sun through");
            assert!(compare(&drawn, &truth).holds(0.01), "{plates} plates of {thickness} m");
            let camera = Camera {
                eye: dvec3(9.0, -12.0, 4.0),
                target: DVec3::ZERO,
                up: DVec3::Z,
                fov_rad: 1.0,
                width: 160,
                height: 120,
            };
            let scene = scene_of(&mesh, Receivers::Top, 0.0);
            let (drawn, truth) = masks(&scene, View::Camera(camera), &[to_sun(140.0, 50.0)]).remove(0);
            // only the ground: a pixel holds many plates, and which one it sees is a matter of rounding
            let face = RayCast::new(scene, View::Camera(camera)).surface().unwrap().face;
            let other = |at: usize| face[at] == Surface::GROUND && drawn.share[at] != truth.share[at];
            let wrong = (0..face.len()).filter(|&at| other(at)).count();
            let dark = (0..face.len()).filter(|&at| face[at] == Surface::GROUND && truth.share[at] == 0).count();
            assert!(wrong < 20 && dark > 300, "{plates} plates of {thickness} m: {wrong} of {dark} dark cells wrong");
        }
    }
}

#[test]
fn a_box_casts_height_over_tangent() {
    let (height, altitude) = (20.0, 33.0f64);
    let mesh = Mesh::build(vec![cuboid("box", dvec3(-5.0, -5.0, 0.0), dvec3(5.0, 5.0, height))]).unwrap();
    let scene = scene_of(&mesh, Receivers::Ground, 0.0);
    let view = plan(50.0, 1000);
    for (drawn, truth) in masks(&scene, view, &[to_sun(180.0, altitude)]) {
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
        for (drawn, truth) in masks(&scene_of(&mesh, receivers, 0.0), plan(10.0, 200), &day()) {
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
        for (drawn, truth) in masks(&scene_of(&mesh, Receivers::Top, 0.0), plan(10.0, 100), &[to_sun(180.0, 20.0)]) {
            for mask in [drawn, truth] {
                assert_eq!(mask.share[30 * 100 + 50], 0);
                assert_eq!(mask.share[80 * 100 + 50], 255);
            }
        }
    }
}
