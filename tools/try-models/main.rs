//! Tries every glTF model in some folders: `cargo run --example try-models -- FOLDER...`
//!
//! Prints a row per model: its triangles and casting edges, whether every finder gives the silhouettes of the simple
//! rule, and how the stencil's plan differs from ray casting over a day that begins and ends with a low sun. The exit
//! status is 1 if a check fails. A model that cannot be read is reported and counted, but is not a failure.
//!
//! The tests include this file to check that its comparisons can fail.

use glam::{DVec3, DVec4, dvec4};
use gnomon::choice::Receivers;
use gnomon::gpu::{Gpu, GpuError};
use gnomon::mesh::Mesh;
use gnomon::shadow::ray_cast::RayCast;
use gnomon::shadow::stencil::Stencil;
use gnomon::shadow::walls::extraction::{Extraction, ExtractionProgram};
use gnomon::shadow::walls::{WallQuery, Walls};
use gnomon::shadow::{Scene, ShadowError, Technique};
use gnomon::silhouette::hextree::{DEEPEST, PAPER_DEPTH};
use gnomon::silhouette::{DirectedEdge, ProcessorFinder, SilhouetteFinder};
use gnomon::site::{Overrides, Site};
use gnomon::verification::Difference;
use gnomon::view::View;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

pub(crate) mod extracted;

/// Makes a finder for a mesh.
type Make = fn(&Mesh) -> Box<dyn SilhouetteFinder>;

/// The finders that are compared with the simple rule. A new finder gets a line here.
const FINDERS: &[(&str, Make)] = &[
    ("brute force", |mesh| ProcessorFinder::BruteForce.build(mesh)),
    ("hextree of the paper's depth", |mesh| ProcessorFinder::Hextree { depth: PAPER_DEPTH }.build(mesh)),
    ("deepest hextree", |mesh| ProcessorFinder::Hextree { depth: DEEPEST }.build(mesh)),
    ("hierarchy", |mesh| ProcessorFinder::Hierarchy.build(mesh)),
];

/// Cells along the plan's longer side.
const SIZE: u32 = 700;
/// The share of edge cells that may differ, since models are not clean.
const EDGE_SHARE: f64 = 0.01;

/// A day with a low sun at both ends.
fn asked(receivers: Receivers) -> Overrides {
    Overrides {
        place: Some([51.9984, 4.3737]),
        date: "2026-09-18".parse().ok(),
        from: "sunrise+25min".parse().ok(),
        to: "sunset-35min".parse().ok(),
        step_secs: Some(140 * 60),
        size: Some(SIZE),
        receivers: Some(receivers),
        ..Overrides::default()
    }
}

/// A silhouette: each edge, lower vertex first, with its directed count, forwards minus backwards.
type Sums = BTreeMap<[u32; 2], i32>;

fn sums(edges: impl IntoIterator<Item = DirectedEdge>) -> Sums {
    let mut sums = Sums::new();
    for [from, to] in edges {
        *sums.entry([from.min(to), from.max(to)]).or_default() += if from < to { 1 } else { -1 };
    }
    sums.retain(|_, sum| *sum != 0);
    sums
}

/// The rule itself: every face turned towards the light, its three sides added up.
fn plain_rule(mesh: &Mesh, facing: &[bool]) -> Sums {
    let turned = |(&[a, b, c], &facing): (&[u32; 3], &bool)| if facing { [a, b, c] } else { [a, c, b] };
    let faces = mesh.faces.iter().zip(facing).map(turned);
    sums(faces.flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]]))
}

/// The finders whose silhouette is not that of the plain rule.
fn disagreeing(mesh: &Mesh, lights: &[DVec4], finders: &[(&'static str, Make)]) -> Vec<&'static str> {
    let truths: Vec<Sums> = lights.iter().map(|&light| plain_rule(mesh, &mesh.facing(light))).collect();
    let agrees = |make: &Make| {
        let mut finder = make(mesh);
        lights.iter().zip(&truths).all(|(&light, truth)| {
            let mut found = Vec::new();
            finder.find(mesh, light, &mut found);
            is_silhouette(found, truth)
        })
    };
    finders.iter().filter(|(_, make)| !agrees(make)).map(|(name, _)| *name).collect()
}

/// Whether edges are those of the simple rule, with the same multiplicity and without pairs that cancel.
fn is_silhouette(found: Vec<DirectedEdge>, truth: &Sums) -> bool {
    let length: i32 = truth.values().map(|sum| sum.abs()).sum();
    found.len() == length as usize && sums(found) == *truth
}

/// Whether the adapter's silhouettes are those of the plain rule, by the adapter's own facing; and whether that is the
/// processor's but for faces so near to edge-on that they may fall either way.
fn adapter_agrees(program: &ExtractionProgram, gpu: &Gpu, mesh: &Mesh, lights: &[DVec4]) -> Result<bool, GpuError> {
    let most = gpu.limits.max_storage_buffer_binding_size;
    let mut extraction = Extraction::new(program, mesh, most)?;
    for &local_light in lights {
        let sought = WallQuery { local_light, to_infinity: true, with_cap: true, halved: false, borders: None };
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        extraction.find(mesh, &sought, &mut encoder)?;
        gpu.queue.submit([encoder.finish()]);
        let [walls, cap] = extraction.read()?;
        let facing = extracted::facing_of(mesh, &cap);
        let found = extracted::edges_of(mesh, &walls, local_light, sought.to_infinity);
        let turned =
            mesh.facing(local_light).into_iter().zip(&facing).enumerate().filter(|(_, (one, other))| one != *other);
        let all_near = turned.into_iter().all(|(face, _)| extracted::near_edge_on(mesh, face, local_light));
        if !all_near || !is_silhouette(found, &plain_rule(mesh, &facing)) {
            return Ok(false);
        }
    }
    Ok(true)
}

/// The result for a model.
struct Row {
    triangles: usize,
    edges: usize,
    wrong_finders: Vec<&'static str>,
    /// Altitude of the lowest sun, degrees.
    lowest_deg: f64,
    suns: usize,
    /// Under ground and top receivers.
    differences: [Difference; 2],
}

impl Row {
    fn holds(&self) -> bool {
        self.wrong_finders.is_empty() && self.differences.iter().all(|difference| difference.holds(EDGE_SHARE))
    }
}

/// Compares the stencil's plan with ray casting, over all suns.
fn stencil_against_rays(gpu: &Arc<Gpu>, scene: Scene, view: View, suns: &[DVec3]) -> Result<Difference, ShadowError> {
    let mut stencil = Stencil::new(Arc::clone(gpu), scene.clone(), view, ProcessorFinder::BruteForce)?;
    let mut truth = RayCast::new(scene, view, None);
    let mut total = Difference::default();
    for &sun in suns {
        let mut difference = Difference::between(&stencil.draw(sun)?.read()?, &truth.draw(sun)?.read()?);
        difference.except_thin(&mut truth, view, sun)?;
        total.add(difference);
    }
    Ok(total)
}

fn try_model(gpu: &Arc<Gpu>, program: &ExtractionProgram, path: &Path) -> Result<Row, Box<dyn std::error::Error>> {
    let site = Site::load(path, &asked(Receivers::Top))?;
    let mesh = &site.mesh;
    let instants: Vec<_> = site.track.instants.iter().filter(|instant| !instant.night).collect();
    let suns: Vec<DVec3> = instants.iter().map(|instant| instant.to_sun).collect();
    let (low, high) = mesh.bounds().ok_or("no faces")?;
    // a lamp beside the model's middle, and one above a corner
    let lamps = [(low + high) / 2.0 + (high - low) * 0.13, high + (high - low) * 0.4].map(|at| at - mesh.origin);
    let lights: Vec<DVec4> = suns
        .iter()
        .map(|sun| sun.extend(0.0))
        .chain(lamps.map(|lamp| lamp.extend(1.0)))
        .chain([dvec4(0.3, -0.4, -0.8, 0.0), DVec4::Z])
        .collect();
    let scene = |receivers: Mesh| Scene { casters: mesh.clone(), receivers, ground: site.ground.level };
    let none = vec![false; mesh.components.len()];
    let view = View::Plan(site.grid);
    let ground = stencil_against_rays(gpu, scene(mesh.of_components(&none)), view, &suns)?;
    let top = stencil_against_rays(gpu, scene(mesh.clone()), view, &suns)?;
    let mut wrong_finders = disagreeing(mesh, &lights, FINDERS);
    if !adapter_agrees(program, gpu, mesh, &lights)? {
        wrong_finders.push("gpu");
    }
    Ok(Row {
        triangles: mesh.faces.len(),
        edges: mesh.edges.len(),
        wrong_finders,
        lowest_deg: instants.iter().map(|instant| instant.altitude_deg()).fold(90.0, f64::min),
        suns: suns.len(),
        differences: [ground, top],
    })
}

/// The models in a folder and its folders, in the order of their names.
fn models(folder: &Path) -> std::io::Result<Vec<PathBuf>> {
    if folder.is_file() {
        return Ok(vec![folder.to_owned()]);
    }
    let mut paths: Vec<PathBuf> =
        std::fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect::<std::io::Result<_>>()?;
    paths.sort();
    let mut found = Vec::new();
    for path in paths {
        let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
        if path.is_dir() {
            found.extend(models(&path)?);
        } else if extension == "glb" || extension == "gltf" {
            found.push(path);
        }
    }
    Ok(found)
}

#[cfg(not(test))]
fn main() -> Result<std::process::ExitCode, Box<dyn std::error::Error>> {
    let folders: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    if folders.is_empty() {
        return Err("which folder? cargo run --example try-models -- FOLDER...".into());
    }
    let gpu = Arc::new(Gpu::open()?);
    let program = ExtractionProgram::new(&gpu);
    println!("{SIZE} cells on the plan's longer side; {}", gpu.name());
    println!("model: triangles, edges, finders; edge cells and other cells that differ, ground and top receivers");
    let (mut tried, mut refused, mut failed) = (0, 0, 0);
    for folder in &folders {
        for path in models(folder)? {
            let name = path.strip_prefix(folder).unwrap_or(&path).display();
            match try_model(&gpu, &program, &path) {
                Err(why) => {
                    refused += 1;
                    println!("{name}: cannot be read: {why}");
                }
                Ok(row) => {
                    tried += 1;
                    failed += usize::from(!row.holds());
                    let finders = match row.wrong_finders.is_empty() {
                        true => "all finders agree".to_owned(),
                        false => format!("WRONG: {}", row.wrong_finders.join(", ")),
                    };
                    let [ground, top] = &row.differences;
                    println!(
                        "{name}: {} triangles, {} edges, {finders}, {} suns from {:.1}°; ground: {ground}; top: {top}{}",
                        row.triangles,
                        row.edges,
                        row.suns,
                        row.lowest_deg,
                        if row.holds() { "" } else { "; DOES NOT HOLD" }
                    );
                }
            }
        }
    }
    println!("{tried} models tried, {failed} do not hold, {refused} cannot be read");
    Ok(std::process::ExitCode::from(u8::from(failed > 0 || tried == 0)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use gnomon::silhouette::QueryCost;

    /// A finder that loses, turns or doubles an edge.
    struct Wrong(fn(&mut Vec<DirectedEdge>));

    impl SilhouetteFinder for Wrong {
        fn find(&mut self, mesh: &Mesh, local_light: DVec4, silhouette: &mut Vec<DirectedEdge>) -> QueryCost {
            let looked = ProcessorFinder::BruteForce.build(mesh).find(mesh, local_light, silhouette);
            (self.0)(silhouette);
            looked
        }
    }

    #[test]
    fn a_finder_that_is_wrong_is_named() {
        let parts = crate::shared::scenes::small().remove(4).1;
        let mesh = Mesh::build(parts).unwrap();
        let lights = [dvec4(0.3, 0.2, 0.8, 0.0), dvec4(3.0, -9.0, 12.0, 1.0)];
        assert!(disagreeing(&mesh, &lights, FINDERS).is_empty());
        let wrong: &[(&str, Make)] = &[
            ("loses", |_| Box::new(Wrong(|edges| edges.truncate(edges.len() - 1)))),
            ("turns", |_| Box::new(Wrong(|edges| edges[0].reverse()))),
            ("doubles", |_| Box::new(Wrong(|edges| edges.push(edges[0])))),
            ("goes to and fro", |_| Box::new(Wrong(|edges| edges.extend([[0, 1], [1, 0]])))),
        ];
        assert_eq!(disagreeing(&mesh, &lights, wrong).len(), wrong.len());
    }

    #[test]
    fn a_row_fails_for_a_finder_or_a_mask() {
        let row = |wrong_finders, edge_differ| {
            let top = Difference { edge_cells: 1000, edge_differ, other_cells: 1000, ..Difference::default() };
            Row {
                triangles: 1,
                edges: 3,
                wrong_finders,
                lowest_deg: 3.0,
                suns: 5,
                differences: [Difference::default(), top],
            }
        };
        assert!(row(vec![], 10).holds());
        assert!(!row(vec!["hextree"], 0).holds() && !row(vec![], 11).holds());
    }

    #[test]
    fn a_site_s_model_is_found_and_holds() {
        let found = models(Path::new("sites/tower")).unwrap();
        assert_eq!(found, [Path::new("sites/tower/tower.glb")]);
        let row = try_model(
            &crate::shared::drawing::gpu(),
            &ExtractionProgram::new(&crate::shared::drawing::gpu()),
            &found[0],
        )
        .unwrap();
        assert!(row.holds() && row.suns >= 5 && row.lowest_deg < 5.0 && row.triangles > 0 && row.edges > 0);
        assert!(
            try_model(
                &crate::shared::drawing::gpu(),
                &ExtractionProgram::new(&crate::shared::drawing::gpu()),
                Path::new("sites/tower/site.toml.glb")
            )
            .is_err()
        );
    }
}
