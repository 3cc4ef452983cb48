//! How high may be built on a plot so that what a rule protects, or everything, keeps its sun: a raster, a drawing, a
//! solid.

use super::parts::{note, note_letters};
use super::sink::NamedFile;
use super::{DeliverError, Sink, WrittenFiles};
use crate::export::envelope::{self as encode, EnvelopeContext, EnvelopeMap, EnvelopeSolid, KeptReceiver, KeptSpot};
use crate::export::{figure, raster};
use crate::message::{Field, Message, message};
use crate::rules::{Grouping, ResolvedRule, RuleDay, RuleReceiver, SunDemand, duration_text};
use crate::site::{GroundKind, JudgedPlot, JudgedSite, metres};
use crate::study::envelope::{CountedHeights, EnvelopeOutcome, KeptThing, envelope as find};
use crate::study::judge::{kept_by, plot_to_build_on};
use crate::study::plot_cells::{buildings, cells_within, lowest_ground, plot_grid};
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
    /// What must keep its sun.
    pub demand: SunDemand<'a>,
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
    let (plot, grid, inside) = plot(site, &asked)?;
    let open = sink.open(&FILES.map(PathBuf::from), None)?;
    note(open.note(), on_event)?;
    let name = name(&asked.demand);
    note_letters([site.place.name.as_str(), name.as_str()], on_event)?;
    let mut notes = site.notes.clone();
    let mut heard = |event: Event<'_>| {
        study::gather(&event, &site.notes, &mut notes);
        on_event(event)
    };
    let base = without_the_new(site);
    let kept = kept_by(&base, asked.demand, asked.highest_m, &mut heard)?;
    let foot_m = lowest_ground(&base.now, (&grid, &inside));
    note_states((&base, foot_m), site, &mut heard)?;
    note_choices(&asked.demand, &mut heard)?;
    let year = NaiveDate::from_ymd_opt(site.year, 7, 1).unwrap_or_default().and_time(NaiveTime::MIN).and_utc();
    let air = site.refraction.then(|| Air::standard(site.place.elevation_m));
    let sky = Sky { place: &site.place, delta_t_secs: delta_t_secs(year).map_err(StudyError::from)?, air };
    let room = Headroom::new(grid, inside);
    let counted = CountedHeights { ground: foot_m, most: foot_m + asked.highest_m };
    let outcome = find(&sky, (room, counted), (&kept.things, kept.needed), &mut heard)?;
    note_outcome(&outcome, &mut heard)?;
    let told = told(&kept.things, &outcome, foot_m);
    note_lacking(&told, &mut heard)?;
    let heights = heights(&outcome.headroom, foot_m, asked.highest_m);
    let standing = buildings(&base.now, &grid);
    let points = points(&told);
    let map = EnvelopeMap {
        place: &site.place,
        ground: &base.now.ground,
        foot_m,
        grid: &grid,
        heights: &heights,
        cap_m: asked.highest_m as f32,
        border: &plot.border,
        buildings: &standing,
        points: &points,
        kept: &name,
        days: &days_said(site, &asked.demand, &kept.days),
        refraction: site.refraction,
    };
    let mut files = drawn(&map, &mut heard)?;
    let mut names: Vec<PathBuf> = files.iter().map(|(name, _)| name.clone()).collect();
    names.push(FILES[5].into());
    let paths: Vec<PathBuf> = names.iter().map(|name| open.path(name).unwrap_or_else(|| name.clone())).collect();
    let (demand, days, most_m3) = (asked.demand, kept.days.as_slice(), outcome.most_m3);
    let said = EnvelopeContext { map: &map, demand, days, kept: &told, most_m3, files: &paths };
    let report = encode::json(&said, (&notes, site.words))?;
    files.push((FILES[5].into(), report.clone().into_bytes()));
    Ok(EnvelopeAnswer { table: encode::table(&said), report, written: open.write(files)? })
}

/// The plot, the cells around it, and which of them belong to it.
fn plot<'s>(
    site: &'s JudgedSite,
    asked: &EnvelopeRequest<'_>,
) -> Result<(&'s JudgedPlot, Grid, Vec<bool>), DeliverError> {
    let plot = plot_to_build_on(site, asked.demand)?;
    let Some(grid) = plot_grid(plot, asked.cell_m) else {
        let message = message!["the plot has too many cells of that size"; "take larger ones"];
        return Err(StudyError::Conflict { field: Field::Cell, message }.into());
    };
    let inside = cells_within(&plot.border, &grid);
    if !inside.contains(&true) {
        let message = message![format!("no cell of {} m has its middle on the plot", grid.cell); "take smaller ones"];
        return Err(StudyError::Conflict { field: Field::Cell, message }.into());
    }
    Ok((plot, grid, inside))
}

/// What stands without the new building: the state before, or else the only state. It is compared with itself.
fn without_the_new(site: &JudgedSite) -> JudgedSite {
    let now = site.before.clone().unwrap_or_else(|| site.now.clone());
    JudgedSite { before: Some(now.clone()), now, ..site.clone() }
}

/// One line that says what is kept.
fn name(demand: &SunDemand<'_>) -> String {
    match demand {
        SunDemand::Rule(source, _) => format!("{}, {}", source.name, source.edition),
        SunDemand::Hours(secs, _) => format!("{} of sun each day", duration_text(*secs)),
    }
}

/// Notes on what stands, and on what the heights do not include.
fn note_states(
    (base, foot_m): (&JudgedSite, f64),
    site: &JudgedSite,
    on_event: &mut OnEvent<'_>,
) -> Result<(), StudyError> {
    let mut tell_all = |said: &str| tell(on_event, Event::Note(said.to_owned().into()));
    if site.before.is_none() {
        tell_all("the site has no state before, so everything counts as standing, also what is on the plot")?;
    }
    if base.now.ground.kind == GroundKind::Terrain {
        let foot = metres(foot_m);
        tell_all(&format!(
            "heights are measured from the lowest point of the terrain on the plot, which is at {foot}"
        ))?;
    }
    Ok(())
}

/// Notes on what was chosen where the demand leaves a choice.
fn note_choices(demand: &SunDemand<'_>, on_event: &mut OnEvent<'_>) -> Result<(), StudyError> {
    let mut tell_all = |said: &str| tell(on_event, Event::Note(said.to_owned().into()));
    let rule: &ResolvedRule = match demand {
        SunDemand::Rule(_, rule) => rule,
        SunDemand::Hours(..) => {
            return tell_all(
                "each window (the middle of it, in the wall's outer plane), each point of a façade and each place on an area \
                 keeps so much sun by itself, that whose rays pass highest over the plot: the least height is as great as it \
                 can be, while other hours may leave more volume",
            );
        }
    };
    tell_all(
        "each place keeps as much sun as the rule asks, that whose rays pass highest over the plot: the least height is as \
         great as it can be, while other hours may leave more volume",
    )?;
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

/// Notes on hours that places chose together, and on a plot over which no sun must stay.
fn note_outcome(outcome: &EnvelopeOutcome, on_event: &mut OnEvent<'_>) -> Result<(), StudyError> {
    let mut tell_all = |said: &str| tell(on_event, Event::Note(said.to_owned().into()));
    if outcome.is_together {
        tell_all(
            "some places keep other hours than those whose rays pass highest, as all together then leave more volume",
        )?;
    }
    if outcome.kept.iter().all(|kept| kept.lowest().is_infinite()) {
        tell_all("no sun that must stay passes over the plot, so nothing that is protected bounds the heights")?;
    }
    Ok(())
}
fn note_lacking(told: &[KeptReceiver], on_event: &mut OnEvent<'_>) -> Result<(), StudyError> {
    let lacking: Vec<String> = told.iter().filter(|of| of.lacks).map(|of| format!("{:?}", of.name)).collect();
    if lacking.is_empty() {
        return Ok(());
    }
    let names = crate::message::few(lacking);
    let said = format!("already less sun than is asked, so all of it is kept: {names}");
    tell(on_event, Event::Note(said.into()))
}

/// What is kept, as it is reported.
fn told(things: &[KeptThing], outcome: &EnvelopeOutcome, foot_m: f64) -> Vec<KeptReceiver> {
    let of = |(thing, kept): (&KeptThing, &study::envelope::KeptOf)| KeptReceiver {
        name: kept.name.clone(),
        lowest_m: Some(kept.lowest() - foot_m).filter(|lowest| lowest.is_finite()),
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

/// Heights above the lowest ground, metres, slightly below the rays; NaN outside the plot.
fn heights(room: &Headroom, foot_m: f64, highest_m: f64) -> Vec<f32> {
    let of = |(top, inside): (&f64, &bool)| match inside {
        true => (top - foot_m - FREE_M).clamp(0.0, highest_m) as f32,
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

/// The days; and of given hours when the sun counts on them, as a rule's own windows stand in the rule.
fn days_said(site: &JudgedSite, demand: &SunDemand<'_>, days: &[RuleDay]) -> String {
    let window = match demand {
        SunDemand::Rule(..) => String::new(),
        SunDemand::Hours(..) => encode::window_said(&site.place, days),
    };
    if window.is_empty() { dates(days) } else { format!("{}, {window}", dates(days)) }
}

/// `21 March 2026`; a few days one by one, and of many the first and the last, in the order of the calendar.
fn dates(days: &[RuleDay]) -> String {
    /// The most days that are said one by one.
    const MOST: usize = 4;
    let said = |date: &NaiveDate| date.format("%-d %B %Y").to_string();
    let mut dates: Vec<NaiveDate> = days.iter().map(|day| day.date).collect();
    dates.sort_unstable();
    match dates.as_slice() {
        [] => "no day".to_owned(),
        few if few.len() <= MOST => few.iter().map(said).collect::<Vec<_>>().join(", "),
        [first, .., last] => format!("{} days, {} – {}", dates.len(), said(first), said(last)),
        [one] => said(one),
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
