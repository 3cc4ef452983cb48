//! What a face requests beside the site file, and the reading of its values.

use super::error::{FieldLocation, SiteError};
use crate::choice::{Engine, Finder, Method, Receivers, Settings};
use crate::formats::{ModelReader, Up};
use crate::message::{Field, Message, Words, message};
use crate::sun::Zone;
use crate::view::Side;
use chrono::DateTime;
use std::path::PathBuf;

/// Options of the command line; each, where given, goes before the site file.
#[derive(Clone, Debug, Default)]
pub struct Overrides {
    /// `--place LAT,LON`, for a model file or a site file without `[place]`.
    pub place: Option<String>,
    /// `--up y|z`: of all models, whatever their files say.
    pub up: Option<Up>,
    /// `--default-height M`: of all models' footprints without a height, whatever the site file says.
    pub default_height: Option<f64>,
    /// Further model files, for the same site as the first one.
    pub beside: Vec<PathBuf>,
    /// How model files are read.
    pub reading: ModelReader,
    /// `--ground METRES`
    pub ground: Option<f64>,
    /// `--date 2026-09-18`
    pub date: Option<String>,
    /// `--from 10:00`
    pub from: Option<String>,
    /// `--to 14:00`
    pub to: Option<String>,
    /// `--step 30min`
    pub step: Option<String>,
    /// `--resolution 1min|step`
    pub resolution: Option<String>,
    /// `--from-date 2026-02-19`, the first of several days.
    pub from_date: Option<String>,
    /// `--to-date 2026-10-21`, the last of them.
    pub to_date: Option<String>,
    /// `--at 2026-09-18T15:00`: this instant alone, instead of the study.
    pub at: Option<String>,
    /// The same as a time that need not be read; it goes before all other fields that say when.
    pub instant: Option<DateTime<Zone>>,
    /// `--point X,Y,Z`, metres: this probe alone, instead of the file's.
    pub point: Option<String>,
    /// `--normal X,Y,Z`, with `--point`.
    pub normal: Option<String>,
    /// `--region W,S,E,N`, metres.
    pub region: Option<String>,
    /// `--cell M`, metres.
    pub cell: Option<f64>,
    /// `--size PIXELS`: cells along the longer side.
    pub size: Option<u32>,
    /// `--receivers top|ground|surfaces`
    pub receivers: Option<Receivers>,
    /// `--view north|east|south|west`: the side that the camera's picture shows.
    pub side: Option<Side>,
    /// `--patch-cell M`, metres, with `--receivers surfaces`.
    pub patch_cell: Option<f64>,
    /// `--technique auto|…`
    pub technique: Option<Method>,
    /// `--silhouette auto|…`
    pub silhouette: Option<Finder>,
    /// `--hextree-depth N`, with `--silhouette hextree`
    pub hextree_depth: Option<u32>,
    /// `--engine auto|gpu|cpu`
    pub engine: Option<Engine>,
    /// `--map-size`, `--pcf`, `--smoothie-width`, `--sun-samples`
    pub settings: Settings,
    /// `--no-refraction`
    pub no_refraction: bool,
    /// The face's words for these fields, for the notes on the site, which go into files as well as to people.
    pub words: &'static dyn Words,
}

/// Reads `N` finite numbers with commas between them.
///
/// # Errors
/// [`SiteError::Value`] with the example.
pub(super) fn numbers<const N: usize>(field: Field, text: &str, example: &'static str) -> Result<[f64; N], SiteError> {
    let read: Option<Vec<f64>> =
        text.split(',').map(|number| number.trim().parse().ok().filter(|number: &f64| number.is_finite())).collect();
    read.and_then(|numbers| numbers.try_into().ok()).ok_or_else(|| {
        let what = format!("\"{text}\" is not {N} numbers with commas between them");
        refuse(FieldLocation::Field(field), message![what; "write for example ", (field, example)])
    })
}

/// A value that cannot be taken.
pub(super) fn refuse(at: FieldLocation, message: impl Into<Message>) -> SiteError {
    SiteError::Value { at, message: Box::new(message.into()) }
}
