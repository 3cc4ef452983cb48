//! Which side of a face is judged. An architect means the outer one, and windings cannot be trusted to show it.
//!
//! A *piece* is a set of faces that are connected by edges of two faces. Within it faces are turned one way by their
//! neighbours, whatever their winding; then the piece as a whole is turned:
//!
//! - A closed piece is judged on its outside, which its signed volume shows: a box turned inside out is still a box.
//!   The largest piece of a component sets the winding of the component; a piece wound the other way is taken for one
//!   turned inside out. But within the bounding box of a larger piece it may be a cavity of that, or stand in its
//!   courtyard: nothing shows which.
//! - An open piece that mostly looks upwards (roofs against soffits, of faces less steep than 60°) is judged on that
//!   side: terrain, or a sheet of roof with its walls. But where what looks up lies lower than the walls it may be a
//!   basin, or a house whose roof is another component: nothing shows which.
//! - For those pieces, for a closed sheet whose front and back are both in the file, and for any other open piece (a
//!   fence, walls without a roof, a twisted band), no outer side is known. They are judged on the side that faces the
//!   sun. Where walls of a single sheet enclose a room, the inner side is as dark as the room; sunlight that falls onto
//!   it through windows is counted, too.

use crate::mesh::planes::area_vector;
use crate::mesh::{Component, Mesh};
use glam::{DVec3, Vec3};

/// How one face is judged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct SeenSide {
    /// On the back of its winding.
    pub(super) turned: bool,
    /// On both sides.
    pub(super) both: bool,
}

/// Cosine of the tilt above which a face tells what is up: 60°.
const ROOF: f64 = 0.5;
/// Part of a piece's area that must be steep for it to have walls.
const WALLED: f64 = 0.1;
/// Part of a piece's area that must look up or down for that to tell its side.
const ROOFED: f64 = 0.02;
/// What has no such part of its area times its size as its volume bounds nothing.
const NO_VOLUME: f64 = 1e-9;
/// By which part of that area more must look one way than the other.
const CLEARLY: f64 = 0.5;

/// Faces that are connected by edges of two faces.
#[derive(Default)]
struct FacePiece {
    faces: Vec<u32>,
    /// No two of its neighbours can be turned one way.
    twisted: bool,
    open: bool,
    /// Signed, as its faces are turned to each other; around its first vertex.
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

/// How the faces of a component are judged, in their order; `edges` are the three of each face of the mesh.
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

/// The pieces, and per face which it is in. Turns each face as its piece's first.
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
                // neighbours that run along an edge the same way are wound against each other
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

/// Marks pieces with an edge along which their faces do not cancel.
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

/// Turns a piece to the side that most of its area has as its winding's, and measures it.
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

/// Whether an open piece looks up as it is turned, or down; nothing where that is not clear, or where walls stand
/// higher than what looks up.
fn upwards(mesh: &Mesh, piece: &FacePiece, first: u32, seen: &[SeenSide]) -> Option<bool> {
    let (mut roofs, mut up) = (0.0, 0.0);
    // area, and area times height, of what is level and of what is steep
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
