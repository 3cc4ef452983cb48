//! The drawings, checked by numbers. With GNOMON_PICTURES=FOLDER they are also written for people to look at.

use super::camera;
use super::synthetic::{self, Town};
use glam::DVec3;
use gnomon::choice::Receivers;
use gnomon::export::figure::scale::{self, Bands};
use gnomon::export::figure::{self, PictureExtras, ScaleBar};
use gnomon::profile::Profile;
use gnomon::sun::ZoneRules;
use gnomon::view::{Camera, Mask, Overlay, Surface, View};

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
    eprintln!("{name}: {:.0} ms, {} kB", start.elapsed().as_secs_f64() * 1e3, png.len() / 1000);
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
    thirty.drawn.adapter = Some(
        "NVIDIA GeForce RTX 4090 Laptop GPU (Vulkan, driver 560.94.0.0, Some Extremely Long Vendor Text Included)"
            .to_owned(),
    );
    draw("thirty", &thirty, (1400, 1000), 0.22, Receivers::Top);
    let tiny = Town::new(2.0 / 300.0, 9 * H, 17 * H, 1800);
    draw("tiny", &tiny, (800, 700), 0.0025, Receivers::Top);
    let mut huge = Town::new(60.0, 9 * H, 17 * H, 1800);
    huge.place.name = "東京 Δοκιμή Тест \u{7}".to_owned();
    draw("huge", &huge, (2048, 2048), 10.0, Receivers::Top);
}

#[test]
fn windows_without_sun() {
    let night = Town::new(1.0, 21 * H, 23 * H, 1800);
    draw("night", &night, (300, 200), 1.0, Receivers::Top);
    let mut nameless = Town::new(1.0, 12 * H, 13 * H, 3600);
    nameless.place.name = String::from(" \u{0} ");
    nameless.track.days.clear();
    let kathmandu = ZoneRules::newest().zone("Asia/Kathmandu").unwrap();
    nameless.place.time_zone = kathmandu;
    for instant in &mut nameless.track.instants {
        instant.time = instant.time.with_timezone(&kathmandu);
    }
    draw("nameless", &nameless, (1, 300), 1.0, Receivers::Top);
}

#[test]
fn instants() {
    let look = |name: &str, town: &Town, surface: &Surface, view: View, mask: &Mask, receivers| {
        let png = figure::instant(&town.scene(surface, receivers), &view, mask, &PictureExtras::default()).unwrap();
        keep(name, &png);
    };
    let town = Town::new(1.0, 15 * H, 15 * H, 0);
    let grid = synthetic::grid(1500, 1000, 0.2);
    let surface = synthetic::plan(&town.mesh, &grid);
    let sun = &town.track.instants[0];
    for receivers in [Receivers::Top, Receivers::Ground] {
        let mut mask = synthetic::mask(&surface, &grid, sun, receivers);
        mask.share[0] = 100;
        look(&format!("instant-{receivers:?}"), &town, &surface, View::Plan(grid), &mask, receivers);
    }
    let night = Town::new(1.0, 21 * H, 21 * H, 0);
    let at = |town: &Town, name: &str, eye: DVec3, up: DVec3| {
        let target = DVec3::new(0.0, 0.0, 15.0);
        let lens = Camera { eye, target, up, fov_rad: 0.7, width: 1200, height: 800 };
        let to_sun = town.track.instants[0].to_sun;
        let (surface, mut mask) = camera::photograph(&town.mesh, &lens, to_sun);
        if to_sun.z < 0.0 {
            mask.share.fill(0);
        }
        look(name, town, &surface, View::Camera(lens), &mask, Receivers::Top);
    };
    at(&town, "camera", DVec3::new(150.0, -230.0, 130.0), DVec3::Z);
    at(&town, "street", DVec3::new(-120.0, -230.0, 30.0), DVec3::Z);
    at(&night, "street-night", DVec3::new(120.0, -230.0, 30.0), DVec3::Z);
    at(&town, "down", DVec3::new(0.0, 0.0, 300.0), DVec3::Y);
    // Along its own up a camera sees nothing that makes sense, but the sheet is still drawn.
    at(&town, "askew", DVec3::new(0.0, 0.0, 300.0), DVec3::Z);
}

/// Pixels of a drawing in exactly this colour.
fn in_colour(png: &[u8], colour: [u8; 3]) -> usize {
    image::load_from_memory(png).unwrap().to_rgb8().pixels().filter(|pixel| pixel.0 == colour).count()
}

#[test]
fn overlays_and_components() {
    let town = Town::new(1.0, 15 * H, 15 * H, 0);
    let (eye, target) = (DVec3::new(150.0, -230.0, 130.0), DVec3::new(0.0, 0.0, 15.0));
    let lens = Camera { eye, target, up: DVec3::Z, fov_rad: 0.7, width: 300, height: 200 };
    let (surface, mask) = camera::photograph(&town.mesh, &lens, town.track.instants[0].to_sun);
    let scene = town.scene(&surface, Receivers::Top);
    let draw = |shown: &PictureExtras| figure::instant(&scene, &View::Camera(lens), &mask, shown);
    let cells = 600 * 400;
    let mut overlay = Overlay { width: 600, height: 400, layers: None, silhouette: Some(vec![0; cells]) };
    overlay.silhouette.as_mut().unwrap()[..cells / 4].fill(255);
    let black = [10, 10, 12];
    let lines = draw(&PictureExtras { overlay: Some(&overlay), casts: None, ..PictureExtras::default() }).unwrap();
    let picture = in_colour(&lines, black);
    let plain = in_colour(&draw(&PictureExtras::default()).unwrap(), black);
    assert!(picture > 1_000_000 && plain == 0, "{picture} black pixels, {plain} without a silhouette");

    // many layers hide no more than some do
    let with = |layers: u8| {
        let overlay = Overlay { width: 600, height: 400, layers: Some(vec![layers; cells]), silhouette: None };
        let png = draw(&PictureExtras { overlay: Some(&overlay), casts: None, ..PictureExtras::default() }).unwrap();
        image::load_from_memory(&png).unwrap().to_rgb8().get_pixel(1700, 1500).0
    };
    let tones = [0, 1, 2, 8, 255].map(with);
    assert!(tones.windows(2).take(3).all(|pair| pair[0][2] > pair[1][2]), "each layer is yellower: {tones:?}");
    assert_eq!(tones[3], tones[4], "and then they are as opaque as they get");

    let [casting, not] = [[true], [false]]
        .map(|casts| draw(&PictureExtras { overlay: None, casts: Some(&casts), ..PictureExtras::default() }).unwrap());
    keep("component", &casting);
    let mint = [139, 212, 188];
    assert!(in_colour(&casting, mint) > 3000 && in_colour(&not, mint) == 0, "{}", in_colour(&casting, mint));

    overlay.width = 601;
    assert!(
        draw(&PictureExtras { overlay: Some(&overlay), casts: None, ..PictureExtras::default() }).is_err(),
        "a raster of another size"
    );
}

/// CIE L* of an sRGB colour (IEC 61966-2-1 and CIE 15).
fn lightness(rgb: [u8; 3]) -> f64 {
    let linear = rgb.map(|part| {
        let part = f64::from(part) / 255.0;
        if part <= 0.04045 { part / 12.92 } else { ((part + 0.055) / 1.055).powf(2.4) }
    });
    let y = 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2];
    if y > 0.008856 { 116.0 * y.cbrt() - 16.0 } else { 903.3 * y }
}

#[test]
fn more_shadow_is_darker() {
    for bands in [Bands::new(1800, 8 * H), Bands::new(H, 4 * H), Bands::new(1800, 7 * H)] {
        let tones = [scale::NO_SHADOW].into_iter().chain(bands.colours.iter().copied());
        let tones: Vec<f64> = tones.map(lightness).collect();
        let steps: Vec<f64> = tones.windows(2).map(|pair| pair[0] - pair[1]).collect();
        assert!(steps.iter().all(|step| *step > 2.0), "{tones:?}");
        // The lightest band differs from none as clearly as from its neighbour; the darkest still shows a black line.
        assert!(steps[0] > 3.0 && tones[tones.len() - 1] > 18.0, "{tones:?}");
    }
}

#[test]
fn bands_are_steps_or_round() {
    let width = |step, day| Bands::new(step, day).band_secs;
    assert_eq!(width(1800, 8 * H), 1800, "sixteen half hours");
    assert_eq!(width(1200, 10 * H), H, "thirty steps of 20 min: the next multiple that is round");
    assert_eq!(width(90, H), 900, "a multiple of 90 s");
    assert_eq!(width(35 * 60, 7 * H), 35 * 60, "few steps stay steps");
    assert_eq!(width(0, 0), 1);
    assert!(Bands::new(60, u32::MAX).colours.len() <= 16);

    let bands = Bands::new(1800, 8 * H - 900);
    assert_eq!(bands.colours.len(), 16);
    assert_eq!(bands.bounds(15), (7 * H + 1800, 8 * H - 900), "the last band ends with the daylight");
    let at = |secs: u32| bands.colour(255 * u64::from(secs));
    assert_eq!(at(0), scale::NO_SHADOW);
    assert_eq!((at(1), at(1800), at(1801)), (bands.colours[0], bands.colours[0], bands.colours[1]));
    assert_eq!(at(8 * H - 900), bands.colours[15]);
    assert_eq!(at(20 * H), bands.colours[15]);
}

#[test]
fn scale_bars_are_round() {
    for power in -60..60 {
        let metres_a_pixel = 10_f64.powf(f64::from(power) / 10.0);
        let bar = ScaleBar::within(metres_a_pixel, 500.0);
        let digits = bar.metres / 10_f64.powf((bar.metres * 1.000001).log10().floor());
        assert!([1.0_f64, 2.0, 5.0].iter().any(|d| (d - digits).abs() < 1e-6), "{bar:?}");
        assert!(bar.pixels > 190.0 && bar.pixels < 500.001, "{bar:?}");
    }
    let label = |metres_a_pixel| ScaleBar::within(metres_a_pixel, 500.0).label();
    assert_eq!(label(0.1), "50 m");
    assert_eq!(label(2.0), "1 km");
    assert_eq!(label(0.001), "50 cm");
    assert_eq!(label(1e-5), "5 mm");
}

#[test]
fn the_legend_is_the_plan() {
    let town = Town::new(1.0, 9 * H, 17 * H, 1800);
    let grid = synthetic::grid(6, 6, 1.0);
    let surface = Surface { width: 6, height: 6, face: vec![Surface::GROUND; 36], height_m: vec![0.0; 36] };
    // Row by row: none, then more and more shadow.
    let shaded: Vec<u32> = (0..36).map(|cell| cell / 6 * 255 * 5400).collect();
    let profile: Profile = Profile { grid, shaded: shaded.into(), day_secs: 8 * H, night_secs: 0 };
    let png = figure::profile(&town.scene(&surface, Receivers::Top), &profile).unwrap();
    let page = image::load_from_memory(&png).unwrap().to_rgb8();
    assert_eq!(page.dimensions(), (figure::WIDTH, figure::HEIGHT));
    let bands = Bands::new(1800, 8 * H);
    for row in 0..6 {
        // The square plan is the sheet's left part, a little inside of its frame.
        let y = figure::HEIGHT / 2 - 1100 + row * 2200 / 6 + 180;
        let plan = page.get_pixel(1300, y).0;
        assert_eq!(plan, bands.colour(u64::from(row) * 255 * 5400), "row {row}");
        let in_panel = |x: u32| (0..figure::HEIGHT).filter(|y| page.get_pixel(x, *y).0 == plan).count();
        let swatch = (2600..figure::WIDTH).map(in_panel).max().unwrap();
        assert!(swatch >= 30, "row {row}: the legend shows {plan:?} over {swatch} pixels");
    }
}

#[test]
fn a_surface_of_another_size_is_an_error() {
    let town = Town::new(1.0, 9 * H, 17 * H, 1800);
    let grid = synthetic::grid(4, 3, 1.0);
    let surface = synthetic::plan(&town.mesh, &synthetic::grid(3, 3, 1.0));
    let profile: Profile = Profile { grid, shaded: vec![0_u32; 12].into(), day_secs: 8 * H, night_secs: 0 };
    assert!(figure::profile(&town.scene(&surface, Receivers::Top), &profile).is_err());
    let mask = Mask { width: 4, height: 3, share: vec![0; 12] };
    assert!(
        figure::instant(&town.scene(&surface, Receivers::Top), &View::Plan(grid), &mask, &PictureExtras::default())
            .is_err()
    );
}
