//! What a face requests in addition to the site file, and how its values are read.

use super::error::{FieldLocation, SiteError};
use crate::choice::{Engine, Finder, Method, Receivers, Settings};
use crate::formats::{ModelReader, Up};
use crate::message::{Field, Message, Words, message};
use crate::sun::Zone;
use crate::view::Side;
use chrono::DateTime;
use std::path::PathBuf;

/// Fields of a request that a face sets; each that is set has priority over the site file.
#[derive(Clone, Debug, Default)]
pub struct Overrides {
    /// Latitude and longitude, in degrees with a comma between them, for a model file or a site file without `[place]`.
    pub place: Option<String>,
    /// The upward axis of all models, whatever their files say.
    pub up: Option<Up>,
    /// Metres: the height of all footprints that have none, whatever the site file says.
    pub default_height: Option<f64>,
    /// Further model files of the same site.
    pub beside: Vec<PathBuf>,
    /// How model files are read.
    pub reading: ModelReader,
    /// The height of the ground, metres above the place's point.
    pub ground: Option<f64>,
    /// The date of the study, such as `2026-09-18`.
    pub date: Option<String>,
    /// The beginning of the study's window, such as `10:00` or `sunrise+1h`.
    pub from: Option<String>,
    /// The end of the study's window.
    pub to: Option<String>,
    /// The time between two instants, such as `30min`.
    pub step: Option<String>,
    /// How near together times of change are found, such as `1min`, or `step` for the instants alone.
    pub resolution: Option<String>,
    /// The first date of a study of several days.
    pub from_date: Option<String>,
    /// The last date of a study of several days.
    pub to_date: Option<String>,
    /// A single instant instead of the study, such as `2026-09-18T15:00`.
    pub at: Option<String>,
    /// The same as a parsed time; it has priority over all other fields of time.
    pub instant: Option<DateTime<Zone>>,
    /// A single probe instead of the site file's: `X,Y,Z` in metres.
    pub point: Option<String>,
    /// The normal of that probe: `X,Y,Z`.
    pub normal: Option<String>,
    /// A table of probes instead of the site file's.
    pub points: Option<PathBuf>,
    /// Names of components on which probes are laid.
    pub on: Vec<String>,
    /// The distance between laid probes, metres.
    pub spacing: Option<f64>,
    /// The height of laid probes above the ground, metres.
    pub height: Option<f64>,
    /// The plan's region: `W,S,E,N` in metres.
    pub region: Option<String>,
    /// The side of a cell, metres.
    pub cell: Option<f64>,
    /// The number of cells along the longer side of the plan.
    pub size: Option<u32>,
    /// What receives in the study: the plan's highest surfaces, its ground, or the models' surfaces.
    pub receivers: Option<Receivers>,
    /// The side from which the camera's picture is seen.
    pub side: Option<Side>,
    /// The side of a patch's texel, metres, where the models' surfaces receive.
    pub patch_cell: Option<f64>,
    /// The technique.
    pub technique: Option<Method>,
    /// The finder of silhouettes.
    pub silhouette: Option<Finder>,
    /// The depth of the paper's hextree; without it the finder is its successor.
    pub hextree_depth: Option<u32>,
    /// The engine: the graphics adapter, or the processor.
    pub engine: Option<Engine>,
    /// The settings of techniques: the map's size, the filter, the width of smoothies, the number of samples of the sun.
    pub settings: Settings,
    /// Whether the sun's directions leave out atmospheric refraction.
    pub no_refraction: bool,
    /// The face's words for these fields, for the notes on the site, which are written into files as well as shown.
    pub words: &'static dyn Words,
}

/// Reads `N` finite numbers, separated by commas.
///
/// # Errors
/// [`SiteError::Value`], with the example as its hint.
pub(super) fn numbers<const N: usize>(field: Field, text: &str, example: &'static str) -> Result<[f64; N], SiteError> {
    let read: Option<Vec<f64>> =
        text.split(',').map(|number| number.trim().parse().ok().filter(|number: &f64| number.is_finite())).collect();
    read.and_then(|numbers| numbers.try_into().ok()).ok_or_else(|| {
        let what = format!("\"{text}\" is not {N} numbers with commas between them");
        refuse(FieldLocation::Field(field), message![what; "write for example ", (field, example)])
    })
}

/// The error for a value that cannot be used.
pub(super) fn refuse(at: FieldLocation, message: impl Into<Message>) -> SiteError {
    SiteError::Value { at, message: Box::new(message.into()) }
}
