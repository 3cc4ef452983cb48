//! A footprint as in its file, and its names.

use super::tags::FootprintTags;
use crate::formats::left_out::label;
use glam::DVec3;

/// Why things that are not polygons are left out.
pub(super) const NO_AREA: &str = "they are not polygons";

/// A polygon as in its file: its rings follow each other, the outer one first.
#[derive(Clone, Debug, Default)]
pub(super) struct RingPolygon {
    pub points: Vec<DVec3>,
    pub ends: Vec<usize>,
}

/// A feature: a building, a part of one, or something else.
pub(super) struct Footprint {
    pub polygons: Vec<RingPolygon>,
    pub tags: FootprintTags,
    /// Its index in the file, from 1.
    pub number: u64,
}

/// A feature's name, and the other names that select it.
pub(super) fn names_of(tags: &FootprintTags, number: u64, layer: Option<&str>) -> (String, Vec<String>) {
    let kind = tags.kind().unwrap_or("footprint");
    let address = tags.address();
    let numbered = || format!("{kind} {}", tags.id.clone().unwrap_or_else(|| number.to_string()));
    let name = tags.name.clone().or_else(|| address.clone()).unwrap_or_else(numbered);
    let aliases =
        [tags.name.clone(), address, tags.id.clone(), tags.kind().map(str::to_owned), layer.map(str::to_owned)];
    let part = tags.is_part().then(|| "building:part".to_owned());
    let mut aliases: Vec<String> = aliases.into_iter().chain([part]).flatten().map(|name| label(&name)).collect();
    aliases.retain(|alias| !alias.is_empty());
    (label(&name), aliases)
}
