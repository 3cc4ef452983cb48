//! Shares of areas, on either side of their limits, and with parts that are unknown.

use super::{calendar, rule};
use gnomon::rules::{
    AreaLight, Excuse, PartMet, Quantity, ResolvedRule, Rule, Ruling, ShadowLoad, Verdict, built_in_text, total_secs,
};

/// The ruling on an area, of which a given share meets each criterion, within an error.
fn part(rule: &ResolvedRule, area_m2: f64, now_m2: f64, before_m2: Option<f64>, error_m2: f64) -> Ruling {
    let days = calendar(rule);
    let met = vec![Some(PartMet { now_m2, before_m2, error_m2, has_less: false }); rule.criteria.len()];
    let lights: Vec<_> = days.iter().map(|day| AreaLight { day, met: met.clone() }).collect();
    rule.judge_parts(area_m2, &lights).expect("a ruling")
}

#[test]
fn half_of_the_area_or_most_of_what_was() {
    let both = rule("uk-bre-209-sun-on-ground", &[]);
    let verdict = |rule: &ResolvedRule, now, before| part(rule, 200.0, now, Some(before), 0.0).verdict;
    assert_eq!(verdict(&both, 100.0, 180.0), Verdict::Pass);
    assert_eq!(verdict(&both, 99.99, 180.0), Verdict::Fail);
    // below half, and no less than 0.8 of what it was
    let kept = part(&both, 200.0, 80.0, Some(100.0), 0.0);
    assert_eq!((kept.verdict, kept.findings[0].excuse), (Verdict::Pass, Some(Excuse::Ratio)));
    assert_eq!(kept.findings[0].margin, Some(-20.0));
    assert_eq!(verdict(&both, 79.99, 100.0), Verdict::Fail);
    // what had no sun loses none
    assert_eq!(verdict(&both, 0.0, 0.0), Verdict::Pass);
    let either = rule("uk-bre-209-sun-on-ground", &[("loss", "either")]);
    assert_eq!(verdict(&either, 100.0, 125.0), Verdict::Pass);
    assert_eq!(verdict(&either, 100.0, 125.1), Verdict::Fail);
    assert_eq!(verdict(&either, 99.9, 99.9), Verdict::Fail);
}

#[test]
fn the_lesser_of_a_share_and_square_metres() {
    let victoria = rule("au-vic-b21", &[]);
    let verdict = |area, now, before| part(&victoria, area, now, Some(before), 0.0).verdict;
    // of 100 m² 40 are enough, of 40 m² it is 75%
    assert_eq!(verdict(100.0, 40.0, 100.0), Verdict::Pass);
    assert_eq!(verdict(100.0, 39.99, 100.0), Verdict::Fail);
    assert_eq!(verdict(40.0, 30.0, 40.0), Verdict::Pass);
    assert_eq!(verdict(40.0, 29.99, 40.0), Verdict::Fail);
    // where there was less already nothing may be taken
    let same = part(&victoria, 100.0, 39.0, Some(39.0), 0.0);
    assert_eq!((same.verdict, same.findings[0].excuse), (Verdict::Pass, Some(Excuse::NoWorse)));
    assert_eq!(verdict(100.0, 38.99, 39.0), Verdict::Fail);
    assert_eq!(verdict(100.0, 39.0, 38.0), Verdict::Pass);
    let limit = part(&victoria, 100.0, 41.0, Some(80.0), 0.0).findings[0].limit;
    assert_eq!(limit, Some(Quantity::AreaM2(40.0)));
}

/// A number that differs from its limit by less than its error neither passes nor fails.
#[test]
fn closer_than_its_error_says_so() {
    let victoria = rule("au-vic-b21", &[]);
    let verdict = |now, before, error| part(&victoria, 100.0, now, Some(before), error).verdict;
    assert_eq!(verdict(40.1, 100.0, 0.1), Verdict::Pass);
    assert_eq!(verdict(40.05, 100.0, 0.1), Verdict::Close);
    assert_eq!(verdict(39.95, 100.0, 0.1), Verdict::Close);
    assert_eq!(verdict(39.85, 100.0, 0.1), Verdict::Fail);
    // whether there was less before, and whether it became less, are known no better
    assert_eq!(verdict(39.0, 39.1, 0.1), Verdict::Close);
    assert_eq!(verdict(39.0, 39.0, 0.1), Verdict::Pass);
    assert_eq!(verdict(39.0, 39.5, 0.1), Verdict::Fail);
    let bre = rule("uk-bre-209-sun-on-ground", &[]);
    let of = |now, before| part(&bre, 200.0, now, Some(before), 0.5).verdict;
    assert_eq!([of(80.0, 100.0), of(81.0, 100.0), of(79.0, 100.0)], [Verdict::Close, Verdict::Pass, Verdict::Fail]);
}

#[test]
fn streets_and_parks_of_montreal() {
    let park = rule("ca-montreal", &[("space", "park")]);
    assert_eq!(calendar(&park).len(), 2);
    let verdict = |rule: &ResolvedRule, now| part(rule, 1000.0, now, Some(1000.0), 0.0).verdict;
    assert_eq!([verdict(&park, 500.0), verdict(&park, 499.9)], [Verdict::Pass, Verdict::Fail]);
    let street = rule("ca-montreal", &[("space", "vibrant-street")]);
    assert_eq!([verdict(&street, 1000.0), verdict(&street, 999.9)], [Verdict::Pass, Verdict::Fail]);
    let side = rule("ca-montreal", &[("space", "other-street"), ("street_share", "0.4")]);
    assert_eq!([verdict(&side, 400.0), verdict(&side, 399.9)], [Verdict::Pass, Verdict::Fail]);
}

/// The hours of San Francisco's year, which the reports print as 3,721.4.
#[test]
fn new_shadow_is_a_share_of_the_sun_of_a_year() {
    let free = rule("us-sf-295", &[]);
    let days = calendar(&free);
    let open: i64 = days.iter().map(|day| total_secs(&day.windows)).sum();
    let hours = open as f64 / 3600.0;
    assert!((hours / 3721.4 - 1.0).abs() < 0.0005, "{hours}");
    assert!((hours - 3720.9).abs() < 0.3, "{hours}");
    let loads = |share: f64, error: f64| -> Vec<ShadowLoad> {
        let of = |day| ShadowLoad { day, m2_secs: 0.0, error_m2_secs: 0.0 };
        let mut loads: Vec<_> = days.iter().map(of).collect();
        loads[10].m2_secs = share * 500.0 * open as f64;
        loads[11].error_m2_secs = error * 500.0 * open as f64;
        loads
    };
    let told = free.judge_load(500.0, &loads(0.2, 0.0)).expect("a ruling");
    assert_eq!((told.verdict, told.findings[0].limit), (Verdict::Report, None));
    let limited = rule("us-sf-295", &[("limit", "0.01")]);
    let verdict = |share, error| limited.judge_load(500.0, &loads(share, error)).expect("a ruling").verdict;
    assert_eq!([verdict(0.01, 0.0), verdict(0.010_001, 0.0)], [Verdict::Pass, Verdict::Fail]);
    assert_eq!(
        [verdict(0.01, 0.001), verdict(0.008, 0.001), verdict(0.012, 0.001)],
        [Verdict::Close, Verdict::Pass, Verdict::Fail]
    );
}

/// Where an area had less before, a point that loses sun fails it, though no more of the area misses the hours.
#[test]
fn what_failed_before_may_lose_nothing() {
    let victoria = rule("au-vic-b21", &[]);
    let days = calendar(&victoria);
    let verdict = |now_m2: f64, before_m2: f64, has_less: bool| {
        let met = vec![
            Some(PartMet { now_m2, before_m2: Some(before_m2), error_m2: 0.0, has_less });
            victoria.criteria.len()
        ];
        let lights: Vec<_> = days.iter().map(|day| AreaLight { day, met: met.clone() }).collect();
        victoria.judge_parts(100.0, &lights).expect("a ruling").verdict
    };
    assert_eq!([verdict(0.0, 0.0, false), verdict(0.0, 0.0, true)], [Verdict::Pass, Verdict::Fail]);
    assert_eq!([verdict(20.0, 20.0, false), verdict(20.0, 20.0, true)], [Verdict::Pass, Verdict::Fail]);
    assert_eq!(verdict(80.0, 90.0, true), Verdict::Pass, "what keeps its hours may lose some sun");
}

#[test]
fn what_is_not_there_is_asked_for() {
    let bre = rule("uk-bre-209-sun-on-ground", &[]);
    let days = calendar(&bre);
    let light = |before_m2| AreaLight {
        day: &days[0],
        met: vec![Some(PartMet { now_m2: 1.0, before_m2, error_m2: 0.0, has_less: false })],
    };
    assert!(bre.judge_parts(10.0, &[light(None)]).is_err_and(|error| error.to_string().contains("state before")));
    for area in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(bre.judge_parts(area, &[light(Some(1.0))]).is_err(), "{area}");
    }
    // an area of which nothing is said has no verdict
    let silent = AreaLight { day: &days[0], met: Vec::new() };
    assert_eq!(bre.judge_parts(10.0, &[silent]).expect("a ruling").verdict, Verdict::Report);
    assert!(Rule::parse("x", built_in_text("uk-bre-209-sun-on-ground").expect("text")).is_ok());
}
