//! Guesses whether a model is in millimetres, centimetres or inches, or lies on its side.
//!
//! Many files do not say so: glTF is in metres and y up, STL is usually z up, and many programs export something else.
//! Only keys that nobody wrote are doubted: a written `scale` or `up` is a decision.

use crate::formats::{Model, Up};
use crate::mesh::{Component, Mesh};
use crate::message::{Field, Message, MessagePart, message, pieces, set_to};
use glam::{DMat3, DVec3};
use rayon::prelude::*;

/// What a model looks like, and the keys that would correct it.
#[derive(Clone, Debug, PartialEq)]
pub struct Likeness {
    /// The index of the model in the site, from 0.
    pub model: usize,
    /// The keys, one of which would correct it.
    pub mends: Vec<Mend>,
}

/// A key under `[[model]]`, and its value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mend {
    /// `scale`
    Scale(f64),
    /// `up`
    Up(Up),
}

impl std::fmt::Display for Mend {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Mend::Scale(scale) => write!(f, "scale = {scale}"),
            Mend::Up(up) => write!(f, "up = \"{up}\""),
        }
    }
}

/// The height of the highest building, rounded up, metres (Burj Khalifa: 828).
const HIGHEST_M: f64 = 1000.0;
/// The height of the highest mountain, rounded up.
const MOUNTAIN_M: f64 = 9000.0;
/// The greatest mean height of the horizontal surfaces of a wide building, metres.
const MASSIVE_M: f64 = 200.0;
/// The least share of walls in the area of a building; with less, it is terrain.
const WALLED: f64 = 0.15;
/// The least height or width of a house, metres.
const LEAST_M: f64 = 2.4;

/// To tell which way is up, more of the roofs and terrain must face up than down, by this share of the area, and this
/// many times as clearly as along the other axis.
const ROOFED: f64 = 0.05;
const CLEARLY: f64 = 4.0;
/// A model stands on the ground if it begins this close to 0, as a share of its height; it is centred on its axis if
/// its middle is this close to it, as a share of its depth.
const ON_THE_GROUND: f64 = 0.02;
const AROUND_ITS_AXIS: f64 = 0.05;

/// A face is horizontal or vertical if it is off by less than 5°: this is the sine.
const PLUMB: f64 = 0.087;

/// The areas of a model's faces, square metres, and its box. Axes are the file's own, turned upright: east, north, up.
/// A file that is y up has its z to the south.
#[derive(Clone, Copy, Debug)]
struct ModelMeasures {
    low: DVec3,
    high: DVec3,
    area: f64,
    walls: f64,
    /// For faces that look up: their area, and the area times the height.
    upwards: [f64; 2],
    /// The area of slopes that face north and up, and of those that face the other way.
    sloped: [DVec3; 2],
    /// The same for level faces, seen along each axis.
    level: [DVec3; 2],
    faces: usize,
}

impl ModelMeasures {
    const NOTHING: ModelMeasures = ModelMeasures {
        low: DVec3::INFINITY,
        high: DVec3::NEG_INFINITY,
        area: 0.0,
        walls: 0.0,
        upwards: [0.0; 2],
        sloped: [DVec3::ZERO; 2],
        level: [DVec3::ZERO; 2],
        faces: 0,
    };

    fn add(&mut self, corners: [DVec3; 3]) {
        let [a, b, c] = corners;
        corners.iter().for_each(|&corner| (self.low, self.high) = (self.low.min(corner), self.high.max(corner)));
        self.faces += 1;
        let vector = (b - a).cross(c - a) / 2.0;
        let area = vector.length();
        // `try_normalize` would find the length again
        let over_area = area.recip();
        if !(over_area.is_finite() && over_area > 0.0) {
            return;
        }
        let normal = vector * over_area;
        // without branches, as none of these could be predicted
        let if_so = |counts: bool| if counts { area } else { 0.0 };
        self.area += area;
        self.walls += if_so(normal.z.abs() < PLUMB);
        let upwards = if_so(normal.z > 0.5);
        self.upwards[0] += upwards;
        self.upwards[1] += upwards * (a.z + b.z + c.z) / 3.0;
        for axis in [1, 2] {
            let along = normal[axis];
            // level to within 5°, as well
            let is_level = along.abs() > (1.0 - PLUMB * PLUMB).sqrt();
            let is_sloped = !is_level && along.abs() >= PLUMB;
            for (side, is_side) in [along >= 0.0, along < 0.0].into_iter().enumerate() {
                self.level[side][axis] += if_so(is_side && is_level);
                self.sloped[side][axis] += if_so(is_side && is_sloped);
            }
        }
    }

    fn and(self, other: &ModelMeasures) -> ModelMeasures {
        let sum = |one: [DVec3; 2], other: [DVec3; 2]| [one[0] + other[0], one[1] + other[1]];
        ModelMeasures {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
            area: self.area + other.area,
            walls: self.walls + other.walls,
            upwards: [self.upwards[0] + other.upwards[0], self.upwards[1] + other.upwards[1]],
            sloped: sum(self.sloped, other.sloped),
            level: sum(self.level, other.level),
            faces: self.faces + other.faces,
        }
    }

    /// The length in metres that a unit seems to have if it is not 1; several lengths if they cannot be told apart.
    fn units(&self) -> Option<&'static [f64]> {
        let size = self.high - self.low;
        let narrow = size.x.min(size.y);
        let is_walled = self.walls > WALLED * self.area;
        let mean_height = self.upwards[1] / self.upwards[0].max(f64::MIN_POSITIVE) - self.low.z;
        let is_massive = narrow > MASSIVE_M && mean_height > MASSIVE_M;
        if !(size.z > MOUNTAIN_M || is_walled && (size.z > HIGHEST_M || is_massive)) {
            return None;
        }
        let in_millimetres = size.z.min(narrow) / 1000.0;
        Some(if in_millimetres >= LEAST_M { &[0.001] } else { &[0.01, 0.0254] })
    }

    /// Whether it lies on its side: the axis taken as up looks horizontal, and the other one looks like up. A file that
    /// is taken as y up has its z to the south, one that is taken as z up has its y to the north.
    fn lies(&self, taken: Up) -> bool {
        let (other_up, foot) = match taken {
            Up::Y => (1, self.high.y),
            Up::Z => (0, self.low.y),
        };
        // by which share of the area more faces look one way along an axis than the other
        let looks = |axis: usize, up: usize| {
            let more = |areas: [DVec3; 2]| (areas[up][axis] - areas[1 - up][axis]).max(0.0);
            (more(self.sloped) + more(self.level)) / self.area
        };
        let (upright, lying) = (looks(2, 0), looks(1, other_up));
        let size = self.high - self.low;
        let stands = foot.abs() <= ON_THE_GROUND * size.y;
        let is_around_axis = ((self.low.z + self.high.z) / 2.0).abs() <= AROUND_ITS_AXIS * size.z;
        lying >= ROOFED.max(CLEARLY * upright) || stands && is_around_axis && upright < ROOFED
    }
}

/// The number of faces for one task.
const AT_ONCE: usize = 1 << 14;

/// The unit and axis with which a model stands, and whether its file or the user gave them.
#[derive(Clone, Copy, Debug)]
pub(super) struct TakenFrame {
    pub up: Up,
    pub up_is_said: bool,
    pub unit_is_said: bool,
}

impl TakenFrame {
    /// A model as its file gives it.
    pub(super) fn of_file(model: &Model) -> Self {
        Self { up: model.up, up_is_said: model.up_is_said, unit_is_said: model.unit_m.is_some() }
    }

    /// The same if the user gave the unit or the axis.
    pub(super) fn written(self, unit: bool, up: bool) -> Self {
        Self { up_is_said: self.up_is_said || up, unit_is_said: self.unit_is_said || unit, ..self }
    }
}

/// Examines a model: its components, and how it was turned and moved. Only what nobody gave is doubted.
pub(super) fn of(
    mesh: &Mesh,
    components: &[Component],
    (north_rad, position): (f64, DVec3),
    taken: TakenFrame,
) -> Vec<Mend> {
    if taken.unit_is_said && taken.up_is_said {
        return Vec::new();
    }
    let upright_from_world = DMat3::from_rotation_z(-north_rad);
    let corner = |vertex: u32| {
        let world = mesh.origin + mesh.vertices[vertex as usize].as_dvec3();
        upright_from_world * (world - position)
    };
    let are_all_home = mesh.are_all_at_home();
    let of_faces = |faces: &[[u32; 3]], only_home: bool| {
        let mut measured = ModelMeasures::NOTHING;
        let is_counted = |face: &&[u32; 3]| face.iter().all(|&vertex| mesh.is_at_home(vertex));
        let mut add = |face: &[u32; 3]| measured.add(face.map(corner));
        match only_home && !are_all_home {
            true => faces.iter().filter(is_counted).for_each(add),
            false => faces.iter().for_each(&mut add),
        }
        measured
    };
    // parallel sums are added in order, so that the result is always the same
    let measure = |only_home: bool| {
        components.iter().fold(ModelMeasures::NOTHING, |sum, component| {
            let faces = &mesh.faces[component.faces.start as usize..component.faces.end as usize];
            let parts: Vec<_> = faces.par_chunks(AT_ONCE).map(|faces| of_faces(faces, only_home)).collect();
            parts.iter().fold(sum, |sum, part| sum.and(part))
        })
    };
    let faces: usize = components.iter().map(|component| component.faces.len()).sum();
    let mut measured = measure(true);
    if measured.faces * 2 < faces {
        // strays are few
        measured = measure(false);
    }
    if measured.area <= 0.0 {
        return Vec::new();
    }
    let mut mends = Vec::new();
    if !taken.unit_is_said
        && let Some(units) = measured.units()
    {
        mends.extend(units.iter().map(|&unit| Mend::Scale(unit)));
    }
    if !taken.up_is_said && measured.lies(taken.up) {
        mends.push(Mend::Up(match taken.up {
            Up::Y => Up::Z,
            Up::Z => Up::Y,
        }));
    }
    mends
}

/// The notes on what a model looks like.
pub(super) fn notes(model: &str, mends: &[Mend]) -> Vec<Message> {
    let scales: Vec<f64> =
        mends.iter().filter_map(|mend| if let Mend::Scale(scale) = mend { Some(*scale) } else { None }).collect();
    let mut notes = Vec::new();
    match scales[..] {
        [] => (),
        [scale] => notes.push(message![
            format!("{model} is so large that its unit may be millimetres");
            "if so, write ",
            set_to("[[model]]", "scale", scale.to_string(), format!("`scale = {scale}` under [[model]]"))
        ]),
        _ => notes.push(message![
            format!("{model} is so large that its unit may be centimetres or inches");
            "if so, write ",
            set_to("[[model]]", "scale", "0.01".to_owned(), "`scale = 0.01`".to_owned()),
            " or ",
            set_to("[[model]]", "scale", "0.0254".to_owned(), "`scale = 0.0254` under [[model]]".to_owned())
        ]),
    }
    for mend in mends {
        let Mend::Up(up) = mend else { continue };
        notes.push(message![
            format!("{model} looks as if it lies on its side, with its {up} up");
            "if it does, write ",
            set_to("[[model]]", "up", up.word().to_owned(), format!("`{mend}` under [[model]]")),
            MessagePart::Where(Field::Up, pieces![", or say ", (Field::Up, up.word())])
        ]);
    }
    notes
}
