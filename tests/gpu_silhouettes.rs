//! Silhouettes found on the GPU against those found on the processor, edge for edge; and the resulting masks.

use crate::geometry::silhouettes::{naive, sums};
use crate::geometry::{light, modelled, part, soup, sphere};
use crate::shared::drawing::{day, gpu, plan, scene_of, to_sun};
use crate::shared::scenes::{cuboid, joined, small, stack};
use crate::try_models::extracted::{edges_of, facing_of, near_edge_on};
use glam::{DVec3, DVec4, dvec3, dvec4};
use gnomon::choice::Receivers;
use gnomon::gpu::GpuError;
use gnomon::mesh::Mesh;
use gnomon::shadow::near_clip::near_clip_volume_touched;
use gnomon::shadow::stencil::Stencil;
use gnomon::shadow::walls::borders::Borders;
use gnomon::shadow::walls::extraction::{Extraction, ExtractionProgram};
use gnomon::shadow::walls::{WallQuery, Walls};
use gnomon::shadow::{Scene, Silhouettes, Technique};
use gnomon::silhouette::brute_force::BruteForce;
use gnomon::silhouette::{DirectedEdge, ProcessorFinder, SilhouetteFinder};
use gnomon::site::{Overrides, Site};
use gnomon::view::{Camera, Grid, Mask, View};
use proptest::prelude::*;
use std::sync::OnceLock;

/// Far more than any mesh of these tests needs.
const PLENTY: u64 = 1 << 27;

fn program() -> &'static ExtractionProgram {
    static PROGRAM: OnceLock<ExtractionProgram> = OnceLock::new();
    PROGRAM.get_or_init(|| ExtractionProgram::new(&gpu()))
}

/// The walls as the indices that are drawn, and the cap's; and how many runs wrote them.
fn extracted(mesh: &Mesh, sought: &WallQuery, most: u64) -> Result<([Vec<u32>; 2], usize), GpuError> {
    let gpu = gpu();
    let mut extraction = Extraction::new(program(), mesh, most)?;
    // the second answer must not build on the first
    for light in [-sought.local_light, sought.local_light] {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        extraction.find(mesh, &WallQuery { local_light: light, ..*sought }, &mut encoder)?;
        gpu.queue.submit([encoder.finish()]);
    }
    Ok((extraction.read()?, extraction.runs()))
}

fn brute_force(mesh: &Mesh, light: DVec4) -> Vec<DirectedEdge> {
    let mut edges = Vec::new();
    BruteForce.find(mesh, light, &mut edges);
    edges.sort_unstable();
    edges
}

/// Compares one extraction, in runs of at most `most` bytes, with the processor.
fn check(name: &str, mesh: &Mesh, light: DVec4, to_infinity: bool, most: u64) -> usize {
    let sought = WallQuery { local_light: light, to_infinity, with_cap: true, halved: false, borders: None };
    let ([walls, cap], runs) = extracted(mesh, &sought, most).unwrap();
    let (facing, expected_facing) = (facing_of(mesh, &cap), mesh.facing(light));
    for face in 0..mesh.faces.len() {
        assert!(
            facing[face] == expected_facing[face] || near_edge_on(mesh, face, light),
            "{name}: face {face} faces {light}"
        );
    }
    let mut edges = edges_of(mesh, &walls, light, to_infinity);
    edges.sort_unstable();
    if facing == expected_facing {
        assert_eq!(edges, brute_force(mesh, light), "{name}");
    }
    let sums_found = sums(edges.iter().copied());
    assert_eq!(sums_found, naive(mesh, &facing), "{name}");
    assert_eq!(edges.len(), sums_found.values().map(|sum| sum.unsigned_abs() as usize).sum::<usize>(), "{name}");
    runs
}

#[test]
fn one_wrong_edge_is_seen() {
    let mesh = Mesh::build(vec![cuboid("box", dvec3(-3.0, -4.0, 0.0), dvec3(3.0, 4.0, 7.0))]).unwrap();
    let light = dvec4(0.3, 0.4, 0.8, 0.0);
    for to_infinity in [false, true] {
        let sought = WallQuery { local_light: light, to_infinity, with_cap: true, halved: false, borders: None };
        let ([walls, _], _) = extracted(&mesh, &sought, PLENTY).unwrap();
        let sorted = |walls: &[u32]| {
            let mut edges = edges_of(&mesh, walls, light, to_infinity);
            edges.sort_unstable();
            edges
        };
        assert_eq!(sorted(&walls), brute_force(&mesh, light));
        let wall = if to_infinity { 3 } else { 6 };
        assert_ne!(sorted(&walls[wall..]), brute_force(&mesh, light), "one is missing");
        assert_ne!(sorted(&[&walls[..wall], &walls].concat()), brute_force(&mesh, light), "one is too many");
        let mut turned = sorted(&walls);
        turned[0].reverse();
        turned.sort_unstable();
        assert_ne!(turned, brute_force(&mesh, light), "one is turned");
        let wrong = std::panic::catch_unwind(|| {
            let mut walls = walls.clone();
            walls.swap(0, 1);
            edges_of(&mesh, &walls, light, to_infinity)
        });
        assert!(wrong.is_err(), "a triangle that begins elsewhere");
    }
}

#[test]
fn modelled_meshes_have_the_same_silhouettes() {
    for (name, mesh) in modelled() {
        for light in [dvec4(0.31, 0.22, 0.83, 0.0), dvec4(-0.8, 0.1, 0.05, 0.0), dvec4(3.1, -2.2, 9.4, 1.0)] {
            check(name, &mesh, light, false, PLENTY);
            check(name, &mesh, light, true, PLENTY);
        }
    }
}

#[test]
fn sites_and_a_large_mesh_have_the_same_silhouettes() {
    for name in ["tower", "industry", "headquarters"] {
        let site = Site::load(std::path::Path::new(&format!("sites/{name}")), &Overrides::default()).unwrap();
        for instant in site.track.instants.iter().step_by(4) {
            check(name, &site.mesh, instant.to_sun.extend(0.0), false, PLENTY);
        }
        let lamp = site.mesh.local_light((site.mesh.origin + dvec3(20.0, -35.0, 60.0)).extend(1.0));
        check(name, &site.mesh, lamp, true, PLENTY);
    }
    let mesh = Mesh::build(vec![sphere(30.0, 800, 500)]).unwrap();
    assert!(mesh.faces.len() > 790_000);
    assert_eq!(check("sphere", &mesh, dvec4(0.48, -0.6, 0.64, 0.0), false, 1 << 30), 1);
    assert!(check("sphere", &mesh, dvec4(0.48, -0.6, 0.64, 0.0), false, 1 << 22) > 10);
}

#[test]
fn halved_walls_stand_half_as_often() {
    let mesh = Mesh::build(vec![sphere(9.0, 20, 12), cuboid("box", DVec3::splat(20.0), DVec3::splat(25.0))]).unwrap();
    let light = dvec4(0.3, 0.4, 0.8, 0.0);
    for to_infinity in [false, true] {
        let sought = WallQuery { local_light: light, to_infinity, with_cap: false, halved: true, borders: None };
        let ([walls, cap], _) = extracted(&mesh, &sought, PLENTY).unwrap();
        assert!(cap.is_empty());
        let mut twice: Vec<_> =
            edges_of(&mesh, &walls, light, to_infinity).into_iter().flat_map(|edge| [edge, edge]).collect();
        twice.sort_unstable();
        assert_eq!(twice, brute_force(&mesh, light));
    }
}

#[test]
fn what_does_not_fit_is_an_error() {
    let pages = (0..10).map(|page| {
        let (sin, cos) = f64::from(page).sin_cos();
        part(vec![DVec3::ZERO, DVec3::Z, dvec3(cos, sin, 0.5)], vec![[0, 1, 2]])
    });
    let mesh = Mesh::build(vec![joined(pages.collect())]).unwrap();
    let sought =
        |to_infinity| WallQuery { local_light: DVec4::Y, to_infinity, with_cap: false, halved: false, borders: None };
    // ten walls can hang from the spine
    assert!(extracted(&mesh, &sought(false), 240).is_ok());
    let error = extracted(&mesh, &sought(false), 239).unwrap_err().to_string();
    assert!(error.contains("extraction.walls takes 240 bytes, more than the 239"), "{error}");
    assert!(extracted(&mesh, &sought(true), 239).is_ok());
    // one bit a face, which is not split
    let mesh = Mesh::build(vec![sphere(9.0, 60, 40)]).unwrap();
    let error = extracted(&mesh, &sought(false), 100).unwrap_err().to_string();
    assert!(error.contains("faces.facing"), "{error}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn any_mesh_under_any_light_has_the_same_silhouette(mesh in soup(), light in light(), to_infinity: bool) {
        check("soup", &mesh, light, to_infinity, PLENTY);
    }

    #[test]
    fn runs_find_what_the_whole_finds(mesh in soup(), light in light(), to_infinity: bool) {
        // room for the most crowded edge and little more, so that many meshes come in several runs
        let most_crowded = (0..mesh.edges.len()).map(|edge| mesh.faces_at(edge).len()).max().unwrap_or(0);
        let runs = check("soup", &mesh, light, to_infinity, (most_crowded as u64 + 4) * 24);
        prop_assert!(runs > 1 || mesh.faces.len() < 8);
    }
}

const WAYS: [Silhouettes; 3] =
    [Silhouettes::OnProcessor(ProcessorFinder::BruteForce), Silhouettes::OnGpu, Silhouettes::InVertexShader];

/// Draws with all methods, each sun twice and others in between.
fn masks(scene: &Scene, view: View, suns: &[DVec3]) -> [Vec<Mask>; 3] {
    WAYS.map(|way| {
        let mut stencil = Stencil::new(gpu(), scene.clone(), view, way).unwrap();
        suns.iter().chain(suns).map(|&sun| stencil.draw(sun).unwrap().read().unwrap()).collect()
    })
}

fn same_masks(name: &str, scene: &Scene, view: View, suns: &[DVec3]) {
    let expected = same_masks_anywhere(name, scene, view, suns);
    assert!(expected.iter().any(|mask| mask.share.contains(&0)), "{name}: nothing is in shadow");
}

fn same_masks_anywhere(name: &str, scene: &Scene, view: View, suns: &[DVec3]) -> Vec<Mask> {
    let [expected, on_gpu, in_vertex_shader] = masks(scene, view, suns);
    for (at, expected) in expected.iter().enumerate() {
        for (way, found) in [("extracted", &on_gpu[at]), ("in the vertex shader", &in_vertex_shader[at])] {
            let differ = found.share.iter().zip(&expected.share).filter(|(found, expected)| found != expected).count();
            assert_eq!(differ, 0, "{name}, instant {at}, {way}");
        }
    }
    expected
}

#[test]
fn all_ways_draw_the_same_plan() {
    for (name, parts) in small() {
        let mesh = Mesh::build(parts).unwrap();
        for receivers in [Receivers::Ground, Receivers::Top] {
            same_masks(name, &scene_of(&mesh, receivers, 0.0), plan(40.371_93, 300), &day());
        }
    }
    for name in ["tower", "industry", "headquarters"] {
        let asked = Overrides { size: Some(401), ..Overrides::default() };
        let site = Site::load(std::path::Path::new(&format!("sites/{name}")), &asked).unwrap();
        let receivers = site.mesh.of_components(&site.receives);
        let scene = Scene { casters: site.mesh.of_components(&site.casts), receivers, ground: site.ground.level };
        let suns: Vec<_> = site.track.instants.iter().filter(|instant| !instant.night).map(|it| it.to_sun).collect();
        same_masks(name, &scene, View::Plan(site.grid), &[suns[0], suns[suns.len() / 2]]);
    }
}

#[test]
fn all_ways_draw_the_same_picture() {
    let mut kinds = [0, 0];
    for (name, parts) in small() {
        let mesh = Mesh::build(parts).unwrap();
        let scene = scene_of(&mesh, Receivers::Top, 0.0);
        for eye in [dvec3(30.0, -40.0, 25.0), dvec3(3.0, 14.0, 2.0)] {
            let camera =
                Camera { eye, target: dvec3(0.0, 0.0, 3.0), up: DVec3::Z, fov_rad: 1.2, width: 320, height: 200 };
            let suns = [to_sun(180.0, 40.0), to_sun(100.0, 20.0)];
            kinds[usize::from(near_clip_volume_touched(&camera, suns[0], &scene.casters))] += 1;
            same_masks(name, &scene, View::Camera(camera), &suns);
        }
    }
    assert!(kinds[0] > 2 && kinds[1] > 2, "both ways of counting must occur: {kinds:?}");
}

#[test]
fn walls_beyond_the_borders_are_not_missed() {
    for name in ["tower", "industry"] {
        let site = Site::load(std::path::Path::new(&format!("sites/{name}")), &Overrides::default()).unwrap();
        let receivers = site.mesh.of_components(&site.receives);
        let scene = Scene { casters: site.mesh.of_components(&site.casts), receivers, ground: site.ground.level };
        let (low, high) = scene.casters.bounds().unwrap();
        let suns = [site.track.instants[1].to_sun, site.track.instants[5].to_sun];
        let middle = (low + high) / 2.0;
        // on the casters, beside them, and where their shadows reach
        for step in 0..5 {
            let at = middle - suns[0] * f64::from(step) * 25.0 / suns[0].z;
            let grid = Grid { west: at.x - 12.0, north: at.y + 9.0, cell: 0.1, width: 240, height: 180 };
            same_masks_anywhere(name, &scene, View::Plan(grid), &suns);
        }
        let mut kinds = [0, 0];
        for (eye, to) in [(high, middle), (dvec3(middle.x, low.y - 20.0, 2.0), middle), (middle.with_z(1.7), high)] {
            let camera = Camera { eye, target: to, up: DVec3::Z, fov_rad: 0.4, width: 320, height: 200 };
            kinds[usize::from(near_clip_volume_touched(&camera, suns[0], &scene.casters))] += 1;
            same_masks_anywhere(name, &scene, View::Camera(camera), &suns);
        }
        assert!(kinds[0] > 0 && kinds[1] > 0, "both ways of counting must occur: {kinds:?}");
    }
}

#[test]
fn a_wall_is_hidden_only_beyond_one_border() {
    let half = glam::DMat4::from_scale(DVec3::new(0.1, 0.1, 0.01));
    let to_sun = to_sun(180.0, 45.0);
    let hidden = |from: [f32; 3], to: [f32; 3]| {
        let hide =
            |lowest_z| Borders { clip_from_local: half, lowest_z, to_sun }.hide(&[from.into(), to.into()], [0, 1]);
        [hide(Some(0.0)), hide(None)]
    };
    // the view reaches 10 m each way; shadows go north, as far as their casters are high
    assert_eq!(hidden([20.0, 0.0, 5.0], [30.0, 5.0, 9.0]), [true, false]); // the point at infinity is no farther east
    assert_eq!(hidden([0.0, 20.0, 5.0], [5.0, 30.0, 9.0]), [true, true]);
    assert_eq!(hidden([0.0, -20.0, 5.0], [5.0, -30.0, 9.0]), [true, false]);
    assert_eq!(hidden([0.0, -20.0, 15.0], [5.0, -30.0, 9.0]), [false, false]);
    assert_eq!(hidden([-20.0, 0.0, 5.0], [20.0, 0.0, 5.0]), [false, false]);
    assert_eq!(hidden([20.0, 0.0, 5.0], [5.0, 20.0, 5.0]), [false, false]);
    assert_eq!(hidden([10.05, 0.0, 5.0], [10.05, 5.0, 9.0]), [false, false]);
}

#[test]
fn all_ways_draw_in_batches() {
    for (plates, thickness) in [(300, 0.0), (300, 0.004)] {
        let mesh = Mesh::build(vec![stack(plates, thickness)]).unwrap();
        let name = format!("{plates} plates of {thickness} m");
        same_masks(&name, &scene_of(&mesh, Receivers::Ground, 0.0), plan(10.0, 100), &[to_sun(200.0, 70.0)]);
    }
}
