//! All tests in one binary, which links once.

mod architecture;
mod command;
mod exact;
mod export;
mod geometry;
mod mistakes;
mod model;
mod shaders;
mod site;
mod sites;
mod sums;
mod sun;
mod try_models;
