//! `gnomon probe`: when points lie in the sun.

use super::arguments::{Common, SiteArgs};
use super::commands::lines;
use super::model::ModelArgs;
use super::options::Options;
use super::output::say;
use super::progress::Progress;
use super::values;
use super::wrong_use::WrongUse;
use crate::deliver::Sink;
use crate::deliver::probe::{ProbeAnswer, ProbeRequest, probe as deliver};
use crate::export::probe as told;
use crate::message::Field;
use crate::site::{Overrides, SiteError, load_probes};
use clap::Args;
use std::ffi::OsStr;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(super) struct ProbeArgs {
    #[command(flatten)]
    site: SiteArgs,
    #[command(flatten)]
    model: ModelArgs,
    /// One point instead of the site file's [[probe]]s, metres east, north and up of the place: 12,-3,4.5
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    point: Option<String>,
    /// With --point: the direction that the point faces, like a window; it sees only what is in front of its plane
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    normal: Option<String>,
    /// Points from a table instead: CSV whose first line is name,x,y,z,nx,ny,nz; the last three, a normal, may be
    /// absent or empty
    #[arg(long, value_name = "FILE.csv")]
    points: Option<PathBuf>,
    /// Points on the components with this name, as in `casts`: IfcWindow. One in the middle of each connected piece, on
    /// its outer side, which is the one more open to the sky. May be repeated
    #[arg(long, value_name = "NAME")]
    on: Vec<String>,
    /// With --on and --height: points at this spacing in metres along the upright faces of these components
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
    spacing: Option<f64>,
    /// With --on and --spacing: the points' height above the ground, metres
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
    height: Option<f64>,
    /// The day [default: the study's date]
    #[arg(long, value_name = "DATE", allow_hyphen_values = true)]
    date: Option<String>,
    /// Several days: the first one. With --to-date
    #[arg(long, value_name = "DATE", allow_hyphen_values = true)]
    from_date: Option<String>,
    /// The last of several days, at most ten years later
    #[arg(long, value_name = "DATE", allow_hyphen_values = true)]
    to_date: Option<String>,
    /// Beginning of the time on each day: 10:00, sunrise+1h30 [default: the whole day]
    #[arg(long, value_name = "TIME", allow_hyphen_values = true)]
    from: Option<String>,
    /// End of the time on each day: 14:00, sunset-1h30 [default: the whole day]
    #[arg(long, value_name = "TIME", allow_hyphen_values = true)]
    to: Option<String>,
    /// A drawing: time of day across, days down
    #[arg(long, value_name = "FILE.png")]
    out: Option<PathBuf>,
    /// A table with a line per interval: probe,start,end,seconds,blocked_before,blocked_after
    #[arg(long, value_name = "FILE.csv")]
    csv: Option<PathBuf>,
    /// A table of the seconds in the sun by day, month and year: probe,unit,date,days,seconds,longest_seconds,intervals
    #[arg(long, value_name = "FILE.csv")]
    totals: Option<PathBuf>,
    /// The sky of each point, as a stereographic and a cylindrical sun-path chart on one sheet: the sun's ways, hours of
    /// clock and sundial, what stands before them, and the sun that the point sees. PNG, or SVG by its ending; of several
    /// points each has its number in the name: sky-1.png
    #[arg(long, value_name = "FILE.png|svg")]
    sky: Option<PathBuf>,
    #[command(flatten)]
    pub(super) common: Common,
}

impl ProbeArgs {
    fn overrides(&self) -> Result<Overrides, SiteError> {
        Ok(Overrides {
            point: values::point(&self.point)?,
            normal: values::normal(&self.normal)?,
            points: self.points.clone(),
            on: self.on.clone(),
            spacing: self.spacing,
            height: self.height,
            date: values::date(Field::Date, &self.date)?,
            from_date: values::date(Field::FromDate, &self.from_date)?,
            to_date: values::date(Field::ToDate, &self.to_date)?,
            from: values::reading(Field::From, &self.from)?,
            to: values::reading(Field::To, &self.to)?,
            ..self.model.onto(self.site.overrides()?)
        })
    }
}

pub(super) fn probe(asked: &ProbeArgs) -> anyhow::Result<()> {
    let files = [
        ("--out", &["png"][..], &asked.out),
        ("--csv", &["csv"], &asked.csv),
        ("--totals", &["csv"], &asked.totals),
        ("--sky", &["png", "svg"], &asked.sky),
    ];
    for (option, formats, path) in
        files.iter().filter_map(|(option, formats, path)| Some((option, formats, path.as_ref()?)))
    {
        let is_one = |extension: &OsStr| formats.iter().any(|format| extension.eq_ignore_ascii_case(format));
        if !path.extension().is_some_and(is_one) {
            let named: Vec<_> = formats.iter().map(|format| format!(".{format}")).collect();
            let what = format!(
                "{option} writes {}; name a {} file instead of {}",
                formats.join(" or ").to_uppercase().replace(" OR ", " or "),
                named.join(" or "),
                path.display()
            );
            return Err(WrongUse(what).into());
        }
    }
    let probing = load_probes(asked.site.path(), &asked.overrides()?)?;
    let request = ProbeRequest {
        drawing: asked.out.clone(),
        table: asked.csv.clone(),
        totals: asked.totals.clone(),
        sky: asked.sky.clone(),
        words: &Options,
    };
    let mut progress = Progress::of("days", asked.common.quiet);
    let mut inputs = asked.site.inputs()?;
    inputs.extend(asked.points.clone());
    let sink = Sink::Paths { inputs: &inputs };
    let ProbeAnswer { sunlight, notes, written } =
        deliver(&probing, &request, sink, &mut |event| progress.heard(&event))?;
    match asked.common.json {
        true => say(&told::json(&sunlight, &probing.place, &probing.ground, (&notes, &Options))?),
        false => say(&(told::table(&sunlight, &probing.place, &probing.ground) + &lines(&written))),
    }
}
