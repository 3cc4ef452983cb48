//! The result of `gnomon verify`: JSON, and a table with a legend.

use super::{ExportError, report};
use crate::choice::{Engine, Finder, Method, Promise, Truth};
use crate::message::{Field, Message, MessagePart, Words, message, pieces};
use crate::site::Site;
use crate::sun::{Place, SunTrack};
use crate::verification::{HoursDifference, Row, Verification};
use serde::Serialize;
use std::fmt::Write;

/// Of the cells that are not edge cells, one in this many may differ.
const OTHERS: u32 = 100_000;

#[derive(Serialize)]
struct VerifyReport<'a> {
    gnomon: &'static str,
    place: report::PlaceReport<'a>,
    tz_version: String,
    region: [f64; 4],
    cell: f64,
    width: u32,
    height: u32,
    receivers: &'static str,
    #[serde(flatten)]
    ground: report::GroundReport,
    refraction: bool,
    instants: Vec<report::InstantReport>,
    instants_compared: usize,
    sun_samples: u32,
    sun_samples_secs_per_instant: f64,
    clean: bool,
    edge_share_bound: f64,
    holds: bool,
    surfaces: Option<SurfacesReport>,
    techniques: Vec<RowReport<'a>>,
    notes: Vec<String>,
}

#[derive(Serialize)]
struct SurfacesReport {
    cell: f64,
    texels: usize,
    edge_share_bound: f64,
}

#[derive(Serialize)]
struct RowReport<'a> {
    technique: &'static str,
    compared_on: &'static str,
    silhouette: Option<&'static str>,
    engine: &'static str,
    adapter: Option<&'a str>,
    #[serde(flatten)]
    settings: report::SettingsReport,
    against: &'static str,
    cells: u64,
    edge_cells: u64,
    edge_differ: u64,
    other_differ: u64,
    thin_differ: u64,
    map_missed: Option<u64>,
    furthest_cells: Option<f64>,
    mean_share_off: f64,
    largest_hours_off: Option<f64>,
    mean_hours_off: Option<f64>,
    secs_per_instant: f64,
    holds: Option<bool>,
}

/// The JSON of `gnomon verify`: place, plan and instants as in `profile.json`, then
///
/// - `instants_compared`: those with a sun;
/// - `sun_samples`, `sun_samples_secs_per_instant`: the points of the sun's disc, and how long an instant took to them;
/// - `clean`: every part that casts is closed and well wound; `edge_share_bound`: the part of the edge cells of an exact
///   technique that may therefore differ (of other cells, one in 100,000);
/// - `holds`: whether every technique that decides does;
/// - `surfaces`: the side of a texel (`cell`, metres) and how many `texels` techniques were compared on that draw façades and
///   roofs, with an `edge_share_bound` of their own; null where nothing has any;
/// - `techniques`, each with what drew it, what it was `compared_on` (`plan`, or `surfaces`, where cells are texels), and
///   `against` (`centre`: ray casting to the sun's centre, `disc`: to the points
///   of its disc, `every-face`: rays without the trees, at some cells), the `cells` compared, how many of them are
///   `edge_cells`; how many of these and of the others differ by more than half the sun (`edge_differ`,
///   `other_differ`), counted apart where they lie beside what is thinner than a cell (`thin_differ`) and where the
///   hybrid's map missed something (`map_missed`); how far the furthest of those that differ lies from a shadow edge
///   (`furthest_cells`); by how much the share of the sun, 0 to 1, and the hours of the profile are off
///   (`mean_share_off`, `largest_hours_off`, `mean_hours_off`); `secs_per_instant`; and `holds`, null where the technique
///   decides nothing;
/// - `notes` as in `profile.json`: those given.
///
/// # Errors
/// [`ExportError::Encode`] if the encoder fails.
pub fn json(verification: &Verification, site: &Site, notes: &[Message]) -> Result<String, ExportError> {
    let Site { place, track, receivers, ground, .. } = site;
    let Verification { grid, instants, clean, edge_share, sun_samples, disc_secs, surfaces, rows } = verification;
    report::json(&VerifyReport {
        gnomon: env!("CARGO_PKG_VERSION"),
        place: report::place_report(place),
        tz_version: report::tz_version(place),
        region: grid.region(),
        cell: grid.cell,
        width: grid.width,
        height: grid.height,
        receivers: receivers.word(),
        ground: report::ground_report(ground),
        refraction: track.refraction,
        instants: track.instants.iter().map(report::instant_report).collect(),
        instants_compared: *instants,
        sun_samples: *sun_samples,
        sun_samples_secs_per_instant: *disc_secs,
        clean: *clean,
        edge_share_bound: *edge_share,
        holds: verification.failed().next().is_none(),
        surfaces: surfaces.map(|surfaces| SurfacesReport {
            cell: surfaces.cell,
            texels: surfaces.texels,
            edge_share_bound: surfaces.edge_share,
        }),
        techniques: rows.iter().map(|row| row_report(row, verification.row_holds(row))).collect(),
        notes: report::said(notes, site.words),
    })
}

fn row_report(row: &Row, holds: Option<bool>) -> RowReport<'_> {
    RowReport {
        technique: row.drawn.technique.word(),
        compared_on: if row.on_surfaces { "surfaces" } else { "plan" },
        silhouette: row.drawn.finder.map(Finder::word),
        engine: row.drawn.engine.word(),
        adapter: row.drawn.adapter.as_deref(),
        settings: report::settings_report(&row.drawn.settings),
        against: match row.against {
            Truth::Centre => "centre",
            Truth::Disc => "disc",
            Truth::EveryFace => "every-face",
        },
        cells: row.difference.cells(),
        edge_cells: row.difference.edge_cells,
        edge_differ: row.difference.edge_differ,
        other_differ: row.difference.other_differ,
        thin_differ: row.thin,
        map_missed: row.missed,
        furthest_cells: row.furthest,
        mean_share_off: row.share_off,
        largest_hours_off: row.hours_off.map(|off| off.largest),
        mean_hours_off: row.hours_off.map(|off| off.mean),
        secs_per_instant: row.secs,
        holds,
    }
}

/// The silhouette finder that was used, and which techniques used another one.
fn silhouettes(rows: &[Row]) -> String {
    let mut found = rows.iter().filter_map(|row| Some((row.drawn.finder?, row.drawn.technique)));
    let Some((first, _)) = found.next() else { return "none".to_owned() };
    let others = found.filter(|(finder, _)| *finder != first);
    let others: Vec<_> = others.map(|(finder, technique)| format!("; {technique} {finder}")).collect();
    format!("{first}{}", others.concat())
}

/// The size of shadow maps, the filter of the shadow map, and the width of smoothies if it was set by hand.
fn maps(rows: &[Row]) -> Option<String> {
    let size = rows.iter().find_map(|row| row.drawn.settings.map_size)?;
    let filtered = |row: &Row| {
        let filter = row.drawn.settings.filter?;
        Some(format!(", {} filtered {filter}", row.drawn.technique))
    };
    let pcf = rows.iter().find_map(filtered);
    let width = rows.iter().find_map(|row| row.drawn.settings.smoothie_width_m);
    let width = width.map(|width| format!(", smoothies of at most {width} m"));
    Some(format!("maps of {size} × {size} texels{}{}", pcf.unwrap_or_default(), width.unwrap_or_default()))
}

/// The place, the time and the machine, then one line per technique, then what the columns mean; ends with a line
/// break.
pub fn table(verification: &Verification, site: &Site) -> String {
    let mut table = String::new();
    head(&mut table, verification, site);
    for line in HEADINGS {
        columns(&mut table, line);
    }
    for row in &verification.rows {
        line(&mut table, row, verification.row_holds(row));
    }
    legend(&mut table, verification, site.words);
    table
}

/// Writes place, time and machine, and an empty line.
fn head(table: &mut String, verification: &Verification, site: &Site) {
    let Site { place, track, receivers, ground, .. } = site;
    let Verification { grid, instants, .. } = verification;
    let night = track.instants.len() - instants;
    let adapter = verification.rows.iter().find_map(|row| row.drawn.adapter.as_deref()).unwrap_or("no adapter");
    let drawn_by = [silhouettes(&verification.rows)].into_iter().chain(maps(&verification.rows));
    let drawn_by = drawn_by.collect::<Vec<_>>().join("\n");
    // Writing to a String cannot fail.
    let _ = writeln!(
        table,
        "{}: {}, {}{}\n{} × {} cells of {:.3} m, receivers {}\nground at {}\ndrawn on {adapter}, silhouettes {drawn_by}\n",
        words(place),
        window(track),
        counted(*instants, "instant"),
        if night > 0 { format!(" by day ({night} at night left out)") } else { String::new() },
        grid.width,
        grid.height,
        grid.cell,
        receivers.word(),
        ground.said(),
    );
}

/// The columns' names, in two lines.
const HEADINGS: [[&str; 13]; 2] = [
    ["", "", "compared", "edge", "differ", "at edges", "else-", "map", "furthest", "share", "most", "mean", "time per"],
    [
        "technique",
        "against",
        "cells",
        "cells",
        "cells",
        "%",
        "where",
        "missed",
        "cells",
        "off %",
        "h off",
        "h off",
        "instant s",
    ],
];

/// The widths of the columns; the first two are aligned left.
const WIDTHS: [usize; 13] = [12, 7, 9, 9, 7, 8, 6, 6, 8, 7, 6, 7, 9];

fn columns(table: &mut String, names: [&str; 13]) {
    let cells = names.iter().zip(WIDTHS).enumerate().map(|(at, (name, width))| match at {
        0 | 1 => format!("{name:<width$}"),
        _ => format!("{name:>width$}"),
    });
    // Writing to a String cannot fail.
    let _ = writeln!(table, "{}", cells.collect::<Vec<_>>().join(" "));
}

fn line(table: &mut String, row: &Row, holds: Option<bool>) {
    let difference = &row.difference;
    let or_dash = |number: Option<String>| number.unwrap_or_else(|| "-".to_owned());
    let hours = |of: fn(&HoursDifference) -> f64, digits: usize| {
        or_dash(row.hours_off.as_ref().map(|off| format!("{:.digits$}", of(off))))
    };
    // Writing to a String cannot fail.
    let _ = writeln!(
        table,
        "{:<12} {:<7} {:>9} {:>9} {:>7} {:>8.3} {:>6} {:>6} {:>8} {:>7.3} {:>6} {:>7} {:>9.4}{}",
        if is_on_gpu_too(row) { "  on gpu" } else { row.drawn.technique.word() },
        match row.against {
            Truth::Centre => "centre",
            Truth::Disc => "disc",
            Truth::EveryFace => "faces",
        },
        difference.cells(),
        difference.edge_cells,
        difference.edge_differ,
        100.0 * difference.edge_share(),
        difference.other_differ,
        or_dash(row.missed.map(|missed| missed.to_string())),
        or_dash(row.furthest.map(|furthest| format!("{furthest:.1}"))),
        100.0 * row.share_off,
        hours(|off| off.largest, 2),
        hours(|off| off.mean, 4),
        row.secs,
        match holds {
            Some(true) => "  holds",
            Some(false) => "  FAILS",
            None => "",
        },
    );
}

fn legend(table: &mut String, verification: &Verification, words: &dyn Words) {
    let Verification { sun_samples, disc_secs, rows, .. } = verification;
    // Writing to a String cannot fail.
    let _ = writeln!(
        table,
        "\n\
         against: ray casting to the sun's centre, or to {sun_samples} points of its disc ({disc_secs:.4} s an instant); ray casting\n\
         \u{20}        itself against every face of the model without a search tree, at some cells\n\
         edge cells: a shadow's edge runs past the cell or a neighbour; differ: by more than half the sun\n\
         elsewhere: cells away from edges that differ{}\n\
         map missed: cells that the hybrid's map decided otherwise than the stencil, as under what is thinner than its\n\
         \u{20}           texels; not among the cells that differ, but in the share and the hours\n\
         furthest: how far the furthest cell that differs lies from a shadow edge, in cells: 1 is right at the edge\n\
         share off: of the sun, in the mean of all cells; h off: hours of the profile, in the worst cell and in the mean\n\
         {}{}",
        match rows.iter().map(|row| row.thin).max().unwrap_or(0) {
            0 => String::new(),
            thin => format!(", without up to {thin} beside what is thinner than a cell"),
        },
        bound(verification, words),
        on_surfaces(verification),
    );
}

/// The bound that must be met, and the reason for it.
fn bound(verification: &Verification, words: &dyn Words) -> String {
    let bound = format!(
        "holds: of edge cells at most {}% differ, and of others one in {OTHERS}; of ray casting's none",
        100.0 * verification.edge_share
    );
    if verification.clean {
        return bound;
    }
    let more = MessagePart::Where(Field::Check, pieces![": ", Field::Check, " says more"]);
    message![bound, "\n         (as not every part that casts is clean", more, ")"].in_words(words)
}

/// Which techniques were compared on façades and roofs, and in how many texels.
fn on_surfaces(verification: &Verification) -> String {
    let Some(surfaces) = verification.surfaces else {
        return "\nno technique was compared on façades and roofs: nothing flat receives".to_owned();
    };
    let mut words: Vec<_> =
        verification.rows.iter().filter(|row| row.on_surfaces).map(|row| row.drawn.technique).collect();
    words.dedup();
    let words: Vec<_> = words.into_iter().map(Method::word).collect();
    format!(
        "\n{}: compared on façades and roofs, in {} texels of {:.3} m; at edges at most {}% of them differ",
        words.join(", "),
        surfaces.texels,
        surfaces.cell,
        100.0 * surfaces.edge_share
    )
}

/// Whether a row is that of the graphics card for a technique that also has a row for the processor.
fn is_on_gpu_too(row: &Row) -> bool {
    row.drawn.engine == Engine::Gpu && !row.drawn.technique.row().on_cpu.is_empty()
}

/// The techniques that do not meet the bound, in one line; `None` if all do.
pub fn failure(verification: &Verification) -> Option<String> {
    let told = |row: &Row| {
        let most = match row.promise {
            Promise::Same => "none may".to_owned(),
            _ => format!(
                "at most {}% of the former may, and one in {OTHERS} others",
                100.0 * verification.edge_share_of(row)
            ),
        };
        let machine = if is_on_gpu_too(row) { " on the gpu" } else { "" };
        let on = if row.on_surfaces { " on surfaces" } else { "" };
        format!("{}{machine}{on} does not hold: {}; {most}", row.drawn.technique, row.difference)
    };
    let failed: Vec<String> = verification.failed().map(told).collect();
    (!failed.is_empty()).then(|| failed.join("; "))
}

/// The place's name, or its coordinates.
fn words(place: &Place) -> String {
    match place.name.as_str() {
        "" => format!("{}°, {}°", place.latitude_deg, place.longitude_deg),
        name => name.replace(char::is_control, " "),
    }
}

/// From the first instant to the last.
fn window(track: &SunTrack) -> String {
    let [Some(first), Some(last)] = [track.instants.first(), track.instants.last()] else { return String::new() };
    let from = first.time.format("%Y-%m-%d %H:%M");
    if first.time == last.time {
        return from.to_string();
    }
    let same_day = first.time.date_naive() == last.time.date_naive();
    format!("{from} to {}", last.time.format(if same_day { "%H:%M" } else { "%Y-%m-%d %H:%M" }))
}

fn counted(count: usize, one: &str) -> String {
    if count == 1 { format!("1 {one}") } else { format!("{count} {one}s") }
}
