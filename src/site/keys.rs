//! The keys that a site file may have, and what to say about one that it may not.

use super::asked::refuse;
use super::error::{At, SiteError};
use toml::{Table, Value};

/// Every table's keys with an example of each; `docs` and errors speak from it.
const KEYS: &[(&str, &str, &str)] = &[
    ("place", "name", "name = \"Champ de Mars, Paris\""),
    ("place", "latitude", "latitude = 48.8583"),
    ("place", "longitude", "longitude = 2.2945"),
    ("place", "elevation", "elevation = 35.0"),
    ("place", "time_zone", "time_zone = \"Europe/Paris\""),
    ("model", "path", "path = \"tower.glb\""),
    ("model", "scene", "scene = \"existing\""),
    ("model", "up", "up = \"z\""),
    ("model", "north", "north = 0.0"),
    ("model", "position", "position = [0.0, 0.0, 0.0]"),
    ("model", "scale", "scale = 1.0"),
    ("model", "casts", "casts = [\"roof\", \"walls\"]"),
    ("model", "receives", "receives = true"),
    ("ground", "level", "level = 0.0"),
    ("study", "date", "date = 2026-09-18"),
    ("study", "dates", "dates = [\"2026-01-01\", \"2026-12-31\"]"),
    ("study", "from", "from = \"10:00\""),
    ("study", "to", "to = \"14:00\""),
    ("study", "step", "step = \"30min\""),
    ("study", "technique", "technique = \"auto\""),
    ("plan", "region", "region = [-300, -300, 300, 300]"),
    ("plan", "cell", "cell = 0.5"),
    ("camera", "eye", "eye = [250, -300, 180]"),
    ("camera", "target", "target = [0, 0, 60]"),
    ("camera", "up", "up = [0, 0, 1]"),
    ("camera", "fov", "fov = 40.0"),
    ("camera", "side", "side = \"south\""),
    ("probe", "name", "name = \"kitchen window\""),
    ("probe", "point", "point = [12.0, -3.0, 4.5]"),
    ("probe", "normal", "normal = [0, -1, 0]"),
];

/// How a key is written, for errors.
pub(super) fn example(table: &str, key: &str) -> &'static str {
    KEYS.iter().find(|known| (known.0, known.1) == (table, key)).map_or("", |known| known.2)
}

/// The tables of which there may be several.
const LISTS: [&str; 2] = ["model", "probe"];

/// A table's name as it is written.
pub(super) fn bracketed(table: &str) -> String {
    if LISTS.contains(&table) { format!("[[{table}]]") } else { format!("[{table}]") }
}

/// Refuses every table and key that is not known, and tables that are no tables.
///
/// # Errors
/// [`SiteError::Unknown`] with the nearest known one, [`SiteError::Value`].
pub(super) fn check(file: &str, root: &Table) -> Result<(), SiteError> {
    for (name, value) in root {
        let known = KEYS.iter().any(|known| known.0 == name);
        match value {
            Value::Table(table) if known && !LISTS.contains(&name.as_str()) => {
                check_keys(file, name, &bracketed(name), table)?
            }
            Value::Array(tables) if LISTS.contains(&name.as_str()) && tables.iter().all(Value::is_table) => {
                for (index, table) in tables.iter().filter_map(Value::as_table).enumerate() {
                    check_keys(file, name, &numbered(name, index, tables.len()), table)?;
                }
            }
            _ if known => {
                let brackets = bracketed(name);
                let at = At::Key { file: file.to_owned(), table: brackets.clone(), key: String::new() };
                let what = format!("write {brackets} on a line of its own, and its keys on the lines below it");
                return Err(refuse(at, what));
            }
            _ => {
                let is_table =
                    value.is_table() || value.as_array().is_some_and(|list| list.iter().any(Value::is_table));
                return Err(unknown_name(file, name, is_table));
            }
        }
    }
    Ok(())
}

/// What one of a list's tables is called in errors: by its number where there are several.
pub(super) fn numbered(list: &str, index: usize, tables: usize) -> String {
    let brackets = bracketed(list);
    if tables > 1 { format!("{brackets} number {}", index + 1) } else { brackets }
}

fn check_keys(file: &str, name: &str, brackets: &str, table: &Table) -> Result<(), SiteError> {
    for key in table.keys() {
        if !KEYS.iter().any(|known| known.0 == name && known.1 == key) {
            return Err(SiteError::Unknown {
                at: At::Key { file: file.to_owned(), table: brackets.to_owned(), key: key.clone() },
                nearest: nearest_key(key, name),
            });
        }
    }
    Ok(())
}

/// A name before any table: a misspelt table, or a key that lacks its table.
fn unknown_name(file: &str, name: &str, is_table: bool) -> SiteError {
    let at = |table: String, key: &str| At::Key { file: file.to_owned(), table, key: key.to_owned() };
    if is_table {
        let tables = KEYS.iter().map(|known| known.0);
        let nearest = crate::choice::nearest(name, tables).unwrap_or("place");
        return SiteError::Unknown { at: at(format!("[{name}]"), ""), nearest: bracketed(nearest) };
    }
    SiteError::Unknown { at: at("before any table:".to_owned(), name), nearest: nearest_key(name, "") }
}

/// The nearest key with its table; of two equally near ones that in `home`.
fn nearest_key(word: &str, home: &str) -> String {
    let lower = word.to_lowercase();
    let score = |known: &(&str, &str, &str)| {
        let at_home = if known.0 == home { 0.05 } else { 0.0 };
        strsim::jaro_winkler(known.1, &lower) + at_home
    };
    KEYS.iter()
        .max_by(|a, b| score(a).total_cmp(&score(b)))
        .map_or_else(String::new, |known| format!("{} in {}", known.1, bracketed(known.0)))
}
