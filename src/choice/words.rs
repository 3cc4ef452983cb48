//! Converts choices to their words and back.

/// A word that is not one of the choices, with a hint.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("\"{word}\" is not one of {known}; the nearest is \"{nearest}\"")]
pub struct ChoiceError {
    /// The word as written.
    pub word: String,
    /// All known words.
    pub known: String,
    /// The nearest known word.
    pub nearest: &'static str,
}

/// Finds a word among the choices; the error names the nearest.
pub(crate) fn find<T: Copy>(word: &str, choices: &[(&'static str, T)]) -> Result<T, ChoiceError> {
    if let Some((_, choice)) = choices.iter().find(|(name, _)| *name == word) {
        return Ok(*choice);
    }
    let known: Vec<_> = choices.iter().map(|(name, _)| *name).collect();
    let nearest = nearest(word, known.iter().copied()).unwrap_or_default();
    Err(ChoiceError { word: word.to_owned(), known: known.join(", "), nearest })
}

/// The candidate most like a word.
pub(crate) fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let lower = word.to_lowercase();
    let likeness = |candidate: &str| strsim::jaro_winkler(&candidate.to_lowercase(), &lower);
    let mut best = None;
    for candidate in candidates {
        let score = likeness(candidate);
        // the first of equals is kept
        if best.is_none_or(|(most, _)| score > most) {
            best = Some((score, candidate));
        }
    }
    best.map(|(_, candidate)| candidate)
}

/// `a`, `a and b`, `a, b and c`, with any word instead of `and`.
pub fn listed(words: &[&str], and: &str) -> String {
    match words {
        [] => String::new(),
        [word] => (*word).to_owned(),
        [rest @ .., last] => format!("{} {and} {last}", rest.join(", ")),
    }
}

/// Implements conversions between words and choices for an enum.
macro_rules! words {
    ($choice:ty, [$($word:literal => $value:path),+ $(,)?]) => {
        impl $choice {
            /// The words with their choices.
            pub const WORDS: &'static [(&'static str, $choice)] = &[$(($word, $value)),+];

            /// The word of the choice.
            pub fn word(self) -> &'static str {
                match self {
                    $($value => $word),+
                }
            }
        }

        $crate::choice::read!($choice);
    };
}

/// Implements parsing and printing of an enum by its `WORDS`.
macro_rules! read {
    ($choice:ty) => {
        impl std::str::FromStr for $choice {
            type Err = $crate::choice::ChoiceError;

            fn from_str(word: &str) -> Result<Self, Self::Err> {
                $crate::choice::find(word, Self::WORDS)
            }
        }

        impl std::fmt::Display for $choice {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str(self.word())
            }
        }
    };
}

pub(crate) use {read, words};
