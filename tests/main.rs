//! All tests in one binary, so that it is linked only once.

mod api;
mod architecture;
mod changes;
mod choice;
mod circles;
mod clock;
mod command;
mod counts;
mod crs;
mod daylight;
mod deliver;
#[cfg(feature = "desktop")]
mod desktop;
mod documents;
mod doors;
mod elevation;
mod envelope;
mod exact;
mod export;
mod far;
mod flush;
mod folders;
mod formats;
mod geometry;
mod georeference;
mod gpu_silhouettes;
mod judge;
mod judged;
mod live;
mod look;
mod lost;
mod message;
mod mistakes;
mod model;
mod names;
mod overdraw;
mod overlay;
mod patches;
mod probe;
mod references;
mod rules;
mod shaders;
mod shared;
mod site;
mod sites;
mod soft_texture;
mod sums;
mod sun;
mod techniques;
mod terrain;
mod tiles;
mod timers;
#[path = "../tools/try-models/main.rs"]
mod try_models;
mod typed;
mod verify;
mod volumes;
mod year;

/// So that tests can say how much memory a reader takes.
#[global_allocator]
static ALLOCATOR: shared::memory::CountingAllocator = shared::memory::CountingAllocator;
