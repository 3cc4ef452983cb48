//! `gnomon profile --draw`: drawings of lines, beside the profile's other files.

use crate::deliver::lines::{Lines, LinesError};
use crate::export::figure::MOST_OUTLINES;
use clap::{Args, ValueEnum};

/// What is drawn with lines.
#[derive(Debug, Args)]
pub(super) struct LinesArgs {
    /// Also drawings of lines, each as PNG and SVG: hours (a labelled line for each whole hour of shadow), outlines (the
    /// border of each instant's shadow with its time: at most 24 instants with a sun, in one window)
    #[arg(long = "draw", value_name = "hours,outlines", value_delimiter = ',')]
    lines: Vec<Draw>,
}

/// A drawing of lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Draw {
    Hours,
    Outlines,
}

impl LinesArgs {
    /// Whether there is any.
    pub(super) fn given(&self) -> bool {
        !self.lines.is_empty()
    }

    /// Those that are asked for, each once.
    pub(super) fn lines(&self) -> Vec<Lines> {
        let all = [(Draw::Hours, Lines::Hours), (Draw::Outlines, Lines::Outlines)];
        all.into_iter().filter(|(draw, _)| self.lines.contains(draw)).map(|(_, lines)| lines).collect()
    }
}

/// Why lines cannot be drawn, in the command's words.
pub(super) fn words(error: LinesError) -> String {
    match error {
        LinesError::NoSun => {
            "--draw: there is no sun at any of the study's instants; take a window by day with --from and --to"
                .to_owned()
        }
        LinesError::SeveralDays { date } => format!(
            "--draw outlines is for one day, and these instants lie on several; take one without dates: --date {date} \
             with --from and --to"
        ),
        LinesError::TooMany { count, step_min } => format!(
            "--draw outlines: {count} instants with a sun are too many to tell apart, at most {MOST_OUTLINES} are drawn; \
             take a longer --step, as {step_min}min, or a shorter window with --from and --to"
        ),
    }
}
