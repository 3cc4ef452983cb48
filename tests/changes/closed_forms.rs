//! A box and an infinite wall, whose shadows come and go at times that are known to the second.

use crate::shared::scenes::{cuboid, joined};
use chrono::{NaiveDate, TimeDelta};
use glam::{DVec3, dvec3};
use gnomon::choice::{Engine, Receivers};
use gnomon::mesh::{Mesh, Part};
use gnomon::site::Site;
use gnomon::study::{self, Wants, patches};
use gnomon::sun::{Place, SunTrack, Window};
use gnomon::view::Grid;
use std::ops::ControlFlow;

fn vienna() -> Place {
    Place::new("Vienna", 48.2082, 16.3738, 170.0, Some("Europe/Vienna")).unwrap()
}

/// From eight to four by the hour, with times of change to the second.
fn track(month: u32) -> SunTrack {
    let date = NaiveDate::from_ymd_opt(2026, month, 21);
    let window = Window { date, from: "8:00".parse().unwrap(), to: "16:00".parse().unwrap(), step_secs: 3600 };
    SunTrack { resolution_secs: 1, ..SunTrack::window(&vienna(), &window, true).unwrap() }
}

fn site(month: u32, part: Part, grid: Grid, receivers: Receivers) -> Site {
    let mesh = Mesh::build(vec![part]).unwrap();
    let site = Site::in_memory(vienna(), mesh, Some(0.0), track(month), grid).unwrap();
    Site { engine: Engine::Cpu, receivers, ..site }
}

/// The sun at every second of the window.
fn seconds(track: &SunTrack) -> Vec<DVec3> {
    let (place, first) = (vienna(), track.instants[0].time);
    let sky = track.sky(&place);
    (0..=8 * 3600).map(|secs| sky.at(first + TimeDelta::seconds(secs)).unwrap().to_sun).collect()
}

/// The seconds in shadow, how often that changes, and whether no hour has more than one change.
fn truth(suns: &[DVec3], is_shaded: impl Fn(DVec3) -> bool) -> (u64, u64, bool) {
    let shaded: Vec<bool> = suns.iter().map(|to_sun| is_shaded(*to_sun)).collect();
    let changes = |hour: &[bool]| hour.windows(2).filter(|pair| pair[0] != pair[1]).count();
    let is_plain = (0..8).all(|hour| changes(&shaded[hour * 3600..=(hour + 1) * 3600]) < 2);
    let secs = shaded[..suns.len() - 1].iter().filter(|shaded| **shaded).count();
    (secs as u64, changes(&shaded) as u64, is_plain)
}

/// The seconds in shadow of every cell equal the closed form, to within a second per change. Returns the number of
/// changes.
fn holds(site: &Site, is_shaded: impl Fn(DVec3, DVec3) -> bool) -> u64 {
    let shaded = study::run(site, &Wants::default(), &mut |_| ControlFlow::Continue(())).unwrap().profile.shaded;
    let suns = seconds(&site.track);
    let (mut all, mut several) = (0, 0);
    for row in 0..site.grid.height {
        for column in 0..site.grid.width {
            let at = site.grid.centre(column, row).extend(0.001);
            let (secs, changes, is_plain) = truth(&suns, |to_sun| is_shaded(at, to_sun));
            let found = shaded.of((row * site.grid.width + column) as usize);
            assert_eq!(found % 255, 0, "whole seconds");
            if is_plain {
                assert!(
                    found / 255 <= secs + changes && secs <= found / 255 + changes,
                    "{at}: {} not {secs} s",
                    found / 255
                );
                all += changes;
            }
            several += u32::from(!is_plain);
        }
    }
    assert!(several * 4 < site.grid.width * site.grid.height, "{several} cells change too often");
    all
}

#[test]
fn an_endless_wall() {
    let wall = cuboid("wall", dvec3(-9000.0, 0.0, 0.0), dvec3(9000.0, 1.0, 20.0));
    let grid = Grid { west: -0.51, north: 350.3, cell: 6.7, width: 1, height: 52 };
    // north of it the ray rises to the top edge, or not
    let is_shaded = |at: DVec3, to_sun: DVec3| to_sun.y < 0.0 && at.z + (at.y - 1.0) * to_sun.z / -to_sun.y < 20.0;
    let changes = holds(&site(12, wall, grid, Receivers::Ground), is_shaded);
    assert!(changes >= 30, "{changes} changes");
}

#[test]
fn a_box() {
    let (low, high) = (dvec3(-6.0, -4.0, 0.0), dvec3(7.0, 5.0, 21.0));
    let grid = Grid { west: -39.7, north: 50.2, cell: 6.1, width: 13, height: 8 };
    let is_shaded = |at: DVec3, to_sun: DVec3| {
        let [near, far] = [(low - at) / to_sun, (high - at) / to_sun];
        let (enters, leaves) = (near.min(far).max_element(), near.max(far).min_element());
        enters < leaves && leaves > 0.0
    };
    let tower = || cuboid("tower", low, high);
    for receivers in [Receivers::Ground, Receivers::Top] {
        let raised = |at: DVec3| {
            (receivers == Receivers::Top && low.x < at.x && at.x < high.x && low.y < at.y && at.y < high.y)
                .then_some(at.with_z(high.z + 0.001))
        };
        let is_shaded = |at: DVec3, to_sun: DVec3| is_shaded(raised(at).unwrap_or(at), to_sun);
        let changes = holds(&site(3, tower(), grid, receivers), is_shaded);
        assert!(changes > 60, "{changes} changes");
    }
}

#[test]
fn a_free_facade() {
    let grid = Grid { west: -10.0, north: 10.0, cell: 5.0, width: 4, height: 4 };
    let site = site(3, cuboid("house", dvec3(-5.0, -4.0, 0.0), dvec3(5.0, 4.0, 6.0)), grid, Receivers::Patches);
    let found = patches(&site, 1.0, &mut |_| ControlFlow::Continue(())).unwrap();
    let suns = seconds(&site.track);
    let mut turns = 0;
    for patch in &found.patches.list {
        let (shaded, changes, is_plain) = truth(&suns, |to_sun| to_sun.dot(patch.normal()) <= 0.0);
        assert!(is_plain);
        let lit = 8 * 3600 - shaded;
        for at in patch.texels.clone() {
            let found = u64::from(found.hours.lit[at as usize]);
            assert!(found.abs_diff(lit) <= changes, "{}: {found} not {lit} s", patch.normal());
        }
        turns += changes;
    }
    assert!(turns >= 2, "{turns} changes");
}

#[test]
fn facades_beside_a_block_have_the_hours_of_minutes() {
    let grid = Grid { west: -10.0, north: 10.0, cell: 5.0, width: 4, height: 4 };
    let found = |step_secs: u32, resolution_secs: u32| {
        let house = cuboid("house", dvec3(-5.0, 10.0, 0.0), dvec3(5.0, 18.0, 9.0));
        let block = cuboid("block", dvec3(-20.0, -12.0, 0.0), dvec3(8.0, -4.0, 16.0));
        let mut site = site(3, joined(vec![house, block]), grid, Receivers::Patches);
        let window = Window {
            date: NaiveDate::from_ymd_opt(2026, 3, 21),
            from: "8:00".parse().unwrap(),
            to: "16:00".parse().unwrap(),
            step_secs,
        };
        site.track = SunTrack { resolution_secs, ..SunTrack::window(&vienna(), &window, true).unwrap() };
        patches(&site, 1.0, &mut |_| ControlFlow::Continue(())).unwrap().hours.lit
    };
    let (stepped, searched, alone) = (found(60, 0), found(3600, 60), found(3600, 0));
    let off =
        |lit: &[u32], secs: u32| lit.iter().zip(&stepped).filter(|(one, other)| one.abs_diff(**other) > secs).count();
    let (searched, alone) = (off(&searched, 0), off(&alone, 60));
    assert!(
        searched * 50 < stepped.len() && alone * 20 > stepped.len(),
        "{searched} of {} are off, {alone} alone",
        stepped.len()
    );
}
