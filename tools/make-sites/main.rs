//! Draws the models of the sample sites: `cargo run --example make-sites` writes the files in `sites/NAME`.
//!
//! The tests include this file to check that the repository has exactly what it draws.

mod glb;
mod headquarters;
mod hillside;
mod houses;
mod industry;
mod plant;
mod quarter;
mod shapes;
mod solids;
mod tower;

/// Every file's path in `sites/` and its bytes.
pub(crate) fn files() -> Vec<(&'static str, Vec<u8>)> {
    [models(), hillside::files()].concat()
}

/// Those of them that are GLB.
pub(crate) fn models() -> Vec<(&'static str, Vec<u8>)> {
    vec![
        ("tower/tower.glb", tower::model().to_glb()),
        ("industry/industry.glb", industry::model().to_glb()),
        ("headquarters/headquarters.glb", headquarters::model().to_glb()),
    ]
}

#[cfg(not(test))]
fn main() -> std::io::Result<()> {
    let sites = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("sites");
    for (path, bytes) in files() {
        let path = sites.join(path);
        // Beside first, so that whoever reads meanwhile finds a whole file.
        let beside = path.with_extension("new");
        std::fs::write(&beside, &bytes)?;
        std::fs::rename(&beside, &path)?;
        println!("{}: {} bytes", path.display(), bytes.len());
    }
    Ok(())
}
