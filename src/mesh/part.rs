//! What a model file gives: a part before its corners are welded.

use glam::DVec3;
use std::ops::Range;

/// One component as a model file gives it: triangles of one node and one material, before welding.
#[derive(Clone, Debug, Default)]
pub struct Part {
    /// `node/material`, or `node` where the node has one material.
    pub name: String,
    /// The names by which `casts` and `receives` may mean it: of its node, mesh and material.
    pub aliases: Vec<String>,
    /// Metres in the world frame.
    pub positions: Vec<DVec3>,
    /// Counter-clockwise seen from outside (mirroring transforms already undone).
    pub triangles: Vec<[u32; 3]>,
    /// Where the file's own numbers are coarser than a millimetre.
    pub coarse: Vec<CornerPrecision>,
}

/// A run of corners, and how coarse the numbers are that a file writes them with.
#[derive(Clone, Debug, PartialEq)]
pub struct CornerPrecision {
    /// Of the part's positions.
    pub corners: Range<u32>,
    /// From one number to the next, metres in the world.
    pub step_m: f64,
    /// Whether that is so since single precision holds no larger numbers better; else they are whole numbers.
    pub is_float: bool,
}
