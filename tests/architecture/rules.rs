//! The rules as tables: which module may use which, reserved words, and the greatest lengths of files and functions.

/// The modules in reading order, and whom each may know. Everybody may know themselves.
pub(super) const MAY_KNOW: &[(&str, &[&str])] = &[
    ("message", &[]),
    ("choice", &[]),
    ("contour", &[]),
    ("crs", &[]),
    ("look", &[]),
    ("mesh", &[]),
    ("sun", &[]),
    ("view", &[]),
    ("rules", &["choice", "sun"]),
    ("formats", &["crs", "mesh"]),
    ("site", &["choice", "crs", "mesh", "sun", "view", "formats"]),
    ("silhouette", &["mesh"]),
    ("volume", &["mesh", "silhouette"]),
    ("gpu", &[]),
    ("shadow", &["choice", "mesh", "sun", "view", "silhouette", "volume", "gpu"]),
    ("picture", &["look", "mesh", "view", "silhouette", "volume", "gpu", "shadow"]),
    ("profile", &["choice", "view", "gpu", "shadow"]),
    ("sunlight", &["mesh", "sun", "view", "shadow"]),
    ("verification", &["choice", "view", "shadow", "profile"]),
    ("judgement", &["choice", "rules", "site"]),
    (
        "study",
        &[
            "choice",
            "mesh",
            "sun",
            "view",
            "rules",
            "site",
            "silhouette",
            "volume",
            "gpu",
            "shadow",
            "picture",
            "profile",
            "sunlight",
            "verification",
            "judgement",
        ],
    ),
    (
        "export",
        &[
            "choice",
            "contour",
            "look",
            "mesh",
            "sun",
            "view",
            "rules",
            "formats",
            "site",
            "volume",
            "profile",
            "sunlight",
            "verification",
            "judgement",
        ],
    ),
    (
        "deliver",
        &[
            "choice",
            "mesh",
            "sun",
            "view",
            "rules",
            "site",
            "volume",
            "shadow",
            "profile",
            "sunlight",
            "judgement",
            "study",
            "export",
        ],
    ),
    ("fault", &["choice", "sun", "formats", "site", "gpu", "shadow", "study", "export", "deliver"]),
    (
        "cli",
        &[
            "choice",
            "mesh",
            "sun",
            "view",
            "rules",
            "formats",
            "site",
            "silhouette",
            "volume",
            "gpu",
            "shadow",
            "profile",
            "judgement",
            "study",
            "export",
            "fault",
            "deliver",
        ],
    ),
    // the faces do not know each other
    (
        "desktop",
        &[
            "choice",
            "look",
            "mesh",
            "sun",
            "view",
            "rules",
            "formats",
            "site",
            "silhouette",
            "volume",
            "gpu",
            "shadow",
            "picture",
            "profile",
            "sunlight",
            "judgement",
            "study",
            "export",
            "fault",
            "deliver",
        ],
    ),
];

/// Whom everybody may know: what is said to people is said everywhere.
pub(super) const KNOWN_TO_ALL: &str = "message";

/// Who may write an option of the command: all others name a field of the request, which each face has its own word for.
pub(super) const WRITES_OPTIONS: &[&str] = &["cli", "main"];

/// Words of one face in what is said to people.
pub(super) const WORDS_OF_A_FACE: &[&str] = &[
    "command",
    "gnomon profile",
    "gnomon compare",
    "gnomon shadow",
    "gnomon animate",
    "gnomon sun",
    "gnomon check",
    "gnomon convert",
    "gnomon volumes",
    "gnomon verify",
    "gnomon probe",
    "gnomon open",
    "gnomon judge",
    "gnomon envelope",
    "gnomon rules",
];

/// Where these words are meant: a menu of another program, the reference of the site file, and a window that cannot open.
pub(super) const SPEAK_OF_COMMANDS: &[&str] = &["formats/refused.rs", "site/key_table.rs", "desktop/reopening.rs"];

/// Words that only some modules may write, and why. `main` is the binary's own file.
pub(super) const RESERVED: &[(&str, &[&str], &str)] = &[
    ("print!(", &["cli", "main"], "only faces print"),
    ("println!(", &["cli", "main"], "only faces print"),
    ("eprint!(", &["cli", "main"], "only faces print"),
    ("eprintln!(", &["cli", "main"], "only faces print"),
    ("dbg!(", &[], "only faces print"),
    ("io::stdout", &["cli", "main"], "only faces print"),
    ("io::stderr", &["cli", "main"], "only faces print"),
    ("clap::", &["cli"], "only faces read the command line"),
    ("toml::", &["site", "rules"], "only site and rules read what the user wrote"),
    ("gltf::", &["formats", "export"], "only formats reads models, and only export writes"),
    (
        "fs::read",
        &["formats", "site", "rules", "export", "deliver", "sun"],
        "only formats, site and rules read what the user wrote, export and deliver what they wrote themselves, and sun the system's rules of clocks",
    ),
    ("File::open", &["formats", "site", "deliver"], "they read users' files, deliver its own bits"),
    // gpu and shadow name shaders and passes so
    ("\"stencil\"", &["choice", "gpu", "shadow"], "techniques are types until they are printed"),
    ("\"projected\"", &["choice", "gpu", "shadow"], "techniques are types until they are printed"),
    ("\"shadow-map\"", &["choice", "gpu", "shadow"], "techniques are types until they are printed"),
    ("\"hybrid\"", &["choice", "gpu", "shadow"], "techniques are types until they are printed"),
    ("\"smoothie\"", &["choice", "gpu", "shadow"], "techniques are types until they are printed"),
    ("\"soft-texture\"", &["choice", "gpu", "shadow"], "techniques are types until they are printed"),
    ("\"ray-cast\"", &["choice", "gpu", "shadow"], "techniques are types until they are printed"),
    ("SystemTime::now", &[], "nothing reads the clock"),
    ("Utc::now", &[], "nothing reads the clock"),
    ("Local::now", &[], "nothing reads the clock"),
];

/// The faces. What a technique can do they read in its row, so that a new technique needs no line there.
pub(super) const FACES: &[&str] = &["cli", "desktop"];

/// The file of a face that casts rays itself, where no adapter is left, and says so.
pub(super) const DRAWS_ITSELF: &str = "desktop/stage/plain.rs";

/// At this length look for a second idea inside.
pub(super) const MOST_LINES: usize = 500;

/// At this length a function has steps that can be named.
pub(super) const MOST_LINES_OF_A_FUNCTION: usize = 60;

/// The rooms, and folders of rooms, whose functions are not held to it yet.
pub(super) const LONG_FUNCTIONS_IN: &[&str] = &[];
