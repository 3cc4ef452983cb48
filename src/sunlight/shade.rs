//! Finds the seconds in which faces block the sun from a probe, for all days at once. It descends the cells of the
//! sky's band, each with only the faces that reach it.
//!
//! A cell that no face reaches is lit, and one that a single face fills is dark, without a look at its single days.
//! What remains are slots of single days. In each, the faces, nearest first, remove the seconds that they certainly
//! cover, until no second or no face is left. Seconds so close to a face's side that the polynomials cannot decide are
//! doubtful: the exact ray decides them.

use super::face_tree::{BoxContents, FaceTree, SeenBox, SeenCorners, SeenFace, SunCoverage};
use super::sift::{Halfspace, Sureness, sift, sift_flat};
use super::sky_cells::{SunCell, SunCells, SunPyramid};
use super::sun_path::{MOST_OFF_RAD, SLOT_SECS, Second, SunPath, SunPiece};
use super::wall_front::WallFront;
use glam::{DVec3, Vec3};
use std::ops::Range;

/// What is known about a probe's day.
#[derive(Clone, Debug, Default)]
pub(super) struct Shade {
    /// Runs of seconds, first and last, in which the probe is certainly dark. As found they are unordered and may
    /// overlap.
    pub(super) dark: Vec<[Second; 2]>,
    /// Seconds that the exact ray decides, unless they are dark.
    pub(super) doubtful: Vec<Second>,
}

impl Shade {
    /// Puts runs into their order, those that touch or overlap joined, and doubtful seconds, too.
    pub(super) fn put_in_order(&mut self) {
        self.dark.sort_unstable();
        self.dark.dedup_by(|next, run| {
            let joins = next[0] <= run[1] + 1;
            if joins {
                run[1] = run[1].max(next[1]);
            }
            joins
        });
        self.doubtful.sort_unstable();
        self.doubtful.dedup();
    }

    /// Adds more shade.
    pub(super) fn add(&mut self, more: Shade) {
        if more.dark.is_empty() && more.doubtful.is_empty() {
            return;
        }
        self.dark.extend(more.dark);
        self.doubtful.extend(more.doubtful);
        self.put_in_order();
    }
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
    /// Which faces cast, if not all do.
    front: Option<WallFront>,
    /// A stack of what may reach the cells from the root to the current one; each cell's candidates follow its
    /// parent's.
    reaching: Vec<Candidate>,
    faces: Vec<SeenFace>,
    /// For each day, runs of seconds that are known to be dark, in their order; empty if nothing is known.
    known: &'a [Vec<[Second; 2]>],
    shades: Vec<Shade>,
    /// The number of tests of faces against cells and slots.
    tested: u64,
}

/// The shade of a probe on each of several days, and the number of tests of faces; `point` and `front` are relative to the mesh's origin. Seconds that are
/// known to be dark are passed over: for each day their runs, in their order.
pub(super) fn shades(
    tree: &FaceTree,
    cells: &SunCells,
    paths: &[SunPath<'_>],
    (point, normal, front): (DVec3, Option<DVec3>, Option<WallFront>),
    known: &[Vec<[Second; 2]>],
) -> (Vec<Shade>, u64) {
    let behind = normal.map(|normal| Halfspace { normal: -normal, slack: 1e-15 });
    let shades = vec![Shade::default(); paths.len()];
    let (reaching, faces) = (Vec::new(), Vec::new());
    let mut descent = Descent { tree, cells, paths, point, behind, front, reaching, faces, known, shades, tested: 0 };
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
        if self.is_known(cell) {
            return;
        }
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

    /// Whether all of a cell is known to be dark.
    fn is_known(&self, cell: &SunCell) -> bool {
        let [first, last] = [cell.slots.start * SLOT_SECS, cell.slots.end * SLOT_SECS - 1];
        let covers = |runs: &Vec<[Second; 2]>| {
            let at = runs.partition_point(|run| run[1] < last);
            runs.get(at).is_some_and(|run| run[0] <= first)
        };
        !self.known.is_empty() && self.known[cell.days.clone()].iter().all(covers)
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
                if seen.is_outside(pyramid) || !self.may_cast(&seen) {
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

    /// Whether any face within a box may cast.
    fn may_cast(&self, seen: &SeenBox) -> bool {
        self.front.is_none_or(|front| seen.may_reach(&front, self.point))
    }

    /// Adds a face if it reaches a pyramid. Returns whether it fills it.
    fn add_face(&mut self, corners: &[Vec3; 3], pyramid: &SunPyramid) -> bool {
        if self.front.is_some_and(|front| !front.has(corners)) {
            return false;
        }
        self.tested += 1;
        let corners = SeenCorners::new(corners, self.point);
        if corners.is_beside(pyramid) {
            return false;
        }
        let face = SeenFace::new(corners);
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
        let (tree, point, front, faces, tested) = (self.tree, self.point, self.front, &self.faces, &mut self.tested);
        let mut open = OpenSeconds::new(path, cell.slots.start, pyramid);
        if let Some(known) = self.known.get(cell.days.start) {
            open.pass_over(known);
        }
        if let Some(behind) = self.behind.filter(|_| !is_before) {
            open.take(&[behind], [f64::NEG_INFINITY, f64::INFINITY], shade);
        }
        let far = |reaching: Candidate| match reaching {
            Candidate::Face(face) => (faces[face as usize].corners.nearest(), reaching),
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
                    open.shade(faces[face as usize].corners, Some(&faces[face as usize]), shade);
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
                    let casting = faces.iter().filter(|corners| front.is_none_or(|front| front.has(corners)));
                    for corners in casting {
                        *tested += 1;
                        open.shade(SeenCorners::new(corners, point), None, shade);
                    }
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

    /// Removes runs of seconds, which are in their order.
    fn pass_over(&mut self, known: &[[Second; 2]]) {
        let whole = std::mem::take(&mut self.runs);
        for ([first, last], _, piece) in whole {
            let from = known.partition_point(|run| run[1] < first);
            let within = known[from..].iter().take_while(|run| run[0] <= last);
            let covered: Vec<[Second; 2]> = within.map(|run| [run[0].max(first), run[1].min(last)]).collect();
            let left: Vec<_> = without([first, last], &covered).map(|seconds| self.run(seconds, piece)).collect();
            self.runs.extend(left);
        }
    }

    /// Removes what a face covers; `face` if it is known already.
    fn shade(&mut self, corners: SeenCorners, face: Option<&SeenFace>, shade: &mut Shade) {
        if corners.is_beside(self.pyramid) {
            return;
        }
        let along = corners.along(self.pyramid);
        if !self.reaches(along) {
            return;
        }
        let own;
        let face = match face {
            Some(face) => face,
            None => {
                own = SeenFace::new(corners);
                &own
            }
        };
        if face.is_flat {
            for (seconds, _, piece) in &self.runs {
                sift_flat(&face.sides, piece, *seconds, &mut |second| shade.doubtful.push(second));
            }
        } else {
            self.take(&face.sides, along, shade);
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
