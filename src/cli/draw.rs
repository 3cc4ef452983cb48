//! `gnomon profile --draw`: line drawings among the profile's files.

use crate::deliver::lines::Lines;
use clap::{Args, ValueEnum};

/// What is drawn with lines.
#[derive(Debug, Args)]
pub(super) struct LinesArgs {
    /// Also line drawings, each as PNG and SVG: hours (a labelled line for each whole hour of shadow), outlines (the
    /// border of each instant's shadow with its time, for at most 24 instants with a sun, in one window)
    #[arg(long = "draw", value_name = "hours,outlines", value_delimiter = ',')]
    lines: Vec<Draw>,
}

/// A line drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Draw {
    Hours,
    Outlines,
}

impl LinesArgs {
    /// Whether there are any.
    pub(super) fn given(&self) -> bool {
        !self.lines.is_empty()
    }

    /// The requested ones, without repetition.
    pub(super) fn lines(&self) -> Vec<Lines> {
        let all = [(Draw::Hours, Lines::Hours), (Draw::Outlines, Lines::Outlines)];
        all.into_iter().filter(|(draw, _)| self.lines.contains(draw)).map(|(_, lines)| lines).collect()
    }
}
