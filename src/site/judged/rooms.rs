//! A table of windows with their rooms → the properties of each window.

use super::request::JudgedWindow;
use super::windows::AskedWindows;
use crate::choice::nearest;
use crate::formats::{composed, on_disk};
use crate::message::{Message, few, message};
use crate::site::csv_lines::{CsvLines, text_of};
use crate::site::error::{FieldLocation, SiteError};
use crate::site::judged::asked_table::AskedTable;
use crate::site::overrides::refuse;
use crate::site::written::WrittenSite;
use rustc_hash::FxHashMap;
use std::path::{Path, PathBuf};

/// The columns, of which all but the first may be absent.
const COLUMNS: [&str; 6] = ["window", "room", "dwelling", "usage", "floor", "room_area"];

/// A line about a window.
#[derive(Debug, Default)]
struct RoomLine {
    line: usize,
    window: String,
    room: Option<String>,
    dwelling: Option<String>,
    usage: Option<String>,
    floor: Option<f64>,
    room_m2: Option<f64>,
}

/// Sets the properties of windows that the tables of rooms give.
///
/// # Errors
/// A table that cannot be read, a window that does not exist or has two lines, a room without a window, and a room with
/// two floor areas.
pub(super) fn add_rooms(written: &WrittenSite, asked: &mut AskedWindows) -> Result<(), SiteError> {
    let tables = &written.site.window;
    let mut read: Vec<PathBuf> = Vec::new();
    for (index, window) in tables.iter().enumerate() {
        let Some(name) = &window.rooms else { continue };
        let table = AskedTable { written, name: "window", at: (index, tables.len()) };
        let path = table.file("rooms", name)?;
        if read.contains(&path) {
            continue;
        }
        let names_it = |index: usize| {
            let rooms = tables.get(index).and_then(|other| other.rooms.as_ref());
            rooms.is_some_and(|rooms| on_disk(&written.folder.join(rooms)) == path)
        };
        let of_file: Vec<usize> = (0..asked.list.len()).filter(|at| names_it(asked.of_table[*at])).collect();
        let note = add_file(&path, name, &mut asked.list, &of_file)?;
        asked.notes.extend(note);
        read.push(path);
    }
    one_area_each(written, asked)
}

/// Sets the properties that one file gives. Returns a note on the windows that it does not name.
fn add_file(
    path: &Path,
    name: &str,
    windows: &mut [JudgedWindow],
    of_file: &[usize],
) -> Result<Option<Message>, SiteError> {
    let file = path.display().to_string();
    let mut by_name: FxHashMap<String, (usize, bool)> =
        of_file.iter().map(|at| (composed(&windows[*at].name).into_owned(), (*at, false))).collect();
    for line in lines(&file, &text_of(path)?)? {
        let at = line_of(&file, line.line);
        if line.window.is_empty() {
            let of = line.room.or(line.dwelling).unwrap_or_default();
            return Err(refuse(at, message![format!("\"{of}\" has no window"); "name one, or leave the line out"]));
        }
        let Some((index, is_taken)) = by_name.get_mut(&*composed(&line.window)) else {
            let what = format!("there is no window \"{}\"", line.window);
            let nearest =
                nearest(&line.window, of_file.iter().map(|at| windows[*at].name.as_str())).unwrap_or_default();
            return Err(refuse(at, message![what; format!("the nearest is \"{nearest}\"")]));
        };
        if std::mem::replace(is_taken, true) {
            let what = format!("the window \"{}\" stands in two lines", line.window);
            return Err(refuse(at, message![what; "write one for each window"]));
        }
        let window = &mut windows[*index];
        window.room = line.room.or(window.room.take());
        window.dwelling = line.dwelling.or(window.dwelling.take());
        window.usage = line.usage.or(window.usage.take());
        window.floor = line.floor.or(window.floor);
        window.room_m2 = line.room_m2.or(window.room_m2);
    }
    let mut missing: Vec<usize> = by_name.values().filter(|(_, is_taken)| !is_taken).map(|(at, _)| *at).collect();
    missing.sort_unstable();
    let (windows_are, count) = (if missing.len() == 1 { "window is" } else { "windows are" }, missing.len());
    let names = few(missing.iter().map(|at| format!("\"{}\"", windows[*at].name)).collect());
    Ok((count > 0).then(|| Message::from(format!("{count} {windows_are} not in {name}: {names}"))))
}

fn line_of(file: &str, line: usize) -> FieldLocation {
    FieldLocation::Key { file: file.to_owned(), table: format!("line {line}"), key: String::new() }
}

/// The lines of a table's text.
fn lines(file: &str, text: &str) -> Result<Vec<RoomLine>, SiteError> {
    let head = text.lines().next().unwrap_or_default();
    let separator = if head.contains(';') { ';' } else { ',' };
    let mut lines = CsvLines::new(text, separator);
    let columns = match lines.next() {
        Some((_, Some(fields))) => columns(file, &fields)?,
        _ => columns(file, &[])?,
    };
    let mut found = Vec::new();
    while let Some((line, fields)) = lines.next() {
        let at = || line_of(file, line);
        let fields = fields.ok_or_else(|| refuse(at(), message!["a quote has no end"; "close it"]))?;
        if fields.iter().all(|field| field.trim().is_empty()) {
            continue;
        }
        if fields.len() != columns.len() {
            let what = format!("there are {} fields and {} columns", fields.len(), columns.len());
            return Err(refuse(
                at(),
                message![what; format!("write \"{separator}\" between fields, and quotes around one that has it")],
            ));
        }
        let text = |name: &str| {
            let column = columns.iter().position(|column| *column == name)?;
            Some(fields[column].trim().to_owned()).filter(|text| !text.is_empty())
        };
        let number = |name: &str, low: f64, high: f64| {
            let Some(text) = text(name) else { return Ok(None) };
            // if fields are separated by semicolons, numbers may have a decimal comma
            let plain = if separator == ';' { text.replace(',', ".") } else { text.clone() };
            let number = plain.parse::<f64>().ok().filter(|number| (low..=high).contains(number));
            let range = if low == f64::MIN_POSITIVE {
                format!("above 0 and up to {high}")
            } else {
                format!("between {low} and {high}")
            };
            let what =
                || message![format!("{name} is \"{text}\", which is not a number {range}"); "write for example 3.2"];
            number.map(Some).ok_or_else(|| refuse(at(), what()))
        };
        found.push(RoomLine {
            line,
            window: text("window").unwrap_or_default(),
            room: text("room"),
            dwelling: text("dwelling"),
            usage: text("usage"),
            floor: number("floor", -1e5, 1e5)?,
            room_m2: number("room_area", f64::MIN_POSITIVE, 1e6)?,
        });
    }
    Ok(found)
}

/// The column of each field of the first line.
fn columns(file: &str, fields: &[String]) -> Result<Vec<&'static str>, SiteError> {
    let mut columns = Vec::new();
    for field in fields {
        let name = field.trim().to_lowercase();
        let Some(column) = COLUMNS.iter().find(|column| **column == name).copied() else {
            let what = format!("\"{}\" is not a column", field.trim());
            let nearest = nearest(&name, COLUMNS).unwrap_or_default();
            return Err(refuse(line_of(file, 1), message![what; format!("the nearest is {nearest}")]));
        };
        if columns.contains(&column) {
            return Err(refuse(
                line_of(file, 1),
                message![format!("the column {column} appears twice"); "leave one out"],
            ));
        }
        columns.push(column);
    }
    if !columns.contains(&"window") || columns.len() < 2 {
        let what = format!("the columns are not window and some of {}", COLUMNS[1..].join(", "));
        return Err(refuse(line_of(file, 1), message![what; "name them in the first line"]));
    }
    Ok(columns)
}

/// Refuses a room that has two floor areas.
fn one_area_each(written: &WrittenSite, asked: &AskedWindows) -> Result<(), SiteError> {
    let mut known: FxHashMap<(Option<&str>, &str), f64> = FxHashMap::default();
    for (window, index) in asked.list.iter().zip(&asked.of_table) {
        let (Some(room), Some(area)) = (window.room.as_deref(), window.room_m2) else { continue };
        let first = *known.entry((window.dwelling.as_deref(), room)).or_insert(area);
        if first != area {
            let table = AskedTable { written, name: "window", at: (*index, written.site.window.len()) };
            let what =
                format!("the room \"{room}\" has {area} m² by \"{}\", and {first} m² by another window", window.name);
            return Err(table.wrong("room_area", message![what; "write one area for each room"]));
        }
    }
    Ok(())
}
