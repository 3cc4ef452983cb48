//! The request: the site file and the models that it names, checked once.
//!
//! [`Site`] is the checked request: in it nothing is optional, relative to a file, or unchecked.

mod anchored_zero;
mod asked_value;
mod camera;
mod choice;
mod contents;
mod csv_lines;
mod dates;
mod demolished;
mod error;
mod extent;
#[doc(hidden)]
pub mod file;
mod georeference;
mod given_by_file;
mod ground;
mod in_memory;
mod inputs;
mod judged;
#[doc(hidden)]
pub mod judged_tables;
mod key_notes;
mod key_table;
mod keys;
mod laid;
mod layers;
mod left_out;
mod likeness;
mod load;
mod located;
mod mark;
mod model_bounds;
mod model_place;
mod model_table;
mod models;
mod names;
mod notes;
mod on_terrain;
mod overrides;
mod pair;
mod place_doubts;
mod placed_model;
mod placement;
mod plan;
mod points_file;
mod probe;
mod rewrite;
mod stand;
mod standing;
mod study;
mod terrain;
#[doc(hidden)]
pub mod typed;
mod written;

#[doc(hidden)]
pub use contents::{ModelContents, NameGroup};
pub use error::{FieldLocation, SiteError};
#[doc(hidden)]
pub use given_by_file::GivenByFile;
#[doc(hidden)]
pub use ground::metres;
pub use ground::{Ground, GroundFrom, GroundKind};
#[doc(hidden)]
pub use inputs::inputs;
#[doc(hidden)]
pub use judged::{
    AreaSurface, JudgedArea, JudgedFacade, JudgedPlot, JudgedSite, JudgedState, JudgedWindow, PlotSide, load_judged,
    study_days,
};
#[cfg(feature = "desktop")]
pub(crate) use judged::{border_fault, judged_with_models};
#[doc(hidden)]
pub use key_table::{SITE_KEYS, SITE_TABLES, SiteKey, ValueType};
pub use likeness::{Likeness, Mend};
#[doc(hidden)]
pub use load::{CoordinateFrame, LoadedMesh, LoadedSun, load_mesh, load_sun};
#[doc(hidden)]
pub use model_place::{EarthPoint, ModelReference, anchor_text};
#[doc(hidden)]
pub use models::Models;
pub use overrides::Overrides;
#[doc(hidden)]
pub use pair::Pair;
#[doc(hidden)]
pub use placed_model::{PlacedModel, load_model};
#[doc(hidden)]
pub use placement::Placement;
#[doc(hidden)]
pub use probe::{ProbeSite, load_probes};
#[doc(hidden)]
pub use written::WrittenSite;

use crate::choice::{Engine, Finder, Method, Receivers, Settings};
use crate::mesh::Mesh;
use crate::message::{Message, Words};
use crate::sun::{Place, SunTrack};
use crate::view::{Camera, Elevation, Grid, Side, View};
use glam::DVec3;

/// The checked request: place, models, receivers, study.
#[derive(Clone, Debug)]
pub struct Site {
    /// The place on Earth where the models stand.
    pub place: Place,
    /// All models, welded, in the world frame.
    pub mesh: Mesh,
    /// Notes on how the models were read, and on the clock: sentences without a full stop. Those about a model name it.
    pub notes: Vec<Message>,
    /// The face's words for the fields of a request, for notes that go into files.
    pub words: &'static dyn Words,
    /// What was given by a site file, if there is one.
    #[doc(hidden)]
    pub by_file: GivenByFile,
    /// Models that look as if they had a different unit or up axis, with the keys that would correct them.
    pub likenesses: Vec<Likeness>,
    /// For each component, whether it casts.
    pub casts: Vec<bool>,
    /// For each component, whether it receives. A component that does not is looked through.
    pub receives: Vec<bool>,
    /// The ground.
    pub ground: Ground,
    /// The instants of the study.
    pub track: SunTrack,
    /// The plan.
    pub grid: Grid,
    /// The perspective view.
    pub camera: Camera,
    /// The side that is shown instead of the perspective, with as much of it as the perspective shows at its target.
    pub side: Option<Side>,
    /// The receivers of the study.
    pub receivers: Receivers,
    /// The side of a texel of [`Receivers::Patches`], metres.
    pub patch_cell: f64,
    /// The requested technique.
    pub method: Method,
    /// The requested finder of silhouettes.
    pub finder: Finder,
    /// The depth of the paper's hextree, if the request gives one.
    pub hextree_depth: Option<u32>,
    /// The requested machine.
    pub engine: Engine,
    /// The settings of single techniques.
    pub settings: Settings,
}

impl Site {
    /// Returns for each component whether it is judged; the ground's plane is judged besides. Under
    /// [`Receivers::Ground`] only terrain is.
    pub fn judges(&self, receivers: Receivers) -> Vec<bool> {
        match (receivers, self.ground.kind) {
            (Receivers::Top | Receivers::Patches, _) => self.receives.clone(),
            (Receivers::Ground, GroundKind::Plane) => vec![false; self.mesh.components.len()],
            (Receivers::Ground, GroundKind::Terrain) => {
                let components = self.mesh.components.iter().zip(&self.receives);
                components.map(|(component, receives)| component.is_terrain && *receives).collect()
            }
        }
    }

    /// The view of the camera's picture: a side if one is requested, otherwise the perspective.
    pub fn picture(&self) -> View {
        match self.side {
            Some(side) => View::Elevation(self.camera.side(side)),
            None => View::Camera(self.camera),
        }
    }

    /// What a sun sees of all models, in a picture of the camera's size; at the scale that all suns of the study need. None
    /// for a sun that is not above the horizon.
    pub fn sun_view(&self, to_sun: DVec3) -> Option<View> {
        let is_up = |to_sun: &DVec3| to_sun.z > 0.0;
        let suns = self.track.instants.iter().map(|instant| instant.to_sun).filter(is_up);
        let (low, high) = self.mesh.bounds_at_home().unwrap_or((DVec3::ZERO, DVec3::ZERO));
        let above = (low.with_z(low.z.max(self.ground.level)), high.with_z(high.z.max(self.ground.level)));
        let size = [self.camera.width, self.camera.height];
        is_up(&to_sun).then(|| View::Elevation(Elevation::from_sun(to_sun, above, size, suns)))
    }
}
