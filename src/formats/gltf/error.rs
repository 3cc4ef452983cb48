//! Errors in glTF files. Each names what is at fault and says what to do.

use super::{MAX_COMPONENTS, MAX_TRIANGLES};

/// What is wrong with a glTF file.
#[derive(Debug, thiserror::Error)]
pub enum Fault {
    /// The operating system cannot read the file.
    #[error("cannot be read: {0}")]
    Unreadable(std::io::Error),
    /// A folder, a pipe or a device.
    #[error("is not a file; name a .glb or .gltf file")]
    NotAFile,
    /// Larger than any glTF container.
    #[error("has {0} bytes, but a model may have at most 4 GiB: export it in parts or with less detail")]
    TooLarge(u64),
    /// The file is of another format, or of none.
    #[error("is not glTF, though its name says so; it is damaged or of another format: copy or export it again")]
    NotGltf,
    /// The binary container is inconsistent.
    #[error("{0}; the file is cut off or damaged: copy or export it again")]
    Container(String),
    /// The JSON is not JSON, or not glTF's.
    #[error("its JSON is damaged ({0}): export it again")]
    Json(serde_json::Error),
    /// glTF 1.0, or a version that does not exist yet.
    #[error("is glTF {0}, but Gnomon reads glTF 2.0: export it as glTF 2.0")]
    Version(String),
    /// An extension without which the geometry would be wrong.
    #[error("requires the extension {0}, which Gnomon does not read: export it without")]
    Extension(String),
    /// Compressed geometry that cannot be unpacked.
    #[error("{what} {problem}; the file is damaged: copy or export it again, or export it without mesh compression")]
    Unpacking {
        /// What is compressed.
        what: String,
        /// The predicate of a sentence.
        problem: String,
    },
    /// An index out of range.
    #[error("{user} refers to {what} {index}, but there are only {count}; the file is damaged: export it again")]
    NoSuch {
        /// What refers.
        user: String,
        /// The kind of thing referred to.
        what: &'static str,
        /// Its index.
        index: usize,
        /// The number of things that exist.
        count: usize,
    },
    /// A byte range beyond the end of its source.
    #[error(
        "{what} reads bytes {start}–{end} of {holder}, which holds {holds}; \
         the file is cut off or damaged: export it again"
    )]
    Range {
        /// What is read.
        what: String,
        /// The first byte.
        start: u64,
        /// The end of the range.
        end: u64,
        /// The source.
        holder: String,
        /// The bytes of the source.
        holds: u64,
    },
    /// A name that is too long to be meant. Names are copied into every component.
    #[error("{what} has a name of {bytes} bytes; a name may have at most 1000: shorten it and export again")]
    LongName {
        /// What has the name.
        what: String,
        /// Length of the name.
        bytes: usize,
    },
    /// An accessor with contents that glTF does not allow here.
    #[error("accessor {accessor} {problem}: export it again")]
    Accessor {
        /// Its index.
        accessor: usize,
        /// The predicate of a sentence.
        problem: String,
    },
    /// A buffer without usable bytes.
    #[error("buffer {buffer} {problem}")]
    Buffer {
        /// Its number.
        buffer: usize,
        /// The predicate of a sentence, and a hint.
        problem: String,
    },
    /// A node without a valid transform.
    #[error("node {node} {problem}: repair the model and export it again")]
    Node {
        /// Its index.
        node: usize,
        /// The predicate of a sentence.
        problem: String,
    },
    /// A skin without a valid pose.
    #[error("skin {skin} {problem}: repair the model and export it again")]
    Skin {
        /// Its index.
        skin: usize,
        /// The predicate of a sentence.
        problem: String,
    },
    /// The requested scene does not exist.
    #[error("{0}")]
    Scene(String),
    /// A primitive whose triangles cannot be read.
    #[error("primitive {primitive} of mesh {mesh} {problem}: repair the model and export it again")]
    Primitive {
        /// The mesh's index.
        mesh: usize,
        /// The primitive's index in the mesh.
        primitive: usize,
        /// The predicate of a sentence.
        problem: String,
    },
    /// More triangles than a study can handle.
    #[error("has more than {MAX_TRIANGLES} triangles, instances counted: export it in parts or with less detail")]
    TooManyTriangles,
    /// More components than a study can handle.
    #[error("has more than {MAX_COMPONENTS} components: join its objects by material and export again")]
    TooManyComponents,
    /// More values to morph or skin than a study can handle.
    #[error("morphs or skins too much, instances counted: export it as it stands, without morph targets and skins")]
    TooManyMoves,
    /// The scene has no triangles.
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
