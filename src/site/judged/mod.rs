//! What a rule judges of a site, and the states that are compared: the tables `[[area]]`, `[[window]]`, `[[facade]]`,
//! `[plot]` and `[before]` of the site file → [`JudgedSite`].
//!
//! Each table has a file, which uses `rings`, `outline_file`, `glass` and `rooms`.

mod areas;
mod asked_table;
mod before;
mod days;
mod facades;
mod glass;
mod glazing;
mod load;
mod outline_file;
mod plot;
mod request;
mod rings;
mod rooms;
mod window_names;
mod windows;

pub use days::study_days;
#[cfg(feature = "desktop")]
pub(crate) use load::judged_with_models;
pub use load::load_judged;
pub use request::{AreaSurface, JudgedArea, JudgedFacade, JudgedPlot, JudgedSite, JudgedState, JudgedWindow, PlotSide};
#[cfg(feature = "desktop")]
pub(crate) use rings::border_fault;
