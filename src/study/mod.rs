//! The flow: a checked request in, its shadow profile out.
//!
//! [`run`] and [`in_tiles`] read as the whole program does; [`instant`] is the same for one instant, seen from above or by a camera;
//! [`surfaces()`] is the study on facades and roofs; [`compare()`] is the study of two states of a site; [`verify`] holds
//! every technique against ray casting; [`probe`] finds when single points lie in the sun; [`frames()`] is every instant
//! as a picture; [`live`] draws one picture after another for whoever looks.

pub mod again;
mod compare;
mod fingerprint;
mod frames;
mod instant;
pub mod live;
mod machine;
pub mod probe;
mod profile;
mod stopwatch;
mod surfaces;
mod tiles;
pub mod verify;

pub use compare::{CompareOutcome, compare, compare_with};
pub use frames::{Frame, frames};
pub use instant::instant;
pub use profile::{TiledOutcome, TiledStudy, in_tiles, paste, run};
pub use stopwatch::Stopwatch;
pub use surfaces::{SurfaceOutcome, seen_receivers, surfaces};
pub use tiles::Budget;

use crate::choice::{Misfit, Subject};
use crate::gpu::GpuError;
use crate::mesh::Mesh;
use crate::message::{Field, Message, Piece, Worded, aside, message, pieces, plain_display};
use crate::picture::overlay::VolumePicture;
use crate::profile::{Profile, Provenance, Shaded, Statistics, Timings, Unfinished};
use crate::shadow::ray_cast::RayCast;
use crate::shadow::{GpuSurface, Scene, ShadowError, Technique, plan_surface};
use crate::site::{GroundKind, Receivers, Site};
use crate::sun::{SunError, SunTrack, Zone};
use crate::view::{Bits, Camera, FragmentCounts, Mask, Overlay, Surface, Tile, View};
use chrono::DateTime;
use glam::DVec3;
use machine::{Machine, not_surfaces};
use std::cell::RefCell;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

/// What is made beside the profile.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Wants {
    /// Every instant's mask, in [`Event::Drawn`].
    pub masks: bool,
    /// Of every instant with a sun which cells are in shadow, in [`Event::Drawn`].
    pub bits: bool,
    /// The folder to which whoever asks writes the masks, by its canonical name: a study that writes them elsewhere is
    /// another study.
    pub masks_in: Option<PathBuf>,
    /// Whether lines are drawn, which are made of all cells at once: tiles will not do.
    pub lines: bool,
    /// What the cells see, for a drawing.
    pub surface: bool,
    /// What counting took.
    pub statistics: bool,
    /// What is done so far, in [`Event::Kept`]: each time that so long has passed, and when the work is ended.
    pub keep_every: Option<Duration>,
    /// What memory there is for rasters; without one as much as they take.
    pub budget: Option<Budget>,
}

/// What is made beside the mask of one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct InstantWants {
    /// What the cells see, for a drawing.
    pub surface: bool,
    /// The layers of the shadow volumes before a camera's picture.
    pub volumes: bool,
    /// The silhouette's lines over a camera's picture.
    pub silhouette: bool,
    /// What counting took, cell by cell, and what it is for.
    pub counted: Option<CountingPurpose>,
}

/// What counting shadow volumes is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CountingPurpose {
    /// Numbers of the whole.
    Statistics,
    /// A diagram of what a map decided and what the volumes did.
    Mask,
    /// A diagram of how many fragments were counted.
    Overdraw,
}

impl CountingPurpose {
    /// The field that asks for it.
    fn field(self) -> Field {
        match self {
            CountingPurpose::Statistics => Field::Statistics,
            CountingPurpose::Mask => Field::MaskDiagram,
            CountingPurpose::Overdraw => Field::OverdrawDiagram,
        }
    }
}

/// What happens on the way.
#[derive(Clone, Debug)]
pub enum Event<'a> {
    /// Something that the user should know.
    Note(String),
    /// A graphics adapter failed, and the work is done again: what was told of it is void, but for notes.
    Anew,
    /// The same study is done again: whoever keeps what was done so far ([`Event::Kept`]) can put it here, and the study
    /// goes on from there.
    Resumes {
        /// The study.
        study: &'a TiledStudy<'a>,
        /// What is to be gone on from.
        begun: &'a RefCell<Option<Unfinished>>,
    },
    /// All is prepared; drawing begins.
    Started {
        /// How many instants there are, those of each tile counted.
        instants: usize,
        /// How many tiles there are.
        tiles: usize,
    },
    /// So many of them were done before, and are not drawn again.
    GoesOn {
        /// How many.
        done: usize,
    },
    /// A tile of the plan begins, or goes on: the next instants are its.
    Tile(Tile),
    /// The tile's sums, once all of its instants are done.
    Summed(Arc<Shaded>),
    /// One instant is done, in time's order for each tile.
    Drawn {
        /// From 0.
        index: usize,
        /// Of how many.
        count: usize,
        /// Local clock time of the place.
        time: DateTime<Zone>,
        /// Its mask, where masks are wanted.
        mask: Option<&'a Mask>,
        /// Which cells are in shadow, where that is wanted and there is a sun.
        bits: Option<&'a Bits>,
    },
    /// What is done so far, to be kept: with it the study can go on another time.
    Kept(&'a Unfinished),
    /// The study is done, and of what is made of it another stage is.
    Stage(&'static str),
}

/// Hears what happens; [`ControlFlow::Break`] ends the work with [`StudyError::Interrupted`].
pub type OnEvent<'a> = dyn FnMut(Event<'_>) -> ControlFlow<()> + 'a;

/// The answer to a study.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The shaded time.
    pub profile: Profile,
    /// What drew it.
    pub drawn: Provenance,
    /// What the cells see, where wanted: also under [`Receivers::Ground`] with the models.
    pub surface: Option<Surface>,
    /// Whose faces [`Surface::face`] counts.
    pub surface_mesh: Mesh,
    /// What counting took, where wanted.
    pub statistics: Option<Statistics>,
    /// `prepare` and `shadows`.
    pub timings: Timings,
}

/// The answer for one instant.
#[derive(Clone, Debug)]
pub struct InstantOutcome {
    /// Which part of the sun each cell sees.
    pub mask: Mask,
    /// What drew it.
    pub drawn: Provenance,
    /// What the cells see, where wanted.
    pub surface: Option<Surface>,
    /// Volumes and silhouette, where wanted and where there is a camera and a sun.
    pub overlay: Option<Overlay>,
    /// What counting took, where wanted and where there is a sun.
    pub counted: Option<FragmentCounts>,
    /// Whose faces [`Surface::face`] counts.
    pub surface_mesh: Mesh,
    /// `prepare` and `shadows`.
    pub timings: Timings,
}

/// Why there is no answer. One line each.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// Two choices that exclude each other.
    Conflict {
        /// What does not fit.
        field: Field,
        /// Why, and the way out.
        message: Message,
    },
    /// Technique, engine and settings that do not go together, or not with what is drawn.
    Misfit(#[from] Misfit),
    /// The plan does not fit the memory that there is for it.
    LittleMemory {
        /// What there is, bytes.
        asked: u64,
        /// What the smallest tile takes, bytes.
        least: u64,
        /// Columns of the plan.
        width: u32,
    },
    /// The plan is drawn at once, and has too many cells for that.
    TooManyCells {
        /// Columns of the plan.
        width: u32,
        /// Its rows.
        height: u32,
    },
    /// Time on surfaces is summed in 32 bits.
    TooLong {
        /// Seconds of the window with the sun above the horizon.
        day_secs: u32,
        /// How many can be summed.
        most_secs: u32,
    },
    /// Nothing that receives has an area.
    NoSurface,
    /// The track has no instant.
    NoInstant,
    /// No adapter, or not a good one.
    Gpu(#[from] GpuError),
    /// Volumes and silhouettes are the stencil's alone.
    NoVolumes(String),
    /// Techniques are held against ray casting where they draw.
    NoVerification(String),
    /// Every device failed on which what is asked was tried, and nothing else can do it.
    NoDevice(String),
    /// All instants are at night.
    NoDay,
    /// The sun's position at a time cannot be found.
    Sun(#[from] SunError),
    /// Drawing failed.
    Shadow(#[from] ShadowError),
    /// As asked by the listener.
    Interrupted,
}

plain_display!(StudyError);

impl Worded for StudyError {
    fn message(&self) -> Message {
        const DRIVER: &str = "install a driver (on Linux mesa-vulkan-drivers draws in software)";
        match self {
            StudyError::Conflict { field, message } => message.clone().of((*field).into()),
            StudyError::Misfit(misfit) => misfit.message(),
            StudyError::LittleMemory { asked, least, width } => message![
                Field::Memory,
                format!(": {} is too little for rows of {width} cells", tiles::amount(*asked));
                format!("take at least {}, or larger cells", tiles::amount(*least)), aside(Field::Cell)
            ],
            StudyError::TooManyCells { width, height } => message![
                format!("{width} × {height} cells are more than can be drawn at once");
                "choose larger cells",
                aside(Field::Cell),
                Piece::Where(Field::Size, pieces![" or fewer", aside(Field::Size)])
            ],
            StudyError::TooLong { day_secs, most_secs } => message![
                format!(
                    "the study has {} hours of daylight, and surfaces sum at most {}",
                    day_secs / 3600,
                    most_secs / 3600
                );
                "ask for fewer days or a shorter window"
            ],
            StudyError::NoSurface => {
                message!["no component that receives has a surface"; "see `receives` in the site file"]
            }
            StudyError::NoInstant => message!["there is no instant to draw"],
            StudyError::Gpu(error) => error.message(),
            StudyError::NoVolumes(why) => message![
                Field::Volumes,
                format!(": volumes and silhouette are drawn on a graphics adapter, and {why}");
                DRIVER, " or leave them out"
            ],
            StudyError::NoVerification(why) => message![
                format!("verify draws with every technique on a graphics adapter, and {why}");
                DRIVER
            ],
            StudyError::NoDevice(why) => message![
                why.clone(), ", after another device had failed, and what is asked is drawn on a graphics adapter alone";
                "update its driver, close what else draws on it, take larger cells, or install a driver that draws in \
                 software (on Linux mesa-vulkan-drivers)"
            ],
            StudyError::NoDay => message![
                "there is no sun at any of the study's instants, and nothing to compare";
                "take a window by day", Piece::Where(Field::From, pieces![" with ", Field::From, " and ", Field::To])
            ],
            StudyError::Sun(error) => error.message(),
            StudyError::Shadow(error) => error.message(),
            StudyError::Interrupted => message!["interrupted"],
        }
    }
}

impl StudyError {
    /// Whether the command line was wrong (exit status 2).
    pub fn is_wrong_use(&self) -> bool {
        use StudyError::{Conflict, LittleMemory, Misfit, TooManyCells};
        matches!(self, Conflict { .. } | Misfit(_) | LittleMemory { .. } | TooManyCells { .. })
    }

    /// What a graphics device failed of, where it did while working: on another one the work can be done.
    pub fn lost_device(&self) -> Option<&GpuError> {
        match self {
            StudyError::Gpu(error) | StudyError::Shadow(ShadowError::Gpu(error)) => Some(error),
            _ => None,
        }
        .filter(|error| matches!(error, GpuError::Lost { .. }))
    }
}

/// Where something asks what counting took.
const NOTHING_COUNTED: &str =
    "without a sun nothing is counted: there are no statistics, no mask and no overdraw to show";

/// Tells what the user should know of the models: how they were read, how exact they are, and where they stand.
///
/// # Errors
/// [`StudyError::Interrupted`] as asked by the listener.
pub fn note_models(notes: &[String], on_event: &mut OnEvent<'_>) -> Result<(), StudyError> {
    notes.iter().try_for_each(|note| tell(on_event, Event::Note(note.clone())))
}

/// What a view judges: the plan what was asked, a camera what it sees.
pub fn judged(site: &Site, view: &View) -> Receivers {
    match view {
        View::Plan(_) => site.receivers,
        View::Camera(_) | View::Elevation(_) => Receivers::Top,
    }
}

/// What a technique draws of a view.
fn subject(view: &View, receivers: Receivers, ground: GroundKind) -> Subject {
    match (view, receivers, ground) {
        (View::Camera(_), ..) => Subject::Camera,
        (View::Elevation(_), ..) => Subject::Side,
        (View::Plan(_), Receivers::Top, _) => Subject::Top,
        (View::Plan(_), Receivers::Ground, GroundKind::Plane) => Subject::Ground,
        (View::Plan(_), Receivers::Ground, GroundKind::Terrain) => Subject::Terrain,
        (View::Plan(_), Receivers::Surfaces, _) => Subject::Surfaces,
    }
}

/// What a technique draws of a view of a site.
fn subject_of(site: &Site, view: &View) -> Subject {
    subject(view, judged(site, view), site.ground.kind)
}

/// The seconds of the window with the sun above the horizon, and without.
pub fn day_and_night(track: &SunTrack) -> (u32, u32) {
    // both fit: a window is at most ten years, 3.2e8 s
    let secs = |night: bool| {
        let instants = track.instants.iter().filter(|instant| instant.night == night);
        instants.map(|instant| instant.weight_secs).sum()
    };
    (secs(false), secs(true))
}

/// One view of a site, by one machine.
struct SiteView<'a> {
    site: &'a Site,
    machine: &'a Machine,
    view: View,
    receivers: Receivers,
}

impl SiteView<'_> {
    fn technique(&self) -> Result<Box<dyn Technique>, StudyError> {
        self.machine.technique(self.scene(), self.view)
    }

    fn technique_of(&self, tile: Tile) -> Result<Box<dyn Technique>, StudyError> {
        self.machine.technique_of(self.scene(), tile)
    }

    fn scene(&self) -> Scene {
        let mesh = &self.site.mesh;
        let receivers = mesh.of_components(&self.site.judges(self.receivers));
        let casters = mesh.of_components(&self.site.casts);
        Scene { casters, receivers, ground: self.site.ground.level }
    }

    /// Volumes and silhouette before a camera's picture, in cells half as large as its pixels: a drawing on paper holds
    /// more than the picture's.
    fn overlay(&self, wants: &InstantWants, to_sun: DVec3) -> Result<Option<Overlay>, ShadowError> {
        let (Some(gpu), View::Camera(camera)) = (self.machine.gpu(), self.view) else { return Ok(None) };
        if !(wants.volumes || wants.silhouette) {
            return Ok(None);
        }
        let fine = Camera { width: camera.width * 2, height: camera.height * 2, ..camera };
        let scene = self.scene();
        let picture = VolumePicture::new(gpu, &scene, fine, to_sun)?;
        Ok(Some(Overlay {
            width: fine.width,
            height: fine.height,
            layers: wants.volumes.then(|| picture.layers()).transpose()?,
            silhouette: wants.silhouette.then(|| picture.silhouette()).transpose()?,
        }))
    }

    /// What the drawing shows: the receivers, or over a ground that is judged alone all models.
    fn surface_mesh(&self) -> Mesh {
        match self.receivers {
            Receivers::Top | Receivers::Surfaces => self.site.mesh.of_components(&self.site.receives),
            Receivers::Ground => self.site.mesh.clone(),
        }
    }

    fn surface(&self, technique: &dyn Technique) -> Result<Surface, ShadowError> {
        if self.receivers != Receivers::Ground {
            return technique.surface();
        }
        let receivers = self.surface_mesh();
        match (self.machine.gpu(), self.view) {
            (None, View::Plan(grid)) => Ok(plan_surface(&receivers, self.site.ground.level, &grid)),
            (gpu, view) => {
                let casters = self.site.mesh.of_components(&[]);
                let scene = Scene { casters, receivers, ground: self.site.ground.level };
                match gpu {
                    Some(gpu) => GpuSurface::draw(gpu, &scene, view)?.read(),
                    None => RayCast::new(scene, view, None).surface(),
                }
            }
        }
    }
}

/// Nothing sees the sun.
fn night(view: &View) -> Mask {
    let (width, height) = view.size();
    Mask { width, height, share: vec![0; width as usize * height as usize] }
}

/// Tells what happens.
///
/// # Errors
/// [`StudyError::Interrupted`] as asked by the listener.
pub fn tell(on_event: &mut OnEvent<'_>, event: Event<'_>) -> Result<(), StudyError> {
    match on_event(event) {
        ControlFlow::Continue(()) => Ok(()),
        ControlFlow::Break(()) => Err(StudyError::Interrupted),
    }
}
