//! The sample sites, and writing them to a folder from which they can be opened.

use crate::export::file;
use std::path::{Path, PathBuf};

/// A sample site: its name, its site file, and the models that this names.
struct SampleSite {
    name: &'static str,
    site: &'static str,
    models: &'static [(&'static str, &'static [u8])],
}

/// The sample sites: their names, in the menu's order.
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

/// Writes a sample where it can be opened, and says where that is.
///
/// # Errors
/// Where the system's folder for such files cannot be written to, and a name that no sample has.
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

/// Where the samples are written out, each time that they are opened.
fn samples_folder() -> PathBuf {
    std::env::temp_dir().join(format!("gnomon-{}-samples", env!("CARGO_PKG_VERSION")))
}

/// Whether a site file is a sample's, and nobody's to keep.
pub(in crate::desktop) fn is_sample(path: &Path) -> bool {
    path.starts_with(samples_folder())
}
