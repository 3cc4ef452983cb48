//! `docs/command.md` and `docs/site-file.md` agree with the definitions of the command line and of the site file.

#[path = "../tools/write-references/main.rs"]
mod write_references;

use gnomon::site::file::SiteFile;
use gnomon::site::{SITE_KEYS, SITE_TABLES, SiteKey, ValueType};
use std::path::Path;
use write_references::{PAGES, renewed};

/// What is wrong with a page, if anything.
fn fault(path: &str, text: &str) -> Option<String> {
    let (_, blocks) = PAGES.iter().find(|(page, _)| *page == path)?;
    let way_out = "`cargo run --example write-references` writes it";
    match renewed(text, &blocks()) {
        Err(what) => Some(format!("{path}: {what}")),
        Ok(renewed) if renewed == text => None,
        Ok(renewed) => {
            let line = renewed.lines().zip(text.lines()).take_while(|(new, old)| new == old).count() + 1;
            Some(format!("{path} is out of date from line {line} on; {way_out}"))
        }
    }
}

fn page(path: &str) -> String {
    std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).expect("a page")
}

#[test]
fn the_pages_are_up_to_date() {
    let faults: Vec<_> = PAGES.iter().filter_map(|(path, _)| fault(path, &page(path))).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn a_page_that_is_out_of_date_is_seen() {
    let [command, _] = PAGES.map(|(path, _)| path);
    let text = page(command);
    let stale = text.replacen("--threads N", "--thread N", 1);
    assert!(fault(command, &stale).is_some_and(|fault| fault.contains("write-references")));
    let without = text.replacen("<!-- generated: shared -->", "", 1);
    assert!(fault(command, &without).is_some_and(|fault| fault.contains("no place for shared")));
    let with_more = format!("{text}\n<!-- generated: nothing -->\n<!-- end -->\n");
    assert!(fault(command, &with_more).is_some_and(|fault| fault.contains("nothing generates the block nothing")));
}

/// A site file with one key.
fn with(key: &SiteKey, line: &str) -> String {
    let is_list = SITE_TABLES.iter().any(|(table, is_list, _)| *table == key.table && *is_list);
    if is_list { format!("[[{}]]\n{line}\n", key.table) } else { format!("[{}]\n{line}\n", key.table) }
}

/// Values that a key of this type accepts, and some that it does not.
fn samples(value: ValueType) -> (Vec<String>, Vec<String>) {
    let (good, bad): (&[&str], &[&str]) = match value {
        ValueType::Text | ValueType::Word(_) => (&["\"x\""], &["1", "true", "[]"]),
        ValueType::Moment => (&["\"x\"", "2026-09-18", "10:00:00"], &["1", "true", "[]"]),
        ValueType::TwoMoments => (&["[\"x\", 2026-09-18]"], &["\"x\"", "[\"x\"]", "[1, 2]"]),
        ValueType::Number => (&["1", "-1.5"], &["\"x\"", "true", "[1.0]"]),
        ValueType::TextOrNumber => (&["\"x\"", "1"], &["true", "1.5", "-1"]),
        ValueType::Texts => (&["[\"x\"]", "[]"], &["1", "\"x\"", "[1]", "true"]),
        ValueType::TextOrTexts => (&["\"x\"", "[\"x\"]"], &["1", "true", "[1]"]),
        ValueType::NumberList => (&["[1, 2.5]", "[]"], &["1", "\"x\"", "[\"x\"]"]),
        ValueType::Corners => (&["[[1, 2.5], [3, 4]]"], &["1", "[1, 2]", "[[1, 2, 3]]", "[[\"x\", 2]]"]),
        ValueType::FourPoints => {
            let points = |count: usize| format!("[{}]", vec!["[1, 2, 3]"; count].join(", "));
            return (vec![points(4)], vec![points(3), points(5), "1".to_owned(), "[[1, 2]]".to_owned()]);
        }
        ValueType::Sides(of_side) => {
            let good = vec![format!("[{{ side = 1, {of_side} = 2.5 }}]"), "[]".to_owned()];
            let bad = ["side = 1", &format!("side = -1, {of_side} = 1"), &format!("side = 1, {of_side} = 1, x = 1")];
            let bad = bad.iter().map(|sides| format!("[{{ {sides} }}]"));
            return (good, bad.chain(["1".to_owned()]).collect());
        }
        ValueType::Names => (&["true", "false", "[\"x\"]"], &["1", "\"x\"", "[1]"]),
        ValueType::Numbers(count) => {
            let list = |count: usize| format!("[{}]", vec!["1"; count].join(", "));
            return (vec![list(count)], vec![list(count + 1), list(count - 1), "1".to_owned(), "\"x\"".to_owned()]);
        }
    };
    let owned = |samples: &[&str]| samples.iter().map(|sample| (*sample).to_owned()).collect();
    (owned(good), owned(bad))
}

#[test]
fn the_reader_takes_of_each_key_what_the_reference_says() {
    assert!(!SITE_KEYS.is_empty());
    for key in SITE_KEYS {
        let reads = |line: &str| SiteFile::parse("site.toml", &with(key, line)).is_ok();
        assert!(reads(key.example), "{} is not an example of {} in {}", key.example, key.key, key.table);
        assert!(key.example.starts_with(&format!("{} = ", key.key)), "{}", key.example);
        let (good, bad) = samples(key.value);
        for value in good {
            assert!(reads(&format!("{} = {value}", key.key)), "{} of {} refuses {value}", key.key, key.table);
        }
        for value in bad {
            assert!(!reads(&format!("{} = {value}", key.key)), "{} of {} takes {value}", key.key, key.table);
        }
    }
}

#[test]
fn every_key_is_explained() {
    for key in SITE_KEYS {
        let is_explained = !key.default.is_empty() && !key.meaning.is_empty();
        assert!(is_explained, "{} of {} has no default or no meaning", key.key, key.table);
        assert!(SITE_TABLES.iter().any(|(table, ..)| *table == key.table), "{} is not a table", key.table);
    }
}
