//! What lies on the disk while a study works in a folder: the lock, what the study has done so far, and the files that
//! grow as it works.

pub mod bits;
pub mod sums;
pub mod unfinished;
pub mod workplace;
