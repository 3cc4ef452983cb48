//! A plan in tiles equals the plan as a whole: on the processor to the bit, on a graphics adapter except for cells
//! within a 64th of a cell of an edge. Also the messages about what cannot be combined with tiles.

use crate::shared::drawing::{day, plan, scene_of};
use crate::shared::program::{done, fails, files, gnomon, site, stderr};
use crate::shared::scenes::{sheet, small};
use glam::{DVec3, dvec2, dvec3};
use gnomon::choice::Receivers;
use gnomon::gpu::Gpu;
use gnomon::mesh::Mesh;
use gnomon::shadow::projected::Projected;
use gnomon::shadow::ray_cast::RayCast;
use gnomon::shadow::stencil::Stencil;
use gnomon::shadow::{Scene, Silhouettes, Technique};
use gnomon::silhouette::ProcessorFinder;
use gnomon::site::{Overrides, Site};
use gnomon::view::{Grid, Mask, Tile, View};
use std::path::Path;
use std::sync::Arc;

/// Tiles of uneven size, that begin and end anywhere.
fn tiles(plan: Grid) -> Vec<Tile> {
    let cuts = |length: u32, parts: &[u32]| {
        let ends = parts.iter().map(|part| length * part / 100).chain([length]);
        ends.scan(0, |from, to| Some((std::mem::replace(from, to), to))).collect::<Vec<_>>()
    };
    let mut tiles = Vec::new();
    for (top, bottom) in cuts(plan.height, &[13, 50, 51]) {
        for (left, right) in cuts(plan.width, &[37, 74]) {
            tiles.push(Tile { plan, first: [left, top], size: [right - left, bottom - top] });
        }
    }
    tiles
}

/// Which cells of a tile's mask are others than the whole's, as places on the plan.
fn differing(whole: &Mask, tile: &Tile, part: &Mask) -> Vec<(u32, u32)> {
    assert_eq!([part.width, part.height], tile.size);
    let mut differ = Vec::new();
    for (at, share) in part.share.iter().enumerate() {
        let column = tile.first[0] + at as u32 % part.width;
        let row = tile.first[1] + at as u32 / part.width;
        if whole.share[(row * whole.width + column) as usize] != *share {
            differ.push((column, row));
        }
    }
    differ
}

fn draw(technique: &mut dyn Technique, to_sun: DVec3) -> Mask {
    technique.draw(to_sun).unwrap().read().unwrap()
}

/// Scenes of all kinds, with plans on which cells' corners are no round numbers, and some suns.
fn scenes() -> Vec<(String, Scene, Grid, Vec<DVec3>)> {
    let mut scenes = Vec::new();
    for (name, parts) in small() {
        for receivers in [Receivers::Ground, Receivers::Top] {
            let View::Plan(grid) = plan(40.371_93, 150) else { panic!("a plan") };
            let scene = scene_of(&Mesh::build(parts.clone()).unwrap(), receivers, 0.0);
            scenes.push((format!("{name}, {}", receivers.word()), scene, grid, day()));
        }
    }
    let asked = Overrides { size: Some(500), ..Overrides::default() };
    let site = Site::load(Path::new("sites/tower"), &asked).unwrap();
    let scene = Scene {
        casters: site.mesh.of_components(&site.casts),
        receivers: site.mesh.of_components(&site.receives),
        ground: site.ground.level,
    };
    let suns = site.track.instants.iter().filter(|instant| !instant.night).map(|instant| instant.to_sun);
    scenes.push(("tower".to_owned(), scene, site.grid, suns.step_by(3).collect()));
    scenes
}

#[test]
fn on_the_processor_tiles_are_the_whole_to_the_bit() {
    for (name, scene, grid, suns) in scenes() {
        let whole: [&mut dyn Technique; 3] = [
            &mut Projected::new(&scene, grid),
            &mut RayCast::new(scene.clone(), View::Plan(grid), None),
            &mut RayCast::new(scene.clone(), View::Plan(grid), Some(5)),
        ];
        let all = tiles(grid);
        let parts: [&mut dyn Technique; 3] = [
            &mut Projected::new(&scene, all[0]),
            &mut RayCast::of_tile(scene.clone(), all[0], None),
            &mut RayCast::of_tile(scene.clone(), all[0], Some(5)),
        ];
        for (number, (whole, part)) in whole.into_iter().zip(parts).enumerate() {
            let masks: Vec<Mask> = suns.iter().map(|sun| draw(whole, *sun)).collect();
            let seen = whole.surface().unwrap();
            for (at, tile) in all.iter().enumerate() {
                assert!(at == 0 || part.turn_to_tile(*tile).unwrap());
                for (sun, mask) in suns.iter().zip(&masks) {
                    let differ = differing(mask, tile, &draw(part, *sun));
                    assert!(differ.is_empty(), "{name}, {number}, {sun}: {} cells, {:?}", differ.len(), differ[0]);
                }
                let surface = part.surface().unwrap();
                for (cell, face) in surface.face.iter().enumerate() {
                    let column = tile.first[0] as usize + cell % tile.size[0] as usize;
                    let row = tile.first[1] as usize + cell / tile.size[0] as usize;
                    let there = row * grid.width as usize + column;
                    let heights = [surface.height_m[cell], seen.height_m[there]].map(f32::to_bits);
                    assert_eq!((*face, heights[0]), (seen.face[there], heights[1]), "{name}, {number}");
                }
            }
        }
    }
}

#[test]
fn an_edge_over_a_million_rows_stays_where_it_is() {
    // it goes three columns east, less a quarter of 2⁻³⁰ columns a row: what its steps are rounded by adds up
    let [rows, cell] = [f64::from(1 << 20), 1.0 / 64.0];
    let corner = |down: f64, z: f64| dvec3((2.5 + down * (3.0 - 1.0 / 4096.0)) * cell, (0.5 - down) * rows * cell, z);
    let wall = sheet([corner(0.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(0.0, 1.0)]);
    let scene = scene_of(&Mesh::build(vec![wall]).unwrap(), Receivers::Ground, 0.0);
    let grid = Grid { west: 0.0, north: rows * cell / 2.0, cell, width: 8, height: 1 << 20 };
    let sun = dvec3(1.0, 0.0, 1.0);
    let mut projected = Projected::new(&scene, grid);
    let whole = draw(&mut projected, sun);
    let cast = draw(&mut RayCast::new(scene, View::Plan(grid), None), sun);
    let differ = differing(&cast, &grid.into(), &whole);
    // it meets two columns of centres, a third and a sixth of the rows after one of the wall's triangles begins: half a step
    // for each of them is 57 rows and 28
    assert!(differ.len() <= 86, "{} cells", differ.len());
    for tile in tiles(grid) {
        assert!(projected.turn_to_tile(tile).unwrap());
        assert!(differing(&whole, &tile, &draw(&mut projected, sun)).is_empty(), "{:?}", tile.first);
    }
}

#[test]
fn tiles_that_lie_elsewhere_are_found_out() {
    let (_, scene, grid, suns) = scenes().pop().unwrap();
    let tile = tiles(grid)[4];
    // a cell to the east, and to the south
    for beside in [[1, 0], [0, 1]] {
        let first = [tile.first[0] + beside[0], tile.first[1] + beside[1]];
        let parts: [&mut dyn Technique; 2] = [
            &mut Projected::new(&scene, Tile { first, ..tile }),
            &mut RayCast::of_tile(scene.clone(), Tile { first, ..tile }, None),
        ];
        for part in parts {
            let whole = draw(&mut Projected::new(&scene, grid), suns[1]);
            assert!(differing(&whole, &tile, &draw(part, suns[1])).len() > 50);
        }
    }
    // an eighth of a cell, on the adapter
    let gpu = Arc::new(Gpu::open().unwrap());
    let stencil = |grid| {
        let silhouettes = Silhouettes::OnProcessor(ProcessorFinder::Hierarchy);
        draw(&mut Stencil::new(Arc::clone(&gpu), scene.clone(), View::Plan(grid), silhouettes).unwrap(), suns[1])
    };
    let at = tile.grid();
    let off = Grid { west: at.west + grid.cell / 8.0, ..at };
    let differ = differing(&stencil(grid), &tile, &stencil(off));
    assert!(beside_no_edge(&scene, &grid, suns[1], &differ).len() > 10);
}

/// Of some cells those at which no shadow's edge runs within a 64th of a cell of the centre.
fn beside_no_edge(scene: &Scene, grid: &Grid, sun: DVec3, cells: &[(u32, u32)]) -> Vec<(u32, u32)> {
    let mut truth = RayCast::new(scene.clone(), View::Plan(*grid), None);
    let far = |&(column, row): &(u32, u32)| {
        let cell = grid.cell / 256.0;
        let corner = grid.centre(column, row) + dvec2(-4.5, 4.5) * cell;
        truth.look_at(View::Plan(Grid { west: corner.x, north: corner.y, cell, width: 9, height: 9 }));
        let around = draw(&mut truth, sun).share;
        around.iter().all(|share| *share == around[0])
    };
    cells.iter().copied().filter(far).collect()
}

#[test]
fn on_the_adapter_tiles_differ_beside_edges_alone() {
    let gpu = Arc::new(Gpu::open().unwrap());
    let silhouettes = Silhouettes::OnProcessor(ProcessorFinder::Hierarchy);
    let (mut all, mut differ_at_all) = (0, 0);
    for (name, scene, grid, suns) in scenes() {
        let stencil = |view| Stencil::new(Arc::clone(&gpu), scene.clone(), view, silhouettes).unwrap();
        let mut whole = stencil(View::Plan(grid));
        let mut part = stencil(View::Plan(tiles(grid)[0].grid()));
        for (at, tile) in tiles(grid).iter().enumerate() {
            assert!(at == 0 || part.turn_to_tile(*tile).unwrap());
            for sun in suns.iter().filter(|sun| sun.z > 0.17) {
                let differ = differing(&draw(&mut whole, *sun), tile, &draw(&mut part, *sun));
                let wrong = beside_no_edge(&scene, &grid, *sun, &differ);
                assert!(wrong.is_empty(), "{name}, {sun}: {} of {} cells, {:?}", wrong.len(), differ.len(), wrong[0]);
                (all, differ_at_all) = (all + tile.cells(), differ_at_all + differ.len());
            }
        }
    }
    assert!(differ_at_all * 2000 < all, "{differ_at_all} of {all} cells differ");
    println!("{differ_at_all} of {all} cells differ, each within a 64th of a cell of an edge");
}

/// Of a whole file, byte by byte, but for what took how long.
fn same(folder: &Path, one: &str, other: &str) {
    let [one_files, other_files] = [one, other].map(|out| files(&folder.join(out)));
    assert_eq!(one_files.keys().collect::<Vec<_>>(), other_files.keys().collect::<Vec<_>>());
    for (file, bytes) in &one_files {
        assert!(bytes == &other_files[file], "{one}, {other}: {file} is another");
    }
}

/// A street of boxes and sheets, as a site of the command.
const STUDY: &str = "--size 230 --region -47.3,-38.1,51.7,60.9 --threads 2 --step 20min --bits";

#[test]
fn files_of_a_study_in_tiles_are_those_of_the_whole() {
    let folder = site();
    let path = folder.path();
    for (name, asked, memory) in [
        ("ground", "--receivers ground --engine cpu", "240KiB"),
        ("top", "--engine cpu", "1000KiB"),
        ("rays", "--technique ray-cast", "300kB"),
        ("disc", "--technique ray-cast --sun-samples 4", "300kB"),
    ] {
        done(path, &format!("profile . {STUDY} {asked} --out {name}"));
        let told = stderr(&gnomon(path, &format!("profile . {STUDY} {asked} --memory {memory} --out {name}-tiles")));
        assert!(told.contains("the plan is done in ") && told.contains(" instants, counted in each tile"), "{told}");
        same(path, name, &format!("{name}-tiles"));
        // what is enough makes no tiles
        let told = stderr(&gnomon(path, &format!("profile . {STUDY} {asked} --memory 1GiB --out {name}-enough")));
        assert!(!told.contains("tiles"), "{told}");
    }
}

#[test]
fn a_plan_wider_than_the_largest_texture_is_done_in_tiles() {
    let folder = site();
    let path = folder.path();
    let largest = Gpu::open().unwrap().limits.max_texture_dimension_2d;
    let wide = format!("--region -40,-2,40,18 --receivers ground --cell {:?} --bits", 80.0 / f64::from(largest + 1000));
    let wide = wide.replace("-40,-2,40,18", "-40,8,40,8.1");
    let told = stderr(&gnomon(path, &format!("profile . {wide} --engine gpu --silhouette hextree --out gpu")));
    assert!(told.contains("the plan is done in 2 tiles of "), "{told}");
    done(path, &format!("profile . {wide} --engine cpu --out cpu"));
    let [gpu, cpu] = ["gpu", "cpu"].map(|out| std::fs::read(path.join(out).join("shadow.bits")).unwrap());
    assert_eq!(gpu.len(), cpu.len());
    let differ: u32 = gpu.iter().zip(&cpu).map(|(one, other)| (one ^ other).count_ones()).sum();
    let shadow: u32 = cpu.iter().map(|byte| byte.count_ones()).sum();
    assert!(shadow > 10_000 && differ < shadow / 100, "{differ} of {shadow}");
}

/// The same at one instant: the mask is that of the processor, and the drawing is made.
#[test]
fn an_instant_wider_than_the_largest_texture_is_drawn() {
    let folder = site();
    let path = folder.path();
    let largest = Gpu::open().unwrap().limits.max_texture_dimension_2d;
    let wide = format!("--region -40,8,40,8.1 --cell {:?} --receivers ground", 80.0 / f64::from(largest + 1000));
    let at = "shadow . --at 2026-09-18T11:00";
    let told = stderr(&gnomon(path, &format!("{at} {wide} --technique stencil --mask gpu.png --out gpu-sheet.png")));
    assert!(told.contains("the plan is done in 2 tiles of "), "{told}");
    done(path, &format!("{at} {wide} --engine cpu --mask cpu.png"));
    let [gpu, cpu] = ["gpu.png", "cpu.png"].map(|name| image::open(path.join(name)).unwrap().into_luma8());
    assert_eq!((gpu.width(), gpu.dimensions()), (largest + 1000, cpu.dimensions()));
    let differ = gpu.pixels().zip(cpu.pixels()).filter(|(one, other)| one != other).count();
    let shadow = cpu.pixels().filter(|pixel| pixel.0 == [0]).count();
    assert!(shadow > 10_000 && differ < shadow / 100, "{differ} of {shadow}");
    assert_eq!(image::open(path.join("gpu-sheet.png")).unwrap().width(), 3508);
    let stats = format!("{at} {wide} --technique stencil --stats --mask m.png");
    fails(path, &stats, 2, &["--stats", "in tiles", "--cell"]);
    // what draws the plan at once says that it is too large, on either machine
    for asked in ["animate . --engine gpu", "animate . --engine cpu", "verify ."] {
        fails(path, &format!("{asked} --size 40000"), 2, &["40000 × ", "at once", "--cell", "--size"]);
    }
}

#[cfg(unix)]
#[test]
fn a_study_that_was_stopped_among_its_tiles_goes_on_and_comes_to_the_same() {
    let folder = site();
    let path = folder.path();
    for (name, engine, memory) in
        [("ground", "--receivers ground --engine cpu", "240KiB"), ("gpu", "--technique stencil --stats", "1MiB")]
    {
        let asked = |out: &str, memory: &str| {
            let study = STUDY.replace("--step 20min", "--from 8:00 --to 18:00 --step 1min");
            let step = if name == "gpu" { study.replace("--step 1min", "--step 10min") } else { study };
            format!("profile . {step} {engine} {memory} --out {name}-{out}")
        };
        let memory = &format!("--memory {memory}");
        done(path, &asked("whole", memory));
        for when in ["10%", "40%", "70%"] {
            crate::shared::program::stopped(path, &asked("stopped", memory), when);
        }
        let out = path.join(format!("{name}-stopped"));
        let names = ["profile.N.unfinished", "profile.sums.N.unfinished", "shadow.bits.N.unfinished"];
        assert_eq!(crate::shared::program::numberless(&out), names);
        let number = |out: &Path| {
            let name = crate::shared::program::left(out).file_name().unwrap().to_str().unwrap().to_owned();
            name.split('.').nth(1).unwrap().to_owned()
        };
        let ours = number(&out);
        // other tiles are another study
        let other = if name == "gpu" { "--memory 2MiB" } else { "--memory 300KiB" };
        crate::shared::program::stopped(path, &asked("other", other), "10%");
        let theirs = number(&path.join(format!("{name}-other")));
        assert_ne!(ours, theirs);
        for file in names {
            let to = path.join(format!("{name}-other")).join(file.replace('N', &theirs));
            std::fs::copy(out.join(file.replace('N', &ours)), to).unwrap();
        }
        let told = stderr(&gnomon(path, &asked("other", other)));
        assert!(told.contains("starts over") && !told.contains("continues"), "{told}");
        let told = stderr(&gnomon(path, &asked("stopped", memory)));
        assert!(told.contains("continues where it was stopped, after"), "{told}");
        same(path, &format!("{name}-whole"), &format!("{name}-stopped"));
        // sums of tiles that are gone are not taken for nothing
        if name == "ground" {
            same(path, &format!("{name}-whole"), &format!("{name}-other"));
            std::fs::remove_dir_all(path.join(format!("{name}-stopped"))).unwrap();
            crate::shared::program::stopped(path, &asked("stopped", memory), "60%");
            std::fs::remove_file(out.join(names[1].replace('N', &ours))).unwrap();
            let told = stderr(&gnomon(path, &asked("stopped", memory)));
            assert!(told.contains("starts over") && !told.contains("continues"), "{told}");
            same(path, &format!("{name}-whole"), &format!("{name}-stopped"));
        }
    }
}

#[test]
fn memory_that_cannot_be_kept_to_is_told() {
    let folder = site();
    let path = folder.path();
    let study = "profile . --engine cpu --size 300 --threads 2";
    for wrong in ["512", "MiB", "1.5GiB", "-1MiB", "512mib", "99999999999GiB", "0x10MiB", "512 MiB"] {
        // the command line is split at blanks
        let wrong = wrong.split(' ').next().unwrap();
        fails(path, &format!("{study} --memory={wrong}"), 2, &["--memory", "512MiB"]);
    }
    fails(path, &format!("{study} --memory 0KiB"), 2, &["--memory", "take at least", "300 cells"]);
    // the least that is told is enough
    let told = stderr(&gnomon(path, &format!("{study} --memory 5KiB")));
    let least = told.split("at least ").nth(1).unwrap().split(',').next().unwrap();
    done(path, &format!("{study} --memory {least}"));
    let less = format!("{}KiB", least.strip_suffix("KiB").unwrap().parse::<u32>().unwrap() - 1);
    fails(path, &format!("{study} --memory {less}"), 2, &["--memory", least]);
    fails(path, &format!("{study} --memory {least} --masks masks"), 2, &["--masks", "--bits"]);
    assert!(!path.join("masks/mask-0000.png").exists());
    fails(path, &format!("{study} --memory {least} --draw hours"), 2, &["--draw", "in tiles"]);
    assert!(!path.join("out/hours.svg").exists());
    fails(path, "profile . --receivers surfaces --memory 1GiB", 2, &["--memory", "surfaces"]);
}
