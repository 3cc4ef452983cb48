//! The time that an instant takes, stage by stage, on the sample sites: `cargo bench`. Prints a table in Markdown.
//!
//! All stages of a row are measured in one run; compare ratios, since absolute times vary with the machine's load.
//! `docs/benchmarks/instants.md` has the results of a run and the machine.

mod timing;

use glam::DVec3;
use gnomon::gpu::Gpu;
use gnomon::profile::accumulate::Sum;
use gnomon::shadow::projected::{Projected, ProjectedOnGpu};
use gnomon::shadow::ray_cast::RayCast;
use gnomon::shadow::stencil::Stencil;
use gnomon::shadow::{Scene, Silhouettes, Technique};
use gnomon::silhouette::brute_force::BruteForce;
use gnomon::silhouette::{ProcessorFinder, SilhouetteFinder};
use gnomon::site::{Overrides, Site};
use gnomon::view::{Grid, View};
use gnomon::volume::{Volume, layers_bound};
use std::path::Path;
use std::sync::Arc;
use timing::{median, timed};

fn main() {
    // `cargo test --benches` only asks whether it runs
    if std::env::args().any(|argument| argument == "--test") {
        return;
    }
    let gpu = Gpu::open().ok().map(Arc::new);
    println!("adapter: {}\n", gpu.as_ref().map_or("none", |gpu| gpu.name()));
    println!(
        "| site | casting triangles | edges | silhouette | facing | silhouettes | volume | layers' bound \
         | stencil drawn | stencil added up | rays cast | rays added up |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|");
    for site in ["tower", "industry", "headquarters"] {
        row(site, gpu.clone());
    }
    println!("\nMilliseconds an instant, medians over the study's instants, at the site's own plan.\n");
    println!("| the ground alone | projected, processor | projected, adapter | stencil | rays |");
    println!("|---|---|---|---|---|");
    for site in ["tower", "industry", "headquarters"] {
        ground_row(site, gpu.as_ref());
    }
    println!(
        "\nA plan of 20 m in the middle, times of its highest surfaces under a sun at 30°; in brackets without culling.\n"
    );
    println!("| low suns | 5° | 0.5° | 0.007° |");
    println!("|---|---|---|---|");
    for site in ["tower", "industry", "headquarters"] {
        low_row(site);
    }
}

/// What an instant costs under low suns, beside one under a high sun.
fn low_row(name: &str) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("sites").join(name);
    let site = Site::load(&folder, &Overrides::default()).expect("a sample site");
    let casters = site.mesh.of_components(&site.casts);
    let scene = Scene { casters, receivers: site.mesh.of_components(&site.receives), ground: site.ground.level };
    let [west, south, east, north] = site.grid.region();
    let (west, north) = ((west + east) / 2.0 - 10.0, (south + north) / 2.0 + 10.0);
    let grid = Grid { west, north, cell: 0.02, width: 1000, height: 1000 };
    let mut ways = [Projected::new(&scene, grid), Projected::new(&scene, grid).without_culling()];
    let mut times: [[Vec<f64>; 2]; 4] = Default::default();
    for _ in 0..5 {
        for (altitude, times) in [30.0_f64, 5.0, 0.5, 0.007].into_iter().zip(&mut times) {
            let (height, along) = altitude.to_radians().sin_cos();
            let (east, north) = 237.2_f64.to_radians().sin_cos();
            for (way, times) in ways.iter_mut().zip(times) {
                let to_sun = DVec3::new(east * along, north * along, height);
                timed(times, || way.draw(to_sun).map(|_| ()).expect("a mask"));
            }
        }
    }
    let [high, low @ ..] = times.map(|ways| ways.map(median));
    let cells = low.map(|[culled, plain]| format!("{:.1} ({:.1})", culled / high[0], plain / high[0]));
    println!("| {name} | {} |", cells.join(" | "));
}

/// The ways to the ground's shadow, which take turns at each sun.
fn ground_row(name: &str, gpu: Option<&Arc<Gpu>>) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("sites").join(name);
    let site = Site::load(&folder, &Overrides::default()).expect("a sample site");
    let nothing = site.mesh.of_components(&[]);
    let scene = Scene { casters: site.mesh.of_components(&site.casts), receivers: nothing, ground: site.ground.level };
    let view = View::Plan(site.grid);
    let mut ways: Vec<Option<Box<dyn Technique>>> = vec![Some(Box::new(Projected::new(&scene, site.grid)))];
    ways.push(gpu.map(|gpu| {
        Box::new(ProjectedOnGpu::new(Arc::clone(gpu), &scene, site.grid).expect("it fits")) as Box<dyn Technique>
    }));
    ways.push(gpu.map(|gpu| {
        let finder = if gpu.software() { ProcessorFinder::Hierarchy.into() } else { Silhouettes::OnGpu };
        Box::new(Stencil::new(Arc::clone(gpu), scene.clone(), view, finder).expect("it fits")) as Box<dyn Technique>
    }));
    ways.push(Some(Box::new(RayCast::new(scene.clone(), view, None))));
    let mut times: Vec<Vec<f64>> = vec![Vec::new(); ways.len()];
    for instant in site.track.instants.iter().filter(|instant| !instant.night) {
        for (way, times) in ways.iter_mut().zip(&mut times) {
            let Some(way) = way else { continue };
            timed(times, || {
                way.draw(instant.to_sun).expect("a mask");
                if let Some(gpu) = gpu {
                    gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("the adapter answers");
                }
            });
        }
    }
    let cells: Vec<String> = times.into_iter().map(|calls| format!("{:.1}", median(calls))).collect();
    println!("| {name} | {} |", cells.join(" | "));
}

fn row(name: &str, gpu: Option<Arc<Gpu>>) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("sites").join(name);
    let site = Site::load(&folder, &Overrides::default()).expect("a sample site");
    let casters = site.mesh.of_components(&site.casts);
    let scene = Scene { casters, receivers: site.mesh.of_components(&site.receives), ground: site.ground.level };
    let view = View::Plan(site.grid);
    let (width, height) = view.size();
    let suns: Vec<_> = site.track.instants.iter().filter(|instant| !instant.night).collect();

    let mut times: [Vec<f64>; 8] = Default::default();
    let mut silhouette = 0;
    let mesh = &scene.casters;
    for instant in &suns {
        let light = mesh.local_light(instant.to_sun.extend(0.0));
        timed(&mut times[0], || mesh.facing(light));
        let mut found = Vec::new();
        timed(&mut times[1], || BruteForce.find(mesh, light, &mut found));
        silhouette = silhouette.max(found.len());
        timed(&mut times[2], || Volume::find(mesh, &mut BruteForce, light, false));
        timed(&mut times[3], || layers_bound(mesh, instant.to_sun));
    }
    if let Some(gpu) = gpu {
        let mut stencil =
            Stencil::new(Arc::clone(&gpu), scene.clone(), view, ProcessorFinder::BruteForce).expect("a stencil");
        let mut sum = Sum::new(Some(Arc::clone(&gpu)), width, height);
        let wait = || gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("the adapter answers");
        for instant in &suns {
            let drawn = timed(&mut times[4], || {
                let drawn = stencil.draw(instant.to_sun).expect("a mask");
                wait();
                drawn
            });
            timed(&mut times[5], || {
                sum.add(&drawn, instant.weight_secs).expect("a sum");
                wait();
            });
        }
    }
    let mut rays = RayCast::new(scene.clone(), view, None);
    let mut sum = Sum::new(None, width, height);
    for instant in &suns {
        let drawn = timed(&mut times[6], || rays.draw(instant.to_sun).expect("a mask"));
        timed(&mut times[7], || sum.add(&drawn, instant.weight_secs).expect("a sum"));
    }
    let stages: Vec<String> = times.map(|calls| format!("{:.1}", median(calls))).to_vec();
    println!("| {name} | {} | {} | {silhouette} | {} |", mesh.faces.len(), mesh.edges.len(), stages.join(" | "));
}
