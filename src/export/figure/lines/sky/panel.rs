//! The text beside the charts.

use super::context::SkyContext;
use super::tones::{BEHIND, CLOCK, GROUND, SHADED, SUN, SUNDIAL, WAY, tone};
use crate::export::figure::panel::Panel;
use crate::export::figure::scale::Rgb;
use crate::export::figure::strips::labels::{lead, sums};
use crate::export::figure::{text, words};
use crate::export::probe::{facing, triple};
use crate::export::report;
use crate::site::metres;
use crate::sun::Zone;
use crate::sunlight::{SkyCell, SkyRaster};
use chrono::DateTime;
use glam::DVec3;
use std::collections::BTreeMap;

/// The most components that the legend names, and the most rows of the sun's table.
const MOST_NAMED: usize = 8;
const MOST_ROWS: usize = 8;

pub(super) fn panel(shown: &SkyContext, strip: &SkyRaster) -> Panel {
    let SkyContext { place, sunlight, .. } = shown;
    let probed = &sunlight.probes[shown.probe];
    let name = text::clean(&place.name);
    let mut facts = Vec::new();
    if !name.is_empty() {
        facts.push(("Place", words::coordinates(place)));
    }
    facts.push(("Ground", words::ground(shown.ground)));
    facts.push(("Point", format!("{} m", triple(probed.probe.point).replace('-', "−"))));
    facts.push(("Normal", probed.probe.normal.map_or_else(|| "none: free on all sides".to_owned(), facing)));
    if let Some(below) = probed.below_ground_m {
        facts.push(("Below", format!("{} below the ground: no sun reaches it", metres(below))));
    }
    facts.push(("Refraction", words::refraction(sunlight.refraction, place)));
    sums(&mut facts, sunlight, probed);
    if shown.ways.len() < sunlight.days.len() {
        facts.push(("Drawn", format!("{} of the {} days", shown.ways.len(), sunlight.days.len())));
    }
    let mut lines = vec![text::clean(&probed.probe.name)];
    lines.extend(lead(sunlight, place));
    Panel {
        kicker: "Sky of a point".to_owned(),
        title: if name.is_empty() { words::coordinates(place) } else { name },
        lead: lines,
        facts,
        sun: sun_rows(shown),
        legend_head: "What stands before the point".to_owned(),
        legend: legend(shown, strip),
        keys: keys(shown),
        tz: report::tz_version(place),
        north_up: true,
    }
}

/// The sun's positions when it comes and goes, if there is a single day.
fn sun_rows(shown: &SkyContext) -> Vec<[String; 4]> {
    let [way] = shown.ways else { return Vec::new() };
    let row = |what: &str, time: String, to: Option<&DVec3>| {
        let [azimuth, altitude] = to.map_or_else(Default::default, |to| {
            let azimuth = to.x.atan2(to.y).rem_euclid(std::f64::consts::TAU);
            [azimuth, to.z.clamp(-1.0, 1.0).asin()].map(words::degrees)
        });
        [what.to_owned(), time, azimuth, altitude]
    };
    let clock = |time: &DateTime<Zone>| time.format("%H:%M:%S").to_string();
    let rows = way.intervals.iter().zip(&way.lit).flat_map(|(interval, lit)| {
        [row("comes", clock(&interval.start), lit.first()), row("goes", clock(&interval.end), lit.last())]
    });
    let mut rows: Vec<_> = rows.collect();
    if rows.len() > MOST_ROWS {
        let more = format!("and {} more", rows.len() / 2 - (MOST_ROWS / 2 - 1));
        rows.truncate(MOST_ROWS - 2);
        rows.push(row(&more, String::new(), None));
    }
    rows
}

/// What is seen from the point, the largest part of the sky first.
fn legend(shown: &SkyContext, strip: &SkyRaster) -> Vec<(Rgb, String)> {
    let (width, height) = (strip.picture.width as usize, f64::from(strip.picture.height.max(1)));
    let mut parts: BTreeMap<SkyCell, f64> = BTreeMap::new();
    for (index, cell) in strip.cells.iter().enumerate() {
        let altitude = (1.0 - ((index / width) as f64 + 0.5) / height) * std::f64::consts::FRAC_PI_2;
        *parts.entry(*cell).or_default() += altitude.cos();
    }
    let mut legend = vec![(SUN, "the sun, as the point sees it".to_owned())];
    legend.extend(parts.contains_key(&SkyCell::Behind).then(|| (BEHIND, "behind the point’s plane".to_owned())));
    legend.extend(parts.contains_key(&SkyCell::Ground).then(|| (GROUND, "the ground above the point".to_owned())));
    let mut components: Vec<(u32, f64)> = parts
        .iter()
        .filter_map(|(cell, part)| match cell {
            SkyCell::Component(component) => Some((*component, *part)),
            _ => None,
        })
        .collect();
    components.sort_by(|one, other| other.1.total_cmp(&one.1));
    let named = if components.len() == MOST_NAMED + 1 { components.len() } else { MOST_NAMED };
    for (component, _) in components.iter().take(named) {
        let name = shown.sunlight.components.get(*component as usize).map_or("", String::as_str);
        let colour = tone(SkyCell::Component(*component), shown.colours);
        legend.extend(colour.map(|colour| (colour, text::clean(name))));
    }
    if let Some((next, _)) = components.get(named) {
        let colour = tone(SkyCell::Component(*next), shown.colours).unwrap_or(GROUND);
        legend.push((colour, format!("and {} more, each in its colour", components.len() - named)));
    }
    legend
}

fn keys(shown: &SkyContext) -> Vec<(Rgb, String)> {
    let year = shown.lines.year;
    let days = if shown.ways.len() == 1 { "the sun’s way of the day" } else { "the sun’s ways of the days" };
    vec![
        (SHADED, days.to_owned()),
        (WAY, format!("each 21st in {year}, from July on dashed")),
        (CLOCK, "hours of the clock".to_owned()),
        (SUNDIAL, "hours of true solar time (XII: noon)".to_owned()),
    ]
}
