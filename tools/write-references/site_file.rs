//! The keys of the site file, from the table that its reader uses.

use super::blocks::{Block, head, row};
use gnomon::site::{SITE_KEYS, SITE_TABLES, SiteKey, ValueType};

/// A block for each table.
pub(super) fn blocks() -> Vec<Block> {
    SITE_TABLES.iter().map(|(table, _, about)| ((*table).to_owned(), section(table, about))).collect()
}

fn section(table: &str, about: &str) -> String {
    let mut text = format!("{about}\n\n{}", head(["key", "value", "default", "meaning", "example"]));
    for key in SITE_KEYS.iter().filter(|key| key.table == table) {
        let [name, example] = [key.key, key.example].map(|code| format!("`{code}`"));
        text.push_str(&row([&name, &value(key), key.default, key.meaning, &example]));
    }
    text
}

/// What is written behind a key, in words, with its unit.
fn value(key: &SiteKey) -> String {
    let kind = match key.value {
        ValueType::Text => "text in quotes".to_owned(),
        ValueType::Moment => "text in quotes, or TOML's own date or time".to_owned(),
        ValueType::TwoMoments => "a list of two dates".to_owned(),
        ValueType::Number => "a number".to_owned(),
        ValueType::Numbers(count) => format!("a list of {count} numbers"),
        ValueType::TextOrNumber => "text in quotes, or a whole number".to_owned(),
        ValueType::Texts => "a list of texts in quotes".to_owned(),
        ValueType::TextOrTexts => "text in quotes, or a list of such texts".to_owned(),
        ValueType::NumberList => "a list of numbers".to_owned(),
        ValueType::Corners => "a list of corners, each of 2 numbers".to_owned(),
        ValueType::FourPoints => "a list of 4 points, each of 3 numbers".to_owned(),
        ValueType::Sides(of_side) => format!("a list of `{{ side = 1, {of_side} = 1.0 }}`"),
        ValueType::Names => "`true`, `false`, or a list of names in quotes".to_owned(),
        ValueType::Word(words) => words().iter().map(|word| format!("`\"{word}\"`")).collect::<Vec<_>>().join(", "),
    };
    if key.unit.is_empty() { kind } else { format!("{kind}, {}", key.unit) }
}
