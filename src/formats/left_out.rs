//! Counts what a reader leaves out while it reads, and makes names usable.

use super::{LeftOut, composed};
use crate::message::few;
use std::collections::BTreeMap;

/// The longest name of a part or of a kind, bytes.
const MOST_NAME_BYTES: usize = 1000;

/// The most kinds that are told apart: a file may call each of its objects another kind.
const MOST_KINDS: usize = 200;

/// What was left out so far.
#[derive(Default)]
pub(super) struct LeftOutTally {
    counts: BTreeMap<(String, &'static str), u64>,
}

impl LeftOutTally {
    /// One more of a kind, and why, as a clause.
    pub(super) fn add(&mut self, what: &str, why: &'static str) {
        self.add_many(what, why, 1);
    }

    /// More of a kind.
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

    /// All of it, the commonest first.
    pub(super) fn into_left_out(self) -> Vec<LeftOut> {
        let left_out = |((what, why), count): ((String, &str), u64)| LeftOut { what, count, why: why.into() };
        let mut all: Vec<LeftOut> = self.counts.into_iter().map(left_out).collect();
        all.sort_by_key(|one| std::cmp::Reverse(one.count));
        all
    }
}

/// Words of Gnomon's own for many things, and for one; a file's own terms are as the file has them.
const ONE_OF_MANY: [(&str, &str); 22] = [
    ("contents", "content"),
    ("entities", "entity"),
    ("faces", "face"),
    ("features", "feature"),
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

/// All that was left out on one line, as an error has it.
pub(super) fn listed(left_out: &[LeftOut]) -> String {
    few(left_out.iter().map(|one| format!("{}: {}", one.counted(), one.why)).collect())
}

/// How many there are of a thing: `1 footprint`, `2 footprints`.
pub(super) fn counted(count: u64, thing: &str) -> String {
    format!("{count} {thing}{}", if count == 1 { "" } else { "s" })
}

/// A name as parts have it: composed, without what no name has, and cut where it is too long, which the dots show.
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
