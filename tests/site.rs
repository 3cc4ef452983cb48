//! From site files and options to the checked request: what they mean, and the message for every mistake.

use crate::shared::said;
use glam::DVec3;
use gnomon::choice::{Engine, Method, Receivers};
use gnomon::cli::Options;
use gnomon::formats::{Model, ModelError, ReadOptions, Up};
use gnomon::mesh::Part;
use gnomon::message::Worded;
use gnomon::site::file::SiteFile;
use gnomon::site::{LoadedSun, Models, Overrides, Site, SiteError, WrittenSite, load_sun};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A site whose tower is 10 × 10 × 40 m, with a low yard of 60 × 60 m around it.
pub(crate) const SITE: &str = r#"
[place]
name = "Champ de Mars, Paris"
latitude = 48.8583
longitude = 2.2945
elevation = 35.0
time_zone = "Europe/Paris"

[[model]]
path = "tower.glb"
casts = ["iron"]

[study]
date = 2026-09-18
from = "10:00"
to = "14:00"
step = "30min"
"#;

pub(crate) fn folder(site: &str) -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("site.toml"), site).expect("a site file");
    std::fs::write(folder.path().join("tower.glb"), "").expect("a model");
    folder
}

/// A closed box, counter-clockwise seen from outside.
fn block(name: &str, alias: &str, low: DVec3, high: DVec3) -> Part {
    let corner = |i: usize| DVec3::select(glam::BVec3::new(i & 1 > 0, i & 2 > 0, i & 4 > 0), high, low);
    let sides: [[u32; 4]; 6] = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    Part {
        name: name.to_owned(),
        aliases: vec![name.to_owned(), alias.to_owned()],
        positions: (0..8).map(corner).collect(),
        triangles: sides.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect(),
        ..Part::default()
    }
}

pub(crate) fn tower(_: &Path, _: &ReadOptions) -> Result<Model, ModelError> {
    let at = DVec3::new;
    let parts = vec![
        block("tower", "iron", at(-5.0, -5.0, 0.0), at(5.0, 5.0, 40.0)),
        block("yard", "grass", at(-30.0, -30.0, 0.0), at(30.0, 30.0, 1.0)),
    ];
    Ok(Model { parts, up: Up::Z, ..Model::default() })
}

pub(crate) fn load(site: &str, asked: &Overrides) -> Result<Site, SiteError> {
    Site::load_with(folder(site).path(), asked, tower)
}

pub(crate) fn some<T: std::str::FromStr<Err: std::fmt::Debug>>(text: &str) -> Option<T> {
    Some(text.parse().expect("a value"))
}

#[test]
fn a_site_file_as_meant() {
    let site = load(SITE, &Overrides::default()).unwrap();
    assert_eq!(site.place.name, "Champ de Mars, Paris");
    assert_eq!(site.place.time_zone.name(), "Europe/Paris");
    assert_eq!(site.track.instants.len(), 9);
    assert!(site.track.refraction);
    assert_eq!((site.casts.as_slice(), site.receives.as_slice()), (&[true, false][..], &[true, true][..]));
    assert_eq!(site.ground.level, 0.0);
    assert_eq!((site.method, site.engine, site.receivers), (Method::Auto, Engine::Auto, Receivers::Top));
    assert_eq!(site.grid.width.max(site.grid.height), 2048);
}

/// In the morning of 18 September the shadow falls west and north; only the tower throws one.
#[test]
fn the_default_region_holds_models_and_shadows() {
    let site = load(SITE, &Overrides::default()).unwrap();
    let [west, south, east, north] = site.grid.region();
    for instant in site.track.instants.iter().filter(|instant| !instant.night) {
        let throw = -instant.to_sun.truncate() / instant.to_sun.z;
        let tip = throw * 40.0 + throw.signum() * 5.0;
        assert!(west < tip.x && tip.x < east && south < tip.y && tip.y < north, "{tip}");
    }
    let margin = 0.021 * (north - south).max(east - west);
    assert!((-30.0 - south).abs() <= margin, "{south}: nothing falls south of the yard");
    assert!((30.0 - east).abs() <= margin, "{east}");
    assert!(west > -120.0 && north < 120.0);
}

/// A model of less than a millimetre still has a plan, which `gnomon volumes` does not even draw.
#[test]
fn a_tiny_model_has_a_plan() {
    let tiny = SITE.replace("path = \"tower.glb\"", "path = \"tower.glb\"\nscale = 0.00001");
    let grid = load(&tiny, &Overrides::default()).unwrap().grid;
    assert!(grid.cell == 0.001 && (1000..1100).contains(&grid.width), "{grid:?}");
}

/// Before nine in December the sun is below 13.1°: the shadow is cut at 4.3 heights.
#[test]
fn long_shadows_are_cut() {
    let winter = SITE.replace("2026-09-18", "2026-12-21").replace("14:00", "15:00");
    let [west, south, east, north] = load(&winter, &Overrides::default()).unwrap().grid.region();
    let far = 4.3 * 40.0 + 5.0;
    let margin = 0.03 * (east - west).max(north - south);
    assert!(west > -far - margin && north < far + margin && east < far + margin, "{west} {north}");
    assert!(north > 100.0 && south < -30.0);
    let night = Overrides { at: some("2026-09-18T23:00"), ..Overrides::default() };
    let [west, _, _, north] = load(SITE, &night).unwrap().grid.region();
    assert!((-32.0..-30.0).contains(&west) && (30.0..32.0).contains(&north));
}

#[test]
fn grids_in_whole_cells_from_the_north_west() {
    let grid = |region, cell, size| {
        let asked = Overrides { region: Some(region), cell, size, ..Overrides::default() };
        load(SITE, &asked).unwrap().grid
    };
    let given = grid([-10.0, -20.0, 30.3, 40.0], Some(0.5), None);
    assert_eq!((given.west, given.north, given.width, given.height), (-10.0, 40.0, 81, 120));
    assert_eq!(given.region(), [-10.0, -20.0, 30.5, 40.0]);
    let sized = grid([-10.0, -20.0, 30.0, 40.0], None, Some(600));
    assert_eq!((sized.width, sized.height, sized.cell), (400, 600, 0.1));
    assert_eq!(grid([0.0, 0.0, 1.0, 1.0], Some(50.0), None).width, 1);
    let plan = format!("{SITE}\n[plan]\nregion = [-100, -50, 100, 50]\ncell = 0.5\n");
    let site = load(&plan, &Overrides::default()).unwrap();
    assert_eq!((site.grid.width, site.grid.height), (400, 200));
    let site = load(&plan, &Overrides { size: Some(100), ..Overrides::default() }).unwrap();
    assert_eq!((site.grid.width, site.grid.height), (100, 50));
}

#[test]
fn names_take_components_by_node_mesh_or_material() {
    let casts = |names: &str| load(&SITE.replace("[\"iron\"]", names), &Overrides::default()).unwrap().casts;
    assert_eq!(casts("true"), [true, true]);
    assert_eq!(casts("false"), [false, false]);
    assert_eq!(casts("[]"), [false, false]);
    assert_eq!(casts("[\"grass\", \"tower\"]"), [true, true]);
    assert_eq!(casts("[\"yard\"]"), [false, true]);
}

#[test]
fn options_go_before_the_file() {
    let asked = Overrides {
        date: some("2026-10-25"),
        from: some("02:30+02:00"),
        to: some("02:30+01:00"),
        step_secs: Some(900),
        technique: Some(Method::RayCast),
        engine: Some(Engine::Cpu),
        receivers: Some(Receivers::Ground),
        no_refraction: true,
        ..Overrides::default()
    };
    let site = load(SITE, &asked).unwrap();
    assert_eq!((site.track.instants.len(), site.track.window_secs()), (5, 3600));
    assert!(!site.track.refraction);
    assert_eq!((site.method, site.engine, site.receivers), (Method::RayCast, Engine::Cpu, Receivers::Ground));
    // A `--from` with its own date goes before the date in the file.
    let dated = Overrides { from: some("2026-12-01T11:00"), ..Overrides::default() };
    assert_eq!(load(SITE, &dated).unwrap().track.days[0].date.to_string(), "2026-12-01");
    let at = Overrides { at: some("15:00"), ..Overrides::default() };
    let track = load(SITE, &at).unwrap().track;
    assert_eq!(track.instants[0].time.to_rfc3339(), "2026-09-18T15:00:00+02:00");
}

#[test]
fn a_site_is_a_file_a_folder_or_a_model_with_its_place() {
    let folder = folder(SITE);
    let none = Overrides::default();
    let file: PathBuf = folder.path().join("site.toml");
    let sun = |path: &Path, asked: &Overrides| load_sun(path, asked);
    assert_eq!(sun(folder.path(), &none).unwrap(), sun(&file, &none).unwrap());
    let model = folder.path().join("tower.glb");
    let error = Site::load_with(&model, &none, tower).expect_err("no place, also by its file");
    assert!(error.is_wrong_use() && error.in_words(&Options).contains("--place"), "{error}");
    let asked = Overrides { place: Some([-33.8568, 151.2153]), at: some("2026-09-18T15:00"), ..none.clone() };
    let LoadedSun { place, track, .. } = sun(&model, &asked).unwrap();
    assert_eq!((place.latitude_deg, place.time_zone.name()), (-33.8568, "Australia/Sydney"));
    assert_eq!(track.instants.len(), 1);
    assert_eq!(Site::load_with(&model, &asked, tower).unwrap().casts, [true, true]);
    let bare = Overrides { place: Some([95.0, 0.0]), ..asked.clone() };
    let error = sun(&model, &bare).expect_err("beyond the pole");
    assert!(error.is_wrong_use() && error.in_words(&Options).contains("--place"), "{error}");
    for (path, word) in
        [("nothing.toml", "cannot be read"), ("tower.skp", "cannot be read"), ("nothing.glb", "no such file")]
    {
        let error = sun(&folder.path().join(path), &none).expect_err("nothing there").to_string();
        assert!(error.contains(word), "{error}");
    }
}

/// The sun alone needs no models, even where the file names some that are missing.
#[test]
fn the_sun_needs_no_models() {
    let site = SITE.replace("tower.glb", "missing.glb");
    assert!(load_sun(folder(&site).path(), &Overrides::default()).is_ok());
    let dates = SITE.replace("\"10:00\"", "10:00:00").replace("2026-09-18", "\"2026-09-18\"");
    assert!(load_sun(folder(&dates).path(), &Overrides::default()).is_ok());
    let dated = SITE.replace("\"10:00\"", "2026-09-18T10:00:00+02:00");
    assert!(load_sun(folder(&dated).path(), &Overrides::default()).is_ok());
    let windows = format!("\u{feff}{}", SITE.replace('\n', "\r\n"));
    assert!(load_sun(folder(&windows).path(), &Overrides::default()).is_ok());
}

#[test]
fn every_key_of_the_design_is_known() {
    let text = r#"
        [place]
        name = "a"
        latitude = 1
        longitude = 2
        elevation = 3
        time_zone = "UTC"
        [[model]]
        path = "a.glb"
        north = 4
        position = [1, 2.5, 3]
        scale = 5
        casts = true
        receives = ["b"]
        [ground]
        level = 6
        [study]
        date = "2026-09-18"
        from = "10:00"
        to = "14:00"
        step = "30min"
        technique = "auto"
        [plan]
        region = [-300, -300, 300, 300]
        cell = 0.5
        [camera]
        eye = [250, -300, 180]
        target = [0, 0, 60]
        up = [0, 0, 1]
        fov = 40.0
    "#;
    let file = SiteFile::parse("site.toml", text).unwrap();
    assert_eq!(file.model[0].position, Some([1.0, 2.5, 3.0]));
    assert_eq!(file.camera.fov, Some(40.0));
}

/// The default camera stands on the sunlit side and sees all corners of the models.
#[test]
fn the_default_camera_sees_the_models() {
    for (latitude, longitude) in [(48.8583, 2.2945), (-33.8568, 151.2153), (1.3, 103.8)] {
        let place = format!("latitude = {latitude}\nlongitude = {longitude}");
        let site = SITE
            .replace("latitude = 48.8583\nlongitude = 2.2945", &place)
            .replace("time_zone = \"Europe/Paris\"\n", "");
        let site = load(&site, &Overrides::default()).unwrap();
        let camera = site.camera;
        let forward = (camera.target - camera.eye).normalize();
        let right = forward.cross(camera.up).normalize();
        let half_height = (camera.fov_rad / 2.0).tan();
        let half_width = half_height * f64::from(camera.width) / f64::from(camera.height);
        for corner in 0..8 {
            let pick = |bit: u32, low: f64, high: f64| if corner >> bit & 1 == 1 { high } else { low };
            let corner = DVec3::new(pick(0, -30.0, 30.0), pick(1, -30.0, 30.0), pick(2, 0.0, 40.0));
            let seen = corner - camera.eye;
            let depth = seen.dot(forward);
            assert!(seen.dot(right).abs() <= depth * half_width, "{latitude}: {corner}");
            assert!(seen.dot(right.cross(forward)).abs() <= depth * half_height, "{latitude}: {corner}");
        }
        let sun: DVec3 = site.track.instants.iter().map(|instant| instant.to_sun).sum();
        assert!(sun.truncate().dot((camera.eye - camera.target).truncate()) > 0.0, "{latitude}");
    }
}

/// Unchanged parts stay as a person wrote them; changed ones read as they were set.
#[test]
fn rewritten_file_keeps_its_comments() {
    let text = "# the client's site\n\n[place] # surveyed\nlatitude=48.2 # of the gate\nlongitude = 16.37\nelevation = 35\n\n\
                # the works\n[[model]]\npath = 'works.glb'\ncasts = true # all\n\n[study]\ndate = 2026-03-21 # equinox\n\
                from = \"9:00\"\nto = \"17:00\"\n# every two hours\nstep = \"2h\"\n# the end\n";
    let before = SiteFile::parse("site.toml", text).unwrap();
    assert_eq!(before.to_toml_in(text).unwrap(), text, "nothing was changed");
    let mut after = before.clone();
    after.study.step = Some("4h".to_owned());
    after.study.to = None;
    after.place.as_mut().unwrap().latitude = Some(-33.9);
    after.camera.eye = Some([1.0, -2.0, 3.5]);
    after.model[0].north = Some(12.0);
    after.model.push(after.model[0].clone());
    after.probe.push(gnomon::site::file::ProbeTable { point: Some([1.0, 2.0, 0.0]), ..Default::default() });
    let written = after.to_toml_in(text).unwrap();
    assert_eq!(SiteFile::parse("site.toml", &written).unwrap(), after, "{written}");
    for line in text.lines() {
        let is_changed = ["latitude", "to =", "step"].iter().any(|key| line.starts_with(key));
        assert!(is_changed || written.lines().any(|kept| kept == line), "lost: {line}\n{written}");
    }
    assert!(written.contains("latitude=-33.9 # of the gate\n"), "{written}");
    assert!(written.contains("# every two hours\nstep = \"4h\"\n"), "{written}");
    // there and back; and a list in one line becomes tables
    let back = before.to_toml_in(&written).unwrap();
    assert_eq!(SiteFile::parse("site.toml", &back).unwrap(), before, "{back}");
    let inline = "place = { latitude = 1.0, longitude = 2.0 }\nmodel = [{ path = \"a.glb\" }] # one\n";
    let written = after.to_toml_in(inline).unwrap();
    assert_eq!(SiteFile::parse("site.toml", &written).unwrap(), after, "{written}");
    let written = after.to_toml_in("").unwrap();
    assert_eq!(SiteFile::parse("site.toml", &written).unwrap(), after, "{written}");
}

/// A reader's notes on a model are available from the site, with the model's name, and are sent to a study's listener.
#[test]
fn notes_of_models_are_told() {
    let noted = |path: &Path, options: &ReadOptions| {
        let notes = vec!["leaves something out".to_owned().into()];
        Ok(Model { notes, ..tower(path, options)? })
    };
    let asked = Overrides { size: Some(16), engine: Some(Engine::Cpu), ..Overrides::default() };
    let site = Site::load_with(folder(SITE).path(), &asked, noted).unwrap();
    assert_eq!(said(&site.notes), ["tower.glb leaves something out"]);
    let mut heard = Vec::new();
    let run = gnomon::study::run(&site, &gnomon::study::Wants::default(), &mut |event| {
        if let gnomon::study::Event::Note(note) = event {
            heard.push(note);
        }
        std::ops::ControlFlow::Continue(())
    });
    run.unwrap();
    assert_eq!(heard, site.notes);
    let before = folder(SITE);
    let [before, after] = [before.path(), before.path()].map(|path| WrittenSite::read(path, &asked).unwrap());
    let pair = gnomon::site::Pair::of(&before, &after, &asked, noted).unwrap();
    assert_eq!(pair.notes(), site.notes, "told once of both");
    assert!(load(SITE, &asked).unwrap().notes.is_empty());
}

/// Models that were read are reused as long as the same files are placed in the same way, whatever else the request
/// changes.
#[test]
fn models_are_read_once_as_long_as_they_stay() {
    let folder = folder(SITE);
    let written = WrittenSite::read(folder.path(), &Overrides::default()).unwrap();
    let models = Models::read(&written, tower).unwrap();
    assert_eq!(models.component_counts(), [2]);
    let mut other = WrittenSite::read(folder.path(), &Overrides::default()).unwrap();
    other.site.model[0].casts = gnomon::site::file::Names::Some(vec!["yard".to_owned()]);
    other.site.study.step = Some("1h".to_owned());
    assert!(models.are_those_of(&other));
    let again = Site::with_models(&other, &Overrides::default(), || Ok(models.clone())).unwrap();
    let fresh = Site::of(&other, &Overrides::default(), tower).unwrap();
    assert_eq!((&again.casts, &again.receives, again.grid), (&fresh.casts, &fresh.receives, fresh.grid));
    assert_eq!((&again.casts[..], again.camera), (&[false, true][..], fresh.camera));
    let wrong = gnomon::site::file::Names::Some(vec!["yerd".to_owned()]);
    other.site.model[0].casts = wrong;
    let told = Site::with_models(&other, &Overrides::default(), || Ok(models.clone())).unwrap_err().to_string();
    assert!(told.contains("yerd") && told.contains("yard"), "{told}");

    other.site.model[0].position = Some([1.0, 0.0, 0.0]);
    assert!(!models.are_those_of(&other), "it stands elsewhere");
    assert_eq!(models.changed_file(), None);
    let file = folder.path().join("tower.glb");
    std::fs::write(&file, "another").unwrap();
    assert_eq!(models.changed_file(), Some(file.as_path()), "the file is another");
    // what was read is still what it was
    assert!(models.are_those_of(&written));
    let again = Models::read(&written, tower).unwrap();
    assert_eq!((again.changed_file(), again.mark()), (None, models.mark()));
    std::fs::remove_file(&file).unwrap();
    assert_eq!(again.changed_file(), Some(file.as_path()), "the file is gone");
    let moved = |path: &Path, options: &ReadOptions| {
        let mut model = tower(path, options)?;
        model.parts[0].positions[0].x += 0.001;
        Ok(model)
    };
    std::fs::write(&file, "another").unwrap();
    assert_ne!(Models::read(&written, moved).unwrap().mark(), models.mark(), "a corner is elsewhere");
}
