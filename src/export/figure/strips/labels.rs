//! The text beside the strips.

use super::colours::{NIGHT, OUTSIDE, SHADE, SUN};
use crate::export::figure::panel::Panel;
use crate::export::figure::svg::{ACCENT, Block, LetterStyle, TextAnchor};
use crate::export::figure::{text, words};
use crate::export::probe::{clock, facing, triple};
use crate::export::report;
use crate::site::Ground;
use crate::sun::{Air, Place, Zone, delta_t_secs, position};
use crate::sunlight::{Interval, ProbeIntervals, SunDay, Sunlight};
use chrono::DateTime;

pub(super) fn panel(sunlight: &Sunlight, place: &Place, ground: &Ground) -> Panel {
    let name = text::clean(&place.name);
    let mut facts = Vec::new();
    if !name.is_empty() {
        facts.push(("Place", words::coordinates(place)));
    }
    facts.push(("Elevation", words::metres(place.elevation_m)));
    facts.push(("Ground", words::ground(ground)));
    if let [ProbeIntervals { probe, .. }] = sunlight.probes.as_slice() {
        facts.push(("Point", format!("{} m", triple(probe.point).replace('-', "−"))));
        facts.push(("Normal", probe.normal.map_or_else(|| "none: free on all sides".to_owned(), facing)));
    } else {
        facts.push(("Probes", sunlight.probes.len().to_string()));
    }
    facts.push(("Exact", "to the second, nothing left out".to_owned()));
    facts.push(("Refraction", words::refraction(sunlight.refraction, place)));
    if let [probed] = sunlight.probes.as_slice() {
        sums(&mut facts, sunlight, probed);
    }
    let mut legend = vec![(SUN, "sun".to_owned()), (SHADE, "shade".to_owned()), (NIGHT, "night".to_owned())];
    if sunlight.days.iter().any(is_cut) {
        legend.push((OUTSIDE, "outside of the window".to_owned()));
    }
    legend.push((ACCENT, "sunrise and sunset (lines)".to_owned()));
    Panel {
        kicker: "Hours of sun".to_owned(),
        title: if name.is_empty() { words::coordinates(place) } else { name },
        lead: lead(sunlight, place),
        facts,
        sun: sun_rows(sunlight, place),
        legend_head: if sunlight.probes.len() > 1 { "At the probes" } else { "At the probe" }.to_owned(),
        legend,
        keys: Vec::new(),
        tz: report::tz_version(place),
        north_up: true,
    }
}

/// Whether the requested part of a day is shorter than the time during which the sun is up.
fn is_cut(day: &SunDay) -> bool {
    let window = &day.window;
    let up = [window.day.sunrise, window.day.sunset];
    up.into_iter().flatten().any(|event| !(window.from..=window.to).contains(&event)) || window.from == window.to
}

/// A probe's total, its longest interval, and for several days those with the least and the most sun.
pub(in crate::export::figure) fn sums(
    facts: &mut Vec<(&'static str, String)>,
    sunlight: &Sunlight,
    probed: &ProbeIntervals,
) {
    facts.push(("Total", clock(probed.secs())));
    let several = sunlight.days.len() > 1;
    let on =
        |interval: &Interval| format!("{} on {}", clock(interval.secs()), words::date(interval.start.date_naive()));
    let longest =
        probed.longest().map_or_else(|| "none".to_owned(), |it| if several { on(it) } else { clock(it.secs()) });
    facts.push(("Longest", longest));
    if let (true, Some([(least_on, least), (most_on, most)])) = (several, sunlight.least_and_most(probed)) {
        facts.push(("Least", format!("{} on {}", clock(least), words::date(least_on))));
        facts.push(("Most", format!("{} on {}", clock(most), words::date(most_on))));
    }
}

/// The date or dates, and the time zone.
pub(in crate::export::figure) fn lead(sunlight: &Sunlight, place: &Place) -> Vec<String> {
    let (Some(first), Some(last)) = (sunlight.days.first(), sunlight.days.last()) else { return Vec::new() };
    let [from, to] = [first, last].map(|day| words::date(day.window.day.date));
    let dates = if from == to { from } else { format!("{from} – {to}") };
    let zones = sunlight.days.iter().flat_map(|day| [day.window.from, day.window.to]).map(|time| words::zone(&time));
    let mut zones: Vec<String> = zones.collect();
    let mut seen = Vec::new();
    zones.retain(|zone| {
        !seen.contains(zone) && {
            seen.push(zone.clone());
            true
        }
    });
    vec![dates, format!("{}, {}", zones.join(" and "), place.time_zone.name())]
}

/// For a single day, where the sun rises and sets, and its greatest altitude.
fn sun_rows(sunlight: &Sunlight, place: &Place) -> Vec<[String; 4]> {
    let [day] = sunlight.days.as_slice() else { return Vec::new() };
    let air = sunlight.refraction.then(|| Air::standard(place.elevation_m));
    let row = |what: &str, time: Option<DateTime<Zone>>, is_high: bool| {
        let time = time?;
        let sun = position(place, time.to_utc(), delta_t_secs(time.to_utc()).ok()?, air).ok()?;
        let [azimuth, altitude] =
            [sun.azimuth_deg, sun.altitude_deg].map(|degrees| words::degrees(degrees.to_radians()));
        Some([what.to_owned(), words::almanac(&time), azimuth, if is_high { altitude } else { String::new() }])
    };
    let day = &day.window.day;
    let rows = [row("rises", day.sunrise, false), row("noon", day.noon, true), row("sets", day.sunset, false)];
    rows.into_iter().flatten().collect()
}

/// The intervals of a single probe on a single day, as a table of at most this height.
pub(super) fn intervals(sunlight: &Sunlight, intervals: &[Interval], room: f64) -> Block {
    const LEFT: [f64; 5] = [0.0, 260.0, 520.0, 780.0, 1500.0];
    const PITCH: f64 = 54.0;
    let mut block = Block::default();
    let mut row = |cells: [&str; 5], style: LetterStyle| {
        let baseline = block.height + LetterStyle::BODY.size;
        for (index, (cell, left)) in cells.into_iter().zip(LEFT).enumerate() {
            let width = LEFT.get(index + 1).map_or(700.0, |next| next - left) - 30.0;
            let cell = text::wrap(cell, style.weight, style.size, width, 1).concat();
            block.text(left, baseline, TextAnchor::Start, style, &cell);
        }
        block.height += PITCH;
        block.height
    };
    let mut used = row(["start", "end", "duration", "blocked before", "blocked after"], LetterStyle::LABEL);
    for (index, interval) in intervals.iter().enumerate() {
        if used + 2.0 * PITCH > room && index + 1 < intervals.len() {
            let more = format!("… and {} more", intervals.len() - index);
            row([&more, "", "", "", ""], LetterStyle::LABEL);
            break;
        }
        let [start, end] = [interval.start, interval.end].map(|time| time.format("%H:%M:%S").to_string());
        let [before, after] = [interval.before, interval.after].map(|blocked| sunlight.name(blocked));
        used = row([&start, &end, &clock(interval.secs()), &before, &after], LetterStyle::BODY);
    }
    block
}
