//! A checksum of a file's bytes. A study uses it to verify what it takes over from a stopped one.
//!
//! It is SipHash-1-3 with 64 bits. A CRC of 32 bits would detect flipped bits, but would accept one wrong file in four
//! thousand million, and there are many masks. A cryptographic hash would be slower, and nobody gains by an attack
//! here.

use siphasher::sip::SipHasher13;
use std::fs;
use std::hash::Hasher;
use std::path::Path;

/// The checksum of all bytes added so far; how they are divided does not matter.
#[derive(Clone, Default)]
pub struct Checksum(SipHasher13);

impl Checksum {
    /// Adds the next bytes.
    pub fn add(&mut self, bytes: &[u8]) {
        self.0.write(bytes);
    }

    /// The checksum so far.
    pub fn number(&self) -> u64 {
        self.0.finish()
    }
}

/// The checksum of a whole file; `None` if it cannot be read.
pub fn of_file(path: &Path) -> Option<u64> {
    fs::read(path).ok().map(|bytes| checksum(&bytes))
}

/// The checksum of bytes in memory.
pub fn checksum(bytes: &[u8]) -> u64 {
    let mut checksum = Checksum::default();
    checksum.add(bytes);
    checksum.number()
}
