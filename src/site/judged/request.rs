//! The request for a verdict: what of a site a rule judges, and the states that are compared.
//!
//! All points are in the world frame (metres, x east, y north, z up).

use crate::mesh::Mesh;
use crate::message::{Message, Words};
use crate::site::Ground;
use crate::sun::Place;
use glam::{DVec2, DVec3};
use std::sync::Arc;

/// A checked site with everything on it that a rule may judge.
#[derive(Clone, Debug)]
pub struct JudgedSite {
    /// The site file, as the user named it, for errors.
    pub file: String,
    /// The place on Earth.
    pub place: Place,
    /// As it is asked for: what the verdict is on.
    pub now: JudgedState,
    /// The state with which it is compared, where the site says one.
    pub before: Option<JudgedState>,
    /// What the user should know of how the models were read, as [`crate::site::Site::notes`].
    pub notes: Vec<Message>,
    /// As [`crate::site::Site::words`].
    pub words: &'static dyn Words,
    /// The areas, each with its own name.
    pub areas: Vec<JudgedArea>,
    /// The windows, each with its own name.
    pub windows: Vec<JudgedWindow>,
    /// The façades, each with its own name.
    pub facades: Vec<JudgedFacade>,
    /// The plot, where the site says one.
    pub plot: Option<JudgedPlot>,
    /// The year whose days are judged: that of the study's date.
    pub year: i32,
    /// Whether directions include atmospheric refraction.
    pub refraction: bool,
}

/// One state of a site.
#[derive(Clone, Debug)]
pub struct JudgedState {
    /// All models, welded, in the world frame. Two states that differ in nothing but what stands share one.
    pub mesh: Arc<Mesh>,
    /// For each component, whether it casts in this state.
    pub casts: Vec<bool>,
    /// The ground.
    pub ground: Ground,
}

/// An area whose parts are judged.
#[derive(Clone, Debug)]
pub struct JudgedArea {
    /// Its name.
    pub name: String,
    /// Its outer borders and holes from above, each of at least three corners, counter-clockwise outside and clockwise for
    /// holes; none touches itself or another. Empty of an area that is a component's upper faces.
    pub rings: Vec<Vec<DVec2>>,
    /// Where its points lie.
    pub surface: AreaSurface,
}

/// Where the points of an area lie.
#[derive(Clone, Debug)]
pub enum AreaSurface {
    /// On a level plane at this z.
    Level(f64),
    /// So many metres above the ground below: the terrain, or beside it the plane of the ground.
    Ground(f64),
    /// On these triangles, which look upward.
    Faces(Vec<[DVec3; 3]>),
}

/// A window.
#[derive(Clone, Debug)]
pub struct JudgedWindow {
    /// Its name.
    pub name: String,
    /// The component that it is a piece of; none of a window that is written with its corners. A component with judged
    /// windows lets light through: it is no caster of any state.
    pub component: Option<u32>,
    /// The corners of its glass as it is seen from outside: the sill's left and right end, the head's right and left end.
    pub corners: [DVec3; 4],
    /// Away from the room, a unit vector, square to the glass.
    pub outward: DVec3,
    /// The corners of the glass's other face as they are seen from there, where nothing says which of the two is outside.
    /// `study::settle` takes the more open one and leaves none here.
    pub other_side: Option<[DVec3; 4]>,
    /// How far the wall's outer plane lies before the glass, metres; as `study::settle` measures it where it is not said.
    pub reveal_m: f64,
    /// Whether the site says the reveal.
    pub reveal_is_said: bool,
    /// How far the wall's inner plane lies behind the glass, metres, where it is known.
    pub inner_m: Option<f64>,
    /// The z of the room's floor, where it is known.
    pub floor: Option<f64>,
    /// Its room, where the site says one.
    pub room: Option<String>,
    /// Its dwelling, where the site says one.
    pub dwelling: Option<String>,
    /// What the room is used for, as a rule names it (`all_of`), where the site says it.
    pub usage: Option<String>,
    /// The floor area of its room, square metres, where the site says it.
    pub room_m2: Option<f64>,
}

/// A façade that is judged, whether it has windows or not.
#[derive(Clone, Debug)]
pub struct JudgedFacade {
    /// Its name.
    pub name: String,
    /// Points on it, each with the outward normal of its wall.
    pub points: Vec<[DVec3; 2]>,
    /// Those of them, by their index, of which nothing says that the normal looks outward. `study::settle` turns what is more
    /// open behind and leaves none here.
    pub doubtful: Vec<usize>,
}

/// The plot that is built on.
#[derive(Clone, Debug)]
pub struct JudgedPlot {
    /// Its border from above, counter-clockwise, not touching itself.
    pub border: Vec<DVec2>,
    /// For each side of the border, from its corner to the next, what adjoins.
    pub sides: Vec<PlotSide>,
    /// The z of the mean level of the ground at the building, where the site says it.
    pub mean_ground: Option<f64>,
}

/// What adjoins one side of a plot.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PlotSide {
    /// The width of the road or water there, metres; 0 where a neighbour's plot adjoins.
    pub road_m: f64,
    /// By how much the neighbour's ground lies higher than the mean ground, metres; negative where it lies lower.
    pub neighbour_higher_m: f64,
}
