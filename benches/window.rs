//! How quickly the picture follows the mouse: the real window on all three sites, drawn at every frame while the day's
//! slider or the eye is dragged; and the view's own picture by each technique. `cargo bench --bench window` prints two
//! tables.

mod screen;
mod timing;

use eframe::egui::{Event, Modifiers, PointerButton, Pos2, Role, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use glam::DVec3;
use gnomon::choice::{Method, Settings};
use gnomon::desktop::App;
use gnomon::gpu::Gpu;
use gnomon::picture::{Picture, Style};
use gnomon::site::{Overrides, Site};
use gnomon::study::live::{Live, LiveMethod};
use gnomon::view::{Camera, View};
use screen::Screen;
use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};
use timing::{median, timed};

const SITES: [&str; 3] = ["tower", "industry", "headquarters"];
const SIZE: [u32; 2] = [1920, 1080];
const STYLE: Style = Style { focus_m: 300.0, lines: 1.0, wide_lines: false, tinted: false, hours: false };
/// Pictures of each kind; the median counts.
const PICTURES: usize = 11;
/// How long the hand moves without a pause.
const MOVING: Duration = Duration::from_secs(6);

fn main() {
    let gpu = Arc::new(Gpu::open().expect("a graphics adapter"));
    println!("{}{}", gpu.name(), if gpu.software() { ", a program on the processor" } else { "" });
    if let Ok(load) = std::fs::read_to_string("/proc/loadavg") {
        println!("load of the machine at the beginning: {}", load.trim());
    }
    let [width, height] = SIZE;
    println!("\nThe window at {width} × {height}, while a hand moves without a pause for {} s\n", MOVING.as_secs());
    println!(
        "| site | hand on | pictures a second | latency, ms | 95% | frame, ms | 95% | processor, ms a picture | \
         size of the picture | still frame, ms | whole picture, ms |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|");
    // `cargo bench --bench window -- tower` measures that one
    let named: Vec<String> = std::env::args().skip(1).filter(|name| !name.starts_with("--")).collect();
    let sites: Vec<&str> =
        SITES.into_iter().filter(|site| named.is_empty() || named.iter().any(|name| name == site)).collect();
    for &name in &sites {
        for on in ["the day", "the eye"] {
            line(name, on);
        }
    }
    println!("\nThe picture alone: milliseconds from the wish to its end, median of {PICTURES}\n");
    println!("| site | size | technique | sun moves | eye moves |\n|---|---|---|---|---|");
    for &name in &sites {
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

/// The window, and the clock that it reads, so that pauses of the hand have their real length, not that of the harness.
struct Real {
    window: Harness<'static, App>,
    began: Instant,
}

impl Real {
    /// A site in the window, once all is drawn.
    fn open(name: &str) -> Real {
        let path = path(name);
        let [width, height] = SIZE;
        let window = Harness::<App>::builder()
            .with_size(SIZE.map(|side| side as f32))
            .renderer(Screen::new(width, height))
            .build_eframe(move |cc| App::new(cc, Some(&path)).expect("an adapter"));
        let mut real = Real { window, began: Instant::now() };
        real.until(App::is_settled);
        real
    }

    /// One frame, drawn to its end: milliseconds.
    fn frame(&mut self, event: Option<Event>) -> f64 {
        let began = Instant::now();
        self.window.input_mut().time = Some(self.began.elapsed().as_secs_f64());
        if let Some(event) = event {
            self.window.event(event);
        }
        self.window.step();
        self.window.render().expect("a frame");
        began.elapsed().as_secs_f64() * 1e3
    }

    fn app(&self) -> &App {
        self.window.state()
    }

    fn until(&mut self, is_so: impl Fn(&App) -> bool) {
        let began = Instant::now();
        while !is_so(self.app()) {
            self.frame(None);
            assert!(began.elapsed() < Duration::from_secs(120), "the picture does not come");
        }
    }
}

/// The measurements for a hand that moves without a pause.
#[derive(Default)]
struct Followed {
    /// Milliseconds of each frame.
    frames: Vec<f64>,
    /// From the beginning of the frame that took a movement in to the end of the first one that shows it, milliseconds.
    latencies: Vec<f64>,
    secs: f64,
    /// The processor time of all threads, seconds.
    processor_secs: f64,
}

/// Follows the mouse for a given time. A picture is identified by the request for which it was drawn.
fn follow(real: &mut Real, next: &mut impl FnMut() -> Event, time: Duration) -> Followed {
    let mut followed = Followed::default();
    let mut asked: VecDeque<((View, DVec3), Instant)> = VecDeque::new();
    let mut before = real.app().picture_view();
    let (began, took) = (Instant::now(), processor_secs());
    while began.elapsed() < time {
        let taken = Instant::now();
        followed.frames.push(real.frame(Some(next())));
        asked.push_back((real.app().wanted_view().expect("a wish"), taken));
        let shown = real.app().picture_view();
        if shown == before {
            continue;
        }
        before = shown;
        let found = shown.and_then(|shown| asked.iter().position(|(asked, _)| shows(&shown, asked)));
        if let Some(at) = found {
            followed.latencies.push(asked[at].1.elapsed().as_secs_f64() * 1e3);
            asked.drain(..=at);
        }
    }
    followed.secs = began.elapsed().as_secs_f64();
    followed.processor_secs = processor_secs() - took;
    followed
}

/// The processor time of this program so far, seconds. Unlike elapsed time, it does not depend on other programs. NaN
/// if the system does not report it.
fn processor_secs() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields: Vec<f64> =
        stat.rsplit(')').next().unwrap_or_default().split_whitespace().flat_map(str::parse).collect();
    // user and system time, in hundredths of a second; the state before them is a letter
    fields.get(10..12).map_or(f64::NAN, |times| times.iter().sum::<f64>() / 100.0)
}

/// Whether a picture, of any size, shows what was requested.
fn shows((view, to_sun): &(View, DVec3), (asked, asked_sun): &(View, DVec3)) -> bool {
    let (View::Camera(camera), View::Camera(asked)) = (view, asked) else { return false };
    to_sun == asked_sun && camera.eye == asked.eye && camera.target == asked.target
}

/// A line of the first table.
fn line(name: &str, on: &str) {
    let mut real = Real::open(name);
    let (from, to) = hand(&real.window, on);
    let modifiers = Modifiers::default();
    real.frame(Some(Event::PointerMoved(from)));
    real.frame(Some(Event::PointerButton { pos: from, button: PointerButton::Primary, pressed: true, modifiers }));
    // a zigzag that goes to a new place at every frame
    let mut moves = 0;
    let mut next = || {
        moves += 1;
        Event::PointerMoved(from.lerp(to, (moves * 7 % 97) as f32 / 97.0))
    };
    // until the size of the picture is found, and on a cold start all shaders are compiled
    while follow(&mut real, &mut next, Duration::from_secs(2)).latencies.len() < 3 {}
    let Followed { frames, latencies, secs, processor_secs } = follow(&mut real, &mut next, MOVING);
    let (width, height) = real.app().picture_view().expect("a picture").0.size();
    let a_second = latencies.len() as f64 / secs;
    let a_picture = processor_secs * 1e3 / latencies.len() as f64;
    // the hand rests: the whole picture comes
    let began = Instant::now();
    real.frame(Some(Event::PointerButton { pos: to, button: PointerButton::Primary, pressed: false, modifiers }));
    real.until(App::is_settled);
    let whole = began.elapsed().as_secs_f64() * 1e3;
    let still = median((0..PICTURES).map(|_| real.frame(None)).collect());
    println!(
        "| {name} | {on} | {a_second:.1} | {:.0} | {:.0} | {:.0} | {:.0} | {a_picture:.0} | {width} × {height} | {still:.0} | \
         {whole:.0} |",
        median(latencies.clone()),
        most(latencies),
        median(frames.clone()),
        most(frames),
    );
}

/// The 95th percentile.
fn most(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times.get(times.len() * 95 / 100).copied().unwrap_or(f64::NAN)
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

/// Median milliseconds of a picture for another sun, and for another eye.
fn measure(site: &Site, gpu: &Arc<Gpu>, (width, height): (u32, u32), method: Method) -> [f64; 2] {
    let way = LiveMethod { method, settings: Settings::default() };
    let camera = Camera { width, height, ..site.camera };
    let view = |step: usize| {
        let eye = camera.eye + camera.up * step as f64 * 0.7;
        View::Camera(Camera { eye, ..camera })
    };
    let mut live = Live::new(site, Arc::clone(gpu), view(0)).expect("a picture");
    let target = Picture::target(gpu, &view(0));
    let suns: Vec<_> = site.track.instants.iter().filter(|instant| !instant.night).map(|it| it.to_sun).collect();
    let mut draw = |eye: usize, sun: usize| {
        let mut times = Vec::new();
        timed(&mut times, || {
            live.look_at(view(eye));
            live.draw(&way, suns[sun % suns.len()], &STYLE, &target).expect("a picture");
            gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("an end");
        });
        times[0]
    };
    draw(0, 0);
    let by_sun: Vec<f64> = (1..=PICTURES).map(|sun| draw(0, sun)).collect();
    let by_eye: Vec<f64> = (1..=PICTURES).map(|eye| draw(eye, 1)).collect();
    [median(by_sun), median(by_eye)]
}
