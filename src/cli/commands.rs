//! The subcommands: each loads a site, asks for a deliverable, and prints the answer.

use super::arguments::{CheckArgs, ShadowArgs, ShowArg, SunArgs};
use super::eye::Viewpoint;
use super::interrupt;
use super::options::{Options, nothing_asked};
use super::output::say;
use super::progress::Progress;
use super::technique::showing_mask;
use super::wrong_use::WrongUse;
use crate::choice::{Receivers, listed};
use crate::deliver::instant::{self, InstantRequest};
use crate::deliver::{Sink, WrittenFiles};
use crate::export::check::{self, CheckedMesh, TableExtent};
use crate::export::figure::Diagram;
use crate::export::{file, report};
use crate::mesh::report as mesh_report;
use crate::message::Message;
use crate::profile::{Provenance, Statistics};
use crate::site::{Ground, LoadedMesh, LoadedSun, Overrides, Site, load_mesh, load_sun};
use crate::study::{Event, Stopwatch};
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// `gnomon shadow`
pub(super) fn shadow(asked: &ShadowArgs) -> anyhow::Result<()> {
    let watch = Stopwatch::start();
    asked.view.check(&asked.plan.given())?;
    let out = match (&asked.out, &asked.mask) {
        (Some(out), _) => Some(out.clone()),
        (None, Some(_)) => None,
        (None, None) => Some(PathBuf::from("shadow.png")),
    };
    let diagram = check_show(asked, out.is_some())?;
    let written: Vec<(&str, &Path)> = [("--out", out.as_deref()), ("--mask", asked.mask.as_deref())]
        .into_iter()
        .filter_map(|(option, path)| Some((option, path?)))
        .collect();
    for (option, path) in &written {
        if path.extension().is_some_and(|extension| !extension.eq_ignore_ascii_case("png")) {
            let what = format!("{option} writes PNG; name a .png file instead of {}", path.display());
            return Err(WrongUse(what).into());
        }
    }
    if let [(_, out), (_, mask)] = written.as_slice()
        && file::is_same_place(out, mask)
    {
        return Err(WrongUse("--out and --mask name the same file; name two".to_owned()).into());
    }

    let site = Site::load(asked.site.path(), &asked.overrides()?)?;
    // the site file may set the technique
    if diagram == Some(Diagram::Mask) && !site.method.row().shows_mask {
        let techniques = listed(&showing_mask(), "or");
        let what = format!("--show mask is the {techniques}'s; add --technique {techniques}, or leave it out");
        return Err(WrongUse(what).into());
    }
    let shows = |what| asked.show.contains(&what);
    let request = InstantRequest {
        view: asked.view.of(&site).at_first(&site)?,
        drawing: out,
        mask: asked.mask.clone(),
        show: instant::Show {
            volumes: shows(ShowArg::Volumes),
            silhouette: shows(ShowArg::Silhouette),
            components: shows(ShowArg::Components),
            diagram,
        },
        statistics: asked.stats,
        watch,
    };
    let mut progress = Progress::new(asked.common.quiet);
    let sink = Sink::Paths { inputs: &asked.site.inputs()? };
    let answer = instant::instant(&site, &request, sink, &mut |event| progress.heard(&event))?;
    if asked.common.json {
        return say(&answer.report);
    }
    let mut text = lines(&answer.written);
    // writing to a String cannot fail
    let _ = writeln!(text, "{}", drawn_by(&answer.drawn, &site.ground));
    text.push_str(&answer.statistics.as_ref().map(took).unwrap_or_default());
    say(&text)
}

/// The diagram to show, if any; or why the options contradict each other.
fn check_show(asked: &ShadowArgs, is_drawn: bool) -> anyhow::Result<Option<Diagram>> {
    let wrong = |what: &str| Err(WrongUse(format!("--show {what}")).into());
    let diagrams = [(ShowArg::Mask, Diagram::Mask), (ShowArg::Overdraw, Diagram::Overdraw)];
    let diagram = diagrams.into_iter().find(|(show, _)| asked.show.contains(show)).map(|(_, diagram)| diagram);
    match (asked.show.as_slice(), asked.view) {
        ([], _) => Ok(None),
        _ if !is_drawn => wrong("is for a drawing, but --mask alone makes none; add --out FILE.png"),
        ([_, _, ..], _) if diagram.is_some() => {
            wrong("mask and overdraw replace everything else; show one of them alone")
        }
        (show, Viewpoint::Plan) if diagram.is_none() => {
            // a side has no volumes
            let view = if show == [ShowArg::Components] { "camera or a side" } else { "camera" };
            wrong(&format!("is not for the plan; add --view {view}, or leave it out"))
        }
        _ => Ok(diagram),
    }
}

/// The paths of files, one per line.
pub(super) fn lines(written: &WrittenFiles) -> String {
    written.paths.iter().map(|path| format!("{}\n", path.display())).collect()
}

/// The cost of counting, in a line. Cells are those of the whole picture, the sky included.
pub(super) fn took(statistics: &Statistics) -> String {
    let [with, without] = statistics.overdraw();
    let cells = statistics.cells.max(1) as f64;
    match statistics.silhouette_cells {
        None => format!("overdraw: {without:.1} fragments of shadow volumes per cell\n"),
        Some(silhouette) => format!(
            "silhouette cells: {:.2}% of all; overdraw: {with:.2} fragments of shadow volumes per cell, {without:.1} without the mask\n",
            100.0 * silhouette as f64 / cells
        ),
    }
}

/// `gnomon sun`
pub(super) fn sun(asked: &SunArgs) -> anyhow::Result<()> {
    let LoadedSun { place, track, notes } = load_sun(&asked.path, &asked.overrides()?)?;
    let notes: Vec<Message> = notes.into_iter().chain(track.notes()).collect();
    let mut progress = Progress::new(asked.common.quiet);
    notes.iter().for_each(|note| progress.hear(&Event::Note(note.clone())));
    match asked.common.json {
        true => say(&report::sun_json(&place, &track, &notes, &Options)?),
        false => say(&report::sun_table(&place, &track)),
    }
}

/// `gnomon check`
pub(super) fn check(asked: &CheckArgs) -> anyhow::Result<()> {
    let together = asked.together();
    let checked = together.iter().map(|(path, beside)| check_one(asked, path, beside));
    match checked.collect::<anyhow::Result<Vec<_>>>()?.as_slice() {
        [one] => say(one),
        several if asked.common.json => say(&format!("[{}]\n", several.join(","))),
        several => {
            let named = together.iter().zip(several).map(|((path, _), table)| format!("{}\n{table}", path.display()));
            say(&named.collect::<Vec<_>>().join("\n"))
        }
    }
}

/// The report on one site, or on models that stand together.
fn check_one(asked: &CheckArgs, path: &Path, beside: &[PathBuf]) -> anyhow::Result<String> {
    let overrides = Overrides { beside: beside.to_vec(), ..asked.model.onto(nothing_asked()) };
    let LoadedMesh { mesh, frame, notes, models, references } = load_mesh(path, &overrides)?;
    interrupt::check()?;
    let components = mesh_report::components(&mesh);
    interrupt::check()?;
    let checked = CheckedMesh {
        mesh: &mesh,
        components: &components,
        frame,
        notes: &notes,
        models: &models,
        references: &references,
    };
    let extent = if asked.all { TableExtent::Whole } else { TableExtent::Screen };
    match asked.common.json {
        true => Ok(check::json(checked, &Options)?),
        false => Ok(check::table(checked, extent, &Options)),
    }
}

/// How hours between a study's instants were found, in a line.
pub(super) fn between(drawn: &Provenance, receivers: Receivers, site: &Site) -> String {
    report::between_instants(drawn, (receivers, &site.ground), &site.track)
        .map_or_else(String::new, |said| format!("{said}\n"))
}

/// What drew, and the ground: two lines, the last without a line end.
pub(super) fn drawn_by(drawn: &Provenance, ground: &Ground) -> String {
    let mut line = format!("{} on the {}", drawn.technique, drawn.engine);
    if let Some(adapter) = &drawn.adapter {
        let _ = write!(line, " ({adapter})");
    }
    if let Some(silhouette) = drawn.finder {
        let _ = write!(line, ", silhouettes {silhouette}");
    }
    let _ = write!(line, "\nground at {}", ground.said());
    line
}
