//! The flow: a checked request in, its shadow profile out.
//!
//! [`run`] and [`in_tiles`] read as the whole program does; [`instant`] is the same for one instant, seen from above or by a camera;
//! [`surfaces()`] is the study on facades and roofs; [`compare()`] is the study of two states of a site; [`verify`] holds
//! every technique against ray casting; [`probe`] finds when single points lie in the sun; [`frames()`] is every instant
//! as a picture; [`live`] draws one picture after another for whoever looks.

pub mod again;
mod compare;
mod daylight;
mod error;
mod event;
mod fingerprint;
mod frames;
mod instant;
pub mod live;
mod machine;
mod outcome;
pub mod probe;
mod profile;
mod site_view;
mod stopwatch;
mod surfaces;
mod tiles;
pub mod verify;
mod wants;

pub use compare::{CompareOutcome, compare, compare_with};
pub use daylight::day_and_night;
pub use error::StudyError;
pub use event::{Event, OnEvent, note_models, tell};
pub use frames::{Frame, frames};
pub use instant::instant;
pub use outcome::{InstantOutcome, Outcome};
pub use profile::{TiledOutcome, TiledStudy, in_tiles, paste, run};
pub use site_view::judged;
pub use stopwatch::Stopwatch;
pub use surfaces::{SurfaceOutcome, seen_receivers, surfaces};
pub use tiles::Budget;
pub use wants::{CountingPurpose, InstantWants, Wants};

use machine::not_surfaces;
use site_view::{SiteView, night, subject};
use wants::NOTHING_COUNTED;
