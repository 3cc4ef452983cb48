//! The silhouette finders compared: `cargo bench --bench silhouettes`. Prints tables in Markdown.
//!
//! For each model: the time and memory of building; the nodes and edges (or classes) visited for each one found; and
//! the time of a query, the median over the instants of the site's study. All finders answer for the same instant one
//! after the other, so ratios do not depend on other load. `docs/benchmarks/silhouettes.md` has the results of a run
//! and the machine. The row *gpu* has the number of runs in which edges were handed to the adapter; what it finds is
//! not read back, and its time is that of the whole submission. `-- --copies 10,100` adds `headquarters` copied this
//! often.

#[path = "../tests/shared/dome.rs"]
mod dome;
mod timing;

use glam::{DVec3, DVec4, dvec3};
use gnomon::gpu::Gpu;
use gnomon::mesh::{Mesh, Part};
use gnomon::shadow::walls::extraction::{Extraction, ExtractionProgram};
use gnomon::shadow::walls::{WallQuery, Walls};
use gnomon::silhouette::hierarchy::Hierarchy;
use gnomon::silhouette::{DirectedEdge, ProcessorFinder, QueryCost, SilhouetteFinder, hextree};
use gnomon::site::{Overrides, Site};
use std::path::Path;
use std::sync::Arc;
use timing::{median, timed};

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    // `cargo test --benches` only asks whether it runs
    if arguments.iter().any(|argument| argument == "--test") {
        return;
    }
    let copies = arguments.iter().position(|argument| argument == "--copies").and_then(|at| arguments.get(at + 1));
    let gpu = Gpu::open().ok().map(|gpu| {
        let gpu = Arc::new(gpu);
        let program = ExtractionProgram::new(&gpu);
        (gpu, program)
    });
    println!("adapter: {}\n", gpu.as_ref().map_or("none", |(gpu, _)| gpu.name()));
    println!(
        "| model | casting triangles | edges | silhouette | finder | built, ms | MiB | looked at | found | looked at a find | query, ms | of brute force |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|");
    for name in ["tower", "industry", "headquarters"] {
        let (mesh, suns) = site(name, None);
        rows(gpu.as_ref(), name, &mesh, &suns);
    }
    let (everything, suns) = site("headquarters", Some(()));
    rows(gpu.as_ref(), "headquarters, all cast", &everything, &suns);
    rows(gpu.as_ref(), "dome", &Mesh::build(vec![dome::dome()]).expect("a dome"), &suns);
    for copies in copies.into_iter().flat_map(|list| list.split(',')) {
        let copies: usize = copies.parse().expect("--copies takes numbers");
        rows(
            gpu.as_ref(),
            &format!("headquarters × {copies}"),
            &copied(&everything, copies),
            &suns[..suns.len().min(3)],
        );
    }
    println!("\nMedians over the instants. Classes: edges that answer together count once.");
}

/// An adapter, with the finder's shaders.
type Machine = (Arc<Gpu>, ExtractionProgram);

/// A site's casters and its suns; with `all`, every component casts.
fn site(name: &str, all: Option<()>) -> (Mesh, Vec<DVec4>) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("sites").join(name);
    let file = if all.is_none() && name == "headquarters" { folder.join("facade-and-concrete.toml") } else { folder };
    let site = Site::load(&file, &Overrides::default()).expect("a sample site");
    let mesh = site.mesh.of_components(&site.casts);
    let suns = site.track.instants.iter().filter(|instant| !instant.night);
    (mesh.clone(), suns.map(|instant| mesh.local_light(instant.to_sun.extend(0.0))).collect())
}

/// Copies in a square, whole metres apart.
fn copied(mesh: &Mesh, copies: usize) -> Mesh {
    let (low, high) = mesh.bounds().expect("a mesh with faces");
    let pitch = ((high - low) * 1.2).ceil();
    let side = (copies as f64).sqrt().ceil() as usize;
    let part = |copy: usize, component: &gnomon::mesh::Component| {
        let moved = dvec3((copy % side) as f64 * pitch.x, (copy / side) as f64 * pitch.y, 0.0) + mesh.origin;
        let faces = component.faces.start as usize..component.faces.end as usize;
        let corners = faces.clone().flat_map(|face| mesh.corners(face));
        Part {
            name: component.name.clone(),
            positions: corners.map(|corner| corner.as_dvec3() + moved).collect::<Vec<DVec3>>(),
            triangles: (0..faces.len() as u32).map(|face| [face * 3, face * 3 + 1, face * 3 + 2]).collect(),
            ..Part::default()
        }
    };
    let parts = (0..copies).flat_map(|copy| mesh.components.iter().map(move |component| part(copy, component)));
    Mesh::build(parts.collect()).expect("a mesh")
}

/// Appends the silhouette; asked for runs alone, nothing.
type Query = Box<dyn FnMut(&Mesh, DVec4, &mut Vec<DirectedEdge>) -> QueryCost>;

/// A finder with its name, the time it took to build, and its size.
struct Entry {
    name: String,
    built: f64,
    bytes: usize,
    query: Query,
    times: Vec<f64>,
    looked: Vec<(usize, usize)>,
}

fn entries(gpu: Option<&Machine>, mesh: &Mesh, sun: DVec4) -> Vec<Entry> {
    let entry = |name: &str, built, bytes, query: Query| Entry {
        name: name.into(),
        built,
        bytes,
        query,
        times: Vec::new(),
        looked: Vec::new(),
    };
    let mut entries = Vec::new();
    let mut brute = ProcessorFinder::BruteForce.build(mesh);
    entries.push(entry("brute force", 0.0, 0, Box::new(move |mesh, sun, out| brute.find(mesh, sun, out))));
    for depth in [hextree::PAPER_DEPTH, hextree::DEEPEST] {
        let mut built = Vec::new();
        let mut tree = timed(&mut built, || hextree::Hextree::new(mesh, depth));
        let bytes = tree.bytes();
        let query = Box::new(move |mesh: &Mesh, sun, out: &mut Vec<_>| tree.find(mesh, sun, out));
        entries.push(entry(&format!("hextree, depth {depth}"), built[0], bytes, query));
    }
    let mut built = Vec::new();
    let mut hierarchy = timed(&mut built, || {
        let mut hierarchy = Hierarchy::default();
        hierarchy.classes(mesh, sun);
        hierarchy
    });
    let bytes = hierarchy.classes(mesh, sun).bytes();
    let query = Box::new(move |mesh: &Mesh, sun, out: &mut Vec<_>| hierarchy.find(mesh, sun, out));
    entries.push(entry("hierarchy, edges", built[0], bytes, query));
    let mut hierarchy = Hierarchy::default();
    hierarchy.classes(mesh, sun);
    let mut runs = Vec::new();
    let query = Box::new(move |mesh: &Mesh, sun, _: &mut Vec<_>| {
        runs.clear();
        hierarchy.classes(mesh, sun).ask(sun, &mut runs)
    });
    entries.push(entry("hierarchy, runs", built[0], bytes, query));
    if let Some((gpu, program)) = gpu {
        let most = gpu.limits.max_storage_buffer_binding_size;
        let mut built = Vec::new();
        let extraction = timed(&mut built, || Extraction::new(program, mesh, most));
        let mut extraction = extraction.expect("edges that fit the adapter");
        let name = format!("gpu, in {}", extraction.runs());
        let gpu = Arc::clone(gpu);
        let query = Box::new(move |mesh: &Mesh, local_light, _: &mut Vec<_>| {
            let sought = WallQuery { local_light, to_infinity: true, with_cap: false, halved: false, borders: None };
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            extraction.find(mesh, &sought, &mut encoder).expect("a list");
            gpu.queue.submit([encoder.finish()]);
            gpu.device.poll(wgpu::PollType::wait_indefinitely()).expect("the adapter answers");
            QueryCost { at: mesh.edges.len(), found: 0 }
        });
        entries.push(entry(&name, built[0], 0, query));
    }
    entries
}

fn rows(gpu: Option<&Machine>, model: &str, mesh: &Mesh, suns: &[DVec4]) {
    let mut entries = entries(gpu, mesh, suns[0]);
    let mut found = Vec::new();
    let mut silhouette = Vec::new();
    for _ in 0..3 {
        for &sun in suns {
            for entry in &mut entries {
                found.clear();
                let looked = timed(&mut entry.times, || (entry.query)(mesh, sun, &mut found));
                entry.looked.push((looked.at, looked.found));
                if !found.is_empty() {
                    silhouette.push(found.len());
                }
            }
        }
    }
    silhouette.sort_unstable();
    let silhouette = silhouette[silhouette.len() / 2];
    let brute = median(entries[0].times.clone());
    for mut entry in entries {
        entry.looked.sort_unstable();
        let (at, found) = entry.looked[entry.looked.len() / 2];
        let time = median(entry.times);
        // the adapter tells nobody what it found
        let [finds, a_find] = match found {
            0 => [(); 2].map(|()| "–".to_owned()),
            _ => [found.to_string(), format!("{:.1}", at as f64 / found as f64)],
        };
        println!(
            "| {model} | {} | {} | {silhouette} | {} | {:.1} | {:.1} | {at} | {finds} | {a_find} | {time:.3} | {:.3} |",
            mesh.faces.len(),
            mesh.edges.len(),
            entry.name,
            entry.built,
            entry.bytes as f64 / f64::from(1 << 20),
            time / brute
        );
    }
}
