//! City models and footprints. One building is written in each format, and must be read as the same.

mod block;
mod citygml;
mod cityjson;
mod features;
mod files;
mod footprints;
mod implicit;
mod mutations;
mod notes;
mod osm;
mod shapes;
mod tiles;
