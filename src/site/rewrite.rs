//! Rewrites a site file's text: replaces what has changed, and leaves everything else as a person wrote it.

use super::error::SiteError;
use super::file::SiteFile;
use toml::{Table, Value};
use toml_edit::{ArrayOfTables, DocumentMut, Item, TableLike};

impl SiteFile {
    /// A text that reads as this site file and keeps the comments, order and spelling of another site file's text.
    ///
    /// What both say alike is left alone, however it is spelt; a comment goes only with the line that it stands on or above,
    /// where that is no longer said.
    ///
    /// # Errors
    /// A text that is no site file, and what TOML cannot hold.
    pub fn to_toml_in(&self, text: &str) -> Result<String, SiteError> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let unwritable = |what: String| SiteError::Unwritable { what };
        let table = |site: &SiteFile| Table::try_from(site).map_err(|error| unwritable(error.to_string()));
        let before = table(&SiteFile::parse("the site file", text)?)?;
        let mut document: DocumentMut =
            text.parse().map_err(|error: toml_edit::TomlError| unwritable(error.to_string()))?;
        merge(document.as_table_mut(), &before, &table(self)?).map_err(unwritable)?;
        if !before.contains_key("place") {
            self.note_source(&mut document);
        }
        let is_new = |key: &str| before.get("place").and_then(|place| place.get(key)).is_none();
        if is_new("elevation") {
            self.note_elevation(&mut document);
        }
        Ok(document.to_string())
    }
}

impl SiteFile {
    /// Says above a new [place] which file it is from.
    fn note_source(&self, document: &mut DocumentMut) {
        let said = self.place.as_ref().and_then(|place| place.said_by());
        let table = document.get_mut("place").and_then(Item::as_table_mut);
        if let (Some(said), Some(table)) = (said, table) {
            // a file's name may have a line break
            let said = said.replace(char::is_control, " ");
            table.decor_mut().set_prefix(format!("\n# from {said}\n"));
        }
    }

    /// Says behind a new elevation which file it is from.
    fn note_elevation(&self, document: &mut DocumentMut) {
        let said = self.place.as_ref().and_then(|place| place.elevation_said_by());
        let value = document.get_mut("place").and_then(|place| place.get_mut("elevation")).and_then(Item::as_value_mut);
        if let (Some(said), Some(value)) = (said, value) {
            value.decor_mut().set_suffix(format!(" # from {}", said.replace(char::is_control, " ")));
        }
    }
}

/// Writes into a table what differs between the two.
fn merge(into: &mut dyn TableLike, before: &Table, after: &Table) -> Result<(), String> {
    for key in before.keys().filter(|key| !after.contains_key(*key)) {
        into.remove(key);
    }
    for (key, value) in after {
        let old = before.get(key);
        if old == Some(value) {
            continue;
        }
        match value {
            Value::Table(after) => {
                let item = into.entry(key).or_insert_with(toml_edit::table);
                let Some(table) = item.as_table_like_mut() else { return Err(format!("{key} is no table")) };
                merge(table, old.and_then(Value::as_table).unwrap_or(&Table::new()), after)?;
            }
            Value::Array(after) if after.first().is_some_and(Value::is_table) => {
                let old = old.and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
                merge_list(into.entry(key).or_insert_with(toml_edit::array), old, after)?;
            }
            value => {
                let mut new: toml_edit::Value =
                    value.to_string().parse().map_err(|error: toml_edit::TomlError| error.to_string())?;
                match into.get_mut(key) {
                    Some(item) => {
                        // what stands behind it on its line
                        if let Some(old) = item.as_value() {
                            *new.decor_mut() = old.decor().clone();
                        }
                        *item = Item::Value(new);
                    }
                    None => drop(into.insert(key, Item::Value(new))),
                }
            }
        }
    }
    Ok(())
}

/// The same for `[[model]]` and `[[probe]]`, one after the other.
fn merge_list(item: &mut Item, before: &[Value], after: &[Value]) -> Result<(), String> {
    // a list in one line is written as tables, which it reads as
    if !item.is_array_of_tables() {
        let list = std::mem::take(item).into_array_of_tables().unwrap_or_else(|_| ArrayOfTables::new());
        *item = Item::ArrayOfTables(list);
    }
    let Some(list) = item.as_array_of_tables_mut() else { return Err("no list of tables".to_owned()) };
    while list.len() > after.len() {
        list.remove(list.len() - 1);
    }
    let none = Table::new();
    for (index, after) in after.iter().filter_map(Value::as_table).enumerate() {
        let mut old = before.get(index).and_then(Value::as_table).unwrap_or(&none);
        if index >= list.len() {
            list.push(toml_edit::Table::new());
            old = &none;
        }
        if let Some(table) = list.get_mut(index) {
            merge(table, old, after)?;
        }
    }
    Ok(())
}
