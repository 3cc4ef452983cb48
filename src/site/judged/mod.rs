//! What of a site is judged by a rule, and the states that are compared: the tables `[[area]]`, `[[window]]`, `[[facade]]`,
//! `[plot]` and `[before]` of the site file → [`JudgedSite`].

mod request;

pub use request::{AreaSurface, JudgedArea, JudgedFacade, JudgedPlot, JudgedSite, JudgedState, JudgedWindow, PlotSide};
