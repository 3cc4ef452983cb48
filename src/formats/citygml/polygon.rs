//! Reads GML positions as rings.

use super::tables::{GmlPolygon, GmlTables};
use glam::DVec3;

/// Adds consecutive positions. The file says whether a position has two or three numbers; the default is three.
pub(super) fn add_positions(text: &str, dimension: Option<u8>, points: &mut Vec<DVec3>) -> Result<(), &'static str> {
    let first = points.len();
    let mut numbers = text.split_ascii_whitespace().map(|number| number.parse::<f64>().unwrap_or(f64::NAN));
    match dimension {
        Some(2) => {
            while let Some(x) = numbers.next() {
                points.push(DVec3::new(x, numbers.next().unwrap_or(f64::NAN), 0.0));
            }
        }
        _ => {
            while let Some(x) = numbers.next() {
                let mut next = || numbers.next().unwrap_or(f64::NAN);
                let (y, z) = (next(), next());
                points.push(DVec3::new(x, y, z));
            }
        }
    }
    if points[first..].iter().all(|point| point.is_finite()) {
        return Ok(());
    }
    points.truncate(first);
    Err("positions that are not numbers, or are missing")
}

/// A polygon that is being read.
#[derive(Clone, Copy, Default)]
pub(super) struct OpenPolygon {
    first_point: usize,
    first_end: usize,
    first_of_ring: usize,
    is_broken: bool,
}

impl OpenPolygon {
    pub(super) fn begin(tables: &GmlTables) -> Self {
        Self {
            first_point: tables.points.len(),
            first_end: tables.ends.len(),
            first_of_ring: tables.points.len(),
            is_broken: false,
        }
    }

    /// Leaves the polygon out, whatever follows.
    pub(super) fn give_up(&mut self) {
        self.is_broken = true;
    }

    /// Ends a ring. Its last point may repeat the first.
    pub(super) fn end_ring(&mut self, tables: &mut GmlTables) {
        let ring = &tables.points[self.first_of_ring.min(tables.points.len())..];
        if ring.len() > 1 && ring.first() == ring.last() {
            tables.points.pop();
        }
        if tables.points.len() > self.first_of_ring {
            tables.ends.push(tables.points.len());
            self.first_of_ring = tables.points.len();
        }
    }

    /// Ends the polygon. Returns its index, unless it is left out.
    pub(super) fn end(mut self, tables: &mut GmlTables) -> Option<usize> {
        // triangles of some exporters have positions without a ring around them
        self.end_ring(tables);
        if self.is_broken || tables.ends.len() == self.first_end {
            tables.points.truncate(self.first_point);
            tables.ends.truncate(self.first_end);
            return None;
        }
        let points = self.first_point..tables.points.len();
        tables.polygons.push(GmlPolygon { points, ends: self.first_end..tables.ends.len() });
        Some(tables.polygons.len() - 1)
    }
}
