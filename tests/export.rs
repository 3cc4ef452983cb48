//! Files that go out: what is in them, and that they come whole or not at all.

mod camera;
mod contour;
mod figure;
mod raster;
mod report;
mod runs;
mod synthetic;
