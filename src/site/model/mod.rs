//! Model files → parts. A stand-in: it has the names, and reads nothing yet.

use crate::mesh::Part;
use glam::DVec3;
use std::path::Path;

/// How a model is put into the world: scaled, turned by its north, then moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Radians clockwise from the model's north (−Z in glTF) to true north.
    pub north_rad: f64,
    /// Metres east, north and up.
    pub position: DVec3,
    /// Metres per model unit; above zero.
    pub scale: f64,
}

/// Why a model cannot be read; names the file.
#[derive(Debug, thiserror::Error)]
#[error("{0}: model files cannot be read yet")]
pub struct ModelError(String);

/// The parts of a model file, in the world frame.
///
/// # Errors
/// Always, until it reads.
pub fn load(path: &Path, _placement: &Placement) -> Result<Vec<Part>, ModelError> {
    Err(ModelError(path.display().to_string()))
}
