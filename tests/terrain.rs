//! Terrain as the ground: shadows on it against closed forms, against the plane where the terrain is flat, and against
//! rays.

mod asked;
mod drawn;

use crate::shared::scenes::{cuboid, sheet};
use chrono::NaiveDate;
use glam::{DVec3, dvec3};
use gnomon::choice::Receivers;
use gnomon::choice::{Engine, Method, Settings, Subject};
use gnomon::mesh::{Mesh, Part};
use gnomon::profile::Shaded;
use gnomon::profile::comparison::{Alteration, Change};
use gnomon::shadow::JUDGED_ABOVE_M;
use gnomon::site::{GroundKind, Pair, Site};
use gnomon::study::{self, CompareOutcome, Event, Outcome, StudyError, TiledStudy, Wants};
use gnomon::sun::{Place, SunTrack, Window};
use gnomon::view::{Grid, Mask};
use std::ops::ControlFlow;

/// The centres of cells do not lie on any edge of the scene.
const GRID: Grid = Grid { west: -60.137_1, north: 60.193_3, cell: 0.871, width: 138, height: 138 };

fn vienna() -> Place {
    Place::new("Vienna", 48.2082, 16.3738, 170.0, Some("Europe/Vienna")).unwrap()
}

/// Only instants, since sums are compared with masks.
fn track() -> SunTrack {
    let date = NaiveDate::from_ymd_opt(2026, 3, 21);
    let window = Window { date, from: "6:30".parse().unwrap(), to: "18:00".parse().unwrap(), step_secs: 2400 };
    SunTrack { resolution_secs: 0, ..SunTrack::window(&vienna(), &window, true).unwrap() }
}

/// A sheet over a square with half the side and the heights of the corners given.
fn terrain(half: f64, height: impl Fn(f64, f64) -> f64) -> Part {
    let corners = [[-half, -half], [half, -half], [half, half], [-half, half]];
    Part { name: "hillside".to_owned(), ..sheet(corners.map(|[x, y]| dvec3(x, y, height(x, y)))) }
}

/// The parts as one mesh, of which the first is terrain.
fn mesh(parts: Vec<Part>) -> Mesh {
    let mut mesh = Mesh::build(parts).unwrap();
    mesh.components[0].is_terrain = true;
    mesh
}

/// By rays on the processor, on the ground alone.
fn site(mesh: Mesh, level: Option<f64>) -> Site {
    let site = Site::in_memory(vienna(), mesh, level, track(), GRID).unwrap();
    Site { engine: Engine::Cpu, method: Method::RayCast, receivers: Receivers::Ground, ..site }
}

/// The outcome, and the mask of each instant with its sun.
fn drawn(site: &Site) -> (Outcome, Vec<(DVec3, Mask)>) {
    let mut masks = Vec::new();
    let wants = Wants { masks: true, surface: true, ..Wants::default() };
    let outcome = study::run(site, &wants, &mut |event| {
        if let Event::Drawn { index, mask: Some(mask), .. } = event
            && !site.track.instants[index].night
        {
            masks.push((site.track.instants[index].to_sun, mask.clone()));
        }
        ControlFlow::Continue(())
    });
    (outcome.unwrap(), masks)
}

fn sums(site: &Site) -> Shaded {
    drawn(site).0.profile.shaded
}

/// How many cells of the masks are not as a closed form says of points on the ground of a height: of a cell's centre, and of
/// all that is nearer to it than a millimetre, as rays pass beside edges by less than that.
fn faults(
    masks: &[(DVec3, Mask)],
    height: impl Fn(f64, f64) -> f64,
    normal: DVec3,
    is_dark: impl Fn(DVec3, DVec3) -> bool,
) -> usize {
    const ASIDE: [[f64; 2]; 5] = [[0.0, 0.0], [0.001, 0.001], [-0.001, 0.001], [0.001, -0.001], [-0.001, -0.001]];
    let of_mask = |(to_sun, mask): &(DVec3, Mask)| {
        let cells = (0..GRID.height).flat_map(|row| (0..GRID.width).map(move |column| (column, row)));
        let is_wrong = |&(column, row): &(u32, u32)| {
            let at = GRID.centre(column, row);
            let is_seen_dark = mask.share[(row * GRID.width + column) as usize] == 0;
            ASIDE.into_iter().all(|[east, north]| {
                let (x, y) = (at.x + east, at.y + north);
                is_dark(dvec3(x, y, height(x, y)) + normal * JUDGED_ABOVE_M, *to_sun) != is_seen_dark
            })
        };
        cells.filter(is_wrong).count()
    };
    masks.iter().map(of_mask).sum()
}

/// A quarter of a metre up for each metre to the east.
const SLOPE: f64 = 0.25;
const LOW: DVec3 = DVec3::new(-6.0, -4.0, -8.0);
const HIGH: DVec3 = DVec3::new(7.0, 5.0, 21.0);

/// Whether a point of the slope lies in the shadow of the box, or of the slope itself: the ray to the sun is above the box's
/// plan in one run of its length, and lowest where it enters.
fn is_dark_on_slope(normal: DVec3) -> impl Fn(DVec3, DVec3) -> bool {
    move |point, to_sun| {
        let (mut from, mut to) = (0.0_f64, f64::INFINITY);
        for axis in 0..2 {
            let ends = [LOW, HIGH].map(|corner| (corner[axis] - point[axis]) / to_sun[axis]);
            (from, to) = (from.max(ends[0].min(ends[1])), to.min(ends[0].max(ends[1])));
        }
        normal.dot(to_sun) <= 0.0 || from < to && point.z + from * to_sun.z < HIGH.z
    }
}

#[test]
fn a_box_throws_its_shadow_on_a_slope() {
    let height = |x: f64, _: f64| SLOPE * x;
    let normal = dvec3(-SLOPE, 0.0, 1.0).normalize();
    let slope = site(mesh(vec![terrain(400.0, height), cuboid("box", LOW, HIGH)]), None);
    assert_eq!((slope.ground.kind, slope.ground.level, slope.ground.word()), (GroundKind::Terrain, -100.0, "terrain"));
    let (_, masks) = drawn(&slope);
    assert!(masks.len() > 15, "{} instants", masks.len());
    assert_eq!(faults(&masks, height, normal, is_dark_on_slope(normal)), 0);
    // the same on a level ground is another shadow
    assert!(faults(&masks, |_, _| 0.0, DVec3::Z, is_dark_on_slope(DVec3::Z)) > 1000);
    // in the morning, as the slope rises to the east, all of it is its own shadow
    assert!(masks[0].1.share.iter().all(|share| *share == 0));
    assert!(masks.iter().any(|(_, mask)| mask.share.iter().any(|share| *share > 0)));

    // projected onto cells of any height; a corner may round to the other side of an edge
    let projected = Site { method: Method::Projected, ..slope.clone() };
    let (_, masks) = drawn(&projected);
    let wrong = faults(&masks, height, normal, is_dark_on_slope(normal));
    assert!(wrong <= masks.len(), "{wrong} cells are wrong");
    let auto = Site { method: Method::Auto, ..slope };
    assert_eq!(drawn(&auto).0.drawn.technique, Method::Projected);
}

#[test]
fn level_terrain_is_the_plane_at_its_height() {
    let block = || cuboid("box", dvec3(-6.0, -4.0, 2.5), dvec3(7.0, 5.0, 21.0));
    let on_terrain = site(mesh(vec![terrain(400.0, |_, _| 2.5), block()]), None);
    let on_plane = site(Mesh::build(vec![block()]).unwrap(), Some(2.5));
    let hours = sums(&on_terrain);
    assert!(hours.iter().any(|shaded| shaded > 0) && hours.iter().any(|shaded| shaded == 0));
    assert_eq!(hours, sums(&on_plane));
    // another study, which does not go on from this one's sums
    let as_roof = site(Mesh::build(vec![terrain(400.0, |_, _| 2.5), block()]).unwrap(), Some(2.5));
    let number = |site: &Site| {
        let study = TiledStudy::new(site, &Wants::default(), &mut |_| ControlFlow::Continue(()));
        study.unwrap().number()
    };
    assert_ne!(number(&on_terrain), number(&as_roof));
    assert_eq!(number(&on_terrain), number(&on_terrain.clone()));
    assert_ne!(hours, sums(&Site { ground: site(Mesh::build(vec![block()]).unwrap(), Some(2.0)).ground, ..on_plane }));
    // what lies beyond the terrain's edge is the plane
    let small = site(mesh(vec![terrain(10.0, |_, _| 2.5), block()]), Some(2.5));
    assert_eq!(hours, sums(&small));
    // terrain that does not receive is looked through, and its shadow is that of any roof
    let through = Site { receives: vec![false, true], ..on_terrain.clone() };
    assert_eq!(through.judges(Receivers::Ground), [false, false]);
    assert_eq!(on_terrain.judges(Receivers::Ground), [true, false]);
    assert_eq!(on_terrain.judges(Receivers::Top), [true, true]);
}

/// A valley with a slope to its east, from 0 at x = 100 to 100 at x = 200, far to the north and the south.
fn valley() -> Part {
    const FAR: f64 = 4000.0;
    let profile = [[-300.0, 0.0], [100.0, 0.0], [200.0, 100.0], [300.0, 100.0]];
    let positions = profile.iter().flat_map(|[x, z]| [dvec3(*x, -FAR, *z), dvec3(*x, FAR, *z)]).collect();
    let strip = |at: u32| [[2 * at, 2 * at + 2, 2 * at + 3], [2 * at, 2 * at + 3, 2 * at + 1]];
    Part { name: "hill".to_owned(), positions, triangles: (0..3).flat_map(strip).collect(), ..Part::default() }
}

/// Whether the hill's brink, a line along x = 200 and 100 m high, hides the sun from a point in the valley.
fn is_behind_hill(point: DVec3, to_sun: DVec3) -> bool {
    to_sun.x > 0.0 && point.z + (200.0 - point.x) / to_sun.x * to_sun.z < 100.0
}

#[test]
fn a_hill_shades_the_valley() {
    let (_, masks) = drawn(&site(mesh(vec![valley()]), None));
    assert_eq!(faults(&masks, |_, _| 0.0, DVec3::Z, is_behind_hill), 0);
    let dark = masks.iter().filter(|(_, mask)| mask.share.contains(&0)).count();
    assert!((3..masks.len()).contains(&dark), "the hill shades {dark} instants");
}

#[test]
fn every_technique_holds_on_terrain() {
    const SIDE: u32 = 24;
    let at = |index: u32| f64::from(index) * 8.0 - 96.0;
    let height = |x: f64, y: f64| 6.0 * (x / 23.0).sin() + 4.0 * (y / 17.0).cos() + 0.05 * x;
    let points = (0..=SIDE).flat_map(|row| (0..=SIDE).map(move |column| (at(column), at(row))));
    let positions = points.map(|(x, y)| dvec3(x, y, height(x, y))).collect();
    let square = |row: u32, column: u32| {
        let [a, c] = [row, row + 1].map(|row| row * (SIDE + 1) + column);
        [[a, a + 1, c + 1], [a, c + 1, c]]
    };
    let triangles = (0..SIDE).flat_map(|row| (0..SIDE).flat_map(move |column| square(row, column))).collect();
    let hills = Part { name: "hills".to_owned(), positions, triangles, ..Part::default() };
    let near = cuboid("near", dvec3(-21.3, -14.2, -12.0), dvec3(-9.1, 3.7, 19.4));
    let far = cuboid("far", dvec3(14.6, 8.3, -12.0), dvec3(31.9, 20.1, 13.2));
    let site = site(mesh(vec![hills, near, far]), None);
    let settings = Settings { sun_samples: Some(2), ..Settings::NONE };
    let mut site = Site { engine: Engine::Auto, method: Method::Auto, settings, ..site };
    site.track.instants = site.track.instants.into_iter().step_by(3).collect();
    let held = study::verify::verify(&site, &mut |_| ControlFlow::Continue(())).unwrap();
    let told = gnomon::export::verify::table(&held, &site);
    assert_eq!(gnomon::export::verify::failure(&held), None, "{told}");
    // the projection on an adapter is of the plane alone
    let of = |method: Method| held.rows.iter().filter(|row| row.drawn.technique == method).count();
    assert_eq!([Method::Projected, Method::Stencil, Method::Hybrid].map(of), [1, 1, 1], "{told}");

    let on_gpu = Site { engine: Engine::Gpu, method: Method::Projected, settings: Settings::NONE, ..site };
    let refused = study::run(&on_gpu, &Wants::default(), &mut |_| ControlFlow::Continue(())).unwrap_err();
    let StudyError::Misfit(misfit) = refused else { panic!("{refused}") };
    assert_eq!(
        misfit.to_string(),
        "engine: projected draws terrain as the plan's ground only on the cpu; leave it out, or choose stencil, \
         shadow-map, hybrid or smoothie with gpu"
    );
    assert_eq!(Subject::Terrain.drawn_by(Engine::Cpu), ["projected", "ray-cast"]);
}

fn compared(before: Mesh, after: Mesh) -> CompareOutcome {
    let [before, after] = [before, after].map(|mesh| site(mesh, Some(-100.0)));
    let names = ["before", "after"].map(str::to_owned);
    study::compare(&Pair { before, after, names }, &mut |_| ControlFlow::Continue(())).unwrap()
}

#[test]
fn a_change_is_measured_on_the_terrain_in_plan() {
    let slope = |lift: f64| terrain(400.0, move |x, _| SLOPE * x + lift);
    let house = || cuboid("box", LOW, HIGH);
    let built = compared(mesh(vec![slope(0.0)]), mesh(vec![slope(0.0), house()]));
    let change = &built.comparison;
    // the ground is judged under the house, too
    assert_eq!(change.altered_m2(Alteration::Built) + change.altered_m2(Alteration::Cleared), 0.0);
    assert_eq!(change.more_than_m2(Change::SunGained, 0), 0.0);
    let shaded = |mask: &Mask| mask.share.iter().filter(|share| **share == 0).count();
    let [bare, with] = [vec![slope(0.0)], vec![slope(0.0), house()]].map(|parts| drawn(&site(mesh(parts), None)).1);
    let weights = track().instants.into_iter().filter(|instant| !instant.night).map(|instant| instant.weight_secs);
    let of = bare.iter().zip(&with).zip(weights);
    let lost = of.map(|((bare, with), secs)| (shaded(&with.1) - shaded(&bare.1)) as f64 * f64::from(secs));
    let lost: f64 = lost.sum::<f64>() / 3600.0 * GRID.cell * GRID.cell;
    assert!(lost > 1000.0 && (change.total_m2_hours(Change::SunLost) - lost).abs() < 1e-6 * lost, "{lost}");

    // where the ground itself is raised nothing is compared
    let raised = compared(mesh(vec![slope(0.0)]), mesh(vec![slope(0.5)])).comparison;
    assert_eq!((raised.altered_m2(Alteration::No), raised.more_than_m2(Change::SunLost, 0)), (0.0, 0.0));
    assert!(raised.altered_m2(Alteration::Built) > 10_000.0);
}
