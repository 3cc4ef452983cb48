//! All tests in one binary, which links once.

mod architecture;
mod command;
mod dome;
mod exact;
mod export;
mod geometry;
mod gpu_silhouettes;
mod mistakes;
mod model;
mod overlay;
mod probe;
mod shaders;
mod site;
mod sites;
mod sums;
mod sun;
mod techniques;
mod try_models;
mod verify;
mod volumes;
