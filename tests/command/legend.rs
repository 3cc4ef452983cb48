//! The legend of components.

use super::ground::{block, model};
use crate::shared::program::{PLACE, STUDY, done, pixels};
use gnomon::export::figure::component_colours;
use gnomon::site::{Overrides, Site};

/// A row of boxes, the first the largest; returns how much of the sheet has exactly the legend's colour of each.
fn named(count: usize) -> Vec<usize> {
    let names: Vec<String> = (0..count).map(|number| format!("box {number}")).collect();
    let part = |(number, name)| {
        let half = 6.0 - 0.4 * number as f32;
        block(name, [20.0 * number as f32, 0.0], half, [0.0, 2.0 * half])
    };
    let parts: Vec<_> = names.iter().map(String::as_str).enumerate().map(part).collect();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    std::fs::write(path.join("boxes.glb"), model(&parts)).unwrap();
    std::fs::write(path.join("site.toml"), format!("{PLACE}[[model]]\npath = \"boxes.glb\"\n{STUDY}")).unwrap();
    done(path, "shadow site.toml --at 12:00 --view camera --show components --engine cpu --out sheet.png");
    let site = Site::load(&path.join("site.toml"), &Overrides::default()).unwrap();
    let colours = component_colours(&site.mesh, &site.casts);
    colours.iter().map(|colour| pixels(path.join("sheet.png"), |pixel| pixel == *colour)).collect()
}

/// Eight components have distinct colours; a ninth takes no more room than "and 1 more".
#[test]
fn the_ninth_component_is_named() {
    let swatch = 1500;
    let nine = named(9);
    assert!(nine.iter().all(|count| *count > swatch), "{nine:?}");
    let ten = named(10);
    assert!(ten[..8].iter().all(|count| *count > swatch) && ten[8..].iter().all(|count| *count < swatch), "{ten:?}");
}
