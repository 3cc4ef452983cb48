//! What the library's documentation shows: the three doors and the types that they speak in. All else that is public is
//! hidden there, or stands behind the feature `test-hooks`.

use std::path::Path;

/// The modules, and what each shows at its root.
const SHOWN: &[(&str, &[&str])] = &[
    ("choice", &["Engine", "Filter", "Finder", "Method", "Misfit", "Receivers", "Setting", "Settings", "Subject"]),
    ("mesh", &["Component", "CornerPrecision", "Incidence", "Mesh", "MeshError", "Part"]),
    (
        "sun",
        &[
            "Day",
            "EachDay",
            "Instant",
            "Place",
            "Polar",
            "Position",
            "Reading",
            "SunError",
            "SunTrack",
            "TimeOfDay",
            "TzVersion",
            "Window",
            "Zone",
            "ZoneOffset",
        ],
    ),
    (
        "view",
        &[
            "Bits",
            "Camera",
            "Decider",
            "Elevation",
            "FragmentCounts",
            "Grid",
            "Mask",
            "Side",
            "Surface",
            "Tile",
            "View",
        ],
    ),
    (
        "site",
        &["FieldLocation", "Ground", "GroundFrom", "GroundKind", "Likeness", "Mend", "Overrides", "Site", "SiteError"],
    ),
    ("silhouette", &["ProcessorFinder"]),
    ("gpu", &["Gpu", "GpuError"]),
    (
        "shadow",
        &[
            "DrawnMask",
            "JUDGED_ABOVE_M",
            "Scene",
            "ShadowError",
            "Silhouettes",
            "Technique",
            "hybrid",
            "projected",
            "ray_cast",
            "shadow_map",
            "smoothie",
            "stencil",
        ],
    ),
    ("profile", &["Profile", "Provenance", "Shaded", "Statistics", "Timings", "Unfinished", "hours"]),
    (
        "study",
        &[
            "Budget",
            "Event",
            "OnEvent",
            "Outcome",
            "StudyError",
            "TiledOutcome",
            "TiledStudy",
            "Wants",
            "in_tiles",
            "paste",
            "run",
        ],
    ),
];

/// What a module's own file shows of its root: declarations and re-exports for everybody that are not hidden, in order.
fn shown(source: &str) -> Vec<String> {
    let mut names = Vec::new();
    let (mut hidden, mut reexport) = (false, String::new());
    for line in source.lines() {
        if !reexport.is_empty() {
            reexport.push_str(line);
        } else if line.starts_with("#[") {
            hidden |= line == "#[doc(hidden)]" || line == "#[cfg(feature = \"test-hooks\")]";
            continue;
        } else if let Some(rest) = line.strip_prefix("pub use ") {
            reexport = rest.to_owned();
        } else if let Some(name) = declared(line).filter(|_| !hidden) {
            names.push(name.to_owned());
        }
        if reexport.ends_with(';') {
            names.extend(reexported(&reexport).filter(|_| !hidden));
            reexport.clear();
        }
        if reexport.is_empty() && !line.starts_with("//") {
            hidden = false;
        }
    }
    names.sort();
    names
}

/// The name that a line declares for everybody.
fn declared(line: &str) -> Option<&str> {
    let (_, rest) = line.strip_prefix("pub ")?.split_once(' ')?;
    rest.split(|c: char| !c.is_alphanumeric() && c != '_').next().filter(|name| !name.is_empty())
}

/// The names of a re-export, `room::{One, Other};` or `room::One;`.
fn reexported(path: &str) -> impl Iterator<Item = String> {
    let names = path.rsplit("::").next().unwrap_or_default();
    let names = names.split(|c: char| !c.is_alphanumeric() && c != '_').filter(|name| !name.is_empty());
    names.map(str::to_owned).collect::<Vec<_>>().into_iter()
}

fn source(path: &str) -> String {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    std::fs::read_to_string(src.join(path)).expect("a source file")
}

#[test]
fn documentation_shows_the_doors_and_their_types() {
    let lib = source("lib.rs");
    let mut modules: Vec<_> = SHOWN.iter().map(|(module, _)| module.to_string()).collect();
    // the crates whose types the doors speak in
    modules.extend(["chrono", "glam"].map(str::to_owned));
    modules.sort();
    assert_eq!(shown(&lib), modules, "lib.rs");
    for (module, names) in SHOWN {
        assert_eq!(shown(&source(&format!("{module}/mod.rs"))), *names, "src/{module}/mod.rs");
    }
}

#[test]
fn checker_sees_what_is_shown() {
    let file = "pub use {chrono, glam};\n\n#[doc(hidden)]\npub mod fault;\npub mod sun;\nmod own;\n#[doc(hidden)]\n/// Text.\n\
        pub use own::{\n    One,\n    Two,\n};\npub use own::Three;\n/// Text.\n#[derive(Clone)]\npub struct Four<'a> {\n    pub five: u32,\n}\n\
        pub(crate) use own::Six;\n#[cfg(feature = \"test-hooks\")]\npub use own::seven;\n#[doc(hidden)]\n#[derive(Clone)]\npub enum Eight {";
    assert_eq!(shown(file), ["Four", "Three", "chrono", "glam", "sun"]);
}

/// What a face asks is typed: text is parsed by the face that takes it.
#[test]
fn what_is_asked_is_typed() {
    let fields = std::fs::read_to_string("src/site/overrides.rs").expect("the source");
    let of_text: Vec<&str> = fields.lines().filter(|line| line.contains("Option<String>")).collect();
    assert!(fields.contains("pub struct Overrides") && of_text.is_empty(), "{of_text:?}");
}
