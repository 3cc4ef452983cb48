//! Parts of areas, their worst points, new shadow and area times time.

use super::{area, corner, endless_wall, judged, london, nothing, over_wall, secs, share, site, tried, value_secs};
use crate::shared::dense::cuboid;
use glam::{DVec3, dvec3};
use gnomon::export::judgement::{csv, receiver_row};
use gnomon::judgement::JudgedThing;
use gnomon::rules::{Excuse, Quantity, Verdict, total_secs};
use gnomon::site::AreaSurface;
use gnomon::sun::Place;

const BRE: &str = "uk-bre-209-sun-on-ground";

/// How far north of the wall two hours of sun begin on the day of a rule: by halving, with every second asked.
fn edge(place: &Place, day: &gnomon::rules::RuleDay, height: f64, least: i64) -> f64 {
    let [mut dark, mut lit] = [0.0, 20.0 * height];
    while lit - dark > 1e-4 {
        let middle = (dark + lit) / 2.0;
        let is_lit = secs(place, day, |sun| over_wall(sun, middle, height)) >= least;
        if is_lit { lit = middle } else { dark = middle }
    }
    lit
}

#[test]
fn a_share_behind_an_endless_wall() {
    let place = london();
    let mut asked = site(place.clone(), vec![endless_wall("wall", 0.0, 10.0)], Some(vec![nothing()]));
    asked.areas = vec![area("garden", [-7.0, 0.0], [13.0, 40.0]), area("court", [-7.0, 0.0], [13.0, 20.0])];
    let found = judged(&asked, BRE, &[]);
    let edge = edge(&place, &found.days[0], 10.0, 7200);
    for (receiver, depth) in found.receivers.iter().zip([40.0, 20.0]) {
        let size = receiver.area.expect("an area");
        let error = size.error_m2 / size.m2;
        assert!((size.m2 - 20.0 * depth).abs() < 1e-9 && error <= 0.001, "{size:?}");
        let expected = 1.0 - edge / depth;
        assert!((share(receiver) - expected).abs() <= error, "{} {expected} {error}", share(receiver));
        let before = receiver.ruling.findings[0].before;
        assert!(matches!(before, Some(Quantity::AreaM2(m2)) if (m2 - size.m2).abs() < 1e-9), "{before:?}");
    }
    // more than half of the garden is lit, and less of the court, of which much less is than before
    let verdicts: Vec<Verdict> = found.receivers.iter().map(|receiver| receiver.ruling.verdict).collect();
    assert_eq!((verdicts, found.verdict), (vec![Verdict::Pass, Verdict::Fail], Verdict::Fail));
    assert_eq!(found.receivers[0].kind, JudgedThing::Area);
    assert!(found.receivers[0].takers.is_empty());
    let taker = &found.receivers[1].takers[0];
    assert!(taker.alone_secs > 3600.0 && taker.with_others_secs < 1.0, "{taker:?}");
}

#[test]
fn what_was_dark_before_excuses() {
    let walls = || endless_wall("wall", 0.0, 10.0);
    let mut asked = site(london(), vec![walls(), nothing()], Some(vec![walls()]));
    asked.areas = vec![area("court", [0.0, 0.0], [10.0, 20.0])];
    let found = judged(&asked, BRE, &[]);
    let decides = &found.receivers[0].ruling.findings[0];
    assert_eq!((found.verdict, decides.excuse), (Verdict::Pass, Some(Excuse::Ratio)));
    assert!(decides.margin.is_some_and(|margin| margin < 0.0));
}

/// Components that do not stand before make a state in which nothing casts.
#[test]
fn before_there_may_be_nothing() {
    let mut asked = site(london(), vec![endless_wall("wall", 0.0, 10.0)], Some(vec![endless_wall("wall", 0.0, 10.0)]));
    asked.before.as_mut().expect("before").casts = vec![false];
    asked.areas = vec![area("court", [0.0, 0.0], [10.0, 20.0])];
    let found = judged(&asked, BRE, &[]);
    let before = found.receivers[0].ruling.findings[0].before;
    assert!(matches!(before, Some(Quantity::AreaM2(m2)) if (m2 - 200.0).abs() < 1e-9), "{before:?}");
    assert_eq!(found.verdict, Verdict::Fail);
}

/// On the line of the shadow the share cannot be told from its limit.
#[test]
fn a_share_at_its_limit_is_close() {
    let place = london();
    let wall = || vec![endless_wall("wall", 0.0, 10.0)];
    let mut asked = site(place.clone(), wall(), Some(vec![nothing()]));
    asked.areas = vec![area("any", [0.0, 0.0], [10.0, 10.0])];
    let edge = edge(&place, &judged(&asked, BRE, &[]).days[0], 10.0, 7200);
    let verdict = |depth: f64| {
        let mut asked = asked.clone();
        asked.areas = vec![area("any", [0.0, 0.0], [10.0, depth])];
        judged(&asked, BRE, &[]).verdict
    };
    // a row of corners may lie on the line itself and tell
    let near = [1.9996, 1.9998, 2.0002, 2.0004].map(|ratio| verdict(ratio * edge));
    assert!(near.contains(&Verdict::Close), "{near:?}");
    assert_eq!([verdict(2.01 * edge), verdict(1.99 * edge)], [Verdict::Pass, Verdict::Fail]);
}

#[test]
fn a_hole_and_a_roof_are_no_ground() {
    let mut asked = site(london(), vec![nothing()], Some(vec![nothing()]));
    let mut ring = area("ring", [0.0, 0.0], [10.0, 10.0]);
    ring.rings.push(vec![corner(2.0, 2.0), corner(2.0, 8.0), corner(8.0, 8.0), corner(8.0, 2.0)]);
    let [a, b, c] = [dvec3(0.0, 0.0, 5.0), dvec3(4.0, 0.0, 5.0), dvec3(0.0, 3.0, 9.0)];
    let roof = AreaSurface::Faces(vec![[a, b, c]]);
    asked.areas =
        vec![ring, gnomon::site::JudgedArea { name: "roof".into(), rings: Vec::new(), surface: roof, dwelling: None }];
    let found = judged(&asked, BRE, &[]);
    let m2: Vec<f64> = found.receivers.iter().map(|receiver| receiver.area.expect("an area").m2).collect();
    assert!((m2[0] - 64.0).abs() < 1e-9 && (m2[1] - 10.0).abs() < 1e-9, "{m2:?}");
    assert_eq!(found.receivers.iter().map(share).collect::<Vec<_>>(), [1.0, 1.0]);
    // the roof looks south and up: of the day's sun it misses that behind it alone
    let of_roof = &found.receivers[1];
    let normal = of_roof.normal.expect("a slope");
    let before_it = secs(&asked.place, &found.days[0], |sun| sun.dot(normal) > 0.0);
    assert!((of_roof.counts[0].now_secs - before_it).abs() <= 3, "{} {before_it}", of_roof.counts[0].now_secs);
}

#[test]
fn victoria_takes_the_lesser_of_share_and_square_metres() {
    let melbourne = Place::new("", -37.81, 144.96, 0.0, Some("Australia/Melbourne")).expect("a place");
    // the sun is in the north
    let wall = cuboid("fence", dvec3(-5000.0, 0.0, 0.0), dvec3(5000.0, 0.001, 2.0));
    let mut asked = site(melbourne.clone(), vec![wall], Some(vec![nothing()]));
    asked.areas = vec![area("court", [0.0, -10.0], [10.0, 0.0])];
    let found = judged(&asked, "au-vic-b21", &[]);
    // at the equinox the shadow of 5 of 6 hours is tan φ long at each of them
    let lit = |south: f64| {
        let is_lit = |sun: DVec3| sun.y <= 0.0 || south * sun.z > sun.y * 2.0;
        secs(&melbourne, &found.days[0], is_lit) >= 5 * 3600
    };
    let [mut dark, mut light] = [0.0, 10.0];
    while light - dark > 1e-4 {
        let middle = (dark + light) / 2.0;
        if lit(middle) { light = middle } else { dark = middle }
    }
    let receiver = &found.receivers[0];
    let error = receiver.area.expect("an area").error_m2 / 100.0;
    assert!((share(receiver) - (1.0 - light / 10.0)).abs() <= error, "{} {light}", share(receiver));
    assert_eq!(receiver.ruling.findings[0].limit, Some(Quantity::AreaM2(40.0)));
    assert_eq!(found.verdict, Verdict::Pass);
    // 40 m² of a court of 3 m are more than it has behind the fence
    asked.areas = vec![area("strip", [0.0, -3.0], [10.0, 0.0])];
    assert_eq!(judged(&asked, "au-vic-b21", &[]).verdict, Verdict::Fail);
    // what is narrower than 3 m does not count
    asked.areas = vec![area("passage", [0.0, -2.9], [10.0, 0.0])];
    let refused = tried(&asked, "au-vic-b21", &[]).expect_err("too narrow").to_string();
    assert!(refused.contains("passage") && refused.contains("3 m wide"), "{refused}");
}

/// A passage beside a court is cut off, and what is left out is said; so it is of a component's faces.
#[test]
fn narrow_parts_are_cut_off() {
    let melbourne = Place::new("", -37.81, 144.96, 0.0, Some("Australia/Melbourne")).expect("a place");
    let mut asked = site(melbourne, vec![nothing()], Some(vec![nothing()]));
    let ring = [[0.0, 0.0], [10.0, 0.0], [10.0, 1.5], [5.0, 1.5], [5.0, 8.0], [0.0, 8.0]].map(|[x, y]| corner(x, y));
    let court = gnomon::site::JudgedArea { rings: vec![ring.to_vec()], ..area("court", [0.0, 0.0], [1.0, 1.0]) };
    // a roof that rises by 1 on 2 to the east: 5 m wide, and 1.5 m beyond y = 8
    let up = |x: f64, y: f64| dvec3(x, y, 10.0 + x / 2.0);
    let quad = |[a, b]: [f64; 2], [c, d]: [f64; 2]| [[up(a, b), up(c, b), up(c, d)], [up(a, b), up(c, d), up(a, d)]];
    let faces = [quad([0.0, 0.0], [5.0, 8.0]), quad([0.0, 8.0], [1.5, 20.0])].concat();
    let roof = gnomon::site::JudgedArea {
        rings: Vec::new(),
        surface: AreaSurface::Faces(faces),
        ..area("roof", [0.0, 0.0], [1.0, 1.0])
    };
    asked.areas = vec![court, roof, area("plain", [0.0, 0.0], [9.0, 7.0])];
    let found = judged(&asked, "au-vic-b21", &[]);
    let sizes: Vec<[f64; 2]> = found
        .receivers
        .iter()
        .map(|receiver| receiver.area.expect("an area"))
        .map(|of| [of.m2, of.narrow_m2])
        .collect();
    let slope = (1.0f64 + 0.25).sqrt();
    let expected = [[40.0, 7.5], [40.0 * slope, 18.0], [63.0, 0.0]];
    for (found, expected) in sizes.iter().zip(expected) {
        assert!((found[0] - expected[0]).abs() < 0.01 && (found[1] - expected[1]).abs() < 0.01, "{sizes:?}");
    }
    assert_eq!(sizes[2], [63.0, 0.0]);
    let said: Vec<String> = found.notes.iter().map(ToString::to_string).collect();
    let narrow = "narrower than 3 m do not count, and are left out: 7.50 m² of \"court\" and 18.00 m² of \"roof\"";
    assert!(said.iter().any(|note| note.contains(narrow)), "{said:?}");
    // no rule without a width cuts anything
    let whole = judged(&asked, BRE, &[]);
    assert!((whole.receivers[0].area.expect("an area").m2 - 47.5).abs() < 1e-9);
}

/// A slab over everything takes all the sun there is.
#[test]
fn area_times_time_of_a_year() {
    let sf = Place::new("", 37.77, -122.42, 0.0, Some("America/Los_Angeles")).expect("a place");
    let slab = cuboid("slab", dvec3(-9000.0, -9000.0, 5.0), dvec3(9000.0, 9000.0, 6.0));
    let mut asked = site(sf, vec![slab], Some(vec![nothing()]));
    asked.areas = vec![area("park", [0.0, 0.0], [4.0, 5.0])];
    let found = judged(&asked, "us-sf-295", &[]);
    let open: i64 = found.days.iter().map(|day| total_secs(&day.windows)).sum();
    let finding = &found.receivers[0].ruling.findings[0];
    let Quantity::AreaTime(value) = finding.value else { panic!("{finding:?}") };
    assert!((value / (20.0 * open as f64) - 1.0).abs() < 1e-9, "{value} {open}");
    assert_eq!(found.verdict, Verdict::Report);
    // the square-foot-hours of the reports; a foot is 0.3048 m
    let row = receiver_row(&found, &found.receivers[0]);
    assert_eq!(row.value, format!("{:.0} ft²h", value / 3600.0 / 0.092_903_04));
    assert!(csv(&found).contains(",m2 s,"), "numbers for programs are in metres");
    let limited = |limit: &str| judged(&asked, "us-sf-295", &[("limit", limit)]).verdict;
    assert_eq!([limited("1"), limited("0.99")], [Verdict::Pass, Verdict::Fail]);
}

#[test]
fn new_shadow_is_timed_and_all_sun_gone_is_told() {
    let york = Place::new("", 40.7128, -74.006, 0.0, Some("America/New_York")).expect("a place");
    let slab = cuboid("slab", dvec3(-9000.0, -9000.0, 5.0), dvec3(9000.0, 9000.0, 6.0));
    let mut asked = site(york, vec![slab], Some(vec![nothing()]));
    asked.areas = vec![area("plaza", [0.0, 0.0], [6.0, 6.0])];
    let found = judged(&asked, "us-nyc-ceqr-shadows", &[]);
    assert_eq!((found.verdict, found.days.len()), (Verdict::Report, 4));
    for (day, finding) in found.days.iter().zip(&found.receivers[0].ruling.findings) {
        let window = total_secs(&day.windows);
        assert_eq!((finding.value, finding.no_sun_left_secs), (Quantity::Secs(window), Some(window)));
    }
    let dates: Vec<String> =
        csv(&found).lines().skip(1).map(|line| line.split(',').nth(7).unwrap().to_owned()).collect();
    assert_eq!(dates, found.days.iter().map(|day| day.date.to_string()).collect::<Vec<_>>(), "a line for each day");
    let spells = &found.receivers[0].spells;
    assert!(spells.iter().zip(&found.days).all(|(told, day)| told.newly_shaded.as_ref() == Some(&day.windows)));
}

/// Every point must keep its hours of shadow, and the worst one is found between the first points.
#[test]
fn the_worst_point_of_a_parcel() {
    let zurich = Place::new("", 47.37, 8.54, 0.0, Some("Europe/Zurich")).expect("a place");
    let tower = || cuboid("tower", dvec3(-10.0, -20.0, 0.0), dvec3(10.0, 0.0, 30.0));
    let mut asked = site(zurich, vec![tower()], None);
    asked.areas = vec![area("near", [-40.0, 10.0], [40.0, 40.0]), area("far", [-40.0, 300.0], [40.0, 340.0])];
    let found = judged(&asked, "ch-zh-abv", &[]);
    assert_eq!([found.receivers[0].ruling.verdict, found.receivers[1].ruling.verdict], [Verdict::Fail, Verdict::Pass]);
    // nobody compares a lawful body, and that is said
    assert!(found.notes.iter().any(|note| note.to_string().contains("no lawful body is compared")));
    // no point of a fine grid is worse, but for what changes within a step
    let grid = (0..=40).flat_map(|x| (0..=15).map(move |y| (x, y)));
    let worst = grid
        .map(|(x, y)| {
            let mut one = asked.clone();
            let at = [-39.999 + f64::from(x) * 1.9995, 10.001 + f64::from(y) * 1.9995];
            one.areas = vec![area("one", at, [at[0] + 0.002, at[1] + 0.002])];
            value_secs(&judged(&one, "ch-zh-abv", &[]).receivers[0])
        })
        .max()
        .expect("points");
    assert!(value_secs(&found.receivers[0]) >= worst - 5, "{} {worst}", value_secs(&found.receivers[0]));
}
