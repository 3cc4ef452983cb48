//! The sums of a study: in memory, or in a file if the plan is done in tiles.

use crate::deliver::disk::sums::SumsFile;
use crate::export::ExportError;
use crate::profile::{Shaded, ShadedCells, ShadedPart};
use std::ops::Range;
use std::sync::Arc;

/// Shaded time per cell.
pub enum Sums {
    /// The sums are in memory.
    Memory(Arc<Shaded>),
    /// The sums are read from a file, some cells at a time.
    File(SumsFile),
}

impl Sums {
    /// Returns an error if something could not be read since the file was opened; such cells were read as 0.
    pub(super) fn check(&self) -> Result<(), ExportError> {
        match self {
            Sums::Memory(_) => Ok(()),
            Sums::File(file) => file.check(),
        }
    }

    /// Loads all sums into memory.
    pub(super) fn in_memory(self) -> Result<Arc<Shaded>, ExportError> {
        let file = match self {
            Sums::Memory(shaded) => return Ok(shaded),
            Sums::File(file) => file,
        };
        let shaded = match file.part(0..file.cells()) {
            ShadedPart::One(cells) => Shaded::from(cells.into_owned()),
            ShadedPart::Two(cells) => Shaded::from(cells.into_owned()),
        };
        file.check()?;
        Ok(Arc::new(shaded))
    }
}

impl ShadedCells for Sums {
    fn cells(&self) -> usize {
        match self {
            Sums::Memory(shaded) => shaded.cells(),
            Sums::File(file) => file.cells(),
        }
    }

    fn part(&self, cells: Range<usize>) -> ShadedPart<'_> {
        match self {
            Sums::Memory(shaded) => shaded.part(cells),
            Sums::File(file) => file.part(cells),
        }
    }
}
