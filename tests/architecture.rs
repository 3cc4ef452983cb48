//! The rules of `docs/architecture.md`, as far as a machine can see them: who may know whom, who may print, who may
//! read files, and how long a file may be.

use std::path::{Path, PathBuf};

/// The modules in reading order, and whom each may know. Everybody may know themselves.
const MAY_KNOW: &[(&str, &[&str])] = &[
    ("mesh", &[]),
    ("sun", &[]),
    ("view", &[]),
    ("site", &["mesh", "sun", "view"]),
    ("silhouette", &["mesh"]),
    ("volume", &["mesh", "silhouette"]),
    ("gpu", &[]),
    ("shadow", &["mesh", "sun", "view", "silhouette", "volume", "gpu"]),
    ("profile", &["mesh", "sun", "view", "gpu", "shadow"]),
    ("study", &["mesh", "sun", "view", "site", "silhouette", "volume", "gpu", "shadow", "profile"]),
    ("export", &["mesh", "sun", "view", "site", "volume", "profile"]),
    ("deliver", &["mesh", "sun", "view", "site", "volume", "shadow", "profile", "study", "export"]),
    (
        "cli",
        &[
            "mesh",
            "sun",
            "view",
            "site",
            "silhouette",
            "volume",
            "gpu",
            "shadow",
            "profile",
            "study",
            "export",
            "deliver",
        ],
    ),
    // the faces do not know each other
    (
        "desktop",
        &[
            "mesh",
            "sun",
            "view",
            "site",
            "silhouette",
            "volume",
            "gpu",
            "shadow",
            "profile",
            "study",
            "export",
            "deliver",
        ],
    ),
];

/// Words that only some modules may write, and why. `main` is the binary's own file.
const RESERVED: &[(&str, &[&str], &str)] = &[
    ("print!(", &["cli", "main"], "only faces print"),
    ("println!(", &["cli", "main"], "only faces print"),
    ("eprint!(", &["cli", "main"], "only faces print"),
    ("eprintln!(", &["cli", "main"], "only faces print"),
    ("dbg!(", &[], "only faces print"),
    ("io::stdout", &["cli", "main"], "only faces print"),
    ("io::stderr", &["cli", "main"], "only faces print"),
    ("clap::", &["cli"], "only faces read the command line"),
    ("toml::", &["site"], "only site reads what the user wrote"),
    ("gltf::", &["site", "export"], "only site reads what the user wrote, and only export writes"),
    (
        "fs::read",
        &["site", "export", "deliver", "sun"],
        "only site reads what the user wrote, export and deliver what they wrote themselves, and sun the system's rules of clocks",
    ),
    ("File::open", &["site"], "only site reads what the user wrote"),
    ("SystemTime::now", &[], "nothing reads the clock"),
    ("Utc::now", &[], "nothing reads the clock"),
    ("Local::now", &[], "nothing reads the clock"),
];

/// At this length look for a second idea inside.
const MOST_LINES: usize = 500;

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
        if known != module && !may.contains(&known) {
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
    faults
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
fn without_comments(source: &str) -> String {
    let blank = |line: &str| {
        let code = line.find("//").map_or(line, |start| &line[..start]);
        format!("{code}{}", " ".repeat(line.len() - code.len()))
    };
    source.lines().map(blank).collect::<Vec<_>>().join("\n")
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
fn files(folder: &str, extension: &str) -> Vec<(PathBuf, String)> {
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
        ("desktop/work.rs", "use crate::cli::one_line;"),
        ("cli/mod.rs", "use crate::desktop::open;"),
        ("export/report.rs", "use crate::deliver::Sink;"),
    ];
    for (path, source) in bad {
        assert_eq!(faults(Path::new(path), source).len(), 1, "{path}: {source}");
    }
    let good = [
        ("gpu/device.rs", "/// Knows no [`crate::sun`].\nuse crate::gpu::layout; // not crate::sun"),
        ("export/figure/words.rs", "use super::super::report;\nuse crate::{site::Receivers, sun::Place};"),
        ("cli.rs", "eprintln!(\"{}\", crate::study::run());"),
        ("study.rs", "let started = std::time::Instant::now();"),
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
        let found = ["figure::Scene {", "Told {"].into_iter().flat_map(|word| code.match_indices(word));
        let fields = found.map(|(at, _)| code[at..].split('}').next().unwrap_or_default());
        let whole = fields.filter(|fields| !fields.contains("..scene(") && !fields.contains("..told("));
        files.extend(whole.map(|_| path.display().to_string()));
    }
    files
}

#[test]
fn drawings_and_reports_are_put_together_in_one_place() {
    assert_eq!(put_together(&files("src", "rs")), ["deliver/parts.rs"; 2], "what a drawing is told, and a report");
    let twin = (PathBuf::from("desktop/hours.rs"), "let scene = figure::Scene { place, track };".to_owned());
    assert_eq!(put_together(&[twin]), ["desktop/hours.rs"]);
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
