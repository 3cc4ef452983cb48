//! A place on Earth: checked coordinates and a time zone.

use super::{SunError, Zone, ZoneRules, meant};
use std::sync::OnceLock;

/// A point on the Earth with its time zone.
///
/// Latitude and longitude stay in degrees, as people write them and as SPA expects them.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// Its name; empty if it has none.
    pub name: String,
    /// Degrees, north positive.
    pub latitude_deg: f64,
    /// Degrees, east positive.
    pub longitude_deg: f64,
    /// Metres above sea level.
    pub elevation_m: f64,
    /// The zone whose clock is used.
    pub time_zone: Zone,
}

impl Place {
    /// A checked place: latitude −90 to 90° and longitude −180 to 180°, elevation −500 to 9000 m.
    ///
    /// `time_zone` is an IANA name; without one it is found from the coordinates.
    ///
    /// # Errors
    /// A number out of its range (or NaN), an unknown zone, or no zone at the coordinates.
    pub fn new(
        name: &str,
        latitude_deg: f64,
        longitude_deg: f64,
        elevation_m: f64,
        time_zone: Option<&str>,
    ) -> Result<Place, SunError> {
        within("latitude", latitude_deg, -90.0, 90.0, "degrees")?;
        within("longitude", longitude_deg, -180.0, 180.0, "degrees")?;
        within("elevation", elevation_m, -500.0, 9000.0, "metres")?;
        let time_zone = match time_zone {
            Some(name) => ZoneRules::newest().zone(name).ok_or_else(|| SunError::UnknownZone {
                name: name.to_owned(),
                hint: meant::way_out(name, zone_at(latitude_deg, longitude_deg).ok()),
            })?,
            None => zone_at(latitude_deg, longitude_deg)?,
        };
        Ok(Place { name: name.to_owned(), latitude_deg, longitude_deg, elevation_m, time_zone })
    }
}

/// The condition also refuses NaN.
fn within(what: &'static str, value: f64, low: f64, high: f64, unit: &'static str) -> Result<(), SunError> {
    if (low..=high).contains(&value) {
        return Ok(());
    }
    Err(SunError::OutOfRange { what, value, low, high, unit })
}

/// Returns the time zone at a point of the Earth, on land or at sea.
///
/// # Errors
/// [`SunError::NoZone`] if the map has none, or one that the zone database does not have.
pub fn zone_at(latitude_deg: f64, longitude_deg: f64) -> Result<Zone, SunError> {
    // loading the map takes tens of milliseconds and several megabytes: once, and only when needed
    static FINDER: OnceLock<tzf_rs::DefaultFinder> = OnceLock::new();
    let finder = FINDER.get_or_init(tzf_rs::DefaultFinder::new);
    // longitude first in this library
    let name = finder.get_tz_name(longitude_deg, latitude_deg);
    ZoneRules::newest().zone(name).ok_or(SunError::NoZone { latitude_deg, longitude_deg })
}
