//! The library's documentation shows the three entry points and their types. All other public items are hidden there or
//! need the feature `test-hooks`.

use std::path::Path;

/// The modules, and what each shows at its root.
const SHOWN: &[(&str, &[&str])] = &[
    // and Field, which a macro makes
    ("message", &["Message", "MessagePart", "PlainWords", "Worded", "Words"]),
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
    ("formats", &["ModelCache", "ModelError", "ModelFault", "ModelReader", "ReadLimits", "Up"]),
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

/// A module's own file.
fn own_file(module: &str) -> String {
    if module == "message" { "message.rs".to_owned() } else { format!("{module}/mod.rs") }
}

/// Types of the standard library, of the crates that are exported, and of wgpu.
const OTHERS_TYPES: &[&str] = &[
    "Arc",
    "AtomicBool",
    "Box",
    "ControlFlow",
    "Cow",
    "DVec3",
    "DVec4",
    "DateTime",
    "Device",
    "Duration",
    "FixedOffset",
    "Limits",
    "NaiveDate",
    "NaiveDateTime",
    "NaiveTime",
    "Option",
    "PathBuf",
    "Queue",
    "Range",
    "RefCell",
    "Self",
    "String",
    "Texture",
    "TimeDelta",
    "Vec",
    "Vec3",
];

/// The types in the public fields of a source's shown types which the documentation does not show: `Type: field's type`.
fn unseen_types(source: &str, is_shown: impl Fn(&str) -> bool) -> Vec<String> {
    let (mut unseen, mut of, mut is_hidden) = (Vec::new(), None, false);
    for line in source.lines() {
        let code = line.trim();
        if let Some(name) = ["pub struct ", "pub enum "].iter().find_map(|word| line.strip_prefix(word)) {
            let is_struct = line.starts_with("pub struct");
            let name = name.split(|c: char| !c.is_alphanumeric()).next().unwrap_or_default();
            of = line.ends_with('{').then_some((name, is_struct)).filter(|(name, _)| is_shown(name));
        } else if line == "}" {
            of = None;
        }
        is_hidden &= of.is_some();
        let Some((name, is_struct)) = of.filter(|_| line.starts_with(' ') && !code.starts_with(['/', '#'])) else {
            is_hidden |= code == "#[doc(hidden)]";
            continue;
        };
        if std::mem::take(&mut is_hidden) {
            continue;
        }
        let field = match (code.strip_prefix("pub "), is_struct) {
            (Some(field), true) => field.split_once(": "),
            (_, false) => code.split_once(": ").or(code.split_once('(')),
            _ => None,
        };
        let words = field.map_or("", |(_, of)| of).split(|c: char| !c.is_alphanumeric() && c != '_');
        let types = words.filter(|word| word.starts_with(char::is_uppercase) && word.len() > 1);
        let hidden = types.filter(|word| !is_shown(word) && !OTHERS_TYPES.contains(word));
        unseen.extend(hidden.map(|word| format!("{name}: {word}")));
    }
    unseen
}

#[test]
fn fields_have_types_that_are_shown() {
    let is_shown = |word: &str| word == "Field" || SHOWN.iter().any(|(_, names)| names.contains(&word));
    let sources = crate::architecture::files("src", "rs");
    let unseen: Vec<_> = sources.iter().flat_map(|(_, source)| unseen_types(source, is_shown)).collect();
    assert!(unseen.is_empty(), "types of public fields that the documentation hides:\n{}", unseen.join("\n"));
    let file = "pub struct Site {\n    /// Of a Hidden.\n    pub words: Vec<Words>,\n    #[doc(hidden)]\n    pub of: Hidden,\n    own: Hidden,\n}\npub struct Other {\n    \
        pub it: Hidden,\n}\npub enum Error {\n    Of(Box<Hidden>),\n    Value {\n        at: Words,\n    },\n}";
    let shown = |word: &str| ["Site", "Words", "Error"].contains(&word);
    assert_eq!(unseen_types(file, shown), ["Error: Hidden"]);
    assert_eq!(unseen_types(file, |word| word == "Site"), ["Site: Words"]);
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
        assert_eq!(shown(&source(&own_file(module))), *names, "src/{module}");
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
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/site/overrides.rs");
    let fields = std::fs::read_to_string(path).expect("the source");
    let of_text: Vec<&str> = fields.lines().filter(|line| line.contains("Option<String>")).collect();
    assert!(fields.contains("pub struct Overrides") && of_text.is_empty(), "{of_text:?}");
}
