//! Doubts about where models stand: default places that nobody has set, and sources that disagree.

use super::anchored_zero::{AnchoredZero, true_north};
use crate::crs::{Crs, GeodeticPoint, LocalFrame};
use crate::formats::{Anchor, AnchorPoint};
use crate::message::{Message, message, place_setting, setting};
use glam::DVec3;

/// Places closer than this are the same, metres horizontally and in height.
pub(super) const ONE_PLACE_M: f64 = 10.0;
/// Norths that differ by less than this are the same: 0.1°, in radians.
const ONE_NORTH_RAD: f64 = 0.1 * std::f64::consts::PI / 180.0;

/// More than the convergence of any map that is built by: 5°, in radians.
const LARGEST_CONVERGENCE_RAD: f64 = 5.0 * std::f64::consts::PI / 180.0;

/// A place closer than this to a default is that default: degrees, some 150 m.
const NEAR_DEG: f64 = 0.0015;

/// Default places that programs write, as found in their files: latitude, longitude, and a description.
const DEFAULTS: &[(f64, f64, &str)] = &[
    (42.3584, -71.0598, "the middle of Boston, which Revit writes"),
    (42.3587, -71.0567, "the middle of Boston, which Revit writes"),
    (42.2124, -71.0333, "a weather station near Boston, which Revit writes"),
    (24.466_67, 54.416_67, "a point of Abu Dhabi, which templates for IFC write"),
];

/// A note if a place is a program's default.
pub(super) fn of(at: Option<GeodeticPoint>, said_by: &str) -> Option<Message> {
    let at = at?;
    let is_near = |(latitude, longitude, _): &&(f64, f64, &str)| {
        (at.latitude_deg - latitude).abs() < NEAR_DEG && (at.longitude_deg - longitude).abs() < NEAR_DEG
    };
    let (.., place) = DEFAULTS.iter().find(is_near)?;
    let what = format!("says by its {said_by} that it stands at {}: {place} if nobody has set a place", degrees(at));
    Some(message![
        what;
        "if it stands elsewhere, write so: ",
        place_setting("latitude and longitude in [place]"),
        ", and ",
        setting("[[model]]", "position", "`position` under [[model]]")
    ])
}

/// A note on a place whose latitude and longitude, or easting and northing, are both 0.
pub(super) fn zero(said_by: &str) -> Message {
    message![
        format!("says by its {said_by} that it stands at 0, 0, which programs write if nobody has set a place");
        "it is not used"
    ]
}

/// A note if a point lies far outside of its map; `said_by` names the anchor that gives the point, if one does.
pub(super) fn outside(crs: &Crs, at: DVec3, said_by: Option<&str>) -> Option<Message> {
    if !crs.is_far_outside(at) {
        return None;
    }
    let by = said_by.map(|by| format!(" by its {by}")).unwrap_or_default();
    let there = crs.to_wgs84(at).map(|there| format!(", which is {}", degrees(there))).unwrap_or_default();
    let what = format!("stands{by} at {:.0}, {:.0} in {}{there}: far outside of that map", at.x, at.y, crs.name());
    Some(message![
        what;
        "easting and northing may be exchanged or in a different unit, or the map may be wrong: correct the file, or write ",
        setting("[[model]]", "crs", "`crs`"), " or ", setting("[[model]]", "position", "`position` under [[model]]")
    ])
}

/// A note if the file gives an anchor's point in a different map than the user does, and the point is elsewhere in it.
pub(super) fn other_map(anchor: &Anchor, asked: &Crs) -> Option<Message> {
    let AnchorPoint::Map { crs, easting, northing, .. } = &anchor.at else { return None };
    let of_file = Crs::read(crs);
    let name = of_file.as_ref().map_or_else(|_| crs.trim(), Crs::name);
    if name.is_empty() || name == asked.name() {
        return None;
    }
    let point = |crs: &Crs| crs.to_wgs84((DVec3::new(*easting, *northing, 0.0) / crs.unit_m()).with_z(0.0));
    let frame = of_file.as_ref().ok().and_then(|of_file| LocalFrame::around(point(of_file)?));
    let away = frame.and_then(|frame| frame.distance_m(point(asked)?));
    if away.is_some_and(|away| away < ONE_PLACE_M) {
        return None;
    }
    let away = away.map(|away| format!(", {} from there", length(away))).unwrap_or_default();
    let key = || setting("[[model]]", "crs", "`crs` under [[model]]");
    Some(message![
        format!("says by its {} that it stands in {name}; ", anchor.said_by), key(),
        format!(" says {}{away}, which is used", asked.name());
        "leave out ", key(), " if the file is right"
    ])
}

/// A note if another source contradicts the one that is used. Something that only one of them gives is not a
/// contradiction.
pub(super) fn apart(used: &str, one: &AnchoredZero, other_by: &str, other: &AnchoredZero) -> Option<Message> {
    let away = one.at.zip(other.at).and_then(|(one, other)| {
        let there = LocalFrame::around(one)?.point(other);
        let ground = there.map_or(f64::INFINITY, |there| there.truncate().length());
        Some([ground, other.height_m - one.height_m])
    });
    let heights = one.has_height && other.has_height;
    let turned = true_north(one).zip(true_north(other)).and_then(|(one, other)| norths_apart(one, other));
    let mut differs = Vec::new();
    if let Some([ground, up]) = away {
        if ground > ONE_PLACE_M {
            differs.push(format!("{} away from where it says", length(ground)));
        }
        if heights && up.abs() > ONE_PLACE_M {
            differs.push(format!("{} {}", length(up.abs()), if up > 0.0 { "higher" } else { "lower" }));
        }
    }
    if let Some(turned) = turned {
        differs.push(format!("turned by {}", angle(turned)));
    }
    if differs.is_empty() {
        return None;
    }
    let what = format!("is placed by its {used}; its {other_by} says otherwise: {}", differs.join(", "));
    Some(
        message![what; setting("[[model]]", "position", "`position`"), " and ", setting("[[model]]", "north", "`north` under [[model]]"), " override both"],
    )
}

/// A note if an anchor in a map that cannot be used contradicts the north that is used by more than any map's
/// convergence.
pub(super) fn turned_apart(used: &str, one: &AnchoredZero, other: &Anchor) -> Option<Message> {
    let turned = half_turn(other.north_rad? - true_north(one)?);
    let is_map = matches!(other.at, AnchorPoint::Map { .. });
    (is_map && turned.abs() > LARGEST_CONVERGENCE_RAD).then(|| {
        let what = format!(
            "is turned by its {used}; its {} says otherwise, by {}: more than a map's north can differ from true north",
            other.said_by,
            angle(turned)
        );
        message![what; setting("[[model]]", "north", "`north` under [[model]]"), " overrides both"]
    })
}

/// The clockwise angle from one north to another, radians, if they are not the same.
pub(super) fn norths_apart(one: f64, other: f64) -> Option<f64> {
    Some(half_turn(other - one)).filter(|turned| turned.abs() > ONE_NORTH_RAD)
}

/// Brings an angle between −π and π.
fn half_turn(angle: f64) -> f64 {
    let turn = std::f64::consts::TAU;
    (angle + turn / 2.0).rem_euclid(turn) - turn / 2.0
}

/// An angle in degrees with two decimals: `30.43°`.
pub(super) fn angle(radians: f64) -> String {
    // turns −0 into 0
    format!("{:.2}°", (radians.to_degrees() * 100.0).round() / 100.0 + 0.0)
}

/// `312 m`, `4.2 km`, `320 km`.
pub(super) fn length(metres: f64) -> String {
    match metres {
        _ if !metres.is_finite() => "thousands of kilometres".to_owned(),
        _ if metres < 1000.0 => format!("{metres:.0} m"),
        _ if metres < 20_000.0 => format!("{:.1} km", metres / 1000.0),
        _ => format!("{:.0} km", metres / 1000.0),
    }
}

/// `49.1004 N 8.4366 E`
pub(super) fn degrees(at: GeodeticPoint) -> String {
    let one = |value: f64, positive: &str, negative: &str| {
        let text = format!("{:.5}", value.abs());
        let text = text.trim_end_matches('0').trim_end_matches('.').to_owned();
        format!("{text} {}", if value < 0.0 { negative } else { positive })
    };
    format!("{} {}", one(at.latitude_deg, "N", "S"), one(at.longitude_deg, "E", "W"))
}
