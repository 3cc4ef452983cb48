//! What is looked at: the plan's grid of cells, a camera, or single points.
//!
//! Rasters are north up: row 0 is north, column 0 is west, and a cell is judged at its centre.

use glam::{DMat4, DVec2, DVec3, DVec4};
use rayon::prelude::*;
use std::ops::Range;

/// The plan's raster: square cells from the north-west corner, in metres of the world frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// West edge, metres.
    pub west: f64,
    /// North edge, metres.
    pub north: f64,
    /// Side of a cell, metres.
    pub cell: f64,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl Grid {
    /// East edge, metres: a whole number of cells from the west.
    pub fn east(&self) -> f64 {
        self.west + f64::from(self.width) * self.cell
    }

    /// South edge, metres: a whole number of cells from the north.
    pub fn south(&self) -> f64 {
        self.north - f64::from(self.height) * self.cell
    }

    /// West, south, east, north in metres, as the site file writes a region.
    pub fn region(&self) -> [f64; 4] {
        [self.west, self.south(), self.east(), self.north]
    }

    /// From columns and rows to metres, in GDAL's order: x = t₀ + column · t₁ + row · t₂, y = t₃ + column · t₄ + row · t₅.
    /// Columns count from the west edge, rows from the north edge.
    pub fn transform(&self) -> [f64; 6] {
        [self.west, self.cell, 0.0, self.north, 0.0, -self.cell]
    }

    /// The centre of a cell, metres east and north.
    pub fn centre(&self, column: u32, row: u32) -> DVec2 {
        DVec2::new(self.west + (f64::from(column) + 0.5) * self.cell, self.north - (f64::from(row) + 0.5) * self.cell)
    }

    /// How many cells there are.
    pub fn cells(&self) -> usize {
        self.width as usize * self.height as usize
    }
}

/// A rectangle of a plan's cells, which is worked out on its own where the plan is too large for one go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tile {
    /// The whole plan.
    pub plan: Grid,
    /// The north-west cell: column and row on the plan.
    pub first: [u32; 2],
    /// Columns and rows.
    pub size: [u32; 2],
}

impl From<Grid> for Tile {
    fn from(plan: Grid) -> Tile {
        Tile { plan, first: [0, 0], size: [plan.width, plan.height] }
    }
}

impl Tile {
    /// Whether it is the whole plan.
    pub fn is_whole(&self) -> bool {
        *self == self.plan.into()
    }

    /// Its cells as a plan of their own. They lie where they lay but for the rounding of its corner.
    pub fn grid(&self) -> Grid {
        let Tile { plan, first: [column, row], size: [width, height] } = *self;
        let west = plan.west + f64::from(column) * plan.cell;
        let north = plan.north - f64::from(row) * plan.cell;
        Grid { west, north, cell: plan.cell, width, height }
    }

    /// How many cells there are.
    pub fn cells(&self) -> usize {
        self.size[0] as usize * self.size[1] as usize
    }
}

/// A point of which is asked when it lies in the sun.
#[derive(Clone, Debug, PartialEq)]
pub struct Probe {
    /// What people call it.
    pub name: String,
    /// Metres in the world frame.
    pub point: DVec3,
    /// The unit normal of the plane in which it lies, on the side that is judged; a point without one is free.
    pub normal: Option<DVec3>,
}

/// A perspective camera in the world frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Where the eye is, metres.
    pub eye: DVec3,
    /// The point in the middle of the picture, metres.
    pub target: DVec3,
    /// The direction that is upwards in the picture.
    pub up: DVec3,
    /// Vertical field of view, radians.
    pub fov_rad: f64,
    /// Picture width, pixels.
    pub width: u32,
    /// Picture height, pixels.
    pub height: u32,
}

impl Camera {
    /// What lies nearer to the eye is not drawn, metres.
    pub const NEAR_M: f64 = 0.05;

    /// Rightwards, upwards and forwards in the picture: unit vectors in the world frame.
    pub fn axes(&self) -> [DVec3; 3] {
        let forward = (self.target - self.eye).normalize();
        let right = forward.cross(self.up).normalize();
        [right, right.cross(forward), forward]
    }

    /// Half the picture's width and height at distance 1.
    pub fn half_size(&self) -> DVec2 {
        let half_height = (self.fov_rad / 2.0).tan();
        DVec2::new(half_height * f64::from(self.width) / f64::from(self.height), half_height)
    }

    /// A side, with the same point in the middle and as much of what lies there.
    pub fn side(&self, side: Side) -> Elevation {
        let Camera { target, width, height, .. } = *self;
        let cell = 2.0 * (self.eye - target).length() * (self.fov_rad / 2.0).tan() / f64::from(height);
        Elevation { target, to_viewer: side.to_viewer(), cell, width, height }
    }

    /// The direction in which a pixel's centre lies, a unit vector in the world frame.
    pub fn direction(&self, column: u32, row: u32) -> DVec3 {
        self.lens().direction(column, row)
    }

    /// What the directions of all pixels have in common.
    pub fn lens(&self) -> Lens {
        Lens {
            axes: self.axes(),
            half: self.half_size(),
            size: DVec2::new(f64::from(self.width), f64::from(self.height)),
        }
    }

    /// The perspective, from the near plane (depth 1) to infinity (depth 0).
    ///
    /// Seed 004, section 6, with depth reversed: a point at infinity has depth 0 exactly, so that no volume is cut
    /// at a far plane on any adapter, and `f32` depth keeps its precision far away.
    pub fn clip_from_world(&self) -> DMat4 {
        let [right, up, forward] = self.axes();
        let row = |axis: DVec3, scale: f64| (axis * scale).extend(-axis.dot(self.eye) * scale);
        let half = self.half_size();
        let rows = [
            row(right, 1.0 / half.x),
            row(up, 1.0 / half.y),
            DVec4::new(0.0, 0.0, 0.0, Self::NEAR_M),
            row(forward, 1.0),
        ];
        DMat4::from_cols_array_2d(&rows.map(|row| row.to_array())).transpose()
    }
}

/// A camera's axes and opening, found once for all of its pixels.
#[derive(Clone, Copy, Debug)]
pub struct Lens {
    axes: [DVec3; 3],
    half: DVec2,
    size: DVec2,
}

impl Lens {
    /// As [`Camera::direction`].
    pub fn direction(&self, column: u32, row: u32) -> DVec3 {
        let [right, up, forward] = self.axes;
        let x = ((f64::from(column) + 0.5) / self.size.x * 2.0 - 1.0) * self.half.x;
        let y = (1.0 - (f64::from(row) + 0.5) / self.size.y * 2.0) * self.half.y;
        (forward + right * x + up * y).normalize()
    }

    /// Forwards in the picture.
    pub fn forward(&self) -> DVec3 {
        self.axes[2]
    }
}

/// One of four sides: what is seen from there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// From the north.
    North,
    /// From the east.
    East,
    /// From the south.
    South,
    /// From the west.
    West,
}

/// What stays free on both sides of all that a side shows, below it and above it, a share of the picture.
const BESIDE: f64 = 0.04;
const BELOW: f64 = 0.16;
const ABOVE: f64 = 0.10;
/// The least that a side shows from foot to head, metres.
const LEAST: f64 = 0.1;

impl Side {
    /// The level unit vector towards the viewer.
    pub fn to_viewer(self) -> DVec3 {
        match self {
            Side::North => DVec3::Y,
            Side::East => DVec3::X,
            Side::South => DVec3::NEG_Y,
            Side::West => DVec3::NEG_X,
        }
    }

    /// The middle of the picture of that proportion that holds a box whole, and how much it shows from foot to head,
    /// metres. The box stands low in it: below the ground's line there is only cut earth.
    pub fn around(self, (low, high): (DVec3, DVec3), width_by_height: f64) -> (DVec3, f64) {
        let size = high - low;
        let width = size.dot(self.right().abs()) / (1.0 - 2.0 * BESIDE);
        let height = (width / width_by_height).max(size.z / (1.0 - BELOW - ABOVE)).max(LEAST);
        (((low + high) / 2.0).with_z(low.z + height * (0.5 - BELOW)), height)
    }

    /// How much a picture of that proportion about a point must show from foot to head, metres, to hold a box whole.
    pub fn height_about(self, middle: DVec3, (low, high): (DVec3, DVec3), width_by_height: f64) -> f64 {
        let [low, high] = [low - middle, high - middle];
        let aside = low.dot(self.right()).abs().max(high.dot(self.right()).abs());
        let across = aside / (0.5 - BESIDE) / width_by_height;
        across.max(-low.z / (0.5 - BELOW)).max(high.z / (0.5 - ABOVE)).max(LEAST)
    }

    fn right(self) -> DVec3 {
        DVec3::Z.cross(self.to_viewer())
    }
}

/// A picture of one side: level, along parallel rays, true to scale. What lies below the ground is behind the earth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elevation {
    /// The point in the middle of the picture, metres.
    pub target: DVec3,
    /// The level unit vector towards the viewer.
    pub to_viewer: DVec3,
    /// Side of a pixel, metres.
    pub cell: f64,
    /// Picture width, pixels.
    pub width: u32,
    /// Picture height, pixels.
    pub height: u32,
}

impl Elevation {
    /// Rightwards, upwards and forwards in the picture: unit vectors in the world frame.
    pub fn axes(&self) -> [DVec3; 3] {
        let forward = -self.to_viewer;
        [forward.cross(DVec3::Z), DVec3::Z, forward]
    }

    /// Half the picture's width and height, metres.
    pub fn half_size(&self) -> DVec2 {
        DVec2::new(f64::from(self.width), f64::from(self.height)) * self.cell / 2.0
    }

    /// Where a pixel's centre lies in the plane of the picture, which goes through the target.
    pub fn centre(&self, column: u32, row: u32) -> DVec3 {
        let [right, up, _] = self.axes();
        let half = self.half_size();
        let x = (f64::from(column) + 0.5) * self.cell - half.x;
        let y = half.y - (f64::from(row) + 0.5) * self.cell;
        self.target + right * x + up * y
    }
}

/// What a mask is drawn for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum View {
    /// Straight down on the grid's cells.
    Plan(Grid),
    /// A perspective picture.
    Camera(Camera),
    /// A side, as drawings have it.
    Elevation(Elevation),
}

impl View {
    /// Columns and rows of the raster.
    pub fn size(&self) -> (u32, u32) {
        match self {
            View::Plan(grid) => (grid.width, grid.height),
            View::Camera(camera) => (camera.width, camera.height),
            View::Elevation(side) => (side.width, side.height),
        }
    }

    /// From whence everything is seen, homogeneous: the eye, or the direction straight up or level towards the viewer.
    pub fn viewer(&self) -> DVec4 {
        match self {
            View::Plan(_) => DVec4::Z,
            View::Camera(camera) => camera.eye.extend(1.0),
            View::Elevation(side) => side.to_viewer.extend(0.0),
        }
    }
}

/// What each cell of a view sees first, models before ground.
///
/// Drawn once per study, since it does not depend on the sun. Drawings take roofs and outlines from it.
#[derive(Clone, Debug)]
pub struct Surface {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Per cell the face of the mesh that is seen, or [`Surface::GROUND`], or [`Surface::SKY`].
    pub face: Vec<u32>,
    /// Per cell the world height of the seen point, metres (NaN for the sky).
    pub height_m: Vec<f32>,
}

/// What the cells of a plan see, some rows at a time: a drawing of many cells does not hold them all.
pub trait SurfaceRows: Sync {
    /// How many cells there are.
    fn cells(&self) -> usize;

    /// What some rows see.
    fn rows(&self, rows: Range<usize>) -> Surface;
}

impl SurfaceRows for Surface {
    fn cells(&self) -> usize {
        self.face.len().min(self.height_m.len())
    }

    fn rows(&self, rows: Range<usize>) -> Surface {
        let width = self.width as usize;
        let cells = rows.start * width..rows.end * width;
        Surface {
            width: self.width,
            height: rows.len() as u32,
            face: self.face[cells.clone()].to_vec(),
            height_m: self.height_m[cells].to_vec(),
        }
    }
}

impl Surface {
    /// The cell sees the ground plane.
    pub const GROUND: u32 = u32::MAX - 1;
    /// The cell sees nothing.
    pub const SKY: u32 = u32::MAX;
}

/// Which part of the sun each cell sees at one instant: 255 the whole of it, 0 none.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mask {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Per cell the share of the sun that is seen, in 1/255, row 0 first.
    pub share: Vec<u8>,
}

/// Which cells are in shadow, where the sun is a point: one bit a cell.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bits {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// 1 in shadow, 0 where the sun is seen; each row begins a word of its own, and its first cell is the lowest bit. What a
    /// row leaves over of its last word is 0.
    pub words: Vec<u64>,
}

impl Bits {
    /// No cell is in shadow.
    pub fn new(width: u32, height: u32) -> Bits {
        let words = vec![0; width.div_ceil(64) as usize * height as usize];
        Bits { width, height, words }
    }

    /// Of a mask: in shadow is where at most half of the sun is seen.
    pub fn of(mask: &Mask) -> Bits {
        let mut bits = Bits::new(mask.width, mask.height);
        let in_row = bits.in_row();
        let rows = bits.words.par_chunks_mut(in_row).zip(mask.share.par_chunks(mask.width as usize));
        rows.for_each(|(words, shares)| {
            for (word, shares) in words.iter_mut().zip(shares.chunks(64)) {
                let set = |word: u64, (at, share): (usize, &u8)| word | u64::from(*share <= 127) << at;
                *word = shares.iter().enumerate().fold(0, set);
            }
        });
        bits
    }

    /// Puts a tile's cells in their place on the plan. A tile's first column is a multiple of 64.
    pub fn paste(&mut self, tile: &Tile, part: &Bits) {
        let [left, top] = tile.first.map(|first| first as usize);
        let in_row = self.in_row();
        for (row, words) in part.words.chunks(part.in_row()).enumerate() {
            let first = (top + row) * in_row + left / 64;
            self.words[first..first + words.len()].copy_from_slice(words);
        }
    }

    /// Whether a cell, counted along the rows, is in shadow.
    pub fn contains(&self, cell: usize) -> bool {
        let (row, column) = (cell / self.width as usize, cell % self.width as usize);
        self.words[row * self.in_row() + column / 64] >> (column % 64) & 1 == 1
    }

    /// Words of a row.
    pub fn in_row(&self) -> usize {
        self.width.div_ceil(64) as usize
    }

    /// The same with a byte a cell.
    pub fn mask(&self) -> Mask {
        let mut share = vec![0; self.width as usize * self.height as usize];
        let rows = share.par_chunks_mut(self.width as usize).zip(self.words.par_chunks(self.in_row()));
        rows.for_each(|(shares, words)| {
            for (shares, word) in shares.chunks_mut(64).zip(words) {
                for (at, share) in shares.iter_mut().enumerate() {
                    *share = if word >> at & 1 == 1 { 0 } else { 255 };
                }
            }
        });
        Mask { width: self.width, height: self.height, share }
    }
}

/// What decided a cell's share, where a map decides some and volumes the others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Decider {
    /// The map, and the cell is in shadow.
    MapShadow,
    /// The map, and the cell sees the sun.
    MapLight,
    /// The volumes, and the cell is in shadow.
    VolumeShadow,
    /// The volumes, and the cell sees the sun.
    VolumeLight,
}

/// What counting shadow volumes takes at one instant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FragmentCounts {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Per cell how many fragments of walls and caps reach the count, row 0 first.
    pub reached: Vec<u32>,
    /// How many would in all cells together, if no mask kept any away.
    pub all: u64,
    /// Per cell what decided it, where a map did too.
    pub decided: Option<Vec<Decider>>,
}

/// What a drawing lays over a camera's picture at one instant, in cells finer than the picture's.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Overlay {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Per cell how many walls and caps of the shadow volumes lie before what is seen, at most 255; where wanted.
    pub layers: Option<Vec<u8>>,
    /// Per cell how much of it the silhouette's lines cover, in 1/255; where wanted.
    pub silhouette: Option<Vec<u8>>,
}

impl Overlay {
    /// Nothing is to be seen of it.
    pub fn is_empty(&self) -> bool {
        [&self.layers, &self.silhouette].into_iter().flatten().flatten().all(|cell| *cell == 0)
    }
}
