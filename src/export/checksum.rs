//! A checksum of a file's bytes, by which is checked what a study takes over from a stopped one.
//!
//! SipHash-1-3 in 64 bits. A CRC of 32 bits would do for flipped bits, but of another study's files one in four thousand
//! million would pass, and there are many masks; a number that withstands an attack would be slower, and nobody gains by one.

use siphasher::sip::SipHasher13;
use std::fs;
use std::hash::Hasher;
use std::path::Path;

/// The number of what was added so far, however it was cut into pieces.
#[derive(Clone, Default)]
pub struct Checksum(SipHasher13);

impl Checksum {
    /// Adds what comes next.
    pub fn add(&mut self, bytes: &[u8]) {
        self.0.write(bytes);
    }

    /// The number so far.
    pub fn number(&self) -> u64 {
        self.0.finish()
    }
}

/// Of a whole file; none where it cannot be read.
pub fn of_file(path: &Path) -> Option<u64> {
    fs::read(path).ok().map(|bytes| checksum(&bytes))
}

/// Of bytes that are there at once.
pub fn checksum(bytes: &[u8]) -> u64 {
    let mut checksum = Checksum::default();
    checksum.add(bytes);
    checksum.number()
}
