//! The sample sites, which are written to a folder and opened from there.

use crate::export::file;
use std::path::{Path, PathBuf};

/// A sample site: its name, its site file, and its models.
struct SampleSite {
    name: &'static str,
    site: &'static str,
    models: &'static [(&'static str, &'static [u8])],
}

/// The names of the sample sites, in menu order.
pub(in crate::desktop) const SAMPLES: [&str; 4] = [SITES[0].name, SITES[1].name, SITES[2].name, SITES[3].name];

const SITES: [SampleSite; 4] = [
    SampleSite {
        name: "tower",
        site: include_str!("../../../sites/tower/site.toml"),
        models: &[("tower.glb", include_bytes!("../../../sites/tower/tower.glb"))],
    },
    SampleSite {
        name: "industry",
        site: include_str!("../../../sites/industry/site.toml"),
        models: &[("industry.glb", include_bytes!("../../../sites/industry/industry.glb"))],
    },
    SampleSite {
        name: "headquarters",
        site: include_str!("../../../sites/headquarters/site.toml"),
        models: &[("headquarters.glb", include_bytes!("../../../sites/headquarters/headquarters.glb"))],
    },
    SampleSite {
        name: "hillside",
        site: include_str!("../../../sites/hillside/site.toml"),
        models: &[
            ("house.ifc", include_bytes!("../../../sites/hillside/house.ifc")),
            ("neighbours.geojson", include_bytes!("../../../sites/hillside/neighbours.geojson")),
            ("terrain.asc", include_bytes!("../../../sites/hillside/terrain.asc")),
        ],
    },
];

/// Writes a sample to its folder, and returns its path.
///
/// # Errors
/// If the system's folder for such files cannot be written to, or if there is no such sample.
pub(in crate::desktop) fn sample(name: &str) -> anyhow::Result<PathBuf> {
    let sample = SITES.iter().find(|sample| sample.name == name);
    let sample = sample.ok_or_else(|| anyhow::anyhow!("there is no sample {name}"))?;
    let folder = samples_folder().join(name);
    for (file, bytes) in sample.models {
        file::write(&folder.join(file), bytes)?;
    }
    let path = folder.join("site.toml");
    file::write(&path, sample.site.as_bytes())?;
    Ok(path)
}

/// The folder of the samples, which are written each time they are opened.
fn samples_folder() -> PathBuf {
    std::env::temp_dir().join(format!("gnomon-{}-samples", env!("CARGO_PKG_VERSION")))
}

/// Whether a site file is a sample's, which is not the user's own.
pub(in crate::desktop) fn is_sample(path: &Path) -> bool {
    path.starts_with(samples_folder())
}
