//! The sun at each second of a day.

use super::kept::KeptPlace;
use crate::sun::{Sky, SunError, Zone};
use crate::sunlight::SunSlopes;
use chrono::{DateTime, TimeZone};
use glam::DVec3;
use rayon::prelude::*;

/// The local time at a second since 1970.
pub(super) fn time(sky: &Sky<'_>, secs: i64) -> DateTime<Zone> {
    // a day's windows are within the years that chrono supports
    let utc = DateTime::from_timestamp(secs, 0).unwrap_or_default().naive_utc();
    sky.place.time_zone.from_utc_datetime(&utc)
}

/// The exact direction to the sun at each second of a day at which some place is lit.
pub(super) struct SunsOfDay {
    first: i64,
    to_sun: Vec<DVec3>,
}

impl SunsOfDay {
    pub(super) fn of<'p>(
        sky: &Sky<'_>,
        places: impl Iterator<Item = &'p KeptPlace> + Clone,
        day: usize,
    ) -> Result<SunsOfDay, SunError> {
        let asked = places.filter_map(|place| place.days.get(day)).filter(|asked| asked.secs > 0);
        let spells = asked.flat_map(|asked| &asked.lit);
        let first = spells.clone().map(|spell| spell.start).min().unwrap_or(0);
        let end = spells.map(|spell| spell.end).max().unwrap_or(first);
        let to_sun = (first..end).into_par_iter().map(|secs| Ok(sky.at(time(sky, secs))?.to_sun));
        Ok(SunsOfDay { first, to_sun: to_sun.collect::<Result<_, SunError>>()? })
    }

    /// The sun's slopes on this day.
    pub(super) fn slopes(&self) -> SunSlopes {
        SunSlopes::of(self.first, &self.to_sun)
    }

    pub(super) fn at(&self, secs: i64) -> DVec3 {
        self.to_sun[(secs - self.first) as usize]
    }
}
