//! The share of the sun that each cell sees: a byte per cell, or a bit.

use super::Tile;
use rayon::prelude::*;

/// The share of the sun that each cell sees at one instant: 255 all of it, 0 none.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mask {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// For each cell, the share of the sun that is seen, in 1/255, row 0 first.
    pub share: Vec<u8>,
}

/// The cells in shadow, for the sun as a point: one bit per cell.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bits {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// 1 in shadow, 0 where the sun is seen. Each row begins with its own word, and its first cell is the lowest bit.
    /// The unused bits of a row's last word are 0.
    pub words: Vec<u64>,
}

impl Bits {
    /// A raster without shadow.
    pub fn new(width: u32, height: u32) -> Bits {
        let words = vec![0; width.div_ceil(64) as usize * height as usize];
        Bits { width, height, words }
    }

    /// The cells of a mask that are in shadow: those that see at most half of the sun.
    pub fn of(mask: &Mask) -> Bits {
        let mut bits = Bits::new(mask.width, mask.height);
        let in_row = bits.in_row();
        let rows = bits.words.par_chunks_mut(in_row).zip(mask.share.par_chunks(mask.width as usize));
        rows.for_each(|(words, shares)| {
            for (word, shares) in words.iter_mut().zip(shares.chunks(64)) {
                let set = |word: u64, (at, share): (usize, &u8)| word | u64::from(*share <= 127) << at;
                *word = shares.iter().enumerate().fold(0, set);
            }
        });
        bits
    }

    /// Combines these bits word by word with those of another raster of the same size.
    pub(crate) fn with(&self, other: &Bits, of: impl Fn(u64, u64) -> u64) -> Bits {
        let words = self.words.iter().zip(&other.words).map(|(one, other)| of(*one, *other)).collect();
        Bits { words, ..*self }
    }

    /// Copies a tile's cells to their place on the plan. A tile's first column must be a multiple of 64.
    pub fn paste(&mut self, tile: &Tile, part: &Bits) {
        let [left, top] = tile.first.map(|first| first as usize);
        let in_row = self.in_row();
        for (row, words) in part.words.chunks(part.in_row()).enumerate() {
            let first = (top + row) * in_row + left / 64;
            self.words[first..first + words.len()].copy_from_slice(words);
        }
    }

    /// Whether a cell, by its index in row order, is in shadow.
    pub fn contains(&self, cell: usize) -> bool {
        let (row, column) = (cell / self.width as usize, cell % self.width as usize);
        self.words[row * self.in_row() + column / 64] >> (column % 64) & 1 == 1
    }

    /// The number of words in a row.
    pub(crate) fn in_row(&self) -> usize {
        self.width.div_ceil(64) as usize
    }

    /// The same with one byte per cell.
    pub fn mask(&self) -> Mask {
        let mut share = vec![0; self.width as usize * self.height as usize];
        let rows = share.par_chunks_mut(self.width as usize).zip(self.words.par_chunks(self.in_row()));
        rows.for_each(|(shares, words)| {
            for (shares, word) in shares.chunks_mut(64).zip(words) {
                for (shares, bits) in shares.chunks_mut(8).zip(word.to_le_bytes()) {
                    shares.copy_from_slice(&SHARES[usize::from(bits)][..shares.len()]);
                }
            }
        });
        Mask { width: self.width, height: self.height, share }
    }
}

/// For each value of eight bits, the shares of their cells.
const SHARES: [[u8; 8]; 256] = {
    let mut shares = [[255; 8]; 256];
    let mut at = 0;
    while at < 256 * 8 {
        if (at / 8) >> (at % 8) & 1 == 1 {
            shares[at / 8][at % 8] = 0;
        }
        at += 1;
    }
    shares
};
