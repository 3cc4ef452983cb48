//! A checksum of a file's bytes, by which a study checks what it takes over from a stopped one.
//!
//! It is SipHash-1-3 in 64 bits. A CRC of 32 bits would detect flipped bits, but would accept one in four thousand
//! million of another study's files, and there are many masks. A hash that withstands an attack would be slower, and
//! nobody would gain by an attack.

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
