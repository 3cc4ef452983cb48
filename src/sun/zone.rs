//! A time zone: its name, and the rules of its clock.

use super::TzVersion;
use chrono::{
    DateTime, Datelike, FixedOffset, MappedLocalTime, NaiveDate, NaiveDateTime, NaiveTime, Offset, TimeDelta, TimeZone,
};
use jiff::Timestamp;
use jiff::tz::{AmbiguousOffset, Offset as JiffOffset};
use std::fmt;

/// A zone of the IANA Time Zone Database, in the form that [`chrono::DateTime`] uses. After the last known change its
/// clock follows the last rule.
#[derive(Clone, Copy)]
pub struct Zone(&'static ZoneData);

/// The data of a zone.
pub(super) struct ZoneData {
    name: String,
    version: TzVersion,
    rules: jiff::tz::TimeZone,
}

impl ZoneData {
    /// Reads the rules in a compiled file (TZif, RFC 9636); `None` if it is not one.
    pub(super) fn read(name: &str, version: TzVersion, file: &[u8]) -> Option<ZoneData> {
        Some(ZoneData { name: name.to_owned(), version, rules: jiff::tz::TimeZone::tzif(name, file).ok()? })
    }
}

impl fmt::Debug for ZoneData {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ({})", self.name, self.version)
    }
}

/// A zone's offset from UTC at an instant.
#[derive(Clone, Copy, PartialEq)]
pub struct ZoneOffset {
    zone: Zone,
    fixed: FixedOffset,
    /// Seconds since 1970, to find the zone's abbreviation.
    at: i64,
}

/// A jump of the clock, which skips local times.
pub(super) struct Jump {
    /// The first instant after it, UTC.
    pub(super) at: NaiveDateTime,
    /// The offset before it.
    pub(super) before: FixedOffset,
    /// The offset after it.
    pub(super) after: FixedOffset,
}

impl Zone {
    pub(super) fn of(known: &'static ZoneData) -> Zone {
        Zone(known)
    }

    /// Its name in the database: `Europe/Paris`.
    pub fn name(self) -> &'static str {
        &self.0.name
    }

    /// The release of the database that its rules are from.
    pub fn version(self) -> &'static TzVersion {
        &self.0.version
    }

    /// Whether it is an offset that no government can change, such as `UTC` and `Etc/GMT+7`.
    pub fn is_fixed(self) -> bool {
        self.0.rules.preceding(Timestamp::MAX).next().is_none()
    }

    /// Returns a note if the clock at a time is a guess: more than a year after the release of its rules, counted from
    /// the end of the release's year, since a release has no other date. Fixed offsets are never doubted.
    pub fn doubt(time: &DateTime<Zone>) -> Option<String> {
        let (zone, year) = (time.timezone(), time.year());
        let version = zone.version();
        (year > version.year() + 1 && !zone.is_fixed()).then(|| {
            format!(
                "{year} is more than a year after tz {version}, whose rules are used for the clock of {zone}; governments \
                 may have changed them since"
            )
        })
    }

    /// The instants at which the clock shows a local time, the earlier first: two if it is set back, otherwise the same
    /// one twice. `Err` with the jump if the time is skipped.
    pub(super) fn readings(self, local: NaiveDateTime) -> Result<[DateTime<Zone>; 2], Jump> {
        let by = |offset| self.from_utc_datetime(&(local - delta(offset)));
        match self.offsets(local) {
            AmbiguousOffset::Unambiguous { offset } => Ok([by(offset); 2]),
            AmbiguousOffset::Fold { before, after } => Ok([by(before), by(after)]),
            AmbiguousOffset::Gap { before, after } => {
                // with the later offset, the time is before the jump
                let mut later = self.0.rules.following(timestamp(local - delta(after)));
                let at = later.find(|change| change.offset() == after).map(|change| change.timestamp().as_second());
                let at = at.and_then(|secs| DateTime::from_timestamp(secs, 0)).map(|time| time.naive_utc());
                Err(Jump { at: at.unwrap_or(local - delta(before)), before: fixed(before), after: fixed(after) })
            }
        }
    }

    /// The offset of the clock when it shows a local time.
    fn offsets(self, local: NaiveDateTime) -> AmbiguousOffset {
        self.0.rules.to_ambiguous_timestamp(JiffOffset::UTC.to_datetime(timestamp(local))).offset()
    }

    fn offset(self, fixed: FixedOffset, utc: NaiveDateTime) -> ZoneOffset {
        ZoneOffset { zone: self, fixed, at: utc.and_utc().timestamp() }
    }
}

impl PartialEq for Zone {
    fn eq(&self, other: &Zone) -> bool {
        self.name() == other.name() && self.version() == other.version()
    }
}

impl Eq for Zone {}

impl fmt::Display for Zone {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl fmt::Debug for Zone {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl TimeZone for Zone {
    type Offset = ZoneOffset;

    fn from_offset(offset: &ZoneOffset) -> Zone {
        offset.zone
    }

    fn offset_from_utc_datetime(&self, utc: &NaiveDateTime) -> ZoneOffset {
        self.offset(fixed(self.0.rules.to_offset(timestamp(*utc))), *utc)
    }

    fn offset_from_utc_date(&self, utc: &NaiveDate) -> ZoneOffset {
        self.offset_from_utc_datetime(&utc.and_time(NaiveTime::MIN))
    }

    fn offset_from_local_datetime(&self, local: &NaiveDateTime) -> MappedLocalTime<ZoneOffset> {
        let with = |offset: JiffOffset| self.offset(fixed(offset), *local - delta(offset));
        match self.offsets(*local) {
            AmbiguousOffset::Unambiguous { offset } => MappedLocalTime::Single(with(offset)),
            AmbiguousOffset::Gap { .. } => MappedLocalTime::None,
            AmbiguousOffset::Fold { before, after } => MappedLocalTime::Ambiguous(with(before), with(after)),
        }
    }

    fn offset_from_local_date(&self, local: &NaiveDate) -> MappedLocalTime<ZoneOffset> {
        self.offset_from_local_datetime(&local.and_time(NaiveTime::MIN))
    }
}

impl Offset for ZoneOffset {
    fn fix(&self) -> FixedOffset {
        self.fixed
    }
}

/// The zone's abbreviation: `CEST`, or `+03` if it has none.
impl fmt::Display for ZoneOffset {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.zone.0.rules.to_offset_info(seconds(self.at)).abbreviation())
    }
}

impl fmt::Debug for ZoneOffset {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

fn timestamp(time: NaiveDateTime) -> Timestamp {
    seconds(time.and_utc().timestamp())
}

/// Years beyond jiff's range use the offsets of its last year; no sun is computed for them.
fn seconds(since_1970: i64) -> Timestamp {
    let taken = since_1970.clamp(Timestamp::MIN.as_second(), Timestamp::MAX.as_second());
    Timestamp::from_second(taken).unwrap_or_default()
}

fn delta(offset: JiffOffset) -> TimeDelta {
    TimeDelta::seconds(offset.seconds().into())
}

/// Cannot fail for a zone of the database: offsets are within a day.
fn fixed(offset: JiffOffset) -> FixedOffset {
    FixedOffset::east_opt(offset.seconds()).unwrap_or(chrono::Utc.fix())
}
