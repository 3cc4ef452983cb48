//! Why a study fails.

use crate::choice::Misfit;
use crate::gpu::GpuError;
use crate::message::{Field, Message, MessagePart, Worded, aside, message, pieces, plain_display};
use crate::rules::{RuleError, RuleNeed};
use crate::shadow::ShadowError;
use crate::site::{FieldLocation, Site};
use crate::sun::{SunError, Zone};
use chrono::DateTime;

/// Why a study fails, in one line.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StudyError {
    /// Two choices that exclude each other.
    Conflict {
        /// The choice that does not fit.
        field: Field,
        /// Why, and a hint.
        message: Message,
    },
    /// Technique, engine and settings that do not fit each other or the subject.
    Misfit(#[from] Misfit),
    /// The technique does not fit, which the site file names.
    FileMisfit {
        /// What does not fit.
        misfit: Misfit,
        /// Where the file names it.
        at: FieldLocation,
    },
    /// The plan needs more memory than the budget allows.
    LittleMemory {
        /// What it may take, bytes.
        asked: u64,
        /// What the smallest tile takes, bytes.
        least: u64,
        /// Columns of the plan.
        width: u32,
    },
    /// The plan has too many cells to be drawn at once.
    TooManyCells {
        /// Columns of the plan.
        width: u32,
        /// Its rows.
        height: u32,
    },
    /// Time on patches is summed in 32 bits.
    TooLong {
        /// Seconds of the window with the sun above the horizon.
        day_secs: u32,
        /// How many can be summed.
        most_secs: u32,
    },
    /// No component that receives has an area.
    NoPatch(Message),
    /// No component casts a volume.
    NoVolume(Message),
    /// The track has no instant.
    NoInstant,
    /// A list of a site made in memory does not have one entry for each component.
    Components {
        /// The field of [`Site`](crate::site::Site).
        list: &'static str,
        /// Its length.
        length: usize,
        /// The number of the mesh's components.
        components: usize,
    },
    /// A tile that is not one of the study's.
    OtherTile,
    /// No usable adapter.
    Gpu(#[from] GpuError),
    /// Volumes or silhouettes were requested from a technique other than the stencil.
    NoVolumes(String),
    /// The techniques cannot be compared with ray casting on this machine.
    NoVerification(String),
    /// All devices on which the work was tried failed, and nothing else can do it.
    NoDevice(String),
    /// All instants are at night.
    NoDay,
    /// A rule that does not say how much sun must stay.
    NoEnvelope {
        /// Its id.
        rule: String,
        /// What it says instead.
        why: String,
    },
    /// More rays would have to be kept free than can be asked.
    TooManyRays {
        /// Their number: a ray for each second and each point.
        rays: i64,
        /// How many there may be.
        most: i64,
    },
    /// The sun is the viewer, and it is below the horizon.
    NoSunToSee {
        /// The time.
        time: DateTime<Zone>,
        /// How far below the horizon the sun is, degrees.
        below_deg: f64,
    },
    /// The sun's position cannot be computed.
    Sun(#[from] SunError),
    /// The rule cannot be applied to the site.
    Rule(Message),
    /// Drawing failed.
    Shadow(#[from] ShadowError),
    /// The listener ended the work.
    Interrupted,
}

plain_display!(StudyError);

impl From<RuleError> for StudyError {
    fn from(error: RuleError) -> StudyError {
        let hint = match &error {
            RuleError::Needs { needs, .. } | RuleError::Unsaid { needs, .. } => to_add(needs),
            _ => Vec::new(),
        };
        StudyError::Rule(Message { what: pieces![error.to_string()], hint })
    }
}

/// The keys of a site file that say what a rule needs, each once; nothing where none would help.
fn to_add(needs: &[RuleNeed]) -> Vec<MessagePart> {
    let mut keys: Vec<[&'static str; 2]> = Vec::new();
    for key in needs.iter().filter_map(|need| need.said_at) {
        if !keys.contains(&key) {
            keys.push(key);
        }
    }
    let mut hint = Vec::new();
    for (number, [table, key]) in keys.iter().copied().enumerate() {
        hint.push(MessagePart::from(match number {
            0 => "add ",
            _ if number + 1 == keys.len() => " and ",
            _ => ", ",
        }));
        let written = if key.is_empty() { table.to_owned() } else { format!("`{key}` under {table}") };
        hint.push(MessagePart::Setting {
            table: table.into(),
            key: key.into(),
            value: None,
            written: written.into(),
            field: None,
        });
    }
    if !hint.is_empty() {
        hint.push(" to the site file".into());
    }
    hint
}

impl Worded for StudyError {
    fn message(&self) -> Message {
        match self {
            StudyError::Conflict { field, message } => message.clone().of((*field).into()),
            StudyError::Misfit(misfit) => misfit.message(),
            StudyError::FileMisfit { misfit, at } => at.tells(misfit.reason()),
            StudyError::LittleMemory { asked, least, width } => message![
                Field::Memory,
                format!(": {} is too little for rows of {width} cells", amount(*asked));
                format!("take at least {}, or larger cells", amount(*least)), aside(Field::Cell)
            ],
            StudyError::TooManyCells { width, height } => message![
                format!("{width} × {height} cells are more than can be drawn at once");
                "choose larger cells",
                aside(Field::Cell),
                MessagePart::Where(Field::Size, pieces![" or fewer", aside(Field::Size)])
            ],
            StudyError::TooLong { day_secs, most_secs } => message![
                format!(
                    "the study has {} hours of daylight, and sums on surfaces hold at most {}",
                    day_secs / 3600,
                    most_secs / 3600
                );
                "ask for fewer days or a shorter window"
            ],
            StudyError::NoPatch(message) | StudyError::NoVolume(message) => message.clone(),
            StudyError::NoSunToSee { time, below_deg } => no_sun_to_see(time, *below_deg),
            StudyError::NoEnvelope { rule, why } => no_envelope(rule, why),
            StudyError::TooManyRays { rays, most } => too_many_rays(*rays, *most),
            StudyError::NoInstant => message!["there is no instant to draw"],
            StudyError::Components { list, length, components } => message![
                format!("the site's list `{list}` has {length} entries, and its mesh {components} components");
                "give it one entry for each component"
            ],
            StudyError::OtherTile => message!["the tile is not one of this study's"; "take one of its own tiles"],
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
            StudyError::NoDevice(why) => no_device(why),
            StudyError::NoDay => message![
                "there is no sun at any of the study's instants, so there is nothing to compare or to keep";
                "choose a window by day", MessagePart::Where(Field::From, pieces![" with ", Field::From, " and ", Field::To])
            ],
            StudyError::Sun(error) => error.message(),
            StudyError::Rule(message) => message.clone(),
            StudyError::Shadow(error) => error.message(),
            StudyError::Interrupted => message!["interrupted"],
        }
    }
}

/// The way to a graphics adapter where there is none.
const DRIVER: &str = "install a driver (on Linux mesa-vulkan-drivers draws in software)";

fn no_sun_to_see(time: &DateTime<Zone>, below_deg: f64) -> Message {
    let time = time.format("%Y-%m-%d %H:%M");
    message![
        Field::View,
        format!(": no sun sees the site at {time}: it is {below_deg:.1}° below the horizon");
        "take times of day, or look from elsewhere"
    ]
}

fn no_device(why: &str) -> Message {
    message![
        why.to_owned(), ", after another device had failed, and only a graphics adapter can draw what was requested";
        "update its driver, close other programs that draw on it, take larger cells, or install a driver that draws in \
         software (on Linux mesa-vulkan-drivers)"
    ]
}

impl StudyError {
    /// What does not fit of a site's choices.
    pub(super) fn of_site(site: &Site, misfit: Misfit) -> StudyError {
        match site.by_file.technique_at(&misfit) {
            Some(at) => StudyError::FileMisfit { misfit, at: at.clone() },
            None => misfit.into(),
        }
    }

    /// What keeping given hours needs and a site lacks.
    pub(crate) fn hours_need(needs: &[RuleNeed]) -> StudyError {
        let what = needs.iter().map(|need| need.what.as_str()).collect::<Vec<_>>().join("; ");
        StudyError::Rule(Message { what: pieces![Field::Hours, format!(" needs {what}")], hint: to_add(needs) })
    }

    /// Whether the command line was wrong (exit status 2).
    pub fn is_wrong_use(&self) -> bool {
        use StudyError::{Conflict, FileMisfit, LittleMemory, Misfit, NoEnvelope, Rule, TooManyCells, TooManyRays};
        matches!(
            self,
            Conflict { .. }
                | Misfit(_)
                | FileMisfit { .. }
                | LittleMemory { .. }
                | TooManyCells { .. }
                | Rule(_)
                | NoEnvelope { .. }
                | TooManyRays { .. }
        )
    }

    /// The failure of a graphics device during the work, if that is the error. Another device could do the work.
    pub(crate) fn lost_device(&self) -> Option<&GpuError> {
        match self {
            StudyError::Gpu(error) | StudyError::Shadow(ShadowError::Gpu(error)) => Some(error),
            _ => None,
        }
        .filter(|error| matches!(error, GpuError::Lost { .. }))
    }
}

fn no_envelope(rule: &str, why: &str) -> Message {
    message![
        format!("{rule}: {why}, so it does not say how high may be built");
        "take a rule that says how much sun must stay"
    ]
}

fn too_many_rays(rays: i64, most: i64) -> Message {
    message![
        format!("{rays} seconds of sun, counted for each point, are more than {most}");
        "ask for fewer days, or less of the site"
    ]
}

/// An amount of memory as a budget is written, rounded up.
fn amount(bytes: u64) -> String {
    if bytes < 10 << 20 {
        return format!("{}KiB", bytes.div_ceil(1 << 10));
    }
    format!("{}MiB", bytes.div_ceil(1 << 20))
}
