//! What `gnomon check` says about each model's position: its unit, its up axis, its place and its north.

use super::contents::ContentsReport;
use crate::formats::{Anchor, AnchorPoint};
use crate::site::{EarthPoint, ModelContents, ModelReference, anchor_text, metres};
use serde::Serialize;
use std::fmt::Write;

/// An object for one model, a list for several.
#[derive(Serialize)]
#[serde(untagged)]
pub(super) enum ModelLines<'a> {
    /// The entry of a single model.
    One { model: Box<ModelLine<'a>> },
    /// The entries of several models.
    Several { models: Vec<ModelLine<'a>> },
}

/// Unit, axis, position and north of a model, for `check`.
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
    file_place: Option<FilePlaceLine<'a>>,
    anchors: Vec<AnchorLine<'a>>,
    north_deg: f64,
    convergence_deg: Option<f64>,
    meridian_deg: Option<f64>,
    #[serde(flatten)]
    contents: ContentsReport<'a>,
}

#[derive(Serialize)]
struct PlaceLine {
    latitude: f64,
    longitude: f64,
    elevation: Option<f64>,
}

/// Where the file says that the model stands, if it stands elsewhere.
#[derive(Serialize)]
struct FilePlaceLine<'a> {
    said_by: &'a str,
    #[serde(flatten)]
    place: PlaceLine,
}

impl PlaceLine {
    fn of(point: EarthPoint) -> PlaceLine {
        PlaceLine {
            latitude: point.at.latitude_deg,
            longitude: point.at.longitude_deg,
            elevation: point.has_height.then_some(point.at.height_m),
        }
    }
}

#[derive(Serialize)]
struct AnchorLine<'a> {
    said_by: &'a str,
    #[serde(flatten)]
    at: AnchorNumbers<'a>,
    north_deg: Option<f64>,
}

/// A point of a map or of the Earth, or neither if only north is given.
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
        let file_place = elsewhere(model).map(|(said, said_by)| FilePlaceLine { said_by, place: PlaceLine::of(said) });
        ModelLine {
            name: &model.name,
            unit_m: model.unit_m,
            unit_is_said: model.unit_is_said,
            up: model.up.word(),
            up_is_said: model.up_is_said,
            crs: model.crs.as_deref(),
            said_by: model.stands.map(|_| model.stands_by.as_str()),
            place: model.stands.map(PlaceLine::of),
            file_place,
            anchors: model.anchors.iter().map(AnchorLine::of).collect(),
            north_deg: model.north_deg,
            convergence_deg: model.convergence_deg,
            meridian_deg: model.meridian_deg,
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
        let of_north = [
            model.convergence_deg.map(|deg| format!("the map's convergence there: {:.2}°", hundredths(deg))),
            model.meridian_deg.map(|deg| format!("true north there, from that at the place: {:.2}°", hundredths(deg))),
        ];
        let of_north: Vec<String> = of_north.into_iter().flatten().collect();
        if !of_north.is_empty() {
            let _ = write!(table, " ({})", of_north.join("; "));
        }
        table.push_str(&stands(model));
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

/// Where a model stands, and what its file says if that differs.
fn stands(model: &ModelReference) -> String {
    let Some(point) = &model.stands else { return ", no place on Earth".to_owned() };
    let mut said = format!("\n  stands at {}, by {}", numbers(point), plain(&model.stands_by));
    let other = elsewhere(model);
    if other.is_none()
        && let Some(crs) = &model.crs
    {
        said.push_str(&format!(" in {}", plain(crs)));
    }
    if let Some((point, by)) = &other {
        said.push_str(&format!("\n  its file says {}, by {}", numbers(point), plain(by)));
        if let Some(crs) = &model.crs {
            said.push_str(&format!(" in {}", plain(crs)));
        }
    }
    said
}

/// Where its file says that a model stands and by what, if it stands elsewhere.
fn elsewhere(model: &ModelReference) -> Option<(EarthPoint, &str)> {
    let (stands, said) = model.stands.zip(model.said)?;
    let said_by = model.said_by.as_deref()?;
    (model.stands_by != said_by && stands != said).then_some((said, said_by))
}

/// `49.10044, 8.43655, 110 m`
fn numbers(point: &EarthPoint) -> String {
    let height = if point.has_height { format!(", {}", metres(point.at.height_m)) } else { String::new() };
    format!("{:.5}, {:.5}{height}", point.at.latitude_deg, point.at.longitude_deg)
}

/// A number with six significant digits, without trailing zeros: an inch is 0.0254 m, whatever its last bits are.
fn six_digits(number: f64) -> f64 {
    format!("{number:.5e}").parse().unwrap_or(number)
}

/// A number rounded to hundredths; adding 0 turns −0 into 0.
fn hundredths(number: f64) -> f64 {
    (number * 100.0).round() / 100.0 + 0.0
}

/// A text without characters that would break the line.
fn plain(text: &str) -> String {
    text.replace(char::is_control, " ")
}
