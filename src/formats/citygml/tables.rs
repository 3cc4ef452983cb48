//! What is kept of a file while it is read.

use crate::formats::left_out::LeftOutTally;
use glam::DVec3;
use rustc_hash::FxHashMap;
use std::ops::Range;

/// Everything of a file that matters.
#[derive(Default)]
pub(super) struct GmlTables {
    /// Corners of all polygons, as the file has them.
    pub points: Vec<DVec3>,
    /// The end of each ring in `points`.
    pub ends: Vec<usize>,
    pub polygons: Vec<GmlPolygon>,
    /// The members of geometries.
    pub members: Vec<GmlMember>,
    pub geometries: Vec<GmlGeometry>,
    pub objects: Vec<GmlObject>,
    /// The geometries to which `gml:id`s refer.
    pub ids: FxHashMap<String, NamedGml>,
    /// The first reference system that is named.
    pub system: Option<String>,
    /// The number of geometries that name another system.
    pub other_systems: u64,
    pub tally: LeftOutTally,
}

/// A polygon: corners and ring ends in the tables.
#[derive(Clone)]
pub(super) struct GmlPolygon {
    pub points: Range<usize>,
    pub ends: Range<usize>,
}

/// What a geometry is made of.
pub(super) struct GmlMember {
    pub what: GmlMemberKind,
    /// Whether it is seen from behind.
    pub is_turned: bool,
}

/// A polygon, or a reference to something else.
pub(super) enum GmlMemberKind {
    Polygon(usize),
    Reference(String),
}

/// What an id names.
#[derive(Clone)]
pub(super) enum NamedGml {
    Polygon(usize),
    /// Members of a surface, a shell or a solid.
    Members(Range<usize>),
}

/// A geometry of an object, or of one of the surfaces around it.
pub(super) struct GmlGeometry {
    pub object: usize,
    /// `RoofSurface`; empty for the object's own geometry.
    pub surface: String,
    pub lod: u8,
    pub is_solid: bool,
    pub members: Range<usize>,
}

/// A building, a part of one, a tree.
pub(super) struct GmlObject {
    pub kind: String,
    pub id: String,
    pub name: Option<String>,
    /// The number of its element, by which its parts refer to it.
    pub serial: u64,
    /// The elements around it, from the outermost, with their ids.
    pub around: Vec<(u64, String)>,
}
