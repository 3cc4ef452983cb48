//! The days and windows of rules at a place.

use super::{calendar, hours, place, rule};
use chrono::{DateTime, NaiveDate, NaiveTime, TimeZone};
use gnomon::rules::{BUILT_IN, Dates, DayName, Rule, RuleClock, RuleDay, Spell, total_secs};
use gnomon::sun::{Place, Season};

fn date(year: i32, month: u32, day: u32) -> NaiveDate {
    NaiveDate::from_ymd_opt(year, month, day).expect("a date")
}

/// A day's windows on the place's clock.
fn clock(at: &Place, day: &RuleDay) -> Vec<[String; 2]> {
    let time = |secs| {
        let utc = DateTime::from_timestamp(secs, 0).expect("a time").naive_utc();
        at.time_zone.from_utc_datetime(&utc).format("%H:%M:%S").to_string()
    };
    day.windows.iter().map(|window| [time(window.start), time(window.end)]).collect()
}

/// A Polish rule's windows by each of its clocks.
#[test]
fn each_clock_reads_its_own_hours() {
    let at = place(52.23, 21.01, "Europe/Warsaw");
    let windows = |clock_word| {
        let days = rule("pl-wt-60", &[("clock", clock_word)]).calendar(&at, 2026).expect("days");
        assert_eq!(days.iter().map(|day| day.date).collect::<Vec<_>>(), [date(2026, 3, 20), date(2026, 9, 23)]);
        days.iter().map(|day| clock(&at, day).concat()).collect::<Vec<_>>()
    };
    assert_eq!(windows("legal"), [["07:00:00", "17:00:00"], ["07:00:00", "17:00:00"]]);
    // September has summer time: the standard clock is an hour behind it
    assert_eq!(windows("standard"), [["07:00:00", "17:00:00"], ["08:00:00", "18:00:00"]]);
    // 21°01′ E is 24 min ahead of the zone's meridian; the equation of time is −7:30 in March and +7:30 in September
    let solar = windows("true-solar");
    for (of, about) in solar.iter().zip([["06:43:26", "16:43:26"], ["07:28:20", "17:28:20"]]) {
        for (time, about) in of.iter().zip(about) {
            let parse = |text: &str| text.parse::<NaiveTime>().expect("a time");
            let off = (parse(time) - parse(about)).num_seconds();
            assert!(off.abs() <= 60, "{time} {about}");
        }
    }
}

/// Summer in the south is in January, and the standard clock is the same.
#[test]
fn standard_time_is_the_smaller_offset_of_the_year() {
    let seven = NaiveTime::from_hms_opt(7, 0, 0).expect("a time");
    let utc = |zone, month| {
        let time = RuleClock::Standard.at(&place(-33.0, 151.0, zone), date(2026, month, 10), seven).expect("a time");
        time.to_utc().format("%H:%M").to_string()
    };
    assert_eq!([1, 7].map(|month| utc("Australia/Sydney", month)), ["21:00", "21:00"]);
    assert_eq!([1, 7].map(|month| utc("Europe/Zurich", month)), ["06:00", "06:00"]);
    assert_eq!([1, 7].map(|month| utc("Europe/Dublin", month)), ["07:00", "07:00"]);
    assert_eq!([1, 7].map(|month| utc("Asia/Tokyo", month)), ["22:00", "22:00"]);
    let fixed = RuleClock::Fixed("-05:00".parse().expect("an offset"));
    let time = fixed.at(&place(40.7, -74.0, "America/New_York"), date(2026, 6, 21), seven).expect("a time");
    assert_eq!(time.format("%H:%M").to_string(), "08:00");
}

#[test]
fn a_time_that_clocks_skip_is_an_error() {
    let two = NaiveTime::from_hms_opt(2, 30, 0).expect("a time");
    let at = place(52.5, 13.4, "Europe/Berlin");
    assert!(RuleClock::Legal.at(&at, date(2026, 3, 29), two).is_err());
    assert!(RuleClock::Standard.at(&at, date(2026, 3, 29), two).is_ok());
}

#[test]
fn ranges_have_every_day_once() {
    let count = |id: &str| calendar(&rule(id, &[])).len();
    assert_eq!([count("nl-tno-light"), count("nl-tno-strict"), count("nl-the-hague")], [245, 306, 245]);
    assert_eq!(count("us-sf-295"), 365);
    let at = place(50.0, 8.0, "Europe/Berlin");
    let of = |first, last, year| {
        let range = [first, last].map(|(month, day)| DayName::MonthDay(month, day));
        Dates::Range(range).of(&at, year).expect("days")
    };
    // over New Year, and with a leap day
    let winter = of((11, 1), (2, 28), 2026);
    assert_eq!((winter[0], *winter.last().expect("days")), (date(2026, 11, 1), date(2027, 2, 28)));
    assert_eq!(winter.len(), 120);
    assert_eq!(of((1, 1), (12, 31), 2028).len(), 366);
    assert_eq!(of((3, 21), (3, 21), 2026), [date(2026, 3, 21)]);
    let seasons = Dates::Range([DayName::Season(Season::MarchEquinox), DayName::Season(Season::SeptemberEquinox)]);
    let seasons = seasons.of(&at, 2026).expect("days");
    assert_eq!((seasons[0], *seasons.last().expect("days")), (date(2026, 3, 20), date(2026, 9, 23)));
}

/// New York, 21 December, and the year of San Francisco: the numbers that tell which sunrise is meant.
#[test]
fn windows_that_begin_at_sunrise() {
    let at = place(40.7128, -74.006, "America/New_York");
    let days = rule("us-nyc-ceqr-shadows", &[]).calendar(&at, 2026).expect("days");
    assert_eq!(days.len(), 4);
    let [from, to] = &clock(&at, &days[0])[0];
    assert!(from.starts_with("08:51") && to.starts_with("14:5"), "{from} {to}");
    // summer days are told in the same clock: sunrise is at 4:25 by it
    let day = &days[3];
    let sunrise = DateTime::from_timestamp(day.windows[0].start - 5400, 0).expect("a time");
    assert!(sunrise.format("%H:%M").to_string().starts_with("09:"), "{sunrise}");
}

#[test]
fn a_window_without_room_or_without_sun_is_empty() {
    let text = |windows: &str| {
        let (_, nyc) = BUILT_IN.iter().find(|(id, _)| *id == "us-nyc-ceqr-shadows").expect("a rule");
        let text = nyc.replace("[[\"sunrise+1h30\", \"sunset-1h30\"]]", windows);
        Rule::parse("nyc", &text).expect("a rule").resolve(&[]).expect("options")
    };
    let north = place(69.65, 18.96, "Europe/Oslo");
    let days = |windows: &str, at: &Place| text(windows).calendar(at, 2026);
    // polar night in December
    let first = &days("[[\"sunrise\", \"15:00\"]]", &place(69.65, 18.96, "Europe/Oslo")).map(|days| days[0].clone());
    assert!(
        first.as_ref().is_err_and(|error| error.to_string().contains("polar day")),
        "June has no sunrise: {first:?}"
    );
    let south = place(40.7, -74.0, "America/New_York");
    let short = days("[[\"sunrise+6h\", \"sunset-6h\"]]", &south).expect("days");
    assert!(short[0].windows.is_empty() && total_secs(&short[3].windows) > hours(2));
    let twice = days("[[\"09:00\", \"11:00\"], [\"10:00\", \"12:00\"], [\"14:00\", \"15:00\"]]", &south).expect("days");
    let lengths: Vec<_> = twice[0].windows.iter().map(|window: &Spell| window.secs()).collect();
    assert_eq!(lengths, [hours(3), hours(1)]);
    let whole = days("\"day\"", &north).expect("days");
    assert!(whole.iter().all(|day| total_secs(&day.windows) == hours(24)));
}

#[test]
fn the_date_of_great_cold_is_that_of_beijing() {
    let given = [("day", "great-cold"), ("hours", "2h")];
    let days = calendar(&rule("cn-gb-50180-dwelling", &given));
    assert_eq!(days[0].date, date(2026, 1, 20));
    assert_eq!(total_secs(&days[0].windows), hours(8) + 6, "{:?}", days[0].windows);
    let solstice = calendar(&rule("cn-gb-50180-dwelling", &[("day", "december-solstice"), ("hours", "1h")]));
    assert_eq!(solstice[0].date, date(2026, 12, 22));
    assert!((total_secs(&solstice[0].windows) - hours(6)).abs() < 15);
}

/// EN 17037's day is any of its range, and none beyond.
#[test]
fn a_named_day_lies_in_the_range() {
    let (id, text) = BUILT_IN.iter().find(|(id, _)| *id == "eu-en-17037-sunlight").expect("a rule");
    let rule = Rule::parse(id, text).expect("a rule");
    let days = |date| rule.resolve(&[("above", "DE"), ("date", date)]).map(|rule| calendar(&rule).len());
    assert_eq!(days("best"), Ok(49));
    assert_eq!(days("02-14"), Ok(1));
    assert_eq!(days("march-equinox"), Ok(1));
    assert!(days("03-22").is_err() && days("01-31").is_err() && days("worst").is_err());
    let without = rule.resolve(&[]).expect_err("no altitude").to_string();
    assert!(without.contains("`above`") && !without.contains("`date`"), "{without}");
}
