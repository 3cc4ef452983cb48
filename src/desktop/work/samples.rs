//! Sample sites, which are written out where they can be opened.

use crate::export::file;
use std::path::{Path, PathBuf};

/// The sample sites: their names, and where each lies once it is written out.
pub(in crate::desktop) const SAMPLES: [&str; 3] = ["tower", "industry", "headquarters"];

/// Writes a sample where it can be opened, and says where that is.
///
/// # Errors
/// Where the system's folder for such files cannot be written to.
pub(in crate::desktop) fn sample(name: &str) -> anyhow::Result<PathBuf> {
    let (toml, model): (&str, &[u8]) = match name {
        "tower" => (include_str!("../../../sites/tower/site.toml"), include_bytes!("../../../sites/tower/tower.glb")),
        "industry" => {
            (include_str!("../../../sites/industry/site.toml"), include_bytes!("../../../sites/industry/industry.glb"))
        }
        _ => (
            include_str!("../../../sites/headquarters/site.toml"),
            include_bytes!("../../../sites/headquarters/headquarters.glb"),
        ),
    };
    let folder = samples_folder().join(name);
    file::write(&folder.join(format!("{name}.glb")), model)?;
    let path = folder.join("site.toml");
    file::write(&path, toml.as_bytes())?;
    Ok(path)
}

/// Where the samples are written out, each time that they are opened.
fn samples_folder() -> PathBuf {
    std::env::temp_dir().join(format!("gnomon-{}-samples", env!("CARGO_PKG_VERSION")))
}

/// Whether a site file is a sample's, and nobody's to keep.
pub(in crate::desktop) fn is_sample(path: &Path) -> bool {
    path.starts_with(samples_folder())
}
