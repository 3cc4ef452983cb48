//! Spells: stretches of time, to the second, and what two lists of them have in common.

/// A stretch of time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Spell {
    /// Its first second, since 1970.
    pub start: i64,
    /// The first second after it.
    pub end: i64,
}

impl Spell {
    /// From a second to another.
    pub fn new(start: i64, end: i64) -> Spell {
        Spell { start, end }
    }

    /// How long it is, seconds.
    pub fn secs(self) -> i64 {
        self.end.saturating_sub(self.start)
    }
}

/// How long spells are together, seconds.
pub fn total_secs(spells: &[Spell]) -> i64 {
    spells.iter().map(|spell| spell.secs()).sum()
}

/// The spells in time's order, those that touch as one, without empty ones.
pub fn merged(spells: impl IntoIterator<Item = Spell>) -> Vec<Spell> {
    let mut spells: Vec<Spell> = spells.into_iter().filter(|spell| spell.start < spell.end).collect();
    spells.sort_unstable();
    let mut merged: Vec<Spell> = Vec::with_capacity(spells.len());
    for spell in spells {
        match merged.last_mut() {
            Some(last) if spell.start <= last.end => last.end = last.end.max(spell.end),
            _ => merged.push(spell),
        }
    }
    merged
}

/// When both are.
pub fn common(one: &[Spell], other: &[Spell]) -> Vec<Spell> {
    let (one, other) = (merged(one.iter().copied()), merged(other.iter().copied()));
    let (mut at, mut with) = (0, 0);
    let mut found = Vec::new();
    while let (Some(a), Some(b)) = (one.get(at), other.get(with)) {
        let both = Spell::new(a.start.max(b.start), a.end.min(b.end));
        if both.start < both.end {
            found.push(both);
        }
        if a.end < b.end { at += 1 } else { with += 1 }
    }
    found
}

/// When the first are and the second are not.
pub fn without(one: &[Spell], other: &[Spell]) -> Vec<Spell> {
    let other = merged(other.iter().copied());
    let mut left = Vec::new();
    let mut next = 0;
    for spell in merged(one.iter().copied()) {
        let mut start = spell.start;
        while other.get(next).is_some_and(|gone| gone.end <= start) {
            next += 1;
        }
        for gone in other[next..].iter().take_while(|gone| gone.start < spell.end) {
            if gone.start > start {
                left.push(Spell::new(start, gone.start));
            }
            start = start.max(gone.end);
        }
        if start < spell.end {
            left.push(Spell::new(start, spell.end));
        }
    }
    left
}
