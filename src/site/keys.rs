//! Checks the keys of a site file, and suggests the nearest for one that does not exist.

use super::error::{FieldLocation, SiteError};
use super::key_table::{SITE_KEYS, SITE_TABLES, SiteKey};
use super::overrides::refuse;
use toml::{Table, Value};

/// An example of a key, for errors.
pub(super) fn example(table: &str, key: &str) -> &'static str {
    SITE_KEYS.iter().find(|known| (known.table, known.key) == (table, key)).map_or("", |known| known.example)
}

/// Whether a site file may have several of a table.
fn is_list(table: &str) -> bool {
    SITE_TABLES.iter().any(|(name, is_list, _)| *name == table && *is_list)
}

/// A table's heading.
pub(super) fn bracketed(table: &str) -> String {
    if is_list(table) { format!("[[{table}]]") } else { format!("[{table}]") }
}

/// Refuses unknown tables and keys, and values where tables are expected.
///
/// # Errors
/// [`SiteError::Unknown`] with the nearest known key, or [`SiteError::Value`].
pub(super) fn check(file: &str, root: &Table) -> Result<(), SiteError> {
    for (name, value) in root {
        let known = SITE_TABLES.iter().any(|(table, ..)| table == name);
        match value {
            Value::Table(table) if known && !is_list(name) => check_keys(file, name, &bracketed(name), table)?,
            Value::Array(tables) if is_list(name) && tables.iter().all(Value::is_table) => {
                for (index, table) in tables.iter().filter_map(Value::as_table).enumerate() {
                    check_keys(file, name, &numbered(name, index, tables.len()), table)?;
                }
            }
            _ if known => {
                let brackets = bracketed(name);
                let at = FieldLocation::Key { file: file.to_owned(), table: brackets.clone(), key: String::new() };
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

/// How errors refer to one of a list's tables: with its number if there are several.
pub(super) fn numbered(list: &str, index: usize, tables: usize) -> String {
    let brackets = bracketed(list);
    if tables > 1 { format!("{brackets} number {}", index + 1) } else { brackets }
}

fn check_keys(file: &str, name: &str, brackets: &str, table: &Table) -> Result<(), SiteError> {
    for key in table.keys() {
        if !SITE_KEYS.iter().any(|known| known.table == name && known.key == key) {
            return Err(SiteError::Unknown {
                at: FieldLocation::Key { file: file.to_owned(), table: brackets.to_owned(), key: key.clone() },
                nearest: nearest_key(key, name),
            });
        }
    }
    Ok(())
}

/// The error for an unknown name before any table: a misspelt table, or a key without its table.
fn unknown_name(file: &str, name: &str, is_table: bool) -> SiteError {
    let at = |table: String, key: &str| FieldLocation::Key { file: file.to_owned(), table, key: key.to_owned() };
    if is_table {
        let tables = SITE_TABLES.iter().map(|(table, ..)| *table);
        let nearest = crate::choice::nearest(name, tables).unwrap_or("place");
        return SiteError::Unknown { at: at(format!("[{name}]"), ""), nearest: bracketed(nearest) };
    }
    SiteError::Unknown { at: at("before any table:".to_owned(), name), nearest: nearest_key(name, "") }
}

/// The nearest key with its table; of two equally near ones, the one in the table `home`.
fn nearest_key(word: &str, home: &str) -> String {
    let lower = word.to_lowercase();
    let score = |known: &SiteKey| {
        let at_home = if known.table == home { 0.05 } else { 0.0 };
        strsim::jaro_winkler(known.key, &lower) + at_home
    };
    SITE_KEYS
        .iter()
        .max_by(|a, b| score(a).total_cmp(&score(b)))
        .map_or_else(String::new, |known| format!("{} in {}", known.key, bracketed(known.table)))
}
