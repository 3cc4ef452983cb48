//! Suggests what an unknown time zone probably means: an offset, a city, or a misspelling.

use super::{Zone, zone_names};
use unicode_normalization::UnicodeNormalization;

/// The hint, to follow a semicolon. `here` is the zone at the place's coordinates.
pub(super) fn way_out(name: &str, here: Option<Zone>) -> String {
    let or_none = match here {
        Some(here) => format!("leave time_zone out: by the coordinates it is \"{here}\""),
        None => "give the name of a city's zone, as in \"Europe/Paris\"".to_owned(),
    };
    if let Some(minutes) = offset_minutes(name) {
        return match always(minutes) {
            Some(zone) if minutes == 0 => format!("write \"{zone}\", or {or_none}"),
            Some(zone) => {
                let (hours, side) = (minutes.abs() / 60, if minutes > 0 { "ahead of" } else { "behind" });
                format!("{hours} h {side} UTC all year is \"{zone}\", whose name has the opposite sign; or {or_none}")
            }
            None => format!("no zone has that offset all year; {or_none}"),
        };
    }
    match zone_named_so(name).or_else(|| zone_like(name)) {
        Some(zone) if here.is_some_and(|here| here.name() == zone) => {
            format!("write \"{zone}\", or leave time_zone out: the coordinates lie in it")
        }
        Some(zone) => format!("the nearest is \"{zone}\"; write that, or {or_none}"),
        None => or_none,
    }
}

/// Minutes ahead of UTC in `+02:00`, `-7`, `UTC+2`, `GMT +0530`; `None` for other text.
fn offset_minutes(text: &str) -> Option<i32> {
    let text: String = text.chars().filter(|letter| !letter.is_whitespace()).collect::<String>().to_uppercase();
    let bare = ["UTC", "GMT", "Z"].iter().find_map(|prefix| text.strip_prefix(prefix));
    if bare == Some("") {
        return Some(0);
    }
    let mut rest = bare.unwrap_or(&text).chars();
    let sign = match rest.next()? {
        '+' => 1,
        // word processors write the true minus sign
        '-' | '−' => -1,
        _ => return None,
    };
    let digits = rest.as_str();
    let (hours, minutes) = match digits.split_once([':', '.']) {
        Some(both) => both,
        None if digits.len() == 4 => digits.split_at_checked(2)?,
        None => (digits, "0"),
    };
    let number = |digits: &str| {
        let plain = (1..=2).contains(&digits.len()) && digits.bytes().all(|byte| byte.is_ascii_digit());
        plain.then(|| digits.parse::<i32>().ok()).flatten()
    };
    Some(sign * (60 * number(hours)? + number(minutes).filter(|minutes| *minutes < 60)?))
}

/// The zone with a constant offset. Its name has the sign of POSIX, positive to the west.
fn always(minutes: i32) -> Option<&'static str> {
    let name = match minutes / 60 {
        _ if minutes % 60 != 0 => return None,
        0 => "UTC".to_owned(),
        hours => format!("Etc/GMT{:+}", -hours),
    };
    zone_names().find(|zone| *zone == name)
}

/// The zone with that name in other capitals, or with that city: `berlin`, `São Paulo`, `Deutschland/Berlin`.
fn zone_named_so(name: &str) -> Option<&'static str> {
    /// prefixes of names of regions, not of cities
    const STATES: [&str; 6] = ["Brazil/", "Canada/", "Chile/", "Etc/", "Mexico/", "US/"];
    let is_city = |zone: &&str| zone.contains('/') && !STATES.iter().any(|state| zone.starts_with(state));
    let city = letters(last_part(name));
    let of_city = || zone_names().filter(is_city).find(|zone| letters(last_part(zone)) == city);
    zone_names().find(|zone| zone.eq_ignore_ascii_case(name)).or_else(of_city)
}

/// The zone with a name that differs by one letter, or two in a long name. Names of other cities are excluded, and
/// names as short as `PST` are too ambiguous.
fn zone_like(name: &str) -> Option<&'static str> {
    const SHORT: usize = 5;
    const LONG: usize = 9;
    let slips = match letters(last_part(name)).chars().count() {
        length if length < SHORT => return None,
        length if length < LONG => 1,
        _ => 2,
    };
    let lower = name.to_lowercase();
    let compared = |zone: &'static str| if name.contains('/') { zone } else { last_part(zone) };
    let distance = |zone| strsim::damerau_levenshtein(&compared(zone).to_lowercase(), &lower);
    let nearest = zone_names().map(|zone| (distance(zone), zone)).min_by_key(|(distance, _)| *distance);
    nearest.filter(|(distance, _)| *distance <= slips).map(|(_, zone)| zone)
}

fn last_part(name: &str) -> &str {
    name.rsplit(['/', '\\']).next().unwrap_or(name)
}

/// Lower case, without accents and separators.
fn letters(name: &str) -> String {
    name.nfd().filter(|letter| letter.is_alphanumeric()).flat_map(char::to_lowercase).collect()
}
