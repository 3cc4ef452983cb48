//! `gnomon verify`: its counts are right, and every row that is held to the bound is seen to fail.

use crate::shared::drawing::{plan, scene_of, to_sun};
use crate::shared::program::{PLACE, command, done, fails, site, stderr};
use crate::site::{SITE, load};
use glam::{DVec3, dvec3};
use gnomon::choice::{Engine, Method, Promise, Receivers, Settings, TABLE, Truth};
use gnomon::export::verify as told;
use gnomon::mesh::Mesh;
use gnomon::profile::Provenance;
use gnomon::shadow::ray_cast::RayCast;
use gnomon::shadow::soft_texture::{Choice, Fill, Painter, SoftTexture};
use gnomon::shadow::{DrawnMask, ShadowError, Technique};
use gnomon::site::{Overrides, Site};
use gnomon::study::verify::{Trial, hold, spread};
use gnomon::study::verify_surfaces::{SurfaceTrial, SurfaceTrials};
use gnomon::study::{Event, StudyError};
use gnomon::verification::{Difference, Edges, HoursDifference, Verification, is_edge_cell};
use gnomon::view::{Decider, FragmentCounts, Mask, Surface, View};
use serde_json::Value;
use std::ops::ControlFlow;
use std::sync::Arc;

/// A mask as a picture: `#` is shadow, `+` a penumbra's darker half, `-` its lighter half.
fn mask(rows: &[&str]) -> Mask {
    let share = rows.iter().flat_map(|row| row.bytes()).map(|cell| match cell {
        b'#' => 0,
        b'+' => 100,
        b'-' => 200,
        _ => 255,
    });
    Mask { width: rows[0].len() as u32, height: rows.len() as u32, share: share.collect() }
}

#[test]
fn distances_are_to_the_nearest_cell_on_the_other_side() {
    let picture = mask(&["......", ".#+-..", ".##...", "......", "......"]);
    let edges = Edges::of(&picture);
    // the penumbra's lighter half is no shadow
    assert_eq!((edges.distance(3, 1), edges.distance(2, 1), edges.distance(1, 1)), (Some(1.0), Some(1.0), Some(1.0)));
    assert_eq!(edges.distance(5, 4), Some(13_f64.sqrt()));
    assert_eq!(edges.distance(0, 4), Some(5_f64.sqrt()));
    assert_eq!(Edges::of(&mask(&["...", "-.."])).distance(1, 1), None);
    assert_eq!(Edges::of(&mask(&["#"])).distance(0, 0), None);

    // against all pairs of cells
    let picture = mask(&["#........#", "..........", "..........", "..........", ".........."]);
    let edges = Edges::of(&picture);
    for cell in 0..50_u32 {
        let at = |cell: u32| (f64::from(cell % 10), f64::from(cell / 10));
        let (x, y) = at(cell);
        let other = |&of: &u32| (picture.share[of as usize] > 127) != (picture.share[cell as usize] > 127);
        let distance = |of: u32| (at(of).0 - x).hypot(at(of).1 - y);
        let nearest = (0..50).filter(other).map(distance).min_by(f64::total_cmp);
        assert_eq!(edges.distance(cell % 10, cell / 10), nearest, "{cell}");
    }
}

#[test]
fn a_cell_differs_where_more_than_half_the_sun_does() {
    let truth = mask(&["#+-.", "####"]);
    let mut soft = truth.clone();
    soft.share = vec![127, 228, 72, 128, 0, 0, 0, 128];
    let difference = Difference::by_half(&soft, &truth);
    assert_eq!((&difference.edge_at[..], difference.other_differ), (&[(1, 0), (2, 0), (3, 1)][..], 0));
}

#[test]
fn hours_are_off_in_the_worst_cell_and_in_the_mean() {
    let off = HoursDifference::between(
        &vec![0_u32, 255 * 3600, 255 * 7200].into(),
        &vec![0_u32, 255 * 7200, 255 * 1800].into(),
    );
    assert_eq!((off.largest, off.mean), (1.5, 2.5 / 3.0));
}

#[test]
fn samples_are_spread_and_half_of_them_lie_at_edges() {
    let lit = |at: usize| if (at % 200).abs_diff(100) < 20 { 0 } else { 255 };
    let strip = Mask { width: 200, height: 100, share: (0..20_000).map(lit).collect() };
    let cells = spread(&strip, 0..200);
    let edge = cells.iter().filter(|&&(column, row)| is_edge_cell(&strip, column, row)).count();
    assert!((100..110).contains(&edge), "{edge}");
    for quarter in 0..4 {
        let (column, row) = (100 * (quarter % 2), 50 * (quarter / 2));
        let within = |&&(x, y): &&(u32, u32)| (column..column + 100).contains(&x) && (row..row + 50).contains(&y);
        assert!(cells.iter().filter(within).count() > 30, "{quarter}");
    }
    assert_eq!(spread(&strip, 150..200), cells[150..]);
    assert_eq!(spread(&mask(&["..", ".."]), 0..3).len(), 3);
}

#[test]
fn a_cell_at_which_the_trees_are_wrong_is_seen() {
    for (name, parts) in crate::shared::scenes::small() {
        let mesh = Mesh::build(parts).unwrap();
        for receivers in [Receivers::Ground, Receivers::Top] {
            let mut cast = RayCast::new(scene_of(&mesh, receivers, 0.0), plan(40.371_93, 60), None);
            let sun = to_sun(214.6, 38.8);
            let drawn = cast.draw(sun).unwrap().read().unwrap();
            let cells: Vec<_> = (0..60).flat_map(|row| (0..60).map(move |column| (column, row))).collect();
            let truth: Vec<u8> =
                cells.iter().map(|&(column, row)| cast.share_without_trees(column, row, sun)).collect();
            assert_eq!(truth, drawn.share, "{name} {receivers:?}");
            let mut wrong = drawn.clone();
            wrong.share[17 * 60 + 23] ^= 255;
            let difference = Difference::at(&cells, &wrong, &truth);
            assert_eq!((difference.differ(), difference.cells()), (1, 3600));
        }
    }
}

/// Ray casting that turns some cells over, and says that a map has decided them, or not.
struct Wrong {
    rays: RayCast,
    mask: Mask,
    cells: Vec<usize>,
    decided: Decider,
}

impl Technique for Wrong {
    fn draw(&mut self, to_sun: DVec3) -> Result<DrawnMask<'_>, ShadowError> {
        self.mask = self.rays.draw(to_sun)?.read()?;
        self.cells.iter().for_each(|&cell| self.mask.share[cell] ^= 255);
        Ok(DrawnMask::Memory(&self.mask))
    }

    fn surface(&self) -> Result<Surface, ShadowError> {
        self.rays.surface()
    }

    fn counted(&mut self, _: DVec3) -> Result<Option<FragmentCounts>, ShadowError> {
        let Mask { width, height, ref share } = self.mask;
        let decided = Some(vec![self.decided; share.len()]);
        Ok(Some(FragmentCounts { width, height, reached: Vec::new(), all: 0, decided }))
    }
}

fn asked() -> Overrides {
    let settings = Settings { sun_samples: Some(2), ..Settings::default() };
    Overrides { size: Some(60), settings, receivers: Some(Receivers::Ground), ..Overrides::default() }
}

fn trial(site: &Site, promise: Promise, cells: Vec<usize>, decided: Decider) -> Trial {
    let casters = site.mesh.of_components(&site.casts);
    let scene = gnomon::shadow::Scene { receivers: casters.of_components(&[]), casters, ground: site.ground.level };
    let rays = RayCast::new(scene, View::Plan(site.grid), None);
    let mask = Mask { width: 0, height: 0, share: Vec::new() };
    let drawn = Provenance {
        technique: Method::Stencil,
        finder: None,
        engine: Engine::Cpu,
        adapter: None,
        settings: Settings::NONE,
        resolution_secs: 0,
    };
    Trial { drawn, against: Truth::Centre, promise, technique: Box::new(Wrong { rays, mask, cells, decided }) }
}

fn held(site: &Site, trials: Vec<Trial>) -> Verification {
    hold(site, trials, None, &mut |_| ControlFlow::Continue(())).unwrap()
}

#[test]
fn a_wrong_technique_does_not_hold_and_says_how_wrong() {
    let site = load(SITE, &asked()).unwrap();
    let right = held(&site, vec![trial(&site, Promise::Exact, Vec::new(), Decider::VolumeLight)]);
    assert_eq!((told::failure(&right), right.edge_share, right.clean), (None, 0.005, true));
    assert_eq!((right.rows[0].furthest, right.rows[0].share_off), (None, 0.0));
    assert_eq!(right.rows[0].hours_off, Some(HoursDifference { largest: 0.0, mean: 0.0 }));

    // the first cell of the first row lies in the sun at every instant
    let wrong = held(&site, vec![trial(&site, Promise::Exact, vec![0], Decider::VolumeShadow)]);
    let row = &wrong.rows[0];
    assert_eq!((row.difference.edge_differ, row.difference.other_differ, row.thin), (0, 9, 0));
    assert!(row.furthest > Some(5.0), "{:?}", row.furthest);
    let off = row.hours_off.unwrap();
    assert!(off.largest == 4.0 && (off.mean - 4.0 / site.grid.cells() as f64).abs() < 1e-12, "{off:?}");
    let failure = told::failure(&wrong).unwrap();
    assert!(failure.starts_with("stencil does not hold: 0 of ") && failure.lines().count() == 1, "{failure}");
    assert!(told::table(&wrong, &site).contains("FAILS"));
    // what decides nothing fails nothing
    let near = held(&site, vec![trial(&site, Promise::Near, vec![0], Decider::VolumeShadow)]);
    assert_eq!((told::failure(&near), near.rows[0].difference.differ()), (None, 9));
    let mut trees = near;
    trees.rows[1].difference.other_differ = 1;
    assert!(told::failure(&trees).unwrap().starts_with("ray-cast does not hold: "));
}

#[test]
fn what_a_map_missed_counts_apart() {
    let site = load(SITE, &asked()).unwrap();
    let both = |decided| {
        let exact = trial(&site, Promise::Exact, Vec::new(), decided);
        held(&site, vec![exact, trial(&site, Promise::ExactButForMap, vec![0, 7], decided)])
    };
    let [by_map, by_volumes] = [Decider::MapShadow, Decider::VolumeShadow].map(both);
    assert_eq!((by_map.rows[0].missed, by_map.rows[1].missed, by_map.rows[1].difference.differ()), (None, Some(18), 0));
    assert_eq!((by_volumes.rows[1].missed, by_volumes.rows[1].difference.differ()), (Some(0), 18));
    assert_eq!((by_map.rows[1].furthest, by_map.rows[1].hours_off.unwrap().largest), (None, 4.0));
}

/// One texel of a façade that is turned over counts once an instant, and is seen.
#[test]
fn a_wrong_texel_of_a_facade_is_seen() {
    let site = load(SITE, &asked()).unwrap();
    let with = |wrong: Option<usize>| {
        let mut surfaces = SurfaceTrials::without_trials(&site).unwrap().expect("façades");
        let patches = Arc::clone(surfaces.patches());
        let casters = site.mesh.of_components(&site.casts);
        let rays = SoftTexture::new(casters, Arc::clone(&patches), Painter::OnProcessor(Fill::Faces), Choice::Rays);
        let mut rays = rays.unwrap();
        let draw = Box::new(move |to_sun: DVec3| {
            let mut seen = rays.seen(to_sun)?;
            wrong.iter().for_each(|at| seen[*at] ^= 1);
            Ok(seen)
        });
        let drawn = Provenance {
            technique: Method::SoftTexture,
            finder: None,
            engine: Engine::Cpu,
            adapter: None,
            settings: Settings::NONE,
            resolution_secs: 0,
        };
        surfaces.add(SurfaceTrial { drawn, promise: Promise::Exact, draw });
        // the tower's and not the yard's, over which the tower's shadow turns
        let level = patches.list.iter().filter(|patch| patch.plane.z > 0.9);
        let roof = level.max_by(|one, other| one.corner.z.total_cmp(&other.corner.z)).unwrap();
        (
            hold(&site, Vec::new(), Some(surfaces), &mut |_| ControlFlow::Continue(())).unwrap(),
            roof.texels.start as usize,
        )
    };
    let (right, roof) = with(None);
    let row = &right.rows[0];
    assert!(row.on_surfaces && row.difference.edge_cells > 0 && row.difference.differ() == 0);
    assert_eq!(row.difference.cells(), (right.surfaces.unwrap().texels * right.instants) as u64);
    assert_eq!((told::failure(&right), row.furthest, row.share_off), (None, None, 0.0));
    assert_eq!(row.hours_off, Some(HoursDifference { largest: 0.0, mean: 0.0 }));
    // on the tower's roof no shadow falls
    let (wrong, _) = with(Some(roof));
    let row = &wrong.rows[0];
    assert_eq!((row.difference.edge_differ, row.difference.other_differ, row.thin), (0, right.instants as u64, 0));
    assert_eq!(row.hours_off.unwrap().largest, 4.0);
    let failure = told::failure(&wrong).unwrap();
    assert!(failure.starts_with("soft-texture on surfaces does not hold: 0 of "), "{failure}");
    assert!(told::table(&wrong, &site).contains("FAILS"));
}

#[test]
fn interruption_is_heard_between_instants() {
    let site = load(SITE, &asked()).unwrap();
    let mut drawn = 0;
    let stopped = hold(&site, Vec::new(), None, &mut |event| {
        drawn += usize::from(matches!(event, Event::Drawn { .. }));
        if drawn == 2 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    assert!(matches!(stopped, Err(StudyError::Interrupted)) && drawn == 2);
}

#[test]
fn a_box_is_verified_as_a_table_and_as_json() {
    let folder = site();
    let table = done(folder.path(), "verify . --size 200 --sun-samples 4 --receivers ground --step 1h");
    for word in ["Paris: 2026-09-18 10:00 to 12:00, 3 instants", "receivers ground", "4 points", "at most 0.5% differ"]
    {
        assert!(table.contains(word), "{table}");
    }
    for row in ["stencil", "projected", "hybrid", "shadow-map", "smoothie", "soft-texture", "ray-cast"] {
        assert_eq!(table.lines().filter(|line| line.starts_with(&format!("{row} "))).count(), 1, "{table}");
    }
    assert_eq!(table.lines().filter(|line| line.starts_with("  on gpu ")).count(), 2, "{table}");
    assert_eq!(table.matches("  holds\n").count(), 6, "{table}");
    assert!(
        table.contains(", silhouettes hextree\nmaps of 2048 × 2048 texels, shadow-map filtered fast-2x2\n"),
        "{table}"
    );
    let on_gpu = done(folder.path(), "verify . --size 50 --sun-samples 1 --step 1h --silhouette gpu");
    assert!(on_gpu.contains(", silhouettes gpu; smoothie hextree\n"), "{on_gpu}");
    assert!(table.lines().all(|line| line.chars().count() <= 120), "{table}");

    let options =
        "--json --quiet --at 2026-09-18T11:00 --cell 1 --sun-samples 4 --map-size 256 --pcf none --silhouette brute";
    let json: Value =
        serde_json::from_str(&done(folder.path(), &format!("verify open.glb --place 48.9,2.3 {options}"))).unwrap();
    assert_eq!(
        (&json["holds"], &json["clean"], &json["edge_share_bound"]),
        (&true.into(), &false.into(), &0.01.into())
    );
    assert_eq!((&json["instants_compared"], &json["sun_samples"], &json["cell"]), (&1.into(), &4.into(), &1.0.into()));
    let rows = json["techniques"].as_array().unwrap();
    let row = |name: &str| rows.iter().find(|row| row["technique"] == name).unwrap();
    assert_eq!((&row("shadow-map")["map_size"], &row("shadow-map")["pcf"]), (&256.into(), &"none".into()));
    assert_eq!((&row("stencil")["against"], &row("stencil")["silhouette"]), (&"centre".into(), &"brute".into()));
    assert_eq!((&row("smoothie")["against"], &row("smoothie")["holds"]), (&"disc".into(), &Value::Null));
    assert_eq!((&row("ray-cast")["cells"], &row("ray-cast")["holds"]), (&200.into(), &true.into()));
    // every technique is compared, on each machine where it draws
    for method in TABLE.iter().filter(|method| method.method != Method::Auto) {
        assert!(rows.iter().any(|row| row["technique"] == method.word), "{}", method.word);
    }
    let on_surfaces: Vec<_> = rows.iter().filter(|row| row["compared_on"] == "surfaces").collect();
    for (row, engine) in on_surfaces.iter().zip(["cpu", "gpu"]) {
        assert_eq!((&row["technique"], &row["engine"]), (&"soft-texture".into(), &engine.into()));
        assert_eq!((&row["holds"], &row["against"]), (&true.into(), &"centre".into()));
        assert_eq!(row["cells"], json["surfaces"]["texels"]);
    }
    assert_eq!((on_surfaces.len(), on_surfaces[0]["edge_differ"].as_u64()), (2, Some(0)));
    assert!(json["surfaces"]["cell"].as_f64().unwrap() >= 1.0 && json["surfaces"]["edge_share_bound"] == 0.01);
    let legend = table.lines().last().unwrap();
    assert!(legend.starts_with("soft-texture: compared on façades and roofs, in "), "{table}");
    // one instant has no weight
    assert_eq!((&row("hybrid")["map_missed"], &row("hybrid")["mean_hours_off"]), (&0.into(), &Value::Null));
}

/// Far out, beyond what single precision can tell of a cell.
#[test]
fn a_plan_that_the_adapter_cannot_resolve_fails() {
    let folder = site();
    let at = "2026-09-18T07:33:14";
    let sun: Value = serde_json::from_str(&done(folder.path(), &format!("sun . --at {at} --json"))).unwrap();
    let sun = &sun["instants"][0];
    assert!(sun["altitude_deg"].as_f64().unwrap() < 0.02, "{sun}");
    let azimuth = sun["azimuth_deg"].as_f64().unwrap().to_radians();
    // the shadow's southern edge, from the corner in the south-east
    let away = dvec3(-azimuth.sin(), -azimuth.cos(), 0.0);
    let edge = dvec3(5.0, -5.0, 0.0) + away * 65_000.0;
    let [west, south, east, north] = [edge.x - 0.13, edge.y - 0.13, edge.x + 0.13, edge.y + 0.13];
    let region = format!("--region {west},{south},{east},{north} --cell 0.001");
    let output =
        command(folder.path(), &format!("verify . --at {at} {region} --sun-samples 1 --quiet")).output().unwrap();
    let told = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{told}{}", String::from_utf8_lossy(&output.stdout));
    // drivers may have their own say beside it
    let says = |line: &&str| line.starts_with("error: stencil does not hold: ");
    assert_eq!(told.lines().filter(says).count(), 1, "{told}");
    assert!(String::from_utf8_lossy(&output.stdout).contains("  FAILS\n"));
}

#[test]
fn what_cannot_be_verified_is_told() {
    let folder = site();
    let path = folder.path();
    fails(path, "verify . --at 2026-09-18T02:00", 1, &["no sun at any", "--from"]);
    fails(path, "verify . --technique stencil", 2, &["--technique"]);
    fails(path, "verify . --at 11:00 --step 1h", 2, &["--step", "--at"]);
    fails(path, "verify . --size 64 --hextree-depth 4", 2, &["--hextree-depth", "--silhouette hextree"]);
    fails(path, "verify tower.glb --date 2026-09-18", 2, &["--place LAT,LON"]);

    // no caster above the ground, and none at all
    for (name, more) in [("deep", "position = [0, 0, -30]\n[ground]\nlevel = 0.0\n"), ("none", "casts = false\n")] {
        let text = format!("{PLACE}[[model]]\npath = \"tower.glb\"\n{more}");
        std::fs::write(path.join(format!("{name}.toml")), text).unwrap();
        let said = done(path, &format!("verify {name}.toml --at 2026-09-18T11:00 --size 64 --sun-samples 2 --quiet"));
        assert_eq!(said.matches("  holds\n").count(), 5, "{said}");
    }
}

/// A system whose only selected backend does not exist.
#[cfg(unix)]
#[test]
fn without_an_adapter_there_is_no_verification() {
    let folder = site();
    let output = command(folder.path(), "verify .").env("WGPU_BACKEND", "dx12").output().unwrap();
    let told = stderr(&output);
    assert_eq!((output.status.code(), told.lines().count()), (Some(1), 1), "{told}");
    for word in ["verify", "no graphics adapter was found", "install a driver"] {
        assert!(told.contains(word), "{told}");
    }
    assert!(output.stdout.is_empty());
}
