//! The built-in rules, and those in a site's folder.

use super::error::RuleError;
use super::rule::Rule;
use crate::choice::nearest;
use std::fs;
use std::path::Path;

/// A built-in rule: its id and its text.
type BuiltIn = (&'static str, &'static str);

macro_rules! built_in {
    ($($id:literal),+ $(,)?) => {
        &[$(($id, include_str!(concat!("../../rules/", $id, ".toml")))),+]
    };
}

/// The built-in rules, by region.
pub const BUILT_IN: &[BuiltIn] = built_in![
    "au-nsw-adg-4a1",
    "au-vic-b21",
    "ca-montreal",
    "ch-zh-abv",
    "cn-gb-50180-dwelling",
    "de-din-5034-1",
    "eu-en-17037-sunlight",
    "jp-bsa-56-2",
    "kr-court-tolerance",
    "nl-the-hague",
    "nl-tno-light",
    "nl-tno-strict",
    "pl-wt-60",
    "ru-sanpin-1-2-3685-21",
    "uk-bre-209-sun-on-ground",
    "us-nyc-ceqr-shadows",
    "us-sf-295",
];

/// The largest file that is read as a rule. The built-in ones have a few thousand bytes.
const MOST_BYTES: u64 = 64 << 10;

/// All built-in rules.
///
/// # Errors
/// Never: a test reads them all.
pub fn built_in_rules() -> Result<Vec<Rule>, RuleError> {
    BUILT_IN.iter().map(|(id, text)| Rule::parse(id, text)).collect()
}

/// Returns the text of a built-in rule.
///
/// # Errors
/// [`RuleError::UnknownRule`], which names the nearest one.
pub fn built_in_text(id: &str) -> Result<&'static str, RuleError> {
    match BUILT_IN.iter().find(|(known, _)| *known == id) {
        Some((_, text)) => Ok(text),
        None => Err(RuleError::UnknownRule {
            id: id.to_owned(),
            nearest: nearest(id, BUILT_IN.iter().map(|(known, _)| *known)).unwrap_or_default().to_owned(),
        }),
    }
}

/// Returns the rule of a name for a site in a folder: from the file `NAME.toml` there (or `NAME`, if that already ends
/// in `.toml`), otherwise the built-in one.
///
/// # Errors
/// A name that is neither, or a file that is not a rule.
pub fn rule_for_site(name: &str, folder: &Path) -> Result<Rule, RuleError> {
    let is_file = name.ends_with(".toml");
    let path = folder.join(if is_file { name.to_owned() } else { format!("{name}.toml") });
    if is_file || path.is_file() {
        let file = path.display().to_string();
        let mut rule = Rule::parse(&file, &text_of(&path)?)?;
        rule.source.file = Some(file);
        return Ok(rule);
    }
    Rule::parse(name, built_in_text(name)?)
}

/// The most files of a folder that are looked at as rules.
const MOST_FILES: usize = 1000;

/// A rule that a site can be judged by: the name that asks for it, and the rule, or why it cannot be read.
pub type KnownRule = (String, Result<Rule, RuleError>);

/// The rules for a site in a folder: those of its files that have a table `[rule]`, by name, then the built-in ones
/// that have none of these names.
pub fn rules_for_site(folder: &Path) -> Vec<KnownRule> {
    let mut known: Vec<KnownRule> = names_in(folder)
        .into_iter()
        .filter(|name| says_rule(&folder.join(format!("{name}.toml"))))
        .map(|name| (name.clone(), rule_for_site(&name, folder)))
        .collect();
    known.sort_by(|(one, _), (other, _)| one.cmp(other));
    for (id, text) in BUILT_IN {
        if !known.iter().any(|(name, _)| name == id) {
            known.push(((*id).to_owned(), Rule::parse(id, text)));
        }
    }
    known
}

/// The names of a folder's files that end in `.toml`, without that ending.
fn names_in(folder: &Path) -> Vec<String> {
    // a folder that cannot be read has no rules
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let names = entries.filter_map(|entry| entry.file_name().to_str()?.strip_suffix(".toml").map(str::to_owned));
    names.filter(|name| !name.is_empty()).take(MOST_FILES).collect()
}

/// Whether a file says that it is a rule. Site files, which lie in the same folders, do not.
fn says_rule(path: &Path) -> bool {
    text_of(path).is_ok_and(|text| text.lines().any(|line| line.trim().starts_with("[rule]")))
}

fn text_of(path: &Path) -> Result<String, RuleError> {
    let wrong = |what: String| RuleError::File { path: path.display().to_string(), what };
    let about = fs::metadata(path).map_err(|error| wrong(format!("cannot be read: {error}")))?;
    if !about.is_file() || about.len() > MOST_BYTES {
        return Err(wrong("is not a rule, which is a text file of at most 64 KiB".to_owned()));
    }
    let bytes = fs::read(path).map_err(|error| wrong(format!("cannot be read: {error}")))?;
    String::from_utf8(bytes).map_err(|_| wrong("is not UTF-8; save it as UTF-8".to_owned()))
}
