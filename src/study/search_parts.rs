//! How much of a gap between two instants is searched at once, and the memory that this takes.

use crate::view::Bits;
use std::ops::Range;

/// So many cells are looked at before a listener is asked whether to go on: about what an instant takes.
const CELLS_AT_ONCE: usize = 1 << 22;
/// And no fewer rows, which are shared out among the processors.
const FEWEST_ROWS: usize = 1 << 8;
/// Of the cells of a tile that may all change in one gap, this part is searched at once, so that memory is bounded.
const PARTS: usize = 16;
/// Cells are counted in strips of this many rows, the squares in which neighbours are searched together.
const STRIP: usize = 8;
/// The memory for a cell that changes: its change in a list that may have grown to twice its length, among all changes,
/// and as seconds.
const CHANGE_BYTES: u64 = 64;

/// The memory that the search in gaps takes besides bits, bytes: for each cell, and for each column, as at least a strip
/// is searched at once.
pub(super) const SEARCH_BYTES: [u64; 2] = [CHANGE_BYTES / PARTS as u64, CHANGE_BYTES * STRIP as u64];

/// The rows that are searched at once.
pub(super) fn parts([before, after]: [&Bits; 2]) -> Vec<Range<usize>> {
    let (width, height) = (before.width as usize, before.height as usize);
    let (most_rows, most) = ((CELLS_AT_ONCE / width).max(FEWEST_ROWS), width * height / PARTS);
    let in_strip = STRIP * before.in_row();
    let strips = before.words.chunks(in_strip).zip(after.words.chunks(in_strip));
    let differing = |(before, after): (&[u64], &[u64])| {
        before.iter().zip(after).map(|(before, after)| (before ^ after).count_ones() as usize).sum::<usize>()
    };
    let (mut parts, mut part, mut count) = (Vec::new(), 0..0, 0);
    for differing in strips.map(differing) {
        if !part.is_empty() && (count + differing > most || part.len() + STRIP > most_rows) {
            parts.push(part.clone());
            (part, count) = (part.end..part.end, 0);
        }
        count += differing;
        part.end = (part.end + STRIP).min(height);
    }
    parts.push(part);
    parts
}
