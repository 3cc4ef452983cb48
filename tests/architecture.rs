//! Checks the rules of `docs/architecture.md` that a machine can check: which module may use which, which may print or
//! read files, how types are named, and how long files and functions may be.

mod rules;
mod rust_text;

use rules::{
    DRAWS_ITSELF, FACES, KNOWN_TO_ALL, LONG_FUNCTIONS_IN, MAY_KNOW, MOST_LINES, MOST_LINES_OF_A_FUNCTION, RESERVED,
    SPEAK_OF_COMMANDS, WORDS_OF_A_FACE, WRITES_OPTIONS,
};
use rust_text::TextRanges;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// What is wrong with one source file; `path` is below `src`.
fn faults(path: &Path, source: &str) -> Vec<String> {
    let code = without_comments(source);
    let modules = module_of(path);
    let module = modules[0].as_str();
    let at = |offset: usize| format!("src/{}:{}", path.display(), code[..offset].lines().count().max(1));
    let mut faults = Vec::new();
    for (offset, known) in arrows(&code, modules.len()) {
        let may = match module {
            "lib" => &[][..],
            "main" => &["cli", "desktop"],
            _ => MAY_KNOW.iter().find(|(name, _)| *name == module).map_or(&[][..], |(_, may)| may),
        };
        if known != module && known != KNOWN_TO_ALL && !may.contains(&known) {
            faults.push(format!("{}: {module} may not know {known}", at(offset)));
        }
    }
    for (word, allowed, why) in RESERVED {
        for (offset, _) in code.match_indices(word).filter(|(offset, _)| begins_word(&code, *offset)) {
            if !allowed.contains(&module) {
                faults.push(format!("{}: {word} in {module}: {why}", at(offset)));
            }
        }
    }
    if FACES.contains(&module) && path != Path::new(DRAWS_ITSELF) {
        let found = code.match_indices("Method::").filter(|(offset, word)| is_technique(&code[offset + word.len()..]));
        faults.extend(found.map(|(offset, _)| format!("{}: a technique in {module}: ask its row", at(offset))));
    }
    if !WRITES_OPTIONS.contains(&module) {
        let options = code.match_indices("--").filter(|(offset, _)| is_option(&code[*offset..]));
        faults.extend(options.map(|(offset, _)| format!("{}: an option in {module}: name a field", at(offset))));
        if !SPEAK_OF_COMMANDS.iter().any(|file| path == Path::new(file)) {
            let words = words_of_a_face(source).into_iter();
            faults.extend(words.map(|(offset, word)| format!("{}: \"{word}\" in {module}: name a field", at(offset))));
        }
        faults.extend(options_in_comments(source).map(|offset| format!("{}: an option in a comment", at(offset))));
    }
    faults
}

/// Whether a text that begins with two dashes begins with an option, or with one whose name is put in.
fn is_option(text: &str) -> bool {
    let is_name = |next: char| next.is_ascii_lowercase() || next == '{';
    text.trim_start_matches('-').starts_with(is_name) && !text.starts_with("---")
}

/// Whether a text that follows `Method::` begins with the name of a technique; `auto` stands for any.
fn is_technique(text: &str) -> bool {
    text.starts_with(|next: char| next.is_ascii_uppercase()) && !text.starts_with("Auto") && !text.starts_with("WORDS")
}

/// Where string literals have words of one face.
fn words_of_a_face(source: &str) -> Vec<(usize, &'static str)> {
    let mut found = Vec::new();
    for literal in TextRanges::of(source).literals {
        let text = &source[literal.clone()];
        for word in WORDS_OF_A_FACE {
            found.extend(text.match_indices(word).map(|(at, _)| (literal.start + at, *word)));
        }
    }
    found
}

/// Where comments name options of the command, which are the words of one face only. Options of cargo do not count.
fn options_in_comments(source: &str) -> impl Iterator<Item = usize> {
    let comments = TextRanges::of(source).comments.into_iter();
    comments.flat_map(|comment| {
        let text = &source[comment.clone()];
        let is_said = |at: usize| is_option(&text[at..]) && text[..at].ends_with([' ', '`', '(']);
        let found = text.match_indices("--").map(|(at, _)| at).filter(|at| is_said(*at) && !text.contains("cargo "));
        found.map(|at| comment.start + at).collect::<Vec<_>>()
    })
}

/// The modules around a file's content, the outermost first: `shadow/stencil.rs` is shadow, stencil.
fn module_of(path: &Path) -> Vec<String> {
    let mut modules: Vec<_> = path.with_extension("").iter().map(|part| part.to_string_lossy().into_owned()).collect();
    if modules.len() > 1 && modules.last().is_some_and(|last| last == "mod") {
        modules.pop();
    }
    modules
}

/// The source with every comment blanked, so that a link in the documentation is no arrow. Offsets and lines stay.
pub(crate) fn without_comments(source: &str) -> String {
    let (mut code, mut done) = (String::with_capacity(source.len()), 0);
    for comment in TextRanges::of(source).comments {
        code.push_str(&source[done..comment.start]);
        code.extend(source[comment.clone()].bytes().map(|byte| if byte == b'\n' { '\n' } else { ' ' }));
        done = comment.end;
    }
    code + &source[done..]
}

/// Where the code names a module of the crate's root, and which: `crate::x`, `crate::{x, y::z}`, the library's own name,
/// and a `super` that climbs all `depth` modules.
fn arrows(code: &str, depth: usize) -> Vec<(usize, &str)> {
    let climb = "super::".repeat(depth);
    let mut found = Vec::new();
    for root in ["crate::", "gnomon::", climb.as_str()] {
        for (offset, _) in code.match_indices(root).filter(|(offset, _)| begins_word(code, *offset)) {
            let first = offset + root.len();
            found.extend(names_in(&code[first..]).into_iter().map(|(at, name)| (first + at, name)));
        }
    }
    found.retain(|(_, name)| MAY_KNOW.iter().any(|(module, _)| module == name));
    found
}

fn begins_word(code: &str, offset: usize) -> bool {
    !code[..offset].ends_with(|before: char| before.is_alphanumeric() || before == '_')
}

/// The first name of a path, or of each path of a group in braces.
fn names_in(path: &str) -> Vec<(usize, &str)> {
    let end_of_name = |text: &str| text.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(text.len());
    if !path.starts_with('{') {
        return vec![(0, &path[..end_of_name(path)])];
    }
    let mut names = Vec::new();
    let mut open = 0;
    for (at, c) in path.char_indices() {
        match c {
            '{' => open += 1,
            '}' => open -= 1,
            _ => (),
        }
        if open == 0 {
            break;
        }
        if open == 1 && matches!(c, '{' | ',') {
            let first = at + 1 + path[at + 1..].len() - path[at + 1..].trim_start().len();
            names.push((first, &path[first..first + end_of_name(&path[first..])]));
        }
    }
    names
}

/// Files below a folder of the repository whose names end so, with their text.
pub(crate) fn files(folder: &str, extension: &str) -> Vec<(PathBuf, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let mut folders = vec![root.clone()];
    let mut found = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).expect("a folder of the repository") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|is| is == extension) {
                let text = std::fs::read_to_string(&path).expect("text");
                found.push((path.strip_prefix(&root).expect("below").to_owned(), text));
            }
        }
    }
    found
}

#[test]
fn arrows_point_one_way_and_only_faces_print() {
    let sources = files("src", "rs");
    assert!(sources.len() > MAY_KNOW.len(), "too few sources were found");
    let faults: Vec<_> = sources.iter().flat_map(|(path, source)| faults(path, source)).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// What an error says of fields is lost where it is wrapped in one that does not pass it on, or that the faces do not ask.
fn unworded(sources: &[(PathBuf, String)]) -> Vec<String> {
    let named = |text: &str, before: &str, after: char| {
        let names = text.split(before).skip(1).filter_map(|rest| Some(rest.split_once(after)?.0.trim().to_owned()));
        names.collect::<Vec<String>>()
    };
    let code = sources.iter().map(|(path, source)| (path, without_comments(source))).collect::<Vec<_>>();
    let worded = code.iter().flat_map(|(_, code)| named(code, "plain_display!(", ')')).collect::<Vec<_>>();
    let asked = code.iter().flat_map(|(_, code)| named(code, "worded::<", '>')).collect::<Vec<_>>();
    let mut faults: Vec<_> = worded
        .iter()
        // the macro's own
        .filter(|name| !name.starts_with('$') && !asked.contains(name))
        .map(|name| format!("{name} speaks of fields, and src/fault.rs does not ask it"))
        .collect();
    for (path, code) in &code {
        for (name, body) in code.split("pub enum ").skip(1).filter_map(|rest| rest.split_once(" {")) {
            let body = body.split("\n}").next().unwrap_or_default();
            let words = || body.split(|c: char| !c.is_alphanumeric() && c != '_');
            let wrapped = worded.iter().find(|worded| words().any(|word| word == *worded));
            if let (true, false, Some(wrapped)) = (name.ends_with("Error"), worded.iter().any(|it| it == name), wrapped)
            {
                faults.push(format!("src/{}: {name} holds {wrapped} and is not Worded", path.display()));
            }
        }
    }
    faults
}

#[test]
fn errors_that_speak_of_fields_reach_the_faces() {
    let faults = unworded(&files("src", "rs"));
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    let file = |text: &str| (PathBuf::from("study/mod.rs"), text.to_owned());
    let known = || file("plain_display!(StudyError);\nconst KNOWN = [worded::<StudyError>];");
    assert_eq!(unworded(&[file("plain_display!(StudyError);")]).len(), 1);
    assert_eq!(unworded(&[known(), file("pub enum OtherError {\n    Study(#[from] StudyError),\n}\n")]).len(), 1);
    assert_eq!(unworded(&[known(), file("pub enum OtherError {\n    Night,\n}\n")]), Vec::<String>::new());
}

#[test]
fn table_is_the_reading_order_of_lib() {
    let lib = files("src", "rs").into_iter().find(|(path, _)| path == Path::new("lib.rs")).expect("lib.rs").1;
    let declared: Vec<_> =
        lib.lines().filter_map(|line| line.trim().strip_prefix("pub mod ")?.strip_suffix(';')).collect();
    let listed: Vec<_> = MAY_KNOW.iter().map(|(module, _)| *module).collect();
    assert_eq!(declared, listed, "each module of lib.rs has its line in the table, in the same order");
    for (at, (module, may)) in MAY_KNOW.iter().enumerate() {
        for known in *may {
            assert!(listed[..at].contains(known), "{module} → {known} does not point upwards");
        }
    }
}

/// What the page's table says: each module, and whom it may know.
fn rows_of_page(page: &str) -> Vec<(String, Vec<String>)> {
    let rows = page.lines().filter_map(|line| {
        let cells: Vec<_> = line.strip_prefix("| `")?.strip_suffix(" |")?.split(" | ").collect();
        let [module, _, known] = cells[..] else { return None };
        let known = known.split(';').next().unwrap_or_default();
        let known = known.split(", ").filter(|known| *known != "nobody").map(str::to_owned);
        Some((module.trim_end_matches('`').to_owned(), known.collect()))
    });
    rows.collect()
}

#[test]
fn the_pages_table_says_what_is_checked() {
    let page =
        files("docs", "md").into_iter().find(|(path, _)| path == Path::new("architecture.md")).expect("the page").1;
    let sorted = |known: Vec<String>| known.into_iter().collect::<std::collections::BTreeSet<_>>();
    let page: Vec<_> = rows_of_page(&page).into_iter().map(|(module, known)| (module, sorted(known))).collect();
    let checked = MAY_KNOW
        .iter()
        .map(|(module, known)| (module.to_string(), sorted(known.iter().map(|known| known.to_string()).collect())));
    let checked: Vec<_> = checked.collect();
    for row in &checked {
        assert!(page.contains(row), "docs/architecture.md, {}: not {:?}", row.0, row.1);
    }
    assert_eq!(page.len(), checked.len(), "docs/architecture.md has other modules");
    let table = "| module | what it is | whom it knows |\n|---|---|---|\n| `sun` | where; when | nobody; all know it |\n\
                 | `site` | what | sun, mesh |\n";
    let rows = [("sun".to_owned(), vec![]), ("site".to_owned(), vec!["sun".to_owned(), "mesh".to_owned()])];
    assert_eq!(rows_of_page(table), rows);
}

#[test]
fn checker_finds_each_kind_of_fault() {
    let bad = [
        ("gpu/device.rs", "use crate::sun::Place;"),
        ("mesh/mod.rs", "fn f() { let x = crate::site::Site::load(); }"),
        ("mesh/weld.rs", "use crate::{\n    mesh::Part,\n    view::{Grid, View},\n};"),
        ("view.rs", "use super::mesh::Mesh;"),
        ("silhouette/brute_force.rs", "use super::super::gpu;"),
        ("main.rs", "use gnomon::study;"),
        ("export/file.rs", "println!(\"done\");"),
        ("site/load.rs", "std::eprintln!(\"odd\");"),
        ("profile/mod.rs", "let text = std::fs::read_to_string(path)?;"),
        ("sun/clock.rs", "let now = chrono::Utc::now();"),
        ("cli.rs", "let now = std::time::SystemTime::now();"),
        ("study/machine.rs", "let what = \"take a longer --step\";"),
        ("desktop/panel.rs", "ui.label(\"--technique: rays alone\");"),
        ("study/machine.rs", "let what = format!(\"--{name}: rays alone\");"),
        ("study/machine.rs", "let what = \"see https://example.org --step\";"),
        ("sun/zone.rs", "let link = \"https://example.org\"; let now = chrono::Utc::now();"),
        ("sun/zone.rs", "let link = r#\"a \" // \"#; let now = chrono::Utc::now();"),
        ("sun/zone.rs", "let quote = ['\"', '\\'', b'\"']; // \"\nlet now = chrono::Utc::now();"),
        ("site/overrides.rs", "/// `--step 30min`\nlet step = \"----- -->\";"),
        ("site/study.rs", "let at = 1; // as --at has it"),
        ("deliver/shelf.rs", "let note = \"the same command goes on\";"),
        ("export/verify.rs", "let why = \"\\\n    gnomon check says more\";"),
        ("desktop/view.rs", "let casts = drawn.technique == \"ray-cast\";"),
        ("desktop/view.rs", "let casts = drawn.technique == \"stencil\";"),
        ("export/report.rs", "let casts = drawn.technique == \"hybrid\";"),
        ("desktop/view.rs", "let casts = method == Method::RayCast;"),
        ("cli/technique.rs", "let row = Method::Hybrid.row();"),
        ("desktop/work.rs", "use crate::cli::one_line;"),
        ("cli/mod.rs", "use crate::desktop::open;"),
        ("export/report.rs", "use crate::deliver::Sink;"),
    ];
    for (path, source) in bad {
        assert_eq!(faults(Path::new(path), source).len(), 1, "{path}: {source}");
    }
    let good = [
        ("gpu/device.rs", "/// Knows no [`crate::sun`].\nuse crate::gpu::layout; // not crate::sun"),
        ("export/figure/words.rs", "use super::super::report;\nuse crate::{choice::Receivers, sun::Place};"),
        ("cli.rs", "eprintln!(\"{}\", crate::study::run());"),
        ("study.rs", "let started = std::time::Instant::now();"),
        ("cli.rs", "let what = \"take a longer --step\";"),
        ("cli.rs", "/// `--step 30min`"),
        ("site/overrides.rs", "/// The step, --> as asked.\nlet step = \"----- -->\";"),
        ("lib.rs", "//! `cargo run --example site-in-memory`"),
        ("cli/output.rs", "let note = \"the same command goes on\";"),
        ("export/glb.rs", "let generator = \"gnomon \"; // of the command"),
        ("formats/refused.rs", "let way_out = \"with the command MESHSMOOTH\";"),
        ("desktop/view.rs", "let method = Method::Auto; // Method::RayCast"),
        ("desktop/stage/plain.rs", "let technique = Method::RayCast;"),
        ("study/chooser.rs", "let method = Method::RayCast;"),
        ("shadow/stencil.rs", "let pass = Some(\"stencil\");"),
        ("mesh/weld.rs", "fn of<'a>(text: &'a str) {} /* crate::site */ // crate::sun"),
    ];
    for (path, source) in good {
        assert_eq!(faults(Path::new(path), source), Vec::<String>::new(), "{path}");
    }
    let two_lines_down = faults(Path::new("gpu/mod.rs"), "//! Text.\n\nuse crate::sun::Place;");
    assert_eq!(two_lines_down, ["src/gpu/mod.rs:3: gpu may not know sun"]);
}

/// Which files put together what drawings and reports are told, but for those that take it, and those that change one.
fn put_together(sources: &[(PathBuf, String)]) -> Vec<String> {
    let mut files = Vec::new();
    for (path, source) in sources.iter().filter(|(path, _)| module_of(path)[0] != "export") {
        let code = without_comments(source);
        let found =
            ["figure::FigureContext {", "ReportContext {"].into_iter().flat_map(|word| code.match_indices(word));
        let fields = found.map(|(at, _)| code[at..].split('}').next().unwrap_or_default());
        let whole =
            fields.filter(|fields| !fields.contains("..figure_context(") && !fields.contains("..report_context("));
        files.extend(whole.map(|_| path.display().to_string()));
    }
    files
}

#[test]
fn drawings_and_reports_are_put_together_in_one_place() {
    assert_eq!(put_together(&files("src", "rs")), ["deliver/parts.rs"; 2], "what a drawing is told, and a report");
    let twin = (PathBuf::from("desktop/hours.rs"), "let scene = figure::FigureContext { place, track };".to_owned());
    assert_eq!(put_together(&[twin]), ["desktop/hours.rs"]);
}

/// Names that two types have, whoever may see them, and the files that declare them: such a name cannot be searched for.
fn named_twice(sources: &[(PathBuf, String)]) -> Vec<String> {
    let mut declared: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for (path, source) in sources {
        let code = without_comments(source);
        for name in code.lines().filter_map(declared_type) {
            declared.entry(name.to_owned()).or_default().push(path.display().to_string());
        }
    }
    let twice = declared.into_iter().filter(|(_, files)| files.len() > 1);
    twice.map(|(name, files)| format!("{name}: {}", files.join(", "))).collect()
}

/// The type that a line declares. A type within a trait or its `impl`, such as `type Err`, has the trait's name for it.
fn declared_type(line: &str) -> Option<&str> {
    let code = line.trim_start();
    let code = match code.strip_prefix("pub") {
        Some(rest) if rest.starts_with('(') => rest.split_once(')')?.1.trim_start(),
        Some(rest) => rest.trim_start(),
        None => code,
    };
    let (keyword, rest) = code.split_once(' ')?;
    let is_type =
        matches!(keyword, "struct" | "enum" | "trait" | "union") || keyword == "type" && !line.starts_with(' ');
    let name = &rest[..rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len())];
    (is_type && name.starts_with(char::is_uppercase)).then_some(name)
}

#[test]
fn no_two_types_have_one_name() {
    let sources = files("src", "rs");
    let types = sources.iter().flat_map(|(_, source)| source.lines().filter_map(declared_type)).count();
    assert!(types > sources.len(), "too few types were found");
    let twice = named_twice(&sources);
    assert!(twice.is_empty(), "one name for two types; name each for what it is:\n{}", twice.join("\n"));
    let file = |path: &str, text: &str| (PathBuf::from(path), text.to_owned());
    let mesh = || file("mesh/mod.rs", "pub struct Part<'a> {");
    for twin in [
        "pub enum Part {",
        "    pub(super) struct Part;",
        "pub(in crate::shadow) trait Part: Sync {",
        "type Part = u32;",
    ] {
        assert_eq!(named_twice(&[mesh(), file("view.rs", twin)]), ["Part: mesh/mod.rs, view.rs"], "{twin}");
    }
    for other in
        ["// pub struct Part {", "pub use mesh::Part;", "impl Part {", "    type Part = u32;", "pub struct Parts {"]
    {
        assert_eq!(named_twice(&[mesh(), file("view.rs", other)]), Vec::<String>::new(), "{other}");
    }
}

#[test]
fn files_are_of_one_sitting() {
    let shaders = Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders");
    let mut files_of_both = files("src", "rs");
    if shaders.exists() {
        files_of_both.extend(files("shaders", "wgsl"));
    }
    let long = |(path, text): &(PathBuf, String)| {
        let lines = text.lines().count();
        (lines > MOST_LINES).then(|| format!("{}: {lines} lines", path.display()))
    };
    let long: Vec<_> = files_of_both.iter().filter_map(long).collect();
    assert!(long.is_empty(), "longer than {MOST_LINES} lines; look for a second idea inside:\n{}", long.join("\n"));
}

/// The functions of a source, and how many lines each has, from `fn` to the last brace.
fn functions(source: &str) -> Vec<(&str, usize)> {
    let lines: Vec<&str> = source.lines().collect();
    let is_modifier = |word: &&str| word.starts_with("pub") || word.ends_with(')') || ["const", "async"].contains(word);
    let mut found = Vec::new();
    for (at, line) in lines.iter().enumerate() {
        let code = line.trim_start();
        let mut words = code.split(' ').skip_while(is_modifier);
        let (Some("fn"), Some(name)) = (words.next(), words.next()) else { continue };
        let end = format!("{}}}", &line[..line.len() - code.len()]);
        // of one line, or a trait's without a body
        let is_whole = line.ends_with([';', '}']);
        let more = if is_whole { 0 } else { lines[at..].iter().position(|line| *line == end).unwrap_or(0) };
        found.push((name.split(['(', '<']).next().unwrap_or(name), 1 + more));
    }
    found
}

#[test]
fn functions_are_of_one_glance() {
    let sources = files("src", "rs");
    let all = sources.iter().flat_map(|(path, source)| functions(source).into_iter().map(move |found| (path, found)));
    let all: Vec<_> = all.collect();
    assert!(all.len() > 2 * sources.len(), "too few functions were found");
    let held = all.iter().filter(|(path, _)| !LONG_FUNCTIONS_IN.iter().any(|room| path.starts_with(room)));
    let long = held.filter(|(_, (_, lines))| *lines > MOST_LINES_OF_A_FUNCTION);
    let long: Vec<_> =
        long.map(|(path, (name, lines))| format!("src/{}: {name}: {lines} lines", path.display())).collect();
    assert!(
        long.is_empty(),
        "more than {MOST_LINES_OF_A_FUNCTION} lines; open them up into named steps:\n{}",
        long.join("\n")
    );
    for first in ["    fn f() {", "    pub(in crate::shadow) const fn f<T>(", "    pub async fn f() {"] {
        let long = format!("{first}\n{}    }}\nfn g() {{}}\n", "        go();\n".repeat(59));
        assert_eq!(functions(&long), [("f", 61), ("g", 1)], "{first}");
    }
}
