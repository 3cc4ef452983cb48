//! What is flush with the ground is seen before it: a plot in its plane is one colour and no noise, in every view and by
//! everything that draws.

use crate::shared::drawing::{gpu, to_sun};
use crate::shared::scenes::{cuboid, sheet};
use glam::{DVec2, DVec3, dvec3};
use gnomon::gpu::readback;
use gnomon::mesh::{Mesh, Part};
use gnomon::picture::{Picture, Style};
use gnomon::shadow::projected::Projected;
use gnomon::shadow::ray_cast::{RayCast, RayCaster};
use gnomon::shadow::stencil::Stencil;
use gnomon::shadow::{DrawnMask, FlushFaces, GpuSurface, PlanSurface, Scene, Technique, plan_surface};
use gnomon::silhouette::ProcessorFinder;
use gnomon::view::{Camera, Elevation, Grid, Mask, Surface, SurfaceRows, View};
use std::collections::BTreeSet;
use wgpu::TextureAspect;

/// The height of the ground: single precision has no such number.
const LEVEL: f64 = 37.3;
/// The plot's side, and the lawn's within it, from the middle.
const PLOT: f64 = 30.0;
const LAWN: f64 = 12.0;

/// A sheet as many triangles, turned within its plane, whose corners lie by turns a little above and below the ground.
fn flush_sheet(name: &str, half: f64, squares: u32, off_m: f64) -> Part {
    let mut part = Part { name: name.into(), ..Part::default() };
    let place = |index: u32| half * (2.0 * f64::from(index) / f64::from(squares) - 1.0);
    for row in 0..=squares {
        for column in 0..=squares {
            let z = if (row + column) % 2 == 0 { LEVEL + off_m } else { LEVEL - off_m };
            part.positions.push(dvec3(place(column), place(row), z));
        }
    }
    for row in 0..squares {
        for column in 0..squares {
            let here = row * (squares + 1) + column;
            let above = here + squares + 1;
            part.triangles.extend([[here, here + 1, above + 1], [here, above + 1, above]]);
        }
    }
    part
}

/// A house on a plot, with a lawn on the plot; the first of these two is the one that is seen.
fn scene(first: &str, off_m: f64) -> Scene {
    let plot = flush_sheet("plot", PLOT, 3, off_m);
    let lawn = flush_sheet("lawn", LAWN, 7, off_m / 2.0);
    let house = cuboid("house", dvec3(-4.0, -3.0, LEVEL), dvec3(5.0, 6.0, LEVEL + 8.0));
    let far =
        sheet([dvec3(200.0, 0.0, 40.0), dvec3(201.0, 0.0, 40.0), dvec3(201.0, 1.0, 41.0), dvec3(200.0, 1.0, 41.0)]);
    let parts = if first == "plot" { vec![plot, lawn, house, far] } else { vec![house, lawn, plot, far] };
    let mesh = Mesh::build(parts).unwrap();
    Scene { casters: mesh.of_components(&[true; 4]), receivers: mesh, ground: LEVEL }
}

fn cameras() -> Vec<Camera> {
    let camera = |eye: DVec3, fov_deg: f64| Camera {
        eye: eye + DVec3::Z * LEVEL,
        target: dvec3(0.0, 0.0, LEVEL),
        up: DVec3::Z,
        fov_rad: fov_deg.to_radians(),
        width: 320,
        height: 200,
    };
    let low = camera(dvec3(14.0, -60.0, 1.7), 50.0);
    vec![camera(dvec3(60.0, -80.0, 70.0), 40.0), low, camera(dvec3(-700.0, 400.0, 300.0), 5.0)]
}

fn grid() -> Grid {
    Grid { west: -40.3, north: 41.7, cell: 0.25, width: 330, height: 320 }
}

/// Where a pixel's ray meets the ground's plane.
fn on_ground(view: &View, column: u32, row: u32) -> Option<DVec2> {
    match view {
        View::Plan(grid) => Some(grid.centre(column, row)),
        View::Camera(camera) => {
            let along = camera.lens().direction(column, row);
            let distance = (LEVEL - camera.eye.z) / along.z;
            (distance > 0.0).then(|| (camera.eye + along * distance).truncate())
        }
        View::Elevation(_) => None,
    }
}

/// Which component a pixel shows where that is known: not near borders, nor where the house may stand before it.
fn expected(scene: &Scene, view: &View, nearest: &[u32], at: usize) -> Option<&'static str> {
    let (width, height) = view.size();
    let (column, row) = (at as u32 % width, at as u32 / width);
    if column == 0 || row == 0 || column + 1 == width || row + 1 == height {
        return None;
    }
    let mut found = BTreeSet::new();
    for (column, row) in (column - 1..=column + 1).flat_map(|column| (row - 1..=row + 1).map(move |row| (column, row)))
    {
        let place = on_ground(view, column, row)?.abs().max_element();
        let is_open = !matches!(name(scene, nearest[(row * width + column) as usize]), "house" | "sheet" | "sky");
        found.insert(if !is_open {
            return None;
        } else if place < LAWN {
            "lawn"
        } else if place < PLOT {
            "plot"
        } else {
            "ground"
        });
    }
    let here = if found.len() == 1 { found.first().copied() } else { None };
    // the plot lies under the lawn
    let is_plot_first = scene.receivers.components[0].name == "plot";
    here.map(|here| if here == "lawn" && is_plot_first { "plot" } else { here })
}

fn name(scene: &Scene, face: u32) -> &str {
    match face {
        Surface::GROUND => "ground",
        Surface::SKY => "sky",
        face => {
            let part = scene.receivers.components.iter().find(|part| part.faces.contains(&face));
            part.map_or("", |part| part.name.as_str())
        }
    }
}

/// Pixels that show another component than they must, and how many are known to show plot or lawn.
fn wrong(scene: &Scene, view: &View, faces: &[u32]) -> (usize, usize) {
    let nearest = RayCast::new(Scene { receivers: without_flush(scene), ..scene.clone() }, *view, None).faces();
    // without plot and lawn the house's faces have other numbers
    let house = Scene { receivers: without_flush(scene), ..scene.clone() };
    let nearest: Vec<u32> = nearest
        .iter()
        .map(|face| match name(&house, *face) {
            "house" => scene.receivers.components.iter().find(|part| part.name == "house").unwrap().faces.start,
            _ if *face == Surface::SKY => Surface::SKY,
            _ => Surface::GROUND,
        })
        .collect();
    let mut counted = (0, 0);
    for (at, face) in faces.iter().enumerate() {
        let Some(right) = expected(scene, view, &nearest, at) else { continue };
        counted.0 += usize::from(name(scene, *face) != right);
        counted.1 += usize::from(right != "ground");
    }
    counted
}

fn without_flush(scene: &Scene) -> Mesh {
    let stands: Vec<bool> = scene.receivers.components.iter().map(|part| part.name == "house").collect();
    scene.receivers.of_components(&stands)
}

fn views() -> Vec<View> {
    let mut views: Vec<View> = cameras().into_iter().map(View::Camera).collect();
    views.push(View::Plan(grid()));
    views
}

/// The scenes: exactly in the plane, and by as little off it as counts.
fn scenes() -> Vec<Scene> {
    let kinds = [("plot", 0.0), ("lawn", 0.0), ("plot", 0.0004), ("lawn", 0.0009)];
    kinds.map(|(first, off_m)| scene(first, off_m)).into()
}

#[test]
fn every_surface_shows_the_first_flush_face() {
    for (number, scene) in scenes().iter().enumerate() {
        for view in views() {
            let mut surfaces = vec![
                ("rays", RayCast::new(scene.clone(), view, None).surface().unwrap()),
                ("adapter", GpuSurface::draw(gpu(), scene, view).unwrap().read().unwrap()),
                (
                    "stencil",
                    Stencil::new(gpu(), scene.clone(), view, ProcessorFinder::Hierarchy).unwrap().surface().unwrap(),
                ),
            ];
            if let View::Plan(grid) = view {
                surfaces.push(("plan", plan_surface(&scene.receivers, LEVEL, &grid)));
                surfaces.push(("projected", Projected::new(scene, grid).surface().unwrap()));
                let rows = PlanSurface::new(&scene.receivers, LEVEL, &grid);
                surfaces.push(("rows", rows.rows(0..grid.height as usize)));
            }
            for (who, surface) in surfaces {
                let (wrong, known) = wrong(scene, &view, &surface.face);
                assert!(known > 900, "scene {number}, {who}, {view:?}: {known} pixels show plot or lawn");
                assert_eq!(wrong, 0, "scene {number}, {who}, {view:?}: of {known} pixels");
            }
        }
    }
}

/// Noise is seen, and so is one pixel.
#[test]
fn one_wrong_pixel_is_seen() {
    let scene = scene("plot", 0.0004);
    let view = View::Camera(cameras()[0]);
    let cast = RayCast::new(scene.clone(), view, None);
    let mut faces = cast.faces();
    assert_eq!(wrong(&scene, &view, &faces).0, 0);
    let middle = faces.len() / 2 + 320 * 60 + 160;
    faces[middle] = Surface::GROUND;
    assert_eq!(wrong(&scene, &view, &faces).0, 1);
    // what is nearest is noise: of a plot that is rough by less than a millimetre the ground shows every second hollow
    let (noise, known) = wrong(&scene, &view, &nearest_along_rays(&scene, &cameras()[0]));
    assert!(noise * 10 > known, "{noise} of {known} pixels");
}

/// What is nearest along a camera's rays: a face or the ground.
fn nearest_along_rays(scene: &Scene, camera: &Camera) -> Vec<u32> {
    let rays = RayCaster::new(&scene.receivers, 1000.0);
    let from = camera.eye - scene.receivers.origin;
    let nearest = |(row, column): (u32, u32)| {
        let along = camera.lens().direction(column, row);
        let to_ground = (LEVEL - camera.eye.z) / along.z;
        match rays.first_hit(from, along) {
            Some((face, away)) if to_ground <= 0.0 || away <= to_ground => face,
            _ if to_ground > 0.0 => Surface::GROUND,
            _ => Surface::SKY,
        }
    };
    let pixels = (0..camera.height).flat_map(|row| (0..camera.width).map(move |column| (row, column)));
    pixels.map(nearest).collect()
}

/// Colours of all pixels of the window's picture that show the plot.
fn colours(scene: &Scene, view: View, faces: Option<&[u32]>) -> BTreeSet<[u8; 4]> {
    let mut picture = Picture::new(gpu(), scene, view).unwrap();
    picture.look_at(scene, view, faces).unwrap();
    let tints = [[200, 60, 40], [60, 160, 70], [90, 90, 220], [10, 10, 10]];
    let parts = scene.receivers.components.iter().zip(tints);
    picture.tint(parts.flat_map(|(part, colour)| std::iter::repeat_n(colour, part.faces.len())));
    let (width, height) = view.size();
    let mask = Mask { width, height, share: vec![255; (width * height) as usize] };
    let style = Style { focus_m: 1e6, lines: 0.0, wide_lines: false, tinted: true, hours: false };
    let target = Picture::target(&gpu(), &view);
    picture.draw(&DrawnMask::Memory(&mask), to_sun(170.0, 50.0), &style, &target).unwrap();
    let pixels: Vec<[u8; 4]> = readback::texels(&gpu(), &target, TextureAspect::All).unwrap();
    let house = Scene { receivers: without_flush(scene), ..scene.clone() };
    let nearest = RayCast::new(house.clone(), view, None).faces();
    let is_open = |at: usize| nearest[at] == Surface::GROUND;
    let in_plot = |at: usize| {
        let (column, row) = (at as u32 % width, at as u32 / width);
        on_ground(&view, column, row).is_some_and(|place| place.abs().max_element() < PLOT - 2.0)
    };
    let width = width as usize;
    let around = |at: usize| [at, at.saturating_sub(1), at + 1, at.saturating_sub(width), at + width];
    let open = |at: &usize| around(*at).iter().all(|at| *at < pixels.len() && is_open(*at) && in_plot(*at));
    (0..pixels.len()).filter(open).map(|at| pixels[at]).collect()
}

/// In the window a plot with a lawn on it has one colour, whether the adapter or rays find what is seen.
#[test]
fn a_plot_has_one_colour_in_the_window() {
    let scene = scene("plot", 0.0);
    for view in views() {
        let by_rays = RayCast::new(scene.clone(), view, None).faces();
        let of_adapter = colours(&scene, view, None);
        assert_eq!(of_adapter.len(), 1, "{view:?}: {of_adapter:?}");
        assert_eq!(of_adapter, colours(&scene, view, Some(&by_rays)), "{view:?}");
        // the comparator sees what was drawn before: here and there the ground
        let noise: Vec<u32> =
            by_rays.iter().enumerate().map(|(at, face)| if at % 7 == 0 { Surface::GROUND } else { *face }).collect();
        assert!(colours(&scene, view, Some(&noise)).len() > 1, "{view:?}");
    }
}

/// Masks are those of the plane: what is judged is the nearest, as if no rule said what is seen.
#[test]
fn masks_are_those_of_the_bare_ground() {
    for scene in scenes() {
        let bare = Scene { receivers: without_flush(&scene), casters: without_flush(&scene), ..scene.clone() };
        let scene = Scene { casters: without_flush(&scene), ..scene };
        for view in views() {
            let mut own = RayCast::new(scene.clone(), view, None);
            let mut plain = RayCast::new(bare.clone(), view, None);
            for sun in [to_sun(170.0, 50.0), to_sun(240.0, 12.0)] {
                let [own, plain] = [&mut own, &mut plain].map(|cast| cast.draw(sun).unwrap().read().unwrap().share);
                let differing = own.iter().zip(&plain).filter(|(own, plain)| own != plain).count();
                // a face that lies up to a millimetre higher moves the edge of a shadow by as much
                assert!(differing * 2_000 <= own.len(), "{view:?}: {differing} pixels");
            }
        }
    }
}

/// A side sees no flush face, and a camera sees what stands there before it.
#[test]
fn nothing_that_stands_there_is_covered() {
    let scene = scene("lawn", 0.0);
    let side =
        Elevation { target: dvec3(0.0, 0.0, LEVEL + 4.0), to_viewer: DVec3::NEG_Y, cell: 0.25, width: 160, height: 64 };
    let surface = RayCast::new(scene.clone(), View::Elevation(side), None).surface().unwrap();
    let shown: BTreeSet<&str> = surface.face.iter().map(|face| name(&scene, *face)).collect();
    assert_eq!(shown, BTreeSet::from(["house", "ground", "sky"]));
    for view in views() {
        let bare = Scene { receivers: without_flush(&scene), ..scene.clone() };
        let house = |scene: &Scene, faces: &[u32]| faces.iter().filter(|face| name(scene, **face) == "house").count();
        let of_bare = house(&bare, &RayCast::new(bare.clone(), view, None).faces());
        let own = house(&scene, &RayCast::new(scene.clone(), view, None).faces());
        assert!(of_bare > 500 && own.abs_diff(of_bare) * 200 <= of_bare, "{view:?}: {own} of {of_bare} pixels");
    }
}

/// What leans, stands or lies deeper is not flush; of two flush faces the first is found, wherever both lie.
#[test]
fn flush_faces_are_found_exactly() {
    let at = |z: f64| [dvec3(-1.0, -1.0, z), dvec3(1.0, -1.0, z), dvec3(1.0, 1.0, z), dvec3(-1.0, 1.0, z)];
    let mut leaning = at(0.0);
    leaning[2].z = 0.002;
    let curb = [dvec3(-1.0, 0.0, -0.0004), dvec3(1.0, 0.0, -0.0004), dvec3(1.0, 0.0, 0.0004), dvec3(-1.0, 0.0, 0.0004)];
    for corners in [at(0.0011), at(-0.0011), leaning, curb] {
        let mesh = Mesh::build(vec![sheet(corners)]).unwrap();
        assert!(FlushFaces::new(&mesh, 0.0).is_none(), "{corners:?}");
    }
    let mesh = Mesh::build(vec![sheet(at(0.0005)), sheet(at(0.0)), sheet(at(-0.0009))]).unwrap();
    let flush = FlushFaces::new(&mesh, 0.0).unwrap();
    for index in 0..400 {
        let place = dvec3(f64::from(index % 20) * 0.099 - 0.95, f64::from(index / 20) * 0.097 - 0.93, 3.0);
        let seen = flush.seen(Surface::GROUND, (place - mesh.origin, dvec3(0.01, 0.02, -1.0).normalize()));
        assert!(seen < 2, "{place}: face {seen}");
        assert_eq!(flush.seen(Surface::SKY, (place - mesh.origin, DVec3::NEG_Z)), Surface::SKY);
    }
}
