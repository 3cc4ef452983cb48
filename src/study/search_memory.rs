//! How many cells are searched at once for the times at which they change, and the memory that this takes.

/// Of the cells of a tile that may all change in one gap, this part is searched at once, so that memory is bounded.
pub(super) const PARTS: usize = 16;
/// Cells are counted in strips of this many rows, the squares in which neighbours are searched together.
pub(super) const STRIP: usize = 8;
/// The memory for a cell that changes: its change in a list that may have grown to twice its length, among all changes,
/// and as seconds.
const CHANGE_BYTES: u64 = 64;

/// The memory that the search in gaps takes besides bits, bytes: for each cell, and for each column, as at least a strip
/// is searched at once.
pub(super) const SEARCH_BYTES: [u64; 2] = [CHANGE_BYTES / PARTS as u64, CHANGE_BYTES * STRIP as u64];
