//! What a face requests in addition to the site file.

use super::error::{FieldLocation, SiteError};
use crate::choice::{Engine, Finder, Method, Receivers, Settings};
use crate::formats::{ModelReader, Up};
use crate::message::{Message, Words};
use crate::sun::{Reading, Zone};
use crate::view::Side;
use chrono::{DateTime, NaiveDate};
use glam::DVec3;
use std::path::PathBuf;

/// Fields of a request that a face sets; each that is set has priority over the site file.
#[derive(Clone, Debug, Default)]
pub struct Overrides {
    /// Latitude and longitude, degrees, for a model file or a site file without `[place]`.
    pub place: Option<[f64; 2]>,
    /// The up axis of all models, whatever their files say.
    pub up: Option<Up>,
    /// The height, metres, of all footprints without one, whatever the site file says.
    pub default_height: Option<f64>,
    /// More model files of the same site.
    pub beside: Vec<PathBuf>,
    /// How model files are read.
    pub reading: ModelReader,
    /// The height of the ground, metres above the place's point.
    pub ground: Option<f64>,
    /// The date of the study.
    pub date: Option<NaiveDate>,
    /// The beginning of the study's window: `"10:00".parse()`, `"sunrise+1h".parse()`.
    pub from: Option<Reading>,
    /// The end of the study's window.
    pub to: Option<Reading>,
    /// The time between two instants, seconds.
    pub step_secs: Option<u32>,
    /// The precision of times of change, seconds; 0 for the instants alone.
    pub resolution_secs: Option<u32>,
    /// The first date of a study of several days.
    pub from_date: Option<NaiveDate>,
    /// The last date of a study of several days.
    pub to_date: Option<NaiveDate>,
    /// A single instant instead of the study, on the place's clock: `"2026-09-18T15:00".parse()`.
    pub at: Option<Reading>,
    /// The same as an absolute time. It has priority over all other fields of time.
    pub instant: Option<DateTime<Zone>>,
    /// A single probe instead of the site file's: metres east, north and up of the place.
    pub point: Option<DVec3>,
    /// The normal of that probe, of any length except 0.
    pub normal: Option<DVec3>,
    /// A table of probes instead of the site file's.
    pub points: Option<PathBuf>,
    /// Names of components on which probes are laid.
    pub on: Vec<String>,
    /// The distance between laid probes, metres.
    pub spacing: Option<f64>,
    /// The height of laid probes above the ground, metres.
    pub height: Option<f64>,
    /// The plan's region: west, south, east, north, metres.
    pub region: Option<[f64; 4]>,
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
    /// The depth of the paper's hextree; without it the finder is the hierarchy.
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

/// The error for a value that cannot be used.
pub(super) fn refuse(at: FieldLocation, message: impl Into<Message>) -> SiteError {
    SiteError::Value { at, message: Box::new(message.into()) }
}
