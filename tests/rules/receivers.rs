//! Which sunlight counts, and where receivers are.

use super::{place, rule};
use chrono::NaiveDate;
use gnomon::glam::DVec3;
use gnomon::rules::{Band, DeemedBoundary, GrazingIn, RuleReceiver, SunCuts, WindowPoint};
use gnomon::sun::{Position, Season, position};

fn sun(azimuth_deg: f64, altitude_deg: f64) -> DVec3 {
    Position { azimuth_deg, altitude_deg }.to_sun()
}

const SOUTH: Option<DVec3> = Some(DVec3::NEG_Y);

#[test]
fn a_low_sun_does_not_count() {
    let admits =
        |id: &str, given: &[(&str, &str)], altitude| rule(id, given).cuts.admits(altitude, sun(180.0, altitude), SOUTH);
    let exposure = [("above", "DE")];
    assert!(!admits("eu-en-17037-sunlight", &exposure, 11.0) && admits("eu-en-17037-sunlight", &exposure, 11.000_01));
    assert!(admits("de-din-5034-1", &[], 6.0) && !admits("de-din-5034-1", &[], 5.999_99));
    assert!(!admits("nl-the-hague", &[], 10.0) && admits("nl-the-hague", &[], 10.000_01));
    assert!(!admits("nl-tno-light", &[], 0.0) && admits("nl-tno-light", &[], 0.000_01));
}

#[test]
fn a_grazing_sun_does_not_count() {
    let given = [("day", "great-cold"), ("hours", "2h"), ("sweep", "12")];
    let cuts = rule("cn-gb-50180-dwelling", &given).cuts;
    // the façade's line runs east and west; 12° off it on the plan, however high the sun is
    for altitude in [1.0, 40.0, 80.0] {
        assert!(cuts.admits(altitude, sun(102.0, altitude), SOUTH), "{altitude}");
        assert!(!cuts.admits(altitude, sun(101.99, altitude), SOUTH), "{altitude}");
        assert!(cuts.admits(altitude, sun(258.0, altitude), SOUTH), "{altitude}");
        assert!(!cuts.admits(altitude, sun(0.0, altitude), SOUTH), "behind");
    }
    // in space a high sun is closer to the façade
    let space = SunCuts { off_facade_deg: 25.0, off_facade_in: GrazingIn::Space, ..SunCuts::default() };
    assert!(space.admits(60.0, sun(180.0, 60.0), SOUTH) && !space.admits(66.0, sun(180.0, 66.0), SOUTH));
    assert!(space.admits(0.0, sun(115.0, 0.0), SOUTH) && !space.admits(0.0, sun(114.99, 0.0), SOUTH));
    assert!(space.admits(10.0, sun(100.0, 10.0), None), "what has no plane has no grazing sun");
    // in the plane itself it never counts, nor in the zenith on the plan
    assert!(!SunCuts::default().admits(30.0, sun(90.0, 30.0), Some(DVec3::new(0.0, -1.0, 0.0))));
    assert!(!cuts.admits(90.0, DVec3::Z, SOUTH) && !cuts.admits(45.0, sun(180.0, 45.0), Some(DVec3::Z)));
}

/// The published cases of roads beside a plot, and of neighbours whose ground lies higher.
#[test]
fn the_deemed_boundary_of_japan() {
    let out = |width| DeemedBoundary::Japan.outward_m(width);
    assert_eq!([6.0, 10.0, 12.0, 14.0].map(out), [3.0, 5.0, 7.0, 9.0]);
    let raised = |higher| DeemedBoundary::Japan.raised_m(higher);
    assert_eq!([0.0, 0.99, 1.0, 3.0].map(raised), [0.0, 0.0, 0.0, 1.0]);
}

#[test]
fn receivers_are_as_the_rules_say() {
    let window = |id: &str, given: &[(&str, &str)]| match rule(id, given).receiver {
        RuleReceiver::Window { at, floor_m, sill_m, .. } => (at, floor_m, sill_m),
        other => panic!("{other:?}"),
    };
    assert_eq!(window("eu-en-17037-sunlight", &[("above", "13")]), (WindowPoint::MiddleInside, 1.2, 0.3));
    assert_eq!(window("nl-tno-strict", &[]), (WindowPoint::SillInside, 0.0, 0.0));
    let given = [("plane", "4"), ("near", "4h"), ("far", "2h30")];
    let RuleReceiver::Lines { bands, height_m, .. } = rule("jp-bsa-56-2", &given).receiver else { panic!("no lines") };
    let band = |from_m, to_m| Band { from_m, to_m };
    assert_eq!((bands, height_m), (vec![band(5.0, 10.0), band(10.0, f64::INFINITY)], 4.0));
    assert_eq!(rule("nl-the-hague", &[]).receiver, RuleReceiver::Facade);
    assert_eq!(rule("au-vic-b21", &[]).receiver, RuleReceiver::Area { least_width_m: 3.0 });
}

/// The sun of Japan's rule at 8:00 true solar time: azimuth 53°27′ east of south, shadows of 6.71 times the height.
#[test]
fn the_sun_of_the_first_hour_in_japan() {
    let at = place(35.0, 135.5, "Asia/Tokyo");
    let given = [("plane", "4"), ("near", "4h"), ("far", "2h30")];
    let days = rule("jp-bsa-56-2", &given).calendar(&at, 2026).expect("days");
    assert_eq!(days[0].date, NaiveDate::from_ymd_opt(2026, 12, 22).expect("a date"));
    assert_eq!(Season::DecemberSolstice.date(&at, 2026).expect("a date"), days[0].date);
    let seen = |secs: i64| {
        let time = chrono::DateTime::from_timestamp(days[0].windows[0].start + secs, 0).expect("a time");
        let seen = position(&at, time, 72.0, None).expect("a sun");
        (180.0 - seen.azimuth_deg, 1.0 / seen.altitude_deg.to_radians().tan())
    };
    let (azimuth, factor) = seen(0);
    assert!((azimuth - 53.45).abs() < 0.05 && (factor - 6.71).abs() < 0.01, "{azimuth} {factor}");
    // hours later, by SPA
    for (hour, factor) in [(1, 3.144), (2, 2.145), (4, 1.629)] {
        assert!((seen(hour * 3600).1 - factor).abs() < 0.005, "{hour}");
    }
    assert!(seen(4 * 3600).0.abs() < 0.05);
}
