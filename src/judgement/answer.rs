//! The answer: a verdict for each receiver, each group and the whole, with all that it rests on.

use super::lit_spell::LitSpell;
use crate::choice::words;
use crate::message::Message;
use crate::rules::{DwellingRuling, ResolvedRule, RuleDay, RuleSource, Ruling, Spell, Verdict};
use glam::DVec3;

/// What a rule says of a site.
#[derive(Clone, Debug)]
pub struct Judgement {
    /// Where the rule is from.
    pub source: RuleSource,
    /// The rule with everything chosen.
    pub rule: ResolvedRule,
    /// Its days, set after set.
    pub days: Vec<RuleDay>,
    /// For each of them the verdict of all receivers together.
    pub day_verdicts: Vec<Verdict>,
    /// The whole.
    pub verdict: Verdict,
    /// The lowest grade that all reach, where the rule has grades.
    pub grade: Option<String>,
    /// What is judged, in the site's order.
    pub receivers: Vec<ReceiverRuling>,
    /// Rooms, dwellings and the house, where the rule speaks of them.
    pub groups: Vec<GroupRuling>,
    /// What the user should know of how it was judged.
    pub notes: Vec<Message>,
}

/// The kind of a receiver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JudgedThing {
    /// An area.
    Area,
    /// A window.
    Window,
    /// A façade.
    Facade,
    /// The plane around a plot, from one distance to another.
    Band,
}

words!(JudgedThing, [
    "area" => JudgedThing::Area,
    "window" => JudgedThing::Window,
    "facade" => JudgedThing::Facade,
    "band" => JudgedThing::Band,
]);

/// One receiver.
#[derive(Clone, Debug)]
pub struct ReceiverRuling {
    /// Its name.
    pub name: String,
    /// What it is.
    pub kind: JudgedThing,
    /// The verdict with its findings.
    pub ruling: Ruling,
    /// Of an area.
    pub area: Option<AreaSize>,
    /// Where it is judged: of a window its points; of others the spot that decides.
    pub points: Vec<DVec3>,
    /// Its outward normal at that spot, where it has one.
    pub normal: Option<DVec3>,
    /// Its room, where the site says one.
    pub room: Option<String>,
    /// Its dwelling, where the site says one.
    pub dwelling: Option<String>,
    /// What its room is used for, where the site says it.
    pub usage: Option<String>,
    /// For each of the rule's days what is counted at its points.
    pub counts: Vec<DayCount>,
    /// The spells at its points on the days that are told.
    pub spells: Vec<ReceiverSpells>,
    /// Who takes the sun on the deciding day, the greatest taker first; empty where nobody asked.
    pub takers: Vec<Taker>,
}

/// The size of an area, and how it was measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AreaSize {
    /// Square metres.
    pub m2: f64,
    /// At how many points light was searched.
    pub points: usize,
    /// To so much, up and down, the part that keeps the rule is known, square metres.
    pub error_m2: f64,
}

/// What is counted at a receiver's points on a day, by the rule's own way of counting.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DayCount {
    /// Seconds in the state that is judged.
    pub now_secs: i64,
    /// Seconds in the state before, where there is one.
    pub before_secs: Option<i64>,
}

/// The spells of one day.
#[derive(Clone, Debug)]
pub struct ReceiverSpells {
    /// Which of the rule's days.
    pub day: usize,
    /// When a sun that counts would shine if nothing stood there.
    pub open: Vec<Spell>,
    /// In the sun, in the state that is judged.
    pub now: Vec<LitSpell>,
    /// In the sun in the state before, where there is one.
    pub before: Option<Vec<LitSpell>>,
    /// In shadow that was sun before, anywhere on an area; where the rule counts it.
    pub newly_shaded: Option<Vec<Spell>>,
}

/// A component that takes the sun from a receiver.
#[derive(Clone, Debug, PartialEq)]
pub struct Taker {
    /// By its index in the mesh of the state that is judged.
    pub component: u32,
    /// Seconds that it takes alone: without it there would be sun.
    pub alone_secs: f64,
    /// Seconds in which it and others stand before the sun.
    pub with_others_secs: f64,
}

/// The kind of a group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GroupKind {
    /// A room, by its windows.
    Room,
    /// A dwelling, by its rooms.
    Dwelling,
    /// All dwellings.
    House,
}

words!(GroupKind, [
    "room" => GroupKind::Room,
    "dwelling" => GroupKind::Dwelling,
    "house" => GroupKind::House,
]);

/// A room, a dwelling, or the house.
#[derive(Clone, Debug)]
pub struct GroupRuling {
    /// Its name; empty for the house.
    pub name: String,
    /// What it is.
    pub kind: GroupKind,
    /// The dwelling of a room.
    pub dwelling: Option<String>,
    /// Its verdict.
    pub verdict: Verdict,
    /// By its spells or by its dwellings, where it is judged so.
    pub ruling: Option<Ruling>,
    /// By its rooms, where it is judged so.
    pub by_rooms: Option<DwellingRuling>,
    /// The names of the receivers, or of the groups, of which it is.
    pub of: Vec<String>,
    /// Of a dwelling with uses: each use, and what is counted for it on the first day, seconds.
    pub uses: Vec<(String, i64)>,
}
