//! Counts what a reader leaves out, and cleans names.

use super::{LeftOut, composed};
use crate::message::few;
use std::collections::BTreeMap;

/// The longest name of a part or of a kind, bytes.
const MOST_NAME_BYTES: usize = 1000;

/// The most kinds that are counted separately: a file may give each of its objects a different kind.
const MOST_KINDS: usize = 200;

/// What was left out so far.
#[derive(Default)]
pub(super) struct LeftOutTally {
    counts: BTreeMap<(String, &'static str), u64>,
}

impl LeftOutTally {
    /// Counts one thing of a kind; `why` is a clause.
    pub(super) fn add(&mut self, what: &str, why: &'static str) {
        self.add_many(what, why, 1);
    }

    /// Counts several things of a kind.
    pub(super) fn add_many(&mut self, what: &str, why: &'static str, count: u64) {
        if count == 0 {
            return;
        }
        let mut key = (label(what), why);
        if self.counts.len() >= MOST_KINDS && !self.counts.contains_key(&key) {
            key.0 = "other things".into();
        }
        let total = self.counts.entry(key).or_default();
        *total = total.saturating_add(count);
    }

    /// Everything that was left out, the most frequent first.
    pub(super) fn into_left_out(self) -> Vec<LeftOut> {
        let left_out = |((what, why), count): ((String, &str), u64)| LeftOut { what, count, why: why.into() };
        let mut all: Vec<LeftOut> = self.counts.into_iter().map(left_out).collect();
        all.sort_by_key(|one| std::cmp::Reverse(one.count));
        all
    }
}

/// Gnomon's own plurals with their singulars; a file's own terms are not changed.
const ONE_OF_MANY: [(&str, &str); 23] = [
    ("contents", "content"),
    ("entities", "entity"),
    ("faces", "face"),
    ("features", "feature"),
    ("footprints", "footprint"),
    ("geometries", "geometry"),
    ("hidden faces", "hidden face"),
    ("implicit tilings", "implicit tiling"),
    ("instances", "instance"),
    ("line sets", "line set"),
    ("lines", "line"),
    ("lists", "list"),
    ("nodes", "node"),
    ("outlines", "outline"),
    ("patches", "patch"),
    ("points", "point"),
    ("polygons", "polygon"),
    ("rings", "ring"),
    ("shapes", "shape"),
    ("surfaces", "surface"),
    ("tiles", "tile"),
    ("tilesets", "tileset"),
    ("triangles", "triangle"),
];

impl LeftOut {
    /// The number and the thing: `12 IfcSpace`, `1 face`.
    pub fn counted(&self) -> String {
        let what = &self.what;
        let rest = |many: &str| what.strip_prefix(many).filter(|rest| rest.is_empty() || rest.starts_with(' '));
        let one = ONE_OF_MANY.iter().find_map(|(many, one)| Some(format!("1 {one}{}", rest(many)?)));
        one.filter(|_| self.count == 1).unwrap_or_else(|| format!("{} {what}", self.count))
    }
}

/// Everything that was left out on one line, for an error.
pub(super) fn listed(left_out: &[LeftOut]) -> String {
    few(left_out.iter().map(|one| format!("{}: {}", one.counted(), one.why)).collect())
}

/// A number of things: `1 footprint`, `2 footprints`.
pub(super) fn counted(count: u64, thing: &str) -> String {
    format!("{count} {thing}{}", if count == 1 { "" } else { "s" })
}

/// A part's name: composed, without control characters, and shortened with dots if it is too long.
pub(super) fn label(name: &str) -> String {
    let name = composed(name.trim());
    let mut label: String = name.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    if label.len() > MOST_NAME_BYTES {
        let mut end = MOST_NAME_BYTES - '…'.len_utf8();
        while !label.is_char_boundary(end) {
            end -= 1;
        }
        label.truncate(end);
        label.push('…');
    }
    label
}
