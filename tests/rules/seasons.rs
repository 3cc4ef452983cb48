//! Equinoxes, solstices and solar time against published times.

use super::place;
use chrono::{DateTime, NaiveDate, NaiveTime, TimeDelta, Utc};
use gnomon::sun::{Day, Season, Sunrise, apparent_longitude_deg, true_solar};

fn utc(text: &str) -> DateTime<Utc> {
    format!("{}Z", text.replace(' ', "T")).parse().expect("a time")
}

fn date(year: i32, month: u32, day: u32) -> NaiveDate {
    NaiveDate::from_ymd_opt(year, month, day).expect("a date")
}

/// The table of equinoxes and solstices that encyclopaedias print to the second, UTC.
const PUBLISHED: [[&str; 4]; 5] = [
    ["2010-03-20 17:32:13", "2010-06-21 11:28:25", "2010-09-23 03:09:02", "2010-12-21 23:38:28"],
    ["2019-03-20 21:58:25", "2019-06-21 15:54:14", "2019-09-23 07:50:10", "2019-12-22 04:19:25"],
    ["2024-03-20 03:06:21", "2024-06-20 20:50:56", "2024-09-22 12:43:36", "2024-12-21 09:20:30"],
    ["2026-03-20 14:45:53", "2026-06-21 08:24:26", "2026-09-23 00:05:08", "2026-12-21 20:50:09"],
    ["2030-03-20 13:51:58", "2030-06-21 07:31:11", "2030-09-22 23:26:46", "2030-12-21 20:09:30"],
];

#[test]
fn equinoxes_and_solstices_are_as_published() {
    let seasons = [Season::MarchEquinox, Season::JuneSolstice, Season::SeptemberEquinox, Season::DecemberSolstice];
    for row in PUBLISHED {
        for (season, text) in seasons.iter().zip(row) {
            let published = utc(text);
            let year = text[..4].parse().expect("a year");
            let off = (season.time(year).expect("a time") - published).num_seconds();
            assert!(off.abs() <= 30, "{season:?} of {text}: {off} s");
        }
    }
}

/// 大寒 of three years, Beijing time, as Chinese calendars print it.
#[test]
fn great_cold_is_as_published() {
    for (year, text) in [
        (2021, "2021-01-20 04:39:42"),
        (2024, "2024-01-20 22:07:08"),
        (2025, "2025-01-20 03:59:52"),
        (2026, "2026-01-20 09:44:39"),
    ] {
        let published = utc(text) - TimeDelta::hours(8);
        let off = (Season::GreatCold.time(year).expect("a time") - published).num_seconds();
        assert!(off.abs() <= 30, "{text}: {off} s");
    }
}

/// Meeus, Astronomical Algorithms, example 25.b: 1992 October 13.0 TD, by VSOP87.
#[test]
fn longitude_is_that_of_the_book() {
    let time = utc("1992-10-13 00:00:00") - TimeDelta::seconds(59);
    let longitude = apparent_longitude_deg(time).expect("a longitude");
    assert!((longitude - (199.0 + 54.0 / 60.0 + 21.818 / 3600.0)).abs() < 1.0 / 3600.0, "{longitude}");
}

#[test]
fn a_season_falls_on_the_local_date() {
    // 2026-09-23 00:05 UTC
    let autumn = |zone| Season::SeptemberEquinox.date(&place(45.0, 0.0, zone), 2026).expect("a date");
    assert_eq!(autumn("Europe/Paris"), date(2026, 9, 23));
    assert_eq!(autumn("America/New_York"), date(2026, 9, 22));
    assert!(Season::GreatCold.time(1599).is_err() && Season::GreatCold.time(3000).is_err());
    for year in [1600, 1999, 2999] {
        assert!(
            Season::GreatCold.time(year).is_ok_and(|time| time.to_string().starts_with(&year.to_string())),
            "{year}"
        );
    }
}

/// Noons at 135°30′ E that the city of Sakai publishes for its sun-shadow drawings.
#[test]
fn noon_of_a_sundial_is_as_published() {
    let at = place(34.57, 135.5, "Asia/Tokyo");
    let published = [
        (1, 1, "12:01:15"),
        (1, 18, "12:08:15"),
        (2, 1, "12:11:30"),
        (2, 11, "12:12:15"),
        (3, 1, "12:10:35"),
        (3, 18, "12:06:20"),
        (4, 1, "12:02:10"),
        (5, 1, "11:55:10"),
        (6, 1, "11:55:40"),
    ];
    for (month, day, text) in published {
        let time = true_solar(&at, date(2011, month, day), 43_200).expect("a time").expect("a noon");
        let noon: NaiveTime = text.parse().expect("a time");
        let off = (time.time() - noon).num_seconds();
        assert!(off.abs() <= 20, "{month}-{day}: {time}");
    }
}

/// True solar 8:00 on Great Cold in Beijing time, of a Chinese paper that does not say its year and coordinates.
#[test]
fn eight_o_clock_on_great_cold_is_as_published() {
    let cities = [
        (39.9, 116.40, "08:25:30"),
        (41.8, 123.46, "07:57:02"),
        (34.27, 108.95, "08:55:06"),
        (43.8, 87.65, "10:20:18"),
        (23.13, 113.27, "08:37:54"),
    ];
    for (latitude, longitude, text) in cities {
        let at = place(latitude, longitude, "Asia/Shanghai");
        let day = Season::GreatCold.date(&at, 2001).expect("a date");
        let time = true_solar(&at, day, 8 * 3600).expect("a time").expect("a time");
        let off = (time.time() - text.parse::<NaiveTime>().expect("a time")).num_seconds();
        assert!(off.abs() <= 15, "{longitude}: {time}, {off} s");
    }
}

#[test]
fn a_sundial_runs_on_from_noon_to_noon() {
    let at = place(39.9, 116.4, "Asia/Shanghai");
    let day = date(2026, 1, 20);
    let time = |day, secs| true_solar(&at, day, secs).expect("a time").expect("a time");
    // the midnight between two days is one instant
    let midnight = time(day, 86_400) - time(day.succ_opt().expect("a date"), 0);
    assert!(midnight.num_seconds().abs() <= 1, "{midnight}");
    for secs in [0, 1, 43_199, 43_201, 86_399] {
        assert!(time(day, secs) < time(day, secs + 1));
    }
}

/// A sunrise is the upper limb's, or the centre's without refraction: some minutes apart.
#[test]
fn two_sunrises_are_apart() {
    let at = place(40.7128, -74.006, "America/New_York");
    let of = |sunrise| Day::by(&at, date(2026, 12, 21), sunrise).expect("a day");
    let (almanac, geometric) = (of(Sunrise::Almanac), of(Sunrise::Geometric));
    assert_eq!(almanac, Day::of(&at, date(2026, 12, 21)).expect("a day"));
    let apart = (geometric.sunrise.expect("up") - almanac.sunrise.expect("up")).num_seconds();
    let evening = (almanac.sunset.expect("down") - geometric.sunset.expect("down")).num_seconds();
    assert!((270..330).contains(&apart) && (270..330).contains(&evening), "{apart} {evening}");
    assert_eq!(almanac.noon, geometric.noon);
}
