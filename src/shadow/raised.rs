//! Shadows on all that a plan sees above the ground, exactly: the cells are sorted into buckets as the sun sees them, and
//! every caster's face is held against those in the buckets below it.
//!
//! T. Aila and S. Laine, *Alias-Free Shadow Maps*, and G. Johnson and others, *The Irregular Z-Buffer* (both 2004): a shadow
//! map whose samples are the very points that ask. Seen along the sun, on the raster that the ground's shadow is drawn on, a
//! point is a column, a row and a height, and a face is a triangle over which height is linear; the face shades the point
//! where it covers it and is higher there. All is in double precision, and neighbouring faces ask with the same numbers at
//! the edge that they share, so no point falls between them.

use super::plan_surface::highest;
use super::{JUDGED_ABOVE_M, Scene, seen_normal};
use crate::mesh::Mesh;
use crate::view::{Bits, CellWord, Surface, Tile};
use glam::{DAffine3, DVec2, DVec3, DVec4, Vec3Swizzles};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, Ordering};

/// The cells of a plan, or of a tile of it, that see something above the ground.
pub(super) struct RaisedCells {
    /// The judged points: column, row, height.
    points: Vec<DVec3>,
    /// Per point its column in the tile, and which of the normals is its face's.
    columns: Vec<u32>,
    normal_of: Vec<u32>,
    /// The seen side's normal of each face that is seen.
    normals: Vec<DVec3>,
    /// Where each row's points begin; one longer than the tile has rows.
    row_first: Vec<usize>,
    /// Words of bits in a row of the tile.
    in_row: usize,
    faces: Mesh,
    /// Per point whether it is in shadow.
    shaded: Vec<AtomicU8>,
}

/// As many bands as keep all processors busy to the end, and their buckets in the cache.
const BANDS: usize = 128;

impl RaisedCells {
    /// No cell.
    pub(super) fn none(faces: Mesh) -> RaisedCells {
        RaisedCells {
            points: Vec::new(),
            columns: Vec::new(),
            normal_of: Vec::new(),
            normals: Vec::new(),
            row_first: vec![0],
            in_row: 1,
            faces,
            shaded: Vec::new(),
        }
    }

    /// The cells, of a tile of so many columns and rows; none where there are none.
    pub(super) fn cells(&self, [width, height]: [u32; 2]) -> Option<Arc<Bits>> {
        let mut cells = Bits::new(width, height);
        for (row, words) in cells.words.chunks_mut(self.in_row).enumerate().take(self.row_first.len() - 1) {
            for column in &self.columns[self.row_first[row]..self.row_first[row + 1]] {
                words[*column as usize / 64] |= 1 << (column % 64);
            }
        }
        (!self.points.is_empty()).then(|| Arc::new(cells))
    }

    /// Looks down on the receivers; `raster_from_local` as the ground's shadow has it.
    pub(super) fn new(scene: &Scene, tile: Tile, raster_from_local: &DAffine3) -> RaisedCells {
        let Scene { casters, receivers, ground } = scene;
        let mut number = vec![u32::MAX; receivers.faces.len()];
        let mut raised = RaisedCells::none(casters.clone());
        raised.in_row = tile.size[0].div_ceil(64) as usize;
        if receivers.faces.is_empty() {
            return raised;
        }
        let (face, height) = highest(receivers, *ground, tile, |height| height);
        let [first_column, first_row] = tile.first;
        let width = tile.size[0] as usize;
        for row in 0..tile.size[1] {
            for column in 0..tile.size[0] {
                let cell = row as usize * width + column as usize;
                if face[cell] == Surface::GROUND {
                    continue;
                }
                let number = &mut number[face[cell] as usize];
                if *number == u32::MAX {
                    *number = raised.normals.len() as u32;
                    raised.normals.push(seen_normal(receivers.planes()[face[cell] as usize], DVec4::Z));
                }
                let normal = raised.normals[*number as usize];
                // the raster's whole numbers are the very places that are judged
                let plane = raster_from_local.transform_point3(DVec3::Z * (height[cell] - receivers.origin.z));
                let at = DVec3::new(f64::from(first_column + column), f64::from(first_row + row), plane.z);
                raised.points.push(at + raster_from_local.transform_vector3(normal * JUDGED_ABOVE_M));
                raised.columns.push(column);
                raised.normal_of.push(*number);
            }
            raised.row_first.push(raised.points.len());
        }
        raised.shaded.resize_with(raised.points.len(), AtomicU8::default);
        raised
    }

    /// Sets the bits of the raised cells. The casters' vertices fall on `places` from `tops`, which are columns, rows and
    /// heights; `throw` as they fall.
    pub(super) fn draw(&self, to_sun: DVec3, throw: DVec2, places: &[DVec2], tops: &[DVec3], bits: &mut Bits) {
        if self.points.is_empty() {
            return;
        }
        let count = self.points.len();
        let fall = |at| self.fall(at, throw);
        let (low, high) = (0..count).into_par_iter().map(fall).fold(bounds, widen).reduce(bounds, join);
        let buckets = Buckets::new(low.xy(), high.xy(), count);
        let fallen = FallenVertices { places, tops };
        let points = self.points_in_bands(&buckets, to_sun, throw);
        let faces = self.faces_in_bands(&buckets, &fallen, (low, high));
        (0..BANDS).into_par_iter().for_each(|band| {
            let points = points.iter().map(|bands| &bands[band][..]);
            self.shade(
                &SortedPoints::new(&buckets, band, points),
                &buckets,
                faces.iter().flat_map(|bands| &bands[band]),
                &fallen,
            );
        });
        self.mark(bits);
    }

    /// Of some raised cells those that are in shadow, each judged by itself: whether anything stands between a point (column,
    /// row, height) and the sun.
    pub(super) fn shaded_of(
        &self,
        to_sun: DVec3,
        asked: &[CellWord],
        is_blocked: impl Fn(DVec3) -> bool + Sync,
    ) -> Vec<u64> {
        let away: Vec<bool> = self.normals.iter().map(|normal| normal.dot(to_sun) <= 0.0).collect();
        let shaded = |asked: &CellWord| {
            let (row, first) = asked.place(self.in_row);
            let of_row = self.row_first[row]..self.row_first[row + 1];
            let begin =
                of_row.start + self.columns[of_row.clone()].partition_point(|column| (*column as usize) < first);
            let of_word = (begin..of_row.end).map(|at| (at, self.columns[at] as usize - first));
            let asked = of_word.take_while(|(_, bit)| *bit < 64).filter(|(_, bit)| asked.cells >> bit & 1 == 1);
            let is_shaded = |at: usize| away[self.normal_of[at] as usize] || is_blocked(self.points[at]);
            asked.fold(0, |shaded, (at, bit)| shaded | u64::from(is_shaded(at)) << bit)
        };
        asked.par_iter().map(shaded).collect()
    }

    /// Where a point falls, seen along the sun.
    fn fall(&self, at: usize, throw: DVec2) -> DVec3 {
        let point = self.points[at];
        (point.xy() - throw * point.z).extend(point.z)
    }

    /// Per run of points, and per band, those that may see the sun. The others are in shadow, and ask no further: their
    /// seen side looks away.
    fn points_in_bands(&self, buckets: &Buckets, to_sun: DVec3, throw: DVec2) -> Vec<Vec<Vec<(DVec3, u32)>>> {
        let away: Vec<bool> = self.normals.iter().map(|normal| normal.dot(to_sun) <= 0.0).collect();
        let of_run = |run: Range<usize>| {
            let mut bands = vec![Vec::new(); BANDS];
            for at in run {
                let is_away = away[self.normal_of[at] as usize];
                self.shaded[at].store(u8::from(is_away), Ordering::Relaxed);
                if !is_away {
                    let at_once = self.fall(at, throw);
                    bands[buckets.band(at_once.y)].push((at_once, at as u32));
                }
            }
            bands
        };
        split(self.points.len(), runs()).into_par_iter().map(of_run).collect()
    }

    /// Per run of the casters' faces, and per band, those that may shade points between `low` and `high`.
    fn faces_in_bands(
        &self,
        buckets: &Buckets,
        fallen: &FallenVertices<'_>,
        (low, high): (DVec3, DVec3),
    ) -> Vec<Vec<Vec<u32>>> {
        let FallenVertices { places, tops } = fallen;
        let of_run = |run: Range<usize>| {
            let mut bands = vec![Vec::new(); BANDS];
            for at in run {
                let corners = self.faces.faces[at];
                let [a, b, c] = corners.map(|vertex| places[vertex as usize]);
                let (least, most) = (a.min(b).min(c), a.max(b).max(c));
                let top = corners.map(|vertex| tops[vertex as usize].z).into_iter().fold(f64::MIN, f64::max);
                // beside or below all points
                if most.x < low.x || least.x > high.x || most.y < low.y || least.y > high.y || top <= low.z {
                    continue;
                }
                let reach = buckets.band(least.y)..=buckets.band(most.y);
                bands[reach].iter_mut().for_each(|band| band.push(at as u32));
            }
            bands
        };
        split(self.faces.faces.len(), runs()).into_par_iter().map(of_run).collect()
    }

    /// Holds a band's points against the faces there.
    fn shade<'a>(
        &self,
        sorted: &SortedPoints,
        buckets: &Buckets,
        faces: impl Iterator<Item = &'a u32>,
        fallen: &FallenVertices<'_>,
    ) {
        if sorted.heights.is_empty() {
            return;
        }
        let mut shaded = vec![0; sorted.heights.len()];
        for &face in faces {
            let vertices = self.faces.faces[face as usize];
            if let Some(falling) = FallingFace::new(vertices, vertices.map(|vertex| fallen.corner(vertex))) {
                sorted.hold_against(buckets, &falling, &mut shaded);
            }
        }
        for (&at, _) in sorted.numbers.iter().zip(&shaded).filter(|(_, shaded)| **shaded != 0) {
            self.shaded[at as usize].store(1, Ordering::Relaxed);
        }
    }

    /// Sets the bits of the cells that are in shadow, and takes away those of the others.
    fn mark(&self, bits: &mut Bits) {
        let in_row = bits.in_row();
        bits.words.par_chunks_mut(in_row).enumerate().for_each(|(row, words)| {
            for at in self.row_first[row]..self.row_first[row + 1] {
                let column = self.columns[at] as usize;
                let bit = 1 << (column % 64);
                let word = &mut words[column / 64];
                *word = if self.shaded[at].load(Ordering::Relaxed) != 0 { *word | bit } else { *word & !bit };
            }
        });
    }
}

/// The casters' vertices, seen along the sun.
struct FallenVertices<'a> {
    /// Where they fall.
    places: &'a [DVec2],
    /// Columns, rows and heights from which they do.
    tops: &'a [DVec3],
}

impl FallenVertices<'_> {
    fn corner(&self, vertex: u32) -> DVec3 {
        self.places[vertex as usize].extend(self.tops[vertex as usize].z)
    }
}

/// Into how many runs work is split.
fn runs() -> usize {
    4 * rayon::current_num_threads()
}

/// Nothing yet.
fn bounds() -> (DVec3, DVec3) {
    (DVec3::INFINITY, DVec3::NEG_INFINITY)
}

fn widen((low, high): (DVec3, DVec3), point: DVec3) -> (DVec3, DVec3) {
    (low.min(point), high.max(point))
}

fn join(one: (DVec3, DVec3), other: (DVec3, DVec3)) -> (DVec3, DVec3) {
    (one.0.min(other.0), one.1.max(other.1))
}

/// Runs of about equal length.
fn split(count: usize, runs: usize) -> Vec<Range<usize>> {
    let run = count.div_ceil(runs).max(1);
    (0..count.div_ceil(run)).map(|at| at * run..((at + 1) * run).min(count)).collect()
}

/// Square buckets over all that is asked, and bands of their rows.
struct Buckets {
    low: DVec2,
    /// Buckets a cell.
    scale: f64,
    columns: usize,
    rows: usize,
    /// Rows of a band.
    band_rows: usize,
}

impl Buckets {
    /// No smaller than a cell, and about as many as points.
    fn new(low: DVec2, high: DVec2, points: usize) -> Buckets {
        let size = high - low + 1.0;
        let side = (size.x * size.y / points as f64).sqrt().max(1.0);
        let [columns, rows] = [size.x, size.y].map(|length| (length / side).ceil() as usize);
        Buckets { low, scale: 1.0 / side, columns, rows, band_rows: rows.div_ceil(BANDS) }
    }

    fn column(&self, at: f64) -> usize {
        (((at - self.low.x) * self.scale) as usize).min(self.columns - 1)
    }

    fn row(&self, at: f64) -> usize {
        (((at - self.low.y) * self.scale) as usize).min(self.rows - 1)
    }

    fn band(&self, at: f64) -> usize {
        self.row(at) / self.band_rows
    }
}

/// The points of a band, bucket by bucket.
struct SortedPoints {
    /// The band's first row of buckets.
    first: usize,
    /// Where each bucket's points begin, row after row; one longer.
    begins: Vec<u32>,
    columns: Vec<f64>,
    rows: Vec<f64>,
    heights: Vec<f64>,
    numbers: Vec<u32>,
}

impl SortedPoints {
    fn new<'a>(
        buckets: &Buckets,
        band: usize,
        points: impl Iterator<Item = &'a [(DVec3, u32)]> + Clone,
    ) -> SortedPoints {
        let first = band * buckets.band_rows;
        let bucket = |at: DVec3| (buckets.row(at.y) - first) * buckets.columns + buckets.column(at.x);
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
        // filled from each bucket's end, so that its begin is left
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
        }
    }

    /// Marks the points that a face covers and is higher than.
    fn hold_against(&self, buckets: &Buckets, face: &FallingFace, shaded: &mut [u8]) {
        let last = (self.first + buckets.band_rows).min(buckets.rows) - 1;
        let rows = buckets.row(face.low.y).max(self.first)..=buckets.row(face.high.y).min(last);
        let is_small = rows.clone().count() <= 2;
        for row in rows {
            let columns = if is_small {
                [face.low.x, face.high.x]
            } else {
                let edge = |row: usize| buckets.low.y + row as f64 / buckets.scale;
                // a hair more on both sides, for the rounding of which bucket a point is in
                face.columns(edge(row) - 1e-6, edge(row + 1) + 1e-6)
            };
            let of_row = (row - self.first) * buckets.columns;
            let [from, to] = columns.map(|column| of_row + buckets.column(column));
            if from > to {
                continue;
            }
            let run = self.begins[from] as usize..self.begins[to + 1] as usize;
            let points = self.columns[run.clone()].iter().zip(&self.rows[run.clone()]).zip(&self.heights[run.clone()]);
            for (((column, row), height), shaded) in points.zip(&mut shaded[run]) {
                *shaded |= u8::from(face.shades(*column, *row, *height));
            }
        }
    }
}

/// A caster's face as the sun sees it.
struct FallingFace {
    corners: [DVec3; 3],
    low: DVec3,
    high: DVec3,
    /// Per side a linear function that is nowhere below 0 on the face: factors of column and row, and a constant.
    sides: [DVec3; 3],
    /// The height over it, in the same way.
    height: DVec3,
}

impl FallingFace {
    /// None where the sun sees it from its edge: then it shades nothing.
    fn new(vertices: [u32; 3], corners: [DVec3; 3]) -> Option<FallingFace> {
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a);
        if normal.z == 0.0 {
            return None;
        }
        let side = |from: usize, to: usize| {
            // from the lower vertex to the higher, whichever face asks, so that neighbours find the same but for its sign
            let is_turned = vertices[from] > vertices[to];
            let [start, end] = if is_turned { [corners[to], corners[from]] } else { [corners[from], corners[to]] };
            let across = DVec2::new(start.y - end.y, end.x - start.x);
            let line = across.extend(-across.dot(start.xy()));
            if is_turned == (normal.z > 0.0) { -line } else { line }
        };
        let slope = -normal.xy() / normal.z;
        Some(FallingFace {
            corners,
            low: a.min(b).min(c),
            high: a.max(b).max(c),
            sides: [side(0, 1), side(1, 2), side(2, 0)],
            height: slope.extend(a.z - slope.dot(a.xy())),
        })
    }

    #[inline]
    fn shades(&self, column: f64, row: f64, height: f64) -> bool {
        let of = |line: &DVec3| line.x * column + line.y * row + line.z;
        let [one, other, third] = [of(&self.sides[0]), of(&self.sides[1]), of(&self.sides[2])];
        // nearly edge-on the height over it wavers, but not beyond its corners
        let over = of(&self.height).min(self.high.z).max(self.low.z);
        (one >= 0.0) & (other >= 0.0) & (third >= 0.0) & (over > height)
    }

    /// From where to where it reaches between two rows.
    fn columns(&self, first: f64, last: f64) -> [f64; 2] {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for at in 0..3 {
            let [one, other] = [self.corners[at], self.corners[(at + 1) % 3]];
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
        [low - 1e-6, high + 1e-6]
    }
}
