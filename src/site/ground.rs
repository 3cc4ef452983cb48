//! The height of the ground's plane: as given, or found from the models.

use super::error::{FieldLocation, SiteError};
use super::extent::Bounds;
use super::overrides::{Overrides, refuse};
use super::terrain::{self, BuriedShare, ON_GROUND_M};
use super::written::WrittenSite;
use crate::choice::Receivers;
use crate::mesh::Mesh;
use crate::message::{Field, Message, few, message, setting};

/// The greatest height that a ground may have, above or below the place's point, metres.
const FARTHEST_M: f64 = 1e5;

/// The ground: its kind, the height of its plane and the source of that height, and how far the models reach below it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ground {
    /// What is judged in plans of the ground alone.
    pub kind: GroundKind,
    /// The plane's height, metres.
    pub level: f64,
    /// The source of the plane's height.
    pub from: GroundFrom,
    /// The models' lowest point, metres.
    pub lowest: f64,
    /// The part of the models' upper side that the plane hides. If a plane at the models' own zero would have hidden
    /// terrain, that part.
    buried: Option<BuriedShare>,
}

/// The kind of ground. It is determined once, with the models; everything that depends on it reads it here.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum GroundKind {
    /// The plane alone.
    Plane,
    /// The terrain that receives, seen from above, and the plane beyond its edge.
    Terrain,
}

impl GroundKind {
    /// The kind of ground of a mesh. Terrain that does not receive is looked through.
    fn of(mesh: &Mesh, receives: &[bool]) -> GroundKind {
        let mut components = mesh.components.iter().zip(receives);
        match components.any(|(component, receives)| component.is_terrain && *receives) {
            true => GroundKind::Terrain,
            false => GroundKind::Plane,
        }
    }
}

/// The source of the height of the ground's plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GroundFrom {
    /// The site file or the command line.
    Site,
    /// The models' own zero, since they reach through it.
    Zero,
    /// The models' lowest point.
    Lowest,
}

impl GroundFrom {
    /// Its word in reports.
    pub fn word(self) -> &'static str {
        match self {
            GroundFrom::Site => "site",
            GroundFrom::Zero => "zero",
            GroundFrom::Lowest => "lowest",
        }
    }
}

impl Ground {
    /// The height as given. Otherwise: below terrain the lowest point; else 0 if the models reach through 0 and nothing
    /// that looks like terrain is hidden there; else their lowest point.
    pub(super) fn of(mesh: &Mesh, bounds: Bounds, receives: &[bool], said: Option<f64>) -> Ground {
        let (lowest, highest) = (bounds.low.z, bounds.high.z);
        let kind = GroundKind::of(mesh, receives);
        let at = |level, from, buried| Ground { kind, level, from, lowest, buried };
        let buried = |level| (lowest < level - ON_GROUND_M).then(|| terrain::buried(mesh, bounds, level)).flatten();
        match said {
            Some(level) => at(level, GroundFrom::Site, buried(level)),
            None if kind == GroundKind::Terrain => at(lowest, GroundFrom::Lowest, None),
            None if lowest < -ON_GROUND_M && highest > ON_GROUND_M => match buried(0.0) {
                Some(terrain) if terrain.is_terrain => at(lowest, GroundFrom::Lowest, Some(terrain)),
                buried => at(0.0, GroundFrom::Zero, buried),
            },
            None => at(lowest, GroundFrom::Lowest, None),
        }
    }

    /// A ground at a given height.
    pub fn asked(level: f64) -> Ground {
        Ground { kind: GroundKind::Plane, level, from: GroundFrom::Site, lowest: level, buried: None }
    }

    /// As [`Ground::of`], without a given height.
    pub(super) fn found(mesh: &Mesh, receives: &[bool]) -> Ground {
        // a site always has a triangle
        Self::of(mesh, Bounds::of(mesh).unwrap_or_default(), receives, None)
    }

    /// The source of the ground in words, as in reports.
    pub fn word(&self) -> &'static str {
        match self.kind {
            GroundKind::Terrain => "terrain",
            GroundKind::Plane => self.from.word(),
        }
    }

    /// Whether its plane lies at a height, metres.
    pub fn is_at(&self, level: f64) -> bool {
        (self.level - level).abs() <= ON_GROUND_M
    }

    /// How far the models reach below it, metres; 0 if they do not.
    pub(crate) fn models_below_m(&self) -> f64 {
        Some(self.level - self.lowest).filter(|below| *below > ON_GROUND_M).unwrap_or(0.0)
    }

    /// In words, to follow "ground at": `0.00 m, the models' own zero; they reach 12.00 m below it`. In a comparison it
    /// describes the state before.
    pub fn said(&self) -> String {
        match self.kind {
            GroundKind::Terrain => format!("the terrain's height; beyond the terrain at {}", self.plane_said()),
            GroundKind::Plane => self.plane_said(),
        }
    }

    fn plane_said(&self) -> String {
        let level = metres(self.level);
        let (below, above) = (self.models_below_m(), self.lowest - self.level);
        let below_it = format!("{} below it", metres(below));
        match self.from {
            GroundFrom::Site if below > 0.0 => format!("{level}; the models reach {below_it}"),
            GroundFrom::Site if above > ON_GROUND_M => format!("{level}; the models begin {} above it", metres(above)),
            GroundFrom::Site => level,
            GroundFrom::Zero => format!("{level}, the models' own zero; they reach {below_it}"),
            // with a change, of both states
            GroundFrom::Lowest if below > 0.0 => {
                format!("{level}, the lowest point of the models before; after they reach {below_it}")
            }
            GroundFrom::Lowest => format!("{level}, the models' lowest point"),
        }
    }

    /// What the user should know of it besides its height: that it was found where another height would be possible,
    /// and which parts of a mesh it hides from being judged.
    pub fn notes(&self, mesh: &Mesh, receives: &[bool], receivers: Receivers) -> Vec<Message> {
        let name = |buried: BuriedShare| mesh.components.get(buried.component).map_or("", |component| &component.name);
        let level = || setting("[ground]", "level", "`level` in [ground]");
        let mut notes: Vec<Message> = self.terrain_note(mesh, receives).into_iter().collect();
        match (self.from, self.buried) {
            (GroundFrom::Lowest, Some(terrain)) => notes.push(message![
                format!(
                    "the ground is at {}, the models' lowest point: at their own zero it would hide {} of what is seen of \
                     \"{}\"",
                    metres(self.level),
                    percent(terrain.of_component),
                    name(terrain),
                );
                level(),
                " sets it"
            ]),
            (from, buried) => {
                if from == GroundFrom::Zero {
                    notes.push(message![
                        format!(
                            "the ground is at {}, where the models' own zero is; {} of the models lie below it",
                            metres(self.level),
                            metres(self.models_below_m()),
                        );
                        level(),
                        " sets it"
                    ]);
                }
                let is_plane_alone = receivers == Receivers::Ground && self.kind == GroundKind::Plane;
                if let (Some(buried), false) = (buried, is_plane_alone) {
                    notes.push(message![format!(
                        "the ground hides {} of what is seen of the models from above, of \"{}\" most: what lies below the \
                         ground is not judged on the plan and sees no sun",
                        percent(buried.of_plan),
                        name(buried),
                    )]);
                }
            }
        }
        notes
    }

    /// A note on which terrain is the ground, and what lies beyond it.
    fn terrain_note(&self, mesh: &Mesh, receives: &[bool]) -> Option<Message> {
        if self.kind == GroundKind::Plane {
            return None;
        }
        let terrain =
            mesh.components.iter().zip(receives).filter(|(component, receives)| component.is_terrain && **receives);
        let names = few(terrain.map(|(component, _)| format!("\"{}\"", component.name)).collect());
        let what = format!(
            "the ground is the terrain {names}; beyond the terrain's edge it is a plane at {}",
            metres(self.level)
        );
        Some(match self.from {
            GroundFrom::Site => message![what, ", as asked"],
            GroundFrom::Zero | GroundFrom::Lowest => {
                let level = setting("[ground]", "level", "`level` in [ground]");
                message![what, ", the models' lowest point"; level, " sets it"]
            }
        })
    }
}

/// Metres with two decimals, or with three if the third is not 0.
pub fn metres(value: f64) -> String {
    let millimetres = (value * 1000.0).round() + 0.0;
    let decimals = if millimetres % 10.0 == 0.0 { 2 } else { 3 };
    format!("{:.decimals$} m", millimetres / 1000.0)
}

fn percent(share: f64) -> String {
    format!("{} %", (share * 100.0).round().clamp(1.0, 100.0))
}

/// The ground's height as set by a face or the site file.
///
/// # Errors
/// [`SiteError::Value`] if it is not a height.
pub(super) fn level(written: &WrittenSite, asked: &Overrides) -> Result<Option<f64>, SiteError> {
    let (level, at) = match (asked.ground, written.site.ground.level) {
        (Some(level), _) => (level, FieldLocation::Field(Field::Ground)),
        (None, Some(level)) => (level, written.key("ground", "level")),
        (None, None) => return Ok(None),
    };
    checked(level, at).map(Some)
}

/// Checks the height of a ground.
///
/// # Errors
/// [`SiteError::Value`] if it is not a height.
pub(super) fn checked(level: f64, at: FieldLocation) -> Result<f64, SiteError> {
    // false for NaN
    if level.abs() <= FARTHEST_M {
        // turns −0 into 0
        return Ok(level + 0.0);
    }
    let what = format!("{level} is not a height of the ground");
    Err(refuse(at, message![what; "write metres above the place's point, for example 0.0"]))
}
