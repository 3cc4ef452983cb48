//! Finds the side of a face that is judged. An architect means the outer one, and windings cannot be trusted to show
//! it.
//!
//! A *piece* is a set of faces that are connected by edges with two faces. First, faces within it are turned to match
//! their neighbours, whatever their winding; then the piece as a whole is turned:
//!
//! - A closed piece is judged on its outside, which its signed volume shows: a box turned inside out is still a box.
//!   The largest piece of a component sets the winding of the component, and a piece wound the other way is taken as
//!   turned inside out. But within the bounding box of a larger piece it may be a cavity of that, or stand in its
//!   courtyard: nothing shows which.
//! - An open piece that mostly faces up (roofs against soffits, of faces less steep than 60°) is judged on that side:
//!   terrain, or a sheet of roof with its walls. But if the faces that face up are lower than the walls, it may be a
//!   basin, or a house whose roof is another component: nothing shows which.
//! - For those pieces, for a closed sheet whose front and back are both in the file, and for any other open piece (a
//!   fence, walls without a roof, a twisted band), the outer side is unknown. They are judged on the side that faces the
//!   sun. If walls of a single sheet enclose a room, the inner side is as dark as the room; sunlight that enters through
//!   windows is counted, too.

use crate::mesh::planes::area_vector;
use crate::mesh::{Component, Mesh};
use glam::{DVec3, Vec3};

/// The side on which a face is judged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct SeenSide {
    /// On the back of its winding.
    pub(super) turned: bool,
    /// On either side.
    pub(super) both: bool,
}

/// The cosine of the tilt up to which a face counts as facing up or down: 60°.
const ROOF: f64 = 0.5;
/// The least steep share of its area for a piece to have walls.
const WALLED: f64 = 0.1;
/// The least share of its area that must face up or down to determine a piece's side.
const ROOFED: f64 = 0.02;
/// A piece with less volume, as a share of its area times its size, encloses nothing.
const NO_VOLUME: f64 = 1e-9;
/// By how much of that area one direction must outweigh the other.
const CLEARLY: f64 = 0.5;

/// Faces that are connected by edges with two faces.
#[derive(Default)]
struct FacePiece {
    faces: Vec<u32>,
    /// Whether its faces cannot all be turned to match.
    twisted: bool,
    open: bool,
    /// Signed, with its faces turned to match; relative to its first vertex.
    volume: f64,
    area: f64,
    low: Vec3,
    high: Vec3,
}

impl FacePiece {
    /// Whether it is closed and flat: a sheet whose front and back are both in the file.
    fn bounds_nothing(&self) -> bool {
        self.volume.abs() <= NO_VOLUME * self.area * f64::from(self.low.distance(self.high))
    }
}

/// The judged sides of a component's faces, in order; `edges` has three edges for each face of the mesh.
pub(super) fn of_faces(mesh: &Mesh, component: &Component, edges: &[[u32; 3]]) -> Vec<SeenSide> {
    let first = component.faces.start;
    let mut seen = vec![SeenSide::default(); component.faces.len()];
    let (mut pieces, piece_of) = pieces(mesh, component, edges, &mut seen);
    find_open(mesh, component, &piece_of, &seen, &mut pieces);
    for piece in &mut pieces {
        measure(mesh, piece, first, &mut seen);
    }

    let closed = || pieces.iter().filter(|piece| !piece.open && !piece.twisted);
    let largest = closed().max_by(|one, other| one.volume.abs().total_cmp(&other.volume.abs()));
    let hand = largest.map_or(1.0, |largest| 1.0f64.copysign(largest.volume));
    let holds = |outer: &FacePiece, inner: &FacePiece| {
        outer.volume * hand > -inner.volume * hand
            && outer.low.cmple(inner.low).all()
            && outer.high.cmpge(inner.high).all()
    };
    for piece in &pieces {
        let (turned, both) = if piece.twisted || !piece.open && piece.bounds_nothing() {
            (false, true)
        } else if piece.open {
            match upwards(mesh, piece, first, &seen) {
                Some(up) => (!up, false),
                None => (false, true),
            }
        } else if piece.volume * hand < 0.0 {
            (hand > 0.0, closed().any(|outer| holds(outer, piece)))
        } else {
            (hand < 0.0, false)
        };
        for face in &piece.faces {
            let seen = &mut seen[(face - first) as usize];
            seen.turned ^= turned;
            seen.both = both;
        }
    }
    seen
}

/// The pieces, and the piece of each face. Turns each face to match its piece's first face.
fn pieces(mesh: &Mesh, component: &Component, edges: &[[u32; 3]], seen: &mut [SeenSide]) -> (Vec<FacePiece>, Vec<u32>) {
    let first = component.faces.start;
    let mut piece_of = vec![u32::MAX; component.faces.len()];
    let mut pieces = Vec::new();
    for seed in component.faces.clone() {
        if piece_of[(seed - first) as usize] != u32::MAX {
            continue;
        }
        let number = pieces.len() as u32;
        let mut piece = FacePiece { faces: vec![seed], ..FacePiece::default() };
        piece_of[(seed - first) as usize] = number;
        let mut at = 0;
        while at < piece.faces.len() {
            let face = piece.faces[at];
            at += 1;
            for &edge in &edges[face as usize] {
                let &[one, other] = mesh.faces_at(edge as usize) else { continue };
                let neighbour = if one.face() == face { other.face() } else { one.face() };
                // neighbours that run along an edge in the same direction have opposite windings
                let turned = seen[(face - first) as usize].turned ^ (one.direction() == other.direction());
                let local = (neighbour - first) as usize;
                if piece_of[local] == u32::MAX {
                    piece_of[local] = number;
                    seen[local].turned = turned;
                    piece.faces.push(neighbour);
                } else {
                    piece.twisted |= seen[local].turned != turned;
                }
            }
        }
        pieces.push(piece);
    }
    (pieces, piece_of)
}

/// Marks pieces with an edge whose faces do not cancel.
fn find_open(mesh: &Mesh, component: &Component, piece_of: &[u32], seen: &[SeenSide], pieces: &mut [FacePiece]) {
    let first = component.faces.start;
    for edge in component.edges.clone() {
        let faces = mesh.faces_at(edge as usize);
        for incidence in faces {
            let piece = piece_of[(incidence.face() - first) as usize];
            let of_piece = faces.iter().filter(|it| piece_of[(it.face() - first) as usize] == piece);
            let along = |it: &crate::mesh::Incidence| {
                if seen[(it.face() - first) as usize].turned { -it.direction() } else { it.direction() }
            };
            if of_piece.map(along).sum::<i32>() != 0 {
                pieces[piece as usize].open = true;
            }
        }
    }
}

/// Turns a piece to the side that most of its area has by winding, and measures it.
fn measure(mesh: &Mesh, piece: &mut FacePiece, first: u32, seen: &mut [SeenSide]) {
    let area = |turned: bool, seen: &[SeenSide]| -> f64 {
        let of = piece.faces.iter().filter(|face| seen[(**face - first) as usize].turned == turned);
        of.map(|&face| area_vector(mesh, face).length()).sum()
    };
    let areas = [area(true, seen), area(false, seen)];
    if areas[0] > areas[1] {
        piece.faces.iter().for_each(|face| seen[(face - first) as usize].turned ^= true);
    }
    piece.area = areas[0] + areas[1];
    let corners = || piece.faces.iter().flat_map(|&face| mesh.corners(face as usize));
    piece.low = corners().fold(Vec3::INFINITY, Vec3::min);
    piece.high = corners().fold(Vec3::NEG_INFINITY, Vec3::max);
    let about = mesh.corners(piece.faces[0] as usize)[0].as_dvec3();
    let volume = |&face: &u32| {
        let [a, b, c] = mesh.corners(face as usize).map(|corner| corner.as_dvec3() - about);
        let volume = a.dot(b.cross(c)) / 6.0;
        if seen[(face - first) as usize].turned { -volume } else { volume }
    };
    piece.volume = piece.faces.iter().map(volume).sum();
}

/// Whether an open piece, as it is turned, faces up or down; `None` if that is unclear, or if its walls are higher than
/// the faces that face up.
fn upwards(mesh: &Mesh, piece: &FacePiece, first: u32, seen: &[SeenSide]) -> Option<bool> {
    let (mut roofs, mut up) = (0.0, 0.0);
    // area, and area times height, of level and of steep faces
    let (mut level, mut steep) = ([0.0; 2], [0.0; 2]);
    for &face in &piece.faces {
        let vector: DVec3 = area_vector(mesh, face);
        let (area, height) = (vector.length(), mesh.corners(face as usize).map(|corner| f64::from(corner.z)));
        let is_level = vector.z.abs() > ROOF * area;
        if is_level {
            roofs += vector.z.abs();
            up += if seen[(face - first) as usize].turned { -vector.z } else { vector.z };
        }
        let sums = if is_level { &mut level } else { &mut steep };
        sums[0] += area;
        sums[1] += area * height.iter().sum::<f64>() / 3.0;
    }
    let area = level[0] + steep[0];
    let is_walled = steep[0] > WALLED * area && steep[1] * level[0] > level[1] * steep[0];
    (roofs > ROOFED * area && up.abs() > CLEARLY * roofs && !is_walled).then_some(up > 0.0)
}
