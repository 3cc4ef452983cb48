//! A site that is made in memory from a place, named triangles, a window and a grid, and its hours of shadow.

use gnomon::choice::Engine;
use gnomon::chrono::NaiveDate;
use gnomon::glam::dvec3;
use gnomon::mesh::{Mesh, Part};
use gnomon::site::Site;
use gnomon::study::{self, Wants};
use gnomon::sun::{Place, SunTrack, Window};
use gnomon::view::Grid;
use std::ops::ControlFlow;

pub(crate) fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Metres: x is east, y north, z up, and (0, 0, 0) is the place's point.
    let wall = |name: &str, west: f64| {
        let corner = |east: f64, up: f64| dvec3(west + east, 0.0, up);
        let positions = vec![corner(0.0, 0.0), corner(10.0, 0.0), corner(10.0, 12.0), corner(0.0, 12.0)];
        Part { name: name.to_owned(), positions, triangles: vec![[0, 1, 2], [0, 2, 3]], ..Part::default() }
    };
    let mesh = Mesh::build(vec![wall("wall", -10.0), wall("glass", 0.0)])?;

    let place = Place::new("Vienna", 48.2082, 16.3738, 170.0, Some("Europe/Vienna"))?;
    let date = NaiveDate::from_ymd_opt(2026, 3, 21);
    let window = Window { date, from: "9:00".parse()?, to: "17:00".parse()?, step_secs: 600 };
    let track = SunTrack::window(&place, &window, true)?;

    let grid = Grid { west: -20.0, north: 20.0, cell: 0.5, width: 80, height: 80 };
    let mut site = Site::in_memory(place, mesh, Some(0.0), track, grid)?;
    site.casts = site.mesh.components.iter().map(|component| component.name != "glass").collect();
    site.engine = Engine::Cpu; // no graphics adapter is needed

    let profile = study::run(&site, &Wants::default(), &mut |_| ControlFlow::Continue(()))?.profile;
    let hours = |column: usize, row: usize| profile.hours(row * 80 + column);
    let (behind_wall, behind_glass, before_wall) = (hours(30, 35), hours(50, 35), hours(30, 45));
    println!(
        "hours of shadow: {behind_wall:.2} behind the wall, {behind_glass:.2} behind the glass, {before_wall:.2} before"
    );
    assert!(behind_wall > 5.0 && behind_glass < behind_wall && before_wall == 0.0);
    Ok(())
}
