//! `gnomon profile --draw`: drawings of lines, beside the profile's other files.

use super::WrongUse;
use crate::export::ExportError;
use crate::export::figure::{self, MOST_OUTLINES, Outline, Scene};
use crate::profile::Profile;
use crate::sun::{Instant, SunTrack};
use crate::view::SurfaceRows;
use clap::{Args, ValueEnum};

/// What is drawn with lines.
#[derive(Debug, Args)]
pub(super) struct LinesArgs {
    /// Also drawings of lines, each as PNG and SVG: hours (a labelled line for each whole hour of shadow), outlines (the
    /// border of each instant's shadow with its time: at most 24 instants with a sun, in one window)
    #[arg(long = "draw", value_name = "hours,outlines", value_delimiter = ',')]
    lines: Vec<Lines>,
}

/// A drawing of lines.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Lines {
    Hours,
    Outlines,
}

impl Lines {
    /// Errs where a drawing of such a study would show nothing, or more than can be told apart.
    pub(crate) fn check(self, track: &SunTrack) -> Result<(), WrongUse> {
        let day: Vec<&Instant> = track.instants.iter().filter(|instant| !instant.night).collect();
        let (Some(first), Some(last)) = (day.first(), day.last()) else {
            let what =
                "--draw: there is no sun at any of the study's instants; take a window by day with --from and --to";
            return Err(WrongUse(what.to_owned()));
        };
        if self == Lines::Hours {
            return Ok(());
        }
        // a single window is shorter than a day, so that no clock time comes twice
        let date = first.time.date_naive();
        if track.each_day.is_some() && date != last.time.date_naive() {
            let what = format!(
                "--draw outlines is for one day, and these instants lie on several; take one without dates: --date {date} \
                 with --from and --to"
            );
            return Err(WrongUse(what));
        }
        if day.len() > MOST_OUTLINES {
            let secs = (last.time - first.time).num_seconds();
            let fits = |minutes: &&i64| secs / (**minutes * 60) < MOST_OUTLINES as i64;
            let step = [1, 2, 5, 10, 15, 20, 30, 60].iter().find(fits).unwrap_or(&120);
            let what = format!(
                "--draw outlines: {} instants with a sun are too many to tell apart, at most {MOST_OUTLINES} are drawn; take a \
                 longer --step, as {step}min, or a shorter window with --from and --to",
                day.len()
            );
            return Err(WrongUse(what));
        }
        Ok(())
    }

    /// What the files are called.
    pub(crate) fn names(self) -> [&'static str; 2] {
        match self {
            Lines::Hours => ["hours.png", "hours.svg"],
            Lines::Outlines => ["outlines.png", "outlines.svg"],
        }
    }

    /// The files, by their names.
    pub(crate) fn files<S: SurfaceRows>(
        self,
        scene: &Scene<S>,
        profile: &Profile,
        outlines: &[Outline],
    ) -> Result<[(&'static str, Vec<u8>); 2], ExportError> {
        let drawing = match self {
            Lines::Hours => figure::iso_hours(scene, profile)?,
            Lines::Outlines => figure::outlines(scene, &profile.grid, outlines)?,
        };
        let [png, svg] = self.names();
        Ok([(png, drawing.png()?), (svg, drawing.svg().into_bytes())])
    }
}

impl LinesArgs {
    /// Whether there is any.
    pub(super) fn given(&self) -> bool {
        !self.lines.is_empty()
    }

    /// Whether each instant's shadow is needed.
    pub(super) fn outlines(&self) -> bool {
        self.lines.contains(&Lines::Outlines)
    }

    /// As [`Lines::check`], for all that are asked for.
    pub(super) fn check(&self, track: &SunTrack) -> Result<(), WrongUse> {
        self.lines.iter().try_for_each(|lines| lines.check(track))
    }

    /// What the files of all of them are called.
    pub(super) fn names(&self) -> impl Iterator<Item = &'static str> {
        self.lines.iter().flat_map(|lines| lines.names())
    }

    /// The files, by their names.
    pub(super) fn files<S: SurfaceRows>(
        &self,
        scene: &Scene<S>,
        profile: &Profile,
        outlines: &[Outline],
    ) -> Result<Vec<(&'static str, Vec<u8>)>, ExportError> {
        let mut files = Vec::new();
        for lines in [Lines::Hours, Lines::Outlines].into_iter().filter(|lines| self.lines.contains(lines)) {
            files.extend(lines.files(scene, profile, outlines)?);
        }
        Ok(files)
    }
}
