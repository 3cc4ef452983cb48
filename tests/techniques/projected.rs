//! Projected shadows: the mask of ray casting on the ground, cell for cell, except within a thousandth of a cell of an
//! edge.

use super::plain_scan::scanned;
use super::{draw, site};
use crate::exact::dirty::dirty;
use crate::shared::drawing::{day, plan, scene_of, to_sun};
use crate::shared::scenes::{cuboid, sheet, small, stack};
use crate::shared::{dense, dome};
use glam::{DVec3, dvec2, dvec3};
use gnomon::choice::Receivers;
use gnomon::gpu::Gpu;
use gnomon::mesh::{Mesh, Part};
use gnomon::shadow::projected::{Projected, ProjectedOnGpu};
use gnomon::shadow::ray_cast::RayCast;
use gnomon::shadow::{PlanSurface, Scene, Technique, plan_surface};
use gnomon::view::{Grid, Mask, Surface, SurfaceRows, View};
use std::sync::Arc;

/// How close to the centre of a differing cell an edge must run, in cells.
const ON_PROCESSOR: f64 = 1e-3;
const ON_GPU: f64 = 1.0 / 128.0;

fn projected(scene: &Scene, view: View, sun: DVec3) -> Mask {
    let View::Plan(grid) = view else { panic!("a plan") };
    draw(&mut Projected::new(scene, grid), sun)
}

/// Cells that differ from ray casting, or with `twin` from the simple scan, and those of them that have no edge within
/// this distance, in cells.
fn differing(scene: &Scene, view: View, sun: DVec3, drawn: &Mask, twin: bool, within: f64) -> (usize, Vec<usize>) {
    let View::Plan(grid) = view else { panic!("a plan") };
    let mut truth = RayCast::new(scene.clone(), view, None);
    let right = if twin { scanned(scene, &grid, sun) } else { draw(&mut truth, sun).share };
    let differ: Vec<usize> = (0..right.len()).filter(|&at| drawn.share[at] != right[at]).collect();
    let all = differ.len();
    let wrong = differ.into_iter().filter(|&at| {
        let centre = grid.centre(at as u32 % grid.width, at as u32 / grid.width);
        let cell = grid.cell * within;
        let corner = centre + dvec2(-1.5, 1.5) * cell;
        truth.look_at(View::Plan(Grid { west: corner.x, north: corner.y, cell, width: 3, height: 3 }));
        let around = draw(&mut truth, sun).share;
        around.iter().all(|share| *share == around[0])
    });
    (all, wrong.collect())
}

fn agree(what: &str, scene: &Scene, view: View, suns: &[DVec3]) {
    let with_receivers = !scene.receivers.faces.is_empty();
    for &sun in suns {
        let drawn = projected(scene, view, sun);
        // the twin draws the ground alone
        for (name, twin) in
            [("ray casting", false), ("its twin", true)].into_iter().take(2 - usize::from(with_receivers))
        {
            let (all, wrong) = differing(scene, view, sun, &drawn, twin, ON_PROCESSOR);
            assert!(wrong.is_empty(), "{what}, sun {sun}: of {all} unlike {name} {} lie at no edge", wrong.len());
            assert!(all * 2000 <= drawn.share.len(), "{what}, sun {sun}: {all} unlike {name}");
        }
    }
}

#[test]
fn small_meshes_of_all_kinds_agree_cell_for_cell() {
    let mut suns = day();
    suns.extend([to_sun(20.0, 0.7), to_sun(180.0, 89.9)]);
    for (name, parts) in small() {
        let scene = scene_of(&Mesh::build(parts).unwrap(), Receivers::Ground, 0.0);
        agree(name, &scene, plan(40.371_93, 500), &suns);
        // a ground that cuts the model, and one far below it
        for ground in [3.3, -50.0] {
            agree(name, &Scene { ground, ..scene.clone() }, plan(40.371_93, 300), &suns[1..4]);
        }
    }
    let stacked = scene_of(&Mesh::build(vec![stack(257, 0.0)]).unwrap(), Receivers::Ground, 0.0);
    agree("257 sheets", &stacked, plan(9.0, 200), &day());
}

#[test]
fn dirty_meshes_agree_cell_for_cell() {
    let suns = [to_sun(95.3, 4.1), to_sun(171.2, 51.9), to_sun(271.6, 21.8)];
    for (name, parts) in dirty() {
        agree(name, &scene_of(&Mesh::build(parts).unwrap(), Receivers::Ground, 0.0), plan(30.371_93, 300), &suns);
    }
}

#[test]
fn triangles_in_any_disorder_agree_cell_for_cell() {
    // the same on every machine; corners are shared by chance, above, below and in the judged height
    let mut state = 7_u64;
    let mut random = |most: u64| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) % most
    };
    let mut soup = Part { name: "soup".into(), ..Part::default() };
    soup.positions = (0..120)
        .map(|_| {
            dvec3(
                random(4001) as f64 / 100.0 - 20.0,
                random(4001) as f64 / 100.0 - 20.0,
                random(17) as f64 - 4.0 + 0.001,
            )
        })
        .collect();
    soup.triangles = (0..400).map(|_| [0; 3].map(|_: u32| random(120) as u32)).collect();
    let scene = scene_of(&Mesh::build(vec![soup]).unwrap(), Receivers::Ground, 0.0);
    agree("a soup", &scene, plan(50.371_93, 500), &[to_sun(20.0, 0.7), to_sun(77.0, 12.0), to_sun(200.0, 55.0)]);
}

#[test]
fn bands_and_curves_agree_cell_for_cell() {
    // wide, so that a band has few rows and walls cross many of them
    let scene = |parts| scene_of(&Mesh::build(parts).unwrap(), Receivers::Ground, 0.0);
    let view = View::Plan(Grid { west: -60.1, north: 50.3, cell: 0.03, width: 4001, height: 700 });
    agree("a tree", &scene(dense::tree().parts), view, &[to_sun(200.0, 35.0)]);
    agree("a dome", &scene(vec![dome::dome()]), plan(60.371_93, 700), &[to_sun(100.0, 6.0), to_sun(200.0, 45.0)]);
}

#[test]
fn the_sites_agree_cell_for_cell() {
    for name in ["tower", "industry", "headquarters"] {
        let (scene, view, suns) = site(name, 600);
        let ground = Scene { receivers: scene.receivers.of_components(&[]), ..scene };
        let suns: Vec<DVec3> = suns.iter().step_by(4).copied().chain([to_sun(250.0, 4.0)]).collect();
        agree(name, &ground, view, &suns);
    }
}

#[test]
fn what_lies_within_the_millimetre_shades_nothing() {
    let slab = cuboid("slab", dvec3(-5.0, -5.0, -0.4), dvec3(5.0, 5.0, 0.0005));
    let scene = scene_of(&Mesh::build(vec![slab]).unwrap(), Receivers::Ground, 0.0);
    assert!(projected(&scene, plan(10.0, 200), to_sun(120.0, 20.0)).share.iter().all(|share| *share == 255));
}

#[test]
fn rasters_of_any_width_are_filled_to_their_borders() {
    // above all of the raster, and with its edges far beyond it
    let roof = [dvec3(-1e5, -1e5, 5.0), dvec3(1e5, -1e5, 5.0), dvec3(1e5, 1e5, 5.0), dvec3(-1e5, 1e5, 5.0)];
    let scene = scene_of(&Mesh::build(vec![sheet(roof)]).unwrap(), Receivers::Ground, 0.0);
    for (width, height) in [(1, 1), (63, 2), (64, 3), (65, 1), (128, 5), (130, 7)] {
        let view = View::Plan(Grid { west: -3.0, north: 4.0, cell: 0.5, width, height });
        let mask = projected(&scene, view, to_sun(200.0, 30.0));
        assert!(mask.share.len() == (width * height) as usize && mask.share.iter().all(|share| *share == 0));
    }
    let nothing = scene_of(&Mesh::build(vec![]).unwrap(), Receivers::Ground, 0.0);
    assert!(projected(&nothing, plan(5.0, 20), to_sun(200.0, 30.0)).share.iter().all(|share| *share == 255));
}

#[test]
fn one_wrong_cell_is_seen() {
    let (_, parts) = small().swap_remove(0);
    let scene = scene_of(&Mesh::build(parts).unwrap(), Receivers::Ground, 0.0);
    let (view, sun) = (plan(40.371_93, 300), to_sun(130.0, 30.0));
    let mut drawn = projected(&scene, view, sun);
    let at = drawn.share.iter().position(|share| *share == 0).unwrap() + 6 * 300;
    drawn.share[at] ^= 255;
    assert_eq!(differing(&scene, view, sun, &drawn, false, ON_PROCESSOR).1, [at]);
    assert_eq!(differing(&scene, view, sun, &drawn, true, ON_PROCESSOR).1, [at]);
}

/// Cells that see another receiver than a ray does; of two faces at the same height either may be seen.
fn seen_otherwise(scene: &Scene, view: View, surface: &Surface) -> Vec<usize> {
    let truth = RayCast::new(scene.clone(), view, None).surface().unwrap();
    let differs = |at: &usize| {
        let (height, right) = (surface.height_m[*at], truth.height_m[*at]);
        (height - right).abs() > 1e-4 * (1.0 + right.abs())
    };
    (0..truth.face.len()).filter(differs).collect()
}

#[test]
fn plans_see_what_rays_see() {
    let mut scenes: Vec<(String, Scene, View)> = Vec::new();
    for (name, parts) in small().into_iter().chain(dirty()) {
        let scene = scene_of(&Mesh::build(parts).unwrap(), Receivers::Top, 0.0);
        scenes.push((name.to_owned(), scene, plan(20.371_93, 300)));
    }
    for name in ["tower", "industry", "headquarters"] {
        let (scene, view, _) = site(name, 700);
        scenes.push((name.to_owned(), scene, view));
    }
    for (name, scene, view) in scenes {
        let View::Plan(grid) = view else { panic!("a plan") };
        let surface = plan_surface(&scene.receivers, scene.ground, &grid);
        let otherwise = seen_otherwise(&scene, view, &surface);
        assert!(otherwise.len() * 20_000 <= surface.face.len(), "{name}: {} cells", otherwise.len());
    }
}

#[test]
fn some_rows_of_a_plan_are_those_of_the_whole() {
    let (scene, View::Plan(grid), _) = site("industry", 333) else { panic!("a plan") };
    let whole = plan_surface(&scene.receivers, scene.ground, &grid);
    let rows = PlanSurface::new(&scene.receivers, scene.ground, &grid);
    assert_eq!(rows.cells(), whole.cells());
    let height = grid.height as usize;
    for (from, to) in [(0, height), (0, 1), (31, 33), (7, 150), (height - 40, height), (height - 1, height)] {
        let [part, right] = [rows.rows(from..to), whole.rows(from..to)];
        assert_eq!((part.width, part.height), (right.width, right.height));
        assert_eq!(part.face, right.face, "rows {from} to {to}");
        assert_eq!(part.height_m, right.height_m, "rows {from} to {to}");
        assert!(part.face.iter().any(|face| *face != Surface::GROUND) || to - from < 40);
    }
}

#[test]
fn one_face_too_low_is_seen() {
    let (scene, view, _) = site("tower", 100);
    let View::Plan(grid) = view else { panic!("a plan") };
    let mut surface = plan_surface(&scene.receivers, scene.ground, &grid);
    let before = seen_otherwise(&scene, view, &surface).len();
    let at = surface.face.iter().position(|face| *face != Surface::GROUND).unwrap();
    surface.height_m[at] -= 0.5;
    assert_eq!(seen_otherwise(&scene, view, &surface).len(), before + 1);
}

#[test]
fn what_stands_there_agrees_cell_for_cell() {
    let suns = [to_sun(95.3, 4.1), to_sun(171.2, 51.9), to_sun(271.6, 21.8), to_sun(20.0, 0.7), to_sun(180.0, 89.9)];
    for (name, parts) in small().into_iter().chain(dirty()) {
        let scene = scene_of(&Mesh::build(parts).unwrap(), Receivers::Top, 0.0);
        agree(name, &scene, plan(30.371_93, 300), &suns);
    }
    let many = dense::tree().parts;
    agree("a tree", &scene_of(&Mesh::build(many).unwrap(), Receivers::Top, 0.0), plan(17.371_93, 400), &suns);
}

#[test]
fn sites_agree_on_what_stands_there() {
    for name in ["tower", "industry", "headquarters"] {
        let (scene, view, suns) = site(name, 500);
        let suns: Vec<DVec3> = suns.iter().step_by(5).copied().chain([to_sun(250.0, 4.0)]).collect();
        agree(name, &scene, view, &suns);
    }
}

#[test]
fn what_does_not_receive_is_looked_through() {
    let (scene, view, suns) = site("headquarters", 300);
    let keep: Vec<bool> = (0..scene.receivers.components.len()).map(|at| at % 2 == 0).collect();
    let half = scene.receivers.of_components(&keep);
    agree("half receives", &Scene { receivers: half.clone(), ..scene.clone() }, view, &suns[..2]);
    let casters = scene.casters.of_components(&keep);
    agree("half casts", &Scene { casters, ..scene }, view, &suns[..2]);
}

/// Compares the adapter's mask of the ground with ray casting's, sun by sun; returns how many cells differ at edges.
fn agree_on_gpu(gpu: &Arc<Gpu>, what: &str, scene: &Scene, view: View, suns: &[DVec3]) -> usize {
    let View::Plan(grid) = view else { panic!("a plan") };
    let mut technique = ProjectedOnGpu::new(Arc::clone(gpu), scene, grid).unwrap();
    let mut at_edges = 0;
    for &sun in suns {
        let drawn = draw(&mut technique, sun);
        let (all, wrong) = differing(scene, view, sun, &drawn, false, ON_GPU);
        assert!(wrong.is_empty(), "{what}, sun {sun}: of {all} unlike ray casting {} lie at no edge", wrong.len());
        assert!(all * 500 <= drawn.share.len(), "{what}, sun {sun}: {all} unlike ray casting");
        at_edges += all;
    }
    at_edges
}

#[test]
fn the_adapter_draws_the_ground_as_rays_do() {
    let gpu = Arc::new(Gpu::open().unwrap());
    let suns = [to_sun(95.3, 4.1), to_sun(171.2, 51.9), to_sun(271.6, 21.8), to_sun(20.0, 0.7), to_sun(180.0, 89.9)];
    for (name, parts) in small().into_iter().chain(dirty()) {
        let scene = scene_of(&Mesh::build(parts).unwrap(), Receivers::Ground, 0.0);
        agree_on_gpu(&gpu, name, &scene, plan(40.371_93, 500), &suns);
        for ground in [3.3, -50.0] {
            agree_on_gpu(&gpu, name, &Scene { ground, ..scene.clone() }, plan(40.371_93, 300), &suns[..3]);
        }
    }
    agree_on_gpu(
        &gpu,
        "a tree",
        &scene_of(&Mesh::build(dense::tree().parts).unwrap(), Receivers::Ground, 0.0),
        plan(17.371_93, 700),
        &suns[..3],
    );
    for name in ["tower", "industry", "headquarters"] {
        let (scene, view, suns) = site(name, 600);
        let ground = Scene { receivers: scene.receivers.of_components(&[]), ..scene };
        let suns: Vec<DVec3> = suns.iter().step_by(4).copied().chain([to_sun(250.0, 4.0)]).collect();
        agree_on_gpu(&gpu, name, &ground, view, &suns);
    }
}

#[test]
fn the_adapter_rounds_corners_and_no_more() {
    // an edge drawn 1/40 of a cell beside its place is found
    let gpu = Arc::new(Gpu::open().unwrap());
    let (_, parts) = small().swap_remove(0);
    let scene = scene_of(&Mesh::build(parts).unwrap(), Receivers::Ground, 0.0);
    let (View::Plan(grid), sun) = (plan(40.371_93, 500), to_sun(131.0, 31.0)) else { panic!("a plan") };
    let beside = Grid { west: grid.west + grid.cell / 40.0, ..grid };
    let drawn = draw(&mut ProjectedOnGpu::new(gpu, &scene, beside).unwrap(), sun);
    let (_, wrong) = differing(&scene, View::Plan(grid), sun, &drawn, false, ON_GPU);
    assert!(!wrong.is_empty());
}
