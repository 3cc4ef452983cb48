//! Cameras that move through shadows, walls and casters: z-pass where it is right, z-fail everywhere else.

use crate::shared::drawing::{crossing, gpu, scene_of, to_sun};
use crate::shared::scenes::sheet;
use glam::{DVec3, dvec3};
use gnomon::choice::Receivers;
use gnomon::mesh::Mesh;
use gnomon::shadow::near_clip::near_clip_volume_touched;
use gnomon::shadow::ray_cast::RayCast;
use gnomon::shadow::stencil::Stencil;
use gnomon::shadow::{Scene, Technique};
use gnomon::silhouette::ProcessorFinder;
use gnomon::verification::Difference;
use gnomon::view::{Camera, View};

fn camera(eye: DVec3, target: DVec3) -> Camera {
    Camera { eye, target, up: DVec3::Z, fov_rad: 1.2, width: 160, height: 100 }
}

/// Walks from one point to another, looking at a third.
fn walk(from: DVec3, to: DVec3, steps: u32, target: DVec3) -> Vec<Camera> {
    (0..steps).map(|step| camera(from.lerp(to, (f64::from(step) + 0.37) / f64::from(steps)), target)).collect()
}

/// How each camera's mask, drawn as chosen or as forced, differs from the truth, and whether z-fail is right for it.
fn differences(scene: &Scene, sun: DVec3, cameras: &[Camera], forced: Option<bool>) -> Vec<(bool, Difference)> {
    let mut truth = RayCast::new(scene.clone(), View::Camera(cameras[0]), None);
    let of = |&camera: &Camera| {
        let view = View::Camera(camera);
        let mut stencil = Stencil::new(gpu(), scene.clone(), view, ProcessorFinder::BruteForce).unwrap();
        if let Some(z_fail) = forced {
            stencil.force_z_fail(z_fail);
        }
        truth.look_at(view);
        let cast = truth.draw(sun).unwrap().read().unwrap();
        let mut difference = Difference::between(&stencil.draw(sun).unwrap().read().unwrap(), &cast);
        difference.except_thin(&mut truth, view, sun).unwrap();
        (near_clip_volume_touched(&camera, sun, &scene.casters), difference)
    };
    cameras.iter().map(of).collect()
}

/// Each picture agrees with the truth. Returns for how many z-fail was chosen.
fn agree(name: &str, cameras: &[Camera], sun: DVec3) -> usize {
    let scene = crossing();
    let differences = differences(&scene, sun, cameras, None);
    let mut total = Difference::default();
    for ((z_fail, difference), camera) in differences.iter().zip(cameras) {
        // a small picture has few edge cells: some of them may always differ
        let holds = difference.holds(0.02) || difference.edge_differ <= 5 && difference.other_differ == 0;
        assert!(holds, "{name}, eye {}, z-fail {z_fail}: {difference}", camera.eye);
        total.add(difference.clone());
    }
    println!("{name}: {total}");
    assert!(total.edge_cells > 400 && total.holds(0.01), "{name}: {total}");
    differences.iter().filter(|(z_fail, _)| *z_fail).count()
}

#[test]
fn through_shadows_and_their_walls() {
    // behind the three casters, from the light through every shadow and out again
    let along = walk(dvec3(-40.0, 20.0, 2.0), dvec3(40.0, 17.0, 2.0), 34, dvec3(0.0, 0.0, 6.0));
    let z_fails = agree("along", &along, to_sun(180.0, 40.0));
    assert!(z_fails > 2 && z_fails + 2 < along.len(), "both ways of counting must occur: {z_fails}");
    // into the tower's shadow from above and through the ground
    let down = walk(dvec3(1.0, 25.0, 40.0), dvec3(2.0, 18.0, -3.0), 18, dvec3(0.0, 0.0, 8.0));
    let z_fails = agree("down", &down, to_sun(190.0, 35.0));
    assert!(z_fails > 2 && z_fails + 2 < down.len(), "both ways of counting must occur: {z_fails}");
}

#[test]
fn through_casters_that_the_near_plane_cuts() {
    // through the slab and the tower, below the sheet and through it
    let casters = walk(dvec3(-20.0, 3.0, 4.0), dvec3(22.0, 1.0, 5.6), 34, dvec3(40.0, -3.0, 1.0));
    let z_fails = agree("casters", &casters, to_sun(230.0, 33.0));
    assert!(z_fails > 2 && z_fails + 2 < casters.len(), "both ways of counting must occur: {z_fails}");
    // in steps of two centimetres through the tower's border in the air, with the near plane five before the eye
    let border = walk(dvec3(5.8, 0.4, 12.0), dvec3(6.3, 0.3, 12.0), 20, dvec3(19.0, 3.0, 6.0));
    assert!(agree("border", &border, to_sun(100.0, 20.0)) > 2);
}

#[test]
fn the_wrong_way_of_counting_is_seen_to_fail_and_z_fail_is_always_right() {
    let (scene, sun) = (crossing(), to_sun(180.0, 40.0));
    let cameras = walk(dvec3(-40.0, 20.0, 2.0), dvec3(40.0, 17.0, 2.0), 12, dvec3(0.0, 0.0, 6.0));
    let mut failures = 0;
    for (z_fail, difference) in differences(&scene, sun, &cameras, Some(false)) {
        assert!(z_fail || difference.holds(0.02), "z-pass was right: {difference}");
        failures += usize::from(!difference.holds(0.02));
    }
    assert!(failures > 1, "z-pass inside of shadows must be wrong");
    for (_, difference) in differences(&scene, sun, &cameras, Some(true)) {
        assert!(difference.holds(0.02), "z-fail is always right: {difference}");
    }
}

/// A walk below the ground, along receivers that stand there, agrees with the truth; z-pass alone would not.
#[test]
fn below_the_ground_and_below_every_receiver() {
    let (wall, blind) = (dvec3(-10.0, 0.0, -5.0), dvec3(-2.0, -3.0, -4.0));
    let [wall, blind] = [(wall, dvec3(10.0, 0.0, -0.5)), (blind, dvec3(2.0, -4.0, -1.0))]
        .map(|(low, high)| sheet([low, dvec3(high.x, low.y, low.z), high, dvec3(low.x, high.y, high.z)]));
    let mesh = Mesh::build(vec![wall, blind]).unwrap();
    let scene = scene_of(&mesh, Receivers::Top, 0.0);
    let sun = to_sun(200.0, 30.0);
    // from below the receivers upwards; and beside them downwards, where the sky is
    let mut cameras = walk(dvec3(-6.0, -12.0, -15.0), dvec3(6.0, -6.0, -12.0), 6, dvec3(0.0, 0.0, -3.0));
    cameras.extend(walk(dvec3(-6.0, -9.0, -0.5), dvec3(6.0, -9.0, -2.0), 6, dvec3(0.0, 1.0, -7.0)));
    for (_, difference) in differences(&scene, sun, &cameras, None) {
        assert!(difference.holds(0.02), "{difference}");
    }
    let z_pass = differences(&scene, sun, &cameras, Some(false));
    for half in z_pass.chunks(6) {
        assert!(half.iter().any(|(_, difference)| !difference.holds(0.02)), "z-pass must be wrong somewhere");
    }
}
