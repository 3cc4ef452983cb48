//! Rules about shadows whose length has a closed form, with the sun of SPA.

use super::{hours, place, rule};
use chrono::DateTime;
use gnomon::rules::{DayLight, Quantity, ResolvedRule, RuleDay, Ruling, Spell, Verdict, merged};
use gnomon::sun::{Place, Position, position};

/// The sun at a second since 1970, without refraction as the closed forms have it.
fn sun(at: &Place, secs: i64) -> Position {
    position(at, DateTime::from_timestamp(secs, 0).expect("a time"), 70.0, None).expect("a sun")
}

/// When a test of the sun holds within a day's windows, to ten seconds.
fn when(at: &Place, day: &RuleDay, lit: impl Fn(Position) -> bool) -> Vec<Spell> {
    const STEP: i64 = 10;
    let times = day.windows.iter().flat_map(|window| (window.start..window.end).step_by(STEP as usize));
    merged(times.filter(|secs| lit(sun(at, secs + STEP / 2))).map(|secs| Spell::new(secs, secs + STEP)))
}

fn ruling(rule: &ResolvedRule, band: Option<usize>, day: &RuleDay, lit: &[Spell]) -> Ruling {
    rule.judge_time(band, &[DayLight { day, open: &day.windows, lit, before: None, newly_shaded: None }])
        .expect("a ruling")
}

fn hours_of(ruling: &Ruling) -> f64 {
    match ruling.findings[0].value {
        Quantity::Secs(secs) => secs as f64 / 3600.0,
        other => panic!("{other:?}"),
    }
}

/// The hours of sun of a point to the north of an infinite wall that runs east and west, at a distance in multiples of
/// its height: at the hour angle H the shadow reaches (cos δ cos H sin φ − sin δ cos φ) / (sin φ sin δ + cos φ cos δ
/// cos H) heights.
fn hours_behind_a_wall(latitude_deg: f64, declination_deg: f64, distance: f64) -> f64 {
    let (sin_lat, cos_lat) = latitude_deg.to_radians().sin_cos();
    let (sin_dec, cos_dec) = declination_deg.to_radians().sin_cos();
    let reach = |hour: f64| {
        let cos_hour = (15.0 * hour).to_radians().cos();
        (cos_dec * cos_hour * sin_lat - sin_dec * cos_lat) / (sin_lat * sin_dec + cos_lat * cos_dec * cos_hour)
    };
    let minutes = (0..240).filter(|minute| reach((f64::from(*minute) + 0.5) / 60.0) < distance).count();
    minutes as f64 / 30.0
}

/// An endless wall in Beijing on Great Cold: at 1.7 heights nothing, at 1.8 some two hours and a half, at 2.0 four and a half.
#[test]
fn an_endless_wall_in_beijing() {
    let at = place(39.9, 116.4, "Asia/Shanghai");
    let two = rule("cn-gb-50180-dwelling", &[("day", "great-cold"), ("hours", "2h")]);
    let day = &two.calendar(&at, 2026).expect("days")[0];
    let behind = |distance: f64| {
        let lit = when(&at, day, |sun| {
            let to_south = -(sun.azimuth_deg.to_radians().cos());
            to_south <= 0.0 || sun.altitude_deg.to_radians().tan() > to_south / distance
        });
        ruling(&two, None, day, &lit)
    };
    // the numbers that are known, of another year's declination
    assert!((hours_behind_a_wall(39.9, -20.01, 1.8) - 2.511).abs() < 0.04);
    assert!((hours_behind_a_wall(39.9, -20.01, 2.0) - 4.435).abs() < 0.04);
    // at noon of the day the sun's longitude is 300.1°
    let declination = (23.436_f64.to_radians().sin() * 300.1_f64.to_radians().sin()).asin().to_degrees();
    for distance in [1.8, 1.9, 2.0, 2.5] {
        let (found, closed) = (hours_of(&behind(distance)), hours_behind_a_wall(39.9, declination, distance));
        assert!((found - closed).abs() < 0.05, "{distance}: {found} {closed}");
    }
    assert_eq!(behind(1.7).findings[0].value, Quantity::Secs(0));
    assert_eq!([1.7, 1.8, 2.0].map(|distance| behind(distance).verdict), [Verdict::Fail, Verdict::Pass, Verdict::Pass]);
    // sixteen hours of the true solar day are eight, all lit where the wall is far
    assert!((hours_of(&behind(50.0)) - 8.0).abs() < 0.01);
}

/// At the equinox an endless wall takes all of the sun or none: the reach is tan(latitude) at every hour.
#[test]
fn an_endless_wall_at_the_equinox() {
    let at = place(51.5, 0.0, "Europe/London");
    let poland = rule("pl-wt-60", &[("clock", "true-solar")]);
    let day = &poland.calendar(&at, 2026).expect("days")[0];
    let lit = |distance: f64| {
        let spells = when(&at, day, |sun| {
            let to_south = -(sun.azimuth_deg.to_radians().cos());
            to_south <= 0.0 || sun.altitude_deg.to_radians().tan() > to_south / distance
        });
        hours_of(&ruling(&poland, None, day, &spells))
    };
    let reach = 51.5_f64.to_radians().tan();
    assert!((reach - 1.2572).abs() < 1e-4);
    // an eighth of a degree of declination is what a day's change can do
    assert!(lit(reach * 0.97) < 0.01 && lit(reach * 1.03) > 9.98, "{} {}", lit(reach * 0.97), lit(reach * 1.03));
}

/// Japan's lines of equal duration before a wide box: on its axis the shadow of n hours ends (W/2)/tan A north of it, A the
/// sun's azimuth n/2 hours from noon, whatever the box's height.
#[test]
fn lines_of_equal_duration_in_japan() {
    let at = place(35.0, 135.5, "Asia/Tokyo");
    let given = [("plane", "4"), ("near", "4h"), ("far", "2h30")];
    let japan = rule("jp-bsa-56-2", &given);
    let day = &japan.calendar(&at, 2026).expect("days")[0];
    let width = 20.0_f64;
    let at_distance = |distance: f64| {
        let lit = when(&at, day, |sun| {
            let (sin, cos) = sun.azimuth_deg.to_radians().sin_cos();
            // the ray towards the sun leaves the axis by so much where it comes to the box's north face
            let aside = if cos < 0.0 { distance * sin / -cos } else { f64::INFINITY };
            aside.abs() > width / 2.0
        });
        ruling(&japan, Some(0), day, &lit)
    };
    let tips = [(2.0, 1.7567), (3.0, 1.1566), (4.0, 0.8521), (5.0, 0.6656), (6.0, 0.5380)];
    for (shadow, tip) in tips {
        let found = hours_of(&at_distance(tip * width));
        assert!((found - shadow).abs() < 0.02, "{found} h at {tip} widths");
    }
    // 4 hours: a tenth of a metre nearer is too long, one further is kept
    let verdict = |metres: f64| at_distance(0.8521 * width + metres).verdict;
    assert_eq!([verdict(-0.2), verdict(0.2)], [Verdict::Fail, Verdict::Pass]);
}

/// The manual's longest shadow, 4.3 times the height, is that of its window on 21 December by the geometric sunrise. By the
/// almanac's it would be 4.5 times.
#[test]
fn the_longest_shadow_of_new_york() {
    let at = place(40.7128, -74.006, "America/New_York");
    let factor = |sunrise: &str| {
        let text = gnomon::rules::built_in_text("us-nyc-ceqr-shadows").expect("a rule").replace("geometric", sunrise);
        let rule = gnomon::rules::Rule::parse("nyc", &text).expect("a rule").resolve(&[]).expect("options");
        let window = rule.calendar(&at, 2026).expect("days")[0].windows[0];
        [window.start, window.end].map(|secs| 1.0 / sun(&at, secs).altitude_deg.to_radians().tan())
    };
    for end in factor("geometric") {
        assert!((end - 4.288).abs() < 0.02, "{end}");
    }
    for end in factor("almanac") {
        assert!((end - 4.525).abs() < 0.02, "{end}");
    }
}

/// Noon of the winter solstice: shadows of 1.13, 1.06, 1.99 and 2.63 times the height in four cities; for Shanghai a
/// published 1.22 is wrong, as it is 1.41.
#[test]
fn noon_shadows_of_chinese_cities() {
    let solstice = rule("cn-gb-50180-dwelling", &[("day", "december-solstice"), ("hours", "1h")]);
    let factor = |latitude: f64, longitude: f64| {
        let at = place(latitude, longitude, "Asia/Shanghai");
        let window = solstice.calendar(&at, 2026).expect("days")[0].windows[0];
        1.0 / sun(&at, (window.start + window.end) / 2).altitude_deg.to_radians().tan()
    };
    for (latitude, longitude, published) in
        [(25.04, 102.7, 1.13), (23.13, 113.27, 1.06), (39.9, 116.4, 1.99), (45.75, 126.65, 2.63)]
    {
        let found = factor(latitude, longitude);
        assert!((found - published).abs() < 0.015, "{latitude}: {found}");
    }
    assert!((factor(31.23, 121.47) - 1.41).abs() < 0.01);
    // half an hour from noon, which is what an hour of sun needs: a wall of 18.18 m over a sill of 1.35 m
    let at = place(39.9, 116.4, "Asia/Shanghai");
    let window = solstice.calendar(&at, 2026).expect("days")[0].windows[0];
    let seen = sun(&at, (window.start + window.end) / 2 - hours(1) / 2);
    let reach = -seen.azimuth_deg.to_radians().cos() / seen.altitude_deg.to_radians().tan();
    assert!((reach * (18.18 - 1.35) / 18.18 - 1.86).abs() < 0.015, "{reach}");
}
