//! Ray casting with single rays and with beams: `cargo bench --bench rays`. Prints tables in Markdown.
//!
//! On one thread, nanoseconds per ray and millions of rays per second, medians over the suns of a site's study: for the
//! plain caster, for the same rays one by one, and for beams of 16 and of 64, with each instruction set that the
//! machine has. They take turns for each sun position, so that ratios do not depend on other load. `-- SITE` measures
//! another site than the samples, such as the city of `benches/peers`. `docs/benchmarks/rays.md` has the results of a
//! run and the machine.

mod timing;

use glam::DVec3;
use gnomon::mesh::Mesh;
use gnomon::shadow::JUDGED_ABOVE_M;
use gnomon::shadow::rays::{PlainCaster, RayCaster, Shear, SimdLevel};
use gnomon::site::{Overrides, Site};
use std::hint::black_box;
use std::path::Path;
use timing::{median, timed};

/// Cells a side of a square whose rays are asked at once, and squares along each side of what is looked at.
const SIDE: u32 = 8;
const SQUARES: u32 = 40;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| argument != "--bench").collect();
    // `cargo test --benches` only asks whether it runs
    if arguments.iter().any(|argument| argument == "--test") {
        return;
    }
    println!(
        "| model | triangles | way | built, ms | to the sun, ns | M a second | of plain | first hit, ns | of plain |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    let samples =
        ["tower", "industry", "headquarters"].map(|name| format!("{}/sites/{name}", env!("CARGO_MANIFEST_DIR")));
    for folder in if arguments.is_empty() { &samples[..] } else { &arguments } {
        let site = Site::load(Path::new(folder), &Overrides::default()).expect("a site");
        let instants = site.track.instants.iter().filter(|instant| !instant.night);
        let suns: Vec<DVec3> = instants.map(|instant| instant.to_sun).collect();
        let name = Path::new(folder).file_stem().unwrap_or_default().to_string_lossy();
        rows(&name, &site.mesh.of_components(&site.casts), site.ground.level, &suns);
    }
}

/// Points on the ground in the middle of a mesh, square by square, around its origin.
fn points(mesh: &Mesh, ground: f64) -> Vec<DVec3> {
    let (low, high) = mesh.bounds().unwrap_or_default();
    let (middle, size) = ((low + high) / 2.0, (high - low).truncate().max_element() * 0.7);
    let cell = size / f64::from(SIDE * SQUARES);
    let of_square = |square: u32| {
        (0..SIDE * SIDE).map(move |at| {
            let column = square % SQUARES * SIDE + at % SIDE;
            let row = square / SQUARES * SIDE + at / SIDE;
            DVec3::new(f64::from(column), f64::from(row), 0.0) * cell - DVec3::new(size, size, 0.0) / 2.0
        })
    };
    let at = middle.with_z(ground + JUDGED_ABOVE_M) - mesh.origin;
    (0..SQUARES * SQUARES).flat_map(of_square).map(|point| point + at).collect()
}

fn rows(name: &str, mesh: &Mesh, ground: f64, suns: &[DVec3]) {
    let points = points(mesh, ground);
    let reach = points.iter().map(|point| point.abs().max_element()).fold(0.0, f64::max) + mesh.top().abs() + 1.0;
    let mut built = [Vec::new(), Vec::new()];
    let plain = timed(&mut built[0], || PlainCaster::new(mesh, reach));
    let casters: Vec<(SimdLevel, RayCaster)> = SimdLevel::all()
        .into_iter()
        .map(|level| (level, timed(&mut built[1], || RayCaster::new(mesh, reach)).on(level)))
        .collect();
    let mut times = vec![[Vec::new(), Vec::new()]; 1 + 3 * casters.len()];
    for &to_sun in suns {
        let shear = Shear::along(to_sun);
        let [blocked, first] = &mut times[0];
        timed(blocked, || points.iter().filter(|point| black_box(plain.blocked(**point, to_sun))).count());
        timed(first, || points.iter().filter(|point| black_box(plain.first_hit(**point, to_sun).is_some())).count());
        for ((_, caster), times) in casters.iter().zip(times[1..].chunks_mut(3)) {
            let [blocked, first] = &mut times[0];
            timed(blocked, || points.iter().filter(|point| black_box(caster.blocked(**point, &shear))).count());
            timed(first, || {
                points.iter().filter(|point| black_box(caster.first_hit(**point, to_sun).is_some())).count()
            });
            for (rays, [blocked, first]) in [16, 64].into_iter().zip(&mut times[1..]) {
                timed(blocked, || {
                    points.chunks(rays).for_each(|some| {
                        black_box(caster.blocked_beam(some, &shear));
                    });
                });
                timed(first, || {
                    let mut hits = [None; RayCaster::MOST_RAYS];
                    points.chunks(rays).for_each(|some| caster.first_hits(some, &shear, black_box(&mut hits)));
                });
            }
        }
    }
    let per_ray = |times: &Vec<f64>| median(times.clone()) * 1e6 / points.len() as f64;
    let [plain_blocked, plain_first] = [per_ray(&times[0][0]), per_ray(&times[0][1])];
    let mut ways = vec![("plain".to_owned(), median(built[0].clone()))];
    for (level, _) in &casters {
        let built = median(built[1].clone());
        ways.extend(["alone", "16", "64"].map(|rays| (format!("{level:?}, {rays}"), built)));
    }
    for ((way, built), [blocked, first]) in ways.iter().zip(&times) {
        let (blocked, first) = (per_ray(blocked), per_ray(first));
        println!(
            "| {name} | {} | {way} | {built:.0} | {blocked:.0} | {:.1} | {:.2} | {first:.0} | {:.2} |",
            mesh.faces.len(),
            1e3 / blocked,
            blocked / plain_blocked,
            first / plain_first
        );
    }
}
