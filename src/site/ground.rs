//! The ground's height: as it is said, or as it is found from the models.

use super::Receivers;
use super::asked::{Overrides, refuse};
use super::error::{FieldLocation, SiteError};
use super::extent::Bounds;
use super::terrain::{self, BuriedShare, ON_GROUND_M};
use super::written::WrittenSite;
use crate::mesh::Mesh;
use crate::message::{Field, message};

/// Nobody asks for a ground farther from the place's point than this, metres.
const FARTHEST_M: f64 = 1e5;

/// The ground plane: how high it lies, who says so, and what of the models lies below it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ground {
    /// Its height, metres.
    pub level: f64,
    /// Who says so.
    pub from: GroundFrom,
    /// The models' lowest point, metres.
    pub lowest: f64,
    /// What of their upper side the plane hides; where the models' own zero would have hidden terrain, that.
    buried: Option<BuriedShare>,
}

/// Who says how high the ground lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GroundFrom {
    /// The site file or the command line.
    Site,
    /// The models, which reach through 0: their own zero.
    Zero,
    /// The models, whose lowest point it is.
    Lowest,
}

impl GroundFrom {
    /// As reports have it.
    pub fn word(self) -> &'static str {
        match self {
            GroundFrom::Site => "site",
            GroundFrom::Zero => "zero",
            GroundFrom::Lowest => "lowest",
        }
    }
}

impl Ground {
    /// As it is said. Where nobody says it: 0 where the models reach through 0 and no terrain of theirs is hidden there;
    /// else their lowest point.
    pub(super) fn of(mesh: &Mesh, bounds: Bounds, said: Option<f64>) -> Ground {
        let (lowest, highest) = (bounds.low.z, bounds.high.z);
        let at = |level, from, buried| Ground { level, from, lowest, buried };
        let buried = |level| (lowest < level - ON_GROUND_M).then(|| terrain::buried(mesh, bounds, level)).flatten();
        match said {
            Some(level) => at(level, GroundFrom::Site, buried(level)),
            None if lowest < -ON_GROUND_M && highest > ON_GROUND_M => match buried(0.0) {
                Some(terrain) if terrain.is_terrain => at(lowest, GroundFrom::Lowest, Some(terrain)),
                buried => at(0.0, GroundFrom::Zero, buried),
            },
            None => at(lowest, GroundFrom::Lowest, None),
        }
    }

    /// One that is said, and on which all stands.
    pub fn asked(level: f64) -> Ground {
        Ground { level, from: GroundFrom::Site, lowest: level, buried: None }
    }

    /// As [`Ground::of`] where nobody says it.
    pub(super) fn found(mesh: &Mesh) -> Ground {
        // a site has a triangle
        Self::of(mesh, Bounds::of(mesh).unwrap_or_default(), None)
    }

    /// Whether it lies at a height, metres.
    pub fn is_at(&self, level: f64) -> bool {
        (self.level - level).abs() <= ON_GROUND_M
    }

    /// How far the models reach below it, metres; 0 where they stand on it or above.
    pub fn models_below_m(&self) -> f64 {
        Some(self.level - self.lowest).filter(|below| *below > ON_GROUND_M).unwrap_or(0.0)
    }

    /// In words: `0.00 m, the models' own zero; they reach 12.00 m below it`. Of a comparison it is that of the state before.
    pub fn said(&self) -> String {
        let level = metres(self.level);
        let (below, above) = (self.models_below_m(), self.lowest - self.level);
        let below_it = format!("{} below it", metres(below));
        match self.from {
            GroundFrom::Site if below > 0.0 => format!("{level}; the models reach {below_it}"),
            GroundFrom::Site if above > ON_GROUND_M => format!("{level}; the models begin {} above it", metres(above)),
            GroundFrom::Site => level,
            GroundFrom::Zero => format!("{level}, the models' own zero; they reach {below_it}"),
            // of two states
            GroundFrom::Lowest if below > 0.0 => {
                format!("{level}, the lowest point of the models before; after they reach {below_it}")
            }
            GroundFrom::Lowest => format!("{level}, the models' lowest point"),
        }
    }

    /// What a person has to know of it beside its height: that it was found where it could lie elsewhere, and what of the
    /// components of a mesh it hides from what is judged.
    pub fn notes(&self, mesh: &Mesh, receivers: Receivers) -> Vec<String> {
        let name = |buried: BuriedShare| mesh.components.get(buried.component).map_or("", |component| &component.name);
        let mut notes = Vec::new();
        match (self.from, self.buried) {
            (GroundFrom::Lowest, Some(terrain)) => notes.push(format!(
                "the ground is at {}, the models' lowest point: at their own zero it would hide {} of what is seen of \"{}\"; \
                 `level` in [ground] sets it",
                metres(self.level),
                percent(terrain.of_component),
                name(terrain),
            )),
            (from, buried) => {
                if from == GroundFrom::Zero {
                    notes.push(format!(
                        "the ground is at {}, where the models' own zero is; {} of the models lie below it; \
                         `level` in [ground] sets it",
                        metres(self.level),
                        metres(self.models_below_m()),
                    ));
                }
                if let (Some(buried), Receivers::Top | Receivers::Surfaces) = (buried, receivers) {
                    notes.push(format!(
                        "the ground hides {} of what is seen of the models from above, of \"{}\" most: what lies below the \
                         ground is not judged on the plan and sees no sun",
                        percent(buried.of_plan),
                        name(buried),
                    ));
                }
            }
        }
        notes
    }
}

/// Metres with two decimals, or a third one where there is one.
pub fn metres(value: f64) -> String {
    let millimetres = (value * 1000.0).round() + 0.0;
    let decimals = if millimetres % 10.0 == 0.0 { 2 } else { 3 };
    format!("{:.decimals$} m", millimetres / 1000.0)
}

fn percent(share: f64) -> String {
    format!("{} %", (share * 100.0).round().clamp(1.0, 100.0))
}

/// The ground's height, where the command line or the site file says it.
///
/// # Errors
/// [`SiteError::Value`] where it is no height.
pub(super) fn level(written: &WrittenSite, asked: &Overrides) -> Result<Option<f64>, SiteError> {
    let (level, at) = match (asked.ground, written.site.ground.level) {
        (Some(level), _) => (level, FieldLocation::Field(Field::Ground)),
        (None, Some(level)) => (level, written.key("ground", "level")),
        (None, None) => return Ok(None),
    };
    checked(level, at).map(Some)
}

/// A ground's height that is one.
///
/// # Errors
/// [`SiteError::Value`] where it is none.
pub(super) fn checked(level: f64, at: FieldLocation) -> Result<f64, SiteError> {
    // a NaN is not within either
    if level.abs() <= FARTHEST_M {
        // −0 is 0
        return Ok(level + 0.0);
    }
    let what = format!("{level} is no height of a ground");
    Err(refuse(at, message![what; "write metres above the place's point, for example 0.0"]))
}
