//! Why a file could not be written.

use crate::message::{Field, Message, MessagePart, Worded, aside, message, pieces, plain_display};
use std::io;
use std::path::{Path, PathBuf};

/// The reason why a result could not be written to a file.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The file system failed.
    Write {
        /// The file that was to be written.
        path: PathBuf,
        /// The step that failed.
        doing: &'static str,
        /// The system's message.
        source: std::io::Error,
    },
    /// A file left by a stopped study cannot be read.
    Read {
        /// The file.
        path: PathBuf,
        /// The system's message.
        source: std::io::Error,
    },
    /// The disk is too full.
    NoRoom {
        /// The file that was to be written.
        path: PathBuf,
        /// The size of the file, bytes.
        size: u64,
        /// The free space on the disk, bytes.
        room: u64,
    },
    /// Another study is working in the folder.
    Busy {
        /// The folder.
        folder: PathBuf,
        /// Since when, by which process on which host, and for which request.
        who: String,
    },
    /// The folder was removed, or replaced by another one.
    Lost {
        /// The folder.
        folder: PathBuf,
    },
    /// A file that is not ours would look like a frame of the animation.
    OtherFrame {
        /// The file.
        path: PathBuf,
        /// The number of frames of the animation.
        count: usize,
    },
    /// An output would overwrite an input.
    IsInput {
        /// The file that was to be written.
        path: PathBuf,
        /// The same file, as the site file names it.
        input: PathBuf,
    },
    /// The path cannot be a file: it has no name, or a folder or a device is there.
    NoFileName {
        /// The path as given.
        path: PathBuf,
    },
    /// The model with the hours on its surfaces is too large for a GLB.
    LargeGlb {
        /// The size that it would have, bytes.
        size: u64,
    },
    /// The result cannot be encoded in the format.
    Encode {
        /// What was being made.
        what: &'static str,
        /// The encoder's message.
        why: String,
    },
    /// Two rasters that belong together differ in size. This is a bug elsewhere; it is reported, since the drawing
    /// would be wrong.
    Size {
        /// Which raster.
        what: &'static str,
        /// The number of its cells.
        have: usize,
        /// Columns expected.
        width: u32,
        /// Rows expected.
        height: u32,
    },
}

plain_display!(ExportError);

impl Worded for ExportError {
    fn message(&self) -> Message {
        match self {
            ExportError::Write { path, doing, source } => Message {
                what: pieces![format!("cannot write {}: {doing}: {source}", path.display())],
                hint: way_out(source.kind()),
            },
            ExportError::Read { path, source } => message![
                format!("cannot read {}, which a stopped study left: {source}", path.display());
                "remove it; the study then starts over"
            ],
            ExportError::NoRoom { path, size, room } => no_room(path, *size, *room),
            ExportError::Busy { folder, who } => message![
                format!("{}: another study is working there, {who}", folder.display());
                "wait until it is done, or choose another folder"
            ],
            ExportError::Lost { folder } => message![
                format!(
                    "{}: the folder, or its .gnomon.lock, was removed while the study worked there, and no result was \
                     written",
                    folder.display()
                );
                "run it again"
            ],
            ExportError::OtherFrame { path, count } => message![
                format!(
                    "{} would look like a frame after the {count} of this animation, and is not known to belong to an \
                     animation that was finished there",
                    path.display()
                );
                "remove it and the frames after it, or choose another folder"
            ],
            ExportError::IsInput { path, input } => message![
                format!(
                    "cannot write {}: it is {}, which the site is read from and which would be lost",
                    path.display(),
                    input.display()
                );
                "choose another name or folder"
            ],
            ExportError::NoFileName { path } => message![
                format!("cannot write {}: that is not a file", path.display());
                "give the name of a file"
            ],
            ExportError::LargeGlb { size } => message![
                format!(
                    "cannot write the surfaces: the file would be {:.1} GiB, and a GLB holds at most 4",
                    *size as f64 / f64::from(1 << 30)
                );
                "choose a larger ",
                Field::PatchCell
            ],
            ExportError::Encode { what, why } => format!("cannot write the {what}: {why}").into(),
            ExportError::Size { what, have, width, height } => message![
                format!("the {what} has {have} cells where the view has {width} × {height}");
                "please report this as a bug"
            ],
        }
    }
}

impl ExportError {
    /// Whether the command line was wrong (exit status 2).
    pub fn is_wrong_use(&self) -> bool {
        matches!(self, ExportError::IsInput { .. })
    }

    /// An encoder's error, in its own words.
    pub(crate) fn encode(what: &'static str, why: impl ToString) -> Self {
        ExportError::Encode { what, why: why.to_string() }
    }
}

/// A number of bytes for people: `577 MB`.
pub fn bytes(count: u64) -> String {
    let mut size = count as f64;
    let mut unit = "bytes";
    for larger in ["kB", "MB", "GB", "TB"] {
        if size < 999.5 {
            break;
        }
        size /= 1000.0;
        unit = larger;
    }
    let decimals = if unit == "bytes" || size >= 99.5 { 0 } else { 1 };
    format!("{size:.decimals$} {unit}")
}

/// Returns an error unless `have` cells fill `width` × `height`.
pub(super) fn check_size(what: &'static str, have: usize, width: u32, height: u32) -> Result<(), ExportError> {
    if have == width as usize * height as usize && have > 0 {
        return Ok(());
    }
    Err(ExportError::Size { what, have, width, height })
}

/// The message for a file that does not fit on its disk.
fn no_room(path: &Path, size: u64, room: u64) -> Message {
    message![
        format!("{} takes {}, and its disk has room for {}", path.display(), bytes(size), bytes(room));
        "choose larger cells",
        aside(Field::Cell),
        ", ",
        MessagePart::Where(Field::Size, pieces!["fewer", aside(Field::Size), ", "]),
        "a longer ",
        Field::Step,
        ", or another disk",
        MessagePart::Where(Field::Out, pieces![" with ", Field::Out])
    ]
}

/// The hint for an error of the file system.
fn way_out(kind: io::ErrorKind) -> Vec<MessagePart> {
    let way_out = match kind {
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => "choose a folder you may write to",
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded | io::ErrorKind::FileTooLarge => {
            "free some space, or choose another disk"
        }
        io::ErrorKind::IsADirectory
        | io::ErrorKind::NotADirectory
        | io::ErrorKind::AlreadyExists
        | io::ErrorKind::DirectoryNotEmpty => {
            "there is a folder instead of a file, or a file instead of a folder; choose another name"
        }
        io::ErrorKind::InvalidFilename => "choose a shorter or simpler name",
        _ => "choose another place",
    };
    pieces![way_out, MessagePart::Where(Field::Out, pieces![" with ", Field::Out])]
}
