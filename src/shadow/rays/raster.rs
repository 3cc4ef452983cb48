//! Parallel rays from the cells of a flat raster. A rectangle of cells that one triangle blocks as a whole, or that
//! nothing blocks, is decided without a ray; the others are halved. The parts search only among the blocks of triangles
//! that the whole may meet.

use super::beam::{AnyHits, Beam};
use super::cells::{CellRectangle, CellSet, SQUARE_SIDE};
use super::frame::{BeamFrame, around, reference};
use super::lanes::{LaneWork, Simd};
use super::prune::{Fates, FlatTriangles, StartPlane};
use super::search::{AskedBlock, BlockVisitor, traverse};
use super::shear::Shear;
use super::tree::{TriangleBlock, WideTree};
use arrayvec::ArrayVec;
use glam::{DVec3, DVec4};
use std::ops::Range;

/// A rectangle for which more blocks are tested is halved at once. Measured in `docs/benchmarks/receivers.md`.
const MOST_BLOCKS: usize = 8;
/// Rectangles that wait: one for each halving of a side of 2³² cells, and the last one's halves.
const MOST_WAITING: usize = 2 * 32 + 2;

/// What is found of a raster's cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RasterFate {
    /// No ray is blocked.
    Open,
    /// All rays are blocked.
    Blocked,
    /// Each cell by itself.
    Mixed,
}

/// A flat raster from whose cells parallel rays begin.
pub struct RayRaster<'a, P> {
    /// Columns and rows.
    pub size: [u32; 2],
    /// The plane in which rays begin: its unit normal to the side to which they go, and minus its height along that.
    pub plane: DVec4,
    /// Where the ray of a cell begins, given by column and row: in the plane and evenly spaced, but for rounding.
    pub origin: P,
    /// The cells that are asked; `None` if all are.
    pub asked: Option<&'a CellSet>,
}

/// Finds which rays of a raster are blocked, and how many rays were tested by themselves.
pub(super) struct BlockedRaster<'a, P> {
    pub(super) tree: &'a WideTree,
    pub(super) shear: &'a Shear,
    pub(super) raster: &'a RayRaster<'a, P>,
    pub(super) found: &'a mut BlockedCells,
}

/// The blocked cells of a raster, and what the search for the next one can use.
#[derive(Default)]
pub struct BlockedCells {
    cells: CellSet,
    /// Blocks that rectangles may meet.
    blocks: Vec<AskedBlock>,
    /// The block that last blocked all rays of a rectangle or a square. Often it blocks the next one, too.
    last: Option<u32>,
}

impl BlockedCells {
    /// The blocked cells of the last raster, if its fate was [`RasterFate::Mixed`].
    pub fn cells(&self) -> &CellSet {
        &self.cells
    }
}

/// A rectangle whose rays are not decided, and the blocks among which what they meet must be; `None` for all of the tree.
struct OpenRectangle {
    cells: CellRectangle,
    among: Option<Range<usize>>,
}

/// What the rays of a rectangle meet.
enum RectangleFate {
    /// One triangle blocks all of them.
    Blocked,
    /// At most these of the blocks that were found so far.
    Among(Range<usize>),
    /// More blocks than are worth a list.
    Many,
}

impl<P: Fn(u32, u32) -> DVec3> LaneWork for BlockedRaster<'_, P> {
    type Output = (RasterFate, u64);
    #[inline(always)]
    fn run<S: Simd>(mut self) -> (RasterFate, u64) {
        let mut blocks = std::mem::take(&mut self.found.blocks);
        let found = self.divide::<S>(&mut blocks);
        self.found.blocks = blocks;
        found
    }
}

impl<'a, P: Fn(u32, u32) -> DVec3> BlockedRaster<'a, P> {
    /// Halves the raster until every rectangle is decided. No recursion: its functions would not be compiled for the level.
    #[inline(always)]
    fn divide<S: Simd>(&mut self, blocks: &mut Vec<AskedBlock>) -> (RasterFate, u64) {
        let [width, height] = self.raster.size;
        let whole = CellRectangle { columns: 0..width, rows: 0..height };
        let mut waiting = ArrayVec::<OpenRectangle, MOST_WAITING>::new();
        waiting.push(OpenRectangle { cells: whole.clone(), among: None });
        let mut rays = 0;
        while let Some(OpenRectangle { cells, among }) = waiting.pop() {
            if self.raster.asked.is_some_and(|asked| !asked.has_any(&cells)) {
                continue;
            }
            // what lies behind belonged to rectangles that are done
            blocks.truncate(among.as_ref().map_or(0, |among| among.end));
            let fate = match among {
                None if cells.is_square() => RectangleFate::Many,
                among => self.search::<S>(&cells, among, blocks),
            };
            if cells == whole {
                match &fate {
                    RectangleFate::Blocked => return (RasterFate::Blocked, 0),
                    RectangleFate::Among(none) if none.is_empty() => return (RasterFate::Open, 0),
                    _ => self.found.cells.reset(width, height),
                }
            }
            let among = match fate {
                RectangleFate::Blocked => {
                    self.found.cells.add_all(&cells);
                    continue;
                }
                RectangleFate::Among(none) if none.is_empty() => continue,
                RectangleFate::Among(some) => Some(some),
                RectangleFate::Many => None,
            };
            if cells.is_square() {
                rays += self.ask::<S>(&cells, among.map(|among| &blocks[among]));
            } else {
                waiting.extend(cells.halves().map(|cells| OpenRectangle { cells, among: among.clone() }));
            }
        }
        (RasterFate::Mixed, rays)
    }

    /// Searches what a rectangle's rays meet, and appends its blocks.
    #[inline(always)]
    fn search<S: Simd>(
        &mut self,
        cells: &CellRectangle,
        among: Option<Range<usize>>,
        blocks: &mut Vec<AskedBlock>,
    ) -> RectangleFate {
        let frame = self.frame(cells);
        let plane = self.start_plane(&frame);
        let first = blocks.len();
        let tree = self.tree;
        let mut search = RectangleSearch { plane, blocks, seen: 0, blocked_by: None };
        if let Some(among) = among {
            for at in among {
                let asked = search.blocks[at];
                search.seen = 0;
                if !search.visit::<S>(&frame, asked, &tree.blocks[asked.at as usize]) {
                    return RectangleFate::Blocked;
                }
            }
            return RectangleFate::Among(first..blocks.len());
        }
        if let Some(last) = self.found.last {
            let block = &tree.blocks[last as usize];
            if block.there & FlatTriangles::<S::Eight>::of(&frame, block).fates_of_all(&frame).hit != 0 {
                return RectangleFate::Blocked;
            }
        }
        traverse::<S, _>(tree, &frame, &mut search);
        let RectangleSearch { seen, blocked_by, .. } = search;
        if blocked_by.is_some() {
            self.found.last = blocked_by;
            RectangleFate::Blocked
        } else if seen > MOST_BLOCKS {
            RectangleFate::Many
        } else {
            RectangleFate::Among(first..blocks.len())
        }
    }

    /// The frame of a rectangle's rays, which lie between those of its corners.
    #[inline(always)]
    fn frame(&self, cells: &CellRectangle) -> BeamFrame<'a> {
        let ends = |of: &Range<u32>| [of.start, of.end - 1];
        let ([west, east], [first, last]) = (ends(&cells.columns), ends(&cells.rows));
        let corners = [(west, first), (east, first), (west, last), (east, last)];
        let reference = reference(self.shear, (self.raster.origin)(west, first));
        let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        for (column, row) in corners {
            let ray = around(self.shear, &reference, (self.raster.origin)(column, row));
            for axis in 0..3 {
                low[axis] = low[axis].min(ray[axis]);
                high[axis] = high[axis].max(ray[axis]);
            }
        }
        // each ray between them is rounded by itself
        for axis in 0..3 {
            let rounding = low[axis].abs().max(high[axis].abs()) * f32::EPSILON;
            (low[axis], high[axis]) = (low[axis] - rounding, high[axis] + rounding);
        }
        BeamFrame::new(self.shear, reference, low, high)
    }

    fn start_plane(&self, frame: &BeamFrame<'_>) -> StartPlane {
        let normal = self.shear.axes.map(|axis| self.raster.plane[axis]);
        let reference = frame.reference.map(f64::from);
        let height = normal.iter().zip(reference).fold(self.raster.plane.w, |height, (along, at)| height + along * at);
        StartPlane { normal: normal.map(|along| along as f32), height: height as f32 }
    }

    /// Tests the rays of a square. Returns their number.
    #[inline(always)]
    fn ask<S: Simd>(&mut self, cells: &CellRectangle, among: Option<&[AskedBlock]>) -> u64 {
        let mut origins = ArrayVec::<DVec3, { (SQUARE_SIDE * SQUARE_SIDE) as usize }>::new();
        let mut of = ArrayVec::<(u32, u32), { (SQUARE_SIDE * SQUARE_SIDE) as usize }>::new();
        for row in cells.rows.clone() {
            for column in cells.columns.clone() {
                if self.raster.asked.is_none_or(|asked| asked.has(column, row)) {
                    origins.push((self.raster.origin)(column, row));
                    of.push((column, row));
                }
            }
        }
        let beam = Beam::new(self.shear, &origins);
        let frame = beam.frame(origins.len());
        let plane = among.is_none().then(|| self.start_plane(&frame));
        let mut search = AnyHits::of(&beam, 0..origins.len(), plane);
        match among {
            None => {
                let is_open = self.found.last.is_none_or(|at| {
                    let block = &self.tree.blocks[at as usize];
                    search.visit::<S>(&frame, AskedBlock { at, triangles: block.there }, block)
                });
                if is_open {
                    traverse::<S, _>(self.tree, &frame, &mut search);
                    self.found.last = search.last.or(self.found.last);
                }
            }
            Some(blocks) => {
                for &asked in blocks {
                    if !search.visit::<S>(&frame, asked, &self.tree.blocks[asked.at as usize]) {
                        break;
                    }
                }
            }
        }
        let mut blocked = search.blocked();
        while blocked != 0 {
            let (column, row) = of[blocked.trailing_zeros() as usize];
            self.found.cells.add(column, row);
            blocked &= blocked - 1;
        }
        origins.len() as u64
    }
}

/// The search for the blocks that the rays of a rectangle may meet.
struct RectangleSearch<'a> {
    plane: StartPlane,
    blocks: &'a mut Vec<AskedBlock>,
    /// The number of blocks that were tested.
    seen: usize,
    /// The block of a triangle that blocks all rays.
    blocked_by: Option<u32>,
}

impl BlockVisitor for RectangleSearch<'_> {
    #[inline(always)]
    fn visit<S: Simd>(&mut self, frame: &BeamFrame<'_>, asked: AskedBlock, block: &TriangleBlock) -> bool {
        let flat = FlatTriangles::<S::Eight>::of(frame, block);
        let Fates { missed, hit } = flat.fates_of_all(frame);
        if asked.triangles & hit != 0 {
            self.blocked_by = Some(asked.at);
            return false;
        }
        let triangles = asked.triangles & !missed & !flat.below(frame, block, &self.plane);
        if triangles != 0 {
            self.blocks.push(AskedBlock { triangles, ..asked });
        }
        self.seen += 1;
        self.seen <= MOST_BLOCKS
    }
}
