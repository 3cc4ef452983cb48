//! The amount of work in counts, compared with those in `docs/benchmarks/counts.md`. Counts do not depend on load, so a
//! technique that begins to visit twice as much is noticed even on a busy machine.

use crate::shared::drawing::gpu;
use chrono::NaiveDate;
use glam::{DVec3, dvec3};
use gnomon::choice::{MAP_SIZE, Receivers};
use gnomon::formats;
use gnomon::mesh::Mesh;
use gnomon::mesh::patches::{MOST_TEXELS, Patches};
use gnomon::shadow::hybrid::Hybrid;
use gnomon::shadow::ray_cast::RayCast;
use gnomon::shadow::rays::{RayCaster, RayCounts, Shear};
use gnomon::shadow::soft_texture::{Choice, Fill, Painter, Sample, SoftTexture};
use gnomon::shadow::stencil::Stencil;
use gnomon::shadow::{JUDGED_ABOVE_M, Scene, Technique};
use gnomon::silhouette::ProcessorFinder;
use gnomon::site::{Overrides, Site};
use gnomon::sun::DayWindow;
use gnomon::sunlight::{JudgedPoint, ProbeSearch, SearchedDays};
use gnomon::view::View;
use std::cell::Cell;
use std::path::Path;
use std::sync::Arc;

const RECORD: &str = include_str!("../docs/benchmarks/counts.md");
const SITES: [&str; 3] = ["tower", "industry", "headquarters"];
/// So much may a count be off, of what is recorded: adapters' rasters differ at edges.
const TOLERANCE: f64 = 0.01;

/// Counts by name.
type Counts = Vec<(&'static str, u64)>;
/// A line of the table: a name, and the counts of the sites.
type Row = (String, [u64; 3]);

fn counts(name: &str) -> Counts {
    let asked = Overrides { size: Some(256), receivers: Some(Receivers::Top), ..Overrides::default() };
    let corners = Cell::new(0);
    let site = Site::load_with(&Path::new("sites").join(name), &asked, |path, options| {
        let model = formats::read(path, options)?;
        corners.set(corners.get() + model.parts.iter().map(|part| part.positions.len()).sum::<usize>());
        Ok(model)
    });
    let site = site.unwrap();
    let casters = site.mesh.of_components(&site.casts);
    let by_day: Vec<_> = site.track.instants.iter().filter(|instant| !instant.night).collect();
    let suns = [0, by_day.len() / 2, by_day.len() - 1].map(|at| by_day[at].to_sun);
    let mut counts: Counts = vec![
        ("corners that are read", corners.get() as u64),
        ("vertices after welding", site.mesh.vertices.len() as u64),
        ("triangles that cast", casters.faces.len() as u64),
        ("edges of those", casters.edges.len() as u64),
    ];
    let finders = [
        ("edges tested by brute force", ProcessorFinder::BruteForce),
        ("edges and nodes tested by the hextree, depth 4", ProcessorFinder::Hextree { depth: 4 }),
        ("edges and nodes tested by the hierarchy", ProcessorFinder::Hierarchy),
    ];
    let mut silhouettes = Vec::new();
    for (what, kind) in finders {
        let (mut finder, mut silhouette) = (kind.build(&casters), Vec::new());
        let look = |sun: &glam::DVec3| finder.find(&casters, casters.local_light(sun.extend(0.0)), &mut silhouette).at;
        counts.push((what, suns.iter().map(look).sum::<usize>() as u64));
        silhouettes.push(silhouette.len());
    }
    assert!(silhouettes.iter().all(|count| *count == silhouettes[0]), "{silhouettes:?}");
    counts.push(("silhouette edges", silhouettes[0] as u64));

    counts.extend(on_facades(&site, &casters, &suns));

    let receivers = site.mesh.of_components(&site.receives);
    let (scene, view) = (Scene { casters, receivers, ground: site.ground.level }, View::Plan(site.grid));
    let rays = RayCast::new(scene.clone(), view, None);
    counts.push(("rays", suns.iter().map(|sun| rays.rays(*sun)).sum::<usize>() as u64));
    let mut stencil = Stencil::new(gpu(), scene.clone(), view, ProcessorFinder::Hierarchy).unwrap();
    let mut hybrid = Hybrid::new(gpu(), scene, view, ProcessorFinder::Hierarchy, MAP_SIZE).unwrap();
    let [mut all, mut reached] = [0; 2];
    for sun in suns {
        all += stencil.counted(sun).unwrap().unwrap().all;
        reached += hybrid.counted(sun).unwrap().unwrap().reached.iter().map(|&it| u64::from(it)).sum::<u64>();
    }
    counts.extend([("fragments of the stencil", all), ("fragments that the hybrid's mask lets through", reached)]);
    counts.push(("faces tested by the search of a year", faces_of_a_year(&site)));
    counts
}

/// The tests of faces for the intervals of four points beside the models on all days of a year.
fn faces_of_a_year(site: &Site) -> u64 {
    let (low, high) = site.mesh.bounds().unwrap();
    let point = |[east, north]: [f64; 2]| {
        let at = low + (high - low) * dvec3(east, north, 0.0);
        JudgedPoint { point: at.with_z(site.ground.level + 1.7), normal: None, below_ground_m: None }
    };
    let points = [[0.2, 0.3], [0.7, 0.2], [0.4, 0.8], [0.9, 0.9]].map(point);
    let search = ProbeSearch::new(site.mesh.of_components(&site.casts), &points);
    let first = NaiveDate::from_ymd_opt(2026, 1, 1).unwrap();
    let window = |date: NaiveDate| DayWindow::on(&site.place, date, None, None).unwrap();
    let windows: Vec<DayWindow> = first.iter_days().take(365).map(window).collect();
    for windows in windows.chunks(32) {
        let days = SearchedDays::new(&site.place, windows, None).unwrap();
        points.iter().for_each(|at| drop(search.intervals(at, &days).unwrap()));
    }
    search.tested()
}

/// The work on façades and roofs, with texels of a metre; and what one ray from each patch's first texel tests.
fn on_facades(site: &Site, casters: &Mesh, suns: &[DVec3]) -> Counts {
    let patches = Arc::new(Patches::of(&site.mesh, &site.receives, 1.0, MOST_TEXELS));
    let painter = Painter::OnProcessor(Fill::Silhouettes);
    let mut texture = SoftTexture::new(casters.clone(), Arc::clone(&patches), painter, Choice::Auto).unwrap();
    let samples: Vec<Sample> = suns.iter().map(|sun| Sample { light: sun.extend(0.0), weight: 1 }).collect();
    texture.add(&samples).unwrap();
    let judged = texture.judged();
    let caster = RayCaster::new(casters, 1000.0);
    let mut of_rays = RayCounts::default();
    for sun in suns {
        let shear = Shear::along(*sun);
        for patch in patches.list.iter().filter(|patch| patch.normal().dot(*sun) > 0.0) {
            let first = patches.texels[patch.texels.start as usize];
            let counts = caster.counted(patches.point(patch, first) + patch.normal() * JUDGED_ABOVE_M, &shear);
            of_rays.nodes += counts.nodes;
            of_rays.faces += counts.faces;
        }
    }
    vec![
        ("texels of façades decided in rectangles", judged.rectangle_texels),
        ("texels of façades decided by rays", judged.rays),
        ("boxes tested by a ray from each patch", of_rays.nodes * 8),
        ("faces tested by these", of_rays.faces),
    ]
}

/// The recorded counts of all sites, by name, in the order of the table.
fn recorded(record: &str) -> Vec<Row> {
    let table = record.split("## Work on the sites").nth(1).unwrap().split("##").next().unwrap();
    let row = |line: &str| {
        let cells: Vec<_> = line.trim_matches('|').split('|').map(str::trim).collect();
        let [name, numbers @ ..] = &cells[..] else { return None };
        let numbers: Vec<u64> = numbers.iter().filter_map(|number| number.replace(',', "").parse().ok()).collect();
        Some(((*name).to_owned(), numbers.try_into().ok()?))
    };
    table.lines().filter(|line| line.starts_with('|')).filter_map(row).collect()
}

/// Counts that differ, and those that only one table has.
fn off(recorded: &[Row], found: &[Row]) -> Vec<String> {
    let mut off = Vec::new();
    for (name, counts) in found {
        match recorded.iter().find(|(recorded, _)| recorded == name) {
            None => off.push(format!("{name}: not recorded")),
            Some((_, recorded)) => {
                for at in 0..3 {
                    let most = recorded[at] as f64 * TOLERANCE;
                    if (counts[at] as f64 - recorded[at] as f64).abs() > most {
                        off.push(format!("{name}, {}: {}, recorded {}", SITES[at], counts[at], recorded[at]));
                    }
                }
            }
        }
    }
    let is_found = |name: &str| found.iter().any(|(found, _)| found == name);
    off.extend(recorded.iter().filter(|(name, _)| !is_found(name)).map(|(name, _)| format!("{name}: not counted")));
    off
}

#[test]
fn work_is_what_is_recorded() {
    let of_sites = SITES.map(counts);
    let row = |at: usize| (of_sites[0][at].0.to_owned(), [0, 1, 2].map(|site: usize| of_sites[site][at].1));
    let found: Vec<_> = (0..of_sites[0].len()).map(row).collect();
    let off = off(&recorded(RECORD), &found);
    let line = |(name, [a, b, c]): &Row| format!("| {name} | {a} | {b} | {c} |\n");
    let table: String = found.iter().map(line).collect();
    assert!(off.is_empty(), "{}\nwhere that is meant, put into docs/benchmarks/counts.md:\n{table}", off.join("\n"));
}

#[test]
fn what_is_off_is_found() {
    let recorded = recorded(RECORD);
    assert!(recorded.len() > 8 && off(&recorded, &recorded).is_empty());
    let change = |change: &dyn Fn(&mut Vec<Row>)| {
        let mut found = recorded.clone();
        change(&mut found);
        off(&recorded, &found).len()
    };
    assert_eq!(change(&|found| found[4].1[2] = found[4].1[2] * 1009 / 1000), 0);
    assert_eq!(change(&|found| found[4].1[2] = found[4].1[2] * 1011 / 1000), 1);
    assert_eq!(change(&|found| found[5].1[0] = found[5].1[0] * 98 / 100), 1);
    assert_eq!(change(&|found| drop(found.remove(3))), 1);
    assert_eq!(change(&|found| found[3].0.push('x')), 2);
}
