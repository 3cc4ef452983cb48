//! What can be wrong with a glTF file. Each fault names the thing and says what to do.

use super::{MAX_COMPONENTS, MAX_TRIANGLES};

/// What is wrong with a glTF file.
#[derive(Debug, thiserror::Error)]
pub enum Fault {
    /// The operating system does not let the file be read.
    #[error("cannot be read: {0}")]
    Unreadable(std::io::Error),
    /// A folder, a pipe or a device.
    #[error("is not a file; name a .glb or .gltf file")]
    NotAFile,
    /// Larger than any glTF container.
    #[error("has {0} bytes; a model may have 4 GiB: export it in parts or with less detail")]
    TooLarge(u64),
    /// The file is of another format, or of none.
    #[error("is not glTF, though its name says so; it is damaged or of another format: copy or export it again")]
    NotGltf,
    /// The binary container contradicts itself.
    #[error("{0}; the file is cut off or damaged: copy or export it again")]
    Container(String),
    /// The JSON is not JSON, or not glTF's.
    #[error("its JSON is damaged ({0}): export it again")]
    Json(serde_json::Error),
    /// glTF 1.0, or a version that does not exist yet.
    #[error("is glTF {0}, and Gnomon reads glTF 2.0: export it as glTF 2.0")]
    Version(String),
    /// An extension without which the geometry would be wrong.
    #[error("requires the extension {0}, which Gnomon does not read: export it without")]
    Extension(String),
    /// Compressed geometry that cannot be unpacked.
    #[error("{what} {problem}; the file is damaged: copy or export it again, or export it without mesh compression")]
    Unpacking {
        /// What is compressed.
        what: String,
        /// Verb and object.
        problem: String,
    },
    /// An index that leads nowhere.
    #[error("{user} refers to {what} {index}, and there are only {count}; the file is damaged: export it again")]
    NoSuch {
        /// What refers.
        user: String,
        /// The kind of thing referred to.
        what: &'static str,
        /// Its number.
        index: usize,
        /// How many there are.
        count: usize,
    },
    /// A byte range beyond what holds it.
    #[error(
        "{what} reads bytes {start}–{end} of {holder}, which holds {holds}; \
         the file is cut off or damaged: export it again"
    )]
    Range {
        /// What reads.
        what: String,
        /// First byte.
        start: u64,
        /// One behind the last byte.
        end: u64,
        /// What is read.
        holder: String,
        /// Bytes in it.
        holds: u64,
    },
    /// A name so long that nobody can have meant it; names are copied into every component.
    #[error("{what} has a name of {bytes} bytes; a name may have 1000: shorten it and export again")]
    LongName {
        /// What is named.
        what: String,
        /// Length of the name.
        bytes: usize,
    },
    /// An accessor that says what glTF does not allow here.
    #[error("accessor {accessor} {problem}: export it again")]
    Accessor {
        /// Its number.
        accessor: usize,
        /// Verb and object.
        problem: String,
    },
    /// A buffer without usable bytes.
    #[error("buffer {buffer} {problem}")]
    Buffer {
        /// Its number.
        buffer: usize,
        /// Verb, object and hint.
        problem: String,
    },
    /// A node that has no place in the world.
    #[error("node {node} {problem}: mend the model and export it again")]
    Node {
        /// Its number.
        node: usize,
        /// Verb and object.
        problem: String,
    },
    /// A skin without a pose.
    #[error("skin {skin} {problem}: mend the model and export it again")]
    Skin {
        /// Its number.
        skin: usize,
        /// Verb and object.
        problem: String,
    },
    /// The requested scene does not exist.
    #[error("{0}")]
    Scene(String),
    /// A primitive whose triangles cannot be read.
    #[error("primitive {primitive} of mesh {mesh} {problem}: mend the model and export it again")]
    Primitive {
        /// The mesh's number.
        mesh: usize,
        /// The primitive's number in it.
        primitive: usize,
        /// Verb and object.
        problem: String,
    },
    /// More triangles than a study can handle.
    #[error("has more than {MAX_TRIANGLES} triangles, instances counted: export it in parts or with less detail")]
    TooManyTriangles,
    /// More components than a study can handle.
    #[error("has more than {MAX_COMPONENTS} components: join its objects by material and export again")]
    TooManyComponents,
    /// More numbers to morph or skin than a study can handle.
    #[error("morphs or skins too much, instances counted: export it as it stands, without morph targets and skins")]
    TooManyMoves,
    /// Nothing in the file could cast.
    #[error("has no triangles in {scene}, so nothing casts a shadow: {way_out}")]
    Empty {
        /// Which scene is read.
        scene: &'static str,
        /// What to do.
        way_out: String,
    },
}

impl Fault {
    pub(super) fn of_accessor(accessor: usize, problem: impl Into<String>) -> Fault {
        Fault::Accessor { accessor, problem: problem.into() }
    }

    pub(super) fn of_primitive(mesh: usize, primitive: usize, problem: impl Into<String>) -> Fault {
        Fault::Primitive { mesh, primitive, problem: problem.into() }
    }
}
