//! Why parts cannot become a mesh.

use super::Mesh;
use crate::message::kilometres;

/// Why parts cannot become a mesh.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MeshError {
    /// Too many faces: they are counted in 32 bits, one of which is a face's direction along an edge.
    #[error("the models have {0} triangles, more than the {max} that Gnomon supports; leave parts out", max = Mesh::MOST_FACES)]
    TooLarge(usize),
    /// `f32` around one origin would be too coarse.
    #[error(
        "'{name}' reaches {far} from the middle of the models, where coordinates lose half a metre of precision; place it nearer to them, \
         leave it out of the file, or check its scale",
        far = kilometres(*km)
    )]
    TooWide {
        /// The index of the part, from 0.
        part: usize,
        /// The component that extends the farthest.
        name: String,
        /// Its distance.
        km: f64,
    },
    /// `f32` around the given origin would be too coarse.
    #[error(
        "'{name}' reaches {far} from the given origin, where coordinates lose half a metre of precision; give an origin near the parts",
        far = kilometres(*km)
    )]
    FarFromOrigin {
        /// The component that extends the farthest.
        name: String,
        /// Its distance; infinite if the origin is not finite.
        km: f64,
    },
    /// A coordinate is infinite or NaN.
    #[error("'{0}' has a corner that is not a point; give finite coordinates in metres")]
    NoPoint(String),
    /// A triangle with an index out of range.
    #[error("'{name}' has a triangle with corner {corner}, but only {corners} corners, counted from 0")]
    NoCorner {
        /// The part.
        name: String,
        /// The index.
        corner: u32,
        /// The number of corners.
        corners: usize,
    },
}
