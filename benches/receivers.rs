//! Light on patches by each technique: `cargo bench --bench receivers`. Prints tables in Markdown.
//!
//! For each site, milliseconds per sample by filled textures (processor and adapter), by edge flags, by rays, and by
//! the technique that is chosen automatically. Then the measure of the paper, and how the time grows with the number of
//! occluders, with and without culling. `docs/benchmarks/receivers.md` has the results of a run. All numbers of a table
//! come from one run, so their ratios are comparable.

mod timing;

use glam::{DVec3, DVec4, dvec3};
use gnomon::gpu::Gpu;
use gnomon::mesh::patches::{DEFAULT_CELL_M, MOST_TEXELS, Patches};
use gnomon::mesh::{Mesh, Part};
use gnomon::shadow::soft_texture::{Choice, Fill, Painter, PatchJudgements, Sample, SoftTexture};
use gnomon::site::{Overrides, Site};
use std::path::Path;
use std::sync::Arc;
use timing::{median, timed};

/// A site's suns at the most.
const SUNS: usize = 3;

/// The ways that are compared, by name.
fn ways(gpu: &Arc<Gpu>) -> Vec<(&'static str, Painter, Choice)> {
    let on_processor = Painter::OnProcessor;
    vec![
        ("filled", on_processor(Fill::Faces), Choice::Texture),
        ("edge flags", on_processor(Fill::Silhouettes), Choice::Texture),
        ("filled, adapter", Painter::OnGpu(Arc::clone(gpu)), Choice::Texture),
        ("rays", on_processor(Fill::Faces), Choice::Rays),
        ("rectangles", on_processor(Fill::Silhouettes), Choice::Auto),
        ("auto, adapter", Painter::OnGpu(Arc::clone(gpu)), Choice::Auto),
    ]
}

fn main() {
    // `cargo test --benches` only asks whether it runs
    if std::env::args().any(|argument| argument == "--test") {
        return;
    }
    let gpu = Arc::new(Gpu::open().expect("a graphics adapter"));
    println!("adapter: {}; {} threads\n", gpu.name(), rayon::current_num_threads());
    sites(&gpu);
    papers_measure(&gpu);
    growth(&gpu);
}

fn sites(gpu: &Arc<Gpu>) {
    println!("## Sites\n");
    let mut notes = Vec::new();
    println!(
        "| site | cell, m | way | ms a sample | µs a patch and sample | Mtexels a second | textures | faces a texture | rays | MiB on the adapter |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    for (name, cell) in [
        ("tower", DEFAULT_CELL_M),
        ("industry", DEFAULT_CELL_M),
        ("headquarters", 2.0),
        ("headquarters", DEFAULT_CELL_M),
    ] {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("sites").join(name);
        let site = Site::load(&folder, &Overrides::default()).expect("a sample site");
        let mut times = Vec::new();
        let patches = timed(&mut times, || Arc::new(Patches::of(&site.mesh, &site.receives, cell, MOST_TEXELS)));
        let gathered = median(times);
        let casters = site.mesh.of_components(&site.casts);
        let suns: Vec<_> = site.track.instants.iter().filter(|instant| !instant.night).map(|it| it.to_sun).collect();
        let suns: Vec<_> = suns.iter().copied().step_by(suns.len().div_ceil(SUNS)).collect();
        let mut ways = ways(gpu);
        // all textures of 73,000 patches at the finest cell take minutes
        ways.retain(|(_, _, choice)| name != "headquarters" || cell > 1.0 || *choice != Choice::Texture);
        let mut textures = Vec::new();
        for (_, painter, choice) in &ways {
            let texture = SoftTexture::new(casters.clone(), Arc::clone(&patches), painter.clone(), *choice);
            textures.push((texture.expect("textures"), Vec::new()));
        }
        // ways take turns, so that ratios hold whatever else the machine does
        for (at, sun) in (0..).zip(&suns) {
            for (texture, times) in &mut textures {
                timed(times, || {
                    texture.add(&[Sample { light: sun.extend(0.0), weight: 1 << at }]).expect("a sample");
                    gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("the adapter answers");
                });
            }
        }
        let (mut names, mut sums) = (Vec::new(), Vec::new());
        for ((way, ..), (texture, times)) in ways.into_iter().zip(textures) {
            let millis = median(times);
            let PatchJudgements { textures, faces, rays, texture_texels, rectangle_texels } = texture.judged();
            let (bytes, count) = (texture.gpu_bytes(), suns.len() as u64);
            println!(
                "| {name} | {} | {way} | {millis:.0} | {:.2} | {:.2} | {} | {:.0} | {} | {:.0} |",
                patches.cell,
                millis * 1e3 / patches.list.len() as f64,
                (texture_texels + rectangle_texels + rays) as f64 / count as f64 / (millis * 1e3),
                textures / count,
                faces as f64 / textures.max(1) as f64,
                rays / count,
                bytes as f64 / f64::from(1 << 20),
            );
            names.push(way);
            sums.push(texture.finish().expect("sums"));
        }
        let truth = &sums[names.iter().position(|name| *name == "rays").expect("rays")];
        let differ: Vec<String> = names
            .iter()
            .zip(&sums)
            .map(|(name, sums)| {
                format!("{name} {}", sums.iter().zip(truth).filter(|(one, other)| one != other).count())
            })
            .collect();
        notes.push(format!(
            "- {name}, {} m: {} patches, {} texels judged, atlas of {} page(s) of {}², gathered in {gathered:.0} ms. \
             Texels that differ from rays at any of {} samples: {}.",
            patches.cell,
            patches.list.len(),
            patches.texels.len(),
            patches.pages,
            patches.page_size,
            suns.len(),
            differ.join(", ")
        ));
    }
    println!();
    notes.iter().for_each(|note| println!("{note}"));
    println!();
}

/// A floor of one patch, and a number of thin boxes over it.
fn boxes_over_a_floor(count: u32, side: f64) -> Vec<Part> {
    let slab = |name: &str, low: DVec3, high: DVec3| {
        let corner =
            |index: u32| DVec3::select(glam::BVec3::new(index & 1 == 0, index & 2 == 0, index & 4 == 0), low, high);
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        Part {
            name: name.into(),
            positions: (0..8).map(corner).collect(),
            triangles: quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect(),
            ..Part::default()
        }
    };
    let golden = |at: u32, by: f64| (f64::from(at) * by).fract();
    let mut parts = vec![slab("floor", dvec3(0.0, 0.0, -0.1), dvec3(64.0, 64.0, 0.0))];
    let mut boxes = Part { name: "boxes".into(), ..Part::default() };
    for at in 0..count {
        let low = dvec3(
            golden(at, 0.754_877_666) * side,
            golden(at, 0.569_840_290) * side,
            1.0 + 8.0 * golden(at, 0.618_034),
        );
        let part = slab("", low, low + dvec3(1.5, 1.5, 1.0));
        let base = boxes.positions.len() as u32;
        boxes.positions.extend(part.positions);
        boxes.triangles.extend(part.triangles.iter().map(|triangle| triangle.map(|corner| corner + base)));
    }
    parts.push(boxes);
    parts
}

/// The floor alone as a receiver, with texels of `cell` metres.
fn floor(parts: Vec<Part>, cell: f64) -> (Mesh, Arc<Patches>) {
    let mesh = Mesh::build(parts).expect("a mesh");
    let floor: Vec<bool> = mesh.components.iter().map(|component| component.name == "floor").collect();
    let mut patches = Patches::of(&mesh, &floor, cell, MOST_TEXELS);
    patches.list.retain(|patch| patch.normal().z > 0.5);
    let top = &mut patches.list[0];
    patches.texels = patches.texels[top.texels.start as usize..top.texels.end as usize].to_vec();
    top.texels = 0..patches.texels.len() as u32;
    (mesh, Arc::new(patches))
}

/// 64 points of a square lamp of 4 m, in a jittered grid, 40 m above.
fn lamp() -> Vec<Sample> {
    let at = |index: u32| {
        let jitter = |by: f64| (f64::from(index) * by).fract();
        let [column, row] = [index % 8, index / 8].map(f64::from);
        dvec3(30.0 + (column + jitter(0.618_034)) * 0.5, 30.0 + (row + jitter(0.754_878)) * 0.5, 40.0)
    };
    (0..64).map(|index| Sample { light: DVec4::from((at(index), 1.0)), weight: 1 }).collect()
}

fn papers_measure(gpu: &Arc<Gpu>) {
    println!("## The paper's measure: 256 × 256 texels, 40 boxes (480 triangles), 64 samples of a lamp\n");
    println!("| way | ms a texture of 64 samples | textures a second |");
    println!("|---|---|---|");
    let (mesh, patches) = floor(boxes_over_a_floor(40, 62.0), 0.25);
    assert_eq!(patches.texels.len(), 256 * 256);
    for (way, painter, choice) in ways(gpu).into_iter().take(4) {
        let mut texture = SoftTexture::new(mesh.clone(), Arc::clone(&patches), painter, choice).expect("textures");
        let mut times = Vec::new();
        for _ in 0..6 {
            timed(&mut times, || {
                texture.add(&lamp()).expect("samples");
                gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("the adapter answers");
            });
        }
        let millis = median(times.split_off(1));
        println!("| {way} | {millis:.1} | {:.0} |", 1e3 / millis);
    }
    println!();
}

fn growth(gpu: &Arc<Gpu>) {
    println!("## Growth with the occluders, all spread over ten times the floor's side, ms a texture of 64 samples\n");
    println!("| way | culling | 400 boxes | 4,000 boxes | growth |");
    println!("|---|---|---|---|---|");
    for (way, painter, choice) in ways(gpu).into_iter().take(3) {
        for culling in [true, false] {
            let millis = [400, 4000].map(|count| {
                let (mesh, patches) = floor(boxes_over_a_floor(count, 640.0), 0.25);
                let texture = SoftTexture::new(mesh, patches, painter.clone(), choice).expect("textures");
                let mut texture = if culling { texture } else { texture.without_culling() };
                let mut times = Vec::new();
                for _ in 0..3 {
                    timed(&mut times, || {
                        texture.add(&lamp()).expect("samples");
                        gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("the adapter answers");
                    });
                }
                median(times.split_off(1))
            });
            let said = if culling { "yes" } else { "no" };
            println!("| {way} | {said} | {:.1} | {:.1} | {:.1} |", millis[0], millis[1], millis[1] / millis[0]);
        }
    }
}
