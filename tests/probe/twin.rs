//! The search against a slow reference with a ray at each second: the same intervals with the same bounds.

use super::{at, day, found, place, probing};
use crate::shared::scenes::{cuboid, joined, sheet, small};
use glam::{DVec3, dvec3};
use gnomon::mesh::Part;
use gnomon::site::{Overrides, ProbeSite, load_probes};
use gnomon::study::probe::probe_by_grid;
use gnomon::sun::{Air, DayWindow, Place};
use gnomon::sunlight::{Interval, JudgedPoint, ProbeSearch, SearchedDays, Sunlight};
use gnomon::view::Probe;
use std::path::Path;

/// Every probe's intervals of every day.
fn all(sunlight: &Sunlight) -> Vec<&Vec<Interval>> {
    sunlight.probes.iter().flat_map(|probed| &probed.days).collect()
}

/// Expects the same of both, and returns the number of intervals.
fn same_as_twin(asked: &ProbeSite, what: &str) -> usize {
    let (found, twin) = (found(asked), probe_by_grid(asked, 1).unwrap());
    for (one, other) in found.days.iter().zip(&twin.days) {
        assert_eq!(one.up, other.up, "{what}");
    }
    assert_eq!(all(&found), all(&twin), "{what}");
    all(&found).iter().map(|day| day.len()).sum()
}

/// Days in the north, in the south, beyond the polar circle and on the equator; parts of them, as the twin is slow.
fn skies() -> Vec<(Place, DayWindow)> {
    [
        (48.8583, 2.2945, "Europe/Paris", "2026-05-06", ["10:30", "11:20"]),
        (48.8583, 2.2945, "Europe/Paris", "2026-12-21", ["8:30", "9:30"]),
        (-33.86, 151.21, "Australia/Sydney", "2026-01-12", ["19:20", "20:20"]),
        (69.65, 18.96, "Europe/Oslo", "2026-06-21", ["23:50", "0:50"]),
        (0.1, 32.5, "Africa/Kampala", "2026-03-20", ["12:10", "13:00"]),
    ]
    .map(|(latitude, longitude, zone, on, window)| {
        let place = place(latitude, longitude, zone);
        let day = day(&place, on, Some(window));
        (place, day)
    })
    .into()
}

#[test]
fn small_scenes_on_all_skies() {
    let mut intervals = 0;
    for (place, day) in skies() {
        for (name, parts) in small() {
            let probes = vec![
                at(dvec3(-12.3, 1.7, 0.4), None),
                at(dvec3(7.1, 10.9, 1.3), Some(dvec3(0.6, -0.8, 0.0))),
                at(dvec3(0.4, -9.7, 0.0), Some(DVec3::Z)),
                at(dvec3(1.1, 0.6, 3.2), Some(DVec3::NEG_Y)),
            ];
            let asked = probing(&place, parts, probes, vec![day.clone()]);
            intervals += same_as_twin(&asked, &format!("{name} at {}", place.latitude_deg));
        }
    }
    assert!(intervals > 40, "{intervals}");
}

/// A lattice of bars and slits, each some seconds wide to the sun.
fn lattice() -> Part {
    let bars = (0..160).map(|bar| {
        let x = f64::from(bar) * 0.05 - 4.0;
        // no two slits are alike
        let width = 0.022 + 0.0001 * f64::from(bar % 37);
        cuboid("lattice", dvec3(x, -10.0, 0.0), dvec3(x + width, -9.99, 12.0))
    });
    joined(bars.collect())
}

#[test]
fn lamps_of_light_between_bars_are_found() {
    let paris = super::paris();
    let noon = day(&paris, "2026-03-21", Some(["12:30", "13:40"]));
    let probes = vec![at(dvec3(0.0, 0.0, 1.0), None), at(dvec3(0.3, 0.0, 1.0), Some(DVec3::NEG_Y))];
    let asked = probing(&paris, vec![lattice()], probes, vec![noon]);
    let intervals = same_as_twin(&asked, "lattice");
    let found = found(&asked);
    let short = all(&found).into_iter().flatten().filter(|interval| interval.secs() < 60).count();
    assert!(intervals > 60 && short > 10, "{intervals} intervals, {short} of them shorter than a minute");
    // a grid of a minute misses some: the comparison can fail
    assert_ne!(all(&found), all(&probe_by_grid(&asked, 60).unwrap()));
}

/// A glimpse of the sun of two seconds, and one of a single second's shade.
#[test]
fn what_lasts_two_seconds_is_found() {
    let paris = super::paris();
    let window = day(&paris, "2026-03-21", Some(["12:30", "13:10"]));
    let wall = |west: f64, east: f64| {
        let [west, east] = [west, east].map(|x| dvec3(x, -100.0, 0.0));
        Part { name: "wall".into(), ..sheet([west, east, east + DVec3::Z * 900.0, west + DVec3::Z * 900.0]) }
    };
    // the sun crosses some 15 mm a second at 100 m
    let slit = vec![joined(vec![wall(-500.0, 0.0), wall(0.025, 500.0)])];
    let post = vec![wall(0.0, 0.025)];
    for (parts, count) in [(slit, 1), (post, 2)] {
        let asked = probing(&paris, parts, vec![at(dvec3(0.0, 0.0, 1.0), None)], vec![window.clone()]);
        assert_eq!(same_as_twin(&asked, "glimpse"), count);
    }
}

/// Points in the plane of faces, at their corners and on their edges: where the polynomials are undecided, the ray
/// decides.
#[test]
fn points_in_the_plane_of_faces() {
    let paris = super::paris();
    let window = day(&paris, "2026-06-21", Some(["9:00", "9:40"]));
    let house = || cuboid("house", dvec3(-5.0, 0.0, 0.0), dvec3(5.0, 9.0, 8.0));
    let points = [dvec3(-9.0, 2.0, 8.0), dvec3(7.0, -3.0, 0.0), dvec3(5.0, -3.0, 4.0), dvec3(5.0, 0.0, 8.0)];
    let probes = points.map(|point| at(point, None)).to_vec();
    same_as_twin(&probing(&paris, vec![house()], probes, vec![window]), "in planes");
}

#[test]
fn the_samples_sites() {
    let sites = Path::new(env!("CARGO_MANIFEST_DIR")).join("sites");
    for (site, point, normal, window) in [
        ("tower", dvec3(0.0, 60.0, 1.5), Some(-DVec3::Y), ["11:30", "12:20"]),
        ("industry", dvec3(10.0, 12.0, 1.5), None, ["8:00", "8:50"]),
        ("headquarters", dvec3(-20.0, 95.0, 5.0), Some(-DVec3::Y), ["12:30", "13:20"]),
    ] {
        let [from, to] = window.map(|time| time.parse().ok());
        let asked =
            Overrides { point: Some(point), normal, date: "2026-10-21".parse().ok(), from, to, ..Overrides::default() };
        let mut asked = load_probes(&sites.join(site), &asked).unwrap();
        let Probe { point, normal, .. } = asked.probes[0].clone();
        asked.probes.extend((1..4).map(|step| at(point + dvec3(1.7, 0.9, 2.3) * f64::from(step), normal)));
        same_as_twin(&asked, site);
    }
}

/// Rays and polynomials never disagree: no day is tested second by second.
#[test]
fn no_day_is_distrusted() {
    let paris = super::paris();
    let days = ["2026-03-21", "2026-06-21", "2026-12-21"].map(|on| day(&paris, on, None));
    for (_, parts) in small() {
        let mesh = gnomon::mesh::Mesh::build(parts).unwrap();
        let points = [dvec3(-12.3, 1.7, 0.4), dvec3(0.4, -9.7, 0.001), dvec3(7.1, 10.9, 1.3)];
        let points = points.map(|point| JudgedPoint { point, normal: None, below_ground_m: None });
        let search = ProbeSearch::new(mesh, &points);
        let days = SearchedDays::new(&paris, &days, Some(Air::standard(35.0))).unwrap();
        for point in &points {
            search.intervals(point, &days).unwrap();
        }
        assert_eq!(search.distrusted(), 0);
    }
}
