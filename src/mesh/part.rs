//! What a model file gives: a part before its corners are welded.

use glam::DVec3;
use std::ops::Range;

/// One component as a model file gives it, before welding: in most formats the triangles of one object in one material.
#[derive(Clone, Debug, Default)]
pub struct Part {
    /// The name, such as `node/material` of glTF, or `IfcWindow/Glass` of IFC.
    pub name: String,
    /// Further names by which `casts` and `receives` can select it: those of its node, mesh, material, storey or layer.
    pub aliases: Vec<String>,
    /// The corners, metres in the world frame.
    pub positions: Vec<DVec3>,
    /// The triangles, counter-clockwise seen from outside (mirroring transforms already undone).
    pub triangles: Vec<[u32; 3]>,
    /// Where the file's own numbers are coarser than a millimetre.
    pub coarse: Vec<CornerPrecision>,
}

/// A run of corners, and the precision with which the file writes their numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct CornerPrecision {
    /// The corners, as a range of the part's positions.
    pub corners: Range<u32>,
    /// The distance from one possible number to the next, metres in the world.
    pub step_m: f64,
    /// Whether single precision is the reason; otherwise the numbers are whole steps.
    pub is_float: bool,
}
