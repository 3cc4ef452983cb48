//! Exact shadows on everything above the ground that a plan sees: the cells are sorted into buckets as the sun sees
//! them, and every caster's face is tested against the cells in the buckets that it covers.
//!
//! T. Aila and S. Laine, *Alias-Free Shadow Maps*, and G. Johnson et al., *The Irregular Z-Buffer* (both 2004): a
//! shadow map whose samples are exactly the judged points. Projected along the sun onto the raster of the ground's
//! shadow, a point is a column, a row and a height, and a face is a triangle with linear height. The face shades the
//! point if it covers it and is higher there. Everything is in double precision, and neighbouring faces compute with
//! the same numbers at their shared edge, so no point is lost between them.
//!
//! The buckets are squares of the sun's view ([`buckets`]), not of the raster: with a low sun, points at different
//! heights are far apart on the raster, but close together in the sun's view. Clumps of faces that cannot reach the
//! points are skipped, and points in shadow are dropped, so what is behind the first shade costs little.

mod buckets;
mod falling_face;

use super::flat::{Clumps, JudgedCells, RasterBounds};
use super::plan_surface::highest;
use super::{JUDGED_ABOVE_M, Scene, seen_normal};
use crate::mesh::Mesh;
use crate::view::{Bits, Surface, Tile};
use buckets::{BANDS, Buckets, SortedPoints};
use falling_face::FallingFace;
use glam::{DAffine3, DVec2, DVec3, DVec4, Vec3Swizzles};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicU8, AtomicU64, Ordering};

/// The cells of a plan, or of a tile of it, that see something above the ground.
pub(super) struct RaisedCells {
    /// The judged points: column, row, height.
    points: Vec<DVec3>,
    /// For each point its column in the tile, and the index of its face's normal.
    columns: Vec<u32>,
    normal_of: Vec<u32>,
    /// The visible side's normal of each visible face.
    normals: Vec<DVec3>,
    /// The first point of each row; one entry more.
    row_first: Vec<usize>,
    /// The cells, and how many points there are before those of each word.
    cells: Arc<Bits>,
    word_first: Vec<u32>,
    /// A box around the points.
    bounds: RasterBounds,
    faces: Mesh,
    /// For each point, whether it is in shadow.
    shaded: Vec<AtomicU8>,
    /// The number of tests of points against faces under the last sun.
    held: AtomicU64,
}

/// The casters' vertices as columns, rows and heights, and the shadow's columns and rows per metre of height.
pub(super) struct FallingShadow<'a> {
    pub(super) tops: &'a [DVec3],
    pub(super) throw: DVec2,
}

impl FallingShadow<'_> {
    /// Where a point is projected to, with its height.
    fn of(&self, point: DVec3) -> DVec3 {
        (point.xy() - self.throw * point.z).extend(point.z)
    }

    fn corners(&self, vertices: [u32; 3]) -> [DVec3; 3] {
        vertices.map(|vertex| self.of(self.tops[vertex as usize]))
    }
}

impl RaisedCells {
    /// No cell.
    pub(super) fn none(faces: Mesh) -> RaisedCells {
        RaisedCells {
            points: Vec::new(),
            columns: Vec::new(),
            normal_of: Vec::new(),
            normals: Vec::new(),
            row_first: vec![0],
            cells: Arc::new(Bits::new(1, 0)),
            word_first: Vec::new(),
            bounds: RasterBounds::NONE,
            faces,
            shaded: Vec::new(),
            held: AtomicU64::new(0),
        }
    }

    /// Looks down on the receivers; `raster_from_local` is that of the ground's shadow.
    pub(super) fn new(scene: &Scene, tile: Tile, raster_from_local: &DAffine3) -> RaisedCells {
        let Scene { casters, receivers, ground } = scene;
        let mut number = vec![u32::MAX; receivers.faces.len()];
        let mut raised = RaisedCells::none(casters.clone());
        if receivers.faces.is_empty() {
            return raised;
        }
        let (face, height) = highest(receivers, *ground, tile);
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
                // the raster's whole numbers are exactly the judged places
                let plane = raster_from_local.transform_point3(DVec3::Z * (height[cell] - receivers.origin.z));
                let at = DVec3::new(f64::from(first_column + column), f64::from(first_row + row), plane.z);
                let point = at + raster_from_local.transform_vector3(normal * JUDGED_ABOVE_M);
                raised.points.push(point);
                raised.bounds = raised.bounds.with(point);
                raised.columns.push(column);
                raised.normal_of.push(*number);
            }
            raised.row_first.push(raised.points.len());
        }
        raised.shaded.resize_with(raised.points.len(), AtomicU8::default);
        raised.find_cells(tile.size);
        raised
    }

    /// Finds the cells of the points, of a tile of so many columns and rows.
    fn find_cells(&mut self, [width, height]: [u32; 2]) {
        let mut cells = Bits::new(width, height);
        let in_row = cells.in_row();
        for (row, words) in cells.words.chunks_mut(in_row).enumerate() {
            for column in &self.columns[self.row_first[row]..self.row_first[row + 1]] {
                words[*column as usize / 64] |= 1 << (column % 64);
            }
        }
        let mut next = 0;
        for word in &cells.words {
            self.word_first.push(next);
            next += word.count_ones();
        }
        self.cells = Arc::new(cells);
    }

    /// Sets the bits of the raised cells. `falling` has the casters' vertices, `clumps` their faces.
    pub(super) fn draw(&self, to_sun: DVec3, falling: &FallingShadow<'_>, clumps: &Clumps, bits: &mut Bits) {
        if self.points.is_empty() {
            return;
        }
        self.held.store(0, Ordering::Relaxed);
        let buckets = Buckets::new(&self.bounds, falling.throw, to_sun, self.points.len());
        let points = self.points_in_bands(&buckets, to_sun, falling);
        let faces = self.faces_in_bands(&buckets, falling, clumps);
        (0..BANDS).into_par_iter().for_each(|band| {
            let points = points.iter().map(|bands| &bands[band][..]);
            let sorted = SortedPoints::new(&buckets, band, points);
            self.shade(sorted, &buckets, faces.iter().flat_map(|bands| &bands[band]), falling);
        });
        self.mark(bits);
    }

    /// The cells; none where there are none.
    pub(super) fn cells(&self) -> Option<&Arc<Bits>> {
        (!self.points.is_empty()).then_some(&self.cells)
    }

    /// Where one of the cells is judged: column, row and height; and the normal there.
    pub(super) fn judged(&self, row: usize, column: usize) -> (DVec3, DVec3) {
        let word = row * self.cells.in_row() + column / 64;
        let before = self.cells.words[word] & !(u64::MAX << (column % 64));
        let at = (self.word_first[word] + before.count_ones()) as usize;
        (self.points[at], self.normals[self.normal_of[at] as usize])
    }

    /// The number of tests of points against faces under the last sun.
    #[cfg(feature = "test-hooks")]
    pub(super) fn held(&self) -> u64 {
        self.held.load(Ordering::Relaxed)
    }

    /// For each task and band, the points that may see the sun. The others are in shadow, since their visible side
    /// faces away.
    fn points_in_bands(
        &self,
        buckets: &Buckets,
        to_sun: DVec3,
        falling: &FallingShadow<'_>,
    ) -> Vec<Vec<Vec<(DVec3, u32)>>> {
        let away: Vec<bool> = self.normals.iter().map(|normal| normal.dot(to_sun) <= 0.0).collect();
        let of_run = |run: Range<usize>| {
            let mut bands = vec![Vec::new(); BANDS];
            for at in run {
                let is_away = away[self.normal_of[at] as usize];
                self.shaded[at].store(u8::from(is_away), Ordering::Relaxed);
                if !is_away {
                    let fallen = falling.of(self.points[at]);
                    bands[buckets.band(buckets.seen(fallen).y)].push((fallen, at as u32));
                }
            }
            bands
        };
        split(self.points.len(), runs()).into_par_iter().map(of_run).collect()
    }

    /// For each task of the clumps that reach the points, and each band, the faces that may shade some.
    fn faces_in_bands(&self, buckets: &Buckets, falling: &FallingShadow<'_>, clumps: &Clumps) -> Vec<Vec<Vec<u32>>> {
        let mut reaching = Vec::new();
        clumps.reach(&JudgedCells::new(self.bounds, falling.throw), &mut reaching);
        let of_run = |run: &[u32]| {
            let mut bands = vec![Vec::new(); BANDS];
            for face in run.iter().flat_map(|&clump| clumps.list()[clump as usize].faces.clone()) {
                let corners = falling.corners(self.faces.faces[face as usize]);
                if corners.iter().all(|corner| corner.z <= self.bounds.low.z) {
                    continue;
                }
                if let Some(reach) = buckets.bands(corners) {
                    bands[reach].iter_mut().for_each(|band| band.push(face));
                }
            }
            bands
        };
        reaching.par_chunks(reaching.len().div_ceil(runs()).max(1)).map(of_run).collect()
    }

    /// Tests a band's points against the faces there.
    fn shade<'a>(
        &self,
        mut sorted: SortedPoints,
        buckets: &Buckets,
        faces: impl Iterator<Item = &'a u32>,
        falling: &FallingShadow<'_>,
    ) {
        let shade = |at: u32| self.shaded[at as usize].store(1, Ordering::Relaxed);
        // dropping points costs as much as testing them against a few faces
        let (mut all, mut held, mut enough) = (0, 0, 4 * sorted.size());
        for &face in faces {
            if sorted.is_empty() {
                break;
            }
            let vertices = self.faces.faces[face as usize];
            if let Some(face) = FallingFace::new(vertices, falling.corners(vertices)) {
                held += sorted.hold_against(buckets, &face);
            }
            if held >= enough {
                sorted.drop_shaded(shade);
                (all, held, enough) = (all + held, 0, 4 * sorted.size());
            }
        }
        sorted.drop_shaded(shade);
        self.held.fetch_add((all + held) as u64, Ordering::Relaxed);
    }

    /// Sets the bits of the cells in shadow, and clears those of the others.
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

/// The number of tasks.
fn runs() -> usize {
    4 * rayon::current_num_threads()
}

/// Ranges of about equal length.
fn split(count: usize, runs: usize) -> Vec<Range<usize>> {
    let run = count.div_ceil(runs).max(1);
    (0..count.div_ceil(run)).map(|at| at * run..((at + 1) * run).min(count)).collect()
}
