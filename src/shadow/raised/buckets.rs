//! Buckets over the judged points as the sun sees them.
//!
//! The sun sees the points as wide as they are across their shadows, and along them foreshortened as it sees the
//! ground: a linear map of their projected places. It is only used for sorting; comparisons use the places themselves.

use super::falling_face::FallingFace;
use crate::shadow::flat::RasterBounds;
use glam::{DMat2, DVec2, DVec3, Vec3Swizzles};
use std::ops::RangeInclusive;

/// The number of bands: enough to keep all processors busy, with buckets small enough for the cache.
pub(super) const BANDS: usize = 128;

/// Square buckets over all judged points, and bands of their rows.
pub(super) struct Buckets {
    /// From a projected place to where the sun sees it, in cells of the raster.
    seen_from_fallen: DMat2,
    low: DVec2,
    high: DVec2,
    /// More than the rounding of places.
    slack: f64,
    /// Buckets per cell.
    scale: f64,
    columns: usize,
    rows: usize,
    /// The rows of buckets in a band.
    band_rows: usize,
}

impl Buckets {
    /// About as many buckets as points.
    pub(super) fn new(bounds: &RasterBounds, throw: DVec2, to_sun: DVec3, points: usize) -> Buckets {
        let along = throw.try_normalize().unwrap_or(DVec2::Y);
        let foreshortened = (to_sun.z / to_sun.length()).clamp(1e-9, 1.0);
        let seen_from_fallen = DMat2::from_cols(along.perp(), along * foreshortened).transpose();
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let mut far = 0.0_f64;
        for corner in 0..8 {
            let is_high = [0, 1, 2].map(|axis| corner >> axis & 1 == 1);
            let corner = DVec3::select(is_high.into(), bounds.high, bounds.low);
            let fallen = corner.xy() - throw * corner.z;
            far = far.max(fallen.abs().max_element());
            let seen = seen_from_fallen * fallen;
            (low, high) = (low.min(seen), high.max(seen));
        }
        let size = high - low + 1.0;
        let side = (size.x * size.y / points as f64).sqrt();
        let [columns, rows] = [size.x, size.y].map(|length| (length / side).ceil() as usize);
        let slack = 1e-6 + 1e-14 * far;
        Buckets {
            seen_from_fallen,
            low,
            high,
            slack,
            scale: 1.0 / side,
            columns,
            rows,
            band_rows: rows.div_ceil(BANDS),
        }
    }

    /// Where the sun sees a projected place.
    pub(super) fn seen(&self, fallen: DVec3) -> DVec2 {
        self.seen_from_fallen * fallen.xy()
    }

    fn column(&self, at: f64) -> usize {
        (((at - self.low.x) * self.scale) as usize).min(self.columns - 1)
    }

    fn row(&self, at: f64) -> usize {
        (((at - self.low.y) * self.scale) as usize).min(self.rows - 1)
    }

    pub(super) fn band(&self, at: f64) -> usize {
        self.row(at) / self.band_rows
    }

    /// The bands that a projected face reaches; `None` if it is beside all points.
    pub(super) fn bands(&self, corners: [DVec3; 3]) -> Option<RangeInclusive<usize>> {
        let [a, b, c] = corners.map(|corner| self.seen(corner));
        let (least, most) = (a.min(b).min(c) - self.slack, a.max(b).max(c) + self.slack);
        let is_beside = most.cmplt(self.low).any() || least.cmpgt(self.high).any();
        (!is_beside).then(|| self.band(least.y)..=self.band(most.y))
    }
}

/// The points of a band that are not known to be in shadow yet, by bucket.
pub(super) struct SortedPoints {
    /// The band's first row of buckets.
    first: usize,
    /// The first point of each bucket, row by row; one entry more.
    begins: Vec<u32>,
    columns: Vec<f64>,
    rows: Vec<f64>,
    heights: Vec<f64>,
    numbers: Vec<u32>,
    /// Not 0 for points that a face shades.
    shaded: Vec<u8>,
}

impl SortedPoints {
    pub(super) fn new<'a>(
        buckets: &Buckets,
        band: usize,
        points: impl Iterator<Item = &'a [(DVec3, u32)]> + Clone,
    ) -> SortedPoints {
        let first = band * buckets.band_rows;
        let bucket = |at: DVec3| {
            let seen = buckets.seen(at);
            (buckets.row(seen.y) - first) * buckets.columns + buckets.column(seen.x)
        };
        let mut begins = vec![0_u32; buckets.band_rows * buckets.columns + 1];
        let mut count = 0;
        for (at, _) in points.clone().flatten() {
            begins[bucket(*at)] += 1;
            count += 1;
        }
        let mut sum = 0;
        for begin in &mut begins {
            sum += *begin;
            *begin = sum;
        }
        // filled from the end of each bucket, which leaves its beginning
        let mut sorted = vec![(DVec3::ZERO, 0); count];
        for (at, number) in points.flatten() {
            let slot = &mut begins[bucket(*at)];
            *slot -= 1;
            sorted[*slot as usize] = (*at, *number);
        }
        SortedPoints {
            first,
            begins,
            columns: sorted.iter().map(|(at, _)| at.x).collect(),
            rows: sorted.iter().map(|(at, _)| at.y).collect(),
            heights: sorted.iter().map(|(at, _)| at.z).collect(),
            numbers: sorted.iter().map(|(_, number)| *number).collect(),
            shaded: vec![0; count],
        }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.numbers.is_empty()
    }

    /// The work of a pass: points and buckets.
    pub(super) fn size(&self) -> usize {
        self.numbers.len() + self.begins.len()
    }

    /// Marks the points that a face covers and is higher than. Returns the number of points that were tested.
    pub(super) fn hold_against(&mut self, buckets: &Buckets, face: &FallingFace) -> usize {
        let seen = face.corners.map(|corner| buckets.seen(corner));
        let [a, b, c] = seen;
        let (low, high) = (a.min(b).min(c) - buckets.slack, a.max(b).max(c) + buckets.slack);
        let last = (self.first + buckets.band_rows).min(buckets.rows) - 1;
        let rows = buckets.row(low.y).max(self.first)..=buckets.row(high.y).min(last);
        let is_small = rows.clone().count() <= 2;
        let mut held = 0;
        for row in rows {
            let columns = if is_small {
                [low.x, high.x]
            } else {
                let edge = |row: usize| buckets.low.y + row as f64 / buckets.scale;
                let [from, to] = columns_between(&seen, edge(row) - buckets.slack, edge(row + 1) + buckets.slack);
                [from - buckets.slack, to + buckets.slack]
            };
            let of_row = (row - self.first) * buckets.columns;
            let [from, to] = columns.map(|column| of_row + buckets.column(column));
            if from > to {
                continue;
            }
            let run = self.begins[from] as usize..self.begins[to + 1] as usize;
            held += 1 + run.len();
            let points = self.columns[run.clone()].iter().zip(&self.rows[run.clone()]).zip(&self.heights[run.clone()]);
            for (((column, row), height), shaded) in points.zip(&mut self.shaded[run]) {
                *shaded |= u8::from(face.shades(*column, *row, *height));
            }
        }
        held
    }

    /// Calls `tell` with the indices of points in shadow, and keeps the others.
    pub(super) fn drop_shaded(&mut self, tell: impl Fn(u32)) {
        let (mut kept, mut begin) = (0, 0);
        for bucket in 0..self.begins.len() - 1 {
            let end = self.begins[bucket + 1] as usize;
            self.begins[bucket] = kept as u32;
            for at in begin..end {
                if self.shaded[at] != 0 {
                    tell(self.numbers[at]);
                    continue;
                }
                self.columns[kept] = self.columns[at];
                self.rows[kept] = self.rows[at];
                self.heights[kept] = self.heights[at];
                self.numbers[kept] = self.numbers[at];
                kept += 1;
            }
            begin = end;
        }
        if let Some(end) = self.begins.last_mut() {
            *end = kept as u32;
        }
        self.columns.truncate(kept);
        self.rows.truncate(kept);
        self.heights.truncate(kept);
        self.numbers.truncate(kept);
        self.shaded.clear();
        self.shaded.resize(kept, 0);
    }
}

/// The extent of a triangle between two rows.
fn columns_between(corners: &[DVec2; 3], first: f64, last: f64) -> [f64; 2] {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for at in 0..3 {
        let [one, other] = [corners[at], corners[(at + 1) % 3]];
        let (upper, lower) = if one.y <= other.y { (one, other) } else { (other, one) };
        if lower.y < first || upper.y > last {
            continue;
        }
        for row in [first.max(upper.y), last.min(lower.y)] {
            let along = if lower.y > upper.y { (row - upper.y) / (lower.y - upper.y) } else { 0.0 };
            let column = upper.x + (lower.x - upper.x) * along.clamp(0.0, 1.0);
            (low, high) = (low.min(column), high.max(column));
        }
        if lower.y == upper.y {
            (low, high) = (low.min(lower.x), high.max(lower.x));
        }
    }
    [low, high]
}
