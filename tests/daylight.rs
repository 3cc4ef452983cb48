//! Only seconds with the sun up are counted, at any step: against pvlib, and consistently in all results.

use crate::shared::program::{PLACE, done, fails, gnomon, site, stderr};
use chrono::{NaiveDate, TimeDelta, Timelike};
use gnomon::sun::{EachDay, Place, SunError, SunTrack, Window};
use serde_json::Value;
use std::fs;
use std::path::Path;

const MINUTE: u32 = 60;
const HOUR: u32 = 3600;
const STEPS: [u32; 7] = [MINUTE, 7 * MINUTE, 30 * MINUTE, HOUR, HOUR + 30 * MINUTE, 2 * HOUR, 3 * HOUR];

fn place(latitude: f64, longitude: f64, elevation: f64, zone: &str) -> Place {
    Place::new("", latitude, longitude, elevation, Some(zone)).unwrap()
}

fn tromso() -> Place {
    place(69.65, 18.96, 0.0, "Europe/Oslo")
}

fn vienna() -> Place {
    place(48.2, 16.38, 0.0, "Europe/Vienna")
}

/// A window on each of some days; whole days where nothing is written.
fn days(place: &Place, first: &str, count: usize, [from, to]: [&str; 2], step_secs: u32, refraction: bool) -> SunTrack {
    let dates: Vec<NaiveDate> = first.parse::<NaiveDate>().unwrap().iter_days().take(count).collect();
    let reading = |text: &str| (!text.is_empty()).then(|| text.parse().unwrap());
    let each = EachDay { from: reading(from), to: reading(to) };
    SunTrack::days(place, &dates, each, step_secs, refraction).unwrap()
}

fn one(place: &Place, date: &str, [from, to]: [&str; 2], step_secs: u32) -> SunTrack {
    let [from, to] = [from, to].map(|text| text.parse().unwrap());
    let window = Window { date: Some(date.parse().unwrap()), from, to, step_secs };
    SunTrack::window(place, &window, true).unwrap()
}

fn by_day(track: &SunTrack) -> f64 {
    track.instants.iter().filter(|it| !it.night).map(|it| f64::from(it.weight_secs)).sum()
}

fn near(track: &SunTrack, truth: f64, tolerance: f64, what: &str) {
    let found = by_day(track);
    assert!((found - truth).abs() <= tolerance, "{what}: {found} s of sun are not {truth} s");
    assert!(track.instants.windows(2).all(|pair| pair[0].time < pair[1].time), "{what}");
}

const WHOLE: [&str; 2] = ["", ""];
const SUN: [&str; 2] = ["sunrise", "sunset"];

/// pvlib 0.16.1, `spa.solar_position_numpy` (P of the standard atmosphere at the elevation, T 12 °C, ΔT of Espenak and
/// Meeus), its roots by SciPy's `brentq`: the seconds of a local date on which the apparent elevation is at least
/// −0.000005°; without refraction the elevation.
#[test]
fn days_have_pvlibs_daylight() {
    let vienna = vienna();
    let tromso = tromso();
    let ushuaia = place(-54.8, -68.3, 20.0, "America/Argentina/Ushuaia");
    let la_paz = place(-16.5, -68.15, 3640.0, "America/La_Paz");
    let quito = place(-0.18, -78.47, 2850.0, "America/Guayaquil");
    let svalbard = place(78.22, 15.65, 10.0, "Arctic/Longyearbyen");
    let dead_sea = place(31.5, 35.5, -430.0, "Asia/Jerusalem");
    let auckland = place(-36.84, 174.74, 0.0, "Pacific/Auckland");
    #[rustfmt::skip]
    let rows = [
        (&vienna, "2026-03-21", 43780.0, 43368.6), (&vienna, "2026-06-21", 57643.6, 57128.2),
        (&vienna, "2026-09-18", 44548.8, 44137.0), (&vienna, "2026-12-21", 29797.1, 29286.8),
        (&tromso, "2026-03-21", 44405.2, 43616.5), (&tromso, "2026-06-21", 86400.0, 86400.0),
        (&tromso, "2026-09-18", 46273.2, 45480.7), (&tromso, "2026-12-21", 0.0, 0.0),
        (&ushuaia, "2026-06-21", 25649.5, 24999.9), (&ushuaia, "2026-12-21", 62080.5, 61418.8),
        (&la_paz, "2026-03-21", 43299.3, 43129.2), (&la_paz, "2026-06-21", 39850.2, 39663.3),
        (&quito, "2026-09-18", 43368.3, 43185.6), (&quito, "2026-12-21", 43450.2, 43251.0),
        (&svalbard, "2026-03-21", 45299.8, 43956.9), (&svalbard, "2026-09-18", 48629.7, 47267.6),
        (&dead_sea, "2026-06-21", 50988.5, 50601.1), (&dead_sea, "2026-12-21", 36202.2, 35816.2),
        (&auckland, "2026-06-21", 34500.3, 34106.4), (&auckland, "2026-12-21", 52707.9, 52312.0),
    ];
    for (place, date, refracted, bare) in rows {
        for (refraction, truth) in [(true, refracted), (false, bare)] {
            for step in STEPS {
                let what = format!("{} {date}, step {step}, refraction {refraction}", place.time_zone.name());
                near(&days(place, date, 1, WHOLE, step, refraction), truth, 2.0, &what);
                near(&days(place, date, 1, SUN, step, refraction), truth, 2.0, &format!("{what}, from sunrise"));
            }
        }
    }
}

/// As above, between two clock times.
#[test]
fn windows_over_a_sunrise_have_pvlibs_daylight() {
    let ushuaia = place(-54.8, -68.3, 20.0, "America/Argentina/Ushuaia");
    for (place, date, window, truth) in [
        (vienna(), "2026-03-21", ["5:30", "7:00"], 3765.1),
        // the hour is read twice in between
        (vienna(), "2026-10-25", ["0:30", "7:15"], 2668.8),
        (ushuaia, "2026-06-21", ["16:00", "22:00"], 4128.5),
        // the sun sets and rises
        (tromso(), "2026-05-18", ["22:00", "4:00"], 19251.7),
    ] {
        for step in STEPS {
            let track = one(&place, date, window, step);
            near(&track, truth, 2.0, &format!("{date} {window:?}, step {step}"));
            let [from, to] = [&track.instants[0], &track.instants[track.instants.len() - 1]].map(|it| it.time);
            assert_eq!(track.window_secs() as i64, (to - from).num_seconds(), "night and day are the window");
        }
    }
}

/// As above, for all of 2026: the README's year on the headquarters, Tromsø's, and Longyearbyen's.
#[test]
fn years_have_pvlibs_daylight() {
    let headquarters = place(48.2, 16.38, 165.0, "Europe/Vienna");
    for step in [10 * MINUTE, 30 * MINUTE, HOUR, 3 * HOUR] {
        // 4,448.15 h; each day is right to 2 s, and most are nearer
        near(&days(&headquarters, "2026-01-01", 365, SUN, step, true), 16_013_357.0, 120.0, "headquarters");
    }
    let svalbard = place(78.22, 15.65, 10.0, "Arctic/Longyearbyen");
    for window in [SUN, WHOLE, ["sunrise-20min", "sunset+20min"]] {
        for step in [20 * MINUTE, HOUR, 3 * HOUR] {
            let what = format!("{window:?}, step {step}");
            near(&days(&tromso(), "2026-01-01", 365, window, step, true), 16_372_992.6, 120.0, &what);
            near(&days(&svalbard, "2026-01-01", 365, window, step, true), 16_351_075.8, 120.0, &what);
        }
    }
}

/// pvlib, as above: days around the polar night and day of Tromsø, whose light or night is shorter than a step.
#[test]
fn light_and_night_between_two_instants_are_not_lost() {
    for (date, truth) in [
        ("2026-01-16", 1581.0),
        ("2026-01-17", 4291.4),
        ("2026-11-25", 3263.4),
        ("2026-05-18", 81_587.2),
        ("2026-05-19", 84_051.7),
        ("2026-07-25", 83_858.9),
        ("2026-07-26", 81_336.2),
    ] {
        // far longer steps, too: the light of several days then lies between two instants
        for step in STEPS.into_iter().chain([5 * HOUR, 12 * HOUR, 24 * HOUR, 100 * HOUR]) {
            let track = days(&tromso(), date, 1, WHOLE, step, true);
            near(&track, truth, 2.0, &format!("{date}, step {step}"));
            assert!(track.instants.iter().any(|it| !it.night), "{date}");
        }
    }
    let week = |step| days(&vienna(), "2026-06-15", 7, WHOLE, step, true);
    near(&week(200 * HOUR), by_day(&week(HOUR)), 7.0, "a week in one step");
    // an instant in the middle of the light between two nights
    let short = one(&tromso(), "2026-01-16", ["10:00", "16:00"], 3 * HOUR);
    let added: Vec<_> = short.instants.iter().filter(|it| it.time.minute() != 0).collect();
    assert_eq!((added.len(), short.instants.len()), (1, 4), "{short:?}");
    assert!(!added[0].night && added[0].weight_secs.abs_diff(1581) <= 2);
}

/// Where no time between two instants has a sunrise or a sunset, weights are the trapezoid rule's.
#[test]
fn by_day_nothing_is_cut() {
    let track = one(&vienna(), "2026-09-18", ["9:00", "17:00"], HOUR);
    let weights: Vec<_> = track.instants.iter().map(|it| it.weight_secs).collect();
    assert_eq!(weights, [1800, 3600, 3600, 3600, 3600, 3600, 3600, 3600, 1800]);
}

#[test]
fn windows_bound_to_the_sun_in_polar_day_and_night() {
    let day = one(&tromso(), "2026-06-21", SUN, HOUR);
    assert_eq!((day.window_secs(), by_day(&day), day.instants.len()), (86_400, 86_400.0, 25));
    assert_eq!(day.instants[0].time.to_rfc3339(), "2026-06-21T00:00:00+02:00");
    // there is no sunrise to count from: what is bound to it is the day's own bound
    let shifted = one(&tromso(), "2026-06-21", ["sunrise+1h30", "15:00"], HOUR);
    assert_eq!((shifted.instants[0].time.hour(), by_day(&shifted)), (0, 15.0 * 3600.0));
    assert_eq!(by_day(&one(&tromso(), "2026-06-21", ["10:00", "sunset-1h"], HOUR)), 14.0 * 3600.0);
    let [from, to] = ["sunset-2h", "sunset"].map(|text| text.parse().unwrap());
    let window = Window { date: "2026-06-21".parse().ok(), from, to, step_secs: HOUR };
    let told = SunTrack::window(&tromso(), &window, true).unwrap_err().to_string();
    assert!(told.contains("nothing from sunset-2h to sunset") && told.contains("polar day"), "{told}");

    let night = one(&tromso(), "2026-12-21", SUN, HOUR);
    assert_eq!((night.window_secs(), night.instants.len()), (0, 1));
    assert!(night.instants[0].night && Some(night.instants[0].time) == night.days[0].noon);
    assert_eq!(by_day(&one(&tromso(), "2026-12-21", ["10:00", "sunset-1h"], HOUR)), 0.0);
    let dark = days(&tromso(), "2026-12-01", 31, ["sunrise+1h", "sunset-1h"], HOUR, true);
    assert_eq!((by_day(&dark), dark.instants.len(), dark.days.len()), (0.0, 31, 31));

    // the last night before polar day: the sun rises, and is up at midnight; the next day is whole
    let ends = |date: &str| one(&tromso(), date, SUN, HOUR).instants.last().unwrap().time.to_rfc3339();
    assert_eq!(ends("2026-05-18"), "2026-05-19T00:00:00+02:00");
    // two nights earlier it sets after midnight, which is that day's sunset
    assert_eq!(ends("2026-05-16"), "2026-05-17T00:02:45+02:00");
}

/// A window that is bound to the sun at one end alone has the light of its dates: as much as from sunrise to sunset, cut.
#[test]
fn one_end_at_the_sun_is_that_of_the_dates_light() {
    // the sun sets after midnight, or before noon, or not at all
    for (place, first, count) in [
        (place(65.5, 18.0, 0.0, "Europe/Stockholm"), "2026-06-14", 4),
        (tromso(), "2026-05-10", 90),
        (tromso(), "2026-11-15", 80),
        (vienna(), "2026-12-10", 4),
    ] {
        let sums = |[from, to]: [&str; 2]| {
            let dates: Vec<NaiveDate> = first.parse::<NaiveDate>().unwrap().iter_days().take(count).collect();
            let each = EachDay { from: from.parse().ok(), to: to.parse().ok() };
            match SunTrack::days(&place, &dates, each, HOUR, true) {
                Ok(track) => by_day(&track),
                Err(SunError::NoWindow { .. }) => 0.0,
                Err(error) => panic!("{first}, {from} to {to}: {error}"),
            }
        };
        let whole = sums(SUN);
        // cut anywhere in the day both parts are the whole, and at an hour when the sun is down one of them is
        for clock in ["12:00", "15:00", "16:30", "8:00"] {
            let parts = sums(["sunrise", clock]) + sums([clock, "sunset"]);
            assert!((parts - whole).abs() <= 2.0 * count as f64, "{first}, {clock}: {parts} and {whole}");
        }
    }
    let window = |from: &str, to: &str| {
        let [from, to] = [from, to].map(|text| text.parse().unwrap());
        let window = Window { date: "2026-12-10".parse().ok(), from, to, step_secs: HOUR };
        SunTrack::window(&vienna(), &window, true).unwrap_err().to_string()
    };
    assert!(window("16:30", "sunset").contains("the sun has set by then"));
    assert!(window("sunrise", "7:00").contains("the sun rises later"));
}

/// Where the clock's midnight is by day the light from a sunrise to its sunset lies on two dates, and is that of the first.
#[test]
fn light_over_midnight_belongs_to_the_sunrise() {
    let anchorage = place(61.2167, -149.8667, 30.0, "UTC");
    let there = days(&anchorage, "2026-03-20", 3, SUN, HOUR, true);
    let alone = one(&anchorage, "2026-03-20", SUN, HOUR);
    assert_eq!(there.instants[..alone.instants.len()], alone.instants);
    let local = place(61.2167, -149.8667, 30.0, "America/Anchorage");
    near(&there, by_day(&days(&local, "2026-03-20", 3, SUN, HOUR, true)), 3.0, "three days");
}

const AT: &str = "--date 2026-03-21 --from 5:00 --to 9:00";

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

/// The seconds by day of a report's instants.
fn of_instants(report: &Value) -> u64 {
    let by_day = report["instants"].as_array().unwrap().iter().filter(|it| it["night"] == false);
    by_day.map(|it| it["weight_secs"].as_u64().unwrap()).sum()
}

fn vienna_site(folder: &Path) {
    let place = "[place]\nlatitude = 48.2\nlongitude = 16.38\nelevation = 165.0\n";
    fs::write(folder.join("site.toml"), format!("{place}[[model]]\npath = \"tower.glb\"\n")).unwrap();
}

/// pvlib, as above: 10,960.3 s of the sun on this morning in Vienna, 165 m above the sea.
#[test]
fn every_answer_counts_the_same_light() {
    let folder = site();
    let path = folder.path();
    vienna_site(path);
    for step in ["1h", "7min", "3h"] {
        let asked = format!("{AT} --step {step}");
        let plan = format!("--engine cpu --region -20,-20,20,20 --cell 2 {asked}");
        let said = done(path, &format!("profile . {plan} --bits --quiet"));
        assert!(said.contains("out of 3.04 h with the sun above the horizon"), "{said}");
        let profile = json(&fs::read_to_string(path.join("out/profile.json")).unwrap());
        let secs = of_instants(&profile);
        assert!(secs.abs_diff(10_960) <= 2, "{secs}");
        let bits = fs::read(path.join("out/shadow.bits")).unwrap();
        let begin = u64::from_le_bytes(bits[8..16].try_into().unwrap()) as usize;
        assert_eq!(of_instants(&json(std::str::from_utf8(&bits[16..begin]).unwrap())), secs, "bits");
        assert_eq!(of_instants(&json(&done(path, &format!("sun . {asked} --json")))), secs, "sun");
        let animated = done(path, &format!("animate . {plan} --out frames --width 320 --json"));
        assert_eq!(of_instants(&json(&animated)), secs, "animate");
        let surfaces =
            format!("profile . --receivers surfaces --engine cpu --patch-cell 2 {asked} --write json --json");
        let surfaces = json(&done(path, &surfaces));
        assert_eq!(of_instants(&surfaces), secs, "surfaces");
        let most = surfaces["components"][0]["hours_max"].as_f64().unwrap();
        assert!((most * 3600.0 - secs as f64).abs() < 1.0, "the roof has it all: {most}");
        let compared = json(&done(path, &format!("compare site.toml site.toml {plan} --json")));
        assert_eq!(of_instants(&compared), secs, "compare");
        let probe = "probe . --point 0,0,50 --date 2026-03-21 --from 5:00 --to 9:00 --json";
        let probed = json(&done(path, probe));
        assert!(probed["probes"][0]["seconds"].as_u64().unwrap().abs_diff(secs) <= 1, "probe: {probed}");
    }
    // light that is shorter than half an hour
    let site = "--place 69.65,18.96 --point 0,0,50 --date 2026-01-16 --json";
    let probed = json(&done(path, &format!("probe tower.glb {site}")));
    assert!(probed["probes"][0]["seconds"].as_u64().unwrap().abs_diff(1581) <= 2, "{probed}");
}

/// A whole site in polar night and day, for one date and for many; and no message names an option that was not given.
#[test]
fn studies_work_through_polar_night() {
    let folder = site();
    let path = folder.path();
    let study = |name: &str, dates: &str| {
        let place = "[place]\nlatitude = 69.65\nlongitude = 18.96\n";
        let study = format!("[study]\n{dates}\nfrom = \"sunrise\"\nto = \"sunset\"\nstep = \"1h\"\n");
        fs::write(path.join(name), format!("{place}[[model]]\npath = \"tower.glb\"\n{study}")).unwrap();
    };
    study("night.toml", "date = 2026-12-21");
    study("winter.toml", "dates = [2026-11-20, 2026-12-20]");
    let plan = "--engine cpu --region -20,-20,20,20 --cell 2";
    let output = gnomon(path, &format!("profile night.toml {plan} --bits --masks masks"));
    let [told, said] = [stderr(&output), String::from_utf8(output.stdout).unwrap()];
    assert!(told.contains("no sun on 2026-12-21 (polar night)"), "{told}");
    assert!(said.contains("out of 0.00 h with the sun") && said.contains("1 of them at night"), "{said}");
    assert!(image::open(path.join("masks/mask-0000.png")).unwrap().to_luma8().pixels().all(|share| share.0 == [0]));
    let output = gnomon(path, &format!("profile winter.toml {plan}"));
    let told = stderr(&output);
    assert_eq!(output.status.code(), Some(0), "{told}");
    assert!(told.contains("no sun on 23 of 31 days (polar night)"), "{told}");
    done(path, &format!("animate night.toml {plan} --width 320 --out frames"));
    done(path, &format!("compare night.toml night.toml {plan} --out change"));
    done(path, "profile night.toml --receivers surfaces --engine cpu --patch-cell 2 --out surfaces");
    let probed = done(path, "probe night.toml --point 0,0,50 --from sunrise --to sunset --quiet");
    assert!(probed.contains("it stays below the horizon"), "{probed}");
    fails(path, "sun night.toml --at sunrise", 2, &["--at", "no sunrise on 2026-12-21", "polar night"]);

    fs::write(
        path.join("far.toml"),
        format!("{PLACE}[[model]]\npath = \"tower.glb\"\n[study]\ndates = [1500-01-01, 1500-01-02]\nstep = \"1h\"\n"),
    )
    .unwrap();
    fails(path, "sun far.toml", 1, &["far.toml, [study] dates", "1500"]);
    fails(path, "probe far.toml --point 0,0,1 --from 9:00", 1, &["far.toml, [study] dates", "1500"]);
    let hours = "--from-date 2026-03-28 --to-date 2026-03-30 --from 2:30 --to 12:00 --step 1h";
    fails(path, &format!("sun . {hours}"), 2, &["--from:", "does not exist"]);
}

/// A light hand-made list: midnight, the day's bound, is where a window begins that the day before has not taken.
#[test]
fn no_light_of_a_polar_year_is_of_two_days() {
    for place in [tromso(), place(78.22, 15.65, 10.0, "Arctic/Longyearbyen"), place(66.2, -30.0, 0.0, "Etc/GMT+2")] {
        let first: NaiveDate = "2026-01-01".parse().unwrap();
        let (from, to) = ("sunrise".parse().unwrap(), "sunset".parse().unwrap());
        let mut last = None;
        for date in first.iter_days().take(365) {
            let window = gnomon::sun::DayWindow::on(&place, date, Some(&from), Some(&to)).unwrap();
            assert!(last.is_none_or(|last| last <= window.from) && window.from <= window.to, "{window:?}");
            assert!(window.to - window.from < TimeDelta::hours(49), "{window:?}");
            last = Some(window.to);
        }
    }
}

/// What may be searched lies between instants of one window, with the sun up at both and all the time between.
#[test]
fn gaps_lie_within_a_window_and_its_light() {
    let gaps = |track: &SunTrack| track.instants.iter().map(|it| it.gap_secs).collect::<Vec<_>>();
    let noons = days(&vienna(), "2026-03-20", 2, ["10:00", "12:30"], HOUR, true);
    assert_eq!(gaps(&noons), [0, 3600, 3600, 1800, 0, 3600, 3600, 1800]);
    // the days' windows are ten minutes apart, and the sun does not set
    let summer = days(&tromso(), "2026-06-20", 2, ["0:00", "23:50"], 6 * HOUR, true);
    assert_eq!(gaps(&summer), [0, 21_600, 21_600, 21_600, 21_000, 0, 21_600, 21_600, 21_600, 21_000]);
    let spring = one(&vienna(), "2026-03-21", ["4:00", "8:00"], HOUR);
    assert_eq!(gaps(&spring), [0, 0, 0, 3600, 3600]);
    // the sun sets and rises between two instants
    let night = one(&tromso(), "2026-01-20", ["10:00", "14:00"], 4 * HOUR);
    assert!(gaps(&night).iter().all(|secs| *secs == 0), "{night:?}");
    let weights = |track: &SunTrack| track.instants.iter().map(|it| u64::from(it.gap_secs)).sum::<u64>();
    assert!(weights(&noons) == noons.window_secs() && weights(&summer) == summer.window_secs());
}
