//! How high may be built: over each cell of a plot, the least height of the rays to the suns that must stay.
//!
//! Each place keeps as much sun as it must: those seconds whose rays pass highest over the plot, so that the least
//! height that the place leaves is as great as it can be. Where several places have a choice they then choose together,
//! if that leaves more.

mod alone;
mod kept;
mod search;
mod suns;
mod together;

pub use kept::{DaysNeeded, KeptOf, KeptPlace, KeptSun, KeptThing, SunNeeded};
pub use search::{CountedHeights, EnvelopeOutcome, MOST_RAYS, envelope};
