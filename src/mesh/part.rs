//! The parts of a model file, before their corners are welded.

use glam::DVec3;
use std::ops::Range;

/// A component of a model file before welding: in most formats, the triangles of one object with one material.
#[derive(Clone, Debug, Default)]
pub struct Part {
    /// The name, such as `node/material` of glTF, or `IfcWindow/Glass` of IFC.
    pub name: String,
    /// Other names by which `casts` and `receives` can select it: those of its node, mesh, material, storey or layer.
    pub aliases: Vec<String>,
    /// The corners, metres in the world frame.
    pub positions: Vec<DVec3>,
    /// The triangles, counter-clockwise seen from outside (mirroring transforms already undone).
    pub triangles: Vec<[u32; 3]>,
    /// Runs of corners whose numbers in the file are coarser than a millimetre.
    pub coarse: Vec<CornerPrecision>,
}

/// A run of corners, and the precision with which the file writes their numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct CornerPrecision {
    /// The corners, as a range of the part's positions.
    pub corners: Range<u32>,
    /// The step between possible values, metres in the world.
    pub step_m: f64,
    /// Whether single precision is the reason; otherwise, the file rounds to steps.
    pub is_float: bool,
}
