//! Why a deliverable could not be made.

use super::lines::{LinesError, by_clock};
use crate::export::ExportError;
use crate::message::{Field, Message, Piece, Worded, message, pieces, plain_display};
use crate::study::StudyError;
use crate::sun::Zone;
use crate::volume::solid::SolidError;
use chrono::DateTime;

/// Why a deliverable could not be made, in one line.
#[derive(Debug, thiserror::Error)]
pub enum DeliverError {
    /// The study has no answer.
    Study(#[from] StudyError),
    /// The answer could not be written.
    Export(#[from] ExportError),
    /// Lines cannot be drawn of such a study.
    Lines(#[from] LinesError),
    /// There are more pictures than an animation has.
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
        /// How far below the horizon the sun is, degrees.
        below_deg: f64,
    },
    /// The shadow volumes make no solids.
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
                format!("the study has {count} instants, and an animation at most {most} frames");
                "take a longer ", Field::Step, ", or fewer hours", by_clock()
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
                "take a time of day", Piece::Where(Field::At, pieces![" for ", Field::At])
            ],
            DeliverError::Solid(error) => error.to_string().into(),
        }
    }
}

impl DeliverError {
    /// Whether parts of the request do not fit each other or the site.
    pub fn is_wrong_use(&self) -> bool {
        match self {
            DeliverError::Study(error) => error.is_wrong_use(),
            DeliverError::Export(error) => error.is_wrong_use(),
            DeliverError::Lines(_) | DeliverError::TooManyFrames { .. } | DeliverError::TooManySkies { .. } => true,
            DeliverError::Night { .. } | DeliverError::Solid(_) => false,
        }
    }

    /// Whether somebody stopped the work.
    pub fn is_interrupted(&self) -> bool {
        matches!(self, DeliverError::Study(StudyError::Interrupted))
    }
}
