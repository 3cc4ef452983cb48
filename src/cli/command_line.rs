//! The command line and its subcommands.

use super::animate::AnimateArgs;
use super::arguments::{CheckArgs, Common, ProfileArgs, ShadowArgs, SunArgs, VerifyArgs, VolumesArgs};
use super::compare::CompareArgs;
use super::convert::ConvertArgs;
use super::envelope::EnvelopeArgs;
use super::judge::JudgeArgs;
use super::probe::ProbeArgs;
use super::read_model::ReadModelArgs;
use super::rules::RulesArgs;
use crate::formats::child;
use crate::sun::ZoneRules;
use clap::{Args, Parser, Subcommand};
use std::path::PathBuf;
use std::sync::LazyLock;

/// Where, when and for how long a building takes the sun away: exact shadows and shadow profiles.
#[derive(Debug, Parser)]
#[command(name = "gnomon", version = version(), after_help = "Without a command the window opens.")]
pub(super) struct Arguments {
    #[command(subcommand)]
    pub(super) command: Option<Command>,
}

/// The version of the program, and that of the time zone database.
fn version() -> &'static str {
    static VERSION: LazyLock<String> =
        LazyLock::new(|| format!("{} (tz {})", env!("CARGO_PKG_VERSION"), ZoneRules::newest().version()));
    &VERSION
}

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Open the window, with a site or a model in it
    Open(OpenArgs),
    /// The shadow profile of a study: profile.png, shadow-hours.tif, profile.json. The same command continues a study
    /// that was stopped, except with outlines (--draw)
    Profile(ProfileArgs),
    /// Two states of a site, existing and proposed: hours of sun lost and gained, with the areas, as compare.png,
    /// shadow-hours-difference.tif and compare.json. Study, plan and ground of the first state apply to both
    Compare(CompareArgs),
    /// The shadows at one instant, as a drawing or as a mask
    Shadow(ShadowArgs),
    /// The study's instants as pictures, frame-0000.png …, and as an animated GIF, day.gif, nights included
    Animate(AnimateArgs),
    /// The sun at the study's instants: time, azimuth, altitude, weight; sunrise, noon, sunset
    Sun(SunArgs),
    /// The contents of a model's file (format, unit, axis, place, north), what was left out, and the state of its mesh:
    /// components, triangles, open, crowded, flipped and degenerate parts
    Check(CheckArgs),
    /// A model as it was read, with its components, as glTF in metres and y up, for viewing and for other programs
    Convert(ConvertArgs),
    /// The shadow volumes at one instant as solids down to the ground, in a .glb for other programs
    Volumes(VolumesArgs),
    /// Every technique against ray casting on this site, on the plan or on façades and roofs: how many cells differ, how far,
    /// by how many hours
    #[command(mut_arg("size", |size| size.help("Cells along the longer side [default: 512]")))]
    Verify(VerifyArgs),
    /// When points lie in the sun, on one day or a range of dates: to the second, with what blocks it at other times
    Probe(ProbeArgs),
    /// Whether a site keeps an authority's rule: the verdict of each area, window, façade or band and of the whole, the
    /// margin, the day and the point that decide, and who takes the sun. Exit status 0 passes, 1 does not (or is too close to
    /// say), 3 only reports
    Judge(JudgeArgs),
    /// How high may be built on the site's plot, such that what a rule protects keeps its sun: heights as a GeoTIFF, a drawing
    /// and a solid
    Envelope(EnvelopeArgs),
    /// The built-in rules of authorities, with edition, source and options; or the text of one
    Rules(RulesArgs),
    /// Read a model for the program itself
    #[command(name = child::SUBCOMMAND, hide = true)]
    ReadModel(ReadModelArgs),
}

impl Command {
    /// The options of every subcommand that computes something or reads a model.
    pub(super) fn common(&self) -> Option<&Common> {
        Some(match self {
            Command::Open(_) | Command::Rules(_) | Command::ReadModel(_) => return None,
            Command::Profile(asked) => &asked.common,
            Command::Compare(asked) => &asked.common,
            Command::Shadow(asked) => &asked.common,
            Command::Animate(asked) => &asked.common,
            Command::Sun(asked) => &asked.common,
            Command::Check(asked) => &asked.common,
            Command::Convert(asked) => &asked.common,
            Command::Volumes(asked) => &asked.common,
            Command::Verify(asked) => &asked.common,
            Command::Probe(asked) => &asked.common,
            Command::Judge(asked) => &asked.common,
            Command::Envelope(asked) => &asked.common,
        })
    }
}

#[derive(Debug, Args)]
pub(super) struct OpenArgs {
    /// A site file, a folder that contains a site.toml, or a model; the window asks for the place if the file has none
    #[arg(value_name = "SITE|MODEL")]
    pub(super) path: PathBuf,
}
