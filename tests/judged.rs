//! What a rule judges: the tables `[[area]]`, `[[window]]`, `[[facade]]`, `[plot]` and `[before]`, as they are meant, and what
//! every mistake in them is told.

mod areas;
mod before;
mod files;
mod rooms;
mod settled;
mod windows;

use gnomon::site::{JudgedSite, Overrides, load_judged};
use std::path::Path;
use tempfile::TempDir;

/// A place, models and a year.
pub(crate) const HEAD: &str = "
[place]
latitude = 48.2
longitude = 16.38
elevation = 165.0
time_zone = \"Europe/Vienna\"

[[model]]
path = \"town.obj\"
up = \"z\"

[ground]
level = 0.0

[study]
date = 2026-03-21
";

/// Boxes and quads of a drawing, object by object.
#[derive(Default)]
pub(crate) struct Drawing {
    text: String,
    corners: usize,
}

impl Drawing {
    pub(crate) fn object(mut self, name: &str) -> Self {
        self.text += &format!("o {name}\n");
        self
    }

    /// A closed box, counter-clockwise seen from outside.
    pub(crate) fn block(mut self, low: [f64; 3], high: [f64; 3]) -> Self {
        for corner in 0..8 {
            let at = |axis: usize| if corner >> axis & 1 == 0 { low[axis] } else { high[axis] };
            self.text += &format!("v {} {} {}\n", at(0), at(1), at(2));
        }
        for side in [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]] {
            let numbers = side.map(|corner| (self.corners + corner + 1).to_string());
            self.text += &format!("f {}\n", numbers.join(" "));
        }
        self.corners += 8;
        self
    }

    /// A sheet, counter-clockwise seen from its front.
    pub(crate) fn sheet(mut self, corners: [[f64; 3]; 4]) -> Self {
        for [x, y, z] in corners {
            self.text += &format!("v {x} {y} {z}\n");
        }
        let numbers: Vec<_> = (1..=4).map(|corner| (self.corners + corner).to_string()).collect();
        self.text += &format!("f {}\n", numbers.join(" "));
        self.corners += 4;
        self
    }
}

/// A house of thick walls around one room, with a pane in the south and a sheet of glass in the west; a terrace, a barn and
/// a tower that stand apart.
pub(crate) fn town() -> Drawing {
    Drawing::default()
        .object("house")
        .block([-5.0, -5.0, 0.0], [-1.0, -4.6, 9.0])
        .block([1.0, -5.0, 0.0], [5.0, -4.6, 9.0])
        .block([-1.0, -5.0, 0.0], [1.0, -4.6, 1.0])
        .block([-1.0, -5.0, 2.5], [1.0, -4.6, 9.0])
        .block([-5.0, 4.6, 0.0], [5.0, 5.0, 9.0])
        .block([4.6, -4.6, 0.0], [5.0, 4.6, 9.0])
        .block([-5.0, -4.6, 0.0], [-4.6, -1.0, 9.0])
        .block([-5.0, 1.0, 0.0], [-4.6, 4.6, 9.0])
        .block([-5.0, -1.0, 0.0], [-4.6, 1.0, 1.0])
        .block([-5.0, -1.0, 2.5], [-4.6, 1.0, 9.0])
        .block([-5.0, -5.0, 9.0], [5.0, 5.0, 9.4])
        .object("glass")
        .block([-1.0, -4.85, 1.0], [1.0, -4.83, 2.5])
        // its front looks into the room
        .sheet([[-4.8, 1.0, 1.0], [-4.8, 1.0, 2.5], [-4.8, -1.0, 2.5], [-4.8, -1.0, 1.0]])
        .object("terrace")
        .block([10.0, -5.0, 0.0], [20.0, 5.0, 3.0])
        .object("barn")
        .block([30.0, -5.0, 0.0], [40.0, 5.0, 6.0])
        .object("tower")
        .block([-5.0, -50.0, 0.0], [5.0, -40.0, 30.0])
}

/// A folder with the town, and a site file with these tables.
pub(crate) fn folder(tables: &str) -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("town.obj"), town().text).expect("a model");
    write(&folder, "site.toml", &format!("{HEAD}{tables}"));
    folder
}

pub(crate) fn write(folder: &TempDir, name: &str, text: &str) {
    std::fs::write(folder.path().join(name), text).expect("a file");
}

pub(crate) fn open(folder: &Path) -> JudgedSite {
    load_judged(folder, &Overrides::default()).unwrap_or_else(|error| panic!("{error}"))
}

/// What is judged by these tables.
pub(crate) fn judged(tables: &str) -> JudgedSite {
    open(folder(tables).path())
}

/// The message of what must fail in a folder, in one line that has these words.
pub(crate) fn fails_in(folder: &Path, words: &[&str]) {
    let Err(error) = load_judged(folder, &Overrides::default()) else { panic!("a mistake is taken: {words:?}") };
    let message = error.to_string();
    assert!(!message.contains('\n'), "{message}");
    for word in words {
        assert!(message.contains(word), "{message:?} does not say {word:?}");
    }
}

/// The same of these tables.
pub(crate) fn fails(tables: &str, words: &[&str]) {
    fails_in(folder(tables).path(), words);
}

/// All notes, one a line.
pub(crate) fn notes(site: &JudgedSite) -> String {
    site.notes.iter().map(|note| format!("{note}\n")).collect()
}

#[test]
fn a_site_without_these_tables_has_nothing_to_judge() {
    let site = judged("");
    assert!(site.areas.is_empty() && site.windows.is_empty() && site.facades.is_empty());
    assert!(site.plot.is_none() && site.before.is_none());
    assert_eq!((site.year, site.refraction, site.now.ground.level), (2026, true, 0.0));
    assert!(site.now.casts.iter().all(|casts| *casts));
    assert!(site.file.ends_with("site.toml"), "{}", site.file);
}

#[test]
fn the_year_is_that_of_the_study() {
    let none = folder("");
    let text = HEAD.replace("date = 2026-03-21", "step = \"1h\"");
    write(&none, "site.toml", &text);
    fails_in(none.path(), &["date"]);
    write(&none, "site.toml", &HEAD.replace("date = 2026-03-21", "dates = [\"2025-12-01\", \"2026-02-01\"]"));
    let site = open(none.path());
    assert_eq!(site.year, 2025);
    assert!(notes(&site).contains("the days of 2025 are judged"), "{}", notes(&site));
    let asked = Overrides { date: Some("2030-06-21".parse().unwrap()), no_refraction: true, ..Overrides::default() };
    let site = load_judged(none.path(), &asked).unwrap();
    assert_eq!((site.year, site.refraction), (2030, false));
}

#[test]
fn unknown_keys_name_the_nearest() {
    fails("[[area]]\npoligon = [[0, 0], [1, 0], [1, 1]]", &["[[area]] poligon", "polygon in [[area]]"]);
    fails("[[windows]]\nroom = \"a\"", &["[windows]", "[[window]]"]);
    fails("[[plot]]\nborder = []", &["[plot]"]);
    fails("[before]\ndemolish = [\"barn\"]", &["demolish", "demolished in [before]"]);
    fails(
        "[plot]\nborder = [[0, 0], [1, 0], [1, 1]]\nroads = [{ side = 1, widht = 2 }]",
        &["[plot] roads", "widht", "width"],
    );
    fails("[[area]]\npolygon = [[0, 0, 1], [1, 0, 1]]", &["[[area]] polygon", "polygon = [["]);
    fails("[[area]]\npolygon = [1, 2]", &["[[area]] polygon"]);
}
