//! A view that is drawn repeatedly gives the same picture as a single instant.

use crate::shared::drawing::gpu;
use gnomon::choice::{Method, Settings};
use gnomon::gpu::readback;
use gnomon::picture::{Picture, Style};
use gnomon::site::{Ground, Overrides, Site};
use gnomon::study::live::{Live, LiveMethod};
use gnomon::view::{Camera, Grid, View};
use std::path::Path;
use wgpu::TextureAspect;

const STYLE: Style = Style { focus_m: 300.0, lines: 1.0, wide_lines: false, tinted: false, hours: false };

fn way(method: Method) -> LiveMethod {
    LiveMethod { method, settings: Settings::default() }
}

/// Whatever was looked at before, a view's picture is the one that a new start draws; and every exact technique's is the same
/// but for cells at an edge.
#[test]
fn turning_leaves_no_trace() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("sites/industry");
    let site = Site::load(&path, &Overrides::default()).unwrap();
    let gpu = gpu();
    let camera = Camera { width: 320, height: 200, ..site.camera };
    let other = Camera { eye: camera.eye + camera.up * 30.0, width: 200, height: 160, ..camera };
    let [sun, early] = [3, 0].map(|at| site.track.instants[at].to_sun);
    let drawn = |live: &mut Live, method| {
        let target = Picture::target(&gpu, &View::Camera(camera));
        live.draw(&way(method), sun, &STYLE, &target).unwrap();
        readback::texels::<[u8; 4]>(&gpu, &target, TextureAspect::All).unwrap()
    };
    let mut rays = None;
    for method in [Method::RayCast, Method::Stencil, Method::Hybrid, Method::ShadowMap, Method::Smoothie] {
        let mut fresh = Live::new(&site, gpu.clone(), View::Camera(camera)).unwrap();
        let wanted = drawn(&mut fresh, method);
        // a corner first, so that what was seen there is too little for what comes
        let corner = View::Plan(Grid { width: 60, height: 40, ..site.grid });
        let mut turned = Live::new(&site, gpu.clone(), corner).unwrap();
        for view in [corner, View::Camera(other)] {
            turned.look_at(view);
            turned.draw(&way(method), early, &STYLE, &Picture::target(&gpu, &view)).unwrap();
        }
        turned.look_at(View::Camera(camera));
        assert!(drawn(&mut turned, method) == wanted, "{method}: another picture after turning");
        let rays = rays.get_or_insert_with(|| wanted.clone());
        let differ = rays.iter().zip(&wanted).filter(|(a, b)| a != b).count();
        let is_exact = !matches!(method, Method::ShadowMap | Method::Smoothie);
        assert!(!is_exact || differ * 200 < wanted.len(), "{method}: {differ} pixels differ from ray casting");
        let night = Picture::target(&gpu, &View::Camera(camera));
        turned.draw(&way(method), -sun, &STYLE, &night).unwrap();
        let night: Vec<[u8; 4]> = readback::texels(&gpu, &night, TextureAspect::All).unwrap();
        assert!(night != wanted, "{method}: night is dark");
    }
}

/// A part that casts no more is gone from the picture as if it had never cast, and what receives is another scene.
#[test]
fn casters_change_and_leave_no_trace() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("sites/tower");
    let site = Site::load(&path, &Overrides { size: Some(300), ..Overrides::default() }).unwrap();
    let gpu = gpu();
    let faces = |at: &usize| site.mesh.components[*at].faces.len();
    let largest = (0..site.casts.len()).filter(|at| site.casts[*at]).max_by_key(faces).unwrap();
    let mut casts = site.casts.clone();
    casts[largest] = false;
    let without = Site { casts, ..site.clone() };
    let sun = site.track.instants[3].to_sun;
    let views = [View::Camera(Camera { width: 320, height: 200, ..site.camera }), View::Plan(site.grid)];
    for method in [Method::RayCast, Method::Stencil, Method::Hybrid, Method::ShadowMap, Method::Smoothie] {
        let drawn = |live: &mut Live, view| {
            let target = Picture::target(&gpu, &view);
            live.look_at(view);
            live.draw(&way(method), sun, &STYLE, &target).unwrap();
            readback::texels::<[u8; 4]>(&gpu, &target, TextureAspect::All).unwrap()
        };
        let mut changed = Live::new(&site, gpu.clone(), views[0]).unwrap();
        for view in views {
            let mut fresh = Live::new(&without, gpu.clone(), view).unwrap();
            let wanted = drawn(&mut fresh, view);
            assert!(changed.change_to(&site));
            assert!(drawn(&mut changed, view) != wanted, "{method}: the part throws a shadow");
            assert!(changed.change_to(&without));
            assert!(drawn(&mut changed, view) == wanted, "{method}: the part still throws a shadow");
        }
        let receives = without.casts.clone();
        assert!(!changed.change_to(&Site { receives, ..site.clone() }));
        assert!(!changed.change_to(&Site { ground: Ground::asked(site.ground.level + 1.0), ..site.clone() }));
        assert!(!changed.change_to(&Site::load(&path, &Overrides::default()).unwrap()), "another mesh");
    }
}
