//! The sun over a part of a day, from a few exact positions.
//!
//! SPA adds up hundreds of terms for a position, which takes ten times as long as a ray. But all of them change slowly.
//! In a frame that does not turn with the Earth, the sun moves by a degree a day, and its parallax describes a circle of
//! 9″. So directions are interpolated there, without refraction, through exact ones, and turned back with the Earth;
//! refraction follows by SPA's own formula. Each stretch is compared with exact positions between those that it passes
//! through; if it is off by more than [`FAR_RAD`], exact positions are used.
//!
//! Exact positions themselves jump by up to 40 µs of time, the floating-point spacing of Julian dates. The stretches
//! pass through positions at times whose Julian dates are exact.

use super::{Air, Instant, Position, Sky, SunError, Zone, position};
use chrono::{DateTime, TimeDelta, Utc};
use glam::{DVec2, DVec3};
use std::f64::consts::PI;
use std::ops::Range;

/// The times of exact positions are whole multiples of this many seconds: 1/128 day, which Julian dates hold exactly.
const STEP_SECS: i64 = 675;
/// The greatest length of a stretch, steps: half a day.
const LONGEST: i64 = 64;
/// The least length: a short stretch passes through fewer positions.
const SHORTEST: i64 = 8;
/// The greatest number of exact positions that a stretch passes through.
const NODES: usize = 10;
/// The greatest error, radians. In 0.2 ms the sun moves as far, and exact positions are as uncertain.
const FAR_RAD: f64 = 1e-8;
/// The rotation of the Earth against the stars, radians per second (360.985647366° per day).
const TURN_RAD: f64 = 360.985_647_366 * PI / 180.0 / 86_400.0;
/// SPA's refraction ends where the sun's upper limb is below the horizon: minus its radius and the refraction there,
/// degrees.
const LOWEST_REFRACTED_DEG: f64 = -0.26667 - 0.5667;

/// A sky that answers within a part of time from few exact positions.
pub struct SmoothSky<'a> {
    sky: Sky<'a>,
    stretches: Vec<SkyStretch>,
}

/// A stretch of time, with a polynomial for the direction.
struct SkyStretch {
    times: Range<DateTime<Utc>>,
    middle: DateTime<Utc>,
    /// The seconds from the middle to either end.
    half_secs: f64,
    /// Newton's form: for each position that the polynomial passes through its time, from −1 to 1, and its divided
    /// difference.
    nodes: Vec<(f64, DVec3)>,
    /// Whether it agrees with exact positions.
    is_exact: bool,
}

impl<'a> SmoothSky<'a> {
    /// A sky that is asked between two times.
    ///
    /// # Errors
    /// As for [`position()`].
    pub fn new(sky: Sky<'a>, [from, to]: [DateTime<Utc>; 2]) -> Result<SmoothSky<'a>, SunError> {
        let first = from.timestamp().div_euclid(STEP_SECS);
        let last = to.timestamp().div_euclid(STEP_SECS) + 1;
        // nothing is asked of a day without sun
        let count = if from < to { (last - first + LONGEST - 1) / LONGEST } else { 0 };
        let bound = |index: i64| first + (last - first) * index / count;
        let mut smooth = SmoothSky { sky, stretches: Vec::new() };
        for index in 0..count {
            let steps = bound(index)..bound(index + 1).max(bound(index) + SHORTEST);
            smooth.stretches.push(smooth.stretch(steps)?);
        }
        Ok(smooth)
    }

    /// The sun at a time, with weight 0: within the part of time that of [`Sky::at`] to 1e-8 rad, elsewhere the same.
    ///
    /// # Errors
    /// As for [`position()`].
    pub fn at(&self, time: DateTime<Zone>) -> Result<Instant, SunError> {
        let utc = time.to_utc();
        let after = self.stretches.partition_point(|stretch| stretch.times.end <= utc);
        match self.stretches.get(after).filter(|stretch| stretch.is_exact && stretch.times.start <= utc) {
            Some(stretch) => Ok(Sky::seen(time, &self.by(stretch, utc))),
            None => self.sky.at(time),
        }
    }

    fn stretch(&self, steps: Range<i64>) -> Result<SkyStretch, SunError> {
        let time = |step: i64| DateTime::from_timestamp(step * STEP_SECS, 0).unwrap_or_default();
        let length = steps.end - steps.start;
        let half_secs = (length * STEP_SECS) as f64 / 2.0;
        let middle = time(steps.start) + TimeDelta::seconds(length * STEP_SECS / 2);
        // crowded towards both ends, so that the polynomial is as good there (Chebyshev)
        let place = |index: usize| (1.0 - (PI * index as f64 / (NODES - 1) as f64).cos()) / 2.0;
        let mut places: Vec<i64> = (0..NODES).map(|index| (place(index) * length as f64).round() as i64).collect();
        places.dedup();
        let mut nodes = Vec::with_capacity(places.len());
        for place in places {
            let time = time(steps.start + place);
            let secs = seconds(time - middle);
            let position = position(self.sky.place, time, self.sky.delta_t_secs, None)?;
            nodes.push((secs / half_secs, self.against_stars(position.to_sun(), secs)));
        }
        for order in 1..nodes.len() {
            for at in (order..nodes.len()).rev() {
                nodes[at].1 = (nodes[at].1 - nodes[at - 1].1) / (nodes[at].0 - nodes[at - order].0);
            }
        }
        let times = time(steps.start)..time(steps.end);
        let mut stretch = SkyStretch { times, middle, half_secs, nodes, is_exact: false };
        stretch.is_exact = true;
        for part in [0.03, 0.41, 0.86] {
            let time = middle + TimeDelta::seconds((half_secs * (2.0 * part - 1.0)) as i64);
            let exact = position(self.sky.place, time, self.sky.delta_t_secs, self.sky.air)?;
            stretch.is_exact &= exact.to_sun().distance(self.by(&stretch, time).to_sun()) <= FAR_RAD;
        }
        Ok(stretch)
    }

    /// The position by a stretch's polynomial.
    fn by(&self, stretch: &SkyStretch, time: DateTime<Utc>) -> Position {
        let secs = seconds(time - stretch.middle);
        let unit = secs / stretch.half_secs;
        let slow = stretch.nodes.iter().rev().fold(DVec3::ZERO, |sum, (node, part)| sum * (unit - node) + *part);
        let to_sun = self.against_earth(slow, secs);
        let altitude_deg = to_sun.z.atan2(to_sun.truncate().length()).to_degrees();
        Position {
            azimuth_deg: to_sun.x.atan2(to_sun.y).to_degrees().rem_euclid(360.0),
            altitude_deg: altitude_deg + self.sky.air.map_or(0.0, |air| refraction_deg(altitude_deg, &air)),
        }
    }

    /// A direction (east, north, up) in a frame that turned with the Earth `secs` ago: the meridian at the equator, the
    /// east, and the pole.
    fn against_stars(&self, direction: DVec3, secs: f64) -> DVec3 {
        let (sin, cos) = self.sky.place.latitude_deg.to_radians().sin_cos();
        let meridian = cos * direction.z - sin * direction.y;
        let pole = sin * direction.z + cos * direction.y;
        DVec2::from_angle(TURN_RAD * secs).rotate(DVec2::new(meridian, direction.x)).extend(pole)
    }

    /// The inverse.
    fn against_earth(&self, slow: DVec3, secs: f64) -> DVec3 {
        let (sin, cos) = self.sky.place.latitude_deg.to_radians().sin_cos();
        let turned = DVec2::from_angle(-TURN_RAD * secs).rotate(slow.truncate());
        DVec3::new(turned.y, cos * slow.z - sin * turned.x, sin * slow.z + cos * turned.x)
    }
}

/// SPA's refraction at an altitude without it (Reda and Andreas 2003, equation 42), degrees.
fn refraction_deg(altitude_deg: f64, air: &Air) -> f64 {
    if altitude_deg <= LOWEST_REFRACTED_DEG {
        return 0.0;
    }
    let phase = (altitude_deg + 10.3 / (altitude_deg + 5.11)).to_radians();
    air.pressure_hpa / 1010.0 * (283.0 / (273.0 + air.temperature_c)) * 1.02 / (60.0 * phase.tan())
}

fn seconds(span: TimeDelta) -> f64 {
    span.num_seconds() as f64 + f64::from(span.subsec_nanos()) * 1e-9
}
