//! The request for a verdict: what a rule judges in a site, and the states that are compared.
//!
//! All points are in the world frame (metres, x east, y north, z up).

use crate::mesh::Mesh;
use crate::message::{Message, Words};
use crate::site::Ground;
use crate::sun::Place;
use glam::{DVec2, DVec3};
use std::sync::Arc;

/// A checked site with everything that a rule may judge.
#[derive(Clone, Debug)]
pub struct JudgedSite {
    /// The site file, as the user named it, for errors.
    pub file: String,
    /// The place on Earth.
    pub place: Place,
    /// The state that is judged.
    pub now: JudgedState,
    /// The state that it is compared with, if the site has one.
    pub before: Option<JudgedState>,
    /// Notes on how the models were read, as in [`crate::site::Site::notes`].
    pub notes: Vec<Message>,
    /// As in [`crate::site::Site::words`].
    pub words: &'static dyn Words,
    /// The areas. No two have the same name.
    pub areas: Vec<JudgedArea>,
    /// The windows. No two have the same name.
    pub windows: Vec<JudgedWindow>,
    /// The façades. No two have the same name.
    pub facades: Vec<JudgedFacade>,
    /// The plot, if the site has one.
    pub plot: Option<JudgedPlot>,
    /// The year whose days are judged: that of the study's date.
    pub year: i32,
    /// Whether directions include atmospheric refraction.
    pub refraction: bool,
}

/// One state of a site.
#[derive(Clone, Debug)]
pub struct JudgedState {
    /// All models, welded, in the world frame. The two states share one mesh if they differ only in what stands.
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
    /// Its outer borders and holes in plan, each with at least three corners. Borders are counter-clockwise and holes
    /// clockwise; none touches itself or another one. Empty if the area is a component's upper faces.
    pub rings: Vec<Vec<DVec2>>,
    /// Where its points lie.
    pub surface: AreaSurface,
    /// The dwelling to which it belongs, if it is a private open space.
    pub dwelling: Option<String>,
}

/// The surface that the points of an area lie on.
#[derive(Clone, Debug)]
pub enum AreaSurface {
    /// A level plane at this z.
    Level(f64),
    /// This many metres above the ground below: the terrain, or beside it the plane of the ground.
    Ground(f64),
    /// On these triangles, which look upward.
    Faces(Vec<[DVec3; 3]>),
}

/// A window.
#[derive(Clone, Debug)]
pub struct JudgedWindow {
    /// Its name.
    pub name: String,
    /// The component that it is a piece of; `None` if the site file gives its corners. A component with judged windows
    /// lets light through: it casts in no state.
    pub component: Option<u32>,
    /// The corners of its glass as seen from outside: the sill's left and right end, then the head's right and left
    /// end.
    pub corners: [DVec3; 4],
    /// The glass's unit normal, away from the room.
    pub outward: DVec3,
    /// The corners of the glass's other face as seen from that side, if it is not known which of the two is outside.
    /// `study::settle` takes the more open one and leaves `None` here.
    pub other_side: Option<[DVec3; 4]>,
    /// The distance from the glass out to the wall's outer plane, metres. If it is not given, `study::settle` measures
    /// it.
    pub reveal_m: f64,
    /// Whether the site file gives the reveal.
    pub reveal_is_said: bool,
    /// The distance from the glass in to the wall's inner plane, metres, if it is known.
    pub inner_m: Option<f64>,
    /// The z of the room's floor, if it is known.
    pub floor: Option<f64>,
    /// Its room, if the site has it.
    pub room: Option<String>,
    /// Its dwelling, if the site has it.
    pub dwelling: Option<String>,
    /// The room's use in the words of a rule's `all_of`, if the site has it.
    pub usage: Option<String>,
    /// The floor area of its room, square metres, if the site has it.
    pub room_m2: Option<f64>,
}

/// A façade that is judged, with or without windows.
#[derive(Clone, Debug)]
pub struct JudgedFacade {
    /// Its name.
    pub name: String,
    /// Points on it, each with the outward normal of its wall.
    pub points: Vec<[DVec3; 2]>,
    /// The indices of those points of which it is not known whether the normal looks outward. `study::settle` turns the
    /// ones that are more open behind, and leaves none here.
    pub doubtful: Vec<usize>,
}

/// The plot on which the building stands.
#[derive(Clone, Debug)]
pub struct JudgedPlot {
    /// Its border in plan, counter-clockwise. It does not touch itself.
    pub border: Vec<DVec2>,
    /// For each side of the border, from each corner to the next, what adjoins it.
    pub sides: Vec<PlotSide>,
    /// The z of the ground's mean level at the building, if the site has it.
    pub mean_ground: Option<f64>,
}

/// What adjoins one side of a plot.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PlotSide {
    /// The width of the road or water there, metres; 0 where a neighbour's plot adjoins.
    pub road_m: f64,
    /// The height of the neighbour's ground above the mean ground, metres; negative if it is lower.
    pub neighbour_higher_m: f64,
}
