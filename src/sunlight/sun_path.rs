//! The sun's path across the sky on a day, as polynomials that follow the exact sun.
//!
//! Declination, refraction and the equation of time change within a day, so the path is not a circle. The part above
//! the horizon is cut into pieces. In each, a polynomial of the fifth degree passes through six exact suns and is
//! compared with the exact sun between them; where it is off by more than a small part of a second, the piece is
//! halved.

use super::{Interval, IntervalBound};
use crate::sun::{Air, DayWindow, Instant, Place, Sky, SmoothSky, SunError, delta_t_secs};
use chrono::{DateTime, NaiveTime, TimeDelta, Utc};
use glam::DVec3;
use std::ops::RangeInclusive;
use std::sync::OnceLock;

/// Pieces are cut at multiples of this many seconds since the day's mean solar midnight.
pub(super) const SLOT_SECS: i32 = 3840;

/// The degree of the polynomials.
pub(super) const DEGREE: usize = 5;

/// The uncertainty of the exact sun itself, radians: its time is a Julian date, whose floating-point spacing is 40 µs.
const NOISE_RAD: f64 = 1e-8;

/// A polynomial with a larger error is halved, radians. In one second the sun moves by 7e-5.
const FAR_RAD: f64 = 5e-7;

/// More than the error of any polynomial in a study, radians.
pub(super) const MOST_OFF_RAD: f64 = 1e-5;

/// Pieces no longer than this are not halved, seconds.
const SHORTEST_SECS: i32 = 8;

/// Seconds since the day's mean solar midnight.
pub(super) type Second = i32;

/// A polynomial in the time within a piece, which runs from 0 to 1.
pub(super) type Polynomial<T> = [T; DEGREE + 1];

/// A run of seconds, and the directions to the sun in it.
pub(super) struct SunPiece {
    pub(super) first: Second,
    pub(super) last: Second,
    /// The length of the polynomial's unit, seconds.
    pub(super) unit_secs: f64,
    /// The direction, of approximately unit length.
    pub(super) to_sun: Polynomial<DVec3>,
    /// Its greatest distance from the exact direction, radians.
    pub(super) off_rad: f64,
}

/// The exact sun, as rays need it.
#[derive(Clone, Copy, Debug)]
pub(super) struct ExactSun {
    pub(super) to_sun: DVec3,
    pub(super) night: bool,
}

/// The exact suns of a day that were computed so far, one for each second.
type KnownSuns = OnceLock<Box<[OnceLock<ExactSun>]>>;

/// The sun's path of a day.
pub struct SunPath<'a> {
    sky: SmoothSky<'a>,
    window: &'a DayWindow,
    base: DateTime<Utc>,
    /// When the sun is up within the window.
    pub up: Vec<Interval>,
    /// `up` in seconds.
    pub(super) up_secs: Vec<RangeInclusive<Second>>,
    /// In order of time; together they cover `up`.
    pub(super) pieces: Vec<SunPiece>,
    /// `None` if exact suns are not kept.
    known: Option<KnownSuns>,
}

impl<'a> SunPath<'a> {
    /// The path within a window of the day.
    ///
    /// # Errors
    /// As for [`Sky::at`].
    pub fn new(place: &'a Place, window: &'a DayWindow, air: Option<Air>) -> Result<SunPath<'a>, SunError> {
        let sky = Sky { place, delta_t_secs: delta_t_secs(window.from.to_utc())?, air };
        let up = up(&sky, window)?;
        let mean_solar = TimeDelta::seconds((place.longitude_deg * 240.0) as i64);
        let base = window.day.date.and_time(NaiveTime::MIN).and_utc() - mean_solar;
        let ends = [up.first().map_or(window.from, |up| up.start), up.last().map_or(window.from, |up| up.end)];
        let sky = SmoothSky::new(sky, ends.map(|end| end.to_utc()))?;
        let mut path = SunPath { sky, window, base, up, up_secs: Vec::new(), pieces: Vec::new(), known: None };
        path.up_secs = path.up.iter().map(|interval| path.seconds(interval)).collect();
        for up in path.up_secs.clone() {
            let mut first = *up.start();
            while first <= *up.end() {
                let last = ((first.div_euclid(SLOT_SECS) + 1) * SLOT_SECS - 1).min(*up.end());
                path.fit(first, last)?;
                first = last + 1;
            }
        }
        Ok(path)
    }

    /// The same path. It keeps the exact suns that it computes, a megabyte or two, as most are asked for again if there
    /// are many points.
    pub(super) fn keeping_suns(self) -> SunPath<'a> {
        SunPath { known: Some(OnceLock::new()), ..self }
    }

    /// The seconds of the window, its end included.
    pub(super) fn asked(&self) -> RangeInclusive<Second> {
        self.second(self.window.from.to_utc())..=self.second(self.window.to.to_utc())
    }

    /// The seconds of an interval of [`SunPath::up`].
    fn seconds(&self, interval: &Interval) -> RangeInclusive<Second> {
        let end = self.second(interval.end.to_utc());
        // at the window's end the sun is still up
        let last = if interval.after == IntervalBound::Window { end } else { end - 1 };
        self.second(interval.start.to_utc())..=last
    }

    fn second(&self, time: DateTime<Utc>) -> Second {
        // fits: a window lies within two days of its date
        (time - self.base).num_seconds() as Second
    }

    /// The time of a second.
    pub(super) fn time(&self, second: Second) -> DateTime<crate::sun::Zone> {
        self.window.from + TimeDelta::seconds((second - self.asked().start()).into())
    }

    /// The exact sun at a second.
    pub(super) fn exact(&self, second: Second) -> Result<ExactSun, SunError> {
        let asked = self.asked();
        let suns =
            self.known.as_ref().map(|known| known.get_or_init(|| asked.clone().map(|_| OnceLock::new()).collect()));
        let slot = suns.and_then(|suns| suns.get(usize::try_from(second - asked.start()).ok()?));
        if let Some(known) = slot.and_then(OnceLock::get) {
            return Ok(*known);
        }
        let sun = ExactSun::from(&self.sky.at(self.time(second))?);
        if let Some(slot) = slot {
            // if another thread was faster, it found the same
            let _ = slot.set(sun);
        }
        Ok(sun)
    }

    /// The exact direction a fraction of time after a second.
    fn after(&self, second: Second, secs: f64) -> Result<DVec3, SunError> {
        Ok(self.sky.at(self.time(second) + TimeDelta::nanoseconds((secs * 1e9) as i64))?.to_sun)
    }

    /// The piece that contains a second, if the sun is up then.
    pub(super) fn piece_at(&self, second: Second) -> Option<&SunPiece> {
        let at = self.pieces.partition_point(|piece| piece.last < second);
        self.pieces.get(at).filter(|piece| piece.first <= second)
    }

    /// Adds the pieces for a run of seconds.
    fn fit(&mut self, first: Second, last: Second) -> Result<(), SunError> {
        let unit_secs = f64::from((last - first).max(1));
        let mut suns = [DVec3::ZERO; DEGREE + 1];
        for (index, sun) in suns.iter_mut().enumerate() {
            *sun = if last == first {
                self.exact(first)?.to_sun
            } else {
                self.after(first, unit_secs * index as f64 / DEGREE as f64)?
            };
        }
        let mut piece = SunPiece { first, last, unit_secs, to_sun: through(suns), off_rad: NOISE_RAD };
        if last - first > 1 {
            // a polynomial through evenly spaced points is off the most in the first and the last gap
            let mut off = 0.0f64;
            for at in [0.5 / DEGREE as f64, 1.0 - 0.5 / DEGREE as f64] {
                off = off.max(value(&piece.to_sun, at).distance(self.after(first, unit_secs * at)?));
            }
            if off > FAR_RAD && last - first > SHORTEST_SECS {
                let middle = first + (last - first) / 2;
                self.fit(first, middle)?;
                return self.fit(middle + 1, last);
            }
            piece.off_rad += 4.0 * off;
        }
        self.pieces.push(piece);
        Ok(())
    }
}

impl From<&Instant> for ExactSun {
    fn from(instant: &Instant) -> ExactSun {
        ExactSun { to_sun: instant.to_sun, night: instant.night }
    }
}

impl SunPiece {
    /// The position of a second within the piece, 0 to 1.
    pub(super) fn unit(&self, second: Second) -> f64 {
        f64::from(second - self.first) / self.unit_secs
    }

    /// The direction to the sun by the polynomial.
    pub(super) fn to_sun(&self, second: Second) -> DVec3 {
        value(&self.to_sun, self.unit(second))
    }

    /// Points whose convex hull contains all directions of the piece: the Bernstein control points.
    pub(super) fn hull(&self) -> [DVec3; DEGREE + 1] {
        let choose = |n: usize, k: usize| (0..k).fold(1.0, |value, at| value * (n - at) as f64 / (at + 1) as f64);
        std::array::from_fn(|at| {
            (0..=at).map(|power| self.to_sun[power] * (choose(at, power) / choose(DEGREE, power))).sum()
        })
    }
}

/// The intervals of a window in which the sun is up.
fn up(sky: &Sky<'_>, window: &DayWindow) -> Result<Vec<Interval>, SunError> {
    let [first, last] = [sky.at(window.from)?, sky.at(window.to)?];
    let mut open = (!first.night).then_some((window.from, IntervalBound::Window));
    let mut found = Vec::new();
    for time in sky.changes(&first, &last)? {
        match open.take() {
            Some((start, before)) => found.push(Interval { start, end: time, before, after: IntervalBound::Horizon }),
            None => open = Some((time, IntervalBound::Horizon)),
        }
    }
    found.extend(open.filter(|(start, _)| *start < window.to).map(|(start, before)| Interval {
        start,
        end: window.to,
        before,
        after: IntervalBound::Window,
    }));
    Ok(found)
}

fn value(of: &Polynomial<DVec3>, at: f64) -> DVec3 {
    of.iter().rev().fold(DVec3::ZERO, |sum, part| sum * at + *part)
}

/// The polynomial through the values at 0, 1/5, …, 1: Newton's form, expanded.
fn through(values: Polynomial<DVec3>) -> Polynomial<DVec3> {
    let gap = 1.0 / DEGREE as f64;
    let mut divided = values;
    for order in 1..=DEGREE {
        for at in (order..=DEGREE).rev() {
            divided[at] = (divided[at] - divided[at - 1]) / (gap * order as f64);
        }
    }
    let mut polynomial = [DVec3::ZERO; DEGREE + 1];
    for at in (0..=DEGREE).rev() {
        // multiply by (u − node), then add the coefficient
        let node = gap * at as f64;
        for power in (1..=DEGREE).rev() {
            polynomial[power] = polynomial[power - 1] - polynomial[power] * node;
        }
        polynomial[0] = divided[at] - polynomial[0] * node;
    }
    polynomial
}
