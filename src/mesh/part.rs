//! What a model file gives: a part before its corners are welded.

use glam::DVec3;
use std::ops::Range;

/// One component as a model file gives it, before welding: in most formats the triangles of one object in one material.
#[derive(Clone, Debug, Default)]
pub struct Part {
    /// Such as `node/material` of glTF, or `IfcWindow/Glass` of IFC.
    pub name: String,
    /// Further names by which `casts` and `receives` can select it: of its node, mesh, material, storey or layer.
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
    /// The distance from one number to the next, metres in the world.
    pub step_m: f64,
    /// Whether single precision is the reason; otherwise the numbers are written as whole steps.
    pub is_float: bool,
}
