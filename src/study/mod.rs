//! The flow: a checked request goes in, and its shadow profile comes out.
//!
//! [`run`] and [`in_tiles`] show the flow of the whole program. [`TiledStudy`] is for a program that distributes the
//! parts of a study.

// The deliverables also call: `instant` for one instant's shadows, `frames` for every instant as a picture, `patches`
// for façades and roofs, `compare` for two states of a site. `verify` compares every technique with ray casting,
// `probe` finds when single points lie in the sun, and `live` draws one picture after another for the window.

#[doc(hidden)]
pub mod again;
mod chooser;
mod compare;
mod daylight;
#[doc(hidden)]
pub mod envelope;
mod error;
mod event;
mod fingerprint;
mod frames;
mod gaps;
mod ground_heights;
mod instant;
#[doc(hidden)]
pub mod judge;
#[doc(hidden)]
pub mod live;
mod machine;
mod openness;
mod outcome;
mod patch_sum;
mod patches;
#[doc(hidden)]
pub mod plot_cells;
#[doc(hidden)]
pub mod probe;
mod profile;
mod search_memory;
mod settle;
mod site_view;
#[doc(hidden)]
pub mod sky;
mod stopwatch;
mod subject;
mod tile_sum;
mod tiled_study;
mod tiles;
#[doc(hidden)]
pub mod verify;
#[doc(hidden)]
pub mod verify_surfaces;
mod wants;

pub(crate) use chooser::not_patches;
#[doc(hidden)]
pub use compare::CompareOutcome;
#[cfg(feature = "test-hooks")]
#[doc(hidden)]
pub use compare::compare;
pub(crate) use daylight::day_and_night;
pub use error::StudyError;
pub use event::{Event, OnEvent};
pub(crate) use event::{gather, note_models, note_site, tell};
#[cfg(feature = "desktop")]
pub(crate) use ground_heights::GroundHeights;

#[doc(hidden)]
pub use frames::{Frame, FrameView, frames};
#[doc(hidden)]
pub use instant::instant;

#[doc(hidden)]
pub use outcome::InstantOutcome;
pub use outcome::Outcome;
#[doc(hidden)]
pub use patches::PatchOutcome;
#[cfg(feature = "test-hooks")]
#[doc(hidden)]
pub use patches::patches;
pub(crate) use patches::patches_kept;
pub(crate) use patches::seen_receivers;
pub use profile::{TiledOutcome, in_tiles, paste, run};
#[doc(hidden)]
pub use settle::settle;
#[doc(hidden)]
pub use stopwatch::Stopwatch;
#[doc(hidden)]
pub use subject::judged;
pub use tiled_study::TiledStudy;
pub use wants::{Budget, Wants};
#[doc(hidden)]
pub use wants::{CountingPurpose, InstantWants};

use site_view::{SiteView, night};
use subject::{subject, subject_of};
use wants::NOTHING_COUNTED;
