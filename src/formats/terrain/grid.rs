//! Heights on a raster.

use crate::formats::ModelFault;
use crate::message::message;
use glam::{DVec2, DVec3};

/// The most samples that a raster may have: 10,000 to a side.
const MAX_SAMPLES: u64 = 100_000_000;
/// Cells along the side of a square: in such squares a raster is thinned, which takes memory for all that they cover.
pub(super) const SQUARE: usize = 256;

/// Heights on a raster, row by row.
pub(super) struct HeightGrid {
    pub columns: usize,
    pub rows: usize,
    /// The heights in metres; NaN for missing ones.
    pub heights: Vec<f32>,
    /// The position of the first sample, in the file's coordinates.
    pub first: DVec2,
    /// The steps from one sample to the next in its row, and from one row to the next.
    pub steps: [DVec2; 2],
}

impl HeightGrid {
    /// The number of samples of a raster, if it is within limits.
    pub(super) fn counted(columns: u64, rows: u64) -> Result<usize, ModelFault> {
        let count = columns.checked_mul(rows).filter(|count| *count <= MAX_SAMPLES);
        let count = count.and_then(|count| usize::try_from(count).ok()).ok_or_else(|| too_many(columns, rows))?;
        let covered = [columns, rows].map(|side| side.next_multiple_of(SQUARE as u64));
        if covered[0].saturating_mul(covered[1]) > 2 * MAX_SAMPLES {
            let what = format!("has {columns} × {rows} heights, which is a strip and no terrain");
            return Err(message![what; "cut it to the surroundings of the place in a GIS"].into());
        }
        Ok(count)
    }

    /// The height at a sample; NaN if it is missing or beyond the raster.
    pub(super) fn height(&self, column: usize, row: usize) -> f32 {
        if column >= self.columns {
            return f32::NAN;
        }
        self.heights.get(row * self.columns + column).copied().unwrap_or(f32::NAN)
    }

    /// The position of a sample.
    pub(super) fn point(&self, column: usize, row: usize) -> DVec3 {
        let at = self.first + self.steps[0] * column as f64 + self.steps[1] * row as f64;
        at.extend(self.height(column, row).into())
    }

    /// The spacing of the samples, for a message; `unit` is that of the file's coordinates.
    pub(super) fn spacing(&self, unit: &str) -> String {
        let [across, down] = self.steps.map(|step| rounded(step.length()));
        if across == down {
            format!("{} apart", of_unit(across, unit))
        } else {
            format!("{across} × {down} {unit} apart")
        }
    }

    /// Whether the triangles of [`super::thin`] must be flipped to face up, given the directions of the rows.
    pub(super) fn is_mirrored(&self) -> bool {
        self.steps[0].perp_dot(self.steps[1]) < 0.0
    }
}

/// A length in a file's unit: `1 unit of its map`, `2 units of its map`.
pub(super) fn of_unit(length: f64, unit: &str) -> String {
    let one = [("units", "unit"), ("degrees", "degree")]
        .into_iter()
        .find_map(|(many, one)| Some(format!("1 {one}{}", unit.strip_prefix(many)?)));
    one.filter(|_| length == 1.0).unwrap_or_else(|| format!("{length} {unit}"))
}

/// Rounds to three digits, for messages.
fn rounded(number: f64) -> f64 {
    let digits = (2.0 - number.abs().log10().floor()).clamp(0.0, 12.0) as i32;
    let power = 10_f64.powi(digits);
    (number * power).round() / power
}

/// The error for a raster that is too large.
fn too_many(columns: u64, rows: u64) -> ModelFault {
    message![
        format!("has {columns} × {rows} heights, but a terrain may have at most {MAX_SAMPLES}");
        "cut it to the surroundings of the place in a GIS, or export it with larger cells"
    ]
    .into()
}
