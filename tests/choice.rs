//! The table of techniques must agree with the documents and with the program.

use crate::site::{SITE, load};
use gnomon::choice::{Engine, Filter, Finder, Method, Misfit, Promise, Setting, Settings, Subject, TABLE};
use gnomon::cli::Options;
use gnomon::message::{Worded, Words};
use gnomon::site::{Overrides, Site};
use gnomon::study::{self, InstantWants, StudyError};
use gnomon::view::{Camera, View};
use std::ops::ControlFlow;
use std::path::Path;

/// What a document's table says of a technique.
fn line(method: Method) -> String {
    let row = method.row();
    let options: Vec<_> = Setting::ALL.into_iter().filter(|setting| row.uses(*setting)).collect();
    let options: Vec<_> =
        options.into_iter().map(|setting| format!("`{}`", Options.name(setting.field()).unwrap())).collect();
    format!("| `{}` | {} | {} | {} |", row.word, row.good_for, row.wrong, options.join(", "))
}

/// The documents that may hold the table.
const DOCUMENTS: [&str; 3] = ["README.md", "docs/command.md", "docs/techniques.md"];

#[test]
fn the_documents_table_is_the_programs() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let texts = DOCUMENTS.map(|name| std::fs::read_to_string(root.join(name)).unwrap_or_default());
    let is_head = |line: &str| line.starts_with("| technique | what it is good for |");
    let tables: Vec<_> = texts.iter().filter(|text| text.lines().any(is_head)).collect();
    let [text] = tables[..] else { panic!("{} of {DOCUMENTS:?} have the table of techniques", tables.len()) };
    let lines = text.lines().skip_while(|line| !is_head(line)).skip(2).take_while(|line| line.starts_with('|'));
    let expected = TABLE.iter().filter(|row| row.method != Method::Auto).map(|row| line(row.method));
    let (found, expected): (Vec<&str>, Vec<String>) = (lines.collect(), expected.collect());
    assert_eq!(found, expected, "write:\n{}", expected.join("\n"));
}

#[test]
fn the_table_agrees_with_itself() {
    assert_eq!(TABLE[0].method, Method::default());
    for row in TABLE {
        assert!(std::ptr::eq(row.method.row(), row), "{}", row.word);
        assert_eq!(row.word.parse::<Method>(), Ok(row.method));
        assert!(row.draws(Engine::Auto, Subject::Top) || row.draws(Engine::Auto, Subject::Patches), "{}", row.word);
        let can_show_mask = row.counts && row.uses(Setting::MapSize);
        assert!(can_show_mask || !row.shows_mask, "{}: a mask parts what a map decides from what is counted", row.word);
        assert!(!row.finders.contains(&Finder::Auto), "{}: auto is always there", row.word);
        // what it does not use it has no default for
        assert_eq!(row.set(&Settings::NONE), row.defaults, "{}", row.word);
        let all = Settings {
            map_size: Some(512),
            filter: Some(Filter::None),
            smoothie_width_m: Some(1.0),
            sun_samples: Some(3),
        };
        let set = row.set(&all);
        assert!(row.check(Finder::Auto, &set, Engine::Auto, Subject::Top).is_ok(), "{}", row.word);
        assert_eq!(row.settings.is_empty(), set == Settings::NONE, "{}", row.word);
    }
    for row in TABLE {
        assert_eq!(row.on_patches.is_some(), row.draws(Engine::Auto, Subject::Patches), "{}", row.word);
    }
    // what draws in both ways is told apart in verify by the machine alone, and ray casting is the truth
    let truths: Vec<_> = TABLE.iter().filter(|row| row.promise == Promise::Same).map(|row| row.method).collect();
    assert_eq!(truths, [Method::RayCast]);
}

/// What is drawn for a row's subject, in few cells.
fn view(site: &Site, subject: Subject) -> View {
    let camera = Camera { width: 24, height: 16, ..site.camera };
    match subject {
        Subject::Camera => View::Camera(camera),
        Subject::Side => View::Elevation(camera.side(gnomon::view::Side::South)),
        Subject::Top | Subject::Ground | Subject::Terrain | Subject::Patches => View::Plan(site.grid),
    }
}

/// Every technique draws what its row says, where it says, and nothing else.
#[test]
fn techniques_draw_what_the_table_says() {
    let mut drawn = 0;
    for row in TABLE.iter().filter(|row| row.method != Method::Auto) {
        for subject in Subject::ALL {
            for engine in [Engine::Cpu, Engine::Gpu] {
                let is_ground = matches!(subject, Subject::Ground | Subject::Terrain);
                let receivers = if is_ground { "ground" } else { "top" };
                let asked = Overrides {
                    technique: Some(row.method),
                    engine: Some(engine),
                    receivers: receivers.parse().ok(),
                    at: "2026-09-18T15:00".parse().ok(),
                    size: Some(16),
                    ..Overrides::default()
                };
                // the yard around the tower
                let with_terrain = SITE.replace("path = \"tower.glb\"", "path = \"tower.glb\"\nterrain = [\"yard\"]");
                let text = if subject == Subject::Terrain { &with_terrain } else { SITE };
                let site = load(text, &asked).expect("a site");
                let mut on_event = |_: study::Event<'_>| ControlFlow::Continue(());
                let done = match subject {
                    Subject::Patches => study::patches(&site, 4.0, &mut on_event).map(|outcome| outcome.drawn),
                    _ => study::instant(&site, view(&site, subject), &InstantWants::default(), &mut on_event)
                        .map(|outcome| outcome.drawn),
                };
                let case = format!("{} of {} on the {engine}", row.word, subject.name());
                match done {
                    Ok(by) => {
                        assert!(row.draws(engine, subject), "{case} is drawn");
                        assert_eq!((by.technique, by.engine), (row.method, engine), "{case}");
                        assert_eq!(by.finder.is_some(), !row.finders.is_empty(), "{case}");
                        drawn += 1;
                    }
                    Err(StudyError::Misfit(misfit)) => {
                        assert!(!row.draws(engine, subject), "{case}: {misfit}");
                        let is_of_engine = row.draws(Engine::Auto, subject);
                        assert_eq!(matches!(misfit, Misfit::Engine { .. }), is_of_engine, "{case}: {misfit}");
                    }
                    Err(error) => panic!("{case}: {error}"),
                }
            }
        }
    }
    assert!(drawn > 15, "{drawn} cases were drawn");
}

#[test]
fn what_does_not_fit_names_the_choice_and_the_way_out() {
    let told = |misfit: Result<(), Misfit>| misfit.expect_err("a misfit").to_string();
    let fit = |method: Method, engine, subject| told(method.row().fit(engine, subject).map(drop));
    assert_eq!(
        fit(Method::Projected, Engine::Auto, Subject::Side),
        "technique: projected does not draw a side; choose ray-cast"
    );
    assert_eq!(
        fit(Method::RayCast, Engine::Gpu, Subject::Side),
        "engine: ray-cast draws a side only on the cpu; leave it out, as no other technique draws that on the other engine"
    );
    assert_eq!(
        fit(Method::SoftTexture, Engine::Gpu, Subject::Camera),
        "engine: soft-texture draws a camera's picture only on the cpu; \
         leave it out, or choose stencil, shadow-map, hybrid or smoothie with gpu"
    );
    // what would go with it is asked in the same way: a command that draws a plan has no view to choose
    let options =
        |method: Method, engine, subject| method.row().fit(engine, subject).expect_err("a misfit").in_words(&Options);
    let of_plan = options(Method::SoftTexture, Engine::Auto, Subject::Top);
    assert!(of_plan.ends_with("; soft-texture can be used with --receivers surfaces"), "{of_plan}");
    let of_camera = options(Method::Projected, Engine::Auto, Subject::Camera);
    assert!(of_camera.starts_with("--technique: ") && !of_camera.contains("can be used with"), "{of_camera}");
    let check =
        |method: Method, finder, settings| told(method.row().check(finder, &settings, Engine::Auto, Subject::Top));
    let map = Settings { map_size: Some(512), ..Settings::NONE };
    assert_eq!(
        check(Method::Stencil, Finder::Auto, map),
        "map size: only shadow-map, hybrid and smoothie use it; choose one of them, or leave it out"
    );
    assert_eq!(
        check(Method::Smoothie, Finder::Gpu, Settings::NONE),
        "silhouette: smoothie uses only brute and hextree; choose one of them, or leave it out"
    );
    let on_surfaces = Method::SoftTexture.row().check(Finder::Auto, &map, Engine::Auto, Subject::Patches);
    assert_eq!(told(on_surfaces), "map size: nothing that draws façades and roofs uses it; leave it out");
    // no hint leads to what the machine that is asked refuses
    let disc = Settings { sun_samples: Some(4), ..Settings::NONE };
    let on = |method: Method, settings, engine, subject| {
        let misfit = method.row().check(Finder::Auto, &settings, engine, subject).expect_err("a misfit");
        misfit.in_words(&Options)
    };
    assert_eq!(
        on(Method::Stencil, disc, Engine::Gpu, Subject::Top),
        "--sun-samples: only ray-cast uses it; choose that technique without --engine gpu, or leave it out"
    );
    assert_eq!(
        on(Method::Projected, map, Engine::Cpu, Subject::Top),
        "--map-size: only shadow-map, hybrid and smoothie use it; choose one of them without --engine cpu, or leave it out"
    );
    assert_eq!(
        on(Method::Stencil, map, Engine::Gpu, Subject::Top),
        "--map-size: only shadow-map, hybrid and smoothie use it; choose one of them, or leave it out"
    );
    assert_eq!(
        on(Method::Stencil, disc, Engine::Gpu, Subject::Patches),
        "--sun-samples: only soft-texture uses it on the gpu; choose that technique, or leave it out"
    );
}
