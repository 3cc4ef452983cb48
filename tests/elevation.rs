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
