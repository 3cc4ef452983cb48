//! Files that only accompany another one: what they contain, and which file to open instead.

use super::whole::sibling;
use crate::message::{Message, message};
use std::path::Path;

/// A kind of accompanying file.
struct CompanionKind {
    ending: &'static str,
    /// Its contents.
    holds: &'static str,
    /// The endings of the files that it may accompany, the likeliest first.
    of: &'static [&'static str],
}

const KINDS: &[CompanionKind] = &[
    CompanionKind { ending: "shx", holds: "the index of a shapefile", of: &["shp"] },
    CompanionKind { ending: "dbf", holds: "the attributes of a shapefile", of: &["shp"] },
    CompanionKind { ending: "cpg", holds: "the encoding of a shapefile's attributes", of: &["shp"] },
    CompanionKind { ending: "sbn", holds: "the spatial index of a shapefile", of: &["shp"] },
    CompanionKind { ending: "sbx", holds: "the spatial index of a shapefile", of: &["shp"] },
    CompanionKind { ending: "qix", holds: "the spatial index of a shapefile", of: &["shp"] },
    CompanionKind { ending: "prj", holds: "the reference system of a shapefile or a grid", of: &["shp", "asc"] },
    CompanionKind { ending: "tfw", holds: "the place of a GeoTIFF", of: &["tif", "tiff"] },
    CompanionKind { ending: "mtl", holds: "the materials of an OBJ file", of: &["obj"] },
];

fn kind_of(path: &Path) -> Option<&'static CompanionKind> {
    let ending = path.extension()?;
    KINDS.iter().find(|kind| ending.eq_ignore_ascii_case(kind.ending))
}

/// The error for opening an accompanying file.
pub(super) fn refusal(path: &Path) -> Option<Message> {
    let kind = kind_of(path)?;
    let what = format!("contains {}, but no shapes", kind.holds);
    let name = |path: &Path| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let hint = match kind.of.iter().find_map(|ending| sibling(path, ending)) {
        Some(main) => format!("open {}, which lies beside it", name(&main)),
        None => {
            let main = path.with_extension(kind.of.first().copied().unwrap_or_default());
            format!("put {} beside it, and open that", name(&main))
        }
    };
    Some(message![what; hint])
}

/// Whether a file accompanies one of these.
#[cfg(feature = "desktop")]
pub(crate) fn goes_with_one_of(path: &Path, others: &[impl AsRef<Path>]) -> bool {
    kind_of(path).is_some_and(|kind| {
        others.iter().map(AsRef::as_ref).any(|other| {
            let ending = other.extension().unwrap_or_default();
            other.with_extension("") == path.with_extension("")
                && kind.of.iter().any(|of| ending.eq_ignore_ascii_case(of))
        })
    })
}
