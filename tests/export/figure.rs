//! The drawings, looked at by numbers; with GNOMON_PICTURES=FOLDER they are also kept to be looked at by people.

use super::synthetic::{self, Town};
use glam::DVec3;
use gnomon::export::figure;
use gnomon::site::Receivers;
use gnomon::view::{Camera, View};

fn keep(name: &str, png: &[u8]) {
    if let Some(folder) = std::env::var_os("GNOMON_PICTURES") {
        let path = std::path::Path::new(&folder).join(format!("{name}.png"));
        gnomon::export::file::write(&path, png).unwrap();
    }
}

fn draw(name: &str, town: &Town, (w, h): (u32, u32), cell: f64, receivers: Receivers) -> Vec<u8> {
    let grid = synthetic::grid(w, h, cell);
    let surface = synthetic::plan(&town.mesh, &grid);
    let profile = synthetic::profile(town, &surface, grid, receivers);
    let start = std::time::Instant::now();
    let png = figure::profile(&town.scene(&surface, receivers), &profile).unwrap();
    eprintln!(
        "{name}: {:.0} ms, {} kB",
        start.elapsed().as_secs_f64() * 1e3,
        png.len() / 1000
    );
    keep(name, &png);
    png
}

const H: u32 = 3600;

#[test]
fn extremes() {
    let town = Town::new(1.0, 9 * H, 17 * H, 1800);
    draw("top", &town, (1500, 1000), 0.2, Receivers::Top);
    draw("ground", &town, (1200, 1200), 0.24, Receivers::Ground);
    draw("wide", &town, (1600, 400), 0.2, Receivers::Top);
    draw("tall", &town, (300, 1200), 0.2, Receivers::Top);
    draw("line", &town, (900, 1), 0.2, Receivers::Top);
    let four = Town::new(1.0, 10 * H, 14 * H, 3600);
    draw("four", &four, (150, 100), 2.0, Receivers::Top);
    let mut thirty = Town::new(1.0, 4 * H + H / 2, 20 * H, 1200);
    thirty.place.name = "Österreichische Gesellschaft für <Besonnung> & Beschattung, Außenstelle Neusiedl am See, Bürogebäude an der Donaudampfschifffahrtsgesellschaftskapitänsallee".to_owned();
    thirty.place.latitude_deg = -48.2;
    thirty.drawn.adapter = Some("NVIDIA GeForce RTX 4090 Laptop GPU (Vulkan, driver 560.94.0.0, Some Extremely Long Vendor Text Included)".to_owned());
    draw("thirty", &thirty, (1400, 1000), 0.22, Receivers::Top);
    let tiny = Town::new(2.0 / 300.0, 9 * H, 17 * H, 1800);
    draw("tiny", &tiny, (800, 700), 0.0025, Receivers::Top);
    let mut huge = Town::new(60.0, 9 * H, 17 * H, 1800);
    huge.place.name = "東京 Δοκιμή Тест \u{7}".to_owned();
    draw("huge", &huge, (2048, 2048), 10.0, Receivers::Top);
}

#[test]
fn instants() {
    let town = Town::new(1.0, 15 * H, 15 * H, 0);
    let grid = synthetic::grid(1500, 1000, 0.2);
    let surface = synthetic::plan(&town.mesh, &grid);
    let sun = &town.track.instants[0];
    let mask = synthetic::mask(&surface, &grid, sun, Receivers::Top);
    let png = figure::instant(
        &town.scene(&surface, Receivers::Top),
        &View::Plan(grid),
        &mask,
    )
    .unwrap();
    keep("instant", &png);
    let camera = Camera {
        eye: DVec3::new(150.0, -230.0, 130.0),
        target: DVec3::new(0.0, 0.0, 15.0),
        up: DVec3::Z,
        fov_rad: 0.7,
        width: 1200,
        height: 900,
    };
    let (surface, mask) = synthetic::photograph(&town.mesh, &camera, sun.to_sun);
    let png = figure::instant(
        &town.scene(&surface, Receivers::Top),
        &View::Camera(camera),
        &mask,
    )
    .unwrap();
    keep("camera", &png);
}
