//! Reads CityJSON 1.0 to 2.0 and CityJSONSeq. The files of this folder, in the order of the flow: `document` (parses
//! the JSON), `objects` (selects objects and their geometries), `surfaces` (boundaries to faces).

use super::city::CityBuilder;
use super::crs::{is_north_first, named_system};
use super::whole::{whole_file, without_mark};
use super::{Coordinates, Format, Model, ModelFault, ReadOptions};
use crate::message::{Message, message};
use document::{CityDocument, VertexTransform};
use serde::Deserialize as _;
use std::path::Path;

mod document;
mod objects;
mod surfaces;

/// CityJSON and CityJSONSeq, `.city.json` and `.city.jsonl`.
pub(super) struct CityJson;

impl Format for CityJson {
    fn name(&self) -> &'static str {
        "CityJSON"
    }

    fn endings(&self) -> &'static [&'static str] {
        &["json", "jsonl"]
    }

    fn begins(&self, head: &[u8]) -> bool {
        super::json_head::has_member(head, "type", |value| value == "CityJSON" || value == "CityJSONFeature")
            || super::json_head::has_key(head, "CityObjects")
    }

    fn read(&self, path: &Path, options: &ReadOptions) -> Result<Model, ModelFault> {
        read(without_mark(&whole_file(path)?), options)
    }
}

/// Reads one document; or a sequence, with the transform in the first line and a feature in each of the others.
fn read(bytes: &[u8], options: &ReadOptions) -> Result<Model, ModelFault> {
    let mut json = serde_json::Deserializer::from_slice(bytes);
    let head = CityDocument::deserialize(&mut json).map_err(|error| damaged(&error))?;
    check_head(&head)?;
    let transform = head.transform.unwrap_or_default();
    if transform.scale.iter().chain(&transform.translate).any(|number| !number.is_finite()) {
        return Err(message!["has a transform with a value that is not a number"; "export it again"].into());
    }
    let step = head.transform.map(|transform| transform.scale.iter().fold(0.0, |most: f64, step| most.max(step.abs())));
    let mut builder = CityBuilder::new(step, options.told_step(1.0));
    let templates = surfaces::Templates::of(&head);
    objects::add(&head, &transform, &templates, &mut builder)?;
    let mut count = 1_u64;
    for feature in json.into_iter::<CityDocument<'_>>() {
        count += 1;
        let feature = feature.map_err(|error| damaged(&error))?;
        if feature.kind != "CityJSONFeature" {
            let what = format!("has a line of the type \"{}\" after its first", super::left_out::label(&feature.kind));
            return Err(message![what; "a sequence has one CityJSON, and then a CityJSONFeature on each line"].into());
        }
        objects::add(&feature, &transform, &templates, &mut builder)?;
    }
    let (coordinates, note) = coordinates_of(&head);
    let mut model = builder.finish(coordinates);
    model.notes.extend(note);
    if model.parts.is_empty() {
        let what = format!("has no surfaces in its {count} {}", if count == 1 { "document" } else { "lines" });
        let left_out: Vec<String> =
            model.left_out.iter().map(|one| format!("{} {}: {}", one.count, one.what, one.why)).collect();
        let left_out = crate::message::few(left_out);
        return Err(message![what, if left_out.is_empty() { String::new() } else { format!(" ({left_out})") };
            "export it with a level of detail of 1 or higher"]
        .into());
    }
    Ok(model)
}

fn check_head(head: &CityDocument<'_>) -> Result<(), Message> {
    match head.kind.as_ref() {
        "CityJSON" => {}
        "CityJSONFeature" => {
            return Err(message![
                "begins with a CityJSONFeature, without the CityJSON before it that has the transform";
                "export the sequence with its first line"
            ]);
        }
        _ => return Err(message!["is JSON, and not CityJSON"; "export it as CityJSON 2.0"]),
    }
    let version = head.version.as_deref().unwrap_or_default();
    if !["1.", "2."].iter().any(|known| version.starts_with(known)) {
        let what = format!("is CityJSON {}, but Gnomon reads 1.0 to 2.0", super::left_out::label(version));
        return Err(message![what; "convert it to 2.0 with `cjio in.json upgrade save out.json`"]);
    }
    Ok(())
}

fn damaged(error: &serde_json::Error) -> Message {
    let what = match error.classify() {
        serde_json::error::Category::Eof => format!("is cut off ({error})"),
        _ => format!("is not valid CityJSON ({error})"),
    };
    message![what; "export it again"]
}

/// The reference system of the coordinates, and a note if their order is ambiguous.
fn coordinates_of(head: &CityDocument<'_>) -> (Coordinates, Option<Message>) {
    let said = head.metadata.as_ref().and_then(|metadata| metadata.reference_system.as_deref());
    let Some(system) = said.and_then(named_system) else {
        return (Coordinates::Local, None);
    };
    let note = (system.is_official && is_north_first(&system.crs)).then(|| {
        message![format!(
            "has {} as its reference system, whose official order is the northing first, and is read with the easting first, as CityJSON is written",
            system.crs
        ); "check that it lies where it should"]
    });
    (Coordinates::Map(system.crs), note)
}

impl VertexTransform {
    /// Converts a vertex to the coordinates of the reference system.
    fn apply(&self, vertex: [f64; 3]) -> glam::DVec3 {
        glam::DVec3::from(vertex) * glam::DVec3::from(self.scale) + glam::DVec3::from(self.translate)
    }
}
