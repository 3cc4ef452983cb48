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

impl RingPolygon {
    /// Whether a side of it is longer than half the way around the Earth, in degrees: then it goes the other way.
    pub(super) fn crosses_180(&self) -> bool {
        let mut start = 0;
        self.ends.iter().any(|&end| {
            let ring = self.points.get(start..end).unwrap_or_default();
            start = end;
            let next = ring.iter().cycle().skip(1);
            ring.iter().zip(next).any(|(one, other)| (one.x - other.x).abs() > 180.0)
        })
    }

    /// The same with longitudes of 0 to 360°, where that does not cut it at 0°.
    pub(super) fn eastward(mut self) -> RingPolygon {
        let east = |point: &DVec3| if point.x < 0.0 { point.with_x(point.x + 360.0) } else { *point };
        let of_east =
            RingPolygon { points: self.points.iter().map(east).collect(), ends: std::mem::take(&mut self.ends) };
        if !of_east.crosses_180() {
            return of_east;
        }
        RingPolygon { points: self.points, ends: of_east.ends }
    }
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
