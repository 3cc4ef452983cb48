//! Where on Earth a model stands, by its own file and the site file.
//!
//! A model stands by its coordinates, if they belong to a map, and otherwise by the first of its anchors that can be
//! used. What the user wrote has priority over both.

use super::anchored_zero::{AnchoredNorth, AnchoredZero, true_north};
use super::model_bounds::bounds;
use super::place_doubts;
use super::placement::Placement;
use crate::crs::{Crs, CrsKind, GeodeticPoint};
use crate::formats::{Anchor, AnchorPoint, Coordinates, Model};
use crate::message::{Message, message, setting};
use glam::{DAffine3, DMat3, DVec2, DVec3};

/// A model farther than this from its origin is brought into the site's frame corner by corner, metres: the map's scale
/// error, a few parts in 10,000, would otherwise move it by metres.
const FAR_FROM_ZERO_M: f64 = 5_000.0;

/// Units whose ratio differs from 1 by less than this are the same. Files say "foot" for both kinds of foot.
const ONE_UNIT: f64 = 1e-5;

/// Metres per degree of latitude.
const DEGREE_M: f64 = 111_195.0;

/// Where a model stands, and what says so.
#[derive(Clone, Debug)]
pub(super) struct Georeference {
    pub(super) reference: Reference,
    /// The source in the file's own term, such as `IfcMapConversion`; or `crs` if the user gave it; empty without a
    /// source.
    pub(super) said_by: String,
    /// Notes for the user, each with the file as its subject.
    pub(super) notes: Vec<Message>,
}

/// What determines where a model stands.
#[derive(Clone, Debug)]
pub(super) enum Reference {
    /// Only the site file.
    Placement,
    /// The file's coordinates, which are converted to a map's.
    Map {
        crs: Box<Crs>,
        /// From the file's coordinates to the map's units horizontally, and to metres vertically.
        map_from_model: DAffine3,
        /// The length of one of the file's units, metres, for short lengths such as a step.
        unit_m: f64,
    },
    /// A point of the Earth for the model's origin.
    Anchor(Box<AnchoredZero>),
}

/// Why a model cannot stand where its file or the user says.
pub(super) enum StandFault {
    /// The value of one of the model's keys.
    Key(&'static str, Message),
    /// The contents of its file; the message's subject is the file.
    File(Message),
}

impl StandFault {
    /// A fault in the reference system of a model's coordinates: in the key if the user gave it, otherwise in the file.
    pub(super) fn of_crs(placement: &Placement, message: Message) -> StandFault {
        match placement.crs {
            Some(_) => StandFault::Key("crs", message),
            None => StandFault::File(message),
        }
    }

    /// The message, whatever is at fault.
    pub(super) fn into_message(self) -> Message {
        match self {
            StandFault::Key(_, message) | StandFault::File(message) => message,
        }
    }
}

impl Georeference {
    /// What file and user say about where a model stands.
    ///
    /// # Errors
    /// An unknown system, if the model's coordinates are in it, or keys that contradict each other.
    pub(super) fn of(model: &Model, placement: &Placement) -> Result<Georeference, StandFault> {
        let asked = placement.crs.as_deref().map(Crs::read).transpose();
        let asked = asked.map_err(|error| StandFault::Key("crs", error))?;
        let has_map_anchor = model.anchors.iter().any(|anchor| matches!(anchor.at, AnchorPoint::Map { .. }));
        match (&model.coordinates, asked) {
            (Coordinates::Map(_), Some(crs)) => of_coordinates(model, placement, crs, "crs"),
            (Coordinates::Map(text), None) => of_file(model, placement, text),
            (Coordinates::Local, Some(crs)) if !has_map_anchor => of_coordinates(model, placement, crs, "crs"),
            (Coordinates::Local, asked) => Ok(of_anchors(model, placement, asked.as_ref())),
        }
    }

    /// No statement at all.
    pub(super) fn none() -> Georeference {
        Georeference { reference: Reference::Placement, said_by: String::new(), notes: Vec::new() }
    }
}

/// Coordinates in a map that the file names. If the user places the model, they are taken as plain metres.
fn of_file(model: &Model, placement: &Placement, text: &str) -> Result<Georeference, StandFault> {
    let named = Crs::read(text);
    let written = placement.position.map(|_| "position").or(placement.north_rad.map(|_| "north"));
    match (named, written) {
        (Ok(crs), None) => of_coordinates(model, placement, crs, "coordinates"),
        (Err(error), None) => {
            let mut fault = message![
                "names a reference system that cannot be taken: ";
                "write ",
                setting("[[model]]", "crs", "`crs` under [[model]]"),
                ", which goes before it, for example crs = \"EPSG:25832\""
            ];
            fault.what.extend(error.what);
            Err(StandFault::File(fault))
        }
        (Ok(crs), Some(key)) if crs.kind() != CrsKind::Projected => Err(StandFault::Key(
            key,
            message![
                format!("the file's coordinates are of {}, which are not metres and cannot be moved or turned", crs.name());
                "leave it out, or write ", setting("[[model]]", "crs", "`crs`"), " and ", setting("[[model]]", "position", "`position`"), " together: the model is then moved from where it stands"
            ],
        )),
        (named, Some(key)) => {
            let name = named.map_or_else(|_| text.to_owned(), |crs| crs.name().to_owned());
            let what =
                format!("is of {name}, but stands as `{key}` under [[model]] says, its coordinates taken as metres");
            let notes = vec![message![what; "leave that out to place it by its coordinates"]];
            Ok(Georeference { notes, ..Georeference::none() })
        }
    }
}

/// Coordinates in a map, named by the user or the file.
fn of_coordinates(model: &Model, placement: &Placement, crs: Crs, said_by: &str) -> Result<Georeference, StandFault> {
    if placement.north_rad.is_some() {
        let what = format!("{} says which way north is", crs.name());
        return Err(StandFault::Key(
            "north",
            message![
                what;
                "leave out ",
                setting("[[model]]", "north", "`north`"),
                " or ",
                setting("[[model]]", "crs", "`crs` under [[model]]")
            ],
        ));
    }
    let mut notes = Vec::new();
    if let (Coordinates::Map(text), Some(_)) = (&model.coordinates, &placement.crs) {
        let of_file = Crs::read(text).map_or_else(|_| text.clone(), |crs| crs.name().to_owned());
        if of_file != crs.name() {
            notes.push(message![
                format!("says that its coordinates are in {of_file}; "),
                setting("[[model]]", "crs", "`crs` under [[model]]"),
                format!(" says {}", crs.name())
            ]);
        }
    }
    notes.extend(crs.doubt().map(|doubt| message![format!("is of {}: {doubt}", crs.name())]));
    if crs.kind() == CrsKind::EarthCentred {
        notes.push(message![
            "has Earth-centred coordinates, whose heights are above the ellipsoid: those above the sea are up to 100 m \
             lower or higher";
            "to move it up or down beside models of other kinds, write ", setting("[[model]]", "crs", "`crs`"), " with ", setting("[[model]]", "position", "`position` under [[model]]")
        ]);
    }
    let [ground, height] = map_units(model, placement, &crs);
    let scale = DMat3::from_diagonal(DVec3::new(ground, ground, height));
    let map_from_model = DAffine3::from_mat3(scale * placement.upright(model));
    let unit_m = if crs.kind() == CrsKind::Geographic { DEGREE_M } else { ground * crs.unit_m() };
    notes.extend(unit_note(model, placement, &crs, height));
    let reference = Reference::Map { crs: Box::new(crs), map_from_model, unit_m };
    notes.extend(outside_of_map(model, &reference, None));
    Ok(Georeference { reference, said_by: said_by.to_owned(), notes })
}

/// A note if the model's middle lies far outside of its map.
fn outside_of_map(model: &Model, reference: &Reference, said_by: Option<&str>) -> Option<Message> {
    let Reference::Map { crs, map_from_model, .. } = reference else { return None };
    let [low, high] = bounds(model, |corner| map_from_model.transform_point3(corner))?;
    place_doubts::outside(crs, (low + high) / 2.0, said_by)
}

/// The factors from the file's numbers to the system's units horizontally, and to metres vertically.
///
/// If the file itself says that its coordinates are in a map, horizontal ones are in the map's units; heights are in
/// the file's unit, otherwise in the system's unit for heights, otherwise in metres. A drawing's coordinates, heights
/// included, are in its own unit, otherwise in the system's.
fn map_units(model: &Model, placement: &Placement, crs: &Crs) -> [f64; 2] {
    let of_file = matches!(model.coordinates, Coordinates::Map(_)) && placement.scale.is_none();
    let said = placement.scale.or(model.unit_m);
    let ratio = |unit: f64| {
        let ratio = unit / crs.unit_m();
        if (ratio - 1.0).abs() < ONE_UNIT { 1.0 } else { ratio }
    };
    match crs.kind() {
        CrsKind::EarthCentred if of_file => [1.0; 2],
        CrsKind::EarthCentred => [said.map_or(1.0, ratio); 2],
        CrsKind::Geographic => [1.0, said.or(crs.height_unit_m()).unwrap_or(1.0)],
        CrsKind::Projected if of_file => [1.0, said.or(crs.height_unit_m()).unwrap_or(1.0)],
        CrsKind::Projected => {
            let height = said.or(crs.height_unit_m()).unwrap_or_else(|| crs.unit_m());
            [said.map_or(1.0, ratio), height]
        }
    }
}

/// A note if eastings and northings are not in the unit of the heights, or are assumed to be in the map's because no
/// unit is given.
fn unit_note(model: &Model, placement: &Placement, crs: &Crs, height_m: f64) -> Option<Message> {
    // to ten digits, which distinguish the two kinds of foot
    let [map_m, height_m] = [crs.unit_m(), height_m].map(|unit_m| (unit_m * 1e10).round() / 1e10);
    if crs.kind() != CrsKind::Projected {
        return None;
    }
    let is_other = |unit_m: f64| (unit_m / map_m - 1.0).abs() > ONE_UNIT;
    let scale = || setting("[[model]]", "scale", "`scale` under [[model]]");
    if placement.scale.is_none() && matches!(model.coordinates, Coordinates::Map(_)) {
        let what =
            format!("has heights in units of {height_m} m, and eastings and northings in those of its map, {map_m} m");
        return is_other(height_m)
            .then(|| message![what; "if all are in one unit, write its length in metres as ", scale()]);
    }
    let is_said = placement.scale.or(model.unit_m).is_some();
    (!is_said && (map_m - 1.0).abs() > ONE_UNIT).then(|| {
        message![
            format!("does not give its unit, which is assumed to be that of its map, {map_m} m");
            "if that is wrong, write the unit's length in metres as ", scale()
        ]
    })
}

/// The first anchor that can be used, with notes on what the others say differently.
fn of_anchors(model: &Model, placement: &Placement, asked: Option<&Crs>) -> Georeference {
    let mut notes = Vec::new();
    let farthest_m = farthest_m(model, placement);
    let (read, unplaced) = read_anchors(model, asked, farthest_m, &mut notes);
    // for a model far from its origin, the origin is only a number in the map
    let outside = |(anchor, zero): &(&Anchor, AnchoredZero)| {
        let (crs, at) = zero.on_map.as_ref().filter(|_| farthest_m <= FAR_FROM_ZERO_M)?;
        place_doubts::outside(crs, *at, Some(anchor.said_by))
    };
    notes.extend(read.iter().filter_map(outside));
    // one anchor may give the position and another the north; a point outside of its map comes last
    let is_there = |(_, zero): &(&Anchor, AnchoredZero)| zero.at.is_some();
    let sure = read.iter().position(|said| is_there(said) && outside(said).is_none());
    let best = sure.or_else(|| read.iter().position(is_there)).unwrap_or(0);
    let north = read.iter().find_map(|(_, zero)| true_north(zero)).map(AnchoredNorth::True);
    let Some((anchor, mut zero)) = read.get(best).cloned().or_else(|| map_north(model, &mut notes)) else {
        return Georeference { notes, ..Georeference::none() };
    };
    // an angle to the north of an unknown map is better than none
    if zero.north.is_none() && north.is_none() && zero.on_map.is_none() {
        zero.north = map_north(model, &mut notes).and_then(|(_, of_map)| of_map.north);
    }
    // IFC's default is the map's own north
    zero.north = zero.north.or(north).or(zero.on_map.as_ref().map(|_| AnchoredNorth::Map(0.0)));
    notes.extend(
        read.iter()
            .enumerate()
            .filter(|(index, _)| *index != best)
            .filter_map(|(_, (other, said))| place_doubts::apart(anchor.said_by, &zero, other.said_by, said)),
    );
    notes.extend(
        zero.on_map
            .as_ref()
            .and_then(|(crs, _)| crs.doubt().map(|doubt| message![format!("is placed in {}: {doubt}", crs.name())])),
    );
    notes.extend(unplaced.iter().filter_map(|other| place_doubts::turned_apart(anchor.said_by, &zero, other)));
    notes.extend(scale_doubt(anchor, placement.unit_m(model)));
    // the file's numbers, in the map that the user names
    let is_on_asked = asked.is_some() && zero.on_map.is_some();
    let said_by = if is_on_asked { format!("{} with `crs`", anchor.said_by) } else { anchor.said_by.to_owned() };
    if farthest_m > FAR_FROM_ZERO_M
        && let Some(reference) = beyond(model, placement, anchor, &zero)
    {
        notes.extend(outside_of_map(model, &reference, Some(&said_by)));
        return Georeference { reference, said_by, notes };
    }
    Georeference { reference: Reference::Anchor(Box::new(zero)), said_by, notes }
}

/// The anchors that can be used, and notes on those that cannot.
fn read_anchors<'a>(
    model: &'a Model,
    asked: Option<&Crs>,
    farthest_m: f64,
    notes: &mut Vec<Message>,
) -> (Vec<(&'a Anchor, AnchoredZero)>, Vec<&'a Anchor>) {
    let (mut read, mut unplaced) = (Vec::new(), Vec::new());
    for anchor in &model.anchors {
        notes.extend(asked.and_then(|asked| place_doubts::other_map(anchor, asked)));
        match zero(anchor, asked, farthest_m) {
            Ok(zero) => {
                notes.extend(place_doubts::of(zero.at, anchor.said_by));
                notes.extend(unit_doubt(model, anchor, &zero));
                read.push((anchor, zero));
            }
            Err(doubt) => {
                notes.push(doubt);
                unplaced.push(anchor);
            }
        }
    }
    (read, unplaced)
}

/// The model's origin by an anchor, or a note on why it cannot be used.
fn zero(anchor: &Anchor, asked: Option<&Crs>, farthest_m: f64) -> Result<AnchoredZero, Message> {
    let said_by = anchor.said_by;
    match &anchor.at {
        AnchorPoint::Nowhere => Ok(AnchoredZero {
            at: None,
            has_height: false,
            on_map: None,
            north: anchor.north_rad.map(AnchoredNorth::True),
        }),
        AnchorPoint::Geographic { latitude_deg, longitude_deg, elevation_m } => {
            if *latitude_deg == 0.0 && *longitude_deg == 0.0 {
                return Err(place_doubts::zero(said_by));
            }
            let is_point = latitude_deg.abs() <= 90.0 && longitude_deg.abs() <= 360.0;
            if !is_point {
                let what = format!(
                    "says by its {said_by} that it stands at {latitude_deg}, {longitude_deg}, which is not a place"
                );
                return Err(message![what]);
            }
            let height_m = elevation_m.filter(|height| height.is_finite());
            let at = GeodeticPoint {
                latitude_deg: *latitude_deg,
                longitude_deg: *longitude_deg,
                height_m: height_m.unwrap_or_default(),
            };
            let north = anchor.north_rad.map(AnchoredNorth::True);
            Ok(AnchoredZero { at: Some(at), has_height: height_m.is_some(), on_map: None, north })
        }
        AnchorPoint::Map { crs, easting, northing, height, .. } => {
            let named = crs_of_anchor(crs, asked, said_by)?;
            zero_on_map(anchor, named, DVec3::new(*easting, *northing, 0.0), *height, farthest_m)
        }
    }
}

/// A note if an anchor does not give the unit of its point, and its map has a different unit from the assumed one.
fn unit_doubt(model: &Model, anchor: &Anchor, zero: &AnchoredZero) -> Option<Message> {
    let (assumed_m, (crs, at)) = model.assumed_map_unit_m.zip(zero.on_map.as_ref())?;
    let written = at.truncate() * crs.unit_m() / assumed_m;
    let is_one = crs.kind() != CrsKind::Projected || (assumed_m / crs.unit_m() - 1.0).abs() <= ONE_UNIT;
    (!is_one).then(|| {
        let what = format!(
            "says by its {} {:.0}, {:.0} without the map's unit (MapUnit), which is taken to be {assumed_m} m; that of {} is \
             {:.7} m",
            anchor.said_by,
            written.x,
            written.y,
            crs.name(),
            crs.unit_m()
        );
        message![
            what;
            "say MapUnit in the file, or write ", setting("[[model]]", "position", "`position` under [[model]]"),
            " if it stands elsewhere"
        ]
    })
}

/// The reference system of an anchor in a map: the user's, otherwise the file's.
fn crs_of_anchor(text: &str, asked: Option<&Crs>, said_by: &str) -> Result<Crs, Message> {
    match asked {
        Some(asked) => Ok(asked.clone()),
        None if text.trim().is_empty() => {
            let what = format!("says by its {said_by} where on a map it stands, but not on which map");
            Err(message![
                what;
                "write ",
                setting("[[model]]", "crs", "`crs` under [[model]]"),
                ", for example crs = \"EPSG:25832\""
            ])
        }
        None => Crs::read(text).map_err(|error| {
            let what = format!("says by its {said_by} where it stands, but {error}");
            message![what; "or write ", setting("[[model]]", "crs", "`crs` under [[model]]")]
        }),
    }
}

/// The model's origin by an anchor in a map: easting and northing in metres, also for maps in feet.
fn zero_on_map(
    anchor: &Anchor,
    crs: Crs,
    metres: DVec3,
    height: Option<f64>,
    farthest_m: f64,
) -> Result<AnchoredZero, Message> {
    let said_by = anchor.said_by;
    if metres == DVec3::ZERO && farthest_m < FAR_FROM_ZERO_M {
        return Err(place_doubts::zero(said_by));
    }
    let height_m = height.filter(|height| height.is_finite());
    let on_map = (metres / crs.unit_m()).with_z(height_m.unwrap_or_default());
    let at = crs.to_wgs84(on_map).ok_or_else(|| {
        let what = format!(
            "says by its {said_by} that it stands at {}, {} in {}, which does not reach there",
            metres.x,
            metres.y,
            crs.name()
        );
        message![
            what;
            "write ",
            setting("[[model]]", "crs", "`crs`"),
            " or ",
            setting("[[model]]", "position", "`position` under [[model]]")
        ]
    })?;
    let north = anchor.north_rad.map(AnchoredNorth::Map);
    Ok(AnchoredZero { at: Some(at), has_height: height_m.is_some(), on_map: Some((crs, on_map)), north })
}

/// The north of an unknown map, if nothing else gives a north. It is off by the map's convergence, as a note says.
fn map_north<'a>(model: &'a Model, notes: &mut Vec<Message>) -> Option<(&'a Anchor, AnchoredZero)> {
    let (anchor, north) = model.anchors.iter().find_map(|anchor| Some((anchor, anchor.north_rad?)))?;
    let what = format!(
        "says by its {} which way the north of a map is, and that is taken as true north: with most maps the error is up to 2°",
        anchor.said_by
    );
    notes.push(message![
        what;
        "write ",
        setting("[[model]]", "crs", "`crs`"),
        " or ",
        setting("[[model]]", "north", "`north` under [[model]]")
    ]);
    let north = Some(AnchoredNorth::True(north));
    Some((anchor, AnchoredZero { at: None, has_height: false, on_map: None, north }))
}

/// For a model far from its origin with an anchor in a map: takes its coordinates as the map's, with the file's own
/// scale, changed as the user's `scale` changes the unit. `None` if the user places the model.
fn beyond(model: &Model, placement: &Placement, anchor: &Anchor, zero: &AnchoredZero) -> Option<Reference> {
    let (AnchorPoint::Map { scale, .. }, Some((crs, at))) = (&anchor.at, &zero.on_map) else { return None };
    let Some(AnchoredNorth::Map(north)) = zero.north else { return None };
    let is_free = placement.north_rad.is_none() && placement.position.is_none();
    if !is_free || !scale.is_finite() || *scale <= 0.0 {
        return None;
    }
    let unit_m = placement.unit_m(model);
    let scale = scale * placement.scale.map_or(1.0, |said| said / model.unit_m.unwrap_or(1.0));
    let along = DMat3::from_diagonal(DVec3::new(scale / crs.unit_m(), scale / crs.unit_m(), unit_m));
    let turned = DMat3::from_rotation_z(north) * along * placement.upright(model);
    let map_from_model = DAffine3::from_mat3_translation(turned, *at);
    Some(Reference::Map { crs: Box::new(crs.clone()), map_from_model, unit_m })
}

/// The horizontal distance from the origin to the middle of the model's box, metres.
fn farthest_m(model: &Model, placement: &Placement) -> f64 {
    let upright = placement.upright(model) * placement.unit_m(model);
    let Some([low, high]) = bounds(model, |corner| corner) else { return 0.0 };
    let middle: DVec2 = (upright * ((low + high) / 2.0)).truncate();
    if middle.is_finite() { middle.length() } else { 0.0 }
}

/// A note on an implausible map scale, which says how long a metre of the file is in the map. The model always keeps
/// its own size in the file's unit: the usual difference of a few parts in 10,000 is the map's distortion.
fn scale_doubt(anchor: &Anchor, unit_m: f64) -> Option<Message> {
    const DISTORTION: f64 = 0.005;
    let AnchorPoint::Map { scale, .. } = anchor.at else { return None };
    let is_near = (scale / unit_m - 1.0).abs() <= DISTORTION;
    (!is_near).then(|| {
        message![
            format!(
                "says by its {} that a unit of it is {scale} m on the map, and it is taken as {unit_m} m",
                anchor.said_by
            );
            "write ", setting("[[model]]", "scale", "`scale` under [[model]]"), " if that is wrong"
        ]
    })
}
