//! Which study it is: a number of all that its result depends on, so that another one does not go on from its sum.

use super::Wants;
use crate::choice::{Filter, Finder, Settings};
use crate::profile::Drawn;
use crate::site::Site;
use crate::view::Tile;
use rustc_hash::FxBuildHasher;
use siphasher::sip::SipHasher13;
use std::hash::{BuildHasher, Hash, Hasher};

/// Of a study that a machine draws in tiles. The same for the same request, and for another one another.
pub(super) fn of(site: &Site, drawn: &Drawn, tiles: &[Tile], wants: &Wants) -> u64 {
    let mut hasher = SipHasher13::new();
    let Site { mesh, casts, receives, ground, track, grid, receivers, settings, hextree_depth, .. } = site;
    env!("CARGO_PKG_VERSION").hash(&mut hasher);
    let numbers = |numbers: &[f64]| numbers.iter().map(|number| number.to_bits()).collect::<Vec<u64>>();
    numbers(&mesh.origin.to_array()).hash(&mut hasher);
    bytemuck::cast_slice::<_, u8>(&mesh.vertices).hash(&mut hasher);
    bytemuck::cast_slice::<_, u8>(&mesh.faces).hash(&mut hasher);
    mesh.components.iter().for_each(|component| component.faces.hash(&mut hasher));
    (casts, receives, receivers.word(), hextree_depth).hash(&mut hasher);
    numbers(&[ground.level, grid.west, grid.north, grid.cell]).hash(&mut hasher);
    (grid.width, grid.height).hash(&mut hasher);
    tiles.iter().for_each(|tile| (tile.first, tile.size).hash(&mut hasher));
    for instant in &track.instants {
        (instant.time.timestamp(), instant.weight_secs, instant.night).hash(&mut hasher);
        numbers(&instant.to_sun.to_array()).hash(&mut hasher);
    }
    // what is written while it goes on is not there for instants that were drawn without it
    let masks_in = FxBuildHasher.hash_one(&wants.masks_in);
    (wants.masks, wants.bits, masks_in, wants.statistics, wants.keep_every.is_some()).hash(&mut hasher);
    // what is asked of techniques, and what that came to
    for Settings { map_size, filter, smoothie_width_m, sun_samples } in [settings, &drawn.settings] {
        (map_size, filter.map(Filter::word), smoothie_width_m.map(f64::to_bits), sun_samples).hash(&mut hasher);
    }
    let Drawn { technique, finder, engine, adapter, .. } = drawn;
    (technique.word(), finder.map(Finder::word), engine.word(), adapter).hash(&mut hasher);
    hasher.finish()
}
