//! A study's files on the disk while it works in a folder: the lock, its state, and the files that grow.

pub mod bits;
pub mod sums;
pub mod unfinished;
pub mod workplace;
