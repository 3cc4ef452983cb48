//! The shadow map's slope-scaled bias: `cargo bench --bench bias`. Prints a table in Markdown: for each bias, how many
//! cells of a site are wrong and farther than two texels from a shadow's edge. These are counts, which do not depend on
//! the machine's load.
//!
//! `docs/benchmarks/techniques.md` has the results of a run.

#[path = "../tests/shared/far_wrong.rs"]
mod far_wrong;

use glam::DVec3;
use gnomon::choice::Filter;
use gnomon::gpu::Gpu;
use gnomon::shadow::Scene;

use gnomon::site::{Overrides, Site};
use gnomon::view::View;
use std::path::Path;
use std::sync::Arc;

const BIASES: [f32; 6] = [0.0, 0.25, 0.5, 1.0, 2.0, 4.0];
const FILTERS: [(&str, Filter); 3] =
    [("none", Filter::None), ("fast 2×2", Filter::FastTwoByTwo), ("fast 4×4", Filter::FastFourByFour)];
const MAP_SIZE: u32 = 1024;
/// Cells along the plan's longer side.
const SIZE: u32 = 400;

fn main() {
    // `cargo test --benches` only asks whether it runs
    if std::env::args().any(|argument| argument == "--test") {
        return;
    }
    let gpu = Arc::new(Gpu::open().expect("a graphics adapter"));
    println!("adapter: {}; maps of {MAP_SIZE}², {SIZE} cells\n", gpu.name());
    println!("| site | filter | {} |", BIASES.map(|bias| format!("{bias} texels")).join(" | "));
    println!("|---|---|{}", "---|".repeat(BIASES.len()));
    for name in ["tower", "industry", "headquarters"] {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("sites").join(name);
        let site = Site::load(&folder, &Overrides { size: Some(SIZE), ..Overrides::default() }).expect("a site");
        let scene = Scene {
            casters: site.mesh.of_components(&site.casts),
            receivers: site.mesh.of_components(&site.receives),
            ground: site.ground.level,
        };
        // from 10° upwards
        let high = site.track.instants.iter().filter(|instant| instant.altitude_deg() >= 10.0);
        let suns: Vec<DVec3> = high.map(|instant| instant.to_sun).step_by(3).chain([low(112.0, 10.0)]).collect();
        for (word, filter) in FILTERS {
            let wrong = BIASES.map(|bias| {
                let view = View::Plan(site.grid);
                let of = (MAP_SIZE, filter);
                let wrong = far_wrong::far_wrong(&gpu, &scene, view, &suns, of, Some(bias)).expect("a map");
                format!("{:.3}% ({} light, {} dark)", 100.0 * wrong.share(), wrong.lighter, wrong.darker)
            });
            println!("| {name} | {word} | {} |", wrong.join(" | "));
        }
    }
}

/// A low sun, degrees.
fn low(azimuth: f64, altitude: f64) -> DVec3 {
    let (azimuth, altitude) = (azimuth.to_radians(), altitude.to_radians());
    DVec3::new(azimuth.sin() * altitude.cos(), azimuth.cos() * altitude.cos(), altitude.sin())
}
