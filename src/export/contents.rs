//! What `gnomon check` says about model files besides the mesh: format, components and groups, and what was left out.

use crate::formats::LeftOut;
use crate::message::{Field, Words, message};
use crate::site::{ModelContents, NameGroup};
use serde::Serialize;
use serde_json::{Map, Value, json};
use std::fmt::Write;

/// The most groups and kinds of left-out things that a table lists, unless all are requested.
const MOST: usize = 12;

/// How many groups and kinds of left-out things a table lists.
#[derive(Clone, Copy)]
pub(super) enum MostLines {
    /// A few, with a hint at the field that has all.
    OrSee(Field),
    /// Every one, for a request of full lists.
    All,
}

impl MostLines {
    fn count(self) -> usize {
        match self {
            MostLines::OrSee(_) => MOST,
            MostLines::All => usize::MAX,
        }
    }

    /// The line that says how many more there are.
    fn more(self, count: usize, words: &dyn Words) -> String {
        match (self, count.checked_sub(self.count())) {
            (MostLines::OrSee(field), Some(more @ 1..)) => {
                message![format!(" … and {more} more"); field, " lists all"].in_words(words)
            }
            _ => String::new(),
        }
    }
}

/// The content of a file.
#[derive(Serialize)]
pub(super) struct ContentsReport<'a> {
    file: &'a str,
    format: &'a str,
    kinds: Map<String, Value>,
    groups: Vec<GroupLine<'a>>,
    left_out: Vec<LeftOutLine<'a>>,
}

#[derive(Serialize)]
struct GroupLine<'a> {
    name: &'a str,
    components: usize,
}

#[derive(Serialize)]
struct LeftOutLine<'a> {
    what: &'a str,
    count: u64,
    why: &'a str,
}

impl<'a> ContentsReport<'a> {
    pub(super) fn of(model: &'a ModelContents) -> ContentsReport<'a> {
        let group = |group: &'a NameGroup| GroupLine { name: &group.name, components: group.components };
        let left = |left: &'a LeftOut| LeftOutLine { what: &left.what, count: left.count, why: &left.why };
        ContentsReport {
            file: &model.file,
            format: model.format,
            kinds: model.kinds.iter().map(|(kind, count)| (kind.word().to_owned(), json!(count))).collect(),
            groups: model.groups.iter().map(group).collect(),
            left_out: model.left_out.iter().map(left).collect(),
        }
    }
}

/// Lines about each model; they end with a line break.
pub(super) fn table(models: &[ModelContents], most: MostLines, words: &dyn Words) -> String {
    let mut table = String::new();
    // Writing to a String cannot fail.
    for model in models {
        let _ = writeln!(table, "{}: {}", plain(&model.file), model.format);
        if model.kinds.iter().any(|(kind, _)| *kind != Default::default()) {
            let kinds: Vec<String> =
                model.kinds.iter().map(|(kind, count)| format!("{count} {}", kind.word())).collect();
            let _ = writeln!(table, "  kinds: {}", kinds.join(", "));
        }
        if !model.groups.is_empty() {
            let shown = model.groups.iter().take(most.count());
            let shown: Vec<String> =
                shown.map(|group| format!("\"{}\" ({})", plain(&group.name), group.components)).collect();
            let _ = writeln!(table, "  groups: {}{}", shown.join(", "), most.more(model.groups.len(), words));
        }
        for left in model.left_out.iter().take(most.count()) {
            let _ = writeln!(table, "  left out: {}: {}", plain(&left.counted()), plain(&left.why));
        }
        let others = most.more(model.left_out.len(), words);
        if !others.is_empty() {
            let _ = writeln!(table, "  left out:{others}");
        }
    }
    table
}

/// A name without characters that would break the line.
fn plain(name: &str) -> String {
    name.replace(char::is_control, " ")
}
