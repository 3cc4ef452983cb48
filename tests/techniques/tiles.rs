//! Techniques with a map draw one per tile, finer than one for the whole plan: how much the results differ.

use super::{draw, site};
use glam::DVec3;
use gnomon::choice::Filter;
use gnomon::gpu::Gpu;
use gnomon::shadow::hybrid::Hybrid;
use gnomon::shadow::ray_cast::RayCast;
use gnomon::shadow::shadow_map::ShadowMap;
use gnomon::shadow::smoothie::Smoothie;
use gnomon::shadow::{Scene, ShadowError, Technique};
use gnomon::silhouette::ProcessorFinder;
use gnomon::view::{Grid, Mask, Tile, View};
use std::sync::Arc;

/// Cells along the plan's longer side, and texels along the map's: the same number, as by default.
const SIZE: u32 = 1024;

/// The number of tiles along a side.
fn tiles(plan: Grid, parts: u32) -> Vec<Tile> {
    let cut = |length: u32, part: u32| length * part / parts;
    let tile = |part: u32| {
        let [column, row] = [part % parts, part / parts];
        let first = [cut(plan.width, column), cut(plan.height, row)];
        let size = [cut(plan.width, column + 1) - first[0], cut(plan.height, row + 1) - first[1]];
        Tile { plan, first, size }
    };
    (0..parts * parts).map(tile).collect()
}

fn in_tiles(
    plan: Grid,
    parts: u32,
    sun: DVec3,
    make: &dyn Fn(View) -> Result<Box<dyn Technique>, ShadowError>,
) -> Mask {
    let mut share = vec![0; plan.cells()];
    for tile in tiles(plan, parts) {
        let part = draw(make(View::Plan(tile.grid())).unwrap().as_mut(), sun);
        for (row, from) in part.share.chunks(part.width as usize).enumerate() {
            let at = (tile.first[1] as usize + row) * plan.width as usize + tile.first[0] as usize;
            share[at..at + from.len()].copy_from_slice(from);
        }
    }
    Mask { width: plan.width, height: plan.height, share }
}

/// The share of cells in which two masks differ by more than half of the sun, and the mean difference of all cells as a
/// share of the sun.
fn differ(one: &Mask, other: &Mask) -> [f64; 2] {
    let off = one.share.iter().zip(&other.share).map(|(one, other)| one.abs_diff(*other));
    let cells = one.share.len() as f64;
    let [more, all] =
        off.fold([0.0, 0.0], |[more, all], off| [more + f64::from(u8::from(off > 127)), all + f64::from(off) / 255.0]);
    [more / cells, all / cells]
}

/// Prints the rows of the table in docs/benchmarks/growth.md.
#[test]
fn maps_of_tiles_are_finer() {
    let gpu = Arc::new(Gpu::open().unwrap());
    for name in ["headquarters", "industry", "tower"] {
        let (scene, view, suns) = site(name, SIZE);
        let View::Plan(plan) = view else { panic!("a plan") };
        let sun = suns[suns.len() / 3];
        let truth = draw(&mut RayCast::new(scene.clone(), view, None), sun);
        let (gpu, scene): (_, &Scene) = (&gpu, &scene);
        type Make<'a> = Box<dyn Fn(View) -> Result<Box<dyn Technique>, ShadowError> + 'a>;
        let map: Make<'_> =
            Box::new(|view| Ok(Box::new(ShadowMap::new(gpu.clone(), scene, view, SIZE, Filter::FastTwoByTwo)?)));
        let hybrid: Make<'_> = Box::new(|view| {
            Ok(Box::new(Hybrid::new(gpu.clone(), scene.clone(), view, ProcessorFinder::Hierarchy, SIZE)?))
        });
        let smoothie: Make<'_> = Box::new(|view| {
            Ok(Box::new(Smoothie::new(gpu.clone(), scene.clone(), view, ProcessorFinder::Hierarchy, SIZE, None)?))
        });
        for (technique, most, make) in
            [("shadow-map", 0.01, map), ("hybrid", 0.001, hybrid), ("smoothie", 0.01, smoothie)]
        {
            let whole = draw(make(view).unwrap().as_mut(), sun);
            let [whole_off, _] = differ(&whole, &truth);
            for parts in [2, 4] {
                let mask = in_tiles(plan, parts, sun, &make);
                let ([other, mean], [off, _]) = (differ(&mask, &whole), differ(&mask, &truth));
                let percent = [other, off, whole_off].map(|share| format!("{:.3}", 100.0 * share));
                let [other_percent, off_percent, whole_percent] = percent;
                println!(
                    "| {name} | {technique} | {parts} × {parts} | {other_percent} | {:.2} | {off_percent} | {whole_percent} |",
                    60.0 * mean
                );
                assert!(other > 0.0 && other < most, "{name}, {technique}: {other}");
                assert!(
                    off < whole_off,
                    "{name}, {technique}: {off} of the cells are off, and {whole_off} in the whole"
                );
            }
        }
    }
}
