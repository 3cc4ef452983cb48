//! The techniques compared: `cargo bench --bench techniques [-- SCENE]`. Prints tables in Markdown.
//!
//! For each scene and map size: milliseconds of a shadow map (fast 2×2), the hybrid, the stencil and smoothies, split
//! by the adapter's passes; and how many fragments are counted with and without the hybrid's mask. Techniques take
//! turns for each sun position, so ratios do not depend on other load. `docs/benchmarks/techniques.md` has the results
//! of a run.

#[path = "../tests/shared/dense.rs"]
mod dense;
#[path = "../tests/shared/dome.rs"]
mod dome;
mod timing;

use dense::Dense;
use glam::{DVec3, dvec3};
use gnomon::choice::Filter;
use gnomon::gpu::Gpu;
use gnomon::mesh::Mesh;
use gnomon::shadow::hybrid::Hybrid;
use gnomon::shadow::shadow_map::ShadowMap;
use gnomon::shadow::smoothie::Smoothie;
use gnomon::shadow::stencil::Stencil;
use gnomon::shadow::{Scene, Silhouettes, Technique};
use gnomon::silhouette::ProcessorFinder;
use gnomon::site::{Overrides, Site};
use gnomon::view::{Camera, Decider, FragmentCounts, View};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;
use timing::{median, timed};

const MAP_SIZES: [u32; 3] = [256, 512, 1024];
/// How often each sun is drawn after the first time.
const ROUNDS: usize = 3;
/// A site's suns at the most.
const SUNS: usize = 5;
/// The passes of map, hybrid, stencil and smoothie.
const PASSES: [&[&str]; 4] =
    [&["map", "shadow_map"], &["map", "hybrid"], &["stencil"], &["map", "smoothie.edges", "smoothie"]];

fn main() {
    // `cargo test --benches` only asks whether it runs
    if std::env::args().any(|argument| argument == "--test") {
        return;
    }
    let gpu = Arc::new(Gpu::open().expect("a graphics adapter"));
    let with_passes = gpu.time_passes().is_ok();
    println!("adapter: {}\n", gpu.name());
    let mut tables = Tables::default();
    // only scenes whose names hold what is asked for
    let asked: Vec<_> = std::env::args().skip(1).filter(|argument| !argument.starts_with('-')).collect();
    for case in cases().iter().filter(|case| asked.iter().all(|word| case.name.contains(word))) {
        for map_size in MAP_SIZES {
            tables.measure(&gpu, case, map_size);
        }
    }
    tables.print(with_passes);
}

/// What is drawn: a scene, a view, its suns.
struct Case {
    name: String,
    scene: Scene,
    view: View,
    suns: Vec<DVec3>,
}

fn cases() -> Vec<Case> {
    let mut cases = Vec::new();
    for name in ["tower", "industry", "headquarters"] {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("sites").join(name);
        let site = Site::load(&folder, &Overrides::default()).expect("a sample site");
        let scene = Scene {
            casters: site.mesh.of_components(&site.casts),
            receivers: site.mesh.of_components(&site.receives),
            ground: site.ground.level,
        };
        let suns: Vec<_> = site.track.instants.iter().filter(|instant| !instant.night).map(|it| it.to_sun).collect();
        let suns: Vec<_> = suns.iter().copied().step_by(suns.len().div_ceil(SUNS)).collect();
        let camera = View::Camera(Camera { width: 1280, height: 800, ..site.camera });
        for (view_name, view) in [("plan", View::Plan(site.grid)), ("camera", camera)] {
            let name = format!("{name}, {view_name}");
            cases.push(Case { name, scene: scene.clone(), view, suns: suns.clone() });
        }
    }
    let dome = Dense {
        parts: vec![dome::dome()],
        camera: Camera { eye: dvec3(70.0, -110.0, 60.0), target: dvec3(-6.0, 6.0, 6.0), ..dense::curved().camera },
        to_sun: dense::curved().to_sun,
    };
    let of_camera = [
        ("cage", dense::cage(0.4)),
        ("wide cage", dense::cage(0.85)),
        ("tree", dense::tree()),
        ("dome", dome),
        ("ring", dense::curved()),
    ];
    cases.extend(of_camera.map(|(name, dense)| built(name, dense)));
    cases
}

fn built(name: &str, dense: Dense) -> Case {
    let mesh = Mesh::build(dense.parts).expect("a scene");
    let scene = Scene { casters: mesh.clone(), receivers: mesh, ground: 0.0 };
    // the same sun an hour before and after
    let turned = |degrees: f64| glam::DQuat::from_rotation_z(degrees.to_radians()) * dense.to_sun;
    Case {
        name: format!("{name}, camera"),
        scene,
        view: View::Camera(dense.camera),
        suns: vec![turned(15.0), dense.to_sun, turned(-15.0)],
    }
}

/// The rows of each table.
#[derive(Default)]
struct Tables {
    times: Vec<String>,
    passes: Vec<String>,
    fragments: Vec<String>,
}

impl Tables {
    fn measure(&mut self, gpu: &Arc<Gpu>, case: &Case, map_size: u32) {
        let Case { name, scene, view, suns } = case;
        let silhouettes: Silhouettes =
            if gpu.software() { ProcessorFinder::Hierarchy.into() } else { Silhouettes::OnGpu };
        let filter = Filter::FastTwoByTwo;
        let map = ShadowMap::new(Arc::clone(gpu), scene, *view, map_size, filter).expect("a map");
        let mut hybrid = Hybrid::new(Arc::clone(gpu), scene.clone(), *view, silhouettes, map_size).expect("a hybrid");
        let mut stencil = Stencil::new(Arc::clone(gpu), scene.clone(), *view, silhouettes).expect("a stencil");
        let counted = [&mut stencil as &mut dyn Technique, &mut hybrid]
            .map(|it| it.counted(suns[suns.len() / 2]).expect("a count").expect("what is counted"));
        self.fragments.push(fragments_row(name, map_size, &counted));

        let smoothie = Smoothie::new(Arc::clone(gpu), scene.clone(), *view, ProcessorFinder::Hierarchy, map_size, None);
        let mut techniques: [Box<dyn Technique>; 4] =
            [Box::new(map), Box::new(hybrid), Box::new(stencil), Box::new(smoothie.expect("smoothies"))];
        let mut whole: [Vec<f64>; 4] = Default::default();
        let mut passes: [BTreeMap<String, Vec<f64>>; 4] = Default::default();
        for round in 0..=ROUNDS {
            for &to_sun in suns {
                for ((technique, whole), passes) in techniques.iter_mut().zip(&mut whole).zip(&mut passes) {
                    gpu.pass_times().expect("the adapter's times");
                    let mut of_this = Vec::new();
                    timed(&mut of_this, || {
                        technique.draw(to_sun).expect("a mask");
                        gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("the adapter answers");
                    });
                    // the first round makes buffers
                    if round == 0 {
                        continue;
                    }
                    whole.extend(of_this);
                    let mut sums = BTreeMap::new();
                    for (label, millis) in gpu.pass_times().expect("the adapter's times") {
                        *sums.entry(label).or_insert(0.0) += millis;
                    }
                    sums.into_iter().for_each(|(label, sum)| passes.entry(label).or_default().push(sum));
                }
            }
        }
        let [map, hybrid, stencil, smoothie] = whole.map(median);
        self.times.push(format!(
            "| {name} | {map_size} | {map:.1} | {hybrid:.1} | {stencil:.1} | {smoothie:.1} | {:.2} | {:.2} |",
            stencil / hybrid,
            smoothie / map
        ));
        let split =
            passes.into_iter().zip([map, hybrid, stencil, smoothie]).zip(PASSES).map(|((times, whole), labels)| {
                let of = |label: &str| times.get(label).map_or(0.0, |times| median(times.clone()));
                let parts: Vec<f64> = labels.iter().map(|label| of(label)).collect();
                let rest = (whole - parts.iter().sum::<f64>()).max(0.0);
                let parts: Vec<String> = parts.into_iter().chain([rest]).map(|millis| format!("{millis:.1}")).collect();
                parts.join(" + ")
            });
        self.passes.push(format!("| {name} | {map_size} | {} |", split.collect::<Vec<_>>().join(" | ")));
    }

    fn print(&self, with_passes: bool) {
        println!("## Whole instants\n");
        println!(
            "| scene | map | shadow map, ms | hybrid, ms | stencil, ms | smoothie, ms | stencil / hybrid | smoothie / map |"
        );
        println!("|---|---|---|---|---|---|---|---|");
        self.times.iter().for_each(|row| println!("{row}"));
        if with_passes {
            println!("\n## Split by pass\n");
            println!(
                "| scene | map | shadow map: map + comparison + rest | hybrid: map + decision and count + rest | stencil: count + rest | smoothie: map + edges + comparison + rest |"
            );
            println!("|---|---|---|---|---|---|");
            self.passes.iter().for_each(|row| println!("{row}"));
        }
        println!("\n## Fragments\n");
        println!("| scene | map | overdraw of the stencil | silhouette cells | overdraw behind the mask | of all |");
        println!("|---|---|---|---|---|---|");
        self.fragments.iter().for_each(|row| println!("{row}"));
    }
}

fn fragments_row(name: &str, map_size: u32, [stencil, hybrid]: &[FragmentCounts; 2]) -> String {
    let cells = f64::from(stencil.width * stencil.height);
    let reached: u64 = hybrid.reached.iter().map(|&fragments| u64::from(fragments)).sum();
    let decided = hybrid.decided.as_ref().expect("what decided");
    let by_volumes = |decided: &&Decider| matches!(decided, Decider::VolumeShadow | Decider::VolumeLight);
    let silhouette = decided.iter().filter(by_volumes).count();
    format!(
        "| {name} | {map_size} | {:.1} | {:.1}% | {:.2} | {:.1}% |",
        stencil.all as f64 / cells,
        100.0 * silhouette as f64 / cells,
        reached as f64 / cells,
        100.0 * reached as f64 / stencil.all as f64,
    )
}
