//! The sun against independent sources: NREL's paper, pvlib's SPA, the US Naval Observatory; then local time and
//! windows.

mod smooth;

use chrono::{DateTime, NaiveDate, NaiveTime, Timelike, Utc};
use gnomon::sun::{
    Air, Day, Place, Reading, SunError, SunTrack, Window, Zone, delta_t_secs, parse_duration_secs, position,
};
use proptest::prelude::*;

fn place(latitude_deg: f64, longitude_deg: f64, elevation_m: f64, zone: &str) -> Place {
    Place::new("", latitude_deg, longitude_deg, elevation_m, Some(zone)).expect("a place")
}

fn paris() -> Place {
    place(48.8583, 2.2945, 35.0, "Europe/Paris")
}

fn utc(text: &str) -> DateTime<Utc> {
    text.parse().expect("a UTC time")
}

fn date(text: &str) -> NaiveDate {
    text.parse().expect("a date")
}

fn reading(text: &str) -> Reading {
    text.parse().expect("a reading")
}

fn window(day: &str, from: &str, to: &str, step: &str) -> Window {
    Window {
        date: (!day.is_empty()).then(|| date(day)),
        from: reading(from),
        to: reading(to),
        step_secs: parse_duration_secs(step).expect("a duration"),
    }
}

fn track(place: &Place, day: &str, from: &str, to: &str, step: &str) -> Result<SunTrack, SunError> {
    SunTrack::window(place, &window(day, from, to, step), true)
}

fn near(value: f64, truth: f64, tolerance: f64, what: &str) {
    let off = (value - truth).abs();
    assert!(off <= tolerance, "{what}: {value} is not {truth}");
}

/// Reda and Andreas, "Solar position algorithm for solar radiation applications" (NREL/TP-560-34302), table A5.1.
#[test]
fn the_example_of_nrels_paper() {
    let golden = place(39.742476, -105.1786, 1830.14, "America/Denver");
    let air = Air { pressure_hpa: 820.0, temperature_c: 11.0 };
    let seen = position(&golden, utc("2003-10-17T19:30:30Z"), 67.0, Some(air)).unwrap();
    near(90.0 - seen.altitude_deg, 50.11162, 5e-6, "zenith");
    near(seen.azimuth_deg, 194.34024, 5e-6, "azimuth");
}

/// pvlib 0.16.1, nrel_numpy: P 1013.25 hPa, T 12 °C, ΔT 69.2 s.
#[test]
fn positions_of_pvlib() {
    #[rustfmt::skip]
    // UTC, latitude, longitude, elevation; zenith without refraction, azimuth, apparent elevation.
    let rows = [
        ("2026-03-21T12:00:00Z", 51.5074, -0.1278, 0.0, 51.18494, 177.54443, 38.83593),
        ("2026-03-21T08:00:00Z", 51.5074, -0.1278, 0.0, 72.73703, 112.48828, 17.31596),
        ("2026-06-21T15:00:00Z", 51.5074, -0.1278, 0.0, 44.00944, 247.54136, 46.00681),
        ("2026-01-17T11:00:00Z", 52.52, 13.405, 0.0, 73.30159, 175.98622, 16.75321),
        ("2026-02-08T07:00:00Z", 47.3769, 8.5417, 408.0, 88.06141, 114.73354, 2.22365),
        ("2026-02-08T11:00:00Z", 47.3769, 8.5417, 408.0, 62.93201, 169.15068, 27.10067),
        ("2026-11-03T11:00:00Z", 47.3769, 8.5417, 408.0, 62.55247, 177.44739, 27.47970),
        ("2026-12-21T17:00:00Z", 40.7128, -74.006, 0.0, 64.16660, 181.48021, 25.86787),
        ("2026-05-06T14:00:00Z", 40.7128, -74.006, 0.0, 44.22596, 110.02450, 45.79041),
        ("2026-06-20T23:00:00Z", -33.8688, 151.2093, 0.0, 71.07638, 42.56212, 18.97184),
        ("2026-06-21T05:00:00Z", -33.8688, 151.2093, 0.0, 71.96008, 316.25634, 18.09058),
        ("2026-01-20T04:00:00Z", 39.9042, 116.4074, 0.0, 60.32456, 173.16890, 29.70481),
        ("2026-12-22T03:00:00Z", 35.6762, 139.6503, 0.0, 59.30900, 185.39634, 30.71921),
        ("2026-03-21T05:15:00Z", 1.3521, 103.8198, 0.0, 1.35014, 214.45131, 88.65023),
        ("2026-06-20T22:00:00Z", 69.6492, 18.9553, 0.0, 86.55034, 349.47086, 3.65773),
        ("2026-03-21T06:15:00Z", 27.7172, 85.324, 1400.0, 27.58761, 174.09877, 62.42118),
    ];
    let air = Some(Air { pressure_hpa: 1013.25, temperature_c: 12.0 });
    for (time, latitude, longitude, elevation, zenith, azimuth, apparent) in rows {
        let there = place(latitude, longitude, elevation, "UTC");
        let bare = position(&there, utc(time), 69.2, None).unwrap();
        near(90.0 - bare.altitude_deg, zenith, 1e-3, time);
        near(bare.azimuth_deg, azimuth, 1e-3, time);
        let seen = position(&there, utc(time), 69.2, air).unwrap();
        near(seen.altitude_deg, apparent, 1e-3, time);
        let to_sun = seen.to_sun();
        near(to_sun.length(), 1.0, 1e-12, "length");
        near(to_sun.z.asin().to_degrees(), apparent, 1e-3, "up");
        let clockwise = to_sun.x.atan2(to_sun.y).to_degrees().rem_euclid(360.0);
        near(clockwise, azimuth, 1e-3, "clockwise from north");
    }
}

/// The polynomials' values as printed by Espenak and Meeus: they meet their 2050 and 2150 anchors (93 s, 328 s).
#[test]
fn delta_t_of_espenak_and_meeus() {
    let mid = |text| delta_t_secs(utc(text)).unwrap();
    // NASA/TP-2006-214141, table of observed values: 1955 31.1, 1990 56.9, 2000 63.8.
    near(mid("1955-01-01T00:00:00Z"), 31.1, 0.2, "1955");
    near(mid("1990-01-01T00:00:00Z"), 56.9, 0.2, "1990");
    near(mid("2000-01-01T00:00:00Z"), 63.8, 0.1, "2000");
    near(mid("2026-09-18T00:00:00Z"), 75.52, 0.05, "2026");
    near(mid("2049-12-18T00:00:00Z"), 93.0, 0.1, "2050");
    near(mid("2050-01-18T00:00:00Z"), 93.0, 0.2, "2050");
    near(mid("2150-01-18T00:00:00Z"), 328.5, 0.2, "2150");
    assert!(matches!(delta_t_secs(utc("1599-01-01T00:00:00Z")), Err(SunError::Year { .. })));
}

/// ISO 2533 (standard atmosphere): 1013.25 hPa at sea level, 898.76 hPa at 1000 m, 701.1 hPa at 3000 m.
#[test]
fn pressure_of_the_standard_atmosphere() {
    near(Air::standard(0.0).pressure_hpa, 1013.25, 1e-9, "0 m");
    near(Air::standard(1000.0).pressure_hpa, 898.76, 0.05, "1000 m");
    near(Air::standard(3000.0).pressure_hpa, 701.1, 0.1, "3000 m");
}

/// US Naval Observatory, rise and set tables: Golden CO (MST), Anchorage, Auckland, Singapore,
/// Longyearbyen (UT, 2020; `----` down all day, `****` up all day).
#[test]
fn sunrise_and_sunset_of_the_naval_observatory() {
    let golden = (39.742476, -105.1786, "Etc/GMT+7");
    let anchorage = (61.216667, -149.866667, "UTC");
    let auckland = (-36.833333, 174.8, "UTC");
    let singapore = (1.283333, 103.833333, "UTC");
    let svalbard = (78.216667, 15.633333, "UTC");
    #[rustfmt::skip]
    let rows = [
        (golden, "2015-01-01", "07:22", "16:47"),
        (golden, "2015-08-02", "05:00", "19:13"),
        (anchorage, "2020-01-01", "19:14", "00:51"),
        (anchorage, "2020-06-05", "12:29", "07:27"),
        (anchorage, "2020-12-09", "19:02", "00:43"),
        (auckland, "2020-01-01", "17:05", "07:43"),
        (auckland, "2020-06-11", "19:31", "05:11"),
        (singapore, "2020-04-25", "22:58", "11:07"),
        (singapore, "2020-11-25", "22:50", "10:53"),
        (svalbard, "2020-01-15", "", ""),
        (svalbard, "2020-02-16", "10:32", "11:54"),
        (svalbard, "2020-03-01", "07:23", "14:59"),
        (svalbard, "2020-06-21", "", ""),
        (svalbard, "2020-08-24", "23:50", "22:11"),
        (svalbard, "2020-10-25", "09:50", "11:31"),
        (svalbard, "2020-12-01", "", ""),
    ];
    // Half a minute of rounding, and 6 s where the sun grazes the horizon (Longyearbyen, 25 October).
    let agree = |found: Option<DateTime<Zone>>, printed: &str, what: &Day| {
        let Some(found) = found else {
            return assert_eq!("", printed, "{what:?}");
        };
        let truth = NaiveTime::parse_from_str(printed, "%H:%M").expect("a printed minute");
        let off = (found.time() - truth).num_seconds().abs();
        assert!(off <= 36, "{what:?} is {off} s from {printed}");
    };
    for ((latitude, longitude, zone), day, rise, set) in rows {
        let day = Day::of(&place(latitude, longitude, 0.0, zone), date(day)).unwrap();
        agree(day.sunrise, rise, &day);
        agree(day.sunset, set, &day);
        assert!(day.noon.is_some());
    }
    for (day, transit) in [("2015-01-01", "12:04"), ("2015-08-02", "12:07")] {
        let day = Day::of(&place(golden.0, golden.1, 0.0, golden.2), date(day)).unwrap();
        agree(day.noon, transit, &day);
    }
}

/// Two rises on one date (USNO, Longyearbyen 2020-04-16: 00:20, 23:57, set 21:55) make the first the sunrise.
#[test]
fn the_last_night_before_polar_day() {
    let svalbard = place(78.216667, 15.633333, 0.0, "UTC");
    let day = Day::of(&svalbard, date("2020-04-16")).unwrap();
    let hour_minute = |time: Option<DateTime<Zone>>| time.map(|t| (t.hour(), t.minute()));
    assert_eq!(hour_minute(day.sunrise).map(|t| t.0), Some(0));
    assert_eq!(hour_minute(day.sunset).map(|t| t.0), Some(21));
}

#[test]
fn events_lie_on_the_local_date() {
    for (latitude, longitude, zone) in [
        (-36.84, 174.74, "Pacific/Auckland"),
        (61.2167, -149.8667, "America/Anchorage"),
        (1.87, -157.4, "Pacific/Kiritimati"),
    ] {
        let there = place(latitude, longitude, 0.0, zone);
        for day in ["2026-01-10", "2026-04-05", "2026-06-21", "2026-10-31"].map(date) {
            let events = Day::of(&there, day).unwrap();
            let [rise, noon, set] = [events.sunrise, events.noon, events.sunset].map(Option::unwrap);
            assert!(rise < noon && noon < set, "{zone} {day}");
            for time in [rise, noon, set] {
                assert_eq!(time.date_naive(), day, "{zone}");
                assert_eq!(time.nanosecond(), 0);
            }
        }
    }
}

/// At noon the sun stands at 90° − |latitude − declination|, here 23.436° at the solstices.
#[test]
fn noon_altitude_at_the_solstices() {
    for (day, declination) in [("2026-06-21", 23.436), ("2026-12-21", -23.436)] {
        for latitude in [-45.0, 0.0, 35.0, 60.0] {
            let there = place(latitude, 0.0, 0.0, "UTC");
            let noon = Day::of(&there, date(day)).unwrap().noon.unwrap();
            let altitude = position(&there, noon.with_timezone(&Utc), 69.2, None).unwrap().altitude_deg;
            // Parallax takes up to 0.0024°.
            near(altitude, 90.0 - (latitude - declination).abs(), 0.005, day);
        }
    }
}

#[test]
fn a_plain_window() {
    let track = track(&paris(), "2026-09-18", "10:00", "14:00", "1h30").unwrap();
    let times: Vec<_> = track.instants.iter().map(|i| i.time.to_rfc3339()).collect();
    let hours = ["10:00", "11:30", "13:00", "14:00"].map(|t| format!("2026-09-18T{t}:00+02:00"));
    assert_eq!(times, hours);
    let weights: Vec<_> = track.instants.iter().map(|i| i.weight_secs).collect();
    assert_eq!(weights, [2700, 5400, 4500, 1800]);
    assert_eq!(track.window_secs(), 4 * 3600);
    assert_eq!((track.step_secs, track.days.len()), (5400, 1));
    assert!(track.refraction && track.instants.iter().all(|i| !i.night));
}

/// 3 s in steps of 1 s, then an odd rest: halves go to the later instant.
#[test]
fn half_seconds_go_to_the_later_instant() {
    let weights = |step: &str| {
        let track = track(&paris(), "2026-09-18", "10:00:00", "10:00:03", step).unwrap();
        track.instants.iter().map(|i| i.weight_secs).collect::<Vec<_>>()
    };
    assert_eq!(weights("1s"), [0, 1, 1, 1]);
    assert_eq!(weights("2s"), [1, 1, 1]);
    assert_eq!(weights("1h"), [1, 2]);
}

#[test]
fn windows_across_midnight_and_the_change_of_clocks() {
    let secs = |day, from, to| track(&paris(), day, from, to, "30min").unwrap().window_secs();
    assert_eq!(secs("2026-09-18", "22:00", "2:00"), 4 * 3600);
    assert_eq!(secs("2026-03-28", "22:00", "6:00"), 7 * 3600, "clocks go forward");
    assert_eq!(secs("2026-10-24", "22:00", "6:00"), 9 * 3600, "clocks go back");
    assert_eq!(secs("2026-10-25", "02:30+02:00", "02:30+01:00"), 3600);
    // On the date of `from` this `to` is read twice or never, but it means the day after.
    assert_eq!(secs("2026-10-25", "10:00", "2:30"), 16 * 3600 + 1800);
    assert_eq!(secs("2026-03-29", "10:00", "2:30"), 16 * 3600 + 1800);
    assert_eq!(secs("", "2026-10-25T02:30+01:00", "4:30"), 2 * 3600);
    assert_eq!(secs("", "2026-09-18T22:00", "2026-09-20T22:00"), 48 * 3600);
    let night = track(&paris(), "2026-09-18", "22:00", "2:00", "30min").unwrap();
    assert_eq!(night.days.len(), 2);
    assert!(night.instants.iter().all(|i| i.night && i.altitude_deg() < 0.0));
    let over = track(&paris(), "2026-09-18", "sunset-1h30", "sunrise", "1h").unwrap();
    assert_eq!(over.days.len(), 2);
    assert!(!over.instants[0].night);
}

#[test]
fn readings_that_count_from_the_sun() {
    let track = track(&paris(), "2026-09-18", "sunrise+1h30", "sunset-1h30", "30min").unwrap();
    let day = &track.days[0];
    let shift = chrono::TimeDelta::minutes(90);
    assert_eq!(track.instants[0].time, day.sunrise.unwrap() + shift);
    assert_eq!(track.instants.last().unwrap().time, day.sunset.unwrap() - shift);
    // At sea level's horizon the upper limb appears at −0.833° unrefracted.
    let bare = SunTrack::at(&paris(), &reading("sunrise"), Some(day.date), false).unwrap();
    near(bare.instants[0].altitude_deg(), -0.833, 0.005, "sunrise");
    assert!(bare.instants[0].night);
}

#[test]
fn one_instant_alone() {
    let track = SunTrack::at(&paris(), &reading("2026-09-18T15:00"), None, true).unwrap();
    assert_eq!(track.instants.len(), 1);
    assert_eq!(track.instants[0].time.to_rfc3339(), "2026-09-18T15:00:00+02:00");
    assert_eq!((track.instants[0].weight_secs, track.step_secs, track.days.len()), (0, 0, 1));
    let chosen = reading("2026-10-25T02:30+01:00");
    let track = SunTrack::at(&paris(), &chosen, None, true).unwrap();
    assert_eq!(track.instants[0].time.to_rfc3339(), "2026-10-25T02:30:00+01:00");
    let clock = SunTrack::at(&paris(), &reading("15:00"), None, true);
    assert!(matches!(clock, Err(SunError::NoDate { .. })));
    let other = SunTrack::at(&paris(), &chosen, Some(date("2026-10-26")), true);
    assert!(matches!(other, Err(SunError::TwoDates { .. })));
}

fn message(result: Result<SunTrack, SunError>) -> String {
    result.expect_err("an error").to_string()
}

#[test]
fn impossible_clock_times_name_both_readings() {
    let at = |text: &str| message(SunTrack::at(&paris(), &reading(text), None, true));
    let twice = at("2026-10-25T02:30");
    assert!(twice.contains("2026-10-25T02:30+02:00 and 2026-10-25T02:30+01:00"), "{twice}");
    let never = at("2026-03-29T02:30");
    assert!(never.contains("jump from 02:00:00 to 03:00:00"), "{never}");
    assert!(never.contains("2026-03-29T01:30+01:00 or 2026-03-29T03:30+02:00"), "{never}");
    let neither = at("2026-10-25T02:30+03:00");
    assert!(neither.contains("2026-10-25T02:30+02:00 or 2026-10-25T02:30+01:00"), "{neither}");
    let wrong = at("2026-07-01T12:00+01:00");
    assert!(wrong.contains("2026-07-01T12:00+02:00"), "{wrong}");
    // The hour lies in the window's end.
    let end = message(track(&paris(), "2026-10-24", "22:00", "2:30", "30min"));
    assert!(end.contains("exists twice"), "{end}");
    // A whole day was skipped in Samoa.
    let samoa = place(-13.83, -171.77, 0.0, "Pacific/Apia");
    let skipped = SunTrack::at(&samoa, &reading("2011-12-30T12:00"), None, true);
    assert!(matches!(skipped, Err(SunError::NoSuchTime { .. })));
}

#[test]
fn windows_that_are_none() {
    let bad = |from: &str, to: &str, step: &str| message(track(&paris(), "2026-09-18", from, to, step));
    assert!(bad("10:00", "10:00", "1h").contains("2026-09-19T10:00"));
    assert!(bad("10:00", "11:00", "0s").contains("step of 0"));
    assert!(bad("12:00", "2026-09-18T11:00", "1h").contains("before its beginning"));
    let year = message(track(&paris(), "", "2026-01-01T00:00", "2027-01-01T00:00", "1s"));
    assert!(year.contains("at least 32s"), "{year}");
    let long = message(track(&paris(), "", "2026-01-01T00:00", "2126-01-01T00:00", "1h"));
    assert!(long.contains("shorter"), "{long}");
    let far = message(track(&paris(), "9999-12-31", "10:00", "11:00", "1h"));
    assert!(far.contains("9999"), "{far}");
}

#[test]
fn polar_day_and_night_have_no_sunrise() {
    let tromso = place(69.6492, 18.9553, 0.0, "Europe/Oslo");
    let at = |text: &str| message(SunTrack::at(&tromso, &reading(text), None, true));
    let day = at("2026-06-21Tsunrise+1h30");
    assert!(day.contains("no sunrise") && day.contains("polar day"), "{day}");
    let night = at("2026-12-21Tsunset-1h");
    assert!(night.contains("no sunset") && night.contains("polar night"), "{night}");
    let around = track(&tromso, "2026-06-21", "0:00", "2026-06-22T00:00", "1h").unwrap();
    assert!(around.instants.iter().all(|i| !i.night));
    assert!(around.days[0].sunrise.is_none() && around.days[0].sunset.is_none());
    assert!(around.days[0].noon.is_some());
    let dark = track(&tromso, "2026-12-21", "0:00", "23:00", "1h").unwrap();
    assert!(dark.instants.iter().all(|i| i.night));
    for pole in [90.0, -90.0] {
        let there = place(pole, 0.0, 0.0, "UTC");
        assert!(track(&there, "2026-06-21", "0:00", "23:00", "1h").is_ok());
    }
}

#[test]
fn durations_and_readings_as_people_write_them() {
    for (text, secs) in [
        ("30min", 1800),
        ("1h", 3600),
        ("1h30", 5400),
        ("1h30min", 5400),
        ("1h05min10s", 3910),
        ("90s", 90),
        (" 2 h ", 7200),
    ] {
        assert_eq!(parse_duration_secs(text), Ok(secs), "{text}");
    }
    for text in ["", "30", "h", "1.5h", "-1h", "1h30m", "30s1h", "1min30", "99999999h", "1h30 30", "é"] {
        assert!(parse_duration_secs(text).is_err(), "{text}");
    }
    for text in ["9:00", "10:00:30", "sunrise", "sunset - 1h30", "02:30+01:00", "2026-09-18 15:00", "12:00Z"] {
        assert!(text.parse::<Reading>().is_ok(), "{text}");
    }
    for text in [
        "",
        "10",
        "24:00",
        "10:60",
        "10:0",
        "10:00:5",
        "noon",
        "sunrise1h",
        "sunrise+",
        "sunset--1h",
        "10:00+25:00",
        "2026-09-18",
        "2026-09-31T10:00",
        "2026-9-18T10:00",
        "10:00+01",
        "+10:00",
        "10:00:00.5",
        "−",
        "éééé",
        "20é6-01",
    ] {
        assert!(text.parse::<Reading>().is_err(), "{text}");
    }
}

#[test]
fn places_are_checked() {
    assert!(Place::new("", 90.1, 0.0, 0.0, None).is_err());
    assert!(Place::new("", f64::NAN, 0.0, 0.0, None).is_err());
    assert!(Place::new("", 0.0, f64::INFINITY, 0.0, None).is_err());
    assert!(Place::new("", 0.0, -180.5, 0.0, None).is_err());
    assert!(Place::new("", 0.0, 0.0, 10_000.0, None).is_err());
    let near = Place::new("", 48.0, 2.0, 0.0, Some("Europe/Pariss")).expect_err("no such zone");
    assert!(near.to_string().contains("\"Europe/Paris\""), "{near}");
    let lower = Place::new("", 48.0, 2.0, 0.0, Some("europe/paris")).expect_err("no such zone");
    assert!(lower.to_string().contains("\"Europe/Paris\""), "{lower}");
    for (latitude, longitude, zone) in [
        (48.8583, 2.2945, "Europe/Paris"),
        (-33.8568, 151.2153, "Australia/Sydney"),
        (40.6892, -74.0445, "America/New_York"),
        (0.0, -30.0, "Etc/GMT+2"),
    ] {
        let found = Place::new("", latitude, longitude, 0.0, None).unwrap();
        assert_eq!(found.time_zone.name(), zone);
    }
    for (latitude, longitude) in [(90.0, 180.0), (-90.0, -180.0), (0.0, 180.0), (0.0, -180.0)] {
        assert!(Place::new("", latitude, longitude, 0.0, None).is_ok(), "{latitude} {longitude}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn weights_add_up_and_time_runs_forward(
        day in 0_i64..365, from in 0_u32..86_400, length in 1_u32..200_000, step in 60_u32..20_000,
    ) {
        let clock = |secs: u32| format!("{:02}:{:02}:{:02}", secs / 3600, secs / 60 % 60, secs % 60);
        let first = date("2026-01-01") + chrono::TimeDelta::days(day);
        let last = (first + chrono::TimeDelta::days(i64::from((from + length) / 86_400))).to_string();
        let window = Window {
            date: Some(first),
            from: reading(&clock(from)),
            to: reading(&format!("{last}T{}", clock((from + length) % 86_400))),
            step_secs: step,
        };
        // The hours that clocks skip or repeat are errors, tested above.
        if let Ok(track) = SunTrack::window(&paris(), &window, true) {
            let [from, to] = window.bounds(&paris()).unwrap();
            prop_assert_eq!(track.window_secs() as i64, (to - from).num_seconds());
            prop_assert_eq!(track.instants[0].time, from);
            prop_assert_eq!(track.instants.last().unwrap().time, to);
            prop_assert!(track.instants.windows(2).all(|pair| pair[0].time < pair[1].time));
        }
    }

    #[test]
    fn no_text_panics(text in "\\PC{0,20}", clock in "[0-9:+TZhmins. −-]{0,20}") {
        let _ = text.parse::<Reading>();
        let _ = parse_duration_secs(&text);
        let _ = parse_duration_secs(&clock);
        if let Ok(reading) = clock.parse::<Reading>() {
            let _ = SunTrack::at(&paris(), &reading, Some(date("2026-03-29")), true);
        }
    }
}
