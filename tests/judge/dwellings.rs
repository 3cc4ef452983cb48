//! A house by its dwellings.

use super::{judged, nothing, site, window};
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
