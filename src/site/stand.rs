//! Puts a model where it stands in the frame of the site, given what is said about its place.

use super::anchored_zero::{AnchoredNorth, AnchoredZero, true_north};
use super::georeference::{Georeference, Reference, StandFault};
use super::model_bounds::bounds;
use super::place_doubts::{ONE_PLACE_M, angle, degrees, length, norths_apart};
use super::placement::Placement;
use crate::crs::{Crs, CrsKind, GeodeticPoint, LocalFrame, MapToLocal, TOO_FAR_M};
use crate::formats::{Model, PartKind, Up};
use crate::message::{Message, message, place_setting, set_to, setting};
use glam::{DAffine3, DVec3};
use rayon::prelude::*;

/// An anchor farther from the place than this contradicts it, metres.
pub(super) const FAR_M: f64 = 20_000.0;

/// True norths that differ by less are the same: the precision with which they are shown.
pub(super) const ONE_MERIDIAN_RAD: f64 = 0.005 * std::f64::consts::PI / 180.0;

/// The site's frame, and whether its height was given.
#[derive(Clone, Debug)]
pub(super) struct SiteFrame {
    pub(super) local: LocalFrame,
    pub(super) has_elevation: bool,
    /// What the place is, if a model's file proposed it, such as "the middle of town.city.json".
    pub(super) is_of: Option<String>,
}

pub(super) struct StandingModel {
    pub(super) model: Model,
    /// How it was turned and moved, radians and metres; 0 if its corners were converted one by one.
    pub(super) north_rad: f64,
    pub(super) position: DVec3,
    /// Whether it is placed on Earth, so that it moves if the place changes.
    pub(super) is_on_earth: bool,
    /// Whether its corners were converted one by one from a map.
    pub(super) is_of_map: bool,
    /// Whether it stands exactly where its file or `crs` says.
    pub(super) is_where_said: bool,
    /// Notes on where it stands, with the model as the subject.
    pub(super) notes: Vec<Message>,
}

/// Puts a model where it stands. Without a frame there is no place, and only the site file counts.
///
/// # Errors
/// A model that cannot stand where it is said to stand, with the key that helps.
pub(super) fn stand(
    model: Model,
    placement: &Placement,
    said: Georeference,
    frame: Option<&SiteFrame>,
) -> Result<StandingModel, StandFault> {
    let Georeference { reference, said_by, mut notes } = said;
    let by_site = |model: Model, north_rad, position, notes, [is_on_earth, is_where_said]: [bool; 2]| StandingModel {
        model: placement.place_at(model, north_rad, position),
        north_rad,
        position,
        is_on_earth,
        is_of_map: false,
        is_where_said,
        notes,
    };
    let (north_rad, position) = (placement.north_rad.unwrap_or_default(), placement.position.unwrap_or_default());
    match (reference, frame) {
        (Reference::Map { crs, map_from_model, unit_m }, Some(frame)) => {
            let model = converted(model, &crs, map_from_model, unit_m, placement, frame)?;
            notes.extend(note_map(&model, &crs, &said_by, placement, frame));
            let is_where_said = placement.position.is_none();
            Ok(StandingModel {
                model,
                north_rad: 0.0,
                position,
                is_on_earth: true,
                is_of_map: true,
                is_where_said,
                notes,
            })
        }
        (Reference::Anchor(zero), Some(frame)) => {
            let AnchoredPosition { position, north_rad, is_where_said, note } =
                anchored(&zero, &said_by, placement, frame)?;
            notes.extend(note);
            if zero.at.is_none() {
                notes.extend(note_unplaced(&model, placement, frame, true));
            }
            Ok(by_site(model, north_rad, position, notes, [zero.at.is_some(), is_where_said]))
        }
        (Reference::Anchor(zero), None) => {
            let north_rad = placement.north_rad.or(true_north(&zero)).unwrap_or_default();
            Ok(by_site(model, north_rad, position, notes, [false; 2]))
        }
        (Reference::Placement | Reference::Map { .. }, frame) => {
            notes.extend(note_no_map(&model, placement));
            let is_turned = placement.north_rad.is_some();
            notes.extend(frame.and_then(|frame| note_unplaced(&model, placement, frame, is_turned)));
            Ok(by_site(model, north_rad, position, notes, [false; 2]))
        }
    }
}

/// A note if terrain, whose coordinates are always in some map, does not say in which.
fn note_no_map(model: &Model, placement: &Placement) -> Option<Message> {
    let is_terrain = model.kinds.contains(&PartKind::Terrain);
    let is_placed = placement.position.is_some() || placement.crs.is_some();
    let crs = || set_to("[[model]]", "crs", "EPSG:…".to_owned(), "`crs = \"EPSG:…\"` under [[model]]".to_owned());
    (is_terrain && !is_placed).then(|| {
        message![
            "does not say in which map its coordinates are, so they are taken as metres from the place";
            "write ", crs()
        ]
    })
}

/// A note if nothing gives a model's place, and the site's place is only proposed by another model's file, so that
/// nobody has chosen the point at which both meet.
fn note_unplaced(model: &Model, placement: &Placement, frame: &SiteFrame, is_turned: bool) -> Option<Message> {
    let is_terrain = model.kinds.contains(&PartKind::Terrain);
    let of = frame.is_of.as_ref().filter(|_| placement.position.is_none() && !is_terrain)?;
    let axis = match placement.up.unwrap_or(model.up) {
        Up::Y => "−z",
        Up::Z => "y",
    };
    let turned = if is_turned { String::new() } else { format!(", with its {axis} to the north") };
    Some(message![
        format!("gives no place: its zero stands at {of}{turned}");
        "if it stands elsewhere, write ", setting("[[model]]", "position", "`position`"), " and ",
        setting("[[model]]", "north", "`north` under [[model]]")
    ])
}

/// Converts every corner from a map to the frame.
fn converted(
    mut model: Model,
    crs: &Crs,
    map_from_model: DAffine3,
    unit_m: f64,
    placement: &Placement,
    frame: &SiteFrame,
) -> Result<Model, StandFault> {
    let to = MapToLocal { crs, frame: &frame.local };
    let height_unit_m = model.unit_m.unwrap_or(1.0);
    let from_ground = std::mem::take(&mut model.from_ground);
    for (index, part) in model.parts.iter_mut().enumerate() {
        part.positions.par_iter_mut().for_each(|corner| *corner = map_from_model.transform_point3(*corner));
        let is_from_ground = from_ground.get(index).copied().unwrap_or_default();
        let heights = is_from_ground.then(|| part.positions.iter().map(|corner| corner.z).collect::<Vec<_>>());
        to.convert(&mut part.positions).map_err(|index| {
            // for the error: the corner that cannot be converted
            let at = part.positions.get(index).copied().unwrap_or_default();
            StandFault::of_crs(placement, out_of_reach(&part.name, crs, at, frame))
        })?;
        // measured from the ground, not from sea level
        part.positions
            .iter_mut()
            .zip(heights.unwrap_or_default())
            .for_each(|(corner, height)| corner.z = height * height_unit_m);
        let position = placement.position.unwrap_or_default();
        part.positions.par_iter_mut().for_each(|corner| *corner += position);
        part.coarse.iter_mut().for_each(|run| run.step_m *= unit_m);
    }
    model.from_ground = from_ground;
    Ok(model)
}

/// The error for a corner that lies outside of its map or too far from the place; it says what lies where.
fn out_of_reach(part: &str, crs: &Crs, at: DVec3, frame: &SiteFrame) -> Message {
    let crs_key = || setting("[[model]]", "crs", "`crs` under [[model]]");
    let Some(there) = crs.to_wgs84(at) else {
        return message![
            format!("has '{part}' at {}, {}, where {} does not reach", at.x, at.y, crs.name());
            "write another map as ", crs_key(), ", or the unit as ", setting("[[model]]", "scale", "`scale`")
        ];
    };
    let away = frame.local.distance_m(there).unwrap_or(f64::INFINITY);
    let what = format!(
        "has '{part}' at {}, {} in {}: that is {}, {} from the place at {}, and models must stand within {} of it",
        at.x,
        at.y,
        crs.name(),
        degrees(there),
        length(away),
        degrees(frame.local.place()),
        length(TOO_FAR_M)
    );
    message![
        what;
        "if that is not where it stands, write its map as ", crs_key(), "; if it is, correct ",
        place_setting("latitude and longitude in [place]")
    ]
}

/// Where a model with an anchor stands.
struct AnchoredPosition {
    position: DVec3,
    /// The angle by which it is turned.
    north_rad: f64,
    /// Whether it stands where its anchor says.
    is_where_said: bool,
    /// The note about it.
    note: Option<Message>,
}

/// Where an anchored origin lies in the frame.
fn anchored(
    zero: &AnchoredZero,
    said_by: &str,
    placement: &Placement,
    frame: &SiteFrame,
) -> Result<AnchoredPosition, StandFault> {
    let Some(at) = zero.at else {
        let (north_rad, note) = turned_alone(zero, said_by, placement);
        let position = placement.position.unwrap_or_default();
        return Ok(AnchoredPosition { position, north_rad, is_where_said: false, note });
    };
    // without a height the origin is at the place's elevation
    let place_height = frame.local.elevation_m();
    let at = if zero.has_height { at } else { GeodeticPoint { height_m: place_height, ..at } };
    let there = frame.local.point(at);
    let away = there.map_or(f64::INFINITY, |there| there.truncate().length());
    let is_elsewhere = zero.on_map.is_none() && away > FAR_M;
    let Some(there) = there.filter(|_| !is_elsewhere).or(placement.position).or(is_elsewhere.then_some(DVec3::ZERO))
    else {
        return Err(too_far_anchor(said_by, at, away));
    };
    // a building that is moved keeps its true north, not the north at its anchor
    let moved_to = match placement.position {
        Some(position) => Some(frame.local.on_earth(position)),
        None => is_elsewhere.then(|| Some(frame.local.place())),
    };
    let meridian = frame.local.true_north_rad(moved_to.map_or(at, |moved_to| moved_to.unwrap_or(at)));
    let by_anchor = north_by_anchor(zero, moved_to.is_some(), meridian.unwrap_or_default(), frame);
    let north = placement.north_rad.or(by_anchor).unwrap_or_default();
    let position = placement.position.unwrap_or(there);
    let mut said = vec![stands_where(zero, said_by, placement.position, (at, there, away), is_elsewhere)];
    match (placement.north_rad, by_anchor) {
        (Some(north), Some(by_anchor)) if norths_apart(by_anchor, north).is_some() => {
            said.push(said_north(said_by, by_anchor, north));
        }
        (None, Some(by_anchor)) => {
            said.push(own_north(zero, by_anchor, meridian));
        }
        _ => {}
    }
    said.extend(no_elevation(there.z, placement, frame));
    said.retain(|text| !text.is_empty());
    let note = (!said.is_empty()).then(|| {
        message![
            said.join("; ");
            setting("[[model]]", "position", "`position`"),
            " and ",
            setting("[[model]]", "north", "`north` under [[model]]"),
            " change it"
        ]
    });
    let is_where_said = placement.position.is_none() && !is_elsewhere;
    Ok(AnchoredPosition { position, north_rad: north, is_where_said, note })
}

/// That an anchor lies where nothing of the site can stand.
fn too_far_anchor(said_by: &str, at: GeodeticPoint, away: f64) -> StandFault {
    let what = format!("by its {said_by} it stands at {}, {} from the place", degrees(at), length(away));
    let at_place = "[0.0, 0.0, 0.0]";
    let written = format!("`position = {at_place}` under [[model]]");
    StandFault::Key(
        "position",
        message![
            what;
            "write ",
            set_to("[[model]]", "position", at_place.to_owned(), written),
            " to put its zero at the place, or correct ",
            place_setting("latitude and longitude in [place]")
        ],
    )
}

/// A clause on where a model stands compared with its anchor; empty if both are the same.
fn stands_where(
    zero: &AnchoredZero,
    said_by: &str,
    position: Option<DVec3>,
    (at, there, away): (GeodeticPoint, DVec3, f64),
    is_elsewhere: bool,
) -> String {
    match (is_elsewhere, position) {
        (true, None) => {
            format!("stands at the place, though its {said_by} says {}, {} from there", degrees(at), length(away))
        }
        (_, Some(position)) if (position - there).length() <= ONE_PLACE_M => String::new(),
        (_, Some(position)) => format!(
            "stands where `position` says, {} from where its {said_by} says, {}",
            length(position.distance(there)),
            degrees(at)
        ),
        (false, None) => {
            let on_map = zero.on_map.as_ref().map(|(crs, _)| format!(" in {}", crs.name())).unwrap_or_default();
            let away = if away > ONE_PLACE_M { format!(", {} from the place", length(away)) } else { String::new() };
            format!("stands where its {said_by} says{on_map}{away}")
        }
    }
}

/// Radians clockwise from the model's north to the frame's by an anchor, with the meridian of where the model stands.
fn north_by_anchor(zero: &AnchoredZero, is_moved: bool, meridian: f64, frame: &SiteFrame) -> Option<f64> {
    match (zero.north?, &zero.on_map) {
        (AnchoredNorth::Map(north), Some((crs, on_map))) if !is_moved => {
            Some(north - frame.local.map_north_rad(crs, *on_map)?)
        }
        _ => Some(true_north(zero)? - meridian),
    }
}

/// A clause on the north by which it is turned, with the parts that are the map's convergence and the meridian's.
fn own_north(zero: &AnchoredZero, by_anchor: f64, meridian: Option<f64>) -> String {
    let convergence = zero.on_map.as_ref().and_then(|(crs, at)| crs.convergence_rad(at.x, at.y));
    let mut said = format!("its north is {}", angle(by_anchor));
    if let Some(convergence) = convergence {
        said.push_str(&format!(", with the map's convergence of {}", angle(convergence)));
    }
    if let Some(meridian) = meridian.filter(|meridian| meridian.abs() >= ONE_MERIDIAN_RAD) {
        said.push_str(&format!(", and {} between true north there and at the place", angle(meridian)));
    }
    said
}

/// The north of a model whose file gives no place.
fn turned_alone(zero: &AnchoredZero, said_by: &str, placement: &Placement) -> (f64, Option<Message>) {
    let by_anchor = true_north(zero).unwrap_or_default();
    let north = placement.north_rad.unwrap_or(by_anchor);
    let note = match placement.north_rad {
        Some(_) if norths_apart(by_anchor, north).is_some() => Some(message![said_north(said_by, by_anchor, north)]),
        None if norths_apart(0.0, by_anchor).is_some() => {
            let what = format!("is turned as its {said_by} says: north is {}", angle(by_anchor));
            Some(message![what; setting("[[model]]", "north", "`north` under [[model]]"), " changes it"])
        }
        _ => None,
    };
    (north, note)
}

fn said_north(said_by: &str, by_anchor: f64, north: f64) -> String {
    format!("north is {} by `north`, and {} by its {said_by}", angle(north), angle(by_anchor))
}

/// A clause if a model without a written position lies far above or below a place without a written elevation.
fn no_elevation(above_m: f64, placement: &Placement, frame: &SiteFrame) -> Option<String> {
    let is_written = placement.position.is_some() || frame.has_elevation;
    (!is_written && above_m.abs() > ONE_PLACE_M).then(|| {
        let side = if above_m > 0.0 { "above" } else { "below" };
        format!(
            "it lies {} {side} the place, whose elevation nobody has: an elevation of {:.0} m would put it at 0",
            length(above_m.abs()),
            frame.local.elevation_m() + above_m
        )
    })
}

/// A note on where a model in a map stands.
fn note_map(model: &Model, crs: &Crs, said_by: &str, placement: &Placement, frame: &SiteFrame) -> Option<Message> {
    let [low, high] = bounds(model, |corner| corner)?;
    let middle = (low + high) / 2.0;
    let away = middle.truncate().length();
    let mut said = format!("is in {}, as {} says", crs.name(), if said_by == "crs" { "`crs`" } else { "its file" });
    if away > FAR_M {
        said.push_str(&format!("; its middle is {} from the place", length(away)));
    }
    if let Some(clause) = no_elevation(low.z, placement, frame) {
        said.push_str(&format!("; {clause}"));
    }
    Some(message![said; setting("[[model]]", "crs", "`crs` under [[model]]"), " changes it"])
}

/// A place that a model's file proposes: a point, and its elevation if the file gives one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ProposedPoint {
    pub(super) at: GeodeticPoint,
    pub(super) has_elevation: bool,
}

/// Where a model stands on Earth, rounded for a site file: the origin of an anchored one, and the middle at the lowest
/// point for one in map coordinates.
pub(super) fn proposal(model: &Model, said: &Georeference) -> Option<ProposedPoint> {
    let rounded = |value: f64, digits: i32| (value * 10f64.powi(digits)).round() / 10f64.powi(digits);
    let (at, has_elevation, digits) = match &said.reference {
        Reference::Placement => return None,
        Reference::Anchor(zero) => (zero.at?, zero.has_height, 8),
        Reference::Map { crs, map_from_model, .. } => {
            // heights above the ground say nothing about the sea
            (middle(model, crs, *map_from_model)?, !model.stands_on_ground(), 6)
        }
    };
    let at = GeodeticPoint {
        latitude_deg: rounded(at.latitude_deg, digits),
        longitude_deg: rounded(at.longitude_deg, digits),
        height_m: rounded(at.height_m, 2),
    };
    // an impossible elevation is not proposed
    let has_elevation = has_elevation && (-500.0..=9000.0).contains(&at.height_m);
    Some(ProposedPoint { at, has_elevation })
}

/// The middle of a model's box in its map's units, at its lowest height.
pub(super) fn map_middle(model: &Model, crs: &Crs, map_from_model: DAffine3) -> Option<DVec3> {
    let of_map = |corner: DVec3| map_from_model.transform_point3(corner);
    let [mut low, mut high] = bounds(model, of_map)?;
    // a box across the meridian of 180° is not as wide as the Earth
    if crs.kind() == CrsKind::Geographic && high.x - low.x > 180.0 {
        let eastward = |corner: DVec3| of_map(corner).with_x(of_map(corner).x.rem_euclid(360.0));
        let [west, east] = bounds(model, eastward)?;
        if east.x - west.x < high.x - low.x {
            [low, high] = [west, east];
        }
    }
    Some(((low + high) / 2.0).with_z(low.z))
}

fn middle(model: &Model, crs: &Crs, map_from_model: DAffine3) -> Option<GeodeticPoint> {
    let of_map = |corner: DVec3| map_from_model.transform_point3(corner);
    if crs.kind() == CrsKind::EarthCentred {
        let [low, high] = bounds(model, of_map)?;
        let at = crs.to_wgs84((low + high) / 2.0)?;
        // only the lowest height counts
        let height = |corner: DVec3| DVec3::splat(crs.to_wgs84(of_map(corner)).map_or(f64::INFINITY, |at| at.height_m));
        let [lowest, _] = bounds(model, height)?;
        return Some(GeodeticPoint { height_m: lowest.z.floor(), ..at });
    }
    let at = map_middle(model, crs, map_from_model)?;
    // heights above the ground say nothing about the sea
    let of_sea = model.parts.iter().enumerate().filter(|(part, _)| !model.is_from_ground(*part));
    let heights = of_sea.flat_map(|(_, part)| &part.positions).map(|corner| of_map(*corner).z);
    let lowest = if model.from_ground.is_empty() { None } else { heights.reduce(f64::min) };
    Some(GeodeticPoint { height_m: lowest.unwrap_or(at.z).floor(), ..crs.to_wgs84(at)? })
}
