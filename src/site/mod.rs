//! What is asked: the site file and the models it names, checked once.
//!
//! [`Site`] is the checked request. After it nothing is optional, relative to a file, or unproven.

mod asked;
mod camera;
mod choice;
mod error;
mod extent;
pub mod file;
mod keys;
mod load;
pub mod model;
mod plan;
mod study;
mod written;

pub use asked::Overrides;
pub use choice::ChoiceError;
pub use error::{At, SiteError};
pub use load::{Frame, load_mesh, load_sun};

use crate::mesh::Mesh;
use crate::sun::{Place, SunTrack};
use crate::view::{Camera, Grid};

/// Which surfaces are judged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Receivers {
    /// The highest receiving surface under each cell, ground included.
    #[default]
    Top,
    /// The ground plane, as if the buildings only cast.
    Ground,
}

/// How shadows are found, as the user asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Method {
    /// The fastest exact technique for the work.
    #[default]
    Auto,
    /// Stencil shadow volumes.
    Stencil,
    /// Ray casting.
    RayCast,
}

/// Which silhouette finder bounds the volumes, as the user asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Finder {
    /// The fastest that exists.
    #[default]
    Auto,
    /// One pass over all edges, on the processor.
    Brute,
    /// A search in dual space: classes of edges under a hierarchy, or with a depth the paper's tree.
    Hextree,
    /// One pass over all edges, on the graphics adapter.
    Gpu,
}

/// Which machine draws, as the user asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Engine {
    /// The graphics adapter where there is one, else the processor.
    #[default]
    Auto,
    /// The graphics adapter, or an error.
    Gpu,
    /// The processor.
    Cpu,
}

/// The checked request: place, models, receivers, study.
#[derive(Clone, Debug)]
pub struct Site {
    /// Where on earth.
    pub place: Place,
    /// All models, welded, in the world frame.
    pub mesh: Mesh,
    /// Per component: whether it casts.
    pub casts: Vec<bool>,
    /// Per component: whether it receives; what does not is looked through.
    pub receives: Vec<bool>,
    /// Height of the ground plane, metres.
    pub ground: f64,
    /// The instants asked.
    pub track: SunTrack,
    /// The plan.
    pub grid: Grid,
    /// The perspective view.
    pub camera: Camera,
    /// Which surfaces are judged.
    pub receivers: Receivers,
    /// How.
    pub method: Method,
    /// With which finder.
    pub finder: Finder,
    /// The depth of the paper's hextree, where that was asked.
    pub hextree_depth: Option<u32>,
    /// On which machine.
    pub engine: Engine,
}
