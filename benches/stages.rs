//! The stages that run once per study, on the sample sites: loading, welding, adjacency, planes, and writing files:
//! `cargo bench --bench stages`. Prints a table in Markdown.
//!
//! Instants and their sums are in `instants`; `docs/benchmarks/counts.md` has counts, which do not depend on load.
//! Compare ratios, since absolute times vary with the machine's load.

mod timing;

use gnomon::export::{figure, raster};
use gnomon::formats::{self, ReadOptions};
use gnomon::mesh::Mesh;
use gnomon::site::{Overrides, Site};
use gnomon::study::{self, Wants};
use gnomon::view::{Bits, Grid, Mask};
use std::ops::ControlFlow;
use std::path::Path;
use timing::{median, timed};

/// How often each stage is timed.
const TIMES: usize = 7;
/// Cells of the plan's longer side.
const SIZE: u32 = 1024;

fn main() {
    // `cargo test --benches` only asks whether it runs
    if std::env::args().any(|argument| argument == "--test") {
        return;
    }
    println!("| site | triangles | read | welded, with edges | edges | planes | GeoTIFF | drawing | mask |");
    println!("|---|---|---|---|---|---|---|---|---|");
    for site in ["tower", "industry", "headquarters"] {
        row(site);
    }
    println!("\nMilliseconds, medians of {TIMES}; plans of {SIZE} cells; {} threads.", rayon::current_num_threads());
}

fn row(name: &str) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("sites").join(name);
    let asked = Overrides { size: Some(SIZE), ..Overrides::default() };
    let site = Site::load(&folder, &asked).expect("a sample site");
    let outcome = study::run(&site, &Wants { surface: true, ..Wants::default() }, &mut |_| ControlFlow::Continue(()))
        .expect("a study");
    let surface = outcome.surface.as_ref().expect("a surface");
    let scene = figure::FigureContext {
        place: &site.place,
        track: &site.track,
        mesh: &outcome.surface_mesh,
        surface,
        receivers: site.receivers,
        ground: site.ground,
        drawn: &outcome.drawn,
    };
    let Grid { width, height, .. } = site.grid;
    let model = folder.join(format!("{name}.glb"));
    let mut times: [Vec<f64>; 7] = Default::default();
    for _ in 0..TIMES {
        let parts = timed(&mut times[0], || formats::read(&model, &ReadOptions::default()).expect("a model").parts);
        let mesh = timed(&mut times[1], || Mesh::build(parts).expect("a mesh"));
        timed(&mut times[3], || mesh.planes().len());
        // all but one face: what is taken whole keeps the edges that it has
        timed(&mut times[2], || mesh.of_faces(|face| face > 0));
        timed(&mut times[4], || raster::geotiff(&outcome.profile, &site.place).expect("a raster"));
        timed(&mut times[5], || figure::profile(&scene, &outcome.profile).expect("a drawing"));
        let half = Bits { width, height, words: vec![0x00FF_0F33; Bits::new(width, height).words.len()] };
        let mask: Mask = half.mask();
        timed(&mut times[6], || raster::mask_png(&mask).expect("a mask"));
    }
    let stages: Vec<String> = times.map(|calls| format!("{:.1}", median(calls))).to_vec();
    println!("| {name} | {} | {} |", site.mesh.faces.len(), stages.join(" | "));
}
