//! Why there is no deliverable.

use super::lines::LinesError;
use crate::export::ExportError;
use crate::study::StudyError;
use crate::sun::Zone;
use crate::volume::solid::SolidError;
use chrono::DateTime;
use std::error::Error;
use std::iter;

/// Why there is no deliverable. One line each.
#[derive(Debug, thiserror::Error)]
pub enum DeliverError {
    /// The study has no answer.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// The answer did not become files.
    #[error(transparent)]
    Export(#[from] ExportError),
    /// Lines cannot be drawn of such a study.
    #[error(transparent)]
    Lines(#[from] LinesError),
    /// There are more pictures than an animation has.
    #[error(
        "the study has {count} instants, and an animation at most {most} frames; take a longer step, or fewer hours"
    )]
    TooManyFrames {
        /// How many instants there are.
        count: usize,
        /// How many frames there can be.
        most: usize,
    },
    /// Nothing casts a shadow at night.
    #[error(
        "no sun at {}: it is {below_deg:.1}° below the horizon, and nothing casts a shadow; take a time of day",
        time.format("%Y-%m-%d %H:%M")
    )]
    Night {
        /// When.
        time: DateTime<Zone>,
        /// How far below the horizon the sun is, degrees.
        below_deg: f64,
    },
    /// The shadow volumes make no solids.
    #[error(transparent)]
    Solid(#[from] SolidError),
}

impl DeliverError {
    /// Whether what was asked does not go together, or not with the site.
    pub fn is_wrong_use(&self) -> bool {
        match self {
            DeliverError::Study(error) => error.is_wrong_use(),
            DeliverError::Export(error) => error.is_wrong_use(),
            DeliverError::Lines(_) | DeliverError::TooManyFrames { .. } => true,
            DeliverError::Night { .. } | DeliverError::Solid(_) => false,
        }
    }

    /// Whether somebody ended the work.
    pub fn is_interrupted(&self) -> bool {
        matches!(self, DeliverError::Study(StudyError::Interrupted))
    }
}

/// An error and its causes in one line; causes that the message already tells are not told again.
pub fn one_line(error: &(dyn Error + 'static)) -> String {
    let mut line = String::new();
    for cause in iter::successors(Some(error), |&error| error.source()) {
        let cause = cause.to_string().split_whitespace().collect::<Vec<_>>().join(" ");
        if line.is_empty() {
            line = cause;
        } else if !line.contains(&cause) {
            line = format!("{line}: {cause}");
        }
    }
    line
}
