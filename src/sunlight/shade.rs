//! Finds the seconds in which faces block the sun from a probe, for all days at once. It descends the cells of the
//! sky's band, each with only the faces that reach it.
//!
//! A cell that no face reaches is lit, and one that a single face fills is dark, without a look at its single days.
//! What remains are slots of single days. In each, the faces, nearest first, remove the seconds that they certainly
//! cover, until no second or no face is left. Seconds so close to a face's side that the polynomials cannot decide are
//! doubtful: the exact ray decides them.

use super::face_tree::{BoxContents, FaceTree, SeenFace, SunCoverage};
use super::sift::{Halfspace, Sureness, sift, sift_flat};
use super::sky_cells::{SunCell, SunCells, SunPyramid};
use super::sun_path::{MOST_OFF_RAD, SLOT_SECS, Second, SunPath, SunPiece};
use glam::{DVec3, Vec3};
use std::ops::Range;

/// What is known about a probe's day.
#[derive(Clone, Debug, Default)]
pub(super) struct Shade {
    /// Runs of seconds, first and last, in which the probe is certainly dark. They are unordered and may overlap.
    pub(super) dark: Vec<[Second; 2]>,
    /// Seconds that the exact ray decides, unless they are dark.
    pub(super) doubtful: Vec<Second>,
}

/// A face or a box of faces that may reach a cell.
#[derive(Clone, Copy)]
enum Candidate {
    Box(u32),
    /// By its index in [`Descent::faces`].
    Face(u32),
}

/// A probe's descent through the tree of cells.
struct Descent<'a> {
    tree: &'a FaceTree,
    cells: &'a SunCells,
    paths: &'a [SunPath<'a>],
    /// The probe, relative to the mesh's origin.
    point: DVec3,
    /// The probe's plane, as an obstacle for what is behind it.
    behind: Option<Halfspace>,
    /// A stack of what may reach the cells from the root to the current one; each cell's candidates follow its
    /// parent's.
    reaching: Vec<Candidate>,
    faces: Vec<SeenFace>,
    shades: Vec<Shade>,
    /// The number of tests of faces against cells and slots.
    tested: u64,
}

/// The shade of a probe on each of several days, and the number of tests of faces; `point` is relative to the mesh's
/// origin.
pub(super) fn shades(
    tree: &FaceTree,
    cells: &SunCells,
    paths: &[SunPath<'_>],
    (point, normal): (DVec3, Option<DVec3>),
) -> (Vec<Shade>, u64) {
    let behind = normal.map(|normal| Halfspace { normal: -normal, slack: 1e-15 });
    let shades = vec![Shade::default(); paths.len()];
    let (reaching, faces) = (Vec::new(), Vec::new());
    let mut descent = Descent { tree, cells, paths, point, behind, reaching, faces, shades, tested: 0 };
    descent.reaching.extend(tree.root().map(Candidate::Box));
    if let Some(root) = cells.root {
        descent.descend(root, 0, normal.is_none());
    }
    (descent.shades, descent.tested)
}

impl<'a> Descent<'a> {
    /// Visits a cell. Its parent's candidates begin at index `from`.
    fn descend(&mut self, cell: u32, from: usize, mut is_before: bool) {
        let cell: &'a SunCell = &self.cells.cells[cell as usize];
        let (to, faces) = (self.reaching.len(), self.faces.len());
        let mut start = from;
        if let Some(pyramid) = &cell.pyramid {
            if let Some(behind) = self.behind.filter(|_| !is_before) {
                let values = pyramid.corners.map(|corner| behind.normal.dot(corner));
                if values.iter().all(|value| *value > MOST_OFF_RAD) {
                    return self.darken(cell);
                }
                is_before = values.iter().all(|value| *value < -MOST_OFF_RAD);
            }
            if cell.halves.is_empty() {
                self.look_at_slot(cell, pyramid, from..to, is_before);
                return self.faces.truncate(faces);
            }
            start = to;
            if self.filter(from..to, pyramid) {
                self.darken(cell);
                self.reaching.truncate(to);
                return self.faces.truncate(faces);
            }
            if self.reaching.len() == start && is_before {
                return self.faces.truncate(faces);
            }
        }
        if cell.halves.is_empty() {
            // cannot happen, as no slot is that long; if it did, every second would be decided exactly
            for shade in &mut self.shades[cell.days.clone()] {
                shade.doubtful.extend(cell.slots.start * SLOT_SECS..cell.slots.end * SLOT_SECS);
            }
        }
        for half in &cell.halves {
            self.descend(*half, start, is_before);
        }
        self.reaching.truncate(to);
        self.faces.truncate(faces);
    }

    /// Marks a whole cell as dark.
    fn darken(&mut self, cell: &SunCell) {
        let run = [cell.slots.start * SLOT_SECS, cell.slots.end * SLOT_SECS - 1];
        for shade in &mut self.shades[cell.days.clone()] {
            shade.dark.push(run);
        }
    }

    /// Adds those candidates that reach a pyramid, and opens large boxes. Returns whether one face fills the pyramid.
    fn filter(&mut self, of: Range<usize>, pyramid: &SunPyramid) -> bool {
        let mut open: Vec<u32> = Vec::new();
        for at in of {
            match self.reaching[at] {
                Candidate::Face(face) => {
                    self.tested += 1;
                    match self.faces[face as usize].coverage(pyramid) {
                        SunCoverage::Full => return true,
                        SunCoverage::Part => self.reaching.push(Candidate::Face(face)),
                        SunCoverage::None => {}
                    }
                }
                Candidate::Box(at) => open.push(at),
            }
            while let Some(at) = open.pop() {
                let seen = self.tree.seen(at, self.point);
                if seen.is_outside(pyramid) {
                    continue;
                }
                if !seen.is_large(pyramid) {
                    self.reaching.push(Candidate::Box(at));
                    continue;
                }
                match self.tree.within(at) {
                    BoxContents::Boxes(boxes) => open.extend(boxes),
                    BoxContents::Faces(faces) => {
                        if faces.iter().any(|corners| self.add_face(corners, pyramid)) {
                            return true;
                        }
                    }
                }
            }
        }
        false
    }

    /// Adds a face if it reaches a pyramid. Returns whether it fills it.
    fn add_face(&mut self, corners: &[Vec3; 3], pyramid: &SunPyramid) -> bool {
        self.tested += 1;
        let face = SeenFace::new(corners, self.point);
        let coverage = face.coverage(pyramid);
        if coverage == SunCoverage::Part {
            self.reaching.push(Candidate::Face(self.faces.len() as u32));
            self.faces.push(face);
        }
        coverage == SunCoverage::Full
    }

    /// Decides the slot of a single day.
    fn look_at_slot(&mut self, cell: &SunCell, pyramid: &SunPyramid, reaching: Range<usize>, is_before: bool) {
        let path = &self.paths[cell.days.start];
        let shade = &mut self.shades[cell.days.start];
        let (tree, point, faces, tested) = (self.tree, self.point, &self.faces, &mut self.tested);
        let mut open = OpenSeconds::new(path, cell.slots.start, pyramid);
        if let Some(behind) = self.behind.filter(|_| !is_before) {
            open.take(&[behind], [f64::NEG_INFINITY, f64::INFINITY], shade);
        }
        let far = |reaching: Candidate| match reaching {
            Candidate::Face(face) => (faces[face as usize].nearest(), reaching),
            Candidate::Box(at) => (tree.seen(at, point).nearest(), reaching),
        };
        let mut left: Vec<(f64, Candidate)> = self.reaching[reaching].iter().map(|reaching| far(*reaching)).collect();
        // a stack: the nearest is last
        left.sort_unstable_by(|one, other| other.0.total_cmp(&one.0));
        while let Some((_, next)) = left.pop() {
            if open.runs.is_empty() {
                return;
            }
            let at = match next {
                Candidate::Face(face) => {
                    *tested += 1;
                    open.shade(&faces[face as usize], shade);
                    continue;
                }
                Candidate::Box(at) => at,
            };
            let seen = tree.seen(at, point);
            if seen.is_outside(pyramid) || !open.reaches(seen.along(pyramid)) {
                continue;
            }
            match tree.within(at) {
                BoxContents::Boxes(two) => {
                    let mut two = two.map(|at| far(Candidate::Box(at)));
                    if two[0].0 < two[1].0 {
                        two.reverse();
                    }
                    left.extend(two);
                }
                BoxContents::Faces(faces) => {
                    *tested += faces.len() as u64;
                    faces.iter().for_each(|corners| open.shade(&SeenFace::new(corners, point), shade));
                }
            }
        }
    }
}

/// The seconds of a slot that nothing covers so far.
struct OpenSeconds<'a> {
    /// Runs of seconds, each within one piece, with their extent along the direction of time.
    runs: Vec<([Second; 2], [f64; 2], &'a SunPiece)>,
    pyramid: &'a SunPyramid,
}

impl<'a> OpenSeconds<'a> {
    fn new(path: &'a SunPath<'_>, slot: i32, pyramid: &'a SunPyramid) -> OpenSeconds<'a> {
        let from = path.pieces.partition_point(|piece| piece.first < slot * SLOT_SECS);
        let to = path.pieces.partition_point(|piece| piece.first < (slot + 1) * SLOT_SECS);
        let mut open = OpenSeconds { runs: Vec::new(), pyramid };
        for piece in &path.pieces[from..to] {
            open.runs.push(open.run([piece.first, piece.last], piece));
        }
        open
    }

    fn run(&self, seconds: [Second; 2], piece: &'a SunPiece) -> ([Second; 2], [f64; 2], &'a SunPiece) {
        let along = seconds.map(|second| {
            let to_sun = piece.to_sun(second);
            self.pyramid.along.dot(to_sun) / self.pyramid.axis.dot(to_sun)
        });
        (seconds, [along[0].min(along[1]) - MOST_OFF_RAD, along[0].max(along[1]) + MOST_OFF_RAD], piece)
    }

    /// Whether an obstacle with this extent along the direction of time reaches an open second.
    fn reaches(&self, [low, high]: [f64; 2]) -> bool {
        self.runs.iter().any(|(_, along, _)| along[0] <= high && low <= along[1])
    }

    /// Removes what a face covers.
    fn shade(&mut self, face: &SeenFace, shade: &mut Shade) {
        if face.is_beside(self.pyramid) {
            return;
        }
        if face.is_flat {
            for (seconds, _, piece) in &self.runs {
                sift_flat(&face.sides, piece, *seconds, &mut |second| shade.doubtful.push(second));
            }
        } else {
            self.take(&face.sides, face.along(self.pyramid), shade);
        }
    }

    /// Removes what halfspaces cover together.
    fn take<const N: usize>(&mut self, halfspaces: &[Halfspace; N], [low, high]: [f64; 2], shade: &mut Shade) {
        let mut at = 0;
        while at < self.runs.len() {
            let (seconds, along, piece) = self.runs[at];
            if along[0] > high || low > along[1] {
                at += 1;
                continue;
            }
            let mut covered: Vec<[Second; 2]> = Vec::new();
            sift(halfspaces, piece, seconds, &mut |verdict, first, last| match verdict {
                Sureness::Above => match covered.last_mut() {
                    Some(run) if run[1] + 1 == first => run[1] = last,
                    _ => covered.push([first, last]),
                },
                Sureness::Doubtful => shade.doubtful.extend(first..=last),
            });
            if covered.is_empty() {
                at += 1;
                continue;
            }
            shade.dark.extend(&covered);
            let left = without(seconds, &covered).map(|seconds| self.run(seconds, piece)).collect::<Vec<_>>();
            let count = left.len();
            self.runs.splice(at..=at, left);
            at += count;
        }
    }
}

/// A run of seconds minus ordered runs within it.
fn without([first, last]: [Second; 2], runs: &[[Second; 2]]) -> impl Iterator<Item = [Second; 2]> + '_ {
    let starts = std::iter::once(first).chain(runs.iter().map(|run| run[1] + 1));
    let ends = runs.iter().map(|run| run[0] - 1).chain(std::iter::once(last));
    starts.zip(ends).filter(|(start, end)| start <= end).map(|(start, end)| [start, end])
}
