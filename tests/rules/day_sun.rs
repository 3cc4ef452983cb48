//! When the sun counts for a receiver with a free horizon, against spherical trigonometry.

use super::{hours, place, rule};
use gnomon::glam::DVec3;
use gnomon::rules::{DaySun, GrazingIn, RuleDay, Spell, SunCuts, total_secs};
use gnomon::sun::{Air, Place, Sky};

fn sky(place: &Place) -> Sky<'_> {
    Sky { place, delta_t_secs: 72.0, air: None }
}

/// The days of a rule whose windows are whole days or long ones.
fn days(id: &str, given: &[(&str, &str)], at: &Place) -> Vec<RuleDay> {
    rule(id, given).calendar(at, 2026).expect("days")
}

/// Hours above an altitude: cos H = (sin h − sin φ sin δ) / (cos φ cos δ).
fn hours_above(altitude_deg: f64, latitude_deg: f64, declination_deg: f64) -> f64 {
    let [altitude, latitude, declination] = [altitude_deg, latitude_deg, declination_deg].map(f64::to_radians);
    let cos = (altitude.sin() - latitude.sin() * declination.sin()) / (latitude.cos() * declination.cos());
    2.0 * cos.acos().to_degrees() / 15.0
}

/// The declination at noon, from the sun's altitude there.
fn declination(at: &Place, day: &RuleDay) -> f64 {
    let noon = gnomon::sun::Day::of(at, day.date).expect("a day").noon.expect("noon");
    sky(at).at(noon).expect("a sun").altitude_deg() - (90.0 - at.latitude_deg)
}

#[test]
fn a_sun_above_an_altitude() {
    let at = place(50.11, 8.68, "Europe/Berlin");
    let day = &days("eu-en-17037-sunlight", &[("above", "DE"), ("date", "02-14")], &at)[0];
    let sun = DaySun::of(&sky(&at), day).expect("a sun");
    for above_deg in [0.0, 6.0, 11.0, 20.0] {
        let cuts = SunCuts { above_deg, ..SunCuts::default() };
        let found = total_secs(&sun.open(&cuts, None)) as f64 / 3600.0;
        let closed = hours_above(above_deg, at.latitude_deg, declination(&at, day));
        assert!((found - closed).abs() < 0.01, "{above_deg}: {found} {closed}");
    }
    // higher than the noon sun of the day there is none
    assert!(sun.open(&SunCuts { above_deg: 30.0, ..SunCuts::default() }, None).is_empty());
}

/// Its ends equal those of a test of every second.
#[test]
fn open_sun_is_right_to_the_second() {
    let at = place(39.9, 116.4, "Asia/Shanghai");
    let given = [("day", "great-cold"), ("hours", "2h"), ("sweep", "12"), ("above", "15")];
    let resolved = rule("cn-gb-50180-dwelling", &given);
    let day = &resolved.calendar(&at, 2026).expect("days")[0];
    let air = Some(Air::standard(0.0));
    let sky = Sky { air, ..sky(&at) };
    let outward = Some(DVec3::new(0.8, -0.6, 0.0));
    let found = DaySun::of(&sky, day).expect("a sun").open(&resolved.cuts, outward);
    assert_eq!(found.len(), 1);
    let admits = |secs: i64| {
        use chrono::TimeZone;
        let utc = chrono::DateTime::from_timestamp(secs, 0).expect("a time").naive_utc();
        let sun = sky.at(at.time_zone.from_utc_datetime(&utc)).expect("a sun");
        resolved.cuts.admits(sun.altitude_deg(), sun.to_sun, outward)
    };
    let Spell { start, end } = found[0];
    assert!(start > day.windows[0].start && end < day.windows[0].end, "both ends are cuts");
    assert!(!admits(start - 2) && admits(start + 1) && admits(end - 2) && !admits(end + 1));
}

/// At the equinox, on the plan: tan A = tan H / sin φ.
#[test]
fn a_sweep_angle_on_the_plan() {
    let at = place(39.9, 116.4, "Asia/Shanghai");
    let day = &days("pl-wt-60", &[("clock", "true-solar")], &at)[0];
    let sun = DaySun::of(&sky(&at), day).expect("a sun");
    let open = |off_facade_deg: f64, outward: DVec3| {
        let cuts = SunCuts { off_facade_deg, off_facade_in: GrazingIn::Plan, ..SunCuts::default() };
        total_secs(&sun.open(&cuts, Some(outward)))
    };
    let half = (78_f64.to_radians().tan() * at.latitude_deg.to_radians().sin()).atan().to_degrees() / 15.0;
    let found = open(12.0, DVec3::NEG_Y) as f64 / 3600.0;
    // the declination is not 0 all day: in the morning it is −0.15°, which is 40 s of the hour angle
    assert!((found - 2.0 * half).abs() < 0.03, "{found} {half}");
    // from 7 to 17 a south façade has all of it, a north façade nothing, an east façade the morning
    assert!((open(0.0, DVec3::NEG_Y) - hours(10)).abs() < 10);
    assert_eq!(open(0.0, DVec3::Y), 0);
    assert!((open(0.0, DVec3::X) - hours(5)).abs() < 10);
}

#[test]
fn windows_are_not_joined() {
    let at = place(50.0, 8.0, "Europe/Berlin");
    let mut day = days("nl-tno-light", &[], &at)[100].clone();
    let noon = day.windows[0].start + hours(12);
    day.windows = vec![Spell::new(noon - 90, noon), Spell::new(noon + 30, noon + 45), Spell::new(noon + 60, noon + 61)];
    day.criteria = vec![None];
    let open = DaySun::of(&sky(&at), &day).expect("a sun").open(&SunCuts::default(), None);
    assert_eq!(open, day.windows);
    // a criterion's own window may reach further than the day's
    day.criteria = vec![Some(vec![Spell::new(noon - 100, noon + 45)])];
    let open = DaySun::of(&sky(&at), &day).expect("a sun").open(&SunCuts::default(), None);
    assert_eq!(open, [Spell::new(noon - 100, noon + 45), day.windows[2]]);
    let night = RuleDay { windows: vec![Spell::new(noon - hours(12), noon - hours(11))], criteria: vec![None], ..day };
    assert!(DaySun::of(&sky(&at), &night).expect("a sun").open(&SunCuts::default(), None).is_empty());
}
