//! How errors and notes name the fields of a request in each interface.

use crate::shared::program::done;
use crate::site::{SITE, folder, load, some};
use gnomon::choice::Receivers;
use gnomon::cli::Options;
use gnomon::fault;
use gnomon::gpu::GpuError;
use gnomon::message::{Field, Message, MessagePart, PlainWords, Worded, Words};
use gnomon::shadow::ShadowError;
use gnomon::site::{Ground, GroundFrom, Overrides, Site, load_mesh};
use gnomon::study::StudyError;
use std::path::Path;

/// A face that has steps, and nothing else.
#[derive(Debug)]
struct Steps;

impl Words for Steps {
    fn name(&self, field: Field) -> Option<&'static str> {
        (field == Field::Step).then_some("Step")
    }

    fn key(&self, _field: Field) -> &'static str {
        "a label"
    }
}

#[test]
fn pieces_are_said_in_the_words_of_a_face() {
    let message = Message {
        what: vec!["it has too many instants".into()],
        hint: vec![
            "take a longer ".into(),
            Field::Step.into(),
            ", as ".into(),
            (Field::Step, "1h").into(),
            MessagePart::Where(Field::Memory, vec![", or more ".into(), Field::Memory.into()]),
            ", and not another ".into(),
            MessagePart::Key(Field::To),
        ],
    };
    let said = |words: &dyn Words| message.in_words(words);
    let what = "it has too many instants; take a longer";
    assert_eq!(said(&Options), format!("{what} --step, as --step 1h, or more --memory, and not another to"));
    assert_eq!(said(&Steps), format!("{what} Step, as Step 1h, and not another a label"));
    assert_eq!(said(&PlainWords), format!("{what} step, as step 1h, and not another to"));
    assert_eq!(message.to_string(), said(&PlainWords));
    // a way out that nobody can take is none
    let alone = Message { hint: vec![MessagePart::Where(Field::Memory, vec!["take more".into()])], ..message };
    assert_eq!(alone.in_words(&Steps), "it has too many instants");
}

/// Every field is an option, and every option is one that the command takes somewhere.
#[test]
fn fields_are_options_of_the_command() {
    let folder = tempfile::tempdir().unwrap();
    let commands = [
        "profile", "compare", "shadow", "animate", "sun", "check", "volumes", "verify", "probe", "convert", "envelope",
    ];
    let help: String = commands.map(|command| done(folder.path(), &format!("{command} --help"))).concat();
    let taken: Vec<&str> = help.split(|c: char| !c.is_ascii_alphanumeric() && c != '-').collect();
    for field in Field::ALL {
        let option = Options.name(*field).expect("an option");
        let (option, value) = option.split_once(' ').unwrap_or((option, ""));
        assert!(taken.contains(&option) && (value.is_empty() || taken.contains(&value)), "{field:?}: {option} {value}");
    }
}

/// A file beside a site file is an error about these two, and a mistake in the command line.
#[test]
fn files_that_cannot_stand_together_are_named() {
    let folder = folder(SITE);
    let asked = Overrides { beside: vec![folder.path().join("house.glb")], ..Overrides::default() };
    let error = Site::load(folder.path(), &asked).expect_err("a mistake");
    let said = error.in_words(&Options);
    assert!(error.is_wrong_use() && said.contains("house.glb is named beside the site file "), "{said}");
    assert!(said.ends_with("; add it as a [[model]] in the site file"), "{said}");
}

/// The causes of an error use the same words, and each is printed once.
#[test]
fn errors_within_errors_are_worded() {
    let lost = || GpuError::Lost { adapter: "some card".to_owned(), reason: "memory\nis full".to_owned() };
    let error = StudyError::Shadow(ShadowError::Gpu(lost()));
    let what = "the graphics adapter 'some card' failed: memory is full; try larger cells";
    assert_eq!(fault::line(&error, &Options), format!("{what} (--cell) or --engine cpu"));
    assert_eq!(fault::line(&error, &Steps), what);
    let context = anyhow::Error::from(error).context("the picture cannot be drawn");
    let said = fault::line(context.as_ref(), &Options);
    assert_eq!(said, format!("the picture cannot be drawn: {what} (--cell) or --engine cpu"));
}

/// Messages name values of a site file by its keys in every face, and other settings by the face's own words.
#[test]
fn site_files_have_keys_and_faces_have_words() {
    let days = SITE.replace("date = 2026-09-18", "dates = [2026-09-18, 2026-09-19]");
    let days = |from: &str| days.replace("from = \"10:00\"", &format!("from = \"{from}\""));
    let said = |site: &str, asked: &Overrides| load(site, asked).expect_err("a mistake").in_words(&Options);
    let told = said(&days("2026-09-18T10:00"), &Overrides::default());
    assert!(
        told.contains("[study] from: ") && told.ends_with("; leave the date out, and give days with date"),
        "{told}"
    );
    let from = Overrides { from: some("2026-09-18T10:00"), date: some("2026-09-18"), ..Overrides::default() };
    let from = Overrides { from_date: from.date, to_date: from.date, date: None, ..from };
    let told = said(&days("10:00"), &from);
    assert!(
        told.starts_with("--from: ") && told.ends_with("; leave the date out, and give days with --date"),
        "{told}"
    );
}

/// Notes are also written to files, in the words of the face that made the request.
#[test]
fn notes_are_in_the_words_of_who_asks() {
    let folder = crate::command::units::folder(&crate::command::units::lying(), "");
    let note = |words: &'static dyn Words| {
        let asked = Overrides { words, ..Overrides::default() };
        let notes = gnomon::site::load_mesh(Path::new(folder.path()), &asked).expect("models").notes;
        notes.iter().map(|note| note.in_words(words)).collect::<String>()
    };
    assert!(note(&Options).ends_with("write `up = \"z\"` under [[model]], or say --up z"), "{}", note(&Options));
    assert!(note(&PlainWords).ends_with("write `up = \"z\"` under [[model]]"), "{}", note(&PlainWords));
}

/// A note names a key of the site file, and a face that has another word for it says that.
#[test]
fn keys_in_notes_are_in_the_words_of_a_face() {
    #[derive(Debug)]
    struct Labels;
    impl Words for Labels {
        fn setting(&self, table: &str, key: &str, value: Option<&str>, _: &str) -> String {
            format!("<{table} {key} {}>", value.unwrap_or("-"))
        }
    }
    let site = crate::shared::program::site();
    let mut buried = Ground::asked(0.0);
    (buried.from, buried.lowest) = (GroundFrom::Zero, -12.0);
    let mesh = Site::load(site.path(), &Overrides::default()).expect("a site").mesh;
    let [note] = &buried.notes(&mesh, &vec![true; mesh.components.len()], Receivers::Ground)[..] else {
        panic!("one note")
    };
    let what = "the ground is at 0.00 m, where the models' own zero is; 12.00 m of the models lie below it";
    assert_eq!(note.in_words(&Options), format!("{what}; `level` in [ground] sets it"));
    assert_eq!(note.to_string(), note.in_words(&Options));
    assert_eq!(note.in_words(&Labels), format!("{what}; <[ground] level -> sets it"));
    let folder = crate::command::units::folder(&crate::command::units::lying(), "");
    let notes = load_mesh(folder.path(), &Overrides::default()).expect("models").notes;
    assert!(notes.iter().any(|note| note.in_words(&Labels).ends_with("write <[[model]] up z>")), "{notes:?}");
}
