//! Where an IFC file says that the origin of its coordinates lies, and which way north is.
//!
//! The angle [`Anchor::north_rad`] is clockwise, seen from above, from the file's +y to north. For `TrueNorth` (x, y),
//! a direction in the file's axes, it is atan2(x, y). For `IfcMapConversion` it is atan2(XAxisOrdinate, XAxisAbscissa):
//! the file's +x is turned by that angle anticlockwise from the map's east, so the map's north is turned by the same
//! angle clockwise from the file's +y.

use super::super::{Anchor, AnchorPoint};
use super::scan::IfcScan;
use crate::message::{Message, message, setting};
use ifc_lite_core::{
    CoordinateOperationKind, EntityDecoder, GeoRefExtractor, GeoRefSource, GeoReference, GeoReferenceDetails, IfcType,
};

/// Beyond this distance from the file's origin, its site's place says nothing about that origin: the coordinates are a
/// map's.
const FARTHEST_SITE_M: f64 = 20_000.0;

/// WGS 84: the equatorial radius, and the squared eccentricity.
const EQUATOR_M: f64 = 6_378_137.0;
const ECCENTRICITY2: f64 = 0.006_694_379_990_14;

/// The least distance of a map's contents from its origin, metres; the greatest is a quarter of the Earth.
const BESIDE_ZERO_M: f64 = 100_000.0;
const LARGEST_MAP_M: f64 = 1.1e7;

/// The tolerance within which two factors are equal.
const SAME: f64 = 0.01;

/// What a file says about its place.
#[derive(Default)]
pub(super) struct IfcPlaces {
    pub anchors: Vec<Anchor>,
    /// The assumed unit of a map's point, metres, if the file does not give it.
    pub assumed_map_unit_m: Option<f64>,
    pub notes: Vec<Message>,
}

/// What the reader found about units and the first site's placement.
pub(super) struct IfcFrame {
    /// The length of a unit of the file, metres.
    pub unit_m: f64,
    /// The position of the site's own origin along the file's axes, metres.
    pub site: Option<[f64; 3]>,
}

/// The anchors of a file, the most exact first.
pub(super) fn of(scan: &IfcScan, frame: &IfcFrame, decoder: &mut EntityDecoder) -> IfcPlaces {
    let mut places = IfcPlaces::default();
    if let Ok(Some((map, details))) = GeoRefExtractor::extract_with_details(decoder, &scan.georeference) {
        places.on_map(&map, &details, frame.unit_m);
        places.no_direction(scan, decoder);
    }
    let true_north = places.true_north(scan, decoder);
    places.of_site(scan, frame, true_north, decoder);
    if let Some(north) = true_north
        && !places.anchors.iter().any(|anchor| anchor.said_by == "IfcSite")
    {
        places.anchors.push(Anchor { said_by: "TrueNorth", at: AnchorPoint::Nowhere, north_rad: Some(north) });
    }
    places
}

impl IfcPlaces {
    /// Adds the anchor of a map conversion, or of one of its subtypes.
    fn on_map(&mut self, map: &GeoReference, details: &GeoReferenceDetails, unit_m: f64) {
        let said_by = match (details.operation, map.source) {
            (Some(CoordinateOperationKind::RigidOperation), _) => "IfcRigidOperation",
            (_, Some(GeoRefSource::MapConversion)) => "IfcMapConversion",
            (_, Some(GeoRefSource::EPSetMapConversion)) => "ePSet_MapConversion",
            _ => {
                self.notes.push(message!["names a map in IfcProjectedCRS, but does not say where on that map it lies"]);
                return;
            }
        };
        if said_by == "IfcRigidOperation" && map.map_unit.as_deref() == Some("DEGREE") {
            let (latitude_deg, longitude_deg) = (map.northings, map.eastings);
            let at = AnchorPoint::Geographic { latitude_deg, longitude_deg, elevation_m: Some(map.orthogonal_height) };
            self.anchors.push(Anchor { said_by, at, north_rad: Some(0.0) });
            return;
        }
        let map_unit_m = map.map_unit_scale.unwrap_or_else(|| {
            let assumed_m = self.unsaid_map_unit_m(map, said_by, unit_m);
            self.assumed_map_unit_m = Some(assumed_m);
            assumed_m
        });
        let crs = map.crs_name.clone().map(|name| name.trim().to_owned()).filter(|name| !name.is_empty());
        let at = AnchorPoint::Map {
            crs: crs.or_else(|| details.well_known_text.clone()).unwrap_or_default(),
            easting: map.eastings * map_unit_m,
            northing: map.northings * map_unit_m,
            height: Some(map.orthogonal_height * map_unit_m),
            scale: self.scale(map, said_by, map_unit_m, unit_m),
        };
        self.anchors.push(Anchor { said_by, at, north_rad: Some(map.rotation()) });
    }

    /// Notes that a map conversion has an axis without a direction, and that the map's east is assumed.
    fn no_direction(&mut self, scan: &IfcScan, decoder: &mut EntityDecoder) {
        let conversions = scan.georeference.iter().filter(|(_, kind)| *kind == IfcType::IfcMapConversion);
        for &(id, _) in conversions {
            let Ok(conversion) = decoder.decode_by_id(id) else { continue };
            let axis = conversion.get_float(5).zip(conversion.get_float(6));
            if axis.is_some_and(|(x, y)| x.hypot(y) < 1e-9) {
                self.notes.push(message![
                    "says by its IfcMapConversion an XAxis of (0, 0), which is not a direction: it is taken as not turned against its map";
                    setting("[[model]]", "north", "`north` under [[model]]"), " turns it"
                ]);
                return;
            }
        }
    }

    /// The unit of a map's point if the file does not give it, metres: the project's, as IFC defines. It is the metre
    /// if the numbers fit a map in metres, but would lie near its origin in the project's unit. Many programs write
    /// this.
    fn unsaid_map_unit_m(&mut self, map: &GeoReference, said_by: &str, unit_m: f64) -> f64 {
        let is_named = map.crs_name.as_deref().is_some_and(|name| !name.trim().is_empty());
        let as_metres = map.eastings.hypot(map.northings);
        let is_of_map = BESIDE_ZERO_M < as_metres && as_metres < LARGEST_MAP_M;
        if !(is_named && is_of_map && as_metres * unit_m < BESIDE_ZERO_M) {
            return unit_m;
        }
        self.notes.push(message![
            format!(
                "says by its {said_by} {}, {} without the map's unit (MapUnit): in its own unit of {unit_m} m that is near the \
                 map's origin, so it is taken in metres",
                map.eastings, map.northings
            );
            setting("[[model]]", "position", "`position` under [[model]]"), " overrides it"
        ]);
        1.0
    }

    /// The metres on the map for a unit of the file. Scale also converts units, from the file's to the map's.
    fn scale(&mut self, map: &GeoReference, said_by: &str, map_unit_m: f64, unit_m: f64) -> f64 {
        let factors = [map.factor_x, map.factor_y, map.factor_z];
        if factors.iter().any(|factor| (factor - map.factor_x).abs() > 1e-9) {
            let said = format!("{} along x, {} along y and {} along z", factors[0], factors[1], factors[2]);
            self.notes.push(message![format!("has different scales along its axes ({said}); the one along x is used")]);
        }
        if said_by == "IfcRigidOperation" {
            return unit_m;
        }
        let written = map.scale * map.factor_x;
        let is_forgotten = (written - 1.0).abs() < SAME && (map_unit_m / unit_m - 1.0).abs() > SAME;
        if is_forgotten {
            self.notes.push(message![format!(
                "is in units of {unit_m} m on a map in units of {map_unit_m} m, and {said_by} has a Scale of {written}; \
                 the Scale is taken not to convert units"
            )]);
            return written * unit_m;
        }
        written * map_unit_m
    }

    /// The direction of true north in the context of the model, otherwise in that of a plan.
    fn true_north(&mut self, scan: &IfcScan, decoder: &mut EntityDecoder) -> Option<f64> {
        let mut said: Vec<(bool, f64)> = Vec::new();
        for &id in &scan.contexts {
            let Ok(context) = decoder.decode_by_id(id) else { continue };
            let Some(direction) = context.get_ref(5).and_then(|id| decoder.decode_by_id(id).ok()) else { continue };
            let ratio = |at: usize| direction.get_list(0)?.get(at)?.as_float();
            let (Some(x), Some(y)) = (ratio(0), ratio(1)) else { continue };
            let length = x.hypot(y);
            if length.is_finite() && length > 1e-9 {
                let is_model = context.get_string(1).is_some_and(|kind| kind.eq_ignore_ascii_case("Model"));
                said.push((is_model, x.atan2(y)));
            }
        }
        let &(_, north) = said.iter().find(|(is_model, _)| *is_model).or(said.first())?;
        if let Some((_, other)) = said.iter().find(|(_, other)| (other - north).abs() > 1e-3) {
            let (north, other) = (north.to_degrees(), other.to_degrees());
            self.notes.push(message![format!("says TrueNorth twice, {north:.3}° and {other:.3}°; the first is used")]);
        }
        Some(north)
    }

    /// Adds the anchor of the first site with a latitude and a longitude.
    fn of_site(&mut self, scan: &IfcScan, frame: &IfcFrame, north: Option<f64>, decoder: &mut EntityDecoder) {
        let found = scan.sites.iter().find_map(|&id| {
            let place = GeoRefExtractor::extract(decoder, &[(id, IfcType::IfcSite)]).ok()??;
            let elevation = decoder.decode_by_id(id).ok()?.get_float(11);
            (place.source == Some(GeoRefSource::SiteLocation)).then_some((id, place, elevation))
        });
        let Some((id, place, elevation)) = found else { return };
        let (latitude, longitude) = (place.northings, place.eastings);
        if !(latitude.abs() < 90.0 && longitude.abs() <= 180.0) {
            self.notes.push(message![format!("has an IfcSite at {latitude}°, {longitude}°, which is not a place")]);
            return;
        }
        // the latitude and longitude are of the site's own origin
        let site = if scan.sites.first() == Some(&id) { frame.site } else { None };
        let [x, y, z] = site.unwrap_or_default();
        if x.hypot(y) > FARTHEST_SITE_M {
            self.notes.push(message![
                format!("has its IfcSite {:.0} km from its own zero, so its coordinates are those of a map that it does \
                         not name", x.hypot(y) / 1000.0);
                "say which one with ", setting("[[model]]", "crs", "`crs` under [[model]]")
            ]);
            return;
        }
        let (sin, cos) = north.unwrap_or(0.0).sin_cos();
        let (east, northward) = (x * cos - y * sin, x * sin + y * cos);
        let (latitude_deg, longitude_deg) = moved(latitude, longitude, -east, -northward);
        let elevation_m = elevation.filter(|said| said.is_finite()).map(|said| said * frame.unit_m - z);
        let at = AnchorPoint::Geographic { latitude_deg, longitude_deg, elevation_m };
        self.anchors.push(Anchor { said_by: "IfcSite", at, north_rad: north });
    }
}

/// The place some metres east and north of another one, exact to millimetres over a few kilometres.
fn moved(latitude_deg: f64, longitude_deg: f64, east_m: f64, north_m: f64) -> (f64, f64) {
    let (sin, cos) = latitude_deg.to_radians().sin_cos();
    let bent = 1.0 - ECCENTRICITY2 * sin * sin;
    let (across, along) = (EQUATOR_M / bent.sqrt(), EQUATOR_M * (1.0 - ECCENTRICITY2) / bent.powf(1.5));
    let longitude = longitude_deg + (east_m / (across * cos)).to_degrees();
    (latitude_deg + (north_m / along).to_degrees(), longitude)
}
