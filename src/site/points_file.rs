//! Points from a table: CSV whose first line names its columns.

use super::csv_lines::{CsvLines, text_of};
use super::error::{FieldLocation, SiteError};
use super::overrides::refuse;
use crate::formats::composed;
use crate::message::{Field, message};
use crate::view::Probe;
use glam::DVec3;
use rustc_hash::FxHashSet;
use std::path::Path;

/// The columns, the last three of which may be absent.
const COLUMNS: [&str; 7] = ["name", "x", "y", "z", "nx", "ny", "nz"];

/// No more points are asked at once.
pub(super) const MOST_PROBES: usize = 100_000;

/// A normal's direction, whatever its length.
pub(super) fn unit(normal: [f64; 3], at: impl Fn() -> FieldLocation) -> Result<DVec3, SiteError> {
    let normal = DVec3::from_array(normal);
    // Brought near 1 first, so that no square overflows.
    let unit = (normal / normal.abs().max_element()).normalize();
    if unit.is_finite() {
        return Ok(unit);
    }
    let what = format!("{normal} is no direction");
    Err(refuse(at(), message![what; "write one of any length but 0, for example [0, -1, 0]"]))
}

/// The points of a file.
///
/// # Errors
/// What cannot be read, and the first line that is wrong.
pub(super) fn read(path: &Path) -> Result<Vec<Probe>, SiteError> {
    let file = path.display().to_string();
    points(&file, &text_of(path)?)
}

/// The points of a table's text.
fn points(file: &str, text: &str) -> Result<Vec<Probe>, SiteError> {
    let at =
        |line: usize| FieldLocation::Key { file: file.to_owned(), table: format!("line {line}"), key: String::new() };
    let mut lines = CsvLines::new(text, ',');
    let columns = match lines.next() {
        Some((_, Some(fields))) => fields.iter().map(|field| field.trim().to_ascii_lowercase()).collect(),
        _ => Vec::new(),
    };
    if columns != COLUMNS && columns != COLUMNS[..4] {
        let what = format!("the columns are not {}", COLUMNS.join(","));
        return Err(refuse(at(1), message![what; "name them in the first line; the last three may be left out"]));
    }
    let mut names = FxHashSet::default();
    let mut probes = Vec::new();
    while let Some((line, fields)) = lines.next() {
        let fields = fields.ok_or_else(|| refuse(at(line), message!["a quote has no end"; "close it"]))?;
        if fields.iter().all(|field| field.trim().is_empty()) {
            continue;
        }
        if fields.len() != columns.len() {
            let what = format!("there are {} fields and {} columns", fields.len(), columns.len());
            return Err(refuse(at(line), message![what; "write a comma between fields, and a point in numbers"]));
        }
        let probe = point(&fields, probes.len() + 1, &at(line))?;
        if !names.insert(composed(&probe.name).into_owned()) {
            let what = format!("\"{}\" is the name of another point, too", probe.name);
            return Err(refuse(at(line), message![what; "give each its own name"]));
        }
        if probes.len() == MOST_PROBES {
            return Err(refuse(
                at(line),
                message![format!("there are more than {MOST_PROBES} points"); "write several files"],
            ));
        }
        probes.push(probe);
    }
    if probes.is_empty() {
        return Err(refuse(
            FieldLocation::Field(Field::Points),
            message![format!("{file} has no point"); "write a line for each"],
        ));
    }
    Ok(probes)
}

/// The point of a line.
fn point(fields: &[String], number: usize, at: &FieldLocation) -> Result<Probe, SiteError> {
    let number_of = |column: usize| {
        let text = fields[column].trim();
        text.parse::<f64>().ok().filter(|number| number.is_finite()).ok_or_else(|| {
            let what = format!("{} is \"{text}\" and no number", COLUMNS[column]);
            refuse(at.clone(), message![what; "write metres, for example 12.5"])
        })
    };
    let triple = |first: usize| -> Result<DVec3, SiteError> {
        Ok(DVec3::new(number_of(first)?, number_of(first + 1)?, number_of(first + 2)?))
    };
    let name = match fields[0].trim() {
        "" => format!("point {number}"),
        name => name.to_owned(),
    };
    let is_free = fields[4..].iter().all(|field| field.trim().is_empty());
    let point = triple(1)?;
    let normal = if is_free { None } else { Some(unit(triple(4)?.to_array(), || at.clone())?) };
    Ok(Probe { name, point, normal })
}
