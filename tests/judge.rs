//! Sites judged by rules, against what the sun's own directions say second by second, and on either side of each limit.

mod areas;
mod bands;
mod dwellings;
mod geometry;
mod kept;
mod lacking;
mod openings;
mod parts;
mod takers;
mod windows;

use crate::shared::dense::cuboid;
use glam::{DVec2, DVec3, dvec2, dvec3};
use gnomon::judgement::{Judgement, ReceiverRuling};
use gnomon::mesh::{Mesh, Part};
use gnomon::message::PlainWords;
use gnomon::rules::{Quantity, Rule, RuleDay, Spell, built_in_text};
use gnomon::site::{AreaSurface, Ground, JudgedArea, JudgedSite, JudgedState, JudgedWindow};
use gnomon::study::StudyError;
use gnomon::study::judge::judge;
use gnomon::sun::{Place, Sky, delta_t_secs};
use std::ops::ControlFlow;
use std::sync::Arc;

fn london() -> Place {
    Place::new("", 51.5, -0.13, 0.0, Some("Europe/London")).expect("a place")
}

fn beijing() -> Place {
    Place::new("", 39.9, 116.4, 0.0, Some("Asia/Shanghai")).expect("a place")
}

fn state(parts: Vec<Part>) -> JudgedState {
    let mesh = Mesh::build_around(parts, DVec3::ZERO).expect("a mesh");
    JudgedState { casts: vec![true; mesh.components.len()], mesh: Arc::new(mesh), ground: Ground::asked(0.0) }
}

/// A site without air, of 2026, on which nothing is judged yet.
fn site(place: Place, now: Vec<Part>, before: Option<Vec<Part>>) -> JudgedSite {
    JudgedSite {
        file: "site.toml".into(),
        place,
        now: state(now),
        before: before.map(state),
        notes: Vec::new(),
        words: &PlainWords,
        areas: Vec::new(),
        windows: Vec::new(),
        facades: Vec::new(),
        plot: None,
        year: 2026,
        refraction: false,
    }
}

/// What stands far off and shades nothing, where a mesh must not be empty.
fn nothing() -> Part {
    cuboid("far off", dvec3(0.0, -9000.0, -2.0), dvec3(1.0, -8999.0, -1.0))
}

/// A wall from far in the west to far in the east, its top edge at y and z.
fn endless_wall(name: &str, y: f64, z: f64) -> Part {
    cuboid(name, dvec3(-5000.0, y - 0.001, 0.0), dvec3(5000.0, y, z))
}

fn area(name: &str, [west, south]: [f64; 2], [east, north]: [f64; 2]) -> JudgedArea {
    let ring = vec![dvec2(west, south), dvec2(east, south), dvec2(east, north), dvec2(west, north)];
    JudgedArea { name: name.to_owned(), rings: vec![ring], surface: AreaSurface::Ground(0.0), dwelling: None }
}

/// A window 2 m wide and 1.5 m high, its sill's middle at a point.
fn window(name: &str, sill: DVec3, outward: DVec3) -> JudgedWindow {
    let right = DVec3::Z.cross(outward).normalize();
    let [left, right] = [sill - right, sill + right];
    let up = DVec3::Z * 1.5;
    JudgedWindow {
        name: name.to_owned(),
        component: None,
        corners: [left, right, right + up, left + up],
        outward,
        other_side: None,
        reveal_m: 0.0,
        reveal_is_said: true,
        inner_m: None,
        floor: None,
        room: None,
        dwelling: None,
        usage: None,
        room_m2: None,
    }
}

fn tried(site: &JudgedSite, id: &str, options: &[(&str, &str)]) -> Result<Judgement, StudyError> {
    let rule = Rule::parse(id, built_in_text(id).expect("built in")).expect("a rule");
    let resolved = rule.resolve(options).expect("options");
    judge(site, &rule.source, &resolved, &mut |_| ControlFlow::Continue(()))
}

fn judged(site: &JudgedSite, id: &str, options: &[(&str, &str)]) -> Judgement {
    tried(site, id, options).expect("a judgement")
}

/// The seconds of a day's windows in which the sun is up and is so, each second asked.
fn secs(place: &Place, day: &RuleDay, is_lit: impl Fn(DVec3) -> bool) -> i64 {
    suns(place, &day.windows).filter(|to_sun| to_sun.z > 0.0 && is_lit(*to_sun)).count() as i64
}

fn suns<'a>(place: &'a Place, windows: &'a [Spell]) -> impl Iterator<Item = DVec3> + 'a {
    use chrono::TimeZone;
    windows.iter().flat_map(|window| window.start..window.end).map(move |secs| {
        let utc = chrono::DateTime::from_timestamp(secs, 0).expect("a time").naive_utc();
        let time = place.time_zone.from_utc_datetime(&utc);
        let sky = Sky { place, delta_t_secs: delta_t_secs(time.to_utc()).expect("ΔT"), air: None };
        sky.at(time).expect("a sun").to_sun
    })
}

/// Whether an endless wall, so far to the south and so high above a point, leaves it the sun.
fn over_wall(to_sun: DVec3, away: f64, above: f64) -> bool {
    to_sun.y >= 0.0 || away * to_sun.z > -to_sun.y * above
}

fn value_secs(receiver: &ReceiverRuling) -> i64 {
    match receiver.ruling.deciding.map(|at| receiver.ruling.findings[at].value) {
        Some(Quantity::Secs(secs)) => secs,
        other => panic!("{other:?}"),
    }
}

/// The part of an area that keeps the demand.
fn share(receiver: &ReceiverRuling) -> f64 {
    match receiver.ruling.deciding.map(|at| receiver.ruling.findings[at].value) {
        Some(Quantity::AreaM2(m2)) => m2 / receiver.area.expect("an area").m2,
        other => panic!("{other:?}"),
    }
}

fn corner(x: f64, y: f64) -> DVec2 {
    dvec2(x, y)
}
