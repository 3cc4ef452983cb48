//! Contours against the cells that they separate, one by one.

use gnomon::choice::{Engine, Receivers};
use gnomon::contour::{Contour, ScalarField, contours};
use gnomon::site::{Overrides, Site};
use gnomon::study::{self, Wants};
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::Path;

/// How often lines cross between a cell and its eastern (or southern) neighbour, and whether a drawn one does.
type Crossed = BTreeMap<(usize, usize), (usize, bool)>;

/// All pairs of neighbours that are crossed; half-open, so that a corner right between two cells counts once.
fn crossed(contours: &[Contour], [width, height]: [usize; 2]) -> Crossed {
    let mut crossed = Crossed::new();
    for contour in contours {
        for (at, from) in contour.points.iter().enumerate() {
            let to = contour.points[(at + 1) % contour.points.len()];
            for (along, across, counts) in [(0, 1, [width, height]), (1, 0, [height, width])] {
                for line in 0..counts[1] {
                    let middle = line as f64 + 0.5;
                    if (from[across] < middle) == (to[across] < middle) {
                        continue;
                    }
                    let share = (middle - from[across]) / (to[across] - from[across]);
                    let place = from[along] + (to[along] - from[along]) * share - 0.5;
                    // beyond the outermost centres a line runs along the border
                    if place <= 0.0 || place >= (counts[0] - 1) as f64 {
                        assert!(!contour.drawn[at] || place.abs() < 0.5 || place - (counts[0] as f64) < -0.5);
                        continue;
                    }
                    assert!((place - place.round()).abs() > 0.005, "a line through a centre");
                    let cell = |place: usize| if along == 0 { line * width + place } else { place * width + line };
                    let pair = (cell(place as usize), cell(place as usize + 1));
                    let (count, drawn) = crossed.entry(pair).or_default();
                    *count += 1;
                    *drawn |= contour.drawn[at];
                }
            }
        }
    }
    crossed
}

/// A line crosses between two neighbours once if one is above the threshold and the other is not, and otherwise never;
/// and it is drawn where allowed. Returns how many pairs are separated.
fn agree(field: &ScalarField, threshold: u64, contours: &[Contour]) -> usize {
    let [width, height] = [field.width, field.height].map(|count| count as usize);
    let crossed = crossed(contours, [width, height]);
    let mut parted = 0;
    for cell in 0..width * height {
        for (exists, next) in [(cell % width + 1 < width, cell + 1), (cell / width + 1 < height, cell + width)] {
            if !exists {
                continue;
            }
            let apart = ((field.value)(cell) > threshold) != ((field.value)(next) > threshold);
            let (count, drawn) = crossed.get(&(cell, next)).copied().unwrap_or_default();
            assert_eq!(count, usize::from(apart), "{width} × {height}, {threshold}: {cell} and {next}");
            assert!(
                !apart || !(field.open)(cell, next) || drawn,
                "{cell} and {next} are parted by a line that is not drawn"
            );
            parted += usize::from(apart);
        }
    }
    parted
}

/// Steps of a linear congruential generator (Knuth's MMIX).
fn random(seed: u64) -> impl FnMut(u64) -> u64 {
    let mut state = seed;
    move |most| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) % most
    }
}

#[test]
fn lines_part_what_the_numbers_part() {
    let mut all = 0;
    for seed in 0..400 {
        let mut random = random(seed);
        let (width, height) = (1 + random(14) as u32, 1 + random(14) as u32);
        let count = (width * height) as usize;
        // large patches and specks, with saddles
        let levels = [2, 3, 9][seed as usize % 3];
        let values: Vec<u64> = (0..count).map(|_| random(levels)).collect();
        let walls: Vec<bool> = (0..count).map(|_| random(5) == 0).collect();
        let (value, open) = (|cell: usize| values[cell], |a: usize, _| !walls[a]);
        let field = ScalarField { width, height, value: &value, open: &open };
        for threshold in 0..levels {
            all += agree(&field, threshold, &contours(&field, threshold));
        }
    }
    assert!(all > 20_000, "{all} pairs");
}

#[test]
fn no_line_is_drawn_along_the_border() {
    let (width, height) = (7, 5);
    let field = ScalarField { width, height, value: &|_| 1, open: &|_, _| true };
    let [all] = &contours(&field, 0)[..] else { panic!("one patch") };
    assert_eq!((all.area(), all.lines().len()), (35.0, 0));
    // a strip across, up to both borders
    let field = ScalarField { width, height, value: &|cell| u64::from(cell % 7 > 2), open: &|_, _| true };
    let [strip] = &contours(&field, 0)[..] else { panic!("one patch") };
    let mut line = strip.lines().concat();
    line.sort_by(|a, b| a[1].total_cmp(&b[1]));
    assert_eq!((strip.area(), line), (20.0, vec![[3.0, 0.0], [3.0, 5.0]]));
    // a hole has its own, the other way round
    let field = ScalarField { width, height, value: &|cell| u64::from(cell != 17), open: &|_, _| true };
    let areas: Vec<f64> = contours(&field, 0).iter().map(Contour::area).collect();
    assert_eq!(areas, [35.0, -0.5]);
}

/// Two cells that touch at a corner are connected if their mean with the other two is above the threshold.
#[test]
fn saddles_hang_together_by_their_mean() {
    for values in [[9, 0, 0, 9], [0, 9, 9, 0]] {
        let field = ScalarField { width: 2, height: 2, value: &|cell| values[cell], open: &|_, _| true };
        let counts = [3, 4].map(|threshold| contours(&field, threshold).len());
        assert_eq!(counts, [1, 2], "{values:?}");
    }
}

/// At any slope a straight edge gets few corners, and is nowhere a cell off.
#[test]
fn straight_edges_are_straight() {
    for degrees in (0..180).step_by(7) {
        let (sin, cos) = f64::from(degrees).to_radians().sin_cos();
        let away = |[x, y]: [f64; 2]| (x - 150.3) * sin - (y - 149.6) * cos;
        let value = |cell: usize| u64::from(away([(cell % 300) as f64 + 0.5, (cell / 300) as f64 + 0.5]) > 0.0);
        let field = ScalarField { width: 300, height: 300, value: &value, open: &|_, _| true };
        let lines = contours(&field, 0).iter().flat_map(Contour::lines).collect::<Vec<_>>();
        let [line] = &lines[..] else { panic!("{degrees}: {} lines", lines.len()) };
        assert!(line.len() <= 24, "{degrees}°: {} corners", line.len());
        let most = line.iter().map(|point| away(*point).abs()).fold(0.0, f64::max);
        assert!(most < 0.75, "{degrees}°: {most} cells off");
    }
}

#[test]
fn iso_hours_of_the_sites_part_the_hours() {
    for name in ["industry", "tower", "headquarters"] {
        for receivers in [Receivers::Ground, Receivers::Top] {
            let asked = Overrides {
                receivers: Some(receivers),
                size: Some(401),
                engine: Some(Engine::Cpu),
                ..Overrides::default()
            };
            let site = Site::load(Path::new(&format!("sites/{name}")), &asked).unwrap();
            let profile = study::run(&site, &Wants::default(), &mut |_| ControlFlow::Continue(())).unwrap().profile;
            let value = |cell: usize| profile.shaded.of(cell);
            let field =
                ScalarField { width: site.grid.width, height: site.grid.height, value: &value, open: &|_, _| true };
            for hour in 0..profile.day_secs / 3600 {
                let threshold = u64::from(hour) * 3600 * 255;
                let parted = agree(&field, threshold, &contours(&field, threshold));
                assert!(parted > 300, "{name} {receivers:?} {hour} h: {parted} pairs");
            }
        }
    }
}
