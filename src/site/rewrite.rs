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

/// For each table of a list the index of the one that it was before, if it was there: of equal tables as many as can keep
/// their order, and between them one after the other. So a table keeps its comments whatever goes or comes beside it.
fn former(before: &[Value], after: &[Value]) -> Vec<Option<usize>> {
    let equal = |pairs: &mut dyn Iterator<Item = (&Value, &Value)>| pairs.take_while(|(old, new)| old == new).count();
    let front = equal(&mut before.iter().zip(after));
    let (old, new) = (&before[front..], &after[front..]);
    let back = equal(&mut old.iter().rev().zip(new.iter().rev()));
    let (old, new) = (&old[..old.len() - back], &new[..new.len() - back]);
    let between = match old.len() * new.len() <= MOST_PAIRS {
        true => former_between(old, new),
        false => (0..new.len()).map(|index| (index < old.len()).then_some(index)).collect(),
    };
    let between = between.into_iter().map(|index| index.map(|index| index + front));
    let at_back = (before.len() - back..before.len()).map(Some);
    (0..front).map(Some).chain(between).chain(at_back).collect()
}

/// The most pairs of tables that are compared for their order; of longer lists tables are taken one after the other.
const MOST_PAIRS: usize = 1 << 20;

/// The same for the tables between equal ones at the front and at the back.
fn former_between(before: &[Value], after: &[Value]) -> Vec<Option<usize>> {
    // the most equal tables from an index of each list on
    let mut most = vec![vec![0usize; after.len() + 1]; before.len() + 1];
    for one in (0..before.len()).rev() {
        for other in (0..after.len()).rev() {
            most[one][other] = match before[one] == after[other] {
                true => most[one + 1][other + 1] + 1,
                false => most[one + 1][other].max(most[one][other + 1]),
            };
        }
    }
    let (mut former, mut one, mut other) = (vec![None; after.len()], 0, 0);
    // the first tables since the last equal ones
    let (mut first, mut second) = (0, 0);
    loop {
        let is_end = one == before.len() || other == after.len();
        if is_end || before[one] == after[other] {
            let ends = if is_end { [before.len(), after.len()] } else { [one, other] };
            (first..ends[0]).zip(second..ends[1]).for_each(|(old, new)| former[new] = Some(old));
            if is_end {
                return former;
            }
            former[other] = Some(one);
            (one, other) = (one + 1, other + 1);
            (first, second) = (one, other);
        } else if most[one + 1][other] >= most[one][other + 1] {
            one += 1;
        } else {
            other += 1;
        }
    }
}

/// The same for the tables of a list, such as `[[model]]` and `[[area]]`, one after the other.
fn merge_list(item: &mut Item, before: &[Value], after: &[Value]) -> Result<(), String> {
    // an inline list is rewritten as tables, which mean the same
    if !item.is_array_of_tables() {
        let list = std::mem::take(item).into_array_of_tables().unwrap_or_else(|_| ArrayOfTables::new());
        *item = Item::ArrayOfTables(list);
    }
    let Some(list) = item.as_array_of_tables_mut() else { return Err("not a list of tables".to_owned()) };
    let written: Vec<toml_edit::Table> = list.iter().cloned().collect();
    list.clear();
    let none = Table::new();
    for (after, former) in after.iter().zip(former(before, after)) {
        let Some(after) = after.as_table() else { continue };
        let known = former.and_then(|index| written.get(index).zip(before[index].as_table()));
        let (mut table, old) = known.map_or((toml_edit::Table::new(), &none), |(table, old)| (table.clone(), old));
        merge(&mut table, old, after)?;
        list.push(table);
    }
    Ok(())
}
