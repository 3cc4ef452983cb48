//! `gnomon envelope`: how high may be built on the site's plot.

use super::arguments::Common;
use super::output::{say, who};
use super::progress::Progress;
use super::ruled_site::{ChosenRule, JudgedSiteArgs, ReadSite};
use super::values;
use super::wrong_use::WrongUse;
use crate::deliver::envelope::{EnvelopeRequest, envelope as deliver};
use crate::deliver::{Folder, Sink};
use crate::message::Field;
use crate::rules::SunDemand;
use crate::site::{Overrides, SiteError, study_days};
use crate::sun::{DayWindow, parse_duration_secs};
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(super) struct EnvelopeArgs {
    #[command(flatten)]
    judged: JudgedSiteArgs,
    /// The rule that says what must keep its sun: the name of a file beside the site, ID.toml, or a built-in one as
    /// `gnomon rules` lists them
    #[arg(long, value_name = "ID", conflicts_with = "hours")]
    rule: Option<String>,
    /// What the rule leaves to the authority: hours=2h. May be repeated
    #[arg(long, value_name = "KEY=VALUE", allow_hyphen_values = true)]
    set: Vec<String>,
    /// Instead of a rule: all windows, areas and façades of the site keep so many hours of sun on each day of its study:
    /// 2, 1.5, 1h30
    #[arg(long, value_name = "HOURS", value_parser = hours, allow_hyphen_values = true)]
    hours: Option<i64>,
    #[command(flatten)]
    days: HoursDays,
    /// Side of a cell of the plot, metres [default: a round one, of which the longer side has 100 to 200]
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
    cell: Option<f64>,
    /// How high something may be where no sun is in the way, metres above the ground
    #[arg(long, value_name = "M", default_value_t = 100.0, allow_negative_numbers = true)]
    highest: f64,
    /// The folder for the files
    #[arg(long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
    #[command(flatten)]
    pub(super) common: Common,
}

/// The days and times whose sun counts for given hours.
#[derive(Debug, Args)]
struct HoursDays {
    /// With --hours: the day [default: the study's date or dates]
    #[arg(long, value_name = "DATE", allow_hyphen_values = true)]
    date: Option<String>,
    /// With --hours: several days, the first one. With --to-date
    #[arg(long, value_name = "DATE", allow_hyphen_values = true)]
    from_date: Option<String>,
    /// The last of several days, at most ten years later
    #[arg(long, value_name = "DATE", allow_hyphen_values = true)]
    to_date: Option<String>,
    /// With --hours: from when on the sun counts on each day: 10:00, sunrise+1h30 [default: from the site file, otherwise
    /// the whole day]
    #[arg(long, value_name = "TIME", allow_hyphen_values = true)]
    from: Option<String>,
    /// With --hours: until when the sun counts: 14:00, sunset-1h30 [default: as --from]
    #[arg(long, value_name = "TIME", allow_hyphen_values = true)]
    to: Option<String>,
}

impl HoursDays {
    /// The first of the options that was given.
    fn given(&self) -> Option<&'static str> {
        let HoursDays { date, from_date, to_date, from, to } = self;
        let given =
            [("--date", date), ("--from-date", from_date), ("--to-date", to_date), ("--from", from), ("--to", to)];
        given.into_iter().find(|(_, value)| value.is_some()).map(|(name, _)| name)
    }

    fn onto(&self, asked: Overrides) -> Result<Overrides, SiteError> {
        Ok(Overrides {
            date: values::date(Field::Date, &self.date)?,
            from_date: values::date(Field::FromDate, &self.from_date)?,
            to_date: values::date(Field::ToDate, &self.to_date)?,
            from: values::reading(Field::From, &self.from)?,
            to: values::reading(Field::To, &self.to)?,
            ..asked
        })
    }
}

/// What must keep its sun, as it was asked for.
enum AskedDemand {
    Rule(Box<ChosenRule>),
    Hours(i64, Vec<DayWindow>),
}

pub(super) fn envelope(asked: &EnvelopeArgs) -> anyhow::Result<()> {
    for (option, value, least) in [("--cell", asked.cell, 0.01), ("--highest", Some(asked.highest), 0.1)] {
        if value.is_some_and(|value| !(least..=10_000.0).contains(&value)) {
            return Err(WrongUse(format!("{option} takes {least} to 10000 metres")).into());
        }
    }
    if let (None, Some(option)) = (asked.hours, asked.days.given()) {
        let what = format!("{option} belongs to --hours: a rule has its own days and times; leave it out");
        return Err(WrongUse(what).into());
    }
    if asked.rule.is_none() && !asked.set.is_empty() {
        return Err(WrongUse("--set chooses in a rule: add --rule ID, or leave it out".to_owned()).into());
    }
    let (demand, ReadSite { site, inputs }) = read(asked)?;
    let demand = match &demand {
        AskedDemand::Rule(chosen) => SunDemand::Rule(&chosen.source, &chosen.rule),
        AskedDemand::Hours(secs, days) => SunDemand::Hours(*secs, days),
    };
    let request = EnvelopeRequest { demand, cell_m: asked.cell, highest_m: asked.highest };
    let mut progress = Progress::of("days", asked.common.quiet);
    let sink = Sink::Folder(Folder { path: &asked.out, who: &who(), inputs: &inputs });
    let answer = deliver(&site, request, sink, &mut |event| progress.heard(&event))?;
    match asked.common.json {
        true => say(&answer.report),
        false => say(&answer.table),
    }
}

fn read(asked: &EnvelopeArgs) -> anyhow::Result<(AskedDemand, ReadSite)> {
    let judged = &asked.judged;
    match (&asked.rule, asked.hours) {
        (Some(name), _) => {
            let rule = judged.rule(name, &asked.set)?;
            Ok((AskedDemand::Rule(rule.into()), judged.read(Some(name), &judged.overrides()?)?))
        }
        (None, Some(secs)) => {
            let overrides = asked.days.onto(judged.overrides()?)?;
            let read = judged.read(None, &overrides)?;
            let days = study_days(judged.path(), &overrides, &read.site.place)?;
            Ok((AskedDemand::Hours(secs, days), read))
        }
        (None, None) => {
            let what = "how much sun must stay is not said: add --rule ID, as `gnomon rules` lists them, or --hours 2";
            Err(WrongUse(what.to_owned()).into())
        }
    }
}

/// Hours, as a number or as a study's step is written; in seconds.
fn hours(text: &str) -> Result<i64, String> {
    let number = text.trim().replace(',', ".").parse::<f64>().ok().map(|hours| (hours * 3600.0).round());
    let secs = number.or_else(|| parse_duration_secs(text).ok().map(f64::from));
    let secs = secs.filter(|secs| (1.0..=86_400.0).contains(secs)).map(|secs| secs as i64);
    secs.ok_or_else(|| "write hours above 0 and at most 24, for example 2, 1.5 or 1h30".to_owned())
}
