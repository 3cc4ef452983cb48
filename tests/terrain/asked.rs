//! What counts as terrain according to files and keys, how buildings stand on it, and probes above and below it.

use super::{mesh, terrain, track, valley, vienna};
use crate::shared::said;
use crate::shared::scenes::cuboid;
use crate::site::{SITE, folder, load};
use chrono::TimeDelta;
use glam::{DVec3, dvec3};
use gnomon::formats::{Model, ModelError, PartKind, ReadOptions, Up};
use gnomon::mesh::{Mesh, Part};
use gnomon::site::{Ground, GroundFrom, GroundKind, Overrides, ProbeSite, Site, SiteError};
use gnomon::study::probe::probe;
use gnomon::sun::{Air, DayWindow, delta_t_secs, position};
use gnomon::sunlight::{IntervalBound, Sunlight};
use gnomon::view::{Grid, Probe};
use std::ops::ControlFlow;
use std::path::Path;

const HEAD: &str = r#"
[place]
latitude = 48.2082
longitude = 16.3738
[study]
date = 2026-03-21
from = "9:00"
to = "15:00"
step = "1h"
[[model]]
path = "terrain.tif"
"#;

/// The slope rises a metre for each ten to the east.
fn tenth(x: f64, _: f64) -> f64 {
    0.1 * x
}

/// Blocks of 9 m height; west, east and foot are given.
fn blocks(of: &[[f64; 3]]) -> Vec<Part> {
    let block = |(at, [west, east, foot]): (usize, &[f64; 3])| {
        cuboid(&format!("block {at}"), dvec3(*west, -5.0, *foot), dvec3(*east, 5.0, foot + 9.0))
    };
    of.iter().enumerate().map(block).collect()
}

/// A reader whose files contain a slope that is marked as terrain, and blocks.
fn reader(of: &[[f64; 3]]) -> impl Fn(&Path, &ReadOptions) -> Result<Model, ModelError> {
    move |path, _| {
        Ok(match path.file_name().is_some_and(|name| name == "terrain.tif") {
            true => {
                let (parts, kinds) = (vec![terrain(60.0, tenth)], vec![PartKind::Terrain]);
                Model { parts, kinds, up: Up::Z, ..Model::default() }
            }
            false => Model { parts: blocks(of), up: Up::Z, ..Model::default() },
        })
    }
}

fn read(text: &str, of: &[[f64; 3]]) -> Result<Site, SiteError> {
    let folder = folder(text);
    for name in ["terrain.tif", "houses.glb"] {
        std::fs::write(folder.path().join(name), "").unwrap();
    }
    Site::load_with(folder.path(), &Overrides::default(), reader(of))
}

fn standing(of: &[[f64; 3]]) -> Option<String> {
    let site = read(&format!("{HEAD}[[model]]\npath = \"houses.glb\"\n"), of).unwrap();
    said(&site.notes).into_iter().find(|note| note.starts_with("houses.glb has "))
}

#[test]
fn a_key_goes_before_what_a_file_says_to_be_terrain() {
    let kind = |text: &str| read(&format!("{HEAD}{text}"), &[]).map(|site| site.ground.kind).unwrap();
    assert_eq!(kind(""), GroundKind::Terrain);
    assert_eq!(kind("terrain = true"), GroundKind::Terrain);
    assert_eq!(kind("terrain = [\"hillside\"]"), GroundKind::Terrain);
    assert_eq!(kind("terrain = false"), GroundKind::Plane);
    assert_eq!(kind("receives = false"), GroundKind::Plane);
    let wrong = read(&format!("{HEAD}terrain = [\"hilside\"]"), &[]).unwrap_err().to_string();
    assert!(wrong.contains("hilside") && wrong.contains("hillside") && wrong.contains("terrain"), "{wrong}");

    // a glTF says nothing of it; the yard of this one reaches from 0 to 1
    let yard = SITE.replace("casts = [\"iron\"]", "terrain = [\"grass\"]");
    let site = load(&yard, &Overrides::default()).unwrap();
    let is_terrain: Vec<bool> = site.mesh.components.iter().map(|component| component.is_terrain).collect();
    assert_eq!((is_terrain, site.ground.kind), (vec![false, true], GroundKind::Terrain));
}

#[test]
fn what_the_ground_is_stands_beside_the_answer() {
    let told = |text: &str| {
        let site = read(&format!("{HEAD}{text}"), &[]).unwrap();
        let note = said(&site.notes).into_iter().find(|note| note.starts_with("the ground is"));
        (site.ground, note.unwrap_or_default())
    };
    // it reaches from -6 to 6, but the plane is no cellar's
    let (ground, note) = told("");
    assert_eq!((ground.level, ground.from, ground.word()), (-6.0, GroundFrom::Lowest, "terrain"));
    assert_eq!(ground.said(), "the terrain's height; beyond the terrain at -6.00 m, the models' lowest point");
    assert_eq!(
        note,
        "the ground is the terrain \"hillside\"; beyond the terrain's edge it is a plane at -6.00 m, the models' lowest \
         point; `level` in [ground] sets it"
    );
    let (ground, note) = told("[ground]\nlevel = -7.5\n");
    assert_eq!((ground.level, ground.from, ground.word()), (-7.5, GroundFrom::Site, "terrain"));
    assert!(note.ends_with("a plane at -7.50 m, as asked"), "{note}");
    // without terrain as ever
    let (ground, note) = told("terrain = false");
    assert_ne!(ground.word(), "terrain");
    assert!(!note.contains("beyond"), "{note}");
}

#[test]
fn the_default_region_ends_with_the_terrain() {
    let region = |text: &str, of: &[[f64; 3]]| read(&format!("{HEAD}{text}"), of).unwrap().grid.region();
    let near = |region: [f64; 4]| region.iter().all(|side| (side.abs() - 62.4).abs() < 0.1);
    assert!(near(region("", &[])), "{:?}", region("", &[]));
    // as a roof it throws a shadow on the ground around it
    assert!(!near(region("terrain = false", &[])));
    // and so does what stands on it
    let house = "[[model]]\npath = \"houses.glb\"\n";
    let [west, .., north] = region(house, &[[-59.0, -50.0, 0.0]]);
    assert!(west < -64.0 && north < 80.0, "{west}, {north}");
}

#[test]
fn what_floats_and_what_sinks_is_told_with_how_much() {
    // their ground lies 2 to 3, -3 to -2, 0 to 1 and 4 to 4.1 high, and the last ones have none
    let all = [[20.0, 30.0, 1.0], [-30.0, -20.0, 0.0], [0.0, 10.0, 0.5], [40.0, 41.0, 4.05], [70.0, 75.0, 7.0]];
    assert_eq!(
        standing(&all).as_deref(),
        Some(
            "houses.glb has 5 buildings: 2 float more than 0.1 m above the terrain, by up to 3.00 m; 2 reach below the \
             terrain, as cellars do, by up to 2.00 m; 1 stands beyond the terrain's edge; light falls under what floats: \
             `position` under [[model]] moves a model"
        )
    );
    assert_eq!(standing(&all[3..4]), None);
    let sunk = standing(&all[..1]).unwrap();
    assert_eq!(sunk, "houses.glb has 1 building: 1 reaches below the terrain, as cellars do, by up to 2.00 m");
    // what nobody sees is no cellar: its heights count from elsewhere
    let buried = standing(&[all[0], [-30.0, -20.0, -20.0]]).unwrap();
    for part in [
        "2 buildings: 1 reaches below the terrain, as cellars do, by up to 2.00 m; 1 lies wholly below",
        "18.00 m below it",
    ] {
        assert!(buried.contains(part) && buried.contains("`position`"), "{buried}");
    }
    // those that touch are one, and what hangs over its foot does not float
    let joined = [[0.0, 5.0, -0.5], [5.0, 10.0, 6.0]];
    let one = standing(&joined).unwrap();
    assert!(one.starts_with("houses.glb has 1 building: 1 reaches below") && one.ends_with("up to 1.00 m"), "{one}");
    // nothing stands on what is no terrain
    let text = format!("{HEAD}terrain = false\n[[model]]\npath = \"houses.glb\"\n");
    assert!(!said(&read(&text, &all).unwrap().notes).iter().any(|note| note.contains("float")));
}

/// One building without a height of the ground, beside one that has it: each stands as its own heights say.
#[test]
fn each_part_says_for_itself_what_its_heights_count_from() {
    let all = [[20.0, 30.0, 0.0], [-30.0, -20.0, -3.0]];
    let mixed = |path: &Path, options: &ReadOptions| -> Result<Model, ModelError> {
        let model = reader(&all)(path, options)?;
        let from_ground = if path.ends_with("houses.glb") { vec![true, false] } else { Vec::new() };
        Ok(Model { from_ground, ..model })
    };
    let low = |site: &Site, name: &str| {
        let component = site.mesh.components.iter().find(|component| component.name == name).unwrap();
        let faces = component.faces.clone();
        let corners = faces.flat_map(|face| site.mesh.corners(face as usize));
        corners.map(|corner| site.mesh.origin.z + f64::from(corner.z)).fold(f64::INFINITY, f64::min)
    };
    let without_terrain = HEAD.split("[[model]]").next().unwrap();
    for (head, wanted, note) in [
        (HEAD, [2.0, -3.0], "houses.glb says no height of the ground of 1 of its 2 parts: 1 stands on the terrain"),
        (without_terrain, [0.0, -3.0], "houses.glb says no height of the ground of 1 of its 2 parts, which stands at"),
    ] {
        let folder = folder(&format!("{head}[[model]]\npath = \"houses.glb\"\n"));
        for name in ["terrain.tif", "houses.glb"] {
            std::fs::write(folder.path().join(name), "").unwrap();
        }
        let site = Site::load_with(folder.path(), &Overrides::default(), mixed).unwrap();
        let found = ["block 0", "block 1"].map(|name| low(&site, name));
        assert!(found.iter().zip(wanted).all(|(found, wanted)| (found - wanted).abs() < 1e-4), "{found:?}");
        assert!(said(&site.notes).iter().any(|told| told.starts_with(note)), "{note}: {:?}", site.notes);
    }
}

fn probing(mesh: Mesh, points: &[(DVec3, Option<DVec3>)]) -> Sunlight {
    let grid = Grid { west: -10.0, north: 10.0, cell: 1.0, width: 20, height: 20 };
    let ground: Ground = Site::in_memory(vienna(), mesh.clone(), None, track(), grid).unwrap().ground;
    let probe_of = |(at, (point, normal)): (usize, &(DVec3, Option<DVec3>))| Probe {
        name: format!("probe {at}"),
        point: *point,
        normal: *normal,
    };
    let asked = ProbeSite {
        place: vienna(),
        casts: vec![true; mesh.components.len()],
        mesh,
        notes: Vec::new(),
        words: &gnomon::message::PlainWords,
        ground,
        probes: points.iter().enumerate().map(probe_of).collect(),
        laid: Vec::new(),
        days: vec![DayWindow::on(&vienna(), "2026-03-21".parse().unwrap(), None, None).unwrap()],
        refraction: true,
    };
    probe(&asked, &mut |_| ControlFlow::Continue(())).unwrap()
}

/// A window faces east to a hill, over whose edge its sun rises.
#[test]
fn the_sun_rises_over_the_hill_for_a_house_in_the_valley() {
    let window = (dvec3(0.0, 0.0, 3.0), Some(DVec3::X));
    let house = cuboid("house", dvec3(-10.0, -5.0, 0.0), dvec3(0.0, 5.0, 8.0));
    let sunlight = probing(mesh(vec![valley(), house]), &[window]);
    let [first, ..] = sunlight.probes[0].days[0][..] else { panic!("the sun shines on it") };
    assert_eq!((first.before, sunlight.name(first.before)), (IntervalBound::Component(0), "hill".to_owned()));
    assert_eq!(first.after, IntervalBound::Behind);
    let (place, delta_t_secs) = (vienna(), delta_t_secs(first.start.to_utc()).unwrap());
    let is_behind = |secs: i64| {
        let time = first.start + TimeDelta::seconds(secs);
        let sun = position(&place, time.to_utc(), delta_t_secs, Some(Air::standard(place.elevation_m))).unwrap();
        // 97 m up on 200 m to the east, which is farther along the ray
        let rise = sun.altitude_deg.to_radians().tan();
        rise < 97.0 * sun.azimuth_deg.to_radians().sin() / (200.0 - 0.001)
    };
    assert_eq!([-1, 0].map(is_behind), [true, false]);
}

#[test]
fn a_probe_is_below_the_ground_where_the_terrain_is_above_it() {
    let half_up = |z: f64| (dvec3(150.0, 0.0, z), None);
    let sunlight = probing(mesh(vec![valley()]), &[half_up(20.0), half_up(50.0), half_up(49.9995), half_up(60.0)]);
    let of = |at: usize| (sunlight.probes[at].below_ground_m, sunlight.probes[at].secs());
    let (below, secs) = of(0);
    assert!(below.is_some_and(|below| (below - 30.0).abs() < 1e-9) && secs == 0, "{below:?}, {secs} s");
    // one on the terrain sees the sun from where all that receives is judged, however its height is rounded
    assert_eq!(of(1).0, None);
    assert!(of(1).1 > 4 * 3600);
    assert_eq!(of(1), of(2));
    assert!(of(3).1 >= of(1).1);
    // what nobody calls terrain is no ground
    let roof = probing(Mesh::build(vec![valley()]).unwrap(), &[half_up(20.0)]);
    assert_eq!(roof.probes[0].below_ground_m, None);
}
