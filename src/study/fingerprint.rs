//! The fingerprint of a study: a hash of everything that its result depends on, so that no study continues from the
//! sums of another one.
//!
//! This file lists what is hashed: named fields as little-endian bytes, with SipHash-1-3 and the keys 0. Equal
//! fields give the same number with all compilers and on all machines. But the engine, the adapter's name, the tiles,
//! the masks' folder, and the bits of the models' corners and of the directions to the sun are among the fields, and
//! may differ from one machine to another.

use super::Wants;
use crate::choice::Receivers;
use crate::choice::{Filter, Finder, Settings};
use crate::profile::Provenance;
use crate::site::{GroundKind, Site};
use crate::view::{Grid, Tile};
use siphasher::sip::SipHasher13;
use std::hash::Hasher;

/// The fields hashed so far.
struct Fields(SipHasher13);

impl Fields {
    /// Adds a field: the length of its name, its name, the number of its bytes, and the bytes.
    fn bytes(&mut self, name: &str, bytes: &[u8]) {
        for part in [name.as_bytes(), bytes] {
            self.0.write(&(part.len() as u64).to_le_bytes());
            self.0.write(part);
        }
    }

    /// Adds a field of numbers, which may be empty.
    fn numbers<const N: usize>(&mut self, name: &str, numbers: impl IntoIterator<Item = [u8; N]>) {
        let numbers: Vec<[u8; N]> = numbers.into_iter().collect();
        self.bytes(name, numbers.as_flattened());
    }

    fn flags(&mut self, name: &str, flags: &[bool]) {
        self.numbers(name, flags.iter().map(|&flag| [u8::from(flag)]));
    }

    /// Adds a field of text, if there is one.
    fn text(&mut self, name: &str, text: Option<&str>) {
        if let Some(text) = text {
            self.bytes(name, text.as_bytes());
        }
    }
}

/// The fingerprint of a study that a machine draws in tiles: equal for equal requests, and different for others.
pub(super) fn of(site: &Site, drawn: &Provenance, tiles: &[Tile], wants: &Wants) -> u64 {
    let mut fields = Fields(SipHasher13::new());
    // another version may draw differently
    fields.text("gnomon", Some(env!("CARGO_PKG_VERSION")));
    add_scene(&mut fields, site);
    add_plan(&mut fields, &site.grid, tiles);
    add_instants(&mut fields, site);
    add_wants(&mut fields, wants);
    // the settings as requested, and as used
    add_settings(&mut fields, "asked", &site.settings);
    add_settings(&mut fields, "drawn", &drawn.settings);
    let Provenance { technique, finder, engine, adapter, settings: _, resolution_secs } = drawn;
    add_resolution(&mut fields, site, *resolution_secs);
    fields.text("technique", Some(technique.word()));
    fields.text("finder", finder.map(Finder::word));
    fields.text("engine", Some(engine.word()));
    fields.text("adapter", adapter.as_deref());
    fields.0.finish()
}

/// The fingerprint of a study on patches with this number of texels of this size in metres.
pub(super) fn of_patches(site: &Site, drawn: &Provenance, choice: &str, (cell, texels): (f64, usize)) -> u64 {
    let mut fields = Fields(SipHasher13::new());
    fields.text("gnomon", Some(env!("CARGO_PKG_VERSION")));
    add_scene(&mut fields, site);
    fields.numbers("patches", [cell.to_le_bytes(), (texels as u64).to_le_bytes()]);
    add_instants(&mut fields, site);
    fields.text("choice", Some(choice));
    add_settings(&mut fields, "drawn", &drawn.settings);
    let Provenance { technique, engine, adapter, resolution_secs, .. } = drawn;
    add_resolution(&mut fields, site, *resolution_secs);
    fields.text("technique", Some(technique.word()));
    fields.text("engine", Some(engine.word()));
    fields.text("adapter", adapter.as_deref());
    fields.0.finish()
}

fn add_scene(fields: &mut Fields, site: &Site) {
    let mesh = &site.mesh;
    fields.numbers("origin", mesh.origin.to_array().map(f64::to_le_bytes));
    fields.numbers("vertices", mesh.vertices.iter().flat_map(|vertex| vertex.to_array()).map(f32::to_le_bytes));
    fields.numbers("faces", mesh.faces.as_flattened().iter().map(|corner| corner.to_le_bytes()));
    let runs = mesh.components.iter().flat_map(|component| [component.faces.start, component.faces.end]);
    fields.numbers("components", runs.map(u32::to_le_bytes));
    fields.flags("casts", &site.casts);
    fields.flags("receives", &site.receives);
    fields.text("receivers", Some(site.receivers.word()));
    fields.numbers("ground", [site.ground.level.to_le_bytes()]);
    if site.ground.kind == GroundKind::Terrain {
        fields.flags("terrain", &site.judges(Receivers::Ground));
    }
    fields.numbers("hextree depth", site.hextree_depth.map(u32::to_le_bytes));
}

fn add_plan(fields: &mut Fields, grid: &Grid, tiles: &[Tile]) {
    let Grid { west, north, cell, width, height } = *grid;
    fields.numbers("west, north, cell", [west, north, cell].map(f64::to_le_bytes));
    fields.numbers("width, height", [width, height].map(u32::to_le_bytes));
    let tiles = tiles.iter().flat_map(|tile| [tile.first, tile.size].concat());
    fields.numbers("tiles", tiles.map(u32::to_le_bytes));
}

fn add_instants(fields: &mut Fields, site: &Site) {
    let instants = &site.track.instants;
    fields.numbers("times", instants.iter().map(|instant| instant.time.timestamp().to_le_bytes()));
    fields.numbers("to sun", instants.iter().flat_map(|instant| instant.to_sun.to_array()).map(f64::to_le_bytes));
    fields.numbers("weights", instants.iter().map(|instant| instant.weight_secs.to_le_bytes()));
    fields.numbers("nights", instants.iter().map(|instant| [u8::from(instant.night)]));
}

/// Adds the search between instants, if there is one.
fn add_resolution(fields: &mut Fields, site: &Site, resolution_secs: u32) {
    if resolution_secs > 0 {
        fields.numbers("resolution", [resolution_secs.to_le_bytes()]);
        fields.numbers("gaps", site.track.instants.iter().map(|instant| instant.gap_secs.to_le_bytes()));
    }
}

/// Adds what is written during the study: files of instants that were drawn without it would be missing.
fn add_wants(fields: &mut Fields, wants: &Wants) {
    // the tiles reflect the budget; lines and surface leave nothing behind
    let Wants { masks, bits, masks_in, lines: _, surface: _, statistics, keep_every, budget: _ } = wants;
    fields.flags("masks, bits, statistics, kept", &[*masks, *bits, *statistics, keep_every.is_some()]);
    if let Some(folder) = masks_in {
        // a Unicode name is UTF-8; for any other the bytes at least distinguish folders
        fields.bytes("masks in", folder.as_os_str().as_encoded_bytes());
    }
}

fn add_settings(fields: &mut Fields, whose: &str, settings: &Settings) {
    let Settings { map_size, filter, smoothie_width_m, sun_samples } = settings;
    fields.text("settings", Some(whose));
    fields.numbers("map size", map_size.map(u32::to_le_bytes));
    fields.text("filter", filter.map(Filter::word));
    fields.numbers("smoothie width", smoothie_width_m.map(f64::to_le_bytes));
    fields.numbers("sun samples", sun_samples.map(u32::to_le_bytes));
}
