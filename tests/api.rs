//! What other programs use: the three entry points that the library's front page shows, and what they guarantee.

#[path = "../examples/mask-of-one-sun.rs"]
mod mask_of_one_sun;
#[path = "../examples/site-in-memory.rs"]
mod site_in_memory;
#[path = "../examples/sums-of-a-study.rs"]
mod sums_of_a_study;

use crate::model::Model;
use crate::shared::memory::CountedThread;
use crate::shared::scenes::cuboid;
use chrono::{NaiveDate, TimeZone};
use glam::{DVec3, dvec3};
use gnomon::choice::{Engine, Method};
use gnomon::mesh::{Mesh, MeshError, Part};
use gnomon::profile::Shaded;
use gnomon::site::{Overrides, Site, SiteError};
use gnomon::study::{self, Budget, StudyError, TiledStudy, Wants, paste};
use gnomon::sun::{Instant, Place, SunTrack, Window};
use gnomon::view::{Grid, Tile};
use serde_json::json;
use std::ops::ControlFlow;
use std::sync::Arc;

#[test]
fn examples_run() {
    site_in_memory::main().unwrap();
    sums_of_a_study::main().unwrap();
    mask_of_one_sun::main().unwrap();
}

const GRID: Grid = Grid { west: -40.0, north: 40.0, cell: 1.0, width: 80, height: 80 };

fn vienna() -> Place {
    Place::new("Vienna", 48.2082, 16.3738, 170.0, Some("Europe/Vienna")).unwrap()
}

fn track() -> SunTrack {
    let date = NaiveDate::from_ymd_opt(2026, 3, 21);
    let window = Window { date, from: "9:00".parse().unwrap(), to: "17:00".parse().unwrap(), step_secs: 1200 };
    SunTrack::window(&vienna(), &window, true).unwrap()
}

/// A box on whole metres, which `f32` represents exactly.
fn tower() -> Part {
    cuboid("tower", dvec3(-6.0, -4.0, 0.0), dvec3(7.0, 5.0, 21.0))
}

fn site_of(mesh: Mesh) -> Site {
    let site = Site::in_memory(vienna(), mesh, None, track(), GRID).unwrap();
    Site { engine: Engine::Cpu, ..site }
}

fn sums(site: &Site) -> Shaded {
    study::run(site, &Wants::default(), &mut |_| ControlFlow::Continue(())).unwrap().profile.shaded
}

/// The part as a file has it: its y is up.
fn glb(part: &Part) -> Vec<u8> {
    let mut model = Model::new();
    let turned = part.positions.iter().flat_map(|corner| [corner.x, corner.z, -corner.y].map(|at| at as f32));
    let positions = model.f32s("VEC3", &turned.collect::<Vec<f32>>());
    let corners: Vec<u8> = part.triangles.as_flattened().iter().flat_map(|corner| corner.to_le_bytes()).collect();
    let corners = model.accessor("SCALAR", crate::model::U32, part.triangles.len() * 3, &corners);
    let primitive = json!({"attributes": {"POSITION": positions}, "indices": corners});
    model.json["meshes"] = json!([{"primitives": [primitive]}]);
    model.json["nodes"] = json!([{"mesh": 0, "name": part.name}]);
    model.glb()
}

#[test]
fn a_box_in_memory_is_the_box_of_a_file() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("tower.glb"), glb(&tower())).unwrap();
    let text = r#"
[place]
name = "Vienna"
latitude = 48.2082
longitude = 16.3738
elevation = 170.0
time_zone = "Europe/Vienna"
[[model]]
path = "tower.glb"
[study]
date = 2026-03-21
from = "9:00"
to = "17:00"
step = "20min"
[plan]
region = [-40, -40, 40, 40]
cell = 1.0
"#;
    std::fs::write(folder.path().join("site.toml"), text).unwrap();
    let asked = Overrides { engine: Some(Engine::Cpu), ..Overrides::default() };
    let of_file = Site::load(folder.path(), &asked).unwrap();
    let in_memory = site_of(Mesh::build(vec![tower()]).unwrap());

    assert_eq!(in_memory.place, of_file.place);
    assert_eq!(in_memory.track, of_file.track);
    assert_eq!(in_memory.mesh.origin, of_file.mesh.origin);
    // a file's vertices are numbered as its triangles use them
    let corners = |mesh: &Mesh| (0..mesh.faces.len()).map(|face| mesh.corners(face)).collect::<Vec<_>>();
    assert_eq!(corners(&in_memory.mesh), corners(&of_file.mesh));
    assert_eq!((in_memory.ground, in_memory.grid), (of_file.ground, of_file.grid));
    assert_eq!((in_memory.camera, &in_memory.notes), (of_file.camera, &of_file.notes));
    let found = sums(&in_memory);
    assert!(found.iter().any(|shaded| shaded > 0), "the box has a shadow");
    assert_eq!(found, sums(&of_file));
    assert_ne!(found, sums(&Site { casts: vec![false], ..in_memory }), "what does not cast has none");
}

#[test]
fn an_origin_can_be_given() {
    let middle = Mesh::build(vec![tower()]).unwrap();
    let origin = dvec3(100.0, -50.0, 7.0);
    let given = Mesh::build_around(vec![tower()], origin).unwrap();
    assert_eq!(given.origin, origin);
    assert_ne!(given.origin, middle.origin);
    assert_eq!(given.bounds(), middle.bounds());
    assert_eq!(sums(&site_of(given)), sums(&site_of(middle)));

    for origin in [DVec3::X * 1.01 * Mesh::FARTHEST_M, DVec3::splat(f64::NAN)] {
        let error = Mesh::build_around(vec![tower()], origin).unwrap_err();
        assert!(matches!(error, MeshError::FarFromOrigin { .. }), "{error}");
    }
    assert!(Mesh::build_around(vec![tower()], DVec3::X * 0.99 * Mesh::FARTHEST_M).is_ok());
}

#[test]
fn parts_and_plans_that_are_none_are_refused() {
    let mut part = tower();
    part.positions[3].y = f64::NAN;
    assert!(matches!(Mesh::build(vec![part]), Err(MeshError::NoPoint(name)) if name == "tower"));
    let mut part = tower();
    let corners = part.positions.len();
    part.triangles[2][1] = corners as u32;
    assert!(matches!(Mesh::build(vec![part]), Err(MeshError::NoCorner { corner, .. }) if corner as usize == corners));

    let mesh = || Mesh::build(vec![tower()]).unwrap();
    let refused = |mesh, ground, track, grid| Site::in_memory(vienna(), mesh, ground, track, grid).unwrap_err();
    let error = refused(Mesh::build(Vec::new()).unwrap(), None, track(), GRID);
    assert!(matches!(error, SiteError::EmptyMesh), "{error}");
    let no_instant = SunTrack { instants: Vec::new(), ..track() };
    let plans = [
        Grid { cell: 0.0, ..GRID },
        Grid { cell: f64::NAN, ..GRID },
        Grid { width: 0, ..GRID },
        Grid { width: 1 << 16, height: 1 << 16, ..GRID },
        Grid { west: f64::INFINITY, ..GRID },
    ];
    let of_plans = plans.map(|grid| refused(mesh(), None, track(), grid));
    let others = [refused(mesh(), Some(f64::NAN), track(), GRID), refused(mesh(), None, no_instant, GRID)];
    for error in of_plans.into_iter().chain(others) {
        assert!(matches!(error, SiteError::Value { .. }), "{error}");
    }
}

#[test]
fn tiles_and_instants_put_together_are_the_study() {
    let site = site_of(Mesh::build(vec![tower()]).unwrap());
    let wants = Wants { budget: Some(Budget { bytes: 300_000, drawing: 0 }), ..Wants::default() };
    for method in [Method::Projected, Method::RayCast] {
        let site = Site { method, ..site.clone() };
        let study = TiledStudy::new(&site, &wants, &mut |_| ControlFlow::Continue(())).unwrap();
        assert!(method == Method::RayCast || study.tiles().len() > 2, "{} tiles", study.tiles().len());
        let mut whole = Arc::default();
        for tile in study.tiles() {
            let mut sums = vec![0u64; tile.cells()];
            for instants in site.track.instants.chunks(7) {
                let part = study.sum(*tile, instants, &mut |_| ControlFlow::Continue(())).unwrap();
                sums.iter_mut().zip(part.iter()).for_each(|(sum, shaded)| *sum += shaded);
            }
            whole = paste(&whole, tile, &Arc::new(Shaded::from(sums)));
        }
        assert_eq!(*whole, self::sums(&site));
    }
}

#[test]
fn lists_and_tiles_of_something_else_are_refused() {
    let two = || Mesh::build(vec![tower(), Part { name: "twin".into(), ..tower() }]).unwrap();
    let whole = site_of(two());
    let on_event = &mut |_: study::Event<'_>| ControlFlow::Continue(());
    for flags in [vec![true], vec![], vec![true; 3]] {
        let of = |casts: &[bool], receives: &[bool]| Site {
            casts: casts.to_vec(),
            receives: receives.to_vec(),
            ..whole.clone()
        };
        for (list, site) in [("casts", of(&flags, &whole.receives)), ("receives", of(&whole.casts, &flags))] {
            let errors = [
                study::run(&site, &Wants::default(), on_event).map(drop).unwrap_err(),
                TiledStudy::new(&site, &Wants::default(), on_event).map(drop).unwrap_err(),
                study::patches(&site, 4.0, on_event).map(drop).unwrap_err(),
            ];
            for error in errors {
                let StudyError::Components { list: found, length, components: 2 } = error else { panic!("{error}") };
                assert_eq!((found, length), (list, flags.len()));
            }
        }
    }

    let study = TiledStudy::new(&whole, &Wants::default(), on_event).unwrap();
    let own = study.tiles()[0];
    assert!(study.sum(own, &whole.track.instants[..1], on_event).is_ok());
    let others = [
        Tile::from(Grid { west: GRID.west + 1.0, ..GRID }),
        Tile::from(Grid { width: GRID.width + 1, ..GRID }),
        Tile { first: [GRID.width, 0], ..own },
    ];
    for tile in others {
        let error = study.sum(tile, &whole.track.instants[..1], on_event).map(drop).unwrap_err();
        assert!(matches!(error, StudyError::OtherTile), "{tile:?}: {error}");
    }
}

/// The sums of a part can be ended by the listener, after an instant and between two.
#[test]
fn the_sums_of_a_part_have_a_listener() {
    let site = site_of(Mesh::build(vec![tower()]).unwrap());
    let study = TiledStudy::new(&site, &Wants::default(), &mut |_| ControlFlow::Continue(())).unwrap();
    let (tile, instants) = (study.tiles()[0], &site.track.instants);
    let (mut drawn, mut between) = (Vec::new(), 0);
    study
        .sum(tile, instants, &mut |event| {
            match event {
                study::Event::Drawn { index, count, time, .. } => drawn.push((index, count, time)),
                study::Event::Between => between += 1,
                other => panic!("{other:?}"),
            }
            ControlFlow::Continue(())
        })
        .unwrap();
    let expected = instants.iter().enumerate().map(|(index, instant)| (index, instants.len(), instant.time));
    assert_eq!(drawn, expected.collect::<Vec<_>>());
    assert!(between > 0);
    for ends_between in [false, true] {
        let mut heard = 0;
        let ended = study.sum(tile, instants, &mut |event| {
            heard += 1;
            match matches!(event, study::Event::Between) == ends_between {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            }
        });
        assert!(matches!(ended, Err(StudyError::Interrupted)), "between: {ends_between}");
        assert!(heard < instants.len() + between, "{heard} events");
    }
}

/// A plate far towards the sun shades the whole plan at one instant and nothing of it an hour later.
fn all_change() -> Site {
    let date = NaiveDate::from_ymd_opt(2026, 3, 21);
    let window = Window { date, from: "9:00".parse().unwrap(), to: "10:00".parse().unwrap(), step_secs: 3600 };
    let track = SunTrack::window(&vienna(), &window, true).unwrap();
    let to_sun = track.instants[0].to_sun;
    let (east, middle) = (to_sun.cross(DVec3::Z).normalize() * 300.0, to_sun * 5000.0);
    let up = east.cross(to_sun);
    let positions = [-east - up, east - up, east + up, up - east].map(|corner| middle + corner).to_vec();
    let plate = Part { name: "plate".into(), positions, triangles: vec![[0, 1, 2], [0, 2, 3]], ..Part::default() };
    let grid = Grid { west: -40.0, north: 40.0, cell: 0.25, width: 320, height: 320 };
    let site = Site::in_memory(vienna(), Mesh::build(vec![plate]).unwrap(), Some(0.0), track, grid).unwrap();
    Site { engine: Engine::Cpu, method: Method::RayCast, receives: vec![false], ..site }
}

#[test]
fn the_budget_holds_where_every_cell_changes() {
    let site = all_change();
    assert_eq!(site.track.resolution_secs, 60);
    let of = |budget: Option<u64>| {
        let budget = budget.map(|bytes| Budget { bytes, drawing: 0 });
        let wants = Wants { budget, ..Wants::default() };
        let (mut tiles, mut cells) = (0, Vec::new());
        let on_event = &mut |event: study::Event<'_>| {
            if let study::Event::Summed(shaded) = event {
                tiles += 1;
                cells.extend(shaded.iter());
            }
            ControlFlow::Continue(())
        };
        study::in_tiles(TiledStudy::new(&site, &wants, on_event).unwrap(), None, on_event).unwrap();
        (tiles, cells)
    };
    let (_, whole) = of(None);
    let changed = whole.iter().filter(|secs| (1..3600 * 255).contains(*secs)).count();
    assert_eq!(changed, site.grid.cells(), "every cell changes between the instants");
    for budget in [1_200_000, 3_000_000] {
        let (found, most) = CountedThread::new().run(|| of(Some(budget)));
        assert!(found.0 > 1, "{} tiles", found.0);
        assert!(found.1 == whole);
        // the sums of all tiles are this test's own
        let own = 2 * 8 * site.grid.cells() as u64 + (1 << 18);
        assert!(most < budget + own, "{most} bytes of {budget}");
    }
}

#[test]
fn instants_pass_through_plain_numbers() {
    for instant in track().instants {
        let Instant { time, to_sun, azimuth_rad, altitude_rad, weight_secs, gap_secs, night } = instant.clone();
        let (seconds, to_sun) = (time.timestamp(), to_sun.to_array());
        let time = vienna().time_zone.timestamp_opt(seconds, 0).unwrap();
        let to_sun = DVec3::from_array(to_sun);
        assert_eq!(Instant { time, to_sun, azimuth_rad, altitude_rad, weight_secs, gap_secs, night }, instant);
    }
}

#[test]
fn sums_are_a_slice_of_either_width_and_a_plan_has_a_transform() {
    let (short, long) = (Shaded::from(vec![1u32, 2]), Shaded::from(vec![1u64, 1 << 40]));
    assert_eq!((short.in_one_word(), short.in_two_words()), (Some(&[1, 2][..]), None));
    assert_eq!((long.in_one_word(), long.in_two_words()), (None, Some(&[1, 1 << 40][..])));
    let t = GRID.transform();
    for (column, row) in [(0, 0), (79, 0), (3, 61)] {
        let [across, down] = [column, row].map(|cell| f64::from(cell) + 0.5);
        let at = [t[0] + across * t[1] + down * t[2], t[3] + across * t[4] + down * t[5]];
        assert_eq!(at, GRID.centre(column, row).to_array());
    }
}

/// One triangle, one instant: all that is hashed is written here.
fn smallest() -> Site {
    let positions = vec![DVec3::ZERO, dvec3(10.0, 0.0, 0.0), dvec3(0.0, 10.0, 4.0)];
    let part = Part { name: "sail".into(), positions, triangles: vec![[0, 1, 2]], ..Part::default() };
    let mesh = Mesh::build_around(vec![part], DVec3::ZERO).unwrap();
    let instant = Instant {
        time: vienna().time_zone.timestamp_opt(1_774_090_800, 0).unwrap(),
        to_sun: dvec3(0.0, -0.6, 0.8),
        weight_secs: 1800,
        ..track().instants[0]
    };
    let track = SunTrack { instants: vec![instant], resolution_secs: 0, ..track() };
    let grid = Grid { west: -8.0, north: 12.0, cell: 2.0, width: 10, height: 8 };
    let site = Site::in_memory(vienna(), mesh, Some(0.0), track, grid).unwrap();
    Site { engine: Engine::Cpu, method: Method::RayCast, ..site }
}

#[test]
fn a_fingerprint_is_the_same_for_every_compiler() {
    let number =
        |site: &Site, wants: &Wants| TiledStudy::new(site, wants, &mut |_| ControlFlow::Continue(())).unwrap().number();
    let (site, wants) = (smallest(), Wants::default());
    assert_eq!(env!("CARGO_PKG_VERSION"), "0.1.0", "a new version has another fingerprint, which belongs here");
    // found by another program (CPython's SipHash-1-3) from the bytes that src/study/fingerprint.rs describes
    assert_eq!(number(&site, &wants), 0x8504_3567_6601_1aba);

    let mut later = site.clone();
    later.track.instants[0].weight_secs += 1;
    let others = [
        Site { casts: vec![false], ..site.clone() },
        Site { grid: Grid { west: -7.0, ..site.grid }, ..site.clone() },
        Site { method: Method::Projected, ..site.clone() },
        later,
    ];
    let in_folder = |folder: &str| Wants { masks: true, masks_in: Some(folder.into()), ..Wants::default() };
    let mut numbers: Vec<u64> = others.iter().map(|other| number(other, &wants)).collect();
    numbers.extend([number(&site, &wants), number(&site, &in_folder("one")), number(&site, &in_folder("other"))]);
    let count = numbers.len();
    numbers.sort_unstable();
    numbers.dedup();
    assert_eq!(numbers.len(), count, "another study has another number");
}
