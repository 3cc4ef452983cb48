//! Line drawings among a profile's files: iso-hour lines, and outlines of shadows.

use super::sink::NamedFile;
use crate::export::ExportError;
use crate::export::figure::{self, FigureContext, MOST_OUTLINES, Outline};
use crate::message::{Field, Message, MessagePart, Worded, message, pieces, plain_display};
use crate::profile::Profile;
use crate::sun::{Instant, SunTrack};
use crate::view::SurfaceRows;
use chrono::NaiveDate;

/// A line drawing, written as a PNG and an SVG.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lines {
    /// A labelled line for each whole hour of shadow.
    Hours,
    /// The border of each instant's shadow, with its time.
    Outlines,
}

/// Why a study has no line drawing: it would show nothing, or too much to be readable.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum LinesError {
    /// All instants are at night.
    NoSun,
    /// The instants are on several days, but the outlines' labels are times alone.
    SeveralDays {
        /// The first of them.
        date: NaiveDate,
    },
    /// There are too many outlines.
    TooMany {
        /// The number of instants with a sun.
        count: usize,
        /// A step with few enough outlines, minutes.
        step_min: i64,
    },
}

plain_display!(LinesError);

impl Worded for LinesError {
    fn message(&self) -> Message {
        match self {
            LinesError::NoSun => message![
                Field::Lines, ": there is no sun at any of the study's instants";
                "choose a window by day", by_clock()
            ],
            LinesError::SeveralDays { date } => message![
                Field::Outlines, " is for one day, but these instants are on several";
                "choose one day: ", (Field::Date, date.to_string()), by_clock()
            ],
            LinesError::TooMany { count, step_min } => message![
                Field::Outlines,
                format!(": {count} instants with a sun are too many to tell apart, at most {MOST_OUTLINES} are drawn");
                "choose a longer ", Field::Step, format!(", as {step_min}min, or a shorter window"), by_clock()
            ],
        }
    }
}

/// The fields that shorten a window, for faces that have them.
pub(super) fn by_clock() -> MessagePart {
    MessagePart::Where(Field::From, pieces![" with ", Field::From, " and ", Field::To])
}

impl Lines {
    /// Checks that a drawing of such a study would show something, and not too much to be readable.
    ///
    /// # Errors
    /// [`LinesError`].
    pub fn check(self, track: &SunTrack) -> Result<(), LinesError> {
        let day: Vec<&Instant> = track.instants.iter().filter(|instant| !instant.night).collect();
        let (Some(first), Some(last)) = (day.first(), day.last()) else { return Err(LinesError::NoSun) };
        if self == Lines::Hours {
            return Ok(());
        }
        // a single window is shorter than a day, so no clock time occurs twice
        let date = first.time.date_naive();
        if track.each_day.is_some() && date != last.time.date_naive() {
            return Err(LinesError::SeveralDays { date });
        }
        if day.len() > MOST_OUTLINES {
            let secs = (last.time - first.time).num_seconds();
            let fits = |minutes: &&i64| secs / (**minutes * 60) < MOST_OUTLINES as i64;
            let step_min = *[1, 2, 5, 10, 15, 20, 30, 60].iter().find(fits).unwrap_or(&120);
            return Err(LinesError::TooMany { count: day.len(), step_min });
        }
        Ok(())
    }

    /// The names of the files.
    pub fn names(self) -> [&'static str; 2] {
        match self {
            Lines::Hours => ["hours.png", "hours.svg"],
            Lines::Outlines => ["outlines.png", "outlines.svg"],
        }
    }

    /// The drawings' files. `outlines` are those of all instants with a sun.
    pub(super) fn files<S: SurfaceRows>(
        self,
        scene: &FigureContext<S>,
        profile: &Profile,
        outlines: &[Outline],
    ) -> Result<[NamedFile; 2], ExportError> {
        let drawing = match self {
            Lines::Hours => figure::iso_hours(scene, profile)?,
            Lines::Outlines => figure::outlines(scene, &profile.grid, outlines)?,
        };
        let [png, svg] = self.names();
        Ok([(png.into(), drawing.png()?), (svg.into(), drawing.svg().into_bytes())])
    }
}
