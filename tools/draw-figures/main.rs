//! Draws the comparison sheets of `docs/techniques.md` into `docs/pictures`: `cargo run --release --example
//! draw-figures` for all, or followed by the names of some sheets.
//!
//! The library itself draws everything, and each run gives the same pictures, except for the milliseconds in some
//! captions, which are measured in the run.

mod bars;
#[path = "../../tests/shared/dense.rs"]
mod dense;
mod filters;
mod hybrid;
mod picture;
mod scenes;
mod sheet;
mod soft;
mod stage;

use anyhow::Result;
use gnomon::gpu::Gpu;
use sheet::Sheet;
use std::path::Path;
use std::sync::Arc;

/// Draws one sheet.
type Draw = fn(&Arc<Gpu>) -> Result<Sheet>;

const SHEETS: &[(&str, Draw)] = &[
    ("map-filters", filters::filters),
    ("shadow-edges", soft::edges),
    ("smoothie-truth", soft::beside_truth),
    ("smoothie-remap", soft::remap),
    ("smoothie-overlap", soft::overlap),
    ("hybrid-mask", hybrid::mask),
    ("hybrid-overdraw", hybrid::overdraw),
    ("hybrid-artifacts", hybrid::artifacts),
    ("hybrid-beside", hybrid::beside),
    ("hybrid-bars", bars::bars),
];

fn main() -> Result<()> {
    let wanted: Vec<String> = std::env::args().skip(1).collect();
    let gpu = Arc::new(Gpu::open()?);
    for (name, draw) in SHEETS {
        if wanted.is_empty() || wanted.iter().any(|wanted| wanted == name) {
            let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("docs/pictures/{name}.png"));
            draw(&gpu)?.write(&path)?;
            println!("{} ({} KiB)", path.display(), std::fs::metadata(&path)?.len() >> 10);
        }
    }
    Ok(())
}
