//! A side along parallel rays: what it sees and what shades it, against closed forms.

use crate::shared::dense::cuboid;
use crate::shared::drawing::{gpu, to_sun};
use glam::{DVec3, dvec3};
use gnomon::choice::{Method, Settings};
use gnomon::export::figure;
use gnomon::mesh::Mesh;
use gnomon::shadow::ray_cast::RayCast;
use gnomon::shadow::{GpuSurface, Scene, Technique};
use gnomon::site::{Overrides, Site};
use gnomon::study::live::{Live, LiveMethod};
use gnomon::study::{self, InstantWants};
use gnomon::view::{Elevation, Surface, View};
use std::ops::ControlFlow;
use std::path::Path;

/// A wall that begins below the ground, and a post two metres before it, from the south.
fn scene() -> (Scene, Elevation) {
    let wall = cuboid("wall", dvec3(-4.0, 0.0, -2.0), dvec3(4.0, 3.0, 10.0));
    let post = cuboid("post", dvec3(-0.5, -3.0, 0.0), dvec3(0.5, -2.0, 6.0));
    let mesh = Mesh::build(vec![wall, post]).unwrap();
    let side = Elevation { target: dvec3(0.0, 40.0, 5.0), to_viewer: DVec3::NEG_Y, cell: 0.25, width: 64, height: 56 };
    (Scene { casters: mesh.clone(), receivers: mesh, ground: 0.0 }, side)
}

/// What a point of the picture shows: the component (0 the wall, 1 the post), the earth or the sky.
fn expected(x: f64, z: f64) -> u32 {
    match () {
        () if z < 0.0 => Surface::GROUND,
        () if x.abs() < 0.5 && z < 6.0 => 1,
        () if x.abs() < 4.0 && z < 10.0 => 0,
        () => Surface::SKY,
    }
}

#[test]
fn side_is_true_to_scale_and_earth_is_cut() {
    let (scene, side) = scene();
    let view = View::Elevation(side);
    let cast = RayCast::new(scene.clone(), view, None).surface().unwrap();
    let wall = scene.receivers.components[0].faces.end;
    for row in 0..side.height {
        for column in 0..side.width {
            let (x, z) = ((f64::from(column) + 0.5) * 0.25 - 8.0, 12.0 - (f64::from(row) + 0.5) * 0.25);
            let at = (row * side.width + column) as usize;
            let component = match cast.face[at] {
                face if face >= Surface::GROUND => face,
                face => u32::from(face >= wall),
            };
            assert_eq!(component, expected(x, z), "at {x}, {z}");
            if expected(x, z) < Surface::GROUND {
                assert!((f64::from(cast.height_m[at]) - z).abs() < 1e-5, "at {x}, {z}: {}", cast.height_m[at]);
            }
        }
    }
    // the adapter sees the same
    let drawn = GpuSurface::draw(gpu(), &scene, view).unwrap().read().unwrap();
    assert_eq!(drawn.face, cast.face);
}

/// The post's shadow on the wall: its corners, moved along the sun.
#[test]
fn shadow_on_a_wall_lies_where_it_must() {
    let (scene, side) = scene();
    let altitude_deg = 25.0f64;
    let drop = 2f64.sqrt() * altitude_deg.to_radians().tan();
    let mut cast = RayCast::new(scene, View::Elevation(side), None);
    let sun = to_sun(225.0, altitude_deg);
    let mask = cast.draw(sun).unwrap().read().unwrap();
    let mut dark = 0;
    for row in 0..side.height {
        for column in 0..side.width {
            let (x, z) = ((f64::from(column) + 0.5) * 0.25 - 8.0, 12.0 - (f64::from(row) + 0.5) * 0.25);
            // a metre before the wall is a metre to the east and a drop down
            let shaded = x > 1.5 && x < 3.5 && z < 6.0 - 2.0 * drop - (x - 2.5).max(0.0) * drop;
            let share = if expected(x, z) == 0 && shaded { 0 } else { 255 };
            assert_eq!(mask.share[(row * side.width + column) as usize], share, "at {x}, {z}");
            assert_eq!(cast.share_without_trees(column, row, sun), share, "at {x}, {z}, without trees");
            dark += usize::from(share == 0);
        }
    }
    assert!(dark > 100, "{dark} cells in shadow");
}

#[test]
fn no_other_technique_draws_a_side() {
    let site = Path::new(env!("CARGO_MANIFEST_DIR")).join("sites/industry");
    let site = Site::load(&site, &Overrides::default()).unwrap();
    let view = View::Elevation(scene().1);
    let mut live = Live::new(&site, gpu(), view).unwrap();
    let target = gnomon::picture::Picture::target(&gpu(), &view);
    let style = gnomon::picture::Style { focus_m: 1.0, lines: 1.0, wide_lines: false, tinted: false, hours: false };
    for method in [Method::Stencil, Method::Projected, Method::ShadowMap, Method::Hybrid, Method::SoftTexture] {
        let way = LiveMethod { method, settings: Settings::default() };
        let fault = live.draw(&way, to_sun(180.0, 40.0), &style, &target).expect_err("a fault").to_string();
        assert!(fault.contains("technique: ") && fault.contains("ray-cast"), "{method}: {fault}");
    }
    for method in [Method::Auto, Method::RayCast] {
        let way = LiveMethod { method, settings: Settings::default() };
        let drawn = live.draw(&way, to_sun(180.0, 40.0), &style, &target).unwrap();
        assert_eq!(drawn.technique, Method::RayCast, "{method}");
    }
}

/// The sheet has a scale bar and says from where it looks; a north arrow stands by plans alone.
#[test]
fn the_sheet_of_a_side_has_no_north_arrow() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("sites/industry");
    let site = Site::load(&path, &Overrides { size: Some(500), ..Overrides::default() }).unwrap();
    let (low, high) = site.mesh.bounds().unwrap();
    let target = (low + high) / 2.0;
    let side = Elevation { target, to_viewer: DVec3::NEG_Y, cell: 0.4, width: 800, height: 500 };
    let accents = |view: View| {
        let wants = InstantWants { surface: true, ..InstantWants::default() };
        let outcome = study::instant(&site, view, &wants, &mut |_| ControlFlow::Continue(())).unwrap();
        let scene = figure::FigureContext {
            place: &site.place,
            track: &site.track,
            mesh: &outcome.surface_mesh,
            surface: outcome.surface.as_ref().unwrap(),
            receivers: study::judged(&site, &view),
            ground: site.ground,
            drawn: &outcome.drawn,
        };
        let png = figure::instant(&scene, &view, &outcome.mask, &figure::PictureExtras::default()).unwrap();
        let page = image::load_from_memory(&png).unwrap().to_rgb8();
        let arrow =
            page.enumerate_pixels().filter(|(_, y, pixel)| y * 5 > page.height() * 4 && pixel.0 == [190, 82, 44]);
        arrow.count()
    };
    assert!(accents(View::Plan(site.grid)) > 500);
    assert_eq!(accents(View::Elevation(side)), 0);
}

/// What a sun sees of the scene, and how much of that sun each pixel sees.
fn seen_from_sun(viewer: DVec3, sun: DVec3) -> (Surface, Vec<u8>, Elevation) {
    let (scene, _) = scene();
    let box_of = (dvec3(-4.0, -3.0, 0.0), dvec3(4.0, 3.0, 10.0));
    let side = Elevation::from_sun(viewer, box_of, [160, 100], [].into_iter());
    let mut cast = RayCast::new(scene, View::Elevation(side), None);
    let surface = cast.surface().unwrap();
    let mask = cast.draw(sun).unwrap().read().unwrap();
    (surface, mask.share, side)
}

/// The pixels in shadow that are not at an edge of what is seen: their neighbours see the same component.
fn dark_inside((surface, shares, side): &(Surface, Vec<u8>, Elevation)) -> usize {
    let (width, height) = (side.width as usize, side.height as usize);
    let part = |at: usize| match surface.face[at] {
        face if face < Surface::GROUND => u32::from(face >= 12),
        face => face,
    };
    let is_inside = |at: usize| {
        let (column, row) = (at % width, at / width);
        let around = (row.saturating_sub(1)..=(row + 1).min(height - 1))
            .flat_map(|row| (column.saturating_sub(1)..=(column + 1).min(width - 1)).map(move |column| (row, column)));
        around.map(|(row, column)| part(row * width + column)).all(|other| other == part(at))
    };
    (0..shares.len()).filter(|at| shares[*at] == 0 && is_inside(*at)).count()
}

/// What the sun sees is lit, and nothing else is seen from there: the ground fills what the models leave, however low the
/// sun stands.
#[test]
fn what_the_sun_sees_is_lit() {
    for (azimuth, altitude) in [(200.0, 40.0), (95.0, 8.0), (310.0, 1.0), (180.0, 89.9), (45.0, 63.0)] {
        let sun = to_sun(azimuth, altitude);
        let seen = seen_from_sun(sun, sun);
        assert_eq!(dark_inside(&seen), 0, "from {azimuth}°, {altitude}°");
        let (surface, shares, _) = &seen;
        let dark = shares.iter().filter(|share| **share == 0).count();
        assert!(dark * 100 < shares.len(), "{dark} dark pixels at edges");
        let models = surface.face.iter().filter(|face| **face < Surface::GROUND).count();
        assert!(models > 1000, "{models} pixels of models");
        for (face, height) in surface.face.iter().zip(&surface.height_m) {
            assert_ne!(*face, Surface::SKY);
            assert!(*face != Surface::GROUND || height.abs() < 1e-4, "ground at {height}");
        }
    }
    // the comparison can fail: a sun that stands aside sees other things
    let seen = seen_from_sun(to_sun(200.0, 40.0), to_sun(215.0, 40.0));
    assert!(dark_inside(&seen) > 50);
}

/// From the sun the models are whole in the picture, about its middle and as large as they can be; from the zenith it is
/// the plan.
#[test]
fn the_suns_picture_holds_the_models() {
    for (azimuth, altitude) in [(200.0, 40.0), (95.0, 8.0), (0.0, 75.0)] {
        let sun = to_sun(azimuth, altitude);
        let (surface, _, side) = seen_from_sun(sun, sun);
        let (width, height) = (side.width as usize, side.height as usize);
        let seen = (0..surface.face.len()).filter(|at| surface.face[*at] < Surface::GROUND);
        let places: Vec<_> = seen.map(|at| (at % width, at / width)).collect();
        let ends = |of: &dyn Fn(&(usize, usize)) -> usize| {
            let all = places.iter().map(of);
            (all.clone().min().unwrap(), all.max().unwrap())
        };
        let ((west, east), (north, south)) = (ends(&|at| at.0), ends(&|at| at.1));
        assert!(west >= 3 && east < width - 3 && north >= 2 && south < height - 2, "{west} {east} {north} {south}");
        let fills = ((east - west) as f64 / width as f64).max((south - north) as f64 / height as f64);
        assert!(fills > 0.75, "{fills} from {azimuth}°, {altitude}°");
    }
    let side = Elevation { to_viewer: DVec3::Z, ..seen_from_sun(to_sun(180.0, 60.0), DVec3::Z).2 };
    assert_eq!(side.axes(), [DVec3::X, DVec3::Y, DVec3::NEG_Z]);
    // and right and up stand on the rays
    let side = Elevation { to_viewer: to_sun(123.0, 34.0), ..side };
    let [right, up, forward] = side.axes();
    assert!(right.dot(up).abs() < 1e-12 && up.dot(forward).abs() < 1e-12 && right.z == 0.0 && up.z > 0.0);
}

/// All pictures of a study have one scale, and a night has none.
#[test]
fn pictures_from_the_sun_have_one_scale() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("sites/industry");
    let site = Site::load(&path, &Overrides { size: Some(100), ..Overrides::default() }).unwrap();
    let cells: Vec<f64> = site
        .track
        .instants
        .iter()
        .filter_map(|instant| match site.sun_view(instant.to_sun)? {
            View::Elevation(side) => Some(side.cell),
            view => panic!("{view:?}"),
        })
        .collect();
    assert!(cells.len() > 2 && cells.iter().all(|cell| *cell == cells[0]), "{cells:?}");
    assert_eq!(site.sun_view(dvec3(0.6, 0.0, -0.8)), None);
}
