//! How soon a picture follows the hand: the real window on all three sites, drawn at every frame, while the day's slider
//! or the eye is dragged; and the view's own picture by each technique. `cargo bench --bench window` prints three tables.

use eframe::egui::{Event, Pos2, Role, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use gnomon::desktop::{self, App};
use gnomon::gpu::Gpu;
use gnomon::shadow::picture::{Picture, Style};
use gnomon::site::{Method, Overrides, Settings, Site};
use gnomon::study::live::{Live, Way};
use gnomon::view::{Camera, View};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

const SITES: [&str; 3] = ["tower", "industry", "headquarters"];
const SIZE: [f32; 2] = [1920.0, 1080.0];
const STYLE: Style = Style { focus_m: 300.0, lines: 1.0, wide_lines: false, tinted: false, hours: false };
/// Pictures of each kind; the median counts.
const PICTURES: usize = 11;
/// How long the hand moves without a pause.
const MOVING: Duration = Duration::from_secs(4);

fn main() {
    let gpu = Arc::new(Gpu::open().expect("a graphics adapter"));
    println!("{}{}", gpu.name(), if gpu.software() { ", a program on the processor" } else { "" });
    if let Ok(load) = std::fs::read_to_string("/proc/loadavg") {
        println!("load of the machine at the beginning: {}", load.trim());
    }
    let [width, height] = SIZE;
    println!(
        "\nThe window at {width} × {height}: pictures a second while the hand moves, milliseconds from one event to its"
    );
    println!("picture on the screen (median and worst of {PICTURES}), and of a whole frame when nothing moves\n");
    println!(
        "| site | hand on | pictures a second | latency | worst | size of the picture | still frame | whole picture |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for name in SITES {
        for on in ["the day", "the eye"] {
            follow(name, on);
        }
    }
    println!("\nThe picture alone: milliseconds from the wish to its end, median of {PICTURES}\n");
    println!("| site | size | technique | sun moves | eye moves |\n|---|---|---|---|---|");
    for name in SITES {
        let site = Site::load(&path(name), &Overrides::default()).expect("a sample");
        for (width, height) in [(490, 275), (1920, 1080)] {
            for method in [Method::RayCast, Method::ShadowMap, Method::Smoothie, Method::Hybrid, Method::Stencil] {
                let [sun, eye] = measure(&site, &gpu, (width, height), method);
                println!("| {name} | {width} × {height} | {method} | {sun:.1} | {eye:.1} |");
            }
        }
    }
}

fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("sites").join(name)
}

/// The window follows a hand, and says how soon.
fn follow(name: &str, on: &str) {
    let mut window = open(name);
    let (from, to) = hand(&window, on);
    window.hover_at(from);
    frame(&mut window);
    window.drag_at(from);
    frame(&mut window);
    // a zigzag that goes to a new place at every move
    let mut moves = 0;
    let mut next = || {
        moves += 1;
        let along = (moves * 7 % 97) as f32 / 97.0;
        Event::PointerMoved(from.lerp(to, along))
    };
    // without a pause: how many pictures come, and not how soon
    let began = Instant::now();
    let (mut pictures, mut before) = (0, window.state().shown());
    while began.elapsed() < MOVING {
        window.event(next());
        frame(&mut window);
        let now = window.state().shown();
        pictures += usize::from(now != before);
        before = now;
    }
    let a_second = pictures as f64 / began.elapsed().as_secs_f64();
    // one at a time: how soon
    let mut latencies: Vec<f64> = (0..PICTURES)
        .map(|_| {
            until(&mut window, |window| !window.state().is_drawing());
            let before = window.state().shown();
            let began = Instant::now();
            window.event(next());
            until(&mut window, |window| window.state().shown() != before);
            began.elapsed().as_secs_f64() * 1e3
        })
        .collect();
    latencies.sort_by(f64::total_cmp);
    let size = window.state().shown().map_or((0, 0), |(view, _)| view.size());
    window.drop_at(to);
    // the hand rests: the whole picture comes
    let began = Instant::now();
    until(&mut window, |window| window.state().is_settled());
    let whole = began.elapsed().as_secs_f64() * 1e3;
    let began = Instant::now();
    (0..PICTURES).for_each(|_| frame(&mut window));
    let still = began.elapsed().as_secs_f64() * 1e3 / PICTURES as f64;
    let [median, worst] = [PICTURES / 2, PICTURES - 1].map(|at| latencies[at]);
    let (width, height) = size;
    println!(
        "| {name} | {on} | {a_second:.1} | {median:.0} | {worst:.0} | {width} × {height} | {still:.1} | {whole:.0} |"
    );
}

fn open(name: &str) -> Harness<'static, App> {
    let path = path(name);
    let mut window = Harness::<App>::builder()
        .with_size(SIZE)
        .wgpu_setup(desktop::setup())
        .build_eframe(move |cc| App::new(cc, Some(&path)).expect("an adapter"));
    until(&mut window, |window| window.state().is_settled());
    window
}

/// Where a hand takes hold, and how far it goes.
fn hand(window: &Harness<'_, App>, on: &str) -> (Pos2, Pos2) {
    if on == "the day" {
        let rect = window.get_by_label_contains("Time of day").rect();
        (rect.center() - vec2(rect.width() * 0.12, 0.0), rect.center() + vec2(rect.width() * 0.12, 0.0))
    } else {
        let rect = window.get_by_role_and_label(Role::Image, "Model").rect();
        let from = rect.left_bottom() + vec2(120.0, -80.0);
        (from, from + vec2(300.0, -40.0))
    }
}

/// One frame of the window, drawn as it is shown.
fn frame(window: &mut Harness<'_, App>) {
    window.step();
    window.render().expect("a frame");
}

fn until(window: &mut Harness<'_, App>, is_so: impl Fn(&Harness<'_, App>) -> bool) {
    let began = Instant::now();
    while !is_so(window) {
        frame(window);
        assert!(began.elapsed() < Duration::from_secs(120), "the picture does not come");
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
