//! How drawings word places, times, durations and techniques.

use crate::choice::{Finder, Receivers, Settings};
use crate::profile::Provenance;
use crate::site::{self, Ground, GroundFrom, GroundKind};
use crate::sun::{Air, Day, EachDay, Instant, Place, Polar, SunTrack, Zone};
use crate::view::Elevation;
use chrono::{DateTime, NaiveDate, Offset, Timelike};

/// `48.2000° N, 16.3800° E`.
pub(super) fn coordinates(place: &Place) -> String {
    let side = |degrees: f64, positive, negative| {
        format!("{:.4}° {}", degrees.abs(), if degrees < 0.0 { negative } else { positive })
    };
    format!("{}, {}", side(place.latitude_deg, 'N', 'S'), side(place.longitude_deg, 'E', 'W'))
}

/// A number of metres with four digits, without trailing zeros.
pub(super) fn metres(value: f64) -> String {
    let decimals = 3.0 - value.abs().max(1e-9).log10().floor();
    // At least one decimal, so that no whole number loses its zeros.
    let text = format!("{value:.*}", decimals.clamp(1.0, 9.0) as usize);
    let text = text.trim_end_matches('0').trim_end_matches('.');
    format!("{} m", if text == "-0" { "0" } else { text }).replace('-', "−")
}

/// The ground in one line of a panel: `0.00 m, models’ zero; 12.00 m below`, or `terrain; beyond it 312.00 m`.
pub(super) fn ground(ground: &Ground) -> String {
    if ground.kind == GroundKind::Terrain {
        return format!("terrain; beyond it {}", site::metres(ground.level)).replace('-', "−");
    }
    let (below, above) = (ground.models_below_m(), ground.lowest - ground.level);
    let [level, below_m, above_m] = [ground.level, below, above].map(site::metres);
    let said = match ground.from {
        GroundFrom::Zero => format!("{level}, models’ zero; {below_m} below"),
        _ if below > 0.0 => format!("{level}; models reach {below_m} below"),
        GroundFrom::Lowest => format!("{level}, models’ lowest point"),
        GroundFrom::Site if above > 0.001 => format!("{level}; models {above_m} above"),
        GroundFrom::Site => level,
    };
    said.replace('-', "−")
}

/// `18 September 2026`, or the first and the last day.
pub(super) fn dates(track: &SunTrack, first: &Instant, last: &Instant) -> String {
    let (mut first, mut last) = (first.time.date_naive(), last.time.date_naive());
    // the last window may end on the next day
    if let (Some(_), Some(from), Some(to)) = (&track.each_day, track.days.first(), track.days.last()) {
        (first, last) = (from.date, to.date);
    }
    if first == last { date(first) } else { format!("{} – {}", date(first), date(last)) }
}

pub(super) fn date(date: NaiveDate) -> String {
    date.format("%-d %B %Y").to_string()
}

/// `09:00`, with seconds only where there are any.
pub(super) fn clock(time: &DateTime<Zone>) -> String {
    let format = if time.second() == 0 { "%H:%M" } else { "%H:%M:%S" };
    time.format(format).to_string()
}

/// `06:35`: to the nearest minute, as almanacs print it.
pub(super) fn almanac(time: &DateTime<Zone>) -> String {
    (*time + chrono::Duration::seconds(30)).format("%H:%M").to_string()
}

/// `from the south, along level rays`, or `as the sun sees it, along its rays`.
pub(super) fn side(side: &Elevation) -> String {
    if !side.is_level() {
        return "as the sun sees it, along its rays".to_owned();
    }
    let azimuth_deg = side.to_viewer.x.atan2(side.to_viewer.y).to_degrees().rem_euclid(360.0);
    let nearest = (azimuth_deg / 90.0).round();
    let from = match ["the north", "the east", "the south", "the west"].get(nearest as usize % 4) {
        Some(word) if (azimuth_deg - nearest * 90.0).abs() < 0.5 => (*word).to_owned(),
        _ => format!("{azimuth_deg:.0}°"),
    };
    format!("from {from}, along level rays")
}

/// `09:00–17:00 CEST (UTC+2), Europe/Vienna`, or one clock time.
pub(super) fn window(track: &SunTrack, place: &Place) -> String {
    let (Some(first), Some(last)) = (track.instants.first(), track.instants.last()) else {
        return place.time_zone.name().to_owned();
    };
    if let Some(each) = &track.each_day {
        return format!("{}, {}", each_day(each), place.time_zone.name());
    }
    let (first, last) = (&first.time, &last.time);
    let clocks = if track.instants.len() == 1 {
        format!("{} {}", clock(first), zone(first))
    } else if zone(first) == zone(last) {
        format!("{}–{} {}", clock(first), clock(last), zone(first))
    } else {
        format!("{} {} – {} {}", clock(first), zone(first), clock(last), zone(last))
    };
    format!("{clocks}, {}", place.time_zone.name())
}

/// `each day 09:00–17:00`, `each day from sunrise+1h`, `whole days`.
fn each_day(each: &EachDay) -> String {
    match (&each.from, &each.to) {
        (None, None) => "whole days".to_owned(),
        (Some(from), Some(to)) => format!("each day {from} – {to}"),
        (Some(from), None) => format!("each day from {from}"),
        (None, Some(to)) => format!("each day until {to}"),
    }
}

/// `CEST (UTC+2)`, or `UTC+3` if the zone has no abbreviation.
pub(super) fn zone(time: &DateTime<Zone>) -> String {
    let secs = time.offset().fix().local_minus_utc();
    let (hours, minutes) = (secs.abs() / 3600, secs.abs() / 60 % 60);
    let mut utc = String::from("UTC");
    if secs != 0 {
        utc.push(if secs < 0 { '−' } else { '+' });
        utc.push_str(&hours.to_string());
        if minutes != 0 {
            utc.push_str(&format!(":{minutes:02}"));
        }
    }
    let letters = time.format("%Z").to_string();
    if letters == utc || letters.starts_with(['+', '-']) { utc } else { format!("{letters} ({utc})") }
}

/// `8 h`, `1 h 30 min`, `1 min 30 s`.
pub(crate) fn duration(secs: u32) -> String {
    let parts = [(secs / 3600, "h"), (secs / 60 % 60, "min"), (secs % 60, "s")];
    let said: Vec<String> =
        parts.iter().filter(|(count, _)| *count > 0).map(|(count, unit)| format!("{count} {unit}")).collect();
    if said.is_empty() { "0 s".to_owned() } else { said.join(" ") }
}

/// The duration from which minutes are left out, seconds.
pub(super) const MANY_HOURS_SECS: u32 = 100 * 3600;

/// As [`duration`], but long ones without minutes.
pub(super) fn long_duration(secs: u32) -> String {
    if secs < MANY_HOURS_SECS { duration(secs) } else { format!("{} h", (f64::from(secs) / 3600.0).round()) }
}

/// `1:30`; with seconds only if `with_secs`.
pub(super) fn hours(secs: u32, with_secs: bool) -> String {
    let (h, m, s) = (secs / 3600, secs / 60 % 60, secs % 60);
    if with_secs { format!("{h}:{m:02}:{s:02}") } else { format!("{h}:{m:02}") }
}

/// `sunrise 06:35, noon 12:48, sunset 19:02`, or the kind of polar day.
pub(super) fn day(day: &Day) -> String {
    let noon = day.noon.as_ref().map(|noon| format!("noon {}", almanac(noon)));
    let parts = match day.polar {
        Some(Polar::Day) => vec![Some("the sun stays up".to_owned()), noon],
        Some(Polar::Night) => vec![Some("the sun stays down".to_owned())],
        None => vec![
            day.sunrise.as_ref().map(|time| format!("rises {}", almanac(time))),
            noon,
            day.sunset.as_ref().map(|time| format!("sets {}", almanac(time))),
        ],
    };
    parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
}

/// How the result was computed, in words: technique, silhouettes, machine.
pub(super) fn technique(drawn: &Provenance) -> String {
    let technique = drawn.technique.row().name;
    let silhouettes = drawn.finder.map(|finder| match finder {
        Finder::Brute => ", silhouettes by brute force",
        Finder::Hextree => ", silhouettes by hextree",
        Finder::Gpu => ", silhouettes on the GPU",
        Finder::Auto => "",
    });
    let machine = match &drawn.adapter {
        Some(adapter) => format!("GPU: {adapter}"),
        None => drawn.engine.word().to_uppercase(),
    };
    let Settings { map_size, filter, smoothie_width_m, sun_samples } = drawn.settings;
    let settings = [
        map_size.map(|size| format!(", map of {size}²")),
        filter.map(|filter| format!(", filtered {filter}")),
        smoothie_width_m.map(|width| format!(", at most {width} m wide")),
        sun_samples.map(|samples| format!(" to {samples} points of the sun’s disc")),
    ];
    let settings: String = settings.into_iter().flatten().collect();
    format!("{technique}{settings}{}, {machine}", silhouettes.unwrap_or_default())
}

/// What is judged, in words.
pub(super) fn receivers(receivers: Receivers) -> &'static str {
    match receivers {
        Receivers::Top => "highest surface",
        Receivers::Ground => "ground only",
        Receivers::Patches => "walls, roofs and undersides",
    }
}

/// Whether refraction is included, and how it was computed.
pub(super) fn refraction(refraction: bool, place: &Place) -> String {
    if refraction {
        let air = Air::standard(place.elevation_m);
        format!("included, at {:.0} °C and {:.0} hPa", air.temperature_c, air.pressure_hpa)
    } else {
        "left out".to_owned()
    }
}

/// `143.2°`, with a true minus sign.
pub(super) fn degrees(radians: f64) -> String {
    format!("{:.1}°", radians.to_degrees()).replace('-', "−")
}
