//! Low suns in a town: shadows that are hundreds of kilometres long fall as correctly as those at noon, and the cost of
//! an instant depends only on casters that can reach the plan.

use super::plain_scan::scanned;
use crate::shared::scenes::{cuboid, joined};
use glam::{DVec3, dvec3};
use gnomon::mesh::{Mesh, Part};
use gnomon::shadow::projected::{Projected, ProjectedWork};
use gnomon::shadow::ray_cast::RayCast;
use gnomon::shadow::{Scene, Technique};
use gnomon::view::{Bits, Grid, Tile, View};

const RECORD: &str = include_str!("../../docs/benchmarks/counts.md");

/// A square of blocks, 40 m apart, with heights from 6 to 24 m, and a few towers among them.
fn town(side: u32) -> Vec<Part> {
    let block = |number: u32| {
        let [column, row] = [number % side, number / side].map(|at| (f64::from(at) - f64::from(side) / 2.0) * 40.0);
        let height = if number % 97 == 5 { 80.3 } else { 6.1 + f64::from(number * 7 % 19) };
        let size = 12.3 + f64::from(number * 5 % 11);
        cuboid("block", dvec3(column + 3.1, row + 4.2, 0.0), dvec3(column + 3.1 + size, row + 4.2 + size, height))
    };
    (0..side * side).map(block).collect()
}

fn scene(parts: Vec<Part>, top: bool) -> Scene {
    let mesh = Mesh::build(parts).unwrap();
    let receivers = if top { mesh.clone() } else { mesh.of_components(&vec![false; mesh.components.len()]) };
    Scene { casters: mesh, receivers, ground: 0.0 }
}

/// A plan in the middle of a town, with cells of half a metre.
const PLAN: Grid = Grid { west: -61.371, north: 58.193, cell: 0.5, width: 240, height: 230 };

/// The unit vector to the sun at some degrees.
fn to_sun(azimuth: f64, altitude: f64) -> DVec3 {
    let (azimuth, altitude) = (azimuth.to_radians(), altitude.to_radians());
    dvec3(azimuth.sin() * altitude.cos(), azimuth.cos() * altitude.cos(), altitude.sin())
}

fn suns() -> impl Iterator<Item = DVec3> {
    let azimuths = [0.0, 61.3, 90.0, 147.9, 237.2, 301.7];
    azimuths.into_iter().flat_map(|azimuth| [0.007, 0.09, 0.8, 4.3, 31.0].map(|altitude| to_sun(azimuth, altitude)))
}

fn drawn(technique: &mut dyn Technique, to_sun: DVec3) -> Bits {
    technique.draw(to_sun).unwrap().bits().unwrap()
}

/// In how many cells two masks differ.
fn differing(one: &Bits, other: &Bits) -> u32 {
    one.words.iter().zip(&other.words).map(|(one, other)| (one ^ other).count_ones()).sum()
}

/// The greatest number of differing cells: those with an edge within a thousandth of a cell of their centre.
fn few(scene: &Scene) -> u32 {
    if scene.receivers.faces.is_empty() { 0 } else { 3 }
}

#[test]
fn culling_changes_no_bit() {
    for parts in [town(60), vec![joined(town(60))]] {
        for top in [false, true] {
            let scene = scene(parts.clone(), top);
            let (mut culled, mut plain) =
                (Projected::new(&scene, PLAN), Projected::new(&scene, PLAN).without_culling());
            let mut shaded = 0;
            for sun in suns() {
                let (one, other) = (drawn(&mut culled, sun), drawn(&mut plain, sun));
                assert_eq!(differing(&one, &other), 0, "top {top}, sun {sun}");
                assert!(culled.work().reaching < plain.work().reaching, "{:?}", culled.work());
                shaded += one.words.iter().map(|word| u64::from(word.count_ones())).sum::<u64>();
            }
            let all = 30 * PLAN.cells() as u64;
            assert!(shaded > all / 10 && shaded < all, "{shaded} of {all}");
        }
    }
}

#[test]
fn low_suns_shade_what_rays_say() {
    for top in [false, true] {
        let scene = scene(town(30), top);
        let mut projected = Projected::new(&scene, PLAN);
        let mut rays = RayCast::new(scene.clone(), View::Plan(PLAN), None);
        for sun in suns() {
            let drawn_here = drawn(&mut projected, sun);
            let off = differing(&drawn_here, &drawn(&mut rays, sun));
            assert!(off <= few(&scene), "top {top}, sun {sun}: {off} cells are unlike rays");
            if !top {
                let twin: Vec<bool> = scanned(&scene, &PLAN, sun).iter().map(|share| *share == 0).collect();
                let shaded = drawn_here.mask().share.iter().map(|share| *share == 0).collect::<Vec<_>>();
                assert!(shaded == twin, "sun {sun}: unlike the plain scan");
            }
        }
    }
}

#[test]
fn tiles_are_the_plan_under_low_suns() {
    let scene = scene(town(30), true);
    let mut whole = Projected::new(&scene, PLAN);
    let mut tiles = Projected::new(&scene, PLAN);
    for sun in [to_sun(237.2, 0.007), to_sun(90.0, 0.8)] {
        let all = drawn(&mut whole, sun).mask();
        for first in [[0, 0], [101, 67], [170, 130]] {
            let tile = Tile { plan: PLAN, first, size: [70, 100] };
            assert!(tiles.turn_to_tile(tile).unwrap());
            let part = drawn(&mut tiles, sun).mask();
            for (row, shares) in part.share.chunks(70).enumerate() {
                let at = (first[1] as usize + row) * PLAN.width as usize + first[0] as usize;
                assert!(all.share[at..at + 70] == *shares, "tile {first:?}, row {row}");
            }
        }
    }
}

/// The suns of the table in docs/benchmarks/counts.md.
const ALTITUDES: [f64; 5] = [50.0, 30.0, 5.0, 0.5, 0.007];

#[test]
fn an_instant_costs_what_can_reach_the_plan() {
    let mut lines = String::new();
    for side in [30, 100] {
        let scene = scene(town(side), true);
        let mut projected = Projected::new(&scene, PLAN);
        let work = ALTITUDES.map(|altitude| {
            projected.draw(to_sun(237.2, altitude)).unwrap();
            projected.work()
        });
        let of = |count: fn(&ProjectedWork) -> u64| {
            let counts = work.map(|work| count(&work));
            let mut sorted = counts;
            sorted.sort_unstable();
            assert!(sorted[4] <= 20 * sorted[2], "{side}: {counts:?}");
            counts.map(|count| count.to_string()).join(" | ")
        };
        let clumps = work[0].clumps;
        lines += &format!("| {clumps} blocks, those that reach | {} |\n", of(|work| work.reaching));
        lines += &format!("| {clumps} blocks, rows crossed | {} |\n", of(|work| work.rows));
        lines += &format!("| {clumps} blocks, points held against faces | {} |\n", of(|work| work.points));
    }
    assert!(RECORD.contains(&lines), "where that is meant, put into docs/benchmarks/counts.md:\n{lines}");
}
