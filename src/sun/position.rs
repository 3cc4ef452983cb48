//! The sun's position by NREL's SPA (Reda and Andreas 2003), computed by the crate `solar-positioning`.

use super::{Place, SunError};
use chrono::{DateTime, Datelike, Utc};
use glam::DVec3;
use solar_positioning::{Location, RefractionCorrection, SolarPositions, delta_t};

/// The allowed years: Espenak and Meeus end at 3000, and for antiquity no clocks are known.
const FIRST_YEAR: i32 = 1600;
const LAST_YEAR: i32 = 2999;

/// The air that refracts the sun's light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Air {
    /// Hectopascal (millibar), at the place.
    pub pressure_hpa: f64,
    /// Degrees Celsius.
    pub temperature_c: f64,
}

impl Air {
    /// 12 °C and the standard atmosphere's pressure (ISO 2533, lowest layer) at an elevation in metres.
    pub fn standard(elevation_m: f64) -> Air {
        Air { pressure_hpa: 1013.25 * (1.0 - 2.255_77e-5 * elevation_m).powf(5.255_88), temperature_c: 12.0 }
    }
}

/// The apparent position of the sun's centre, topocentric.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Position {
    /// Clockwise from true north, degrees, 0 to 360.
    pub azimuth_deg: f64,
    /// Degrees above the horizon, including refraction if there is air.
    pub altitude_deg: f64,
}

impl Position {
    /// Unit vector to the sun in the world frame (x east, y north, z up).
    pub fn to_sun(&self) -> DVec3 {
        let (sin_azimuth, cos_azimuth) = self.azimuth_deg.to_radians().sin_cos();
        let (sin_altitude, cos_altitude) = self.altitude_deg.to_radians().sin_cos();
        DVec3::new(sin_azimuth * cos_altitude, cos_azimuth * cos_altitude, sin_altitude)
    }
}

/// Computes the sun's position at a time, with ΔT in seconds. Without `air` there is no refraction.
///
/// UTC is used as UT1, from which it never differs by more than 0.9 s (0.004° of the Earth's rotation).
///
/// # Errors
/// Errors of the library: a time outside the years −2000 to 6000, or impossible air.
pub fn position(place: &Place, time: DateTime<Utc>, delta_t_secs: f64, air: Option<Air>) -> Result<Position, SunError> {
    let refused = |error: solar_positioning::Error| SunError::Position(error.to_string());
    let correction =
        air.map(|air| RefractionCorrection::new(air.pressure_hpa, air.temperature_c)).transpose().map_err(refused)?;
    let seen = SolarPositions::new()
        .at(&time, location(place), place.elevation_m, delta_t_secs, correction)
        .map_err(refused)?;
    Ok(Position { azimuth_deg: seen.azimuth(), altitude_deg: seen.elevation_angle() })
}

/// The place in the library's type.
pub(super) fn location(place: &Place) -> Location {
    Location { latitude: place.latitude_deg, longitude: place.longitude_deg }
}

/// ΔT = TT − UT1 in seconds, by the polynomials of Espenak and Meeus
/// (Five Millennium Canon of Solar Eclipses, NASA/TP-2006-214141), at the middle of the month.
///
/// The library's estimator is the same before 2005. After that it uses newer observations (about 6 s less in 2026), so
/// the later polynomials of Espenak and Meeus are implemented here. Six seconds of ΔT move the sun by 0.00007°, less
/// than SPA's own uncertainty of 0.0003°.
///
/// # Errors
/// A year outside 1600 to 2999.
pub fn delta_t_secs(time: DateTime<Utc>) -> Result<f64, SunError> {
    check_year(time.year())?;
    let year = f64::from(time.year()) + (f64::from(time.month()) - 0.5) / 12.0;
    let centuries = (year - 1820.0) / 100.0;
    let parabola = -20.0 + 32.0 * centuries * centuries;
    if year < 2005.0 {
        return delta_t::estimate(year).map_err(|error| SunError::Position(error.to_string()));
    }
    Ok(if year < 2050.0 {
        let t = year - 2000.0;
        62.92 + 0.32217 * t + 0.005589 * t * t
    } else if year < 2150.0 {
        parabola - 0.5628 * (2150.0 - year)
    } else {
        parabola
    })
}

/// Refuses a year for which ΔT is not known.
pub(super) fn check_year(year: i32) -> Result<(), SunError> {
    if (FIRST_YEAR..=LAST_YEAR).contains(&year) {
        return Ok(());
    }
    Err(SunError::Year { year, first: FIRST_YEAR, last: LAST_YEAR })
}
