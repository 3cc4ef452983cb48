//! At every point the volume counts the faces between it and the light, and no count exceeds its bound.

use super::{light, modelled, soup, sphere};
use crate::shared::scenes::{cuboid, stack};
use glam::{DVec3, DVec4, dvec3, dvec4};
use gnomon::mesh::Mesh;
use gnomon::shadow::ray_cast::RayCaster;
use gnomon::silhouette::brute_force::BruteForce;
use gnomon::volume::{Volume, layers_bound};
use proptest::prelude::*;
use std::f64::consts::TAU;

/// How many times farther than the mesh its volume reaches.
const FAR: f64 = 1e6;

/// How often the volume, cut off far away, winds around a point: its solid angle over that of the whole sphere
/// (van Oosterom and Strackee, 1983).
fn winding(mesh: &Mesh, volume: &Volume, light: DVec4, point: DVec3) -> f64 {
    let near = |vertex: u32| mesh.vertices[vertex as usize].as_dvec3();
    let far = |vertex: u32| match light.w {
        0.0 => near(vertex) - light.truncate() * FAR,
        _ => light.truncate() + (near(vertex) - light.truncate()) * FAR,
    };
    let angle = |corners: [DVec3; 3]| {
        let [a, b, c] = corners.map(|corner| (corner - point).normalize());
        2.0 * a.dot(b.cross(c)).atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a))
    };
    let walls = volume.walls.iter().flat_map(|&edge| Volume::wall(edge));
    let walls: f64 =
        walls.map(|wall| angle(wall.map(|(vertex, end)| if end { far(vertex) } else { near(vertex) }))).sum();
    let light_cap: f64 = volume.light_cap.iter().map(|face| angle(face.map(near))).sum();
    let dark_cap: f64 = volume.light_cap.iter().map(|&[a, b, c]| angle([a, c, b].map(far))).sum();
    (walls + light_cap + dark_cap) / (2.0 * TAU)
}

/// The faces between a point and the light.
fn between(caster: &RayCaster, light: DVec4, point: DVec3) -> usize {
    if light.w == 0.0 {
        return caster.crossings(point, light.truncate());
    }
    let towards = light.truncate() - point;
    caster.crossings(point, towards) - caster.crossings(light.truncate(), towards)
}

/// Compares the winding number with rays at some points, and counts how many have any face above them.
fn check(name: &str, mesh: &Mesh, light: DVec4, points: &[DVec3]) -> usize {
    let caster = RayCaster::new(mesh, 100.0);
    let volume = Volume::find(mesh, &mut BruteForce, light, true);
    let mut shaded = 0;
    for &point in points {
        let count = between(&caster, light, point);
        let winding = winding(mesh, &volume, light, point);
        assert!((winding - count as f64).abs() < 1e-4, "{name}: {winding} is not {count} at {point} under {light}");
        shaded += usize::from(count > 0);
    }
    shaded
}

/// Points all over a cube around the mesh's origin, on no round numbers.
fn points(count: u32, half: f64) -> Vec<DVec3> {
    // a lattice of three irrational steps
    let place = |at: u32, step: f64| ((f64::from(at) * step).fract() * 2.0 - 1.0) * half;
    (1..=count)
        .map(|at| dvec3(place(at, 0.819_172_513_396), place(at, 0.671_043_606_703), place(at, 0.549_700_477_901)))
        .collect()
}

#[test]
fn modelled_volumes_count_faces_towards_the_light() {
    for (name, mesh) in modelled() {
        for light in [dvec4(0.311, 0.223, 0.834, 0.0), dvec4(-0.812, 0.113, 0.357, 0.0), dvec4(3.17, -2.21, 12.43, 1.0)]
        {
            let shaded = check(name, &mesh, light, &points(300, 12.0));
            assert!(shaded > 10, "{name}: {shaded} points in shadow");
        }
    }
}

#[test]
fn a_volume_that_lacks_something_counts_wrongly() {
    let mesh = Mesh::build(vec![cuboid("box", dvec3(-3.0, -4.0, -2.0), dvec3(3.0, 4.0, 2.0))]).unwrap();
    let (light, point) = (dvec4(0.31, 0.22, 0.83, 0.0), dvec3(-0.7, -0.4, -6.1));
    let whole = Volume::find(&mesh, &mut BruteForce, light, true);
    assert!((winding(&mesh, &whole, light, point) - 2.0).abs() < 1e-6);
    for lost in 0..whole.walls.len() {
        let mut less = whole.clone();
        less.walls.remove(lost);
        assert!((winding(&mesh, &less, light, point) - 2.0).abs() > 1e-3);
        let mut turned = whole.clone();
        turned.walls[lost].reverse();
        assert!((winding(&mesh, &turned, light, point) - 2.0).abs() > 1e-3);
    }
}

/// The bound is at least any count that rays find. Returns how much larger it is than the greatest.
fn hold_bound(name: &str, mesh: &Mesh, to_sun: DVec3, points: &[DVec3]) -> (u32, u32) {
    let caster = RayCaster::new(mesh, 1000.0);
    let most = points.iter().map(|&point| caster.crossings(point, to_sun)).max().unwrap_or(0) as u32;
    let bound = layers_bound(mesh, to_sun);
    assert!(bound >= most, "{name}: {most} faces, and a bound of {bound}");
    (bound, most)
}

#[test]
fn the_bound_of_layers_is_near_the_truth() {
    let suns = [dvec3(0.0, 0.0, 1.0), dvec3(0.211, -0.137, 0.913), dvec3(0.71, 0.33, 0.15)];
    for sun in suns {
        let plates = Mesh::build(vec![stack(300, 0.0)]).unwrap();
        let few = Mesh::build(vec![stack(10, 0.0)]).unwrap();
        // as far from the sun as there are plates above: near the lowest plate's middle and outwards
        let beneath: Vec<DVec3> = points(4000, 4.0).iter().map(|at| at.with_z(-2.0) - sun * 0.5).collect();
        let (bound, most) = hold_bound("plates", &plates, sun, &beneath);
        assert!(bound <= 600, "a plate is two triangles, and the bound {bound}");
        if sun.z > 0.5 {
            assert_eq!(most, 300);
            assert!(bound >= 300);
            assert!(layers_bound(&few, sun) < most, "another mesh's bound does not hold");
        }
        let cube = Mesh::build(vec![cuboid("box", dvec3(-5.0, -4.0, 0.0), dvec3(5.0, 4.0, 9.0))]).unwrap();
        let (bound, most) = hold_bound("box", &cube, sun, &points(2000, 9.0));
        assert!(most >= 2 && bound <= 12, "{bound}");
        let ball = Mesh::build(vec![sphere(7.0, 200, 100)]).unwrap();
        let (bound, most) = hold_bound("sphere", &ball, sun, &points(500, 7.0));
        // a pole's fan of 200 triangles lies in one cell
        assert!(most >= 2 && bound <= 400, "{bound} of {}", ball.faces.len());
    }
    assert_eq!(layers_bound(&Mesh::build(Vec::new()).unwrap(), DVec3::Z), 0);
}

#[test]
fn the_sites_bounds_hold() {
    for (name, mesh) in modelled() {
        for sun in [dvec3(0.311, 0.223, 0.834), dvec3(-0.95, 0.2, 0.05), DVec3::Z] {
            let (bound, _) = hold_bound(name, &mesh, sun, &points(3000, 20.0));
            assert!(bound <= mesh.faces.len() as u32);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn any_volume_counts_faces_towards_the_light(mesh in soup(), light in light()) {
        check("soup", &mesh, light, &points(40, 9.0));
    }

    #[test]
    fn no_ray_crosses_more_faces_than_the_bound(mesh in soup(), sun in light()) {
        let sun = sun.truncate();
        prop_assume!(sun.length() > 0.1);
        // also from behind every face, where most lie above
        let mut from = points(100, 6.0);
        from.extend((0..mesh.faces.len()).map(|face| {
            mesh.corners(face).map(|corner| corner.as_dvec3()).iter().sum::<DVec3>() / 3.0 - sun * 30.0
        }));
        hold_bound("soup", &mesh, sun, &from);
    }
}
