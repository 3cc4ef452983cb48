//! A whole mask of the stencil with each silhouette finder, on the sample sites: `cargo bench --bench masks`. Prints a
//! table in Markdown.
//!
//! Finders take turns for each sun position, so that other load on the machine affects all of them equally; compare
//! ratios. `docs/benchmarks/silhouettes.md` has the results of a run.

mod timing;

use gnomon::gpu::Gpu;
use gnomon::shadow::stencil::Stencil;
use gnomon::shadow::{Scene, Silhouettes, Technique};
use gnomon::silhouette::ProcessorFinder;
use gnomon::site::{Overrides, Site};
use gnomon::view::{Camera, Grid, View};
use gnomon::volume::layers_bound;
use std::path::Path;
use std::sync::Arc;
use timing::{median, timed};

const WAYS: [Silhouettes; 4] = [
    Silhouettes::OnProcessor(ProcessorFinder::BruteForce),
    Silhouettes::OnProcessor(ProcessorFinder::Hierarchy),
    Silhouettes::OnGpu,
    Silhouettes::InVertexShader,
];

fn main() {
    // `cargo test --benches` only asks whether it runs
    if std::env::args().any(|argument| argument == "--test") {
        return;
    }
    let gpu = Arc::new(Gpu::open().expect("a graphics adapter"));
    println!("adapter: {}\n", gpu.name());
    println!("| site | edges | view | layers' bound | brute | hextree | gpu | vertex shader |");
    println!("|---|---|---|---|---|---|---|---|");
    for name in ["tower", "industry", "headquarters"] {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("sites").join(name);
        let site = Site::load(&folder, &Overrides::default()).expect("a sample site");
        for (view_name, view) in views(&site) {
            row(&gpu, &site, name, view_name, view);
        }
    }
    println!("\nMilliseconds an instant, medians over the study's instants, with all work of processor and adapter.");
}

/// The site's plan; a tenth of it across, around its middle, in as many cells; few cells, which leaves the walls' own
/// price; and the site's camera.
fn views(site: &Site) -> [(&'static str, View); 4] {
    let grid = site.grid;
    let [west, south, east, north] = grid.region();
    let zoomed =
        Grid { west: west * 0.55 + east * 0.45, north: north * 0.55 + south * 0.45, cell: grid.cell / 10.0, ..grid };
    let coarse = Grid { cell: grid.cell * 16.0, width: grid.width / 16, height: grid.height / 16, ..grid };
    let camera = Camera { width: 1280, height: 800, ..site.camera };
    [
        ("plan", View::Plan(grid)),
        ("zoomed plan", View::Plan(zoomed)),
        ("coarse plan", View::Plan(coarse)),
        ("camera", View::Camera(camera)),
    ]
}

fn row(gpu: &Arc<Gpu>, site: &Site, name: &str, view_name: &str, view: View) {
    let casters = site.mesh.of_components(&site.casts);
    let scene = Scene { casters, receivers: site.mesh.of_components(&site.receives), ground: site.ground.level };
    let mut ways = WAYS.map(|way| Stencil::new(Arc::clone(gpu), scene.clone(), view, way).expect("a stencil"));
    let mut times: [Vec<f64>; 4] = Default::default();
    let mut bound = Vec::new();
    for (index, instant) in site.track.instants.iter().filter(|instant| !instant.night).enumerate() {
        timed(&mut bound, || layers_bound(&scene.casters, instant.to_sun));
        for (way, times) in ways.iter_mut().zip(&mut times) {
            let mut of_this = Vec::new();
            timed(&mut of_this, || {
                way.draw(instant.to_sun).expect("a mask");
                gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("the adapter answers");
            });
            // the first draw makes buffers
            times.extend(of_this.into_iter().filter(|_| index > 0));
        }
    }
    let edges = scene.casters.edges.len();
    let times: Vec<String> = times.map(|calls| format!("{:.1}", median(calls))).to_vec();
    println!("| {name} | {edges} | {view_name} | {:.1} | {} |", median(bound), times.join(" | "));
}
