//! How soon a picture follows the hand: the view's own picture on all three sites, for a sun that moves, for an eye that
//! moves, in milliseconds. `cargo bench --bench window` prints a table.

use gnomon::gpu::Gpu;
use gnomon::shadow::picture::{Picture, Style};
use gnomon::site::{Method, Overrides, Settings, Site};
use gnomon::study::live::{Live, Way};
use gnomon::view::{Camera, View};
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

const STYLE: Style = Style { focus_m: 300.0, lines: 1.0, wide_lines: false, tinted: false, hours: false };
/// Pictures of each kind; the median counts.
const PICTURES: usize = 15;

fn main() {
    let gpu = Arc::new(Gpu::open().expect("a graphics adapter"));
    println!("{}{}", gpu.name(), if gpu.software() { ", a program on the processor" } else { "" });
    println!("milliseconds from the wish to the finished picture, median of {PICTURES}\n");
    println!("| site | size | technique | sun moves | eye moves |\n|---|---|---|---|---|");
    for name in ["tower", "industry", "headquarters"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("sites").join(name);
        let site = Site::load(&path, &Overrides::default()).expect("a sample");
        for (width, height) in [(490, 275), (1920, 1080)] {
            for method in [Method::RayCast, Method::ShadowMap, Method::Stencil] {
                let [sun, eye] = measure(&site, &gpu, (width, height), method);
                println!("| {name} | {width} × {height} | {method} | {sun:.1} | {eye:.1} |");
            }
        }
    }
}

/// Median milliseconds of a picture for another sun, and for another eye.
fn measure(site: &Site, gpu: &Arc<Gpu>, (width, height): (u32, u32), method: Method) -> [f64; 2] {
    let way = Way { method, settings: Settings::default() };
    let camera = Camera { width, height, ..site.camera };
    let view = |step: usize| {
        let eye = camera.eye + camera.up * step as f64 * 0.7;
        View::Camera(Camera { eye, ..camera })
    };
    let mut live = Live::new(site, Arc::clone(gpu), view(0)).expect("a picture");
    let target = Picture::target(gpu, &view(0));
    let suns: Vec<_> = site.track.instants.iter().filter(|instant| !instant.night).map(|it| it.to_sun).collect();
    let mut draw = |eye: usize, sun: usize| {
        let begun = Instant::now();
        live.look_at(view(eye));
        live.draw(&way, suns[sun % suns.len()], &STYLE, &target).expect("a picture");
        gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("an end");
        begun.elapsed().as_secs_f64() * 1e3
    };
    draw(0, 0);
    let mut by_sun: Vec<f64> = (1..=PICTURES).map(|sun| draw(0, sun)).collect();
    let mut by_eye: Vec<f64> = (1..=PICTURES).map(|eye| draw(eye, 1)).collect();
    [&mut by_sun, &mut by_eye].map(|times| {
        times.sort_by(f64::total_cmp);
        times[PICTURES / 2]
    })
}
