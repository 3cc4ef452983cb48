//! Why parts cannot become a mesh.

use super::Mesh;
use crate::message::kilometres;

/// Why there is no mesh.
#[derive(Debug, thiserror::Error)]
pub enum MeshError {
    /// Vertices and faces are counted in 32 bits, one of which says which way a face runs along an edge.
    #[error("the models hold {0} triangles, more than the {max} that Gnomon counts; leave parts out", max = Mesh::MOST_FACES)]
    TooLarge(usize),
    /// `f32` around one origin cannot hold it.
    #[error(
        "'{name}' reaches {far} from the middle of the models, where half a metre is lost; place it nearer to them, \
         leave it out of the file, or check its scale",
        far = kilometres(*km)
    )]
    TooWide {
        /// Which of the parts, from 0.
        part: usize,
        /// The component that reaches farthest.
        name: String,
        /// How far.
        km: f64,
    },
    /// `f32` around the origin that was given cannot hold it.
    #[error(
        "'{name}' reaches {far} from the given origin, where half a metre is lost; give an origin near the parts",
        far = kilometres(*km)
    )]
    FarFromOrigin {
        /// The component that reaches farthest.
        name: String,
        /// How far; infinite where the origin is no point.
        km: f64,
    },
    /// A coordinate is infinite or NaN.
    #[error("'{0}' has a corner that is not a point; give finite coordinates in metres")]
    NoPoint(String),
    /// A triangle names a corner that its part does not have.
    #[error("'{name}' has a triangle with corner {corner}, and only {corners} corners, counted from 0")]
    NoCorner {
        /// The part.
        name: String,
        /// The corner that is not there.
        corner: u32,
        /// How many there are.
        corners: usize,
    },
}
