//! Reads CityGML 2 and 3. The text is read event by event, without building a tree. Only the coordinates are kept, and
//! which geometry belongs to which object.
//!
//! The files of this folder, in the order of the flow: `latin` (older encodings), `tables` (what is kept), `scan`
//! (events to tables), `polygon` (positions to rings), `objects` (which geometries of which objects are used, and what
//! references lead to).

use super::city::CityBuilder;
use super::crs::{NamedSystem, is_north_first, named_system};
use super::{Coordinates, Format, Model, ModelFault, ReadOptions};
use crate::message::{Message, message};
use glam::DVec3;
use std::fs::File;
use std::path::Path;
use tables::GmlTables;

mod latin;
mod objects;
mod polygon;
mod scan;
mod tables;

/// CityGML, `.gml` and `.xml`.
pub(super) struct CityGml;

impl Format for CityGml {
    fn name(&self) -> &'static str {
        "CityGML"
    }

    fn endings(&self) -> &'static [&'static str] {
        &["gml", "citygml", "xml"]
    }

    fn begins(&self, head: &[u8]) -> bool {
        let head = super::whole::without_mark(head).trim_ascii_start();
        let has = |wanted: &[u8]| head.windows(wanted.len()).any(|window| window == wanted);
        head.starts_with(b"<") && has(b"CityModel") && has(b"opengis.net/citygml")
    }

    fn read(&self, path: &Path, options: &ReadOptions) -> Result<Model, ModelFault> {
        if !std::fs::metadata(path).map_err(ModelFault::unreadable)?.is_file() {
            return Err(message!["is not a file"; "name a model file"].into());
        }
        let file = File::open(path).map_err(ModelFault::unreadable)?;
        let mut tables = scan::scan(latin::decoded(file)?)?;
        let mut builder = CityBuilder::new(None, options.told_step(1.0));
        let (coordinates, notes) = brought_in_order(&mut tables);
        std::mem::swap(&mut builder.tally, &mut tables.tally);
        objects::add(&tables, &mut builder)?;
        let mut model = builder.finish(coordinates);
        model.notes.extend(notes);
        if model.parts.is_empty() {
            let left_out: Vec<String> =
                model.left_out.iter().map(|one| format!("{} {}: {}", one.count, one.what, one.why)).collect();
            let why = if left_out.is_empty() { String::new() } else { format!(" ({})", crate::message::few(left_out)) };
            let what = format!("has no surfaces that can be used{why}");
            return Err(message![what; "export it with a level of detail of 1 or higher"].into());
        }
        Ok(model)
    }
}

/// Swaps coordinates to easting (or longitude) first if the file has them second, and says what the coordinates are.
fn brought_in_order(tables: &mut GmlTables) -> (Coordinates, Vec<Message>) {
    let mut notes = Vec::new();
    let Some(said) = tables.system.clone() else {
        return (Coordinates::Local, notes);
    };
    let Some(NamedSystem { crs, is_official }) = named_system(&said) else {
        return (Coordinates::Local, notes);
    };
    if tables.other_systems > 0 {
        notes.push(message![format!(
            "names other reference systems than {crs} at {} geometries, which are read as if they were in it",
            tables.other_systems
        ); "export it in one reference system"]);
    }
    if is_official && is_north_first(&crs) {
        // beyond 90 degrees there are only longitudes
        let is_degrees = tables.points.iter().all(|point| point.x.abs() <= 180.0 && point.y.abs() <= 180.0);
        if is_degrees && tables.points.iter().any(|point| point.x.abs() > 90.0) {
            notes.push(message![format!(
                "has latitudes before longitudes, as {said} says, but its first coordinates can only be longitudes, and are read as such"
            )]);
        } else {
            tables.points.iter_mut().for_each(|point| *point = DVec3::new(point.y, point.x, point.z));
        }
    }
    notes.extend(without_zone(&crs, &mut tables.points));
    (Coordinates::Map(crs), notes)
}

/// Removes the number of the UTM zone that German surveyors write before the easting, and that the system's coordinates
/// do not have.
fn without_zone(crs: &str, points: &mut [DVec3]) -> Option<Message> {
    let zone: u32 = crs.strip_prefix("EPSG:258")?.parse().ok().filter(|zone| (28..=38).contains(zone))?;
    let prefix = f64::from(zone) * 1e6;
    if points.is_empty() || !points.iter().all(|point| (prefix..prefix + 1e6).contains(&point.x)) {
        return None;
    }
    points.iter_mut().for_each(|point| point.x -= prefix);
    Some(message![format!(
        "has eastings that begin with the number of their zone, {zone}, which {crs} does not have: it is removed"
    )])
}
