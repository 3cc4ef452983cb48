//! A house by its dwellings.

use super::{area, endless_wall, judged, nothing, secs, site, tried, window};
use glam::{DVec3, dvec3};
use gnomon::judgement::GroupKind;
use gnomon::rules::{Quantity, Verdict};
use gnomon::site::JudgedSite;
use gnomon::sun::Place;

/// Ten dwellings with a living room and an open space each: so many look north and have all six hours, the others look where
/// there is sun in the last hour alone.
fn house(lit: usize) -> JudgedSite {
    let sydney = Place::new("", -33.87, 151.21, 0.0, Some("Australia/Sydney")).expect("a place");
    let mut asked = site(sydney, vec![nothing()], None);
    let late = DVec3::new(240f64.to_radians().sin(), 240f64.to_radians().cos(), 0.0);
    for dwelling in 0..10 {
        for usage in ["living", "open-space"] {
            let outward = if dwelling < lit { DVec3::Y } else { late };
            let at = dvec3(20.0 * dwelling as f64, 0.0, 1.0);
            let mut own = window(&format!("{usage} {dwelling}"), at, outward);
            (own.dwelling, own.usage) = (Some(format!("unit {dwelling}")), Some(usage.into()));
            asked.windows.push(own);
        }
    }
    asked
}

#[test]
fn seven_dwellings_of_ten() {
    for (lit, verdict) in [(7, Verdict::Pass), (6, Verdict::Fail)] {
        let found = judged(&house(lit), "au-nsw-adg-4a1", &[("hours", "2h")]);
        assert_eq!(found.verdict, verdict, "{lit}");
        let whole = found.groups.last().expect("the house");
        assert_eq!((whole.kind, whole.of.len()), (GroupKind::House, 10));
        let shares: Vec<Quantity> =
            whole.ruling.as_ref().expect("a ruling").findings.iter().map(|it| it.value).collect();
        assert_eq!(shares, [Quantity::Share(lit as f64 / 10.0), Quantity::Share(0.0)]);
        let late = &found.groups[9];
        assert!(late.uses.iter().all(|(_, secs)| (1..7200).contains(secs)), "{:?}", late.uses);
        assert_eq!([found.groups[0].verdict, late.verdict], [Verdict::Pass, Verdict::Fail]);
    }
}

/// A dwelling whose open space is an area of 6 m by 4 m, 0.5 m behind a wall in the north that shades some of it.
fn with_open_space(dwelling: Option<&str>) -> JudgedSite {
    let sydney = Place::new("", -33.87, 151.21, 0.0, Some("Australia/Sydney")).expect("a place");
    let mut asked = site(sydney, vec![endless_wall("wall", 0.0, 2.0)], None);
    let mut living = window("living", dvec3(0.0, 100.0, 1.0), DVec3::Y);
    (living.dwelling, living.usage) = (Some("unit 1".into()), Some("living".into()));
    asked.windows = vec![living];
    asked.areas = vec![area("terrace", [0.0, -4.5], [6.0, -0.5]), area("lawn", [50.0, 50.0], [60.0, 60.0])];
    asked.areas[0].dwelling = dwelling.map(str::to_owned);
    asked
}

/// An area is the open space of its dwelling, and lit while so many of its square metres are.
#[test]
fn an_area_is_the_open_space_of_its_dwelling() {
    let asked = with_open_space(Some("unit 1"));
    let of = |lit_area: &str| judged(&asked, "au-nsw-adg-4a1", &[("hours", "2h"), ("lit_area", lit_area)]);
    // the sun is in the north: as far south as the wall's shadow reaches, less than 4.5 m, the rest is lit
    let lit = |m2: f64| {
        let south = 4.5 - m2 / 6.0;
        move |sun: DVec3| sun.y <= 0.0 || south * sun.z > sun.y * 2.0
    };
    for m2 in [1.0, 2.5, 4.0] {
        let found = of(&m2.to_string());
        let uses = &found.groups[0].uses;
        assert_eq!(uses.iter().map(|(usage, _)| usage.as_str()).collect::<Vec<_>>(), ["living", "open-space"]);
        let expected = secs(&asked.place, &found.days[0], lit(m2));
        // where the shadow ends is known to about a centimetre, which it takes a minute for
        assert!(expected > 3600 && (uses[1].1 - expected).abs() < 240, "{m2} {} {expected}", uses[1].1);
        let terrace = &found.receivers[1];
        assert_eq!((terrace.dwelling.as_deref(), terrace.usage.as_deref()), (Some("unit 1"), Some("open-space")));
        assert!((terrace.area.expect("an area").m2 - 24.0).abs() < 1e-9);
    }
    // all of a space that is smaller than what must be lit
    assert_eq!(of("100").groups[0].uses[1].1, of("24").groups[0].uses[1].1);
    assert!(of("0").groups[0].uses[1].1 >= of("1").groups[0].uses[1].1);
    let notes: Vec<String> = of("1").notes.iter().map(ToString::to_string).collect();
    assert!(notes.iter().any(|note| note.contains("1 area has no dwelling")), "{notes:?}");
    let error = tried(&with_open_space(None), "au-nsw-adg-4a1", &[("hours", "2h")]).expect_err("no open space");
    assert!(error.to_string().contains("a window or area of use \"open-space\" in dwelling \"unit 1\""), "{error}");
}
