//! All tests in one binary, which links once.

mod architecture;
mod clock;
mod command;
mod counts;
mod dense;
#[cfg(feature = "desktop")]
mod desktop;
mod dome;
mod elevation;
mod exact;
mod export;
mod far_wrong;
mod folders;
mod geometry;
mod gpu_silhouettes;
mod live;
mod mistakes;
mod model;
mod overdraw;
mod overlay;
mod patches;
mod probe;
mod shaders;
mod site;
mod sites;
mod soft_texture;
mod sums;
mod sun;
mod techniques;
mod tiles;
mod timers;
mod try_models;
mod typed;
mod verify;
mod volumes;
mod year;
