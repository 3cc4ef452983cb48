//! The answer: a verdict for each receiver, each group and the whole, with everything that it rests on.

use super::lit_spell::LitSpell;
use crate::choice::words;
use crate::message::Message;
use crate::rules::{DwellingRuling, ResolvedRule, RuleDay, RuleSource, Ruling, Spell, Verdict};
use glam::DVec3;

/// What a rule says of a site.
#[derive(Clone, Debug)]
pub struct Judgement {
    /// The rule's source.
    pub source: RuleSource,
    /// The rule with all of its options chosen.
    pub rule: ResolvedRule,
    /// The rule's days, one set after the other.
    pub days: Vec<RuleDay>,
    /// For each day, the verdict over all receivers.
    pub day_verdicts: Vec<Verdict>,
    /// The verdict over everything.
    pub verdict: Verdict,
    /// The lowest grade that is reached, if the rule has grades.
    pub grade: Option<String>,
    /// The receivers, in the site's order.
    pub receivers: Vec<ReceiverRuling>,
    /// Rooms, dwellings and the house, if the rule judges them.
    pub groups: Vec<GroupRuling>,
    /// Notes on how the site was judged.
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
    /// A band of the plane around a plot, between two distances.
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
    /// The size, if it is an area.
    pub area: Option<AreaSize>,
    /// The points where it is judged: all points of a window, the deciding one of anything else.
    pub points: Vec<DVec3>,
    /// Its outward normal there, if it has one.
    pub normal: Option<DVec3>,
    /// Its room, if the site has it.
    pub room: Option<String>,
    /// Its dwelling, if the site has it.
    pub dwelling: Option<String>,
    /// The use of its room, if the site has it.
    pub usage: Option<String>,
    /// For each of the rule's days, what is counted at its points.
    pub counts: Vec<DayCount>,
    /// The spells at its points on the days that are reported.
    pub spells: Vec<ReceiverSpells>,
    /// Who takes the sun on the deciding day, the greatest taker first; empty if that was not searched.
    pub takers: Vec<Taker>,
}

/// The probability that a part of an area is farther off than its stated error.
pub const ERROR_ODDS: f64 = 1e-9;

/// The size of an area, and how it was measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AreaSize {
    /// Square metres.
    pub m2: f64,
    /// The square metres of what is too narrow to count, in plan. They are not in `m2`.
    pub narrow_m2: f64,
    /// The number of points at which light was searched.
    pub points: usize,
    /// The error of the part that keeps the rule, up or down, square metres. It is exceeded with a probability of
    /// [`ERROR_ODDS`] at most.
    pub error_m2: f64,
    /// Where area times time is counted, the error of its sum, up or down, square metres × seconds, as the last
    /// splits of triangles changed it.
    pub error_m2_secs: Option<f64>,
    /// Where new shadow on any part is looked for, the greatest distance between points, metres: narrower shadow may
    /// lie between them.
    pub apart_m: Option<f64>,
}

/// What the rule counts at a receiver's points on a day.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DayCount {
    /// Seconds in the state that is judged.
    pub now_secs: i64,
    /// Seconds in the state before, if there is one.
    pub before_secs: Option<i64>,
}

/// The spells of one day.
#[derive(Clone, Debug)]
pub struct ReceiverSpells {
    /// The index of the day among the rule's days.
    pub day: usize,
    /// When a sun that counts would shine with nothing in its way.
    pub open: Vec<Spell>,
    /// The spells in the sun, in the state that is judged.
    pub now: Vec<LitSpell>,
    /// The spells in the sun in the state before, if there is one.
    pub before: Option<Vec<LitSpell>>,
    /// The spells in which any part of an area lies in new shadow, if the rule counts it.
    pub newly_shaded: Option<Vec<Spell>>,
}

/// A component that takes the sun from a receiver.
#[derive(Clone, Debug, PartialEq)]
pub struct Taker {
    /// Its index in the mesh of the state that is judged.
    pub component: u32,
    /// The seconds that it takes alone: without it there would be sun.
    pub alone_secs: f64,
    /// The seconds in which both it and others stand in front of the sun.
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
    /// The room's dwelling.
    pub dwelling: Option<String>,
    /// Its verdict.
    pub verdict: Verdict,
    /// The ruling by its spells or by its dwellings, if it is judged so.
    pub ruling: Option<Ruling>,
    /// The ruling by its rooms, if it is judged so.
    pub by_rooms: Option<DwellingRuling>,
    /// The names of its members: receivers or groups.
    pub of: Vec<String>,
    /// For a dwelling with uses: each use, and the seconds that are counted for it on the first day.
    pub uses: Vec<(String, i64)>,
}
