//! Shadow volumes as solids: closed, as large as they must be, counting the faces towards the sun, and readable.

use crate::geometry::soup;
use crate::shared::scenes::{cuboid, small};
use glam::{DVec3, Vec3, dvec3};
use gnomon::mesh::{Mesh, report};
use gnomon::shadow::ray_cast::RayCaster;
use gnomon::site::{Overrides, Site};
use gnomon::volume::solid::{Solid, SolidError, Solids, solids};
use proptest::prelude::*;
use std::collections::HashMap;
use std::f64::consts::TAU;
use std::path::Path;

const SUNS: [DVec3; 4] = [
    dvec3(0.311, 0.223, 0.834),
    dvec3(-0.812, 0.113, 0.357),
    dvec3(0.35, -0.91, 0.02),
    // edge-on to the walls of boxes
    dvec3(0.0, -0.6, 0.8),
];

fn of(mesh: &Mesh, to_sun: DVec3, ground: f64) -> Solids {
    solids(mesh, &vec![true; mesh.components.len()], to_sun.normalize(), ground).unwrap()
}

/// A plain second opinion: how often each edge is run along less how often against, by positions and by indices.
fn is_closed(vertices: &[Vec3], triangles: &[[u32; 3]]) -> bool {
    let place = |corner: u32| vertices[corner as usize].to_array().map(|value| (value + 0.0).to_bits());
    let mut of_places: HashMap<_, i32> = HashMap::new();
    let mut of_indices: HashMap<_, i32> = HashMap::new();
    for &[a, b, c] in triangles {
        for (from, to) in [(a, b), (b, c), (c, a)] {
            *of_places.entry((place(from), place(to))).or_default() += 1;
            *of_places.entry((place(to), place(from))).or_default() -= 1;
            *of_indices.entry((from, to)).or_default() += 1;
            *of_indices.entry((to, from)).or_default() -= 1;
        }
    }
    of_places.values().chain(of_indices.values()).all(|sum| *sum == 0)
}

fn volume_m3(solid: &Solid) -> f64 {
    let tetrahedron = |triangle| {
        let [a, b, c] = solid.corners(triangle).map(|corner| corner - solid.origin);
        a.dot(b.cross(c)) / 6.0
    };
    (0..solid.triangles.len()).map(tetrahedron).sum()
}

/// How often the solid winds around a point: its solid angle over that of the whole sphere (van Oosterom and Strackee).
fn winding(solid: &Solid, point: DVec3) -> f64 {
    let angle = |triangle| {
        let [a, b, c] = solid.corners(triangle).map(|corner| (corner - point).normalize());
        2.0 * a.dot(b.cross(c)).atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a))
    };
    (0..solid.triangles.len()).map(angle).sum::<f64>() / (2.0 * TAU)
}

/// Points on no round numbers in a box around a point, above the ground.
fn points(count: u32, around: DVec3, ground: f64) -> impl Iterator<Item = DVec3> {
    let place = |at: u32, step: f64| (f64::from(at) * step).fract() * 2.0 - 1.0;
    (1..=count).map(move |at| {
        let aside = dvec3(place(at, 0.819_172_513_396), place(at, 0.671_043_606_703), 0.0) * 10.0;
        (around + aside).with_z(ground + 0.01 + 12.0 * (f64::from(at) * 0.549_700_477_901).fract())
    })
}

/// Whether a solid counts at points the casting faces towards the sun; how many of the points have any.
fn counts_faces(mesh: &Mesh, solid: &Solid, to_sun: DVec3, ground: f64) -> Result<usize, String> {
    let keep: Vec<bool> = (0..mesh.components.len()).map(|at| at == solid.component).collect();
    let caster = mesh.of_components(&keep);
    let report = &report::components(&caster)[0];
    // a closed component casts with the half of its faces through which its inside sees the sun
    let facing = caster.facing(to_sun.extend(0.0));
    let half = report.closed && report.crowded_edges == 0;
    let outwards = volume_of(&caster) >= 0.0;
    let casting = caster.of_faces(|face| !half || facing[face as usize] == outwards);
    let rays = RayCaster::new(&casting, 100.0);
    let wrong = |point: DVec3| {
        let count = rays.crossings(point - mesh.origin, to_sun);
        ((winding(solid, point) - count as f64).abs() > 1e-3).then_some((count, point))
    };
    let mut shaded = 0;
    for point in points(80, mesh.origin, ground) {
        // a point may lie within the rounding of a wall, but not its neighbours on both sides
        let aside = dvec3(0.000_71, 0.000_53, 0.000_89);
        if let (Some((count, at)), Some(_), Some(_)) = (wrong(point), wrong(point + aside), wrong(point - aside)) {
            return Err(format!("{} is not {count} at {at} under {to_sun}", winding(solid, at)));
        }
        shaded += usize::from(rays.crossings(point - mesh.origin, to_sun) > 0);
    }
    Ok(shaded)
}

fn volume_of(mesh: &Mesh) -> f64 {
    (0..mesh.faces.len())
        .map(|face| mesh.corners(face).map(|corner| corner.as_dvec3()))
        .map(|[a, b, c]| a.dot(b.cross(c)))
        .sum()
}

fn boxed(low: DVec3, high: DVec3) -> Mesh {
    Mesh::build(vec![cuboid("box", low, high)]).unwrap()
}

#[test]
fn comparators_see_what_is_lost_or_turned() {
    let mesh = boxed(dvec3(-3.0, -4.0, 0.0), dvec3(3.0, 4.0, 5.0));
    let whole = of(&mesh, SUNS[0], 0.0).solids.remove(0);
    let to_sun = SUNS[0].normalize();
    assert!(is_closed(&whole.vertices, &whole.triangles) && whole.closed());
    assert!(counts_faces(&mesh, &whole, to_sun, 0.0).unwrap() > 3);
    for at in 0..whole.triangles.len() {
        let mut lost = whole.clone();
        lost.triangles.remove(at);
        let mut turned = whole.clone();
        turned.triangles[at].reverse();
        for bad in [lost, turned] {
            assert!(!is_closed(&bad.vertices, &bad.triangles) && !bad.closed(), "{at}");
        }
    }
    let mut moved = whole.clone();
    moved.vertices.iter_mut().filter(|vertex| vertex.z == 5.0).for_each(|vertex| vertex.z = 1.0);
    assert!(moved.closed() && counts_faces(&mesh, &moved, to_sun, 0.0).is_err());
}

#[test]
fn a_box_s_volume_is_the_closed_form() {
    let (low, size) = (dvec3(1002.25, -33.5, -2.0), dvec3(6.0, 9.5, 14.0));
    for inside_out in [false, true] {
        let mut part = cuboid("box", low, low + size);
        if inside_out {
            part.triangles.iter_mut().for_each(|triangle| triangle.swap(0, 1));
        }
        let mesh = Mesh::build(vec![part]).unwrap();
        for (sun, ground) in SUNS.into_iter().flat_map(|sun| [(sun, -2.0), (sun, 3.5), (sun, -2.5)]) {
            let solid = of(&mesh, sun, ground).solids.remove(0);
            // the box above the ground, and behind its lit walls and roof what it hides: from the roof's edges down to
            // the ground along the sun
            let foot = (low.z - ground).max(0.0);
            let top = low.z + size.z - ground;
            let lit = (size.y * sun.x.abs() + size.x * sun.y.abs()) / sun.z;
            let expected = size.x * size.y * top + lit * (top * top - foot * foot) / 2.0;
            let found = volume_m3(&solid);
            assert!((found / expected - 1.0).abs() < 1e-4, "{sun} {ground}: {found} m³ is not {expected} m³");
            assert!((solid.length_m - top * sun.truncate().length() / sun.z).abs() < 1e-9);
        }
    }
}

#[test]
fn small_meshes_are_closed_and_count_their_faces() {
    for (name, parts) in small() {
        let mesh = Mesh::build(parts).unwrap();
        for (sun, ground) in SUNS.into_iter().flat_map(|sun| [(sun, 0.0), (sun, 3.3), (sun, -8.0)]) {
            let found = of(&mesh, sun, ground);
            assert_eq!(found.left_out, 0, "{name}");
            let mut shaded = 0;
            for solid in &found.solids {
                assert!(is_closed(&solid.vertices, &solid.triangles) && solid.closed(), "{name} {sun} {ground}");
                let lowest = (0..solid.triangles.len()).flat_map(|at| solid.corners(at)).map(|corner| corner.z);
                assert!((lowest.fold(f64::INFINITY, f64::min) - ground).abs() < 1e-6, "{name} ends at the ground");
                match counts_faces(&mesh, solid, sun.normalize(), ground) {
                    Ok(points) => shaded += points,
                    Err(wrong) => panic!("{name}, ground {ground}: {wrong}"),
                }
            }
            // under a sun at the horizon hardly a point lies behind a flat plate
            assert!(shaded > 0 || sun.z < 0.1, "{name} {sun} {ground}: nothing was compared");
        }
    }
}

#[test]
fn what_throws_no_shadow_is_left_out() {
    let below = boxed(dvec3(0.0, 0.0, -4.0), dvec3(2.0, 2.0, -1.0));
    let found = of(&below, SUNS[0], -1.0);
    assert_eq!((found.solids.len(), found.left_out), (0, 1));
    // a sheet edge-on to the sun
    let mut sheet = cuboid("sheet", DVec3::ZERO, dvec3(4.0, 0.0, 3.0));
    sheet.triangles = vec![[0, 1, 5], [0, 5, 4]];
    let sheet = Mesh::build(vec![sheet]).unwrap();
    assert_eq!(of(&sheet, dvec3(0.6, 0.0, 0.8), 0.0).left_out, 1);
    assert_eq!(of(&sheet, dvec3(0.6, 0.1, 0.8), 0.0).solids.len(), 1);
    // what does not cast is not missed
    assert_eq!(solids(&below, &[false], DVec3::Z, -9.0).unwrap().left_out, 0);
    for sun in [DVec3::X, dvec3(0.6, 0.0, -0.8), DVec3::NAN] {
        assert_eq!(solids(&sheet, &[true], sun, 0.0).unwrap_err(), SolidError::NoSun);
    }
    let overhead = of(&boxed(DVec3::ZERO, DVec3::ONE), DVec3::Z, 0.0).solids.remove(0);
    assert!((volume_m3(&overhead) - 1.0).abs() < 1e-6 && overhead.closed());
}

#[test]
fn the_sites_volumes_are_closed() {
    for site in ["tower", "industry", "headquarters"] {
        for at in ["2026-09-18T15:00", "2026-06-21T12:00", "2026-12-21T16:00"] {
            let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("sites").join(site);
            let site = Site::load(&folder, &Overrides { at: at.parse().ok(), ..Overrides::default() }).unwrap();
            let found = solids(&site.mesh, &site.casts, site.track.instants[0].to_sun, site.ground.level).unwrap();
            assert!(found.solids.len() > 10);
            for solid in &found.solids {
                assert!(
                    is_closed(&solid.vertices, &solid.triangles),
                    "{at} {}",
                    site.mesh.components[solid.component].name
                );
                assert!(volume_m3(solid) > 0.0);
            }
        }
    }
}

#[test]
fn at_a_very_low_sun_a_volume_is_long_and_whole() {
    let mesh = boxed(dvec3(2_680_000.0, 1_200_000.0, 400.0), dvec3(2_680_012.5, 1_200_007.25, 430.0));
    let altitude = 0.1_f64.to_radians();
    let sun = dvec3(altitude.cos() * 0.6, altitude.cos() * 0.8, altitude.sin());
    let solid = of(&mesh, sun, 400.0).solids.remove(0);
    assert!((solid.length_m - 30.0 / altitude.tan()).abs() < 1e-6);
    assert!(is_closed(&solid.vertices, &solid.triangles));
    // the near end keeps its centimetres
    let near = |at: DVec3| {
        (0..solid.triangles.len()).flat_map(|triangle| solid.corners(triangle)).any(|corner| corner.distance(at) < 1e-3)
    };
    assert!(near(dvec3(2_680_012.5, 1_200_007.25, 430.0)) && near(dvec3(2_680_012.5, 1_200_007.25, 400.0)));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn any_soup_s_volume_is_closed_and_counts_its_faces(
        mesh in soup(), ground in 294.0..304.0f64, aside in prop::array::uniform2(-1.0..1.0f64), up in 0.3..1.0f64,
    ) {
        let sun = dvec3(aside[0], aside[1], up).normalize();
        for solid in of(&mesh, sun, ground).solids {
            prop_assert!(is_closed(&solid.vertices, &solid.triangles) && solid.closed());
            if let Err(wrong) = counts_faces(&mesh, &solid, sun, ground) {
                prop_assert!(false, "{wrong}");
            }
        }
    }
}
