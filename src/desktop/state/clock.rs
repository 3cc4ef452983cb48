//! The instant that is shown, and what the sun does around it.

use crate::sun::{Air, Day, DayWindow, Instant, Place, Sky, Zone, delta_t_secs};
use chrono::{DateTime, Datelike, Days, NaiveDate, NaiveTime, TimeDelta, TimeZone, Timelike};
use eframe::egui;

/// What plays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::desktop) enum Play {
    /// The hours of the day.
    Day,
    /// The days of the year, at one hour.
    Year,
}

/// The instant that is shown, and what the sun does around it.
#[derive(Clone)]
pub(in crate::desktop) struct Clock {
    pub(in crate::desktop) place: Place,
    refraction: bool,
    /// The instant.
    pub(in crate::desktop) now: Instant,
    /// The first instant of its date.
    pub(in crate::desktop) midnight: DateTime<Zone>,
    /// How long that date is, seconds: not always 24 h.
    pub(in crate::desktop) length_secs: f64,
    /// Sunrise, noon, sunset.
    pub(in crate::desktop) events: Day,
    /// The date's instants, five minutes apart.
    pub(in crate::desktop) day: Vec<Instant>,
    /// Its full hours.
    pub(in crate::desktop) hours: Vec<(u32, Instant)>,
    /// The same for the solstices of the year.
    pub(in crate::desktop) solstices: [Vec<Instant>; 2],
    year: Option<i32>,
    /// What is typed into the fields while it is.
    pub(in crate::desktop) typed: [Option<String>; 2],
    /// Why what was typed is no time.
    pub(in crate::desktop) fault: Option<String>,
    /// What plays.
    pub(in crate::desktop) play: Option<Play>,
    /// How much of it is left: seconds of the day, or days of the year.
    left: f64,
    /// The clock time that was asked for, which other dates keep, though some skip it.
    clock_time: NaiveTime,
}

impl Clock {
    /// A clock at a place, that shows an instant.
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

    /// The date that is shown.
    pub(in crate::desktop) fn date(&self) -> NaiveDate {
        self.now.time.date_naive()
    }

    /// Whether it already stands at this place.
    pub(in crate::desktop) fn is_at(&self, place: &Place, refraction: bool) -> bool {
        self.place == *place && self.refraction == refraction
    }

    fn instant(&self, time: DateTime<Zone>) -> Option<Instant> {
        let air = self.refraction.then(|| Air::standard(self.place.elevation_m));
        Sky { place: &self.place, delta_t_secs: delta_t_secs(time.to_utc()).ok()?, air }.at(time).ok()
    }

    /// Shows another instant; one for which the sun is not known (before 1600, after 2999) is not taken.
    pub(in crate::desktop) fn set(&mut self, time: DateTime<Zone>) {
        if let Some(instant) = self.instant(time) {
            // what could not be read is past
            self.fault = None;
            let turns = instant.time.date_naive() != self.date();
            self.clock_time = instant.time.time();
            self.now = instant;
            if turns {
                self.turn_day();
            }
        }
    }

    /// Shows so many seconds of the date.
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

    /// Moves by so many seconds.
    pub(in crate::desktop) fn step_secs(&mut self, secs: i64) {
        self.set(self.now.time + TimeDelta::seconds(secs));
    }

    /// Moves by so many days, at the same clock time.
    pub(in crate::desktop) fn step_days(&mut self, days: i64) {
        let days_on = Days::new(days.unsigned_abs());
        let date = if days < 0 { self.date().checked_sub_days(days_on) } else { self.date().checked_add_days(days_on) };
        if let Some(date) = date {
            self.set_date(date);
        }
    }

    /// How many seconds of its date have passed.
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

    /// Plays the whole day or the whole year, round to where it began; or stops.
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

    /// Moves on what plays.
    pub(in crate::desktop) fn tick(&mut self, context: &egui::Context) {
        let Some(play) = self.play else { return };
        let passed = f64::from(context.input(|input| input.stable_dt)).min(0.5);
        match play {
            Play::Day => {
                // whole seconds, as the clock has no others
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
