//! Spells in the sun with what bounds them.

use crate::rules::Spell;

/// What bounds a spell in the sun.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpellBound {
    /// The rule's window begins or ends.
    Window,
    /// The sun is down.
    Horizon,
    /// The sun is behind the receiver's plane, or in it.
    Behind,
    /// The sun is not counted by the rule: it is too low, or too near the receiver's plane.
    Cut,
    /// The wall around the opening in front of a point inside.
    Reveal,
    /// The ground: the point lies below it.
    Ground,
    /// A component of the state's mesh, by its index.
    Component(u32),
}

/// A spell in the sun.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LitSpell {
    /// The spell, from its first second to the first second after it.
    pub spell: Spell,
    /// What blocks the sun one second before it.
    pub before: SpellBound,
    /// What blocks the sun at its end.
    pub after: SpellBound,
}

/// The greatest difference between two ways to find one moment, seconds; within it, the cause that is nearer is kept.
const SAME_SECS: i64 = 2;

/// The spells, without what bounds them.
pub fn spells_of(lit: &[LitSpell]) -> Vec<Spell> {
    lit.iter().map(|lit| lit.spell).collect()
}

/// The parts of spells that lie within others, in the order of time. `bound` is what ends the sun where these others
/// end.
pub fn clipped(lit: &[LitSpell], within: &[Spell], bound: SpellBound) -> Vec<LitSpell> {
    let within: Vec<LitSpell> =
        within.iter().map(|spell| LitSpell { spell: *spell, before: bound, after: bound }).collect();
    both(lit, &within)
}

/// The spells in which both are lit, bounded by what bounds the later beginning and the earlier end; the first one's
/// where they are equal.
pub fn both(one: &[LitSpell], other: &[LitSpell]) -> Vec<LitSpell> {
    let (mut at, mut with) = (0, 0);
    let mut found = Vec::new();
    while let (Some(a), Some(b)) = (one.get(at), other.get(with)) {
        let spell = Spell::new(a.spell.start.max(b.spell.start), a.spell.end.min(b.spell.end));
        if spell.start < spell.end {
            let before = if spell.start - a.spell.start > SAME_SECS { b.before } else { a.before };
            let after = if a.spell.end - spell.end > SAME_SECS { b.after } else { a.after };
            found.push(LitSpell { spell, before, after });
        }
        if a.spell.end < b.spell.end { at += 1 } else { with += 1 }
    }
    found
}
