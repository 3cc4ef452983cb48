//! Spells, which are stretches of time to the second, and operations on lists of them.

/// A half-open stretch of time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Spell {
    /// Its first second, in seconds since 1970 (UTC).
    pub start: i64,
    /// The first second after it.
    pub end: i64,
}

impl Spell {
    /// A spell from its first second to the first one after it.
    pub fn new(start: i64, end: i64) -> Spell {
        Spell { start, end }
    }

    /// Its length, seconds.
    pub fn secs(self) -> i64 {
        self.end.saturating_sub(self.start)
    }
}

/// Returns the total length of spells, seconds.
pub fn total_secs(spells: &[Spell]) -> i64 {
    spells.iter().map(|spell| spell.secs()).sum()
}

/// Returns the spells in order of time, joined where they touch or overlap, without empty ones.
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

/// Returns the intersection of two lists.
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

/// Returns `one` minus `other`.
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
