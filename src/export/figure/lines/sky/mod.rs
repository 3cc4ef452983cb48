//! The sky of a point: two sun-path charts on a sheet, a stereographic one and below it a cylindrical one, with what
//! stands in front of the sun's ways.

mod chart;
mod context;
mod grid;
mod marks;
mod panel;
mod regions;
mod sheet;
mod tones;
mod ways;

pub use context::{SkyContext, sky_colours, sky_pictures};
pub use sheet::{card_picture, sky_card, sky_sheet};
