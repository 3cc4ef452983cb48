//! City models and footprints. One building is written in each format, and must be read the same from all.

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
