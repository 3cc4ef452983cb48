//! What `gnomon check` says of where each model stands: its unit, its axis, its place and its north.

use super::contents::ContentsReport;
use crate::formats::{Anchor, AnchorPoint};
use crate::site::{ModelContents, ModelReference, anchor_text, metres};
use serde::Serialize;
use std::fmt::Write;

/// For one model an object, for several a list.
#[derive(Serialize)]
#[serde(untagged)]
pub(super) enum ModelLines<'a> {
    /// The line of a single model.
    One { model: Box<ModelLine<'a>> },
    /// The lines of a site that has several.
    Several { models: Vec<ModelLine<'a>> },
}

/// The coordinates of a model, for `check`.
#[derive(Serialize)]
pub(super) struct ModelLine<'a> {
    name: &'a str,
    unit_m: f64,
    unit_is_said: bool,
    up: &'static str,
    up_is_said: bool,
    crs: Option<&'a str>,
    said_by: Option<&'a str>,
    place: Option<PlaceLine>,
    anchors: Vec<AnchorLine<'a>>,
    north_deg: f64,
    convergence_deg: Option<f64>,
    #[serde(flatten)]
    contents: ContentsReport<'a>,
}

#[derive(Serialize)]
struct PlaceLine {
    latitude: f64,
    longitude: f64,
    elevation: Option<f64>,
}

#[derive(Serialize)]
struct AnchorLine<'a> {
    said_by: &'a str,
    #[serde(flatten)]
    at: AnchorNumbers<'a>,
    north_deg: Option<f64>,
}

/// A point of a map or of the Earth, or neither if only a north is given.
#[derive(Serialize)]
#[serde(untagged)]
enum AnchorNumbers<'a> {
    Map { crs: &'a str, easting: f64, northing: f64, height: Option<f64>, scale: f64 },
    Geographic { latitude: f64, longitude: f64, elevation: Option<f64> },
    Nowhere {},
}

impl<'a> ModelLines<'a> {
    pub(super) fn of(models: &'a [ModelReference], contents: &'a [ModelContents]) -> ModelLines<'a> {
        let mut lines: Vec<_> = models.iter().zip(contents).map(|(model, held)| ModelLine::of(model, held)).collect();
        match lines.pop() {
            Some(model) if lines.is_empty() => ModelLines::One { model: Box::new(model) },
            last => ModelLines::Several { models: lines.into_iter().chain(last).collect() },
        }
    }
}

impl<'a> ModelLine<'a> {
    fn of(model: &'a ModelReference, contents: &'a ModelContents) -> ModelLine<'a> {
        let place = model.place.map(|at| PlaceLine {
            latitude: at.latitude_deg,
            longitude: at.longitude_deg,
            elevation: model.has_height.then_some(at.height_m),
        });
        ModelLine {
            name: &model.name,
            unit_m: model.unit_m,
            unit_is_said: model.unit_is_said,
            up: model.up.word(),
            up_is_said: model.up_is_said,
            crs: model.crs.as_deref(),
            said_by: model.said_by.as_deref(),
            place,
            anchors: model.anchors.iter().map(AnchorLine::of).collect(),
            north_deg: model.north_deg,
            convergence_deg: model.convergence_deg,
            contents: ContentsReport::of(contents),
        }
    }
}

impl<'a> AnchorLine<'a> {
    fn of(anchor: &'a Anchor) -> AnchorLine<'a> {
        let at = match &anchor.at {
            AnchorPoint::Map { crs, easting, northing, height, scale } => {
                AnchorNumbers::Map { crs, easting: *easting, northing: *northing, height: *height, scale: *scale }
            }
            AnchorPoint::Geographic { latitude_deg, longitude_deg, elevation_m } => AnchorNumbers::Geographic {
                latitude: *latitude_deg,
                longitude: *longitude_deg,
                elevation: *elevation_m,
            },
            AnchorPoint::Nowhere => AnchorNumbers::Nowhere {},
        };
        AnchorLine { said_by: anchor.said_by, at, north_deg: anchor.north_rad.map(f64::to_degrees) }
    }
}

/// One or two lines per model.
pub(super) fn table(models: &[ModelReference]) -> String {
    let mut table = String::new();
    for model in models {
        let guess = |is_said: bool| if is_said { "" } else { " (assumed)" };
        // Writing to a String cannot fail.
        let _ = write!(
            table,
            "{}: unit {} m{}, {} up{}, north {:.2}°",
            plain(&model.name),
            six_digits(model.unit_m),
            guess(model.unit_is_said),
            model.up,
            guess(model.up_is_said),
            hundredths(model.north_deg),
        );
        if let Some(convergence) = model.convergence_deg {
            let _ = write!(table, " (the map's convergence there: {:.2}°)", hundredths(convergence));
        }
        match (&model.place, &model.said_by) {
            (Some(at), Some(said_by)) => {
                let _ = write!(table, "\n  stands at {:.5}, {:.5}", at.latitude_deg, at.longitude_deg);
                if model.has_height {
                    let _ = write!(table, ", {}", metres(at.height_m));
                }
                let _ = write!(table, ", by {}", plain(said_by));
                if let Some(crs) = &model.crs {
                    let _ = write!(table, " in {}", plain(crs));
                }
            }
            _ => table.push_str(", no place on Earth"),
        }
        table.push('\n');
        for anchor in &model.anchors {
            let at = Some(plain(&anchor_text(&anchor.at))).filter(|at| !at.is_empty());
            let north = anchor.north_rad.map(|north| format!("north {:.2}°", hundredths(north.to_degrees())));
            let said = at.into_iter().chain(north).collect::<Vec<_>>().join(" ");
            let _ = writeln!(table, "  {}: {said}", anchor.said_by);
        }
    }
    table
}

/// A number with six digits that count, without zeros at its end: an inch is 0.0254 m, whatever its last bits are.
fn six_digits(number: f64) -> f64 {
    format!("{number:.5e}").parse().unwrap_or(number)
}

/// A number to its hundredth; adding 0 turns −0 into 0.
fn hundredths(number: f64) -> f64 {
    (number * 100.0).round() / 100.0 + 0.0
}

/// A text without characters that would break the line.
fn plain(text: &str) -> String {
    text.replace(char::is_control, " ")
}
