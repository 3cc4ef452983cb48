//! Exported files: their content, and that they are written completely or not at all.

mod camera;
mod contour;
mod figure;
mod raster;
mod report;
mod runs;
mod synthetic;
