//! The subcommands: load, work, write, say.

use super::arguments::{CheckArgs, ShadowArgs, Show, SunArgs};
use super::eye::Eye;
use super::options::{Options, nothing_asked};
use super::progress::Progress;
use super::{WrongUse, interrupt, say};
use crate::export::figure::Diagram;
use crate::export::report::Told;
use crate::export::{check, figure, file, raster, report};
use crate::mesh::report as mesh_report;
use crate::profile::{Drawn, Statistics};
use crate::site::{Ground, LoadedMesh, Method, Site, inputs, load_mesh, load_sun};
use crate::study::{self, Counting, Event, InstantWants, Stopwatch};
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// `gnomon shadow`
pub(super) fn shadow(asked: &ShadowArgs) -> anyhow::Result<()> {
    let mut watch = Stopwatch::start();
    asked.view.check(&asked.plan)?;
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

    let site = Site::load(&asked.site.path, &asked.overrides())?;
    // the site file may name the technique
    if diagram == Some(Diagram::Mask) && site.method != Method::Hybrid {
        let what = "--show mask is the hybrid's; add --technique hybrid, or leave it out";
        return Err(WrongUse(what.to_owned()).into());
    }
    let outputs: Vec<PathBuf> = written.iter().map(|(_, path)| path.to_path_buf()).collect();
    file::check_inputs(&inputs(&asked.site.path)?, &outputs)?;
    for path in &outputs {
        file::check_folder(path.parent().unwrap_or(Path::new("")))?;
    }
    watch.lap("load");
    let view = asked.view.of(&site);
    let shows = |what| asked.show.contains(&what);
    let wants = InstantWants {
        surface: out.is_some(),
        volumes: shows(Show::Volumes),
        silhouette: shows(Show::Silhouette),
        counted: match diagram {
            Some(Diagram::Mask) => Some(Counting::Mask),
            Some(Diagram::Overdraw) => Some(Counting::Overdraw),
            None => asked.stats.then_some(Counting::Statistics),
        },
    };
    let (receivers, ground) = (study::judged(&site, &view), site.ground);
    let mut progress = Progress::new(asked.common.quiet);
    if out.is_some() {
        let parts = site.mesh.components.iter().filter(|_| shows(Show::Components)).map(|part| part.name.as_str());
        progress.letters([site.place.name.as_str()].into_iter().chain(parts));
    }
    let outcome = study::instant(&site, view, &wants, &mut |event| {
        progress.hear(&event);
        interrupt::flow()
    })?;
    watch.laps(outcome.timings);

    let (place, track, drawn) = (&site.place, &site.track, &outcome.drawn);
    let mut text = String::new();
    if let (Some(path), Some(surface)) = (&out, &outcome.surface) {
        let scene = figure::Scene { place, track, mesh: &outcome.surface_mesh, surface, receivers, ground, drawn };
        // the drawing's mesh holds the components that are seen
        let casts: Vec<bool> =
            site.casts.iter().zip(&site.receives).filter(|(_, seen)| **seen).map(|(casts, _)| *casts).collect();
        let casts = shows(Show::Components).then_some(casts.as_slice());
        let counted = outcome.counted.as_ref().zip(diagram);
        let shown = figure::Shown { overlay: outcome.overlay.as_ref(), casts, counted };
        let bytes = figure::instant(&scene, &view, &outcome.mask, &shown)?;
        interrupt::check()?;
        file::write(path, &bytes)?;
        watch.lap("picture");
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{}", path.display());
    }
    if let Some(path) = &asked.mask {
        file::write(path, &raster::mask_png(&outcome.mask)?)?;
        watch.lap("mask");
        let _ = writeln!(text, "{}", path.display());
    }
    let statistics = outcome.counted.as_ref().filter(|_| asked.stats).map(Statistics::of);
    if asked.common.json {
        let (statistics, timings) = (statistics.as_ref(), &watch.timings());
        let told = Told { receivers, ground, drawn, timings, statistics, notes: &site.notes };
        return say(&report::shadow_json(&view, place, track, &told)?);
    }
    let _ = writeln!(text, "{}", drawn_by(drawn, &ground));
    text.push_str(&statistics.as_ref().map(took).unwrap_or_default());
    say(&text)
}

/// Which diagram is to be shown, if any; or why what is to be shown does not go together.
fn check_show(asked: &ShadowArgs, is_drawn: bool) -> anyhow::Result<Option<Diagram>> {
    let wrong = |what: &str| Err(WrongUse(format!("--show {what}")).into());
    let diagrams = [(Show::Mask, Diagram::Mask), (Show::Overdraw, Diagram::Overdraw)];
    let diagram = diagrams.into_iter().find(|(show, _)| asked.show.contains(show)).map(|(_, diagram)| diagram);
    match (asked.show.as_slice(), asked.view) {
        ([], _) => Ok(None),
        _ if !is_drawn => wrong("is for a drawing, and --mask alone makes none; add --out FILE.png"),
        ([_, _, ..], _) if diagram.is_some() => {
            wrong("mask and overdraw stand instead of all else; show one of them alone")
        }
        (_, Eye::Plan) if diagram.is_none() => {
            wrong("is not for the plan; add --view camera or a side, or leave it out")
        }
        _ => Ok(diagram),
    }
}

/// What counting took, in a line; cells are all of the picture's, those of the sky too.
pub(super) fn took(statistics: &Statistics) -> String {
    let [with, without] = statistics.overdraw();
    let cells = statistics.cells.max(1) as f64;
    match statistics.silhouette_cells {
        None => format!("overdraw: {without:.1} fragments of shadow volumes a cell\n"),
        Some(silhouette) => format!(
            "silhouette cells: {:.2}% of all; overdraw: {with:.2} fragments of shadow volumes a cell, {without:.1} without the mask\n",
            100.0 * silhouette as f64 / cells
        ),
    }
}

/// `gnomon sun`
pub(super) fn sun(asked: &SunArgs) -> anyhow::Result<()> {
    let (place, track) = load_sun(&asked.path, &asked.overrides())?;
    let mut progress = Progress::new(asked.common.quiet);
    track.notes().into_iter().for_each(|note| progress.hear(&Event::Note(note)));
    match asked.common.json {
        true => say(&report::sun_json(&place, &track)?),
        false => say(&report::sun_table(&place, &track)),
    }
}

/// `gnomon check`
pub(super) fn check(asked: &CheckArgs) -> anyhow::Result<()> {
    let LoadedMesh { mesh, frame, notes } = load_mesh(&asked.path, &asked.model.onto(nothing_asked()))?;
    interrupt::check()?;
    let components = mesh_report::components(&mesh);
    interrupt::check()?;
    match asked.common.json {
        true => say(&check::json(&mesh, &components, frame, &notes)?),
        false => say(&check::table(&mesh, &components, frame, &notes, &Options)),
    }
}

/// What drew, and on which ground: two lines, the last without its end.
pub(super) fn drawn_by(drawn: &Drawn, ground: &Ground) -> String {
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
