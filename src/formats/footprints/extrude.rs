//! Extrudes outlines to blocks.

use super::tags::{FootprintTags, Rise};
use super::{Footprint, RingPolygon, names_of};
use crate::formats::face_cutter::{FaceCutter, Uncut, ring_area};
use crate::formats::left_out::LeftOutTally;
use crate::mesh::Part;
use glam::{DVec2, DVec3};

/// A building or a part of one, cut into triangles.
pub(super) struct FootprintOutline {
    /// Its attributes.
    pub tags: FootprintTags,
    number: u64,
    rise: Rise,
    /// Its polygons with an area. Outer rings are counter-clockwise, holes clockwise.
    pub polygons: Vec<FlatPolygon>,
    /// Whether one of the polygons crosses itself.
    pub crosses: bool,
}

/// A polygon of an outline.
pub(super) struct FlatPolygon {
    /// The corners of all rings.
    pub corners: Vec<DVec2>,
    /// The end of each ring.
    pub ends: Vec<usize>,
    /// Counter-clockwise.
    triangles: Vec<[u32; 3]>,
    /// The height of its lowest corner.
    foot: f64,
}

impl FootprintOutline {
    /// Cuts the polygons of a footprint. Polygons without area are counted.
    pub(super) fn cut(footprint: Footprint, rise: Rise, cutter: &mut FaceCutter, tally: &mut LeftOutTally) -> Self {
        let Footprint { polygons, tags, number } = footprint;
        let mut outline = Self { tags, number, rise, polygons: Vec::new(), crosses: false };
        for polygon in &polygons {
            match FlatPolygon::cut(polygon, cutter) {
                Ok((flat, is_exact)) => {
                    outline.polygons.push(flat);
                    outline.crosses |= !is_exact;
                }
                Err(uncut) => tally.add("polygons", uncut.why()),
            }
        }
        outline
    }

    pub(super) fn is_empty(&self) -> bool {
        self.polygons.is_empty()
    }

    /// The number of the block's triangles.
    pub(super) fn triangle_count(&self) -> u64 {
        self.polygons.iter().map(|polygon| 2 * (polygon.triangles.len() + polygon.corners.len()) as u64).sum()
    }

    /// Whether its corners have no heights.
    pub(super) fn is_at_zero(&self) -> bool {
        self.polygons.iter().all(|polygon| polygon.foot == 0.0)
    }

    /// The block's name.
    pub(super) fn name(&self, layer: Option<&str>) -> String {
        names_of(&self.tags, self.number, layer).0
    }

    /// The block.
    pub(super) fn part(&self, layer: Option<&str>) -> Part {
        let (name, aliases) = names_of(&self.tags, self.number, layer);
        let mut part = Part { name, aliases, ..Part::default() };
        for polygon in &self.polygons {
            polygon.extrude(self.rise, &mut part);
        }
        part
    }
}

impl FlatPolygon {
    /// Cuts a polygon. Returns whether its triangles cover what it encloses.
    fn cut(polygon: &RingPolygon, cutter: &mut FaceCutter) -> Result<(Self, bool), Uncut> {
        let foot = polygon.points.iter().map(|point| point.z).fold(f64::INFINITY, f64::min);
        let (mut corners, mut ends) = (Vec::new(), Vec::new());
        let mut start = 0;
        for (ring, &end) in polygon.ends.iter().enumerate() {
            let from = corners.len();
            add_ring(polygon.points.get(start..end).unwrap_or_default(), ring == 0, &mut corners);
            start = end;
            // a hole without an area is ignored; an outline without one is found below
            if ring == 0 || corners.len() > from {
                ends.push(corners.len());
            }
        }
        let level: Vec<DVec3> = corners.iter().map(|corner| corner.extend(0.0)).collect();
        let cut = cutter.cut(&level, &ends)?;
        if !foot.is_finite() {
            return Err(Uncut::NoPoint);
        }
        let is_exact = cut.is_exact;
        let triangles = cut.triangles.to_vec();
        Ok((Self { corners, ends, triangles, foot }, is_exact))
    }

    /// A point inside it.
    pub(super) fn inner_point(&self) -> Option<DVec2> {
        let corners = self.triangles.first()?.map(|corner| self.corners.get(corner as usize).copied());
        let [Some(a), Some(b), Some(c)] = corners else { return None };
        Some((a + b + c) / 3.0)
    }

    /// The least and the greatest coordinates.
    pub(super) fn bounds(&self) -> (DVec2, DVec2) {
        let all = self.corners.iter();
        all.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), &corner| (low.min(corner), high.max(corner)))
    }

    /// Whether a point lies in it, and in none of its holes.
    pub(super) fn holds(&self, point: DVec2) -> bool {
        let mut start = 0;
        let mut inside = false;
        for &end in &self.ends {
            let ring = self.corners.get(start..end).unwrap_or_default();
            for (at, &a) in ring.iter().enumerate() {
                let b = ring[(at + 1) % ring.len()];
                if (a.y > point.y) != (b.y > point.y) && point.x < a.x + (point.y - a.y) / (b.y - a.y) * (b.x - a.x) {
                    inside = !inside;
                }
            }
            start = end;
        }
        inside
    }

    /// Adds the floor, the roof and the walls, counter-clockwise as seen from outside.
    fn extrude(&self, rise: Rise, part: &mut Part) {
        let first = u32::try_from(part.positions.len()).unwrap_or(u32::MAX);
        let count = u32::try_from(self.corners.len()).unwrap_or(u32::MAX);
        let (low, high) = (self.foot + rise.bottom_m, self.foot + rise.top_m);
        part.positions.extend(self.corners.iter().map(|corner| corner.extend(low)));
        part.positions.extend(self.corners.iter().map(|corner| corner.extend(high)));
        let lower = |corner: u32| first.saturating_add(corner);
        let upper = |corner: u32| first.saturating_add(count).saturating_add(corner);
        for &[a, b, c] in &self.triangles {
            part.triangles.push([lower(a), lower(c), lower(b)]);
            part.triangles.push([upper(a), upper(b), upper(c)]);
        }
        let mut start = 0;
        for &end in &self.ends {
            for at in start..end {
                let next = if at + 1 < end { at + 1 } else { start };
                let [a, b] = [at, next].map(|corner| u32::try_from(corner).unwrap_or(u32::MAX));
                part.triangles.push([lower(a), lower(b), upper(b)]);
                part.triangles.push([lower(a), upper(b), upper(a)]);
            }
            start = end;
        }
    }
}

/// Adds a ring without repeated points: counter-clockwise if it is the outer one, otherwise clockwise.
fn add_ring(points: &[DVec3], is_outer: bool, corners: &mut Vec<DVec2>) {
    let mut ring: Vec<[f64; 2]> = points.iter().map(|point| [point.x, point.y]).collect();
    ring.dedup();
    while ring.len() > 1 && ring.first() == ring.last() {
        ring.pop();
    }
    let area = ring_area(&ring);
    if !is_outer && (ring.len() < 3 || area == 0.0) {
        return;
    }
    if (area < 0.0) == is_outer {
        ring.reverse();
    }
    corners.extend(ring.into_iter().map(DVec2::from));
}
