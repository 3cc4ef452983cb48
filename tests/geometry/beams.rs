//! Rays in packets and in beams give the same results as the plain caster and as testing every face, to the bit, with
//! each instruction set that the machine has.

use super::{part, soup, sphere};
use glam::{DVec3, dvec3};
use gnomon::mesh::{Mesh, Part};
use gnomon::shadow::rays::{PlainCaster, RayCaster, Shear, SimdLevel};
use proptest::prelude::*;

/// A caster's result for some parallel rays: the nearest face of each, and its distance.
type Hits = Vec<Option<(u32, f64)>>;

fn plain(mesh: &Mesh, reach: f64, origins: &[DVec3], direction: DVec3) -> Hits {
    let caster = PlainCaster::new(mesh, reach);
    let hit = |origin: &DVec3| {
        let hit = caster.first_hit(*origin, direction);
        assert_eq!(hit.is_some(), caster.blocked(*origin, direction));
        hit
    };
    origins.iter().map(hit).collect()
}

/// The rays for which a caster's result differs from the expected one, with all four kinds of queries.
fn wrong(caster: &RayCaster, origins: &[DVec3], direction: DVec3, expected: &Hits) -> Vec<String> {
    let shear = Shear::along(direction);
    let mut wrong = Vec::new();
    for (first, some) in origins.chunks(RayCaster::MOST_RAYS).enumerate() {
        let first = first * RayCaster::MOST_RAYS;
        let blocked = caster.blocked_beam(some, &shear);
        assert_eq!(blocked.checked_shr(some.len() as u32).unwrap_or(0), 0, "bits of rays that were not asked");
        let mut hits = vec![None; some.len()];
        caster.first_hits(some, &shear, &mut hits);
        for (at, &origin) in some.iter().enumerate() {
            let expected = expected[first + at];
            let alone = caster.first_hit(origin, direction);
            let said = [blocked >> at & 1 == 1, hits[at].is_some(), caster.blocked(origin, &shear), alone.is_some()];
            if said != [expected.is_some(); 4] || hits[at] != expected || alone != expected {
                wrong.push(format!(
                    "from {origin} along {direction}: {expected:?}, but {said:?}, {:?} and {alone:?}",
                    hits[at]
                ));
            }
        }
    }
    wrong
}

/// All instruction sets give the result of the plain caster; returns how many rays hit, and how many miss.
fn agree(mesh: &Mesh, reach: f64, origins: &[DVec3], direction: DVec3) -> [usize; 2] {
    let expected = plain(mesh, reach, origins, direction);
    for level in SimdLevel::all() {
        let caster = RayCaster::new(mesh, reach).on(level);
        let wrong = wrong(&caster, origins, direction, &expected);
        assert!(wrong.is_empty(), "{level:?}, {} of {}: {:?}", wrong.len(), origins.len(), wrong.first());
    }
    let hit = expected.iter().flatten().count();
    [hit, expected.len() - hit]
}

/// Vertices and points of edges, as rays along a direction come to them from some way off.
fn through_edges(mesh: &Mesh, direction: DVec3, off: f64) -> Vec<DVec3> {
    let at = |vertex: u32| mesh.vertices[vertex as usize].as_dvec3();
    let on_edge = |&[a, b]: &[u32; 2]| [0.0, 0.25, 0.5, 0.3, 0.9].map(|share| at(a) + (at(b) - at(a)) * share);
    mesh.edges.iter().flat_map(on_edge).map(|target| target - direction.normalize() * off).collect()
}

const DIRECTIONS: [DVec3; 9] = [
    DVec3::X,
    DVec3::NEG_Y,
    DVec3::NEG_Z,
    dvec3(1.0, 1.0, 0.0),
    dvec3(0.6, 0.0, 0.8),
    dvec3(-0.31, 0.55, 0.77),
    dvec3(0.9, -0.4, 1e-7),
    dvec3(-12.0, -0.1, 0.001),
    dvec3(1e-9, -1e-9, 1.0),
];

#[test]
fn rays_through_edges_and_vertices() {
    let mesh = Mesh::build(vec![sphere(7.0, 48, 24)]).unwrap();
    let mut found = [0; 2];
    for direction in DIRECTIONS {
        for off in [40.0, 7.0, 1e-3] {
            let [hit, passed] = agree(&mesh, 100.0, &through_edges(&mesh, direction, off), direction);
            found = [found[0] + hit, found[1] + passed];
        }
    }
    assert!(found[0] > 10_000 && found[1] > 1000, "{found:?}");
}

/// Boxes side by side on whole metres, some of which touch, and some are as thin as a sheet.
fn boxes() -> Mesh {
    let mut parts = Vec::new();
    for (x, y) in (0..9).flat_map(|x| (0..9).map(move |y| (x, y))) {
        let low = dvec3(f64::from(x) * 3.0, f64::from(y) * 2.0, f64::from((x * y) % 3));
        let high = low + dvec3(if x % 4 == 0 { 0.0 } else { 2.0 }, 2.0, 1.0 + f64::from((x + y) % 5));
        let corner = |at: u32| {
            let pick = |bit: u32, axis: usize| if at >> bit & 1 == 1 { high[axis] } else { low[axis] };
            dvec3(pick(0, 0), pick(1, 1), pick(2, 2))
        };
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        parts.push(part((0..8).map(corner).collect(), triangles));
    }
    Mesh::build(parts).unwrap()
}

#[test]
fn suns_in_the_planes_of_walls_and_rays_on_walls() {
    let mesh = boxes();
    let mut found = [0; 2];
    // whole and half metres stand on walls, and a millimetre beside them
    let grid = (0..64).flat_map(|row| (0..64).map(move |column| dvec3(f64::from(column), f64::from(row), 0.0) * 0.5));
    for direction in DIRECTIONS {
        for (lift, aside) in [(0.0, 0.0), (0.001, 0.0), (1.0, 0.001), (2.001, -1e-9)] {
            let origins: Vec<DVec3> =
                grid.clone().map(|point| point + dvec3(aside, aside, lift) - mesh.origin).collect();
            let [hit, passed] = agree(&mesh, 100.0, &origins, direction);
            found = [found[0] + hit, found[1] + passed];
        }
    }
    assert!(found[0] > 10_000 && found[1] > 10_000, "{found:?}");
}

#[test]
fn beams_whose_rays_lie_apart_and_beams_of_few() {
    let mesh = boxes();
    let direction = dvec3(-0.31, 0.55, 0.77);
    for count in [1, 2, 7, 8, 9, 16, 17, 63, 64] {
        // neighbours on the ground and on roofs, and some that are nobody's neighbour
        let origin = |at: usize| {
            let (column, row) = ((at % 8) as f64, (at / 8) as f64);
            let up = [0.001, 5.001, -300.0, 0.5][at * at % 4];
            dvec3(column * 0.4 + 7.0, row * 0.4 + 3.0, up) - mesh.origin
        };
        let origins: Vec<DVec3> = (0..count).map(origin).collect();
        agree(&mesh, 400.0, &origins, direction);
    }
    let shear = Shear::along(direction);
    let caster = RayCaster::new(&mesh, 400.0);
    assert_eq!(caster.blocked_beam(&[], &shear), 0);
    caster.first_hits(&[], &shear, &mut []);
    let nothing = RayCaster::new(&mesh.of_components(&[]), 400.0);
    assert_eq!(nothing.blocked_beam(&[DVec3::ZERO; 64], &shear), 0);
    assert_eq!(nothing.first_hit(DVec3::ZERO, direction), None);
}

#[test]
fn far_from_the_mesh_s_origin() {
    // 8 km from it, single precision knows half a millimetre
    let at = |x: f64, y: f64| {
        let ball = sphere(7.0, 24, 12);
        Part { positions: ball.positions.iter().map(|position| *position + dvec3(x, y, 0.0)).collect(), ..ball }
    };
    let mesh = Mesh::build(vec![at(0.0, 0.0), at(16_000.0, 0.0), at(0.0, 9000.0)]).unwrap();
    let mut found = [0; 2];
    for direction in DIRECTIONS {
        for off in [100.0, 0.001] {
            let [hit, passed] = agree(&mesh, 20_000.0, &through_edges(&mesh, direction, off), direction);
            found = [found[0] + hit, found[1] + passed];
        }
    }
    assert!(found[0] > 2000 && found[1] > 2000, "{found:?}");
}

#[test]
fn a_face_less_is_found() {
    let whole = Mesh::build(vec![sphere(7.0, 48, 24)]).unwrap();
    let last = whole.faces.len() as u32 - 1;
    let holed = whole.of_faces(|face| face != last);
    let direction = dvec3(-0.31, 0.55, 0.77);
    let middle = whole.corners(last as usize).map(|corner| corner.as_dvec3()).iter().sum::<DVec3>() / 3.0;
    let origins = [middle - direction, middle - direction * 2.0, DVec3::ZERO];
    let expected = plain(&whole, 100.0, &origins, direction);
    for level in SimdLevel::all() {
        assert!(wrong(&RayCaster::new(&whole, 100.0).on(level), &origins, direction, &expected).is_empty());
        let found = wrong(&RayCaster::new(&holed, 100.0).on(level), &origins, direction, &expected);
        assert_eq!(found.len(), 2, "{level:?}: {found:?}");
    }
}

#[test]
fn of_equal_hits_the_first_face_is_told() {
    // one over the other, and each twice; a ray through the diagonal meets four faces at one distance
    let sheet = |name: &str| Part {
        name: name.into(),
        ..part(
            vec![dvec3(-2.0, -2.0, 1.0), dvec3(2.0, -2.0, 1.0), dvec3(2.0, 2.0, 1.0), dvec3(-2.0, 2.0, 1.0)],
            vec![[0, 1, 2], [0, 2, 3]],
        )
    };
    let mesh = Mesh::build((0..20).map(|at| sheet(&format!("sheet {at}"))).collect()).unwrap();
    let origins: Vec<DVec3> = (-15..16).map(|at| dvec3(f64::from(at) * 0.125, f64::from(at) * 0.125, -4.0)).collect();
    agree(&mesh, 100.0, &origins, DVec3::Z);
    assert_eq!(RayCaster::new(&mesh, 100.0).first_hit(origins[3], DVec3::Z).map(|(face, _)| face), Some(0));
}

/// Rays that pass a triangle's edges by a hair, inside and outside.
fn beside_edges(corners: [DVec3; 3], direction: DVec3, off: f64, hair: f64) -> Vec<DVec3> {
    let middle = corners.iter().sum::<DVec3>() / 3.0;
    let beside = |at: usize| {
        let (a, b) = (corners[at % 3], corners[(at + 1) % 3]);
        let along = a + (b - a) * (at / 3) as f64 / 9.0;
        let to_middle = (middle - along).normalize_or_zero();
        [-1.0, -0.1, 0.0, 0.1, 1.0].map(|share| along + to_middle * hair * share - direction * off)
    };
    (0..30).flat_map(beside).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn any_triangles(mesh in soup(), from in prop::array::uniform3(-9.0..9.0), to in prop::array::uniform3(-4.0..4.0)) {
        let (from, direction) = (DVec3::from(from), DVec3::from(to) - DVec3::from(from));
        let square = (0..64).map(|at| from + dvec3(f64::from(at % 8), f64::from(at / 8), f64::from(at % 3)) * 0.7);
        let mut origins: Vec<DVec3> = square.collect();
        origins.extend(through_edges(&mesh, direction, 5.0));
        agree(&mesh, 100.0, &origins, direction);
    }

    /// Every face tested one by one: no tree may exclude a face that rounding cannot exclude.
    #[test]
    fn a_hair_beside_edges(
        corners in prop::array::uniform3(prop::array::uniform3(-1.0..1.0)),
        place in prop::array::uniform3(-1.0..1.0),
        direction in prop::array::uniform3(-1.0..1.0),
        size in prop::sample::select(vec![0.02, 1.0, 30.0, 4000.0]),
        away in prop::sample::select(vec![0.0, 10.0, 5000.0]),
        hair in prop::sample::select(vec![1e-12, 1e-8, 1e-6, 1e-5, 1e-4, 1e-3]),
        off in prop::sample::select(vec![1e-3, 1.0, 40.0, 3000.0]),
    ) {
        let direction = DVec3::from(direction);
        prop_assume!(direction.length() > 0.1);
        let corners = corners.map(|corner| DVec3::from(corner) * size + DVec3::from(place) * away);
        // beside it another one, so that the origin is not in its middle
        let other = corners.map(|corner| corner + dvec3(2.0 * size, 3.0 * away, 0.0));
        let parts = [corners, other].map(|corners| part(corners.to_vec(), vec![[0, 1, 2]]));
        let Ok(mesh) = Mesh::build(parts.to_vec()) else { return Ok(()) };
        prop_assume!(mesh.faces.len() == 2);
        let seen = mesh.corners(0).map(|corner| corner.as_dvec3());
        let origins = beside_edges(seen, direction.normalize(), off, hair);
        let shear = Shear::along(direction);
        for level in SimdLevel::all() {
            let caster = RayCaster::new(&mesh, 30_000.0).on(level);
            for some in origins.chunks(RayCaster::MOST_RAYS) {
                let blocked = caster.blocked_beam(some, &shear);
                for (at, &origin) in some.iter().enumerate() {
                    let expected = caster.crossings(origin, direction) > 0;
                    prop_assert_eq!(blocked >> at & 1 == 1, expected, "{:?}: from {}", level, origin);
                    prop_assert_eq!(caster.blocked(origin, &shear), expected, "{:?}: alone from {}", level, origin);
                }
            }
        }
    }
}
