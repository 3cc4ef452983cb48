//! The hybrid: the mask equals that of the stencil, except for what the map missed; and the count behind its mask.

use super::{draw, site};
use crate::shared::drawing::{crossing, day, gpu, plan, scene_of, to_sun};
use crate::shared::scenes::{sheet, small, stack};
use glam::{DVec3, dvec3};
use gnomon::choice::{Filter, Receivers};
use gnomon::mesh::Mesh;
use gnomon::shadow::hybrid::Hybrid;
use gnomon::shadow::near_clip::near_clip_volume_touched;
use gnomon::shadow::shadow_map::ShadowMap;
use gnomon::shadow::stencil::Stencil;
use gnomon::shadow::{Scene, Silhouettes, Technique};
use gnomon::silhouette::ProcessorFinder;
use gnomon::verification::Edges;
use gnomon::view::{Camera, Decider, FragmentCounts, Mask, View};

/// A sun's masks, and what decided.
struct Pair {
    hybrid: Mask,
    stencil: Mask,
    counted: FragmentCounts,
}

fn by_volumes(decided: Decider) -> bool {
    matches!(decided, Decider::VolumeShadow | Decider::VolumeLight)
}

impl Pair {
    /// Cells that differ: those that volumes decided, and those that the map did.
    fn differing(&self) -> [Vec<usize>; 2] {
        let decided = self.counted.decided.as_ref().unwrap();
        let differ = (0..decided.len()).filter(|&at| self.hybrid.share[at] != self.stencil.share[at]);
        let (by_volumes, by_map) = differ.partition(|&at| by_volumes(decided[at]));
        [by_volumes, by_map]
    }
}

/// How far a cell lies from an edge of the mask, in cells.
fn to_edge(mask: &Mask, at: usize) -> f64 {
    Edges::of(mask).distance(at as u32 % mask.width, at as u32 / mask.width).unwrap_or(f64::INFINITY)
}

fn pairs(scene: &Scene, view: View, suns: &[DVec3], map_size: u32, silhouettes: Silhouettes) -> Vec<Pair> {
    let mut hybrid = Hybrid::new(gpu(), scene.clone(), view, silhouettes, map_size).unwrap();
    let mut stencil = Stencil::new(gpu(), scene.clone(), view, ProcessorFinder::BruteForce).unwrap();
    let pair = |&sun: &DVec3| Pair {
        hybrid: draw(&mut hybrid, sun),
        stencil: draw(&mut stencil, sun),
        counted: hybrid.counted(sun).unwrap().unwrap(),
    };
    suns.iter().map(pair).collect()
}

#[test]
fn it_is_the_stencils_mask_on_solids_larger_than_a_texel() {
    for (name, parts) in small() {
        let mesh = Mesh::build(parts).unwrap();
        for receivers in [Receivers::Ground, Receivers::Top] {
            let scene = scene_of(&mesh, receivers, 0.0);
            for silhouettes in [Silhouettes::OnProcessor(ProcessorFinder::Hierarchy), Silhouettes::OnGpu] {
                for pair in pairs(&scene, plan(40.371_93, 500), &day()[1..4], 1024, silhouettes) {
                    let [by_volumes, by_map] = pair.differing();
                    // an open sheet's own corners are thinner than any texel
                    assert!(
                        by_volumes.is_empty() && by_map.len() <= 3,
                        "{name}: {} {}",
                        by_volumes.len(),
                        by_map.len()
                    );
                }
            }
        }
    }
}

#[test]
fn on_the_sites_it_differs_only_where_the_map_missed_something_thin() {
    for name in ["tower", "industry", "headquarters"] {
        let (scene, view, suns) = site(name, 500);
        let View::Plan(grid) = view else { panic!("a plan") };
        for size in [512, 2048] {
            let texels = ShadowMap::new(gpu(), &scene, view, size, Filter::None).unwrap();
            let suns: Vec<DVec3> = suns.iter().step_by(4).copied().collect();
            let pairs = pairs(&scene, view, &suns, size, ProcessorFinder::Hierarchy.into());
            let (mut missed, mut far) = (0, 0);
            for (pair, &sun) in pairs.iter().zip(&suns) {
                let [by_volumes, by_map] = pair.differing();
                // batches are cut elsewhere, so a wall may be rounded differently now and then
                assert!(by_volumes.len() <= 2, "{name} at {size}: {}", by_volumes.len());
                let texel = f64::from(texels.texel_m(sun).into_iter().fold(0.0, f32::max)) / sun.z / grid.cell;
                // what was missed is thin: light and shadow lie within a texel or two of each other there
                far += by_map.iter().filter(|&&at| to_edge(&pair.stencil, at) > 2.0 * texel + 2.0).count();
                missed += by_map.len();
            }
            let cells = suns.len() * grid.cells();
            println!("{name} at {size}: {missed} of {cells} cells missed by the map, {far} far from an edge");
            // (on a thin beam below others, behind fins and lattices that a coarse map looks through, all may be dark)
            let most_far = if size == 512 { 10 } else { 1 };
            assert!(far <= most_far, "{name} at {size}: {far} of {missed}");
            let most = if size == 512 { cells / 300 } else { cells / 5000 };
            assert!(missed <= most, "{name} at {size}: {missed} of {cells}");
        }
    }
}

#[test]
fn the_count_is_never_wrong_at_128() {
    for plates in [63, 64, 65, 126, 127, 128, 129, 254, 255, 256, 257, 512] {
        for thickness in [0.004, 0.0] {
            let mesh = Mesh::build(vec![stack(plates, thickness)]).unwrap();
            for receivers in [Receivers::Ground, Receivers::Top] {
                let scene = scene_of(&mesh, receivers, 0.0);
                let what = format!("{plates} plates of {thickness} m, {receivers:?}");
                // so coarse a map that much is left to the volumes
                let suns = [to_sun(200.0, 70.0), to_sun(230.0, 80.0)];
                for pair in pairs(&scene, plan(9.0, 160), &suns, 64, ProcessorFinder::Hierarchy.into()) {
                    let [by_volumes, by_map] = pair.differing();
                    assert!(
                        by_volumes.is_empty() && by_map.len() <= 2,
                        "{what}: {} {}",
                        by_volumes.len(),
                        by_map.len()
                    );
                    let decided = pair.counted.decided.as_ref().unwrap();
                    let dark = decided.iter().filter(|&&it| it == Decider::VolumeShadow).count();
                    assert!(dark > 8, "{what}: {dark} cells were counted dark");
                }
            }
        }
    }
}

#[test]
fn cameras_count_by_the_views_own_rule() {
    let (scene, sun) = (crossing(), to_sun(180.0, 40.0));
    let (mut z_fails, mut wrong_when_forced) = (0, 0);
    for step in 0..30 {
        let eye = dvec3(-40.0, 20.0, 2.0).lerp(dvec3(40.0, 17.0, 2.0), (f64::from(step) + 0.37) / 30.0);
        let camera = Camera { eye, target: dvec3(0.0, 0.0, 6.0), up: DVec3::Z, fov_rad: 1.2, width: 320, height: 200 };
        let view = View::Camera(camera);
        let pair = pairs(&scene, view, &[sun], 256, ProcessorFinder::Hierarchy.into()).remove(0);
        let [by_volumes, by_map] = pair.differing();
        let near = by_map.iter().all(|&at| to_edge(&pair.stencil, at) <= 8.0);
        assert!(by_volumes.is_empty() && by_map.len() < 30 && near, "{eye}: {} {}", by_volumes.len(), by_map.len());
        let z_fail = near_clip_volume_touched(&camera, sun, &scene.casters);
        z_fails += usize::from(z_fail);
        // z-pass is wrong where it is not chosen, behind the mask too
        let mut forced = Hybrid::new(gpu(), scene.clone(), view, ProcessorFinder::Hierarchy, 256).unwrap();
        forced.force_z_fail(false);
        let differs = draw(&mut forced, sun).share.iter().zip(&pair.hybrid.share).filter(|(a, b)| a != b).count();
        assert!(z_fail || differs == 0, "{eye}: {differs}");
        wrong_when_forced += usize::from(differs > 50);
    }
    assert!(z_fails > 2 && z_fails < 28 && wrong_when_forced > 0, "{z_fails} z-fails, {wrong_when_forced} wrong");
}

#[test]
fn what_is_counted_lies_behind_the_mask_and_adds_up() {
    let scene = crossing();
    let camera = Camera {
        eye: dvec3(38.0, -41.0, 27.0),
        target: dvec3(0.0, 4.0, 6.0),
        up: DVec3::Z,
        fov_rad: 0.9,
        width: 300,
        height: 200,
    };
    for view in [View::Camera(camera), plan(40.0, 200)] {
        let sun = to_sun(200.0, 35.0);
        let pair = pairs(&scene, view, &[sun], 512, ProcessorFinder::BruteForce.into()).remove(0);
        let FragmentCounts { reached, all, decided, .. } = &pair.counted;
        let decided = decided.as_ref().unwrap();
        let stray = reached.iter().zip(decided).filter(|(reached, decided)| **reached > 0 && !by_volumes(**decided));
        assert_eq!(stray.count(), 0, "fragments outside of the mask");
        let sum: u64 = reached.iter().map(|reached| u64::from(*reached)).sum();
        let mut stencil = Stencil::new(gpu(), scene.clone(), view, ProcessorFinder::BruteForce).unwrap();
        let unmasked = stencil.counted(sun).unwrap().unwrap();
        assert!(unmasked.decided.is_none() && sum > 0 && sum < unmasked.all);
        // the hybrid's batches are smaller, but there is one of each here
        assert_eq!(unmasked.all, *all);
        // walls that cover a cell, in the plan: a wall's fragments are where its area is
        assert!(unmasked.reached.iter().any(|reached| *reached > 2));
        let light = |it: Decider| matches!(it, Decider::MapLight | Decider::VolumeLight);
        let same = decided.iter().zip(&pair.hybrid.share).all(|(it, share)| light(*it) == (*share == 255));
        assert!(same, "what is said to be lit is");
    }
}

/// Bars and slits that are narrower and wider than a texel, seen from the sun. The four texels around a cell cover at
/// least a texel in any direction, so that at least one of them meets anything wider, except at its ends.
#[test]
fn the_map_misses_nothing_wider_than_its_texel() {
    let sun = to_sun(203.0, 52.0);
    let axis = dvec3(0.839, 0.544, 0.0).normalize();
    let across = dvec3(-axis.y, axis.x, 0.0);
    let view = plan(12.0, 700);
    let View::Plan(grid) = view else { panic!("a plan") };
    let (widths, spacing, half) = ([0.3, 0.6, 1.05, 1.4], 2.0, 7.0);
    // bars where the number is even, slits between plates where it is odd
    let middle = |number: usize| across * (spacing * (number as f64 - 3.5));
    let scene = |texel_m: f64| {
        let wide = |number: usize| widths[number / 2] * texel_m;
        let strip = |from: f64, to: f64| {
            let corner = |end: f64, side: f64| axis * (end * half) + across * side + DVec3::Z * 4.0;
            sheet([corner(-1.0, from), corner(1.0, from), corner(1.0, to), corner(-1.0, to)])
        };
        let mut parts = Vec::new();
        for number in 0..8 {
            let (at, reach) = (middle(number).dot(across), wide(number) / 2.0);
            match number % 2 {
                0 => parts.push(strip(at - reach, at + reach)),
                _ => parts.extend([strip(at - 0.7, at - reach), strip(at + reach, at + 0.7)]),
            }
        }
        scene_of(&Mesh::build(parts).unwrap(), Receivers::Ground, 0.0)
    };
    // a texel on a horizontal strip, across its axis
    let texel_of = |scene: &Scene| {
        let map = ShadowMap::new(gpu(), scene, view, 256, Filter::None).unwrap();
        let across_rays = f64::from(map.texel_m(sun).into_iter().fold(0.0, f32::max));
        across_rays * (1.0 - axis.dot(sun).powi(2)).sqrt() / sun.z
    };
    let texel = texel_of(&scene(0.1));
    let scene = scene(texel);
    assert!((texel_of(&scene) / texel - 1.0).abs() < 0.02, "the bars' width changed the map");
    let pair = pairs(&scene, view, &[sun], 256, ProcessorFinder::Hierarchy.into()).remove(0);
    let [by_volumes, by_map] = pair.differing();
    assert!(by_volumes.is_empty());
    let mut missed = [0; 8];
    for at in by_map {
        let centre = grid.centre(at as u32 % grid.width, at as u32 / grid.width);
        let cast_from = centre.extend(0.0) + sun * (4.0 / sun.z);
        let is_end = cast_from.dot(axis).abs() > half - 3.0 * texel;
        let nearest = (0..8).min_by_key(|&it| ((cast_from - middle(it)).dot(across).abs() * 1e6) as u64).unwrap();
        missed[nearest] += usize::from(!is_end);
    }
    println!("texel {texel:.3} m; missed of bars and slits of {widths:?} texels: {missed:?}");
    // narrower ones are missed in part: this test can see it
    assert!(missed[..4].iter().all(|&cells| cells > 20), "{missed:?}");
    assert_eq!(missed[4..], [0; 4]);
}

#[test]
fn by_the_sites_cameras_it_differs_only_where_the_map_missed_something() {
    for name in ["tower", "industry", "headquarters"] {
        let (scene, _, suns) = site(name, 64);
        let site = gnomon::site::Site::load(std::path::Path::new(&format!("sites/{name}")), &Default::default());
        let view = View::Camera(Camera { width: 480, height: 300, ..site.unwrap().camera });
        let suns: Vec<DVec3> = suns.iter().step_by(5).copied().collect();
        let (mut missed, cells) = (0, suns.len() * 480 * 300);
        for pair in pairs(&scene, view, &suns, 2048, ProcessorFinder::Hierarchy.into()) {
            let [by_volumes, by_map] = pair.differing();
            assert!(by_volumes.len() <= 2, "{name}: {}", by_volumes.len());
            missed += by_map.len();
        }
        println!("{name}: {missed} of {cells} cells missed by the map");
        assert!(missed <= cells / 2000, "{name}: {missed} of {cells}");
    }
}
