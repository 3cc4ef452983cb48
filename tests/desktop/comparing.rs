//! Two states of a site: what a change does to the sun.

use super::exporting::{answer, command, menu, name};
use super::*;
use gnomon::export::comparison;
use gnomon::export::figure::ChangeColours;
use gnomon::profile::comparison::Change;
use gnomon::shadow::ray_cast::RayCast;
use gnomon::shadow::{Scene, Technique};
use gnomon::site::{Overrides, Pair};
use gnomon::study::{self, CompareOutcome};
use gnomon::view::{Grid, Surface, View};
use std::ops::ControlFlow;

/// A second state beside a small site: only some components of it cast.
fn without(site: &Path, casts: &[String]) -> PathBuf {
    beside(site, &format!("casts = {casts:?}\n"))
}

/// The same, with further keys for its model.
fn beside(site: &Path, more: &str) -> PathBuf {
    let text = std::fs::read_to_string(site).unwrap();
    let path = site.with_file_name("without.toml");
    let list = format!("path = \"works.glb\"\n{more}");
    std::fs::write(&path, text.replace("path = \"works.glb\"\n", &list).replace("Works", "Works: before")).unwrap();
    path
}

/// The names of the small site's components.
fn components(site: &Path) -> Vec<String> {
    let site = gnomon::site::Site::load(site, &Overrides::default()).unwrap();
    site.mesh.components.into_iter().map(|component| component.name).collect()
}

pub(crate) fn compared(before: &Path, after: &Path) -> (Pair, CompareOutcome) {
    let pair = Pair::load(before, after, &Overrides::default()).unwrap();
    let outcome = study::compare(&pair, &mut |_| ControlFlow::Continue(())).unwrap();
    (pair, outcome)
}

/// Chooses the file that the open site is compared with.
fn compare_with(harness: &mut Harness<'_, App>, path: &Path) {
    click(harness, "Compare with");
    click(harness, "Another file…");
    answer(harness, path, "Compare");
}

/// Which pixels of a plan show ground and have only ground around them: no line and nothing thinner than a cell.
fn ground(pair: &Pair, grid: &Grid) -> Vec<bool> {
    let site = &pair.after;
    let of = |components: &[bool]| site.mesh.of_components(components);
    let scene = Scene { casters: of(&[]), receivers: of(&site.receives), ground: site.ground.level };
    let surface = RayCast::new(scene, View::Plan(*grid), None).surface().unwrap();
    let (width, height) = (grid.width as usize, grid.height as usize);
    let is_ground = |pixel: usize| {
        let (column, row) = (pixel % width, pixel / width);
        let within = column > 0 && row > 0 && column + 1 < width && row + 1 < height;
        within
            && (row - 1..=row + 1).all(|row| {
                (column - 1..=column + 1).all(|column| surface.face[row * width + column] == Surface::GROUND)
            })
    };
    (0..width * height).map(is_ground).collect()
}

/// How many ground pixels of a plan are wrong, and how many change; borders of colours are ignored.
fn wrong(
    grid: &Grid,
    (pixels, is_ground): (&[[u8; 4]], &[bool]),
    colours: &[[u8; 3]],
    of: &CompareOutcome,
) -> (usize, usize) {
    let cells = of.comparison.grid();
    let (width, height) = (i64::from(cells.width), i64::from(cells.height));
    let (mut wrong, mut changed) = (0, 0);
    for (at, pixel) in pixels.iter().enumerate() {
        let centre = grid.centre(at as u32 % grid.width, at as u32 / grid.width);
        let column = ((centre.x - cells.west) / cells.cell).floor() as i64;
        let row = ((cells.north - centre.y) / cells.cell).floor() as i64;
        if !is_ground[at] || column < 1 || row < 1 || column >= width - 1 || row >= height - 1 {
            continue;
        }
        let cell = (row * width + column) as usize;
        let around = |dx: i64, dy: i64| (cell as i64 + dy * width + dx) as usize;
        let all = || (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (dx, dy))).map(|(dx, dy)| around(dx, dy));
        let is_ground = |it: usize| of.surfaces.iter().all(|surface| surface.face[it] == Surface::GROUND);
        let is_plain = all().all(|it| is_ground(it) && colours[it] == colours[cell]);
        if is_plain {
            wrong += usize::from((0..3).any(|part| pixel[part].abs_diff(colours[cell][part]) > 1));
            changed += usize::from(of.comparison.change(cell).is_some_and(|change| change != 0));
        }
    }
    (wrong, changed)
}

/// The first row of the areas that is missing in the panel, with its label and both columns in order.
pub(crate) fn not_told(harness: &Harness<'_, App>, pair: &Pair, of: &CompareOutcome) -> Option<[String; 3]> {
    let places = |text: &str| -> Vec<egui::Pos2> {
        let text = text.replace('-', "−");
        harness.query_all_by_label(&text).map(|node| node.rect().center()).collect()
    };
    let follows = |from: egui::Pos2, to: egui::Pos2| to.x > from.x + 20.0 && (to.y - from.y).abs() < 6.0;
    let is_told = |[what, first, second]: &[String; 3]| {
        let (first_at, second_at) = (places(first), places(second));
        let pairs = first_at.iter().flat_map(|first| second_at.iter().map(move |second| (*first, *second)));
        let heads = if what.is_empty() { Vec::new() } else { places(what) };
        pairs
            .filter(|(first, second)| follows(*first, *second))
            .any(|(first, _)| what.is_empty() || heads.iter().any(|head| follows(*head, first)))
    };
    comparison::rows(&of.comparison, &pair.after.track).into_iter().find(|row| !is_told(row))
}

/// Undoes or redoes `times` times.
fn again(harness: &mut Harness<'_, App>, keys: egui::Modifiers, times: usize) {
    for _ in 0..times {
        harness.key_press_modifiers(keys, Key::Z);
        harness.run_steps(2);
        settle(harness);
    }
}

/// Keeps the site's hours for the comparison, and switches off the shadow of a component.
fn keep_and_switch_off(harness: &mut Harness<'_, App>, name: &str) {
    click(harness, "Find the hours");
    settle(harness);
    click(harness, "Compare from here");
    click(harness, "Components");
    click(harness, &format!("{name} casts"));
}

/// The state is kept, a component is switched off, and the difference equals that of the two states' files.
#[test]
fn change_from_a_kept_state_is_the_engines() {
    let (_folder, site) = small_site();
    let names = components(&site);
    let mut harness = window(Some(&site));
    keep_and_switch_off(&mut harness, &names[0]);
    settle(&mut harness);
    click(&mut harness, "Find the change");
    settle(&mut harness);

    let after = without(&site, &names[1..]);
    let (pair, outcome) = compared(&site, &after);
    assert!(outcome.comparison.total_m2_hours(Change::SunGained) > 100.0, "something changes");
    // every number of the table is there
    let track = &pair.after.track;
    let shown = |harness: &Harness<'_, App>, text: &str| harness.query_all_by_label(text).next().is_some();
    assert_eq!(not_told(&harness, &pair, &outcome), None);
    harness.get_by_label(&comparison::extent(&outcome.comparison));
    // and every pixel of the plan
    harness.key_press(Key::Num2);
    harness.step();
    harness.key_press(Key::F);
    harness.step();
    settle(&mut harness);
    let (View::Plan(grid), _) = harness.state().picture_view().unwrap() else { panic!("a plan") };
    let (_, _, pixels) = harness.state().picture().unwrap();
    let surfaces = [&outcome.surfaces[0], &outcome.surfaces[1]];
    let colours =
        ChangeColours::of(&outcome.comparison, surfaces, &outcome.meshes[1], pair.after.receivers, track.step_secs);
    let is_ground = ground(&pair, &grid);
    let (faults, changed) = wrong(&grid, (&pixels, &is_ground), &colours.of_cells, &outcome);
    assert!(changed > 100, "{changed} pixels change");
    assert_eq!(faults, 0, "pixels are wrong");
    for (_, what) in &colours.legend {
        assert!(shown(&harness, what), "the legend does not say {what}");
    }
    // a cell of another colour is seen
    let mut other = colours.of_cells;
    other.iter_mut().for_each(|colour| colour[0] ^= 8);
    assert!(wrong(&grid, (&pixels, &is_ground), &other, &outcome).0 > 500);

    // what was undone is compared with nothing, and comes back
    let undo = egui::Modifiers::COMMAND;
    again(&mut harness, undo, 1);
    harness.get_by_label("Find the change");
    again(&mut harness, undo, 1);
    harness.get_by_label("Find the hours");
    harness.get_by_label("The request has changed since: find it again.");
    again(&mut harness, undo.plus(egui::Modifiers::SHIFT), 2);
    harness.get_by_label("Find the change");
    assert!(harness.query_by_label("The request has changed since: find it again.").is_none());
    click(&mut harness, "Stop comparing");
    harness.get_by_label("Find the hours");
    assert!(harness.query_by_label("Sun lost and gained").is_none(), "nothing is told of a change any more");
}

/// When the study changes, the kept hours no longer fit, and are found again.
#[test]
fn kept_state_follows_the_study() {
    let (_folder, site) = small_site();
    let names = components(&site);
    let mut harness = window(Some(&site));
    keep_and_switch_off(&mut harness, &names[0]);
    write(&mut harness, "step", "4h");
    settle(&mut harness);
    click(&mut harness, "Find the change");
    settle(&mut harness);
    let (pair, outcome) = compared(&site, &without(&site, &names[1..]));
    assert!(not_told(&harness, &pair, &outcome).is_some(), "of the study before it is another change");
    let text = std::fs::read_to_string(&site).unwrap();
    std::fs::write(&site, text.replace("\"2h\"", "\"4h\"")).unwrap();
    let (pair, outcome) = compared(&site, &without(&site, &names[1..]));
    assert_eq!(not_told(&harness, &pair, &outcome), None);
}

/// The open site against another file: the command's files, byte for byte, and the pointer reads both hours.
#[test]
fn change_from_another_file_is_that_of_the_command() {
    let (folder, site) = small_site();
    let there = &components(&site)[1..];
    let before = beside(&site, &format!("casts = {there:?}\nreceives = {there:?}\n"));
    let mut harness = window(Some(&site));
    compare_with(&mut harness, &before);
    harness.get_by_label("new or higher");
    menu(&mut harness, "Export the hours…");
    let out = folder.path().join("window");
    answer(&mut harness, &out, "Write");
    let by_command = |name: &str, paths: [&Path; 2]| {
        let out = folder.path().join(name);
        let [before, after] = paths.map(Path::as_os_str);
        command(&["compare".as_ref(), before, after, "--out".as_ref(), out.as_ref(), "--quiet".as_ref()]);
        out
    };
    let (right, wrong) = (by_command("command", [&before, &site]), by_command("wrong", [&site, &before]));
    let [ours, theirs, others] = [&out, &right, &wrong].map(|folder| {
        let read = |name: &str| std::fs::read(folder.join(name)).unwrap();
        let mut json: serde_json::Value = serde_json::from_slice(&read("compare.json")).unwrap();
        let timings = json.as_object_mut().unwrap().remove("timings_secs").expect("timings");
        let stages: Vec<String> = timings.as_object().unwrap().keys().cloned().collect();
        (read("compare.png"), read("shadow-hours-difference.tif"), json, stages)
    });
    assert!(ours.0 == theirs.0, "the drawing is another one");
    assert!(ours.1 == theirs.1, "the raster is another one");
    assert_eq!((&ours.2, &ours.3), (&theirs.2, &theirs.3));
    // the opposite change has other files
    assert!(ours.0 != others.0 && ours.1 != others.1 && ours.2 != others.2);

    // under the pointer: what is read is what the engine found there
    let (_, outcome) = compared(&before, &site);
    let found = &outcome.comparison;
    harness.key_press(Key::Num2);
    harness.step();
    harness.key_press(Key::F);
    harness.step();
    settle(&mut harness);
    let (View::Plan(grid), _) = harness.state().picture_view().unwrap() else { panic!("a plan") };
    let most = found.most(Change::SunLost).expect("sun is lost");
    let rect = harness.get_by_label("Model").rect();
    let [east, north] = most.at;
    let x = (east - grid.west) / (grid.east() - grid.west);
    let y = (grid.north - north) / (grid.north - grid.south());
    harness.hover_at(rect.lerp_inside(egui::vec2(x as f32, y as f32)));
    harness.run_steps(3);
    let sun =
        |profile: &gnomon::profile::Profile| f64::from(profile.day_secs) / 3600.0 - f64::from(profile.hours(most.cell));
    let [earlier, later] = [found.before(), found.after()].map(sun);
    let said = format!("{earlier:.2} h of sun before, {later:.2} h after: −{:.2} h", most.hours);
    let (told, _) = named(&harness, "h of sun before");
    assert!(told.starts_with(&said), "{told} is not {said}");
}

/// Choices that cannot be combined are reported with the command's message, and the picture does not change.
#[test]
fn other_place_is_refused_as_by_the_command() {
    let (_folder, site) = small_site();
    let text = std::fs::read_to_string(&site).unwrap();
    let mut harness = window(Some(&site));
    let changes =
        [("latitude = 48.2", "latitude = 48.3"), ("[study]", "[ground]\nlevel = -3.0\n[study]"), ("[study]", "[stdy]")];
    for (from, to) in changes {
        let other = site.with_file_name("other.toml");
        std::fs::write(&other, text.replace(from, to)).unwrap();
        // the window holds the ground that it shows
        let ours = site.with_file_name("ours.toml");
        std::fs::write(&ours, text.replace("[study]", "[ground]\nlevel = 0.0\n[study]")).unwrap();
        let output = std::process::Command::new(env!("CARGO_BIN_EXE_gnomon"))
            .args(["compare".as_ref(), other.as_os_str(), ours.as_os_str()])
            .output()
            .expect("the command");
        let said = String::from_utf8_lossy(&output.stderr).replace("ours.toml", "site.toml");
        let said = said.trim().trim_start_matches("error: ").to_owned();
        assert!(!output.status.success() && !said.is_empty());
        compare_with(&mut harness, &other);
        let told = named(&harness, other.file_name().unwrap().to_str().unwrap()).0;
        assert_eq!(told, said);
        click(&mut harness, "Close");
        harness.get_by_label("Find the hours");
    }
}

#[test]
fn change_can_be_cancelled() {
    let (_folder, site) = small_site();
    let before = without(&site, &components(&site)[1..]);
    let mut harness = window(Some(&site));
    write(&mut harness, "step", "1s");
    settle(&mut harness);
    click(&mut harness, "Compare with");
    click(&mut harness, "Another file…");
    name(&mut harness, &before);
    assert!(!harness.state().is_settled(), "the change is on its way");
    harness.get_by_label("Cancel the hours");
    click(&mut harness, "Cancel the hours");
    assert!(harness.query_by_label("Cancel the hours").is_none(), "it is given up at once");
    settle(&mut harness);
    // nor is the site compared with anything
    harness.get_by_label("Find the hours");
    assert!(harness.query_by_label("Sun lost and gained").is_none(), "no change came");
}
