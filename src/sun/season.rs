//! The sun's ecliptic longitude, and when it reaches the points that calendars name.

use super::position::{check_year, delta_t_secs};
use super::{Place, SunError, Zone};
use chrono::{DateTime, NaiveDate, NaiveTime, TimeDelta, Utc};
use solar_positioning::SolarPositions;
use solar_positioning::time::JulianDate;

/// A point of the year, defined by the sun's apparent longitude. The names use months, so they mean the same in both
/// hemispheres.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Season {
    /// 0°.
    MarchEquinox,
    /// 90°.
    JuneSolstice,
    /// 180°.
    SeptemberEquinox,
    /// 270°.
    DecemberSolstice,
    /// 300°, about 20 January: 大寒, the last of the 24 solar terms.
    GreatCold,
}

impl Season {
    /// The sun's apparent longitude, degrees.
    pub fn longitude_deg(self) -> f64 {
        match self {
            Season::MarchEquinox => 0.0,
            Season::JuneSolstice => 90.0,
            Season::SeptemberEquinox => 180.0,
            Season::DecemberSolstice => 270.0,
            Season::GreatCold => 300.0,
        }
    }

    /// The month and day near which it falls.
    pub(crate) fn about(self) -> (u32, u32) {
        match self {
            Season::MarchEquinox => (3, 20),
            Season::JuneSolstice => (6, 21),
            Season::SeptemberEquinox => (9, 22),
            Season::DecemberSolstice => (12, 21),
            Season::GreatCold => (1, 20),
        }
    }

    /// Returns when the sun reaches it in a year.
    ///
    /// # Errors
    /// A year outside 1600 to 2999.
    pub fn time(self, year: i32) -> Result<DateTime<Utc>, SunError> {
        /// The sun's mean motion per second, degrees.
        const DEGREES_A_SECOND: f64 = 360.0 / (365.242_2 * 86_400.0);
        /// The number of iterations. Each reduces the error thirtyfold, as the sun's speed is within 3.4% of its mean.
        const TURNS: usize = 6;
        check_year(year)?;
        let (month, day) = self.about();
        let noon = NaiveTime::MIN + TimeDelta::hours(12);
        let start = NaiveDate::from_ymd_opt(year, month, day).unwrap_or_default();
        let mut time = start.and_time(noon).and_utc();
        for _ in 0..TURNS {
            let left = (self.longitude_deg() - apparent_longitude_deg(time)? + 540.0).rem_euclid(360.0) - 180.0;
            time += TimeDelta::milliseconds((left / DEGREES_A_SECOND * 1000.0) as i64);
        }
        Ok(time)
    }

    /// Returns the local date on which the sun reaches it.
    ///
    /// # Errors
    /// A year outside 1600 to 2999.
    pub fn date(self, place: &Place, year: i32) -> Result<NaiveDate, SunError> {
        let local: DateTime<Zone> = self.time(year)?.with_timezone(&place.time_zone);
        Ok(local.date_naive())
    }
}

/// Returns the sun's apparent geocentric longitude, degrees: with nutation and aberration, from the true equinox of the
/// date.
///
/// Computed from SPA's right ascension and declination by a rotation about the equinox by the true obliquity. That is
/// the IAU's mean obliquity (Lieske 1979) with the four largest terms of its nutation (Meeus, Astronomical Algorithms,
/// ch. 22: to 0.1"), since the library does not expose SPA's own. The sun moves by 0.1" in 2 s.
///
/// # Errors
/// A year outside 1600 to 2999.
pub fn apparent_longitude_deg(time: DateTime<Utc>) -> Result<f64, SunError> {
    let refused = |error: solar_positioning::Error| SunError::Position(error.to_string());
    let julian = JulianDate::from_datetime(&time, delta_t_secs(time)?).map_err(refused)?;
    let sun = SolarPositions::new().for_time_from_julian(julian).map_err(refused)?;
    let (sin_ascension, cos_ascension) = sun.right_ascension().to_radians().sin_cos();
    let (sin_obliquity, cos_obliquity) = obliquity_rad(julian.julian_ephemeris_century()).sin_cos();
    let tan_declination = sun.declination().to_radians().tan();
    let across = sin_ascension * cos_obliquity + tan_declination * sin_obliquity;
    Ok(across.atan2(cos_ascension).to_degrees().rem_euclid(360.0))
}

/// The true obliquity of the ecliptic, radians; `centuries` counts from the year 2000.
fn obliquity_rad(centuries: f64) -> f64 {
    let t = centuries;
    let mean_arcsec = 84_381.448 - 46.815 * t - 0.000_59 * t * t + 0.001_813 * t * t * t;
    let node = (125.044_52 - 1_934.136_261 * t).to_radians();
    let sun = (280.466_5 + 36_000.769_8 * t).to_radians();
    let moon = (218.316_5 + 481_267.881_3 * t).to_radians();
    let nutation_arcsec =
        9.20 * node.cos() + 0.57 * (2.0 * sun).cos() + 0.10 * (2.0 * moon).cos() - 0.09 * (2.0 * node).cos();
    ((mean_arcsec + nutation_arcsec) / 3600.0).to_radians()
}
