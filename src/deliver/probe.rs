//! The intervals in which points lie in the sun, as drawings and tables.

use super::parts::note_letters;
use super::sink::NamedFile;
use super::{DeliverError, Sink, WrittenFiles};
use crate::export::figure::scale::Rgb;
use crate::export::figure::{self, Screen};
use crate::export::probe as encode;
use crate::export::totals::totals as encode_totals;
use crate::message::{Message, Words};
use crate::site::ProbeSite;
use crate::study::sky::SkySearch;
use crate::study::{self, Event, OnEvent, tell};
use crate::sunlight::{ProbeWay, SkyLines, Sunlight};
use std::path::PathBuf;

/// What is requested besides the answer itself.
#[derive(Clone, Debug, Default)]
pub struct ProbeRequest {
    /// The name of the drawing: time of day across, days down. `None` for no drawing.
    pub drawing: Option<PathBuf>,
    /// The name of the table with one line per interval. `None` for no table.
    pub table: Option<PathBuf>,
    /// The name of the table of totals by day, month and year. `None` for no table.
    pub totals: Option<PathBuf>,
    /// The name of the drawing of a point's sky, a PNG or by its ending an SVG. Of several points each has its own, with
    /// the point's number in its name. Without a name there is none.
    pub sky: Option<PathBuf>,
    /// The face's words, for the fields that the drawing mentions.
    pub words: &'static dyn Words,
}

/// The result of a search.
#[derive(Clone, Debug)]
pub struct ProbeAnswer {
    /// When each point lies in the sun.
    pub sunlight: Sunlight,
    /// Notes on the models and on the search.
    pub notes: Vec<Message>,
    /// The files that were written.
    pub written: WrittenFiles,
}

/// Finds when points lie in the sun.
///
/// # Errors
/// [`DeliverError`]. Files that cannot be written are refused before anything is searched.
pub fn probe(
    probing: &ProbeSite,
    asked: &ProbeRequest,
    sink: Sink<'_>,
    on_event: &mut OnEvent<'_>,
) -> Result<ProbeAnswer, DeliverError> {
    let skies = sky_names(probing, asked)?;
    let one_each = [&asked.drawing, &asked.table, &asked.totals].into_iter().flatten();
    let names: Vec<PathBuf> = one_each.chain(&skies).cloned().collect();
    let open = sink.open(&names, None)?;
    if asked.drawing.is_some() || asked.sky.is_some() {
        let all = probing.probes.iter().chain(probing.laid.iter().filter_map(|sides| sides.first()));
        let probes = all.map(|probe| probe.name.as_str());
        note_letters([probing.place.name.as_str()].into_iter().chain(probes), on_event)?;
    }
    let mut notes = probing.notes.clone();
    let sunlight = study::probe::probe(probing, &mut |event| {
        study::gather(&event, &probing.notes, &mut notes);
        on_event(event)
    })?;
    let mut files = Vec::new();
    if let Some(name) = &asked.table {
        files.push((name.clone(), encode::csv(&sunlight).into_bytes()));
    }
    if let Some(name) = &asked.totals {
        files.push((name.clone(), encode_totals(&sunlight).into_bytes()));
    }
    if let Some(name) = &asked.drawing {
        files.push((name.clone(), figure::strips(&sunlight, &probing.place, &probing.ground, asked.words)?));
    }
    tell(on_event, Event::Stage("picture"))?;
    if !skies.is_empty() {
        draw_skies(probing, &sunlight, skies, &mut files, on_event)?;
    }
    Ok(ProbeAnswer { written: open.write(files)?, sunlight, notes })
}

/// The most points whose skies are drawn at once: each is a sheet.
pub const MOST_SKIES: usize = 100;

/// The names of the drawings of skies: the requested one, or for several points that with each point's number.
fn sky_names(probing: &ProbeSite, asked: &ProbeRequest) -> Result<Vec<PathBuf>, DeliverError> {
    let Some(name) = &asked.sky else { return Ok(Vec::new()) };
    let count = probing.probes.len() + probing.laid.iter().filter(|sides| !sides.is_empty()).count();
    if count > MOST_SKIES {
        return Err(DeliverError::TooManySkies { count, most: MOST_SKIES });
    }
    if count == 1 {
        return Ok(vec![name.clone()]);
    }
    let digits = count.to_string().len();
    let numbered = |number: usize| {
        let mut file = name.file_stem().unwrap_or_default().to_owned();
        file.push(format!("-{number:0digits$}"));
        let mut path = name.with_file_name(file);
        if let Some(extension) = name.extension() {
            // a dot in the stem is none of an ending's
            path.as_mut_os_string().push(".");
            path.as_mut_os_string().push(extension);
        }
        path
    };
    Ok((1..=count).map(numbered).collect())
}

/// Adds the drawing of each point's sky.
fn draw_skies(
    probing: &ProbeSite,
    sunlight: &Sunlight,
    names: Vec<PathBuf>,
    files: &mut Vec<NamedFile>,
    on_event: &mut OnEvent<'_>,
) -> Result<(), DeliverError> {
    let search = SkySearch::new(probing, sunlight);
    let lines = search.lines()?;
    let colours = figure::sky_colours(&probing.mesh, &probing.casts);
    for (probe, name) in names.into_iter().enumerate().take(sunlight.probes.len()) {
        tell(on_event, Event::Stage("sky"))?;
        let rasters = search.rasters(probe, figure::sky_pictures(&probing.place));
        let ways = search.ways(probe)?;
        let shown = sky_context((probing, sunlight), (probe, &ways), &lines, &colours);
        let drawing = figure::sky_sheet(&shown, &rasters);
        let is_svg = name.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("svg"));
        let bytes = if is_svg { drawing.svg().into_bytes() } else { drawing.png()? };
        files.push((name, bytes));
    }
    Ok(())
}

/// The sky of the first point for a card on a screen; none where there is no point.
///
/// # Errors
/// [`DeliverError`].
pub fn sky_card(probing: &ProbeSite, sunlight: &Sunlight) -> Result<Option<Screen>, DeliverError> {
    if sunlight.probes.is_empty() {
        return Ok(None);
    }
    let search = SkySearch::new(probing, sunlight);
    let (lines, ways) = (search.lines()?, search.ways(0)?);
    let colours = figure::sky_colours(&probing.mesh, &probing.casts);
    let [raster] = search.rasters(0, [figure::card_picture()]);
    let shown = sky_context((probing, sunlight), (0, &ways), &lines, &colours);
    Ok(Some(figure::sky_card(&shown, &raster)?))
}

fn sky_context<'a>(
    (probing, sunlight): (&'a ProbeSite, &'a Sunlight),
    (probe, ways): (usize, &'a [ProbeWay]),
    lines: &'a SkyLines,
    colours: &'a [Rgb],
) -> figure::SkyContext<'a> {
    figure::SkyContext { place: &probing.place, ground: &probing.ground, sunlight, probe, lines, ways, colours }
}
