//! How high may be built on a plot so that what a rule protects keeps its sun: a raster, a drawing, a solid.

use super::parts::{note, note_letters};
use super::sink::NamedFile;
use super::{DeliverError, Sink, WrittenFiles};
use crate::export::envelope::{self as encode, EnvelopeMap, EnvelopeSolid, EnvelopeTold, KeptReceiver, KeptSpot};
use crate::export::{figure, raster};
use crate::message::{Field, Message, message};
use crate::rules::{Grouping, ResolvedRule, RuleDay, RuleError, RuleNeed, RuleReceiver, RuleSource};
use crate::site::{GroundKind, JudgedPlot, JudgedSite};
use crate::study::envelope::{EnvelopeOutcome, KeptThing, envelope as find};
use crate::study::judge::kept_by;
use crate::study::plot_cells::{buildings, cells_within, plot_grid};
use crate::study::{self, Event, OnEvent, StudyError, tell};
use crate::sun::{Air, Sky, delta_t_secs};
use crate::sunlight::Headroom;
use crate::view::Grid;
use chrono::{NaiveDate, NaiveTime};
use glam::DVec3;
use std::path::PathBuf;

/// The request, besides the site.
#[derive(Clone, Copy, Debug)]
pub struct EnvelopeRequest<'a> {
    /// The rule's source.
    pub source: &'a RuleSource,
    /// The rule with all of its options chosen.
    pub rule: &'a ResolvedRule,
    /// The side of a cell, metres.
    pub cell_m: Option<f64>,
    /// The greatest height where no sun limits it, metres.
    pub highest_m: f64,
}

/// The result.
#[derive(Clone, Debug)]
pub struct EnvelopeAnswer {
    /// The files that were written.
    pub written: WrittenFiles,
    /// The report in JSON.
    pub report: String,
    /// The report as text for people.
    pub table: String,
}

/// The names of the files: the raster of heights, the drawing and the solid in two formats each, and the report.
const FILES: [&str; 6] =
    ["envelope.tif", "envelope.png", "envelope.svg", "envelope.glb", "envelope.obj", "envelope.json"];

/// The distance kept below a ray, metres, for the rounding of numbers in the files.
const FREE_M: f64 = 0.001;

/// Finds how high may be built on a site's plot.
///
/// # Errors
/// [`DeliverError`]. Files that cannot be written, and everything that the rule needs and the site lacks, are reported
/// before anything is searched.
pub fn envelope(
    site: &JudgedSite,
    asked: EnvelopeRequest<'_>,
    sink: Sink<'_>,
    on_event: &mut OnEvent<'_>,
) -> Result<EnvelopeAnswer, DeliverError> {
    let open = sink.open(&FILES.map(PathBuf::from), None)?;
    note(open.note(), on_event)?;
    let (plot, grid) = plot(site, &asked)?;
    note_letters([site.place.name.as_str(), asked.source.name.as_str()], on_event)?;
    let mut notes = site.notes.clone();
    let mut heard = |event: Event<'_>| {
        study::gather(&event, &site.notes, &mut notes);
        on_event(event)
    };
    let base = without_the_new(site);
    let kept = kept_by(&base, asked.rule, asked.highest_m, &mut heard)?;
    note_choices(&base, site, asked.rule, &mut heard)?;
    let year = NaiveDate::from_ymd_opt(site.year, 7, 1).unwrap_or_default().and_time(NaiveTime::MIN).and_utc();
    let air = site.refraction.then(|| Air::standard(site.place.elevation_m));
    let sky = Sky { place: &site.place, delta_t_secs: delta_t_secs(year).map_err(StudyError::from)?, air };
    let room = Headroom::new(grid, cells_within(&plot.border, &grid));
    let outcome = find(&sky, room, (&kept.things, kept.needed), &mut heard)?;
    let told = told(&kept.things, &outcome, base.now.ground.level);
    note_lacking(&told, &mut heard)?;
    let heights = heights(&outcome.headroom, base.now.ground.level, asked.highest_m);
    let standing = buildings(&base.now, &grid);
    let points = points(&told);
    let map = EnvelopeMap {
        place: &site.place,
        ground: &base.now.ground,
        grid: &grid,
        heights: &heights,
        cap_m: asked.highest_m as f32,
        border: &plot.border,
        buildings: &standing,
        points: &points,
        kept: &format!("{}, {}", asked.source.name, asked.source.edition),
        days: &dates(&kept.days),
        refraction: site.refraction,
    };
    let mut files = drawn(&map, &mut heard)?;
    let mut names: Vec<PathBuf> = files.iter().map(|(name, _)| name.clone()).collect();
    names.push(FILES[5].into());
    let paths: Vec<PathBuf> = names.iter().map(|name| open.path(name).unwrap_or_else(|| name.clone())).collect();
    let (source, rule, days) = (asked.source, asked.rule, kept.days.as_slice());
    let said = EnvelopeTold { map: &map, source, rule, days, kept: &told, files: &paths };
    let report = encode::json(&said, (&notes, site.words))?;
    files.push((FILES[5].into(), report.clone().into_bytes()));
    Ok(EnvelopeAnswer { table: encode::table(&said), report, written: open.write(files)? })
}

/// The plot and its cells.
fn plot<'s>(site: &'s JudgedSite, asked: &EnvelopeRequest<'_>) -> Result<(&'s JudgedPlot, Grid), DeliverError> {
    let Some(plot) = &site.plot else {
        let needs = vec![RuleNeed::of_key("the plot that is built on", "[plot]", "")];
        return Err(StudyError::from(RuleError::Needs { rule: asked.rule.id.clone(), needs }).into());
    };
    let Some(grid) = plot_grid(plot, asked.cell_m) else {
        let message = message!["the plot has too many cells of that size"; "take larger ones"];
        return Err(StudyError::Conflict { field: Field::Cell, message }.into());
    };
    Ok((plot, grid))
}

/// What stands without the new building: the state before, or else the only state. It is compared with itself.
fn without_the_new(site: &JudgedSite) -> JudgedSite {
    let now = site.before.clone().unwrap_or_else(|| site.now.clone());
    JudgedSite { before: Some(now.clone()), now, ..site.clone() }
}

/// Notes on what was chosen where the rule leaves a choice, and on what the heights do not include.
fn note_choices(
    base: &JudgedSite,
    site: &JudgedSite,
    rule: &ResolvedRule,
    on_event: &mut OnEvent<'_>,
) -> Result<(), StudyError> {
    let mut tell_all = |said: &str| tell(on_event, Event::Note(said.to_owned().into()));
    if site.before.is_none() {
        tell_all("the site has no state before, so everything counts as standing, also what is on the plot")?;
    }
    if base.now.ground.kind == GroundKind::Terrain {
        tell_all("heights are measured from the plane of the ground, not from the terrain")?;
    }
    tell_all("each place keeps as much sun as the rule asks, that whose rays pass highest over the plot")?;
    if let RuleReceiver::Window { group, all_of, .. } = &rule.receiver {
        let is_shared = group.is_some_and(|group| matches!(group, Grouping::Room | Grouping::Dwelling));
        if is_shared || rule.dwelling.is_some() || !all_of.is_empty() {
            tell_all("each window keeps its sun by itself, which is more than the rule asks of a room or a dwelling")?;
        }
    }
    if rule.criteria.len() > 1 && (rule.any || rule.criteria.iter().any(|criterion| criterion.grade.is_some())) {
        tell_all(
            "only one of the rule's limits is kept: the lowest grade, or the first of limits of which one is enough",
        )?;
    }
    Ok(())
}

fn note_lacking(told: &[KeptReceiver], on_event: &mut OnEvent<'_>) -> Result<(), StudyError> {
    let lacking: Vec<String> = told.iter().filter(|of| of.lacks).map(|of| format!("{:?}", of.name)).collect();
    if lacking.is_empty() {
        return Ok(());
    }
    let names = crate::message::few(lacking);
    let said = format!("already less sun than the rule asks, so all of it is kept: {names}");
    tell(on_event, Event::Note(said.into()))
}

/// What is kept, as it is reported.
fn told(things: &[KeptThing], outcome: &EnvelopeOutcome, ground: f64) -> Vec<KeptReceiver> {
    let of = |(thing, kept): (&KeptThing, &study::envelope::KeptOf)| KeptReceiver {
        name: kept.name.clone(),
        lowest_m: Some(kept.lowest() - ground).filter(|lowest| lowest.is_finite()),
        lacks: kept.lacks(),
        places: kept
            .places
            .iter()
            .map(|(number, days)| KeptSpot {
                points: thing.places[*number].points.clone(),
                days: days.iter().map(|kept| (kept.day, kept.spells.clone())).collect(),
            })
            .collect(),
    };
    things.iter().zip(&outcome.kept).map(of).collect()
}

/// Heights above the ground, metres, slightly below the rays; NaN outside the plot.
fn heights(room: &Headroom, ground: f64, highest_m: f64) -> Vec<f32> {
    let of = |(top, inside): (&f64, &bool)| match inside {
        true => (top - ground - FREE_M).clamp(0.0, highest_m) as f32,
        false => f32::NAN,
    };
    room.top.iter().zip(&room.inside).map(of).collect()
}

/// The points of the drawing; none if there are several hundred, as on areas.
fn points(told: &[KeptReceiver]) -> Vec<DVec3> {
    const MOST: usize = 300;
    let points: Vec<DVec3> = told.iter().flat_map(|of| &of.places).flat_map(|place| &place.points).copied().collect();
    if points.len() > MOST { Vec::new() } else { points }
}

/// `21 March 2026`, or the first and the last of several days.
fn dates(days: &[RuleDay]) -> String {
    let said = |date: NaiveDate| date.format("%-d %B %Y").to_string();
    match days {
        [] => "no day".to_owned(),
        [one] => said(one.date),
        [first, .., last] => format!("{} – {}, {} days", said(first.date), said(last.date), days.len()),
    }
}

/// The files except the report. If nothing may stand anywhere, there is no solid.
fn drawn(map: &EnvelopeMap, on_event: &mut OnEvent<'_>) -> Result<Vec<NamedFile>, DeliverError> {
    tell(on_event, Event::Stage("picture"))?;
    let drawing = figure::heights(map)?;
    let mut files: Vec<NamedFile> = vec![
        (FILES[0].into(), raster::heights_geotiff(map)?),
        (FILES[1].into(), drawing.png()?),
        (FILES[2].into(), drawing.svg().into_bytes()),
    ];
    tell(on_event, Event::Stage("model"))?;
    if map.range().is_none_or(|[_, high]| high <= 0.0) {
        let note: Message = "nothing may stand anywhere on the plot, so no solid is written".to_owned().into();
        tell(on_event, Event::Note(note))?;
        return Ok(files);
    }
    let solid = EnvelopeSolid::of(map)?;
    files.push((FILES[3].into(), solid.glb(map)?));
    files.push((FILES[4].into(), solid.obj(map).into_bytes()));
    Ok(files)
}
