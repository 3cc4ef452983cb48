//! What is asked: the site file and the models it names, checked once.
//!
//! [`Site`] is the checked request. After it nothing is optional, relative to a file, or unproven.

mod asked;
mod camera;
mod choice;
mod contents;
mod dates;
mod error;
mod extent;
pub mod file;
mod georeference;
mod ground;
mod in_memory;
mod inputs;
mod key_table;
mod keys;
mod left_out;
mod likeness;
mod load;
mod model_place;
mod models;
mod names;
mod notes;
mod pair;
mod place_doubts;
mod placed_model;
mod placement;
mod plan;
mod probe;
mod rewrite;
mod stand;
mod study;
mod terrain;
pub mod typed;
mod written;

pub use asked::Overrides;
pub use contents::{ModelContents, NameGroup};
pub use error::{FieldLocation, SiteError};
pub use ground::{Ground, GroundFrom, metres};
pub use inputs::inputs;
pub use key_table::{SITE_KEYS, SITE_TABLES, SiteKey, ValueType};
pub use likeness::{Likeness, Mend};
pub use load::{CoordinateFrame, LoadedMesh, LoadedSun, load_mesh, load_sun};
pub use model_place::{ModelReference, anchor_text};
pub use models::Models;
pub use pair::Pair;
pub use placed_model::{PlacedModel, load_model};
pub use placement::Placement;
pub use probe::{ProbeSite, load_probes};
pub use written::WrittenSite;

pub use crate::choice::{Engine, Finder, Method, Receivers, Settings};

use crate::mesh::Mesh;
use crate::sun::{Place, SunTrack};
use crate::view::{Camera, Grid, Side, View};

/// The checked request: place, models, receivers, study.
#[derive(Clone, Debug)]
pub struct Site {
    /// Where on earth.
    pub place: Place,
    /// All models, welded, in the world frame.
    pub mesh: Mesh,
    /// What the user should know of how the models were read, each a sentence without its stop that names the model; and
    /// of the clock.
    pub notes: Vec<String>,
    /// What models look like that are not as they are read, with the keys that would mend them.
    pub likenesses: Vec<Likeness>,
    /// Per component: whether it casts.
    pub casts: Vec<bool>,
    /// Per component: whether it receives; what does not is looked through.
    pub receives: Vec<bool>,
    /// The ground plane.
    pub ground: Ground,
    /// The instants asked.
    pub track: SunTrack,
    /// The plan.
    pub grid: Grid,
    /// The perspective view.
    pub camera: Camera,
    /// The side that is seen instead, with as much of it as the perspective shows at its target.
    pub side: Option<Side>,
    /// Which surfaces are judged.
    pub receivers: Receivers,
    /// Side of a texel of [`Receivers::Surfaces`], metres.
    pub patch_cell: f64,
    /// How.
    pub method: Method,
    /// With which finder.
    pub finder: Finder,
    /// The depth of the paper's hextree, where that was asked.
    pub hextree_depth: Option<u32>,
    /// On which machine.
    pub engine: Engine,
    /// What was asked of single techniques.
    pub settings: Settings,
}

impl Site {
    /// What the camera's picture shows: a side, where one is asked, else the perspective.
    pub fn picture(&self) -> View {
        match self.side {
            Some(side) => View::Elevation(self.camera.side(side)),
            None => View::Camera(self.camera),
        }
    }
}
