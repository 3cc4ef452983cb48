//! What is drawn under the lines: the ground, the buildings, and the borders between cells that the sun does not cause.

use super::{Line, LineGroup, Scale, fill, group, line, paths, stroke};
use crate::contour::{Contour, ScalarField, contours};
use crate::export::figure::picture::{Cells, Pen};
use crate::export::figure::scale::{Rgb, mix};
use crate::export::figure::svg::Block;
use crate::export::figure::{FigureContext, plan};
use crate::look::LOOK;
use crate::view::{Grid, SurfaceRows};
use rayon::prelude::*;

/// The base of a line drawing: the buildings of a plan, and the borders of what cells see.
pub(super) struct Base {
    width: u32,
    height: u32,
    ground_only: bool,
    /// For each cell, whether it sees a building.
    buildings: Vec<bool>,
    /// For each cell, whether the height jumps at its east side and at its south side.
    steps: [Vec<bool>; 2],
    /// Lines between cells: from and to in cells, and the pen.
    strokes: Vec<([u32; 2], [u32; 2], Pen)>,
    /// The contours of the buildings.
    footprints: Vec<Contour>,
}

impl Base {
    pub(super) fn new<S: SurfaceRows>(scene: &FigureContext<S>, grid: &Grid) -> Base {
        /// How many rows one task handles.
        const BAND: usize = 64;
        let (width, height) = (grid.width, grid.height);
        let bands: Vec<_> = (0..height as usize).step_by(BAND).collect();
        let of_band = |&first: &usize| {
            let end = (first + BAND).min(height as usize);
            // and the row below
            let surface = scene.surface.rows(first..(end + 1).min(height as usize));
            let mut cells = Cells::new(width);
            cells.border_of(&surface.face, |a, b| plan::pen(scene, &surface, grid.cell, a, b));
            let row = |row: u32| first as u32 + row;
            let within = |row: u32| (row as usize) < end - first;
            let east = cells.east().iter().filter(|line| within(line.0));
            let east: Vec<_> = east.map(|&(at, column, pen)| (row(at), column, pen)).collect();
            let south = cells.south().iter().filter(|line| within(line.0));
            let south: Vec<_> = south.map(|&(at, from, to, pen)| (row(at), from, to, pen)).collect();
            let buildings = surface.face[..(end - first) * width as usize].iter().map(|face| !scene.is_ground(*face));
            (buildings.collect::<Vec<bool>>(), east, south)
        };
        let bands: Vec<_> = bands.par_iter().map(of_band).collect();

        let mut buildings = Vec::with_capacity(grid.cells());
        let mut steps = [vec![false; grid.cells()], vec![false; grid.cells()]];
        let is_step = |pen: Pen| pen == Pen::OUTLINE || pen == Pen::STEP;
        let (mut down, mut strokes) = (Vec::new(), Vec::new());
        for (is_building, east, south) in bands {
            buildings.extend(is_building);
            for (row, column, _) in east.iter().filter(|line| is_step(line.2)) {
                steps[0][*row as usize * width as usize + *column as usize] = true;
            }
            down.extend(east);
            for (row, from, to, pen) in south {
                if is_step(pen) {
                    let first = row as usize * width as usize;
                    steps[1][first + from as usize..first + to as usize].fill(true);
                }
                strokes.push(([from, row + 1], [to, row + 1], pen));
            }
        }
        down.sort_by_key(|&(row, column, _)| (column, row));
        for (row, column, pen) in down {
            match strokes.last_mut() {
                // one stroke for all equal ones in a row
                Some((_, to, its)) if (*to, *its) == ([column + 1, row], pen) => *to = [column + 1, row + 1],
                _ => strokes.push(([column + 1, row], [column + 1, row + 1], pen)),
            }
        }
        let ground_only = scene.is_ground_alone();
        let mut base = Base { width, height, ground_only, buildings, steps, strokes, footprints: Vec::new() };
        let value = |cell| u64::from(base.buildings[cell]);
        let open = |a, b| base.is_step(a, b);
        base.footprints = contours(&ScalarField { width, height, value: &value, open: &open }, 0);
        base
    }

    fn is_step(&self, a: usize, b: usize) -> bool {
        self.steps[usize::from(b != a + 1)][a]
    }

    /// Whether two neighbouring cells are both judged and only the sun can separate them.
    pub(super) fn open(&self, a: usize, b: usize) -> bool {
        let is_judged = |cell: usize| !(self.ground_only && self.buildings[cell]);
        !self.is_step(a, b) && is_judged(a) && is_judged(b)
    }

    /// The contours of a field of numbers on this plan.
    pub(super) fn contours(&self, value: &(dyn Fn(usize) -> u64 + Sync), threshold: u64) -> Vec<Contour> {
        let open = |a, b| self.open(a, b);
        contours(&ScalarField { width: self.width, height: self.height, value, open: &open }, threshold)
    }

    /// Fills the buildings' areas with one colour.
    pub(super) fn fill(&self, block: &mut Block, scale: Scale, colour: Rgb) {
        group(block, "roofs", |block| fill(block, &scale.areas(&self.footprints), colour, 1.0));
    }

    /// The lines around the buildings, where they step up.
    pub(super) fn footprints(&self, scale: Scale) -> Vec<Line> {
        let LineGroup { large, small } = scale.lines(&self.footprints);
        [large, small].concat()
    }

    /// The buildings' lines, on `paper`.
    pub(super) fn draw(&self, block: &mut Block, scale: Scale, paper: Rgb) {
        group(block, "buildings", |block| {
            for pen in [Pen::CREASE, Pen::STEP] {
                let mut data = String::new();
                for (from, to, _) in self.strokes.iter().filter(|stroke| stroke.2 == pen) {
                    line(&mut data, [from, to].map(|at| scale.point(at.map(f64::from))).into_iter());
                }
                draw(block, &data, pen, paper);
            }
            draw(block, &paths(&self.footprints(scale)), Pen::OUTLINE, paper);
        });
    }
}

fn draw(block: &mut Block, data: &str, pen: Pen, paper: Rgb) {
    let colour = mix(paper, LOOK.line, f64::from(pen.strength));
    stroke(block, data, f64::from(pen.radius * 2.0), colour, "");
}
