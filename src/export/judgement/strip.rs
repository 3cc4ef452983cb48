//! The day of a receiver as bars along its hours: when the sun counts, when it could shine, and when it does.

use super::numbers::{blocker, date_of, time};
use crate::judgement::{Judgement, LitSpell, ReceiverRuling, ReceiverSpells};
use crate::rules::Spell;
use crate::site::{JudgedSite, JudgedState};
use crate::sun::Zone;
use chrono::{DateTime, NaiveDate};

/// A day of a receiver.
#[derive(Clone, Debug)]
pub struct DayStrip {
    /// The local date.
    pub date: NaiveDate,
    /// From the first to the last moment of its bars.
    pub ends: [DateTime<Zone>; 2],
    /// The bars, from the rule's window to what is counted.
    pub bars: Vec<StripBar>,
}

/// What a bar shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BarKind {
    /// The rule's window.
    Window,
    /// A sun that counts would shine there with nothing in its way.
    Open,
    /// Sun in the state before.
    Before,
    /// Sun in the state that is judged.
    Now,
    /// New shadow on any part of an area.
    NewShadow,
}

impl BarKind {
    /// The bar's name.
    pub fn label(self) -> &'static str {
        match self {
            BarKind::Window => "counted",
            BarKind::Open => "free horizon",
            BarKind::Before => "sun before",
            BarKind::Now => "sun",
            BarKind::NewShadow => "new shadow",
        }
    }
}

/// A bar.
#[derive(Clone, Debug)]
pub struct StripBar {
    /// What it shows.
    pub kind: BarKind,
    /// Its stretches of time.
    pub spells: Vec<StripSpell>,
}

/// A stretch of time on a bar.
#[derive(Clone, Debug)]
pub struct StripSpell {
    /// Its first second, on the place's clock.
    pub start: DateTime<Zone>,
    /// The first second after it.
    pub end: DateTime<Zone>,
    /// What blocks the sun before it and after it, for sun.
    pub bounds: Option<[String; 2]>,
}

/// The days of a receiver whose spells are reported, the deciding one first.
pub fn day_strips(judgement: &Judgement, site: &JudgedSite, receiver: &ReceiverRuling) -> Vec<DayStrip> {
    let deciding = date_of(judgement, receiver);
    let mut strips: Vec<DayStrip> =
        receiver.spells.iter().filter_map(|spells| day_strip(judgement, site, spells)).collect();
    // the others stay in the order of the rule's days
    strips.sort_by_key(|strip| Some(strip.date) != deciding);
    strips
}

/// `None` for a day on which nothing counts.
fn day_strip(judgement: &Judgement, site: &JudgedSite, spells: &ReceiverSpells) -> Option<DayStrip> {
    let day = judgement.days.get(spells.day)?;
    let plain = |of: &[Spell]| of.iter().map(|spell| placed(site, *spell, None)).collect();
    let lit = |of: &[LitSpell], state: &JudgedState| {
        let bounds = |lit: &LitSpell| [lit.before, lit.after].map(|bound| blocker(state, bound));
        of.iter().map(|lit| placed(site, lit.spell, Some(bounds(lit)))).collect()
    };
    let mut bars = vec![
        StripBar { kind: BarKind::Window, spells: plain(&day.windows) },
        StripBar { kind: BarKind::Open, spells: plain(&spells.open) },
    ];
    if let Some((before, state)) = spells.before.as_ref().zip(site.before.as_ref()) {
        bars.push(StripBar { kind: BarKind::Before, spells: lit(before, state) });
    }
    bars.push(StripBar { kind: BarKind::Now, spells: lit(&spells.now, &site.now) });
    if let Some(newly_shaded) = &spells.newly_shaded {
        bars.push(StripBar { kind: BarKind::NewShadow, spells: plain(newly_shaded) });
    }
    let all = || bars.iter().flat_map(|bar| &bar.spells);
    let ends = [all().map(|spell| spell.start).min()?, all().map(|spell| spell.end).max()?];
    Some(DayStrip { date: day.date, ends, bars })
}

fn placed(site: &JudgedSite, spell: Spell, bounds: Option<[String; 2]>) -> StripSpell {
    StripSpell { start: time(&site.place, spell.start), end: time(&site.place, spell.end), bounds }
}
