//! Hours of sun on façades and roofs, over the model.

use super::exporting::{answer, command, menu};
use super::*;
use gnomon::choice::Receivers;
use gnomon::export::patches::{Atlas, PatchContext};
use gnomon::shadow::ray_cast::RayCast;
use gnomon::shadow::{Scene, Technique};
use gnomon::site::{Overrides, Site};
use gnomon::study::{self, PatchOutcome};
use gnomon::view::{Camera, Surface, View};
use std::ops::ControlFlow;

/// The engine's result for one pixel of a face.
struct Seen {
    colour: [u8; 3],
    hours: f64,
    /// Metres right and down on its face; upright ones only.
    on_wall: Option<[f64; 2]>,
}

fn studied(path: &Path) -> (Site, PatchOutcome) {
    let asked = Overrides { receivers: Some(Receivers::Patches), ..Overrides::default() };
    let site = Site::load(path, &asked).unwrap();
    let outcome = study::patches(&site, site.patch_cell, &mut |_| ControlFlow::Continue(())).unwrap();
    (site, outcome)
}

/// The engine's result for each pixel that lies within a face; `None` for the others.
fn seen(site: &Site, outcome: &PatchOutcome, camera: &Camera) -> Vec<Option<Seen>> {
    let receivers = site.mesh.of_components(&site.receives);
    let scene = Scene { casters: site.mesh.of_components(&[]), receivers, ground: site.ground.level };
    let surface = RayCast::new(scene, View::Camera(*camera), None).surface().unwrap();
    let receivers = site.mesh.of_components(&site.receives);
    let Site { place, track, mesh, receives, .. } = site;
    let patches = &*outcome.patches;
    let answer = PatchContext { place, track, mesh, receives, patches, hours: &outcome.hours };
    let (atlas, bands) = (Atlas::of(&answer), answer.bands());
    let (width, height) = (camera.width as usize, camera.height as usize);
    let of_pixel = |pixel: usize| {
        let (column, row) = (pixel % width, pixel / width);
        if column < 1 || row < 1 || column + 1 >= width || row + 1 >= height {
            return None;
        }
        let face = surface.face[pixel];
        let around =
            (row - 1..=row + 1).flat_map(|row| (column - 1..=column + 1).map(move |column| row * width + column));
        if face >= Surface::GROUND || around.into_iter().any(|other| surface.face[other] != face) {
            return None;
        }
        let plane = receivers.planes()[face as usize];
        let along = camera.direction(column as u32, row as u32);
        let eye = camera.eye - receivers.origin;
        let point = eye - along * ((plane.truncate().dot(eye) + plane.w) / plane.truncate().dot(along));
        let facing = plane.truncate() * -plane.truncate().dot(along).signum();
        let patch = atlas.patch(patches, face, facing)?;
        let point = point + receivers.origin - patches.origin;
        let lit = atlas.lit(patches, patch, point);
        let from = point - patch.corner;
        let is_wall = patch.normal().z.abs() < 0.01 && patch.area_m2 > 20.0;
        Some(Seen {
            colour: bands.of_sun(lit, outcome.hours.samples),
            hours: f64::from(lit) / 3600.0,
            on_wall: is_wall.then(|| [from.dot(patch.right), from.dot(patch.down)]),
        })
    };
    (0..width * height).map(of_pixel).collect()
}

fn wrong(pixels: &[[u8; 4]], seen: &[Option<Seen>]) -> [usize; 2] {
    let mut count = [0, 0];
    for (pixel, seen) in pixels.iter().zip(seen) {
        if let Some(seen) = seen {
            count[0] += usize::from((0..3).any(|part| pixel[part].abs_diff(seen.colour[part]) > 1));
            count[1] += 1;
        }
    }
    count
}

/// Pixels, what the pointer reads, and the files.
#[test]
fn hours_on_facades_are_the_engines() {
    let (folder, site) = small_site();
    let mut harness = window(Some(&site));
    click(&mut harness, "On façades, too");
    click(&mut harness, "Find the hours");
    settle(&mut harness);
    let (View::Camera(camera), _) = harness.state().picture_view().unwrap() else { panic!("a camera") };
    let (_, _, pixels) = harness.state().picture().unwrap();
    let (loaded, outcome) = studied(&site);
    let mut seen = seen(&loaded, &outcome, &camera);
    let [faults, all] = wrong(&pixels, &seen);
    assert!(all > 20_000, "{all} pixels lie within faces");
    // where a texel ends, single and double numbers may differ
    assert!(faults * 200 <= all, "{faults} of {all} pixels are wrong");

    // the pointer on a wall
    let rect = harness.get_by_label("Model").rect();
    let on_wall = |(at, seen): (usize, &Option<Seen>)| Some((at, seen.as_ref()?.hours, seen.as_ref()?.on_wall?));
    let walls: Vec<_> = seen.iter().enumerate().filter_map(on_wall).filter(|(_, hours, _)| *hours > 0.0).collect();
    let (at, hours, [right, down]) = walls[walls.len() / 2];
    let (column, row) = (at as u32 % camera.width, at as u32 / camera.width);
    let share = |at: u32, of: u32| (at as f32 + 0.5) / of as f32;
    harness.hover_at(rect.lerp_inside(egui::vec2(share(column, camera.width), share(row, camera.height))));
    harness.run_steps(3);
    let (told, _) = named(&harness, "down on its face");
    let said: Vec<f64> = told.split(' ').filter_map(|word| word.parse().ok()).take(3).collect();
    let near = |one: f64, other: f64| (one - other).abs() < 0.03;
    assert!(near(said[0], hours) && near(said[1], right) && near(said[2], down), "{told}: {hours}, {right}, {down}");
    // and so does the card of that point
    let pointer = rect.lerp_inside(egui::vec2(share(column, camera.width), share(row, camera.height)));
    click_at(&mut harness, pointer);
    let (card, _) = named(&harness, "In the study: ");
    let of_study = card.strip_prefix("In the study: ").expect("the study");
    assert!(told.starts_with(of_study), "{card}: {told}");

    menu(&mut harness, "Export the hours…");
    let out = folder.path().join("window");
    answer(&mut harness, &out, "Write");
    let by_command = folder.path().join("command");
    let options = ["--receivers", "surfaces", "--quiet", "--out"].map(std::ffi::OsStr::new);
    command(&[&["profile".as_ref(), site.as_os_str()], options.as_slice(), &[by_command.as_ref()]].concat());
    for name in ["surfaces.png", "surfaces.glb", "surfaces.csv"] {
        let [ours, theirs] = [&out, &by_command].map(|folder| std::fs::read(folder.join(name)).unwrap());
        assert!(ours == theirs, "{name} is another one");
    }

    // a wrong colour is seen
    seen.iter_mut().flatten().for_each(|seen| seen.colour[1] ^= 8);
    assert!(wrong(&pixels, &seen)[0] * 2 > all);
    // hours do not lie on what receives otherwise
    click(&mut harness, "Components");
    let name = loaded.mesh.components[0].name.clone();
    click(&mut harness, &format!("{name} receives"));
    settle(&mut harness);
    assert!(harness.query_by_label("Show the hours").is_none(), "the hours are of other faces");
}

/// The command's notes about a study are in the panel as long as its hours are shown.
#[test]
fn notes_of_a_study_are_told() {
    let (folder, site) = small_site();
    std::fs::write(folder.path().join("sheet.obj"), "v 0 0 0\nv 10 0 0\nv 10 0 6\nv 0 0 6\nf 1 2 3 4\n").unwrap();
    let text = std::fs::read_to_string(&site).unwrap().replace("works.glb\"", "sheet.obj\"\nup = \"z\"");
    std::fs::write(&site, text).unwrap();
    let mut harness = window(Some(&site));
    let note = "1 of 1 patches (60 m²) has no known outer side";
    assert!(harness.query_by_label_contains(note).is_none());
    click(&mut harness, "On façades, too");
    click(&mut harness, "Find the hours");
    settle(&mut harness);
    assert_eq!(harness.query_all_by_label_contains(note).count(), 1);
    // hours on the plan have no such note
    click(&mut harness, "On façades, too");
    click(&mut harness, "Find the hours");
    settle(&mut harness);
    assert!(harness.query_by_label_contains(note).is_none());
}
