//! The clock: the shown instant, and the sun's events around it.

use crate::sun::{Air, Day, DayWindow, Instant, Place, Sky, Zone, delta_t_secs};
use chrono::{DateTime, Datelike, Days, NaiveDate, NaiveTime, TimeDelta, TimeZone, Timelike};
use eframe::egui;

/// An animation of the clock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::desktop) enum Play {
    /// The hours of the day.
    Day,
    /// The days of the year, at one hour.
    Year,
}

/// The clock: the shown instant, and the sun's events around it.
#[derive(Clone)]
pub(in crate::desktop) struct Clock {
    pub(in crate::desktop) place: Place,
    refraction: bool,
    /// The instant.
    pub(in crate::desktop) now: Instant,
    /// The first instant of its date.
    pub(in crate::desktop) midnight: DateTime<Zone>,
    /// The length of that date, seconds: not always 24 h.
    pub(in crate::desktop) length_secs: f64,
    /// Sunrise, noon, sunset.
    pub(in crate::desktop) events: Day,
    /// The instants of the date, five minutes apart.
    pub(in crate::desktop) day: Vec<Instant>,
    /// The date's full hours.
    pub(in crate::desktop) hours: Vec<(u32, Instant)>,
    /// The same for the solstices of the year.
    pub(in crate::desktop) solstices: [Vec<Instant>; 2],
    year: Option<i32>,
    /// Text in the fields while it is typed.
    pub(in crate::desktop) typed: [Option<String>; 2],
    /// Why the typed text is refused.
    pub(in crate::desktop) fault: Option<String>,
    /// The running animation.
    pub(in crate::desktop) play: Option<Play>,
    /// The rest of it: seconds of the day, or days of the year.
    left: f64,
    /// The requested clock time, which stays the same on other dates, even if some skip it.
    clock_time: NaiveTime,
}

impl Clock {
    /// A clock at a place, which shows an instant.
    pub(in crate::desktop) fn new(place: &Place, refraction: bool, at: &Instant) -> Clock {
        let mut clock = Clock {
            place: place.clone(),
            refraction,
            now: at.clone(),
            midnight: at.time,
            length_secs: 86_400.0,
            events: Day { date: at.time.date_naive(), sunrise: None, noon: None, sunset: None, polar: None },
            day: Vec::new(),
            hours: Vec::new(),
            solstices: [Vec::new(), Vec::new()],
            year: None,
            typed: [None, None],
            fault: None,
            play: None,
            left: 0.0,
            clock_time: at.time.time(),
        };
        clock.turn_day();
        clock
    }

    pub(in crate::desktop) fn date(&self) -> NaiveDate {
        self.now.time.date_naive()
    }

    /// Whether it is for this place.
    pub(in crate::desktop) fn is_at(&self, place: &Place, refraction: bool) -> bool {
        self.place == *place && self.refraction == refraction
    }

    fn instant(&self, time: DateTime<Zone>) -> Option<Instant> {
        let air = self.refraction.then(|| Air::standard(self.place.elevation_m));
        Sky { place: &self.place, delta_t_secs: delta_t_secs(time.to_utc()).ok()?, air }.at(time).ok()
    }

    /// Shows another instant. Years without a known sun (before 1600, after 2999) are ignored.
    pub(in crate::desktop) fn set(&mut self, time: DateTime<Zone>) {
        if let Some(instant) = self.instant(time) {
            // an earlier refused text is obsolete
            self.fault = None;
            let turns = instant.time.date_naive() != self.date();
            self.clock_time = instant.time.time();
            self.now = instant;
            if turns {
                self.turn_day();
            }
        }
    }

    /// Shows a time of the date, in seconds.
    pub(in crate::desktop) fn set_secs(&mut self, secs: f64) {
        let secs = secs.clamp(0.0, self.length_secs - 1.0).round() as i64;
        self.set(self.midnight + TimeDelta::seconds(secs));
    }

    /// Shows the same clock time on another date; an hour that clocks skip there becomes the next one.
    pub(in crate::desktop) fn set_date(&mut self, date: NaiveDate) {
        let clock = self.clock_time;
        let at = |clock: NaiveTime| self.place.time_zone.from_local_datetime(&date.and_time(clock)).earliest();
        let next = clock.overflowing_add_signed(TimeDelta::hours(1)).0;
        if let Some(time) = at(clock).or_else(|| at(next)) {
            self.set(time);
            self.clock_time = clock;
        }
    }

    /// Moves by seconds.
    pub(in crate::desktop) fn step_secs(&mut self, secs: i64) {
        self.set(self.now.time + TimeDelta::seconds(secs));
    }

    /// Moves by days, at the same clock time.
    pub(in crate::desktop) fn step_days(&mut self, days: i64) {
        let days_on = Days::new(days.unsigned_abs());
        let date = if days < 0 { self.date().checked_sub_days(days_on) } else { self.date().checked_add_days(days_on) };
        if let Some(date) = date {
            self.set_date(date);
        }
    }

    /// The seconds of its date that have passed.
    pub(in crate::desktop) fn secs(&self) -> f64 {
        (self.now.time - self.midnight).num_seconds() as f64
    }

    fn turn_day(&mut self) {
        let date = self.date();
        let Ok(window) = DayWindow::on(&self.place, date, None, None) else { return };
        self.midnight = window.from;
        self.length_secs = (window.to - window.from).num_seconds() as f64;
        self.events = window.day;
        self.day = self.instants(window.from, self.length_secs);
        let hours = (0..self.length_secs as i64).step_by(3600).map(|secs| window.from + TimeDelta::seconds(secs));
        self.hours = hours.filter_map(|time| Some((time.hour(), self.instant(time)?))).collect();
        if self.year != Some(date.year()) {
            self.year = Some(date.year());
            self.solstices = [6, 12].map(|month| {
                let date = NaiveDate::from_ymd_opt(date.year(), month, 21);
                let window = date.and_then(|date| DayWindow::on(&self.place, date, None, None).ok());
                window.map_or(Vec::new(), |window| self.instants(window.from, 86_400.0))
            });
        }
    }

    fn instants(&self, from: DateTime<Zone>, length_secs: f64) -> Vec<Instant> {
        (0..=length_secs as i64).step_by(300).filter_map(|secs| self.instant(from + TimeDelta::seconds(secs))).collect()
    }

    /// Starts an animation of the whole day or year, which ends where it began; or stops it.
    pub(in crate::desktop) fn toggle(&mut self, play: Play) {
        self.play = if self.play == Some(play) { None } else { Some(play) };
        self.left = match play {
            Play::Day => self.length_secs,
            Play::Year => self.days_of_year(),
        };
    }

    fn days_of_year(&self) -> f64 {
        if self.date().leap_year() { 366.0 } else { 365.0 }
    }

    /// Advances the animation.
    pub(in crate::desktop) fn tick(&mut self, context: &egui::Context) {
        let Some(play) = self.play else { return };
        let passed = f64::from(context.input(|input| input.stable_dt)).min(0.5);
        match play {
            Play::Day => {
                // the clock has whole seconds
                let step = (passed * 5400.0).ceil().min(self.left);
                self.left -= step;
                self.set_secs((self.secs() + step) % self.length_secs);
            }
            Play::Year => {
                let from = f64::from(self.date().ordinal0());
                let step = (passed * 20.0).max(1.0).round().min(self.left);
                self.left -= step;
                let ordinal0 = (from + step) % self.days_of_year();
                if let Some(date) = NaiveDate::from_yo_opt(self.date().year(), ordinal0 as u32 + 1) {
                    self.set_date(date);
                }
            }
        }
        if self.left <= 0.0 {
            self.play = None;
        }
        context.request_repaint();
    }
}
