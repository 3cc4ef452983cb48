//! Shaded time per cell.

/// Per cell the shaded time in 1/255 s, row 0 (north) first: one word of 32 bits, as a year of daylight just fits, or two
/// where a longer study needs them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Shaded(Words);

#[derive(Clone, Debug, PartialEq, Eq)]
enum Words {
    One(Vec<u32>),
    Two(Vec<u64>),
}

impl Shaded {
    /// How many cells there are.
    pub fn len(&self) -> usize {
        match &self.0 {
            Words::One(cells) => cells.len(),
            Words::Two(cells) => cells.len(),
        }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// A cell's, in 1/255 s.
    pub fn of(&self, cell: usize) -> u64 {
        match &self.0 {
            Words::One(cells) => cells[cell].into(),
            Words::Two(cells) => cells[cell],
        }
    }

    /// All cells', in 1/255 s.
    pub fn iter(&self) -> impl Iterator<Item = u64> {
        (0..self.len()).map(|cell| self.of(cell))
    }

    /// The cells, where one word is enough for each.
    pub fn in_one_word(&self) -> Option<&[u32]> {
        match &self.0 {
            Words::One(cells) => Some(cells),
            Words::Two(_) => None,
        }
    }
}

impl From<Vec<u32>> for Shaded {
    fn from(cells: Vec<u32>) -> Shaded {
        Shaded(Words::One(cells))
    }
}

impl From<Vec<u64>> for Shaded {
    /// One word where that is enough for all cells, so that equal sums are equal.
    fn from(cells: Vec<u64>) -> Shaded {
        match cells.iter().map(|&cell| u32::try_from(cell)).collect() {
            Ok(cells) => Shaded(Words::One(cells)),
            Err(_) => Shaded(Words::Two(cells)),
        }
    }
}
