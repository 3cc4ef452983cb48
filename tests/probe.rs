//! `gnomon probe`: intervals against closed forms that compute the sun's position second by second, against masks of
//! ray casting, and on unusual days; then as users run it.

mod asked;
mod sky;
mod together;
mod twin;

use crate::shared::drawing::{plan, scene_of};
use crate::shared::scenes::{cuboid, sheet, small};
use chrono::{NaiveDate, TimeDelta};
use glam::{DVec2, DVec3, dvec3};
use gnomon::choice::Receivers;
use gnomon::cli::Options;
use gnomon::export::figure;
use gnomon::mesh::{Mesh, Part};
use gnomon::shadow::Technique;
use gnomon::shadow::ray_cast::RayCast;
use gnomon::site::{Ground, ProbeSite};
use gnomon::study::StudyError;
use gnomon::study::probe::probe;
use gnomon::sun::{Air, DayWindow, Place, Position, Reading, Sky, Zone, delta_t_secs, position};
use gnomon::sunlight::{Interval, IntervalBound, Sunlight, longest, secs};
use gnomon::view::{Probe, View};
use std::ops::ControlFlow;

fn place(latitude: f64, longitude: f64, zone: &str) -> Place {
    Place::new("somewhere", latitude, longitude, 35.0, Some(zone)).unwrap()
}

fn paris() -> Place {
    place(48.8583, 2.2945, "Europe/Paris")
}

fn date(text: &str) -> NaiveDate {
    text.parse().unwrap()
}

/// All of a date, or between readings.
fn day(place: &Place, on: &str, window: Option<[&str; 2]>) -> DayWindow {
    let readings: Option<[Reading; 2]> = window.map(|texts| texts.map(|text| text.parse().unwrap()));
    let [from, to] = [0, 1].map(|index| readings.as_ref().map(|readings| &readings[index]));
    DayWindow::on(place, date(on), from, to).unwrap()
}

fn at(point: DVec3, normal: Option<DVec3>) -> Probe {
    Probe { name: "probe".to_owned(), point, normal }
}

fn probing(place: &Place, parts: Vec<Part>, probes: Vec<Probe>, days: Vec<DayWindow>) -> ProbeSite {
    let mesh = Mesh::build(parts).unwrap();
    let casts = vec![true; mesh.components.len()];
    let (place, notes, ground) = (place.clone(), Vec::new(), Ground::asked(0.0));
    let words = &gnomon::message::PlainWords;
    ProbeSite { place, mesh, notes, words, casts, ground, probes, laid: Vec::new(), days, refraction: true }
}

fn found(asked: &ProbeSite) -> Sunlight {
    probe(asked, &mut |_| ControlFlow::Continue(())).unwrap()
}

/// The sun, asked directly and not by the search.
fn sun(place: &Place, time: chrono::DateTime<Zone>, delta_t_secs: f64) -> Position {
    position(place, time.to_utc(), delta_t_secs, Some(Air::standard(place.elevation_m))).unwrap()
}

/// Whether the altitude, as it is printed, is not below 0.
fn is_up(sun: &Position) -> bool {
    sun.altitude_deg > -0.5e-5
}

/// First and last seconds in sunlight of a day, by asking at each of its seconds.
fn second_by_second(place: &Place, day: &DayWindow, lit: impl Fn(&Position) -> bool) -> Vec<[i64; 2]> {
    let delta_t_secs = delta_t_secs(day.from.to_utc()).unwrap();
    let mut found: Vec<[i64; 2]> = Vec::new();
    let mut before = false;
    for second in 0..(day.to - day.from).num_seconds() {
        let sun = sun(place, day.from + TimeDelta::seconds(second), delta_t_secs);
        let now = is_up(&sun) && lit(&sun);
        match (before, now) {
            (false, true) => found.push([second, second + 1]),
            (true, true) => found.last_mut().unwrap()[1] = second + 1,
            _ => {}
        }
        before = now;
    }
    found
}

/// Expects the same intervals, each end within a second.
fn same(found: &[Interval], day: &DayWindow, truth: &[[i64; 2]]) {
    let seconds = |interval: &Interval| [interval.start, interval.end].map(|time| (time - day.from).num_seconds());
    let found: Vec<_> = found.iter().map(seconds).collect();
    let near = |[a, b]: [i64; 2], [c, d]: [i64; 2]| a.abs_diff(c) <= 1 && b.abs_diff(d) <= 1;
    let equal = found.len() == truth.len() && found.iter().zip(truth).all(|(one, other)| near(*one, *other));
    assert!(equal, "{found:?} is not {truth:?}");
}

/// South of the window, so long that its ends are never in the sun's way.
fn wall(top: f64) -> Part {
    let far = 100_000.0;
    let [west, east] = [-far, far].map(|x| dvec3(x, -20.0, 0.0));
    Part { name: "wall".into(), ..sheet([west, east, east + DVec3::Z * top, west + DVec3::Z * top]) }
}

/// The intervals of a window 3.5 m above the ground and 20 m behind the wall, and those in which the southern sun, seen
/// along the wall, is above atan(height / distance).
fn behind_a_wall(on: &str, top: f64, height: f64) -> (DayWindow, Sunlight, Vec<[i64; 2]>) {
    let place = paris();
    let day = day(&place, on, None);
    let window = at(dvec3(3.0, 0.0, 3.5), None);
    let sunlight = found(&probing(&place, vec![wall(top)], vec![window], vec![day.clone()]));
    let clears = |sun: &Position| {
        let south = -sun.azimuth_deg.to_radians().cos();
        south <= 0.0 || sun.altitude_deg.to_radians().tan() / south > height / 20.0
    };
    let truth = second_by_second(&place, &day, clears);
    (day, sunlight, truth)
}

#[test]
fn a_long_wall_hides_the_sun_below_its_edge() {
    use IntervalBound::{Component, Horizon};
    let wall = Component(0);
    for (on, top, bounds) in [
        ("2026-04-10", 29.5, &[Horizon, wall, wall, Horizon][..]),
        ("2026-06-21", 29.5, &[Horizon, Horizon]),
        ("2026-12-21", 29.5, &[]),
        ("2026-12-21", 7.5, &[wall, wall]),
    ] {
        let (day, sunlight, truth) = behind_a_wall(on, top, top - 3.5);
        let intervals = &sunlight.probes[0].days[0];
        same(intervals, &day, &truth);
        let found: Vec<_> = intervals.iter().flat_map(|interval| [interval.before, interval.after]).collect();
        assert_eq!(found, bounds, "{on}");
        assert_eq!(sunlight.name(wall), "wall");
    }
}

/// A wall that is two centimetres higher is not the same: the comparison above can fail.
#[test]
#[should_panic(expected = "is not [[")]
fn a_wall_of_another_height_is_seen() {
    let (day, sunlight, truth) = behind_a_wall("2026-04-10", 29.5, 26.02);
    same(&sunlight.probes[0].days[0], &day, &truth);
}

#[test]
fn a_north_facade_has_sun_early_and_late_in_summer() {
    let place = paris();
    let day = day(&place, "2026-06-21", None);
    // the house behind the façade casts, and the façade is judged a millimetre before it
    let house = cuboid("house", dvec3(-5.0, -9.0, 0.0), dvec3(5.0, 0.0, 9.0));
    let asked = probing(&place, vec![house], vec![at(dvec3(0.0, 0.0, 4.0), Some(DVec3::Y))], vec![day.clone()]);
    let sunlight = found(&asked);
    let intervals = &sunlight.probes[0].days[0];
    same(intervals, &day, &second_by_second(&place, &day, |sun| sun.azimuth_deg.to_radians().cos() > 0.0));
    let bounds: Vec<_> = intervals.iter().flat_map(|interval| [interval.before, interval.after]).collect();
    assert_eq!(bounds, [IntervalBound::Horizon, IntervalBound::Behind, IntervalBound::Behind, IntervalBound::Horizon]);
    let [early, late] = [intervals[0].secs(), intervals[1].secs()];
    let probed = &sunlight.probes[0];
    assert_eq!((probed.secs(), probed.longest().unwrap().secs()), (early + late, early.max(late)));
}

#[test]
fn the_nearest_component_blocks() {
    let place = paris();
    let day = day(&place, "2026-03-21", None);
    let far = cuboid("far", dvec3(-30.0, -60.0, 0.0), dvec3(30.0, -50.0, 90.0));
    // as wide in the sky at its right side, and as high
    let near = cuboid("near", dvec3(-3.0, -12.0, 0.0), dvec3(9.0, -10.0, 30.0));
    let point = at(dvec3(0.0, 0.0, 1.0), None);
    for parts in [vec![far.clone(), near.clone()], vec![near, far]] {
        let asked = probing(&place, parts, vec![point.clone()], vec![day.clone()]);
        let sunlight = found(&asked);
        let [before, after] = sunlight.probes[0].days[0][..] else { panic!("{sunlight:?}") };
        // the near one hides the sun first, and the far one when it is past the near one
        assert_eq!([before.after, after.before].map(|blocked| sunlight.name(blocked)), ["near", "far"]);
        // what does not cast is looked through
        let casts = asked.mesh.components.iter().map(|component| component.name == "far").collect();
        let sunlight = found(&ProbeSite { casts, ..asked });
        assert_eq!(sunlight.name(sunlight.probes[0].days[0][0].after), "far");
    }
}

/// A component may be called as the words are.
#[test]
fn components_are_told_from_words() {
    let place = paris();
    let parts = vec![cuboid("window", dvec3(-3.0, -12.0, 0.0), dvec3(3.0, -10.0, 30.0))];
    let days = vec![day(&place, "2026-03-21", None)];
    let sunlight = found(&probing(&place, parts, vec![at(DVec3::Z, None)], days));
    assert_eq!(sunlight.name(sunlight.probes[0].days[0][0].after), "window (component)");
    assert_eq!(sunlight.name(IntervalBound::Window), "window");
}

/// How often the mask of ray casting and the intervals disagree about cells of the ground, at a study's instants.
fn disagreements(mesh: &Mesh, view: View, day: &DayWindow, sunlight: &Sunlight, cells: &[(u32, u32)]) -> usize {
    let place = paris();
    let View::Plan(grid) = view else { return usize::MAX };
    let mut rays = RayCast::new(scene_of(mesh, Receivers::Ground, 0.0), view, None);
    let delta_t_secs = delta_t_secs(day.from.to_utc()).unwrap();
    let mut count = 0;
    let mut time = day.from;
    while time < day.to {
        let instant =
            Sky { place: &place, delta_t_secs, air: Some(Air::standard(place.elevation_m)) }.at(time).unwrap();
        let mask = (!instant.night).then(|| rays.draw(instant.to_sun).unwrap().read().unwrap());
        for (&(column, row), probed) in cells.iter().zip(&sunlight.probes) {
            let lit = mask.as_ref().is_some_and(|mask| mask.share[(row * grid.width + column) as usize] == 255);
            let within = |interval: &Interval| (interval.start..interval.end).contains(&time);
            count += usize::from(probed.days[0].iter().any(within) != lit);
        }
        time += TimeDelta::minutes(7);
    }
    count
}

#[test]
fn probes_agree_with_the_masks_of_ray_casting() {
    let (place, view) = (paris(), plan(22.371_93, 12));
    let View::Plan(grid) = view else { unreachable!() };
    let cells: Vec<(u32, u32)> = (0..12).map(|index| (index, (index * 5 + 1) % 12)).collect();
    let day = day(&place, "2026-05-06", None);
    for (name, parts) in small() {
        let probes = cells.iter().map(|&(column, row)| {
            // as masks do, a hair beside the very centre
            let centre = grid.centre(column, row) + DVec2::new(1e-4, -1e-5) * grid.cell;
            at(centre.extend(0.0), Some(DVec3::Z))
        });
        let asked = probing(&place, parts, probes.collect(), vec![day.clone()]);
        let mut sunlight = found(&asked);
        assert_eq!(disagreements(&asked.mesh, view, &day, &sunlight, &cells), 0, "{name}");
        // an interval less is seen
        let last = sunlight.probes.iter_mut().find(|probed| probed.days[0].len() > 1);
        if let Some(probed) = last {
            probed.days[0].remove(0);
            assert!(disagreements(&asked.mesh, view, &day, &sunlight, &cells) > 0, "{name}");
        }
    }
}

#[test]
fn days_on_which_clocks_change_have_23_and_25_hours() {
    let place = paris();
    for (on, hours) in [("2026-03-29", 23), ("2026-10-25", 25), ("2026-06-21", 24)] {
        let day = day(&place, on, None);
        assert_eq!((day.to - day.from).num_hours(), hours);
        let sunlight =
            found(&probing(&place, vec![wall(21.5)], vec![at(dvec3(0.0, 0.0, 90.0), None)], vec![day.clone()]));
        same(&sunlight.probes[0].days[0], &day, &second_by_second(&place, &day, |_| true));
    }
    // Egypt's clocks go on at midnight, and Samoa had no 30 December
    let cairo = place_of("Africa/Cairo", "2024-04-26");
    assert_eq!(
        (cairo.from.to_rfc3339(), (cairo.to - cairo.from).num_hours()),
        ("2024-04-26T01:00:00+03:00".into(), 23)
    );
    let apia = place_of("Pacific/Apia", "2011-12-30");
    assert_eq!(apia.from, apia.to);
}

fn place_of(zone: &str, on: &str) -> DayWindow {
    day(&place(0.0, 0.0, zone), on, None)
}

#[test]
fn polar_days_and_nights() {
    let place = place(69.65, 18.96, "Europe/Oslo");
    let days = ["2026-06-20", "2026-06-21", "2026-12-21"].map(|on| day(&place, on, None));
    let asked = probing(&place, vec![wall(21.5)], vec![at(dvec3(0.0, 0.0, 90.0), None)], days.to_vec());
    let sunlight = found(&asked);
    let [one, other, night] = &sunlight.probes[0].days[..] else { panic!() };
    for (intervals, day) in [(one, &days[0]), (other, &days[1])] {
        let whole =
            Interval { start: day.from, end: day.to, before: IntervalBound::Window, after: IntervalBound::Window };
        assert_eq!(intervals, &[whole]);
        assert_eq!(secs(intervals), 86_400);
    }
    assert!(night.is_empty() && sunlight.days[2].up.is_empty() && longest(night).is_none());
    let [(least_on, least), (most_on, most)] = sunlight.least_and_most(&sunlight.probes[0]).unwrap();
    assert_eq!((least_on, least, most_on, most), (date("2026-12-21"), 0, date("2026-06-20"), 86_400));
    assert!(figure::strips(&sunlight, &place, &Ground::asked(0.0), &Options).is_ok());
    // the sun is up for less than two hours: an hour after it rises it sets within the hour
    let short = day(&place, "2026-01-16", Some(["sunrise+1h", "sunset-1h"]));
    assert_eq!(short.from, short.to);
    let nothing = found(&probing(&place, vec![wall(21.5)], vec![at(DVec3::Z * 90.0, None)], vec![short]));
    assert_eq!(nothing.probes[0].secs(), 0);
}

#[test]
fn windows_cut_intervals_and_ranges_are_their_days() {
    let place = paris();
    let all = ["2026-09-17", "2026-09-18", "2026-09-19"].map(|on| day(&place, on, Some(["10:00", "16:00"])));
    let probes = || vec![at(dvec3(3.0, 0.0, 3.5), None), at(dvec3(0.0, 0.0, 90.0), None)];
    let together = found(&probing(&place, vec![wall(21.5)], probes(), all.to_vec()));
    for (index, day) in all.iter().enumerate() {
        let alone = found(&probing(&place, vec![wall(21.5)], probes(), vec![day.clone()]));
        for (one, other) in together.probes.iter().zip(&alone.probes) {
            assert_eq!(one.days[index], other.days[0]);
        }
        let whole =
            Interval { start: day.from, end: day.to, before: IntervalBound::Window, after: IntervalBound::Window };
        assert_eq!(together.probes[1].days[index], [whole]);
    }
    let night = day(&place, "2026-09-18", Some(["22:00", "7:00"]));
    assert_eq!((night.to - night.from).num_hours(), 9);
}

#[test]
fn interruption_is_heard_between_days() {
    let place = paris();
    let days = date("2026-01-01").iter_days().take(200).map(|date| DayWindow::on(&place, date, None, None).unwrap());
    let asked = probing(&place, vec![wall(21.5)], vec![at(DVec3::Z, None)], days.collect());
    let mut heard = 0;
    let stopped = probe(&asked, &mut |_| {
        heard += 1;
        if heard == 3 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    assert!(matches!(stopped, Err(StudyError::Interrupted)) && heard == 3);
}

/// As on patches: what lies below the ground sees no sun, the wall above it does.
#[test]
fn below_the_ground_there_is_no_sun() {
    let place = paris();
    let day = day(&place, "2026-06-21", None);
    let house = cuboid("house", dvec3(-5.0, 0.0, -3.0), dvec3(5.0, 9.0, 9.0));
    let wall = |z: f64| at(dvec3(0.0, 0.0, z), Some(DVec3::NEG_Y));
    let mut asked = probing(&place, vec![house], vec![wall(-1.0), wall(0.0), wall(1.0)], vec![day]);
    let secs =
        |asked: &ProbeSite| found(asked).probes.iter().map(gnomon::sunlight::ProbeIntervals::secs).collect::<Vec<_>>();
    let above = secs(&asked);
    assert!(above[0] == 0 && above[1] > 20_000 && above[1] == above[2], "{above:?}");
    asked.ground.level = -3.0;
    assert_eq!(secs(&asked)[0], above[1]);
}
