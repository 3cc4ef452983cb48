//! The options as the user writes them. Each is accepted only by the subcommands that use it.

use super::draw::LinesArgs;
use super::eye::Viewpoint;
use super::memory;
use super::model::{GroundArgs, ModelArgs};
use super::options::nothing_asked;
pub(super) use super::technique::DrawArgs;
use super::technique::{self, FinderArgs, MapArgs};
use super::values;
use super::wrong_use::WrongUse;
use crate::choice::Receivers;
use crate::formats::is_model;
use crate::message::Field;
use crate::site::{Overrides, SiteError, inputs};
use crate::study::verify::SIZE;
use clap::{Args, ValueEnum, value_parser};
use std::path::{Path, PathBuf};

/// The options of every subcommand.
#[derive(Debug, Args)]
pub(super) struct Common {
    /// Print the results as JSON
    #[arg(long)]
    pub(super) json: bool,
    /// Print no progress and no notes
    #[arg(long)]
    pub(super) quiet: bool,
    /// Threads on the processor [default: one per core]
    #[arg(long, value_name = "N", value_parser = value_parser!(u16).range(1..=1024), allow_negative_numbers = true)]
    pub(super) threads: Option<u16>,
}

/// The site: its files, its place and its ground.
#[derive(Debug, Args)]
pub(super) struct SiteArgs {
    /// A site file, a folder that contains a site.toml, or one or more models. Without a site file, the place comes
    /// from a model's file or --place
    #[arg(value_name = "SITE", required = true)]
    paths: Vec<PathBuf>,
    #[command(flatten)]
    place: PlaceArgs,
    #[command(flatten)]
    ground: GroundArgs,
}

/// The place of the models, and the air.
#[derive(Debug, Args)]
pub(super) struct PlaceArgs {
    /// The place of the models, degrees north and east: 48.8583,2.2945 [default: from a model's file]
    #[arg(long, value_name = "LAT,LON", allow_hyphen_values = true)]
    place: Option<String>,
    /// Directions without atmospheric refraction
    #[arg(long)]
    no_refraction: bool,
}

/// The study's window.
#[derive(Debug, Args)]
pub(super) struct WindowArgs {
    /// Date of the study: 2026-09-18
    #[arg(long, value_name = "DATE", allow_hyphen_values = true)]
    date: Option<String>,
    /// Several days with the same window: the first one. With --to-date
    #[arg(long, value_name = "DATE", allow_hyphen_values = true)]
    from_date: Option<String>,
    /// The last of several days, at most ten years later
    #[arg(long, value_name = "DATE", allow_hyphen_values = true)]
    to_date: Option<String>,
    /// Beginning of the window: 10:00, sunrise+1h30 [default: from the site file; with several days, otherwise the
    /// whole days]
    #[arg(long, value_name = "TIME", allow_hyphen_values = true)]
    from: Option<String>,
    /// End of the window: 14:00, sunset-1h30 [default: as --from]
    #[arg(long, value_name = "TIME", allow_hyphen_values = true)]
    to: Option<String>,
    /// Time between instants: 30min, 1h, 1h30, 90s
    #[arg(long, value_name = "STEP", allow_hyphen_values = true)]
    step: Option<String>,
}

/// The precision of hours between instants.
#[derive(Debug, Args)]
pub(super) struct ResolutionArgs {
    /// Precision of the times at which light changes between two instants: 1min, 10s; step to use the instants alone
    /// [default: on a single day 1min, or the step if that is shorter; on several days step]
    #[arg(long, value_name = "TIME", allow_hyphen_values = true)]
    resolution: Option<String>,
}

impl ResolutionArgs {
    pub(super) fn onto(&self, asked: Overrides) -> Result<Overrides, SiteError> {
        Ok(Overrides { resolution_secs: values::resolution_secs(&self.resolution)?, ..asked })
    }
}

/// The plan.
#[derive(Debug, Args)]
pub(super) struct PlanArgs {
    /// West, south, east and north border, metres from the place: -300,-300,300,300 [default: models and shadows]
    #[arg(long, value_name = "W,S,E,N", allow_hyphen_values = true)]
    region: Option<String>,
    /// Side of a cell, metres
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
    cell: Option<f64>,
    /// Cells along the longer side [default: 2048]
    #[arg(long, value_name = "PIXELS", allow_negative_numbers = true)]
    size: Option<u32>,
    /// What is judged: top (the highest surface, ground included), ground, or with profile surfaces (walls and roofs)
    #[arg(long, value_name = "NAME")]
    receivers: Option<Receivers>,
}

impl PlanArgs {
    /// The options that were given.
    pub(super) fn given(&self) -> Vec<&'static str> {
        let given = [
            ("--region", self.region.is_some()),
            ("--cell", self.cell.is_some()),
            ("--size", self.size.is_some()),
            ("--receivers", self.receivers.is_some()),
        ];
        given.into_iter().filter(|(_, given)| *given).map(|(name, _)| name).collect()
    }
}

#[derive(Debug, Args)]
pub(super) struct ProfileArgs {
    #[command(flatten)]
    pub(super) site: SiteArgs,
    #[command(flatten)]
    model: ModelArgs,
    #[command(flatten)]
    window: WindowArgs,
    #[command(flatten)]
    resolution: ResolutionArgs,
    #[command(flatten)]
    draw: DrawArgs,
    #[command(flatten)]
    pub(super) plan: PlanArgs,
    /// With --receivers surfaces: side of a texel, metres; larger if there would be too many [default: 0.25]
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
    patch_cell: Option<f64>,
    /// Folder for the files
    #[arg(long, value_name = "DIR", default_value = "out")]
    pub(super) out: PathBuf,
    /// Also every instant's mask, as mask-0000.png … in this folder
    #[arg(long, value_name = "DIR")]
    pub(super) masks: Option<PathBuf>,
    /// Also shadow.bits: one bit per cell for every instant with a sun, for later analysis
    #[arg(long)]
    pub(super) bits: bool,
    /// Memory for everything that grows with the number of cells, such as 512MiB or 2GB. A plan that needs more is done
    /// in tiles, with the same results. Models, the program and the adapter's driver are not included [default: no
    /// limit]
    #[arg(long, value_name = "SIZE", value_parser = memory::parse, allow_hyphen_values = true)]
    pub(super) memory: Option<u64>,
    #[arg(long, help = technique::stats())]
    pub(super) stats: bool,
    /// Files to write [default: png,tif,json; with --receivers surfaces png,glb,csv,json]
    #[arg(long, value_name = "png,tif,glb,csv,json", value_delimiter = ',')]
    write: Vec<ProfileFile>,
    #[command(flatten)]
    pub(super) lines: LinesArgs,
    #[command(flatten)]
    pub(super) common: Common,
}

/// A file of the profile.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum ProfileFile {
    Png,
    Tif,
    Glb,
    Csv,
    Json,
}

#[derive(Debug, Args)]
pub(super) struct ShadowArgs {
    #[command(flatten)]
    pub(super) site: SiteArgs,
    #[command(flatten)]
    model: ModelArgs,
    /// The instant in local time: 2026-09-18T15:00
    #[arg(long, value_name = "T", required = true, allow_hyphen_values = true)]
    at: Option<String>,
    /// Date for an instant without one: 2026-09-18
    #[arg(long, value_name = "DATE", allow_hyphen_values = true)]
    date: Option<String>,
    #[command(flatten)]
    draw: DrawArgs,
    #[command(flatten)]
    pub(super) plan: PlanArgs,
    #[arg(long, help = technique::stats())]
    pub(super) stats: bool,
    /// The view
    #[arg(long, value_name = "NAME", value_enum, default_value_t = Viewpoint::Plan)]
    pub(super) view: Viewpoint,
    #[arg(long, value_name = "volumes,silhouette,components|mask|overdraw", value_delimiter = ',',
          help = technique::show())]
    pub(super) show: Vec<ShowArg>,
    /// The drawing [default: shadow.png, or none with --mask]
    #[arg(long, value_name = "FILE.png")]
    pub(super) out: Option<PathBuf>,
    /// The mask: 255 sees the whole sun, 0 none of it
    #[arg(long, value_name = "FILE.png")]
    pub(super) mask: Option<PathBuf>,
    #[command(flatten)]
    pub(super) common: Common,
}

/// What a camera's drawing shows besides sun and shadow.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum ShowArg {
    Volumes,
    Silhouette,
    Components,
    Mask,
    Overdraw,
}

#[derive(Debug, Args)]
pub(super) struct SunArgs {
    /// A site file, a folder that contains a site.toml, or a model. Without a site file, the place comes from the
    /// model's file or --place
    #[arg(value_name = "SITE")]
    pub(super) path: PathBuf,
    #[command(flatten)]
    place: PlaceArgs,
    #[command(flatten)]
    window: WindowArgs,
    /// One instant instead of the study, in local time: 2026-09-18T15:00
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    at: Option<String>,
    #[command(flatten)]
    pub(super) common: Common,
}

#[derive(Debug, Args)]
pub(super) struct CheckArgs {
    /// One or more models, or sites with their models. Several models are checked as one site; if there is a site among
    /// them, each is checked separately
    #[arg(value_name = "MODEL", required = true)]
    paths: Vec<PathBuf>,
    #[command(flatten)]
    pub(super) model: ModelArgs,
    /// List all names, everything that was left out, and all components that are not clean
    #[arg(long, conflicts_with = "json")]
    pub(super) all: bool,
    #[command(flatten)]
    pub(super) common: Common,
}

impl CheckArgs {
    /// What is checked together: each a first path, and the others.
    pub(super) fn together(&self) -> Vec<(&Path, Vec<PathBuf>)> {
        match self.paths.as_slice() {
            [first, others @ ..] if self.paths.iter().all(|path| is_model(path)) => vec![(first, others.to_vec())],
            paths => paths.iter().map(|path| (path.as_path(), Vec::new())).collect(),
        }
    }
}

#[derive(Debug, Args)]
pub(super) struct VolumesArgs {
    #[command(flatten)]
    pub(super) site: SiteArgs,
    #[command(flatten)]
    model: ModelArgs,
    /// The instant in local time: 2026-09-18T15:00
    #[arg(long, value_name = "T", required = true, allow_hyphen_values = true)]
    at: Option<String>,
    /// Date for an instant without one: 2026-09-18
    #[arg(long, value_name = "DATE", allow_hyphen_values = true)]
    date: Option<String>,
    /// The file
    #[arg(long, value_name = "FILE.glb", default_value = "volumes.glb")]
    pub(super) out: PathBuf,
    #[command(flatten)]
    pub(super) common: Common,
}

#[derive(Debug, Args)]
pub(super) struct VerifyArgs {
    #[command(flatten)]
    pub(super) site: SiteArgs,
    #[command(flatten)]
    model: ModelArgs,
    #[command(flatten)]
    window: WindowArgs,
    /// One instant instead of the study, in local time: 2026-09-18T15:00
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    at: Option<String>,
    #[command(flatten)]
    finder: FinderArgs,
    #[command(flatten)]
    maps: MapArgs,
    /// Points of the sun's disc in ray casting for smoothies, 1 to 1024 [default: 64]
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..=1024), allow_negative_numbers = true)]
    sun_samples: Option<u32>,
    #[command(flatten)]
    plan: PlanArgs,
    #[command(flatten)]
    pub(super) common: Common,
}

impl SiteArgs {
    pub(super) fn overrides(&self) -> Result<Overrides, SiteError> {
        let beside = self.paths.get(1..).unwrap_or_default().to_vec();
        Ok(Overrides { beside, ..self.ground.onto(self.place.overrides()?) })
    }

    /// The site, or the first of several models.
    pub(super) fn path(&self) -> &Path {
        self.paths.first().map_or(Path::new(""), PathBuf::as_path)
    }

    /// The files that the request is read from.
    pub(super) fn inputs(&self) -> Result<Vec<PathBuf>, SiteError> {
        Ok(self.paths.iter().map(|path| inputs(path)).collect::<Result<Vec<_>, _>>()?.concat())
    }
}

impl PlaceArgs {
    pub(super) fn overrides(&self) -> Result<Overrides, SiteError> {
        Ok(Overrides { place: values::place(&self.place)?, no_refraction: self.no_refraction, ..nothing_asked() })
    }
}

impl WindowArgs {
    pub(super) fn onto(&self, asked: Overrides) -> Result<Overrides, SiteError> {
        Ok(Overrides {
            date: values::date(Field::Date, &self.date)?,
            from_date: values::date(Field::FromDate, &self.from_date)?,
            to_date: values::date(Field::ToDate, &self.to_date)?,
            from: values::reading(Field::From, &self.from)?,
            to: values::reading(Field::To, &self.to)?,
            step_secs: values::step_secs(&self.step)?,
            ..asked
        })
    }
}

impl PlanArgs {
    pub(super) fn onto(&self, asked: Overrides) -> Result<Overrides, SiteError> {
        let PlanArgs { ref region, cell, size, receivers } = *self;
        Ok(Overrides { region: values::region(region)?, cell, size, receivers, ..asked })
    }
}

impl ProfileArgs {
    pub(super) fn overrides(&self) -> Result<Overrides, SiteError> {
        let asked = self.draw.onto(self.window.onto(self.model.onto(self.site.overrides()?))?);
        let asked = self.plan.onto(self.resolution.onto(asked)?)?;
        Ok(Overrides { patch_cell: self.patch_cell, ..asked })
    }

    /// The requested files among the possible ones; by default all of those.
    pub(super) fn wanted(&self, possible: &[ProfileFile]) -> Result<Vec<ProfileFile>, WrongUse> {
        let word =
            |kind: &ProfileFile| kind.to_possible_value().map_or_else(String::new, |it| it.get_name().to_owned());
        if let Some(kind) = self.write.iter().find(|kind| !possible.contains(kind)) {
            let known: Vec<_> = possible.iter().map(word).collect();
            let what =
                format!("--write {}: these receivers have only {}; choose from those", word(kind), known.join(", "));
            return Err(WrongUse(what));
        }
        Ok(if self.write.is_empty() { possible.to_vec() } else { self.write.clone() })
    }
}

impl ShadowArgs {
    pub(super) fn overrides(&self) -> Result<Overrides, SiteError> {
        let asked = self.plan.onto(self.draw.onto(self.model.onto(self.site.overrides()?)))?;
        let (at, date) = (values::reading(Field::At, &self.at)?, values::date(Field::Date, &self.date)?);
        Ok(Overrides { at, date, side: self.view.side(), ..asked })
    }
}

impl SunArgs {
    pub(super) fn overrides(&self) -> Result<Overrides, SiteError> {
        Ok(Overrides { at: values::reading(Field::At, &self.at)?, ..self.window.onto(self.place.overrides()?)? })
    }
}

impl VolumesArgs {
    pub(super) fn overrides(&self) -> Result<Overrides, SiteError> {
        let (at, date) = (values::reading(Field::At, &self.at)?, values::date(Field::Date, &self.date)?);
        Ok(Overrides { at, date, ..self.model.onto(self.site.overrides()?) })
    }
}

impl VerifyArgs {
    pub(super) fn overrides(&self) -> Result<Overrides, SiteError> {
        let asked = self.finder.onto(self.window.onto(self.model.onto(self.site.overrides()?))?);
        let asked = self.plan.onto(asked)?;
        let size = asked.size.or(asked.cell.is_none().then_some(SIZE));
        let at = values::reading(Field::At, &self.at)?;
        Ok(Overrides { at, settings: self.maps.settings(self.sun_samples), size, ..asked })
    }
}
