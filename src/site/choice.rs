//! The words by which people choose a technique, a finder, an engine, a side and receivers.

use super::error::nearest;
use super::model::Up;
use super::{Engine, Finder, Method, Pcf, Receivers};
use crate::view::Side;
use std::fmt;
use std::str::FromStr;

/// A word that is none of the choices, with the way out.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ChoiceError {
    /// Not a word of this choice.
    #[error("\"{word}\" is not one of {known}; the nearest is \"{nearest}\"")]
    Unknown {
        /// As written.
        word: String,
        /// All words.
        known: String,
        /// The nearest of them.
        nearest: &'static str,
    },
    /// A word of the design whose feature is not built.
    #[error("\"{word}\" is not there yet; take one of {known}")]
    NotYet {
        /// As written.
        word: String,
        /// All words.
        known: String,
    },
}

/// Finds a word among the choices, or says which is nearest.
fn find<T: Copy>(word: &str, known: &[(&'static str, T)], later: &[&'static str]) -> Result<T, ChoiceError> {
    if let Some((_, choice)) = known.iter().find(|(name, _)| *name == word) {
        return Ok(*choice);
    }
    let names: Vec<_> = known.iter().map(|(name, _)| *name).collect();
    let list = names.join(", ");
    if later.contains(&word) {
        return Err(ChoiceError::NotYet { word: word.to_owned(), known: list });
    }
    Err(ChoiceError::Unknown { word: word.to_owned(), known: list, nearest: nearest(word, names).unwrap_or("auto") })
}

/// Words ↔ choices, for one enum.
macro_rules! words {
    ($choice:ty, [$($word:literal => $value:expr),+], later [$($later:literal),*]) => {
        impl $choice {
            /// The words that choose, with what they choose.
            pub const WORDS: &'static [(&'static str, $choice)] = &[$(($word, $value)),+];

            /// The word that chooses this.
            pub fn word(self) -> &'static str {
                Self::WORDS.iter().find(|(_, choice)| *choice == self).map_or("auto", |(word, _)| *word)
            }
        }

        impl FromStr for $choice {
            type Err = ChoiceError;

            fn from_str(word: &str) -> Result<Self, ChoiceError> {
                find(word, Self::WORDS, &[$($later),*])
            }
        }

        impl fmt::Display for $choice {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(self.word())
            }
        }
    };
}

words!(Up, ["y" => Up::Y, "z" => Up::Z], later []);
words!(
    Method,
    [
        "auto" => Method::Auto,
        "stencil" => Method::Stencil,
        "projected" => Method::Projected,
        "shadow-map" => Method::ShadowMap,
        "hybrid" => Method::Hybrid,
        "smoothie" => Method::Smoothie,
        "soft-texture" => Method::SoftTexture,
        "ray-cast" => Method::RayCast
    ],
    later []
);
words!(
    Pcf,
    [
        "none" => Pcf::None,
        "2x2" => Pcf::TwoByTwo,
        "fast-2x2" => Pcf::FastTwoByTwo,
        "fast-4x4" => Pcf::FastFourByFour
    ],
    later []
);
words!(
    Finder,
    [
        "auto" => Finder::Auto,
        "brute" => Finder::Brute,
        "hextree" => Finder::Hextree,
        "gpu" => Finder::Gpu
    ],
    later []
);
words!(Engine, ["auto" => Engine::Auto, "gpu" => Engine::Gpu, "cpu" => Engine::Cpu], later []);
words!(
    Side,
    [
        "north" => Side::North,
        "east" => Side::East,
        "south" => Side::South,
        "west" => Side::West
    ],
    later []
);
words!(
    Receivers,
    [
        "top" => Receivers::Top,
        "ground" => Receivers::Ground,
        "surfaces" => Receivers::Surfaces
    ],
    later []
);
