//! Shaded time per cell.

use std::borrow::Cow;
use std::ops::Range;

/// The shaded time of each cell in 1/255 s, row 0 (north) first: in one 32-bit word per cell, which just holds a year
/// of daylight, or in two for longer studies.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Shaded(ShadedPart<'static>);

/// The shaded time of some cells, in memory or read from a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ShadedPart<'a> {
    /// One word per cell.
    One(Cow<'a, [u32]>),
    /// Two words per cell.
    Two(Cow<'a, [u64]>),
}

impl Default for ShadedPart<'_> {
    fn default() -> Self {
        ShadedPart::One(Cow::default())
    }
}

impl ShadedPart<'_> {
    /// The number of cells.
    pub fn len(&self) -> usize {
        match self {
            ShadedPart::One(cells) => cells.len(),
            ShadedPart::Two(cells) => cells.len(),
        }
    }

    /// Whether there are no cells.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The shaded time of a cell, in 1/255 s.
    pub fn of(&self, cell: usize) -> u64 {
        match self {
            ShadedPart::One(cells) => cells[cell].into(),
            ShadedPart::Two(cells) => cells[cell],
        }
    }
}

/// The shaded time of all cells of a plan, which can be read in parts, so that not everything has to be in memory.
pub trait ShadedCells: Sync {
    /// The number of cells.
    fn cells(&self) -> usize;

    /// The values of some cells.
    fn part(&self, cells: Range<usize>) -> ShadedPart<'_>;
}

impl ShadedCells for Shaded {
    fn cells(&self) -> usize {
        self.len()
    }

    fn part(&self, cells: Range<usize>) -> ShadedPart<'_> {
        match &self.0 {
            ShadedPart::One(all) => ShadedPart::One(Cow::Borrowed(&all[cells])),
            ShadedPart::Two(all) => ShadedPart::Two(Cow::Borrowed(&all[cells])),
        }
    }
}

impl Shaded {
    /// The number of cells.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether there are no cells.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The shaded time of a cell, in 1/255 s.
    pub fn of(&self, cell: usize) -> u64 {
        self.0.of(cell)
    }

    /// The shaded time of all cells, in 1/255 s.
    pub fn iter(&self) -> impl Iterator<Item = u64> {
        (0..self.len()).map(|cell| self.of(cell))
    }

    /// The cells, if one word per cell is enough; otherwise [`Shaded::in_two_words`] has them.
    pub fn in_one_word(&self) -> Option<&[u32]> {
        match &self.0 {
            ShadedPart::One(cells) => Some(cells),
            ShadedPart::Two(_) => None,
        }
    }

    /// The cells, if one word is not enough for some of them.
    pub fn in_two_words(&self) -> Option<&[u64]> {
        match &self.0 {
            ShadedPart::One(_) => None,
            ShadedPart::Two(cells) => Some(cells),
        }
    }
}

impl From<Vec<u32>> for Shaded {
    fn from(cells: Vec<u32>) -> Shaded {
        Shaded(ShadedPart::One(cells.into()))
    }
}

impl From<Vec<u64>> for Shaded {
    /// Uses one word per cell if that is enough for all, so that equal sums compare equal.
    fn from(cells: Vec<u64>) -> Shaded {
        match cells.iter().map(|&cell| u32::try_from(cell)).collect::<Result<Vec<u32>, _>>() {
            Ok(cells) => cells.into(),
            Err(_) => Shaded(ShadedPart::Two(cells.into())),
        }
    }
}
