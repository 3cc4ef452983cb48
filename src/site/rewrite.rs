//! Rewrites a site file's text: replaces what has changed, and keeps everything else as it was written.

use super::error::SiteError;
use super::file::SiteFile;
use toml::{Table, Value};
use toml_edit::{ArrayOfTables, DocumentMut, Item, TableLike};

impl SiteFile {
    /// Writes this site file into the text of another one, and keeps the comments, order and spelling of that text.
    ///
    /// Values that both have stay as they are written. A comment disappears only together with the line that it is on
    /// or above.
    ///
    /// # Errors
    /// A text that is not a site file, or a value that TOML cannot represent.
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
    /// Writes a comment above a new `[place]` that names the file it is from.
    fn note_source(&self, document: &mut DocumentMut) {
        let said = self.place.as_ref().and_then(|place| place.said_by());
        let table = document.get_mut("place").and_then(Item::as_table_mut);
        if let (Some(said), Some(table)) = (said, table) {
            // a file's name may contain a line break
            let said = said.replace(char::is_control, " ");
            table.decor_mut().set_prefix(format!("\n# from {said}\n"));
        }
    }

    /// Writes a comment after a new elevation that names the file it is from.
    fn note_elevation(&self, document: &mut DocumentMut) {
        let said = self.place.as_ref().and_then(|place| place.elevation_said_by());
        let value = document.get_mut("place").and_then(|place| place.get_mut("elevation")).and_then(Item::as_value_mut);
        if let (Some(said), Some(value)) = (said, value) {
            value.decor_mut().set_suffix(format!(" # from {}", said.replace(char::is_control, " ")));
        }
    }
}

/// Writes the differences between two tables into the text's table.
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
                let Some(table) = item.as_table_like_mut() else { return Err(format!("{key} is not a table")) };
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
                        // keeps the comment on the same line
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

/// The indices of the tables that a shorter list lacks: those that differ from the next one that is left, from the front
/// on. So a table keeps its comments if one before it is removed.
fn removed(before: &[&Value], after: &[Value]) -> Vec<usize> {
    let mut surplus = before.len().saturating_sub(after.len());
    let (mut left, mut removed) = (after.iter().peekable(), Vec::new());
    for (index, table) in before.iter().enumerate() {
        if surplus > 0 && left.peek() != Some(table) {
            removed.push(index);
            surplus -= 1;
        } else {
            left.next();
        }
    }
    removed
}

/// The same for the tables of a list, such as `[[model]]` and `[[area]]`, one after the other.
fn merge_list(item: &mut Item, before: &[Value], after: &[Value]) -> Result<(), String> {
    // an inline list is rewritten as tables, which mean the same
    if !item.is_array_of_tables() {
        let list = std::mem::take(item).into_array_of_tables().unwrap_or_else(|_| ArrayOfTables::new());
        *item = Item::ArrayOfTables(list);
    }
    let Some(list) = item.as_array_of_tables_mut() else { return Err("not a list of tables".to_owned()) };
    let mut before: Vec<&Value> = before.iter().collect();
    for index in removed(&before, after).into_iter().rev() {
        before.remove(index);
        if index < list.len() {
            list.remove(index);
        }
    }
    let none = Table::new();
    for (index, after) in after.iter().filter_map(Value::as_table).enumerate() {
        let mut old = before.get(index).and_then(|table| table.as_table()).unwrap_or(&none);
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
