//! The sun's position at a place, and its rises and sets between two instants.

use super::{Air, Instant, Place, Position, SunError, Zone, position};
use chrono::{DateTime, TimeDelta};

/// Everything that the sun's position in a study depends on.
#[derive(Clone, Copy, Debug)]
pub struct Sky<'a> {
    /// The place from which the sun is seen.
    pub place: &'a Place,
    /// ΔT, seconds.
    pub delta_t_secs: f64,
    /// The air that refracts the sun's light; `None` for no refraction.
    pub air: Option<Air>,
}

/// The rises and sets of the sun between two instants.
#[derive(Clone, Debug)]
pub struct HorizonCrossings {
    /// The first second at which night has become day, or day night.
    pub first: DateTime<Zone>,
    /// From here on it is as at the later instant.
    pub last: DateTime<Zone>,
    /// If the sun rises or sets more than once: the middle of each stretch between these times, with the stretch's
    /// seconds as its weight.
    pub between: Vec<Instant>,
}

impl Sky<'_> {
    /// Returns the sun at a time, with weight 0.
    ///
    /// # Errors
    /// As for [`position()`].
    pub fn at(&self, time: DateTime<Zone>) -> Result<Instant, SunError> {
        Ok(Self::seen(time, &position(self.place, time.to_utc(), self.delta_t_secs, self.air)?))
    }

    /// A position at a time.
    pub(super) fn seen(time: DateTime<Zone>, seen: &Position) -> Instant {
        let mut instant = Instant {
            time,
            to_sun: seen.to_sun(),
            azimuth_rad: seen.azimuth_deg.to_radians(),
            altitude_rad: seen.altitude_deg.to_radians(),
            weight_secs: 0,
            gap_secs: 0,
            night: false,
        };
        instant.night = instant.altitude_deg() < 0.0;
        instant
    }

    /// Returns the first seconds of day after night, and of night after day, between two instants.
    ///
    /// # Errors
    /// As for [`position()`].
    pub fn changes(&self, before: &Instant, after: &Instant) -> Result<Vec<DateTime<Zone>>, SunError> {
        let mut changes = Vec::new();
        self.search(before, after, &mut changes)?;
        Ok(changes)
    }

    /// Returns the rises and sets of the sun between two instants a whole number of seconds apart; `None` if there are
    /// none.
    ///
    /// # Errors
    /// As for [`position()`].
    pub fn cut(&self, before: &Instant, after: &Instant) -> Result<Option<HorizonCrossings>, SunError> {
        let changes = self.changes(before, after)?;
        let (Some(first), Some(last)) = (changes.first(), changes.last()) else { return Ok(None) };
        let middle = |stretch: &[DateTime<Zone>]| {
            let secs = (stretch[1] - stretch[0]).num_seconds();
            let instant = self.at(stretch[0] + TimeDelta::seconds(secs / 2))?;
            Ok(Instant { weight_secs: u32::try_from(secs).unwrap_or(0), ..instant })
        };
        let between = changes.windows(2).map(middle).collect::<Result<_, SunError>>()?;
        Ok(Some(HorizonCrossings { first: *first, last: *last, between }))
    }

    /// Finds every change between night and day, to the second, by bisection. A half with equal ends is skipped if the
    /// sun cannot have reached the horizon and come back within it.
    fn search(&self, before: &Instant, after: &Instant, found: &mut Vec<DateTime<Zone>>) -> Result<(), SunError> {
        let secs = (after.time - before.time).num_seconds();
        let changes = before.night != after.night;
        if secs <= 1 {
            found.extend(changes.then_some(after.time));
            return Ok(());
        }
        if !changes && self.least_secs_to_horizon(before) + self.least_secs_to_horizon(after) > secs as f64 {
            return Ok(());
        }
        let middle = self.at(before.time + TimeDelta::seconds(secs / 2))?;
        self.search(before, &middle, found)?;
        self.search(&middle, after, found)
    }

    /// The least number of seconds between an instant and a sun at the horizon, before or after.
    pub fn least_secs_to_horizon(&self, instant: &Instant) -> f64 {
        /// More than the sky's rotation, degrees per hour.
        const TURN: f64 = 15.05;
        /// More than the change of the sun's declination, degrees per hour.
        const DECLINE: f64 = 0.02;
        /// More than the greatest refraction at the horizon, degrees. Far below it there is none.
        const LIFTED_DEG: f64 = 0.7;
        const DEEP_DEG: f64 = -0.5;
        let altitude = instant.altitude_deg();
        let lifted = if self.air.is_some() && altitude < DEEP_DEG { LIFTED_DEG } else { 0.0 };
        // refraction only slows the sun's apparent motion
        let degrees_an_hour = TURN * self.place.latitude_deg.to_radians().cos() + DECLINE;
        (altitude.abs() - lifted).max(0.0) / degrees_an_hour * 3600.0
    }
}
