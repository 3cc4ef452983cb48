//! The count is never wrong, not even where it exceeds 128 or 256, or where half of it does.

use super::masks;
use crate::shared::drawing::{plan, scene_of, to_sun};
use crate::shared::scenes::stack;
use glam::{DVec3, dvec3};
use gnomon::choice::Receivers;
use gnomon::mesh::Mesh;
use gnomon::shadow::Technique;
use gnomon::shadow::ray_cast::RayCast;
use gnomon::view::{Camera, Surface, View};

/// Counts around the powers of two that a count, its double or its half exceeds.
const PLATES: [u32; 12] = [127, 128, 129, 254, 255, 256, 257, 258, 510, 512, 514, 1024];

/// Closed slabs, or single sheets.
const THICKNESSES: [f64; 2] = [0.004, 0.0];

#[test]
fn on_the_plan() {
    for plates in PLATES {
        for thickness in THICKNESSES {
            let mesh = Mesh::build(vec![stack(plates, thickness)]).unwrap();
            for receivers in [Receivers::Ground, Receivers::Top] {
                let what = format!("{plates} plates of {thickness} m, {receivers:?}");
                let scene = scene_of(&mesh, receivers, 0.0);
                // high, and so low that only some of the plates lie above each other
                let suns = [to_sun(200.0, 70.0), to_sun(95.0, 9.0)];
                for (drawn, truth, difference) in masks(&scene, plan(12.0, 60), &suns) {
                    assert!(difference.holds(0.01), "{what}: {difference}");
                    assert!(truth.share.contains(&0) && drawn.share.contains(&255), "{what}");
                }
            }
        }
    }
}

#[test]
fn from_above_from_below_and_from_the_side() {
    let camera = |eye: DVec3, target: DVec3| Camera { eye, target, up: DVec3::Z, fov_rad: 1.0, width: 80, height: 60 };
    for plates in PLATES {
        let top = 1.0 + 0.01 * f64::from(plates);
        let cameras = [
            ("above", camera(dvec3(-14.0, 14.0, top + 8.0), dvec3(-2.0, 3.0, 0.0))),
            ("below", camera(dvec3(-3.0, -1.0, 0.5), dvec3(9.0, 7.0, 0.0))),
            ("the side", camera(dvec3(-13.0, 0.0, 2.0), dvec3(0.0, 6.0, 0.0))),
        ];
        for thickness in THICKNESSES {
            let mesh = Mesh::build(vec![stack(plates, thickness)]).unwrap();
            let scene = scene_of(&mesh, Receivers::Top, 0.0);
            for (from, camera) in cameras {
                let view = View::Camera(camera);
                let (drawn, truth, _) = masks(&scene, view, &[to_sun(140.0, 50.0)]).remove(0);
                // only the ground: a pixel holds many plates, and which one it sees is a matter of rounding
                let face = RayCast::new(scene.clone(), view, None).surface().unwrap().face;
                let ground = || (0..face.len()).filter(|&at| face[at] == Surface::GROUND);
                let wrong = ground().filter(|&at| drawn.share[at] != truth.share[at]).count();
                let dark = ground().filter(|&at| truth.share[at] == 0).count();
                let what = format!("{plates} plates of {thickness} m from {from}");
                assert!(wrong * 25 <= dark && dark > 50, "{what}: {wrong} of {dark} dark cells wrong");
            }
        }
    }
}
