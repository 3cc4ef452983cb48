//! Why a deliverable could not be made.

use super::lines::{LinesError, by_clock};
use crate::export::ExportError;
use crate::message::{Field, Message, MessagePart, Worded, message, pieces, plain_display};
use crate::study::StudyError;
use crate::sun::Zone;
use crate::volume::solid::SolidError;
use chrono::DateTime;

/// Why a deliverable could not be made, in one line.
#[derive(Debug, thiserror::Error)]
pub enum DeliverError {
    /// The study failed.
    Study(#[from] StudyError),
    /// The answer could not be written.
    Export(#[from] ExportError),
    /// The lines of such a study cannot be drawn.
    Lines(#[from] LinesError),
    /// The study has more instants than an animation has frames.
    TooManyFrames {
        /// The number of instants.
        count: usize,
        /// The greatest number of frames.
        most: usize,
    },
    /// There are more points than have their skies drawn at once.
    TooManySkies {
        /// The number of points.
        count: usize,
        /// The greatest number of drawings.
        most: usize,
    },
    /// Nothing casts a shadow at night.
    Night {
        /// The time.
        time: DateTime<Zone>,
        /// The sun's depth below the horizon, degrees.
        below_deg: f64,
    },
    /// The shadow volumes do not make solids.
    Solid(#[from] SolidError),
}

plain_display!(DeliverError);

impl Worded for DeliverError {
    fn message(&self) -> Message {
        match self {
            DeliverError::Study(error) => error.message(),
            DeliverError::Export(error) => error.message(),
            DeliverError::Lines(error) => error.message(),
            DeliverError::TooManyFrames { count, most } => message![
                format!("the study has {count} instants, but an animation has at most {most} frames");
                "choose a longer ", Field::Step, ", or fewer hours", by_clock()
            ],
            DeliverError::TooManySkies { count, most } => message![
                Field::Sky, format!(": there are {count} points, and each has a drawing of its own, at most {most} at once");
                "ask for fewer points, or leave it out"
            ],
            DeliverError::Night { time, below_deg } => message![
                format!(
                    "no sun at {}: it is {below_deg:.1}° below the horizon, and nothing casts a shadow",
                    time.format("%Y-%m-%d %H:%M")
                );
                "choose a time of day", MessagePart::Where(Field::At, pieces![" for ", Field::At])
            ],
            DeliverError::Solid(error) => error.to_string().into(),
        }
    }
}

impl DeliverError {
    /// Whether parts of the request contradict each other or the site.
    pub fn is_wrong_use(&self) -> bool {
        match self {
            DeliverError::Study(error) => error.is_wrong_use(),
            DeliverError::Export(error) => error.is_wrong_use(),
            DeliverError::Lines(_) | DeliverError::TooManyFrames { .. } | DeliverError::TooManySkies { .. } => true,
            DeliverError::Night { .. } | DeliverError::Solid(_) => false,
        }
    }

    /// Whether the user stopped the work.
    pub fn is_interrupted(&self) -> bool {
        matches!(self, DeliverError::Study(StudyError::Interrupted))
    }
}
