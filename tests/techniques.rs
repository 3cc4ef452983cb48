//! The techniques other than the stencil, each against ray casting or a closed form.

mod disc;
mod hybrid;
mod low_suns;
mod plain_scan;
mod projected;
mod shadow_map;
mod smoothie;
mod tiles;

use glam::DVec3;
use gnomon::choice::Receivers;
use gnomon::shadow::{Scene, Technique};
use gnomon::site::{Overrides, Site};
use gnomon::view::{Mask, View};
use std::path::Path;

/// A site's scene under top receivers, its plan, and its suns that stand at 10° or more.
fn site(name: &str, size: u32) -> (Scene, View, Vec<DVec3>) {
    let asked = Overrides { size: Some(size), receivers: Some(Receivers::Top), ..Overrides::default() };
    let site = Site::load(Path::new(&format!("sites/{name}")), &asked).unwrap();
    let scene = Scene {
        casters: site.mesh.of_components(&site.casts),
        receivers: site.mesh.of_components(&site.receives),
        ground: site.ground.level,
    };
    let high = site.track.instants.iter().filter(|instant| instant.altitude_deg() >= 10.0);
    (scene, View::Plan(site.grid), high.map(|instant| instant.to_sun).collect())
}

fn draw(technique: &mut dyn Technique, to_sun: DVec3) -> Mask {
    technique.draw(to_sun).unwrap().read().unwrap()
}
