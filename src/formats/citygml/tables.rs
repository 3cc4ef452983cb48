//! The tables that a file is read into.

use crate::formats::left_out::LeftOutTally;
use glam::DVec3;
use rustc_hash::FxHashMap;
use std::ops::Range;

/// Everything that is kept of a file.
#[derive(Default)]
pub(super) struct GmlTables {
    /// Corners of all polygons, as in the file.
    pub points: Vec<DVec3>,
    /// The end of each ring in `points`.
    pub ends: Vec<usize>,
    pub polygons: Vec<GmlPolygon>,
    /// The members of geometries.
    pub members: Vec<GmlMember>,
    pub geometries: Vec<GmlGeometry>,
    pub objects: Vec<GmlObject>,
    /// The geometries by `gml:id`.
    pub ids: FxHashMap<String, NamedGml>,
    /// The first reference system in the file.
    pub system: Option<String>,
    /// The number of geometries in other systems.
    pub other_systems: u64,
    pub tally: LeftOutTally,
}

/// A polygon: its corners and the ends of its rings in the tables.
#[derive(Clone)]
pub(super) struct GmlPolygon {
    pub points: Range<usize>,
    pub ends: Range<usize>,
}

/// A member of a geometry.
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

/// What an id refers to.
#[derive(Clone)]
pub(super) enum NamedGml {
    Polygon(usize),
    /// Members of a surface, a shell or a solid.
    Members(Range<usize>),
}

/// A geometry of an object, or of one of its surfaces.
pub(super) struct GmlGeometry {
    pub object: usize,
    /// `RoofSurface`; empty for the object's own geometry.
    pub surface: String,
    pub lod: u8,
    pub is_solid: bool,
    pub members: Range<usize>,
}

/// A building, a part of one, a tree, and so on.
pub(super) struct GmlObject {
    pub kind: String,
    pub id: String,
    pub name: Option<String>,
    /// The number of its element, by which its parts refer to it.
    pub serial: u64,
    /// The enclosing elements, from the outermost, with their ids.
    pub around: Vec<(u64, String)>,
}
