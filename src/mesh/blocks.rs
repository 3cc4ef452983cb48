//! Cuts a list of triangles into blocks that share no vertex, so that work that follows the triangles' connections can
//! be done block by block in parallel, with the same result.
//!
//! Files list triangles solid by solid, and number vertices in the same order. A cut is where all vertices before have
//! lower numbers than all vertices behind. A list without cuts, such as a terrain's, is one block.

use rayon::prelude::*;
use std::ops::Range;

/// The number of triangles in which one cut is searched.
const AT_ONCE: usize = 1 << 13;

/// Consecutive triangles, and the vertices that only they use.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct VertexBlock {
    /// The triangles.
    pub(crate) triangles: Range<usize>,
    /// The vertices: those of all blocks follow each other, and begin at 0.
    pub(crate) vertices: Range<usize>,
}

/// The blocks of some triangles with vertices below a number; at least one.
pub(crate) fn blocks(triangles: &[[u32; 3]], vertices: usize) -> Vec<VertexBlock> {
    let mut blocks = vec![VertexBlock { triangles: 0..triangles.len(), vertices: 0..vertices }];
    if triangles.len() <= AT_ONCE {
        return blocks;
    }
    let reaches: Vec<VertexReach> = triangles.par_chunks(AT_ONCE).map(VertexReach::of).collect();
    let mut before = reaches.clone();
    before.iter_mut().fold(VertexReach::NONE, |all, reach| all.and(&std::mem::replace(reach, all)));
    let mut behind = reaches;
    behind.iter_mut().rev().fold(VertexReach::NONE, |all, reach| all.and(&std::mem::replace(reach, all)));
    let others = before.par_iter().zip(&behind);
    let cuts: Vec<Option<(usize, u32)>> =
        triangles.par_chunks(AT_ONCE).zip(others).map(|(chunk, (before, behind))| cut(chunk, before, behind)).collect();
    for (chunk, (at, vertex)) in cuts.iter().enumerate().filter_map(|(chunk, cut)| Some((chunk, (*cut)?))) {
        let (at, vertex) = (chunk * AT_ONCE + at, vertex as usize);
        if let Some(last) = blocks.last_mut() {
            (last.triangles.end, last.vertices.end) = (at, vertex);
        }
        blocks.push(VertexBlock { triangles: at..triangles.len(), vertices: vertex..vertices });
    }
    blocks
}

/// The lowest and the highest vertex of some triangles.
#[derive(Clone, Copy)]
struct VertexReach {
    low: u32,
    high: u32,
}

impl VertexReach {
    const NONE: VertexReach = VertexReach { low: u32::MAX, high: 0 };

    fn of(triangles: &[[u32; 3]]) -> VertexReach {
        triangles
            .iter()
            .flatten()
            .fold(Self::NONE, |reach, &vertex| VertexReach { low: reach.low.min(vertex), high: reach.high.max(vertex) })
    }

    fn and(self, other: &VertexReach) -> VertexReach {
        VertexReach { low: self.low.min(other.low), high: self.high.max(other.high) }
    }
}

/// The first cut within a chunk: the triangle behind it, and the lowest vertex from there on. There is none before the
/// first triangle of all.
fn cut(chunk: &[[u32; 3]], before: &VertexReach, behind: &VertexReach) -> Option<(usize, u32)> {
    if before.high >= behind.low {
        return None;
    }
    let mut lowest = vec![behind.low; chunk.len()];
    chunk.iter().zip(&mut lowest).rev().fold(behind.low, |low, (triangle, lowest)| {
        *lowest = triangle.iter().fold(low, |low, &vertex| low.min(vertex));
        *lowest
    });
    let mut reach = *before;
    for (at, (triangle, &lowest)) in chunk.iter().zip(&lowest).enumerate() {
        let is_first = reach.low > reach.high;
        if !is_first && reach.high < lowest {
            return Some((at, lowest));
        }
        reach = reach.and(&VertexReach::of(&[*triangle]));
    }
    None
}
