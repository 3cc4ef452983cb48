//! A camera's picture with soft textures against rays to the same points of the sun's disc.

use crate::shared::dense::{cuboid, prism, to_sun};
use glam::{DVec3, dvec3};
use gnomon::choice::{Engine, Method};
use gnomon::cli::Options;
use gnomon::mesh::{Mesh, Part};
use gnomon::message::Worded;
use gnomon::shadow::ray_cast::RayCast;
use gnomon::shadow::soft_picture::SoftPicture;
use gnomon::shadow::{Scene, Technique};
use gnomon::site::Site;
use gnomon::study::{InstantWants, instant};
use gnomon::view::{Camera, Mask, View};
use std::ops::ControlFlow;

const SAMPLES: u32 = 48;

fn camera(eye: DVec3, target: DVec3) -> Camera {
    Camera { eye, target, up: DVec3::Z, fov_rad: 0.7, width: 480, height: 320 }
}

/// A house with a canopy, a mast and a round tank on the ground.
fn scene() -> Scene {
    let mut round = Part { name: "tank".into(), ..Part::default() };
    prism(&mut round, [dvec3(9.0, -4.0, 0.0), dvec3(9.0, -4.0, 4.0)], 48, [2.0, 2.0]);
    let mut mast = Part { name: "mast".into(), ..Part::default() };
    prism(&mut mast, [dvec3(-7.0, -6.0, 0.0), dvec3(-7.0, -6.0, 14.0)], 6, [0.15, 0.1]);
    let mut sheet = cuboid("sheet", dvec3(-12.0, -4.0, 0.0), dvec3(-11.9, 3.0, 2.5));
    sheet.triangles.truncate(5);
    let mesh = Mesh::build(vec![
        cuboid("house", dvec3(-5.0, 0.0, 0.0), dvec3(5.0, 7.0, 6.0)),
        cuboid("canopy", dvec3(-3.0, -3.0, 3.0), dvec3(3.0, 0.0, 3.2)),
        round,
        mast,
        sheet,
    ])
    .expect("a mesh");
    Scene { casters: mesh.clone(), receivers: mesh, ground: 0.0 }
}

fn drawn(technique: &mut dyn Technique, sun: DVec3) -> Mask {
    technique.draw(sun).expect("a mask").read().expect("a mask")
}

/// Pixels that differ where the truth is the same all around, and the mean difference of the others, in 1/255.
fn difference(truth: &Mask, found: &Mask) -> (usize, f64) {
    let (width, height) = (truth.width as i32, truth.height as i32);
    let at = |x: i32, y: i32| truth.share[(y.clamp(0, height - 1) * width + x.clamp(0, width - 1)) as usize];
    let (mut far, mut sum, mut near) = (0, 0.0, 0);
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        let off = at(x, y).abs_diff(found.share[(y * width + x) as usize]);
        let uniform = (-REACH..=REACH).all(|down| (-REACH..=REACH).all(|right| at(x + right, y + down) == at(x, y)));
        if uniform {
            far += usize::from(off > 0);
        } else {
            (sum, near) = (sum + f64::from(off), near + 1);
        }
    }
    (far, sum / f64::from(near.max(1)))
}

/// A texel is a pixel in the middle of the depth, and some pixels nearer to the eye.
const REACH: i32 = 4;

#[test]
fn a_picture_is_that_of_rays_to_the_disc() {
    let views = [(dvec3(16.0, -26.0, 13.0), dvec3(0.0, -1.0, 2.0)), (dvec3(-22.0, -16.0, 20.0), dvec3(-2.0, 0.0, 1.0))];
    for (eye, target) in views {
        let camera = camera(eye, target);
        let mut picture = SoftPicture::new(scene(), camera, SAMPLES);
        let mut rays = RayCast::new(scene(), View::Camera(camera), Some(SAMPLES));
        for sun in [to_sun(215.0, 36.0), to_sun(140.0, 14.0)] {
            let (truth, found) = (drawn(&mut rays, sun), drawn(&mut picture, sun));
            assert!(truth.share.iter().filter(|share| !matches!(share, 0 | 255)).count() > 300, "a penumbra is seen");
            let (far, near) = difference(&truth, &found);
            println!("{far} far, {near:.1} near of {}", truth.share.len());
            assert!(far * 2000 < truth.share.len(), "{far} pixels far from any penumbra differ");
            assert!(near < 20.0, "{near}/255 near edges");
            assert!(picture.note().expect("a note").contains("rays are cast there"), "the sheet has no outer side");
        }
        // the comparator sees a sun some degrees aside
        let (truth, aside) = (drawn(&mut rays, to_sun(215.0, 36.0)), drawn(&mut picture, to_sun(223.0, 33.0)));
        assert!(difference(&truth, &aside).0 * 500 > truth.share.len());
    }
}

#[test]
fn the_command_draws_it_for_a_camera_on_the_processor() {
    let mut site = super::hours::house();
    site.method = Method::SoftTexture;
    let view = View::Camera(camera(dvec3(16.0, -26.0, 13.0), DVec3::ZERO));
    let asked = |site: &Site, view| instant(site, view, &InstantWants::default(), &mut |_| ControlFlow::Continue(()));
    let default = asked(&site, view).expect("a picture");
    assert_eq!((default.drawn.technique, default.drawn.engine), (Method::SoftTexture, Engine::Cpu));
    assert!(default.mask.share.iter().any(|share| !matches!(share, 0 | 255)), "a penumbra is seen");
    site.settings.sun_samples = Some(64);
    assert_eq!(asked(&site, view).expect("a picture").mask, default.mask);
    site.settings.sun_samples = Some(8);
    assert_ne!(asked(&site, view).expect("a picture").mask, default.mask);
    for (view, engine, word) in
        [(View::Plan(site.grid), Engine::Auto, "does not draw the plan"), (view, Engine::Gpu, "on the cpu")]
    {
        let error = asked(&Site { engine, ..site.clone() }, view).expect_err("a conflict");
        assert!(error.is_wrong_use() && error.in_words(&Options).contains(word), "{error}");
    }
}

#[test]
fn what_is_flat_alone_needs_no_rays() {
    let mesh = Mesh::build(vec![cuboid("house", dvec3(-5.0, 0.0, 0.0), dvec3(5.0, 7.0, 6.0))]).expect("a mesh");
    let scene = Scene { casters: mesh.clone(), receivers: mesh, ground: 0.0 };
    let mut picture = SoftPicture::new(scene, camera(dvec3(16.0, -26.0, 13.0), DVec3::ZERO), SAMPLES);
    drawn(&mut picture, to_sun(215.0, 36.0));
    assert_eq!(picture.note(), None);
}
