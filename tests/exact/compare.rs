//! The comparison of masks itself detects differences.

use crate::shared::drawing::{plan, scene_of, to_sun};
use crate::shared::scenes::cuboid;
use glam::{DVec3, dvec3};
use gnomon::choice::Receivers;
use gnomon::mesh::Mesh;
use gnomon::shadow::Technique;
use gnomon::shadow::ray_cast::RayCast;
use gnomon::verification::Difference;
use gnomon::view::{Camera, Mask, View};

#[test]
fn one_wrong_cell_is_seen() {
    let truth = Mask { width: 40, height: 30, share: (0..1200).map(|at| if at % 40 < 20 { 0 } else { 255 }).collect() };
    let same = Difference::between(&truth, &truth);
    assert_eq!((same.edge_differ, same.other_differ, same.edge_cells), (0, 0, 60));
    for (at, edge) in [(10 * 40 + 19, 1), (10 * 40 + 5, 0)] {
        let mut wrong = truth.clone();
        wrong.share[at] = 255;
        let difference = Difference::between(&wrong, &truth);
        assert_eq!((difference.edge_differ, difference.other_differ), (edge, 1 - edge));
        assert_eq!((difference.edge_at.len(), difference.other_at.len()), (edge as usize, 1 - edge as usize));
    }
    let mut two_wrong = truth.clone();
    two_wrong.share[5] = 255;
    two_wrong.share[7] = 255;
    assert!(!Difference::between(&two_wrong, &truth).holds(0.01));
    let mut edge_wrong = truth.clone();
    edge_wrong.share[5 * 40 + 20] = 0;
    edge_wrong.share[9 * 40 + 20] = 0;
    let difference = Difference::between(&edge_wrong, &truth);
    assert!(difference.holds(0.04) && !difference.holds(0.02), "{difference}");
}

#[test]
fn only_what_is_thinner_than_a_cell_is_excepted() {
    let sun = to_sun(180.0, 45.0);
    let beam =
        |name: &str, x: f64, half: f64| cuboid(name, dvec3(x - half, -8.0, 4.0), dvec3(x + half, 8.0, 4.0 + half));
    let mesh = Mesh::build(vec![beam("wire", -3.1, 0.03), beam("beam", 4.0, 1.0)]).unwrap();
    let scene = scene_of(&mesh, Receivers::Ground, 0.0);
    // its picture shows the ground just as the plan does
    let from_above = Camera {
        eye: dvec3(0.0, 0.0, 40.0),
        target: DVec3::ZERO,
        up: DVec3::Y,
        fov_rad: 2.0 * 0.25f64.atan(),
        width: 200,
        height: 200,
    };
    for view in [plan(10.0, 200), View::Camera(from_above)] {
        let mut cast = RayCast::new(scene.clone(), view, None);
        let truth = cast.draw(sun).unwrap().read().unwrap();
        // beneath the wire, beneath the beam, and in the sun
        let mut wrong = truth.clone();
        for column in [69, 140, 190] {
            assert_eq!(truth.share[100 * 200 + column], if column == 140 { 0 } else { 255 });
            wrong.share[100 * 200 + column] ^= 255;
        }
        let mut difference = Difference::between(&wrong, &truth);
        assert_eq!((difference.edge_differ, difference.other_differ), (0, 3));
        difference.except_thin(&mut cast, view, sun).unwrap();
        assert_eq!(difference.other_at, [(140, 100), (190, 100)]);
        assert_eq!(difference.other_differ, 2);
        assert_eq!(cast.draw(sun).unwrap().read().unwrap(), truth, "it looks at the view again");
    }
}
