//! Cuts a flat face with holes into triangles in O(n log n): a city's lakes and roads have a hundred thousand corners,
//! and ear clipping takes quadratic time if a face winds or has spikes.
//!
//! After de Berg et al., *Computational Geometry*, chapter 3: a sweep line moves down and cuts the face into monotone
//! pieces at its split and merge vertices; each piece is then cut from top to bottom. Corners of equal height are taken
//! from left to right. A face that crosses or touches itself may come out wrong: the caller compares the areas.

use glam::DVec2;
use std::cmp::Ordering;

/// The most edges in a block of the sweep line's list.
const BLOCK: usize = 512;

/// No corner.
const NONE: u32 = u32::MAX;

/// The triangles of rings that are consecutive in `points` and end at `ends`, all counter-clockwise, as corner indices;
/// `None` if the rings are inconsistent.
pub(super) fn triangles(points: &[[f64; 2]], ends: &[usize]) -> Option<Vec<[u32; 3]>> {
    let mut sweep = Sweep::of(points, ends)?;
    sweep.run()?;
    let faces = MonotonePieces::of(&sweep);
    let mut triangles = Vec::with_capacity(points.len());
    faces.each(&sweep, |piece| cut(&sweep, piece, &mut triangles));
    Some(triangles)
}

/// The rings, the edges that cross the sweep line, and the diagonals so far. An edge is identified by the corner where
/// it begins, and has the face on its left.
struct Sweep {
    points: Vec<DVec2>,
    next: Vec<u32>,
    before: Vec<u32>,
    /// The corners in use, from top to bottom.
    order: Vec<u32>,
    /// The downward edges that cross the line, from left to right, in blocks; no block is empty.
    line: Vec<Vec<u32>>,
    /// For each of these edges its helper: the lowest corner above the line that sees it.
    helper: Vec<u32>,
    /// Which corners are merge vertices.
    joins: Vec<bool>,
    diagonals: Vec<[u32; 2]>,
}

impl Sweep {
    fn of(points: &[[f64; 2]], ends: &[usize]) -> Option<Self> {
        let count = points.len();
        let mut sweep = Self {
            points: points.iter().map(|&point| DVec2::from(point)).collect(),
            next: vec![NONE; count],
            before: vec![NONE; count],
            order: Vec::with_capacity(count),
            line: Vec::new(),
            helper: vec![NONE; count],
            joins: vec![false; count],
            diagonals: Vec::new(),
        };
        let mut start = 0;
        for &end in ends {
            let ring = u32::try_from(start).ok()?..u32::try_from(end).ok()?;
            sweep.add_ring(ring.collect(), start == 0)?;
            start = end;
        }
        let mut order = std::mem::take(&mut sweep.order);
        order.sort_unstable_by(|&a, &b| sweep.height_order(a, b));
        sweep.order = order;
        Some(sweep)
    }

    /// Links a ring, the outer one counter-clockwise and holes clockwise. Repeated corners are left out.
    fn add_ring(&mut self, mut ring: Vec<u32>, is_outer: bool) -> Option<()> {
        ring.dedup_by_key(|corner| self.points.get(*corner as usize).map(|at| at.to_array().map(f64::to_bits)));
        while ring.len() > 1 && self.at(*ring.first()?) == self.at(*ring.last()?) {
            ring.pop();
        }
        let first = self.at(*ring.first()?);
        let pairs = ring.iter().zip(ring.iter().cycle().skip(1));
        let area: f64 = pairs.map(|(&a, &b)| (self.at(a) - first).perp_dot(self.at(b) - first)).sum();
        if ring.len() < 3 || area == 0.0 {
            // a hole without area has no effect
            return (!is_outer).then_some(());
        }
        if (area > 0.0) != is_outer {
            ring.reverse();
        }
        for (&a, &b) in ring.iter().zip(ring.iter().cycle().skip(1)) {
            *self.next.get_mut(a as usize)? = b;
            *self.before.get_mut(b as usize)? = a;
        }
        self.order.extend(ring);
        Some(())
    }

    fn at(&self, corner: u32) -> DVec2 {
        self.points.get(corner as usize).copied().unwrap_or(DVec2::NAN)
    }

    /// The order of two corners from top to bottom.
    fn height_order(&self, a: u32, b: u32) -> Ordering {
        let ([ax, ay], [bx, by]) = (self.at(a).to_array(), self.at(b).to_array());
        by.total_cmp(&ay).then(ax.total_cmp(&bx)).then(a.cmp(&b))
    }

    fn is_above(&self, a: u32, b: u32) -> bool {
        self.height_order(a, b) == Ordering::Less
    }

    /// Twice the area of a triangle of corners, positive if it is counter-clockwise.
    fn turn(&self, [a, b, c]: [u32; 3]) -> f64 {
        let from = self.at(a);
        (self.at(b) - from).perp_dot(self.at(c) - from)
    }

    fn next(&self, corner: u32) -> u32 {
        self.next.get(corner as usize).copied().unwrap_or(NONE)
    }

    fn before(&self, corner: u32) -> u32 {
        self.before.get(corner as usize).copied().unwrap_or(NONE)
    }

    /// Finds the diagonals; `None` if an edge is not where it should be, as happens if rings cross.
    fn run(&mut self) -> Option<()> {
        for at in 0..self.order.len() {
            let corner = *self.order.get(at)?;
            let (before, next) = (self.before(corner), self.next(corner));
            let is_convex = self.turn([before, corner, next]) > 0.0;
            match (self.is_above(before, corner), self.is_above(next, corner)) {
                // both sides begin here: a start or split vertex
                (false, false) => {
                    if !is_convex {
                        self.see_from(corner, true)?;
                    }
                    self.insert(corner);
                }
                // both sides end here: an end or merge vertex
                (true, true) => {
                    self.close(before, corner)?;
                    if !is_convex {
                        self.see_from(corner, false)?;
                        *self.joins.get_mut(corner as usize)? = true;
                    }
                }
                // the face is on the right
                (true, false) => {
                    self.close(before, corner)?;
                    self.insert(corner);
                }
                (false, true) => self.see_from(corner, false)?,
            }
        }
        Some(())
    }

    /// Connects a corner with the edge on its left: adds a diagonal to the helper of that edge if the helper is a merge
    /// vertex or the corner is a split vertex, and makes the corner the helper.
    fn see_from(&mut self, corner: u32, divides: bool) -> Option<()> {
        let (block, at) = self.place(corner);
        let left = *self.line.get(block)?.get(at.checked_sub(1)?)?;
        let helper = *self.helper.get(left as usize)?;
        if divides || self.joins.get(helper as usize).copied()? {
            self.diagonals.push([corner, helper]);
        }
        *self.helper.get_mut(left as usize)? = corner;
        Some(())
    }

    /// Removes the edge that ends at a corner.
    fn close(&mut self, edge: u32, corner: u32) -> Option<()> {
        let helper = *self.helper.get(edge as usize)?;
        if self.joins.get(helper as usize).copied()? {
            self.diagonals.push([corner, helper]);
        }
        let (mut block, mut at) = self.place(corner);
        if self.line.get(block)?.len() == at {
            (block, at) = (block + 1, 0);
        }
        let edges = self.line.get_mut(block)?;
        if edges.get(at) != Some(&edge) {
            return None;
        }
        edges.remove(at);
        if edges.is_empty() {
            self.line.remove(block);
        }
        Some(())
    }

    /// Inserts the edge that begins at a corner, with the corner as its helper.
    fn insert(&mut self, corner: u32) {
        if let Some(helper) = self.helper.get_mut(corner as usize) {
            *helper = corner;
        }
        let (block, at) = self.place(corner);
        let Some(edges) = self.line.get_mut(block) else {
            self.line.push(vec![corner]);
            return;
        };
        edges.insert(at, corner);
        if edges.len() > BLOCK {
            let half = edges.split_off(BLOCK / 2);
            self.line.insert(block + 1, half);
        }
    }

    /// The position of a corner on the line: the block, and the number of its edges to the left of the corner.
    fn place(&self, corner: u32) -> (usize, usize) {
        let is_left = |edge: &u32| self.turn([*edge, self.next(*edge), corner]) > 0.0;
        let blocks = self.line.partition_point(|edges| edges.first().is_some_and(is_left));
        let Some(block) = blocks.checked_sub(1) else { return (0, 0) };
        (block, self.line.get(block).map_or(0, |edges| edges.partition_point(is_left)))
    }
}

/// The pieces between edges and diagonals.
struct MonotonePieces {
    /// Both directions of each diagonal, sorted by their start, and there counter-clockwise from the edge.
    ways: Vec<[u32; 2]>,
    /// The index of each one's opposite direction.
    back: Vec<usize>,
    /// The first entry of each corner in `ways`, and the end.
    first: Vec<usize>,
}

impl MonotonePieces {
    fn of(sweep: &Sweep) -> Self {
        let both = sweep.diagonals.iter().flat_map(|&[a, b]| [[a, b], [b, a]]);
        let angle = |[from, to]: [u32; 2]| {
            let way = |to: u32| (sweep.at(to) - sweep.at(from)).to_angle();
            (way(to) - way(sweep.next(from))).rem_euclid(std::f64::consts::TAU)
        };
        let mut ways: Vec<(u32, f64, usize, u32)> =
            both.enumerate().map(|(number, way)| (way[0], angle(way), number, way[1])).collect();
        ways.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.cmp(&b.2)));
        let mut place = vec![0; ways.len()];
        for (at, &(_, _, number, _)) in ways.iter().enumerate() {
            place[number] = at;
        }
        let mut first = vec![0; sweep.points.len() + 1];
        for &(from, ..) in &ways {
            first[from as usize + 1] += 1;
        }
        for corner in 1..first.len() {
            first[corner] += first[corner - 1];
        }
        let back = ways.iter().map(|&(_, _, number, _)| place[number ^ 1]).collect();
        Self { ways: ways.iter().map(|&(from, _, _, to)| [from, to]).collect(), back, first }
    }

    /// Calls the function with the corners of each piece, counter-clockwise.
    fn each(&self, sweep: &Sweep, mut each: impl FnMut(&[u32])) {
        let mut is_done = vec![false; sweep.points.len() + self.ways.len()];
        let mut piece = Vec::new();
        for &start in &sweep.order {
            // every piece has an edge, or a diagonal that begins at one of its corners
            let from_here = self.first[start as usize]..self.first[start as usize + 1];
            for first in std::iter::once(start as usize).chain(from_here.map(|way| sweep.points.len() + way)) {
                piece.clear();
                let mut step = first;
                while !std::mem::replace(&mut is_done[step], true) {
                    let (from, next) = self.follow(sweep, step);
                    piece.push(from);
                    step = next;
                }
                if piece.len() > 2 {
                    each(&piece);
                }
            }
        }
    }

    /// Where an edge or a diagonal begins, and the next one around its piece: the first clockwise at its end.
    fn follow(&self, sweep: &Sweep, step: usize) -> (u32, usize) {
        let count = sweep.points.len();
        let Some(way) = step.checked_sub(count) else {
            let (from, to) = (step as u32, sweep.next(step as u32));
            let last = self.first[to as usize + 1];
            return (from, if last > self.first[to as usize] { count + last - 1 } else { to as usize });
        };
        let [from, to] = self.ways[way];
        let back = self.back[way];
        (from, if back > self.first[to as usize] { count + back - 1 } else { to as usize })
    }
}

/// Cuts a monotone piece.
fn cut(sweep: &Sweep, piece: &[u32], triangles: &mut Vec<[u32; 3]>) {
    let mut push = |[a, b, c]: [u32; 3]| {
        triangles.push(if sweep.turn([a, b, c]) < 0.0 { [a, c, b] } else { [a, b, c] });
    };
    if let [a, b, c] = *piece {
        return push([a, b, c]);
    }
    let ends = |pick: Ordering| {
        let better = |&a: &usize, &b: &usize| if sweep.height_order(piece[b], piece[a]) == pick { b } else { a };
        (0..piece.len()).reduce(|a, b| better(&a, &b)).unwrap_or(0)
    };
    let (top, bottom) = (ends(Ordering::Less), ends(Ordering::Greater));
    // counter-clockwise from the top, the left side comes first
    let count = piece.len();
    let left = (bottom + count - top) % count;
    let mut corners: Vec<(u32, bool)> =
        (0..count).map(|step| (piece[(top + step) % count], step > 0 && step <= left)).collect();
    corners.sort_unstable_by(|a, b| sweep.height_order(a.0, b.0));
    let mut open: Vec<(u32, bool)> = corners[..2].to_vec();
    for (at, &(corner, is_left)) in corners.iter().enumerate().skip(2) {
        let last = open[open.len() - 1];
        if is_left != last.1 || at + 1 == count {
            open.windows(2).for_each(|pair| push([corner, pair[0].0, pair[1].0]));
            open = vec![last, (corner, is_left)];
            continue;
        }
        while let [.., before, last] = open[..] {
            let turn = sweep.turn([before.0, last.0, corner]);
            if if is_left { turn <= 0.0 } else { turn >= 0.0 } {
                break;
            }
            push([before.0, last.0, corner]);
            open.pop();
        }
        open.push((corner, is_left));
    }
}
