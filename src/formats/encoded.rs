//! A model as plain bytes, for the pipe from a reading process and for the cache.
//!
//! The bytes are a magic number, a version, and the length of the JSON that follows; the JSON, with all names, the
//! meaning of the coordinates, what was left out, and the notes; then for each part the corners as `f64` and the
//! triangles as `u32`, little-endian; and a checksum of everything. Neither the process nor the disk is trusted: every
//! length is checked, and memory is allocated only as the bytes arrive.

use super::exact::{self, option as exact_option};
use super::{Anchor, AnchorPoint, Coordinates, FORMATS, LeftOut, MAX_COMPONENTS, MAX_TRIANGLES, Model, PartKind};
use super::{SeeThrough, Up};
use crate::mesh::{CornerPrecision, Part};
use crate::message::Message;
use glam::DVec3;
use serde::{Deserialize, Serialize};
use siphasher::sip::SipHasher13;
use std::collections::BTreeSet;
use std::hash::Hasher;
use std::io::{self, Read, Write};
use std::sync::Mutex;

const MARK: [u8; 8] = *b"gnomonMD";

/// The version of the bytes and of the readers. It changes when readers read files differently, so that older entries
/// of the cache are not used.
pub(super) const VERSION: u32 = 3;

/// The longest JSON: a thousand bytes per component.
const MOST_JSON: u64 = 1 << 30;

/// The bytes of a corner and of a triangle.
const CORNER: usize = 24;
const TRIANGLE: usize = 12;

/// The number of corners or triangles that are copied at once.
const AT_ONCE: usize = 1 << 14;

/// Why bytes cannot be decoded.
#[derive(Debug, thiserror::Error)]
pub(super) enum EncodingError {
    /// The bytes end early, or cannot be read.
    #[error("they end early ({0})")]
    Cut(#[from] io::Error),
    /// The bytes are inconsistent.
    #[error("{0}")]
    Damaged(&'static str),
}

/// All of a model except its corners and triangles; or the error of reading it.
#[derive(Serialize, Deserialize)]
struct EncodedHeader {
    fault: Option<Message>,
    format: String,
    parts: Vec<EncodedPart>,
    kinds: Vec<PartKind>,
    up: Up,
    up_is_said: bool,
    #[serde(with = "exact_option")]
    unit_m: Option<f64>,
    coordinates: Coordinates,
    from_ground: Vec<bool>,
    anchors: Vec<EncodedAnchor>,
    #[serde(with = "exact_option")]
    assumed_map_unit_m: Option<f64>,
    left_out: Vec<LeftOut>,
    notes: Vec<Message>,
    see_through: Vec<SeeThrough>,
}

#[derive(Serialize, Deserialize)]
struct EncodedPart {
    name: String,
    aliases: Vec<String>,
    corners: u64,
    triangles: u64,
    coarse: Vec<EncodedPrecision>,
}

#[derive(Serialize, Deserialize)]
struct EncodedPrecision {
    corners: [u32; 2],
    #[serde(with = "exact")]
    step_m: f64,
    is_float: bool,
}

#[derive(Serialize, Deserialize)]
struct EncodedAnchor {
    said_by: String,
    at: AnchorPoint,
    #[serde(with = "exact_option")]
    north_rad: Option<f64>,
}

/// The bytes of a model without its JSON.
pub(super) fn raw_bytes(model: &Model) -> u64 {
    let of_part = |part: &Part| (part.positions.len() * CORNER + part.triangles.len() * TRIANGLE) as u64;
    model.parts.iter().map(of_part).sum()
}

/// Writes a model, or the error of reading it.
///
/// # Errors
/// Errors of the writer.
pub(super) fn write(outcome: Result<&Model, &Message>, out: &mut impl Write) -> io::Result<()> {
    let absent = Model::default();
    let (model, fault) = match outcome {
        Ok(model) => (model, None),
        Err(message) => (&absent, Some(message.clone())),
    };
    let json = serde_json::to_vec(&header(model, fault))?;
    let mut out = ChecksumStream { inner: out, sum: SipHasher13::new() };
    out.write(&MARK)?;
    out.write(&VERSION.to_le_bytes())?;
    out.write(&(json.len() as u64).to_le_bytes())?;
    out.write(&json)?;
    let mut bytes = Vec::with_capacity(AT_ONCE * CORNER);
    for part in &model.parts {
        for corners in part.positions.chunks(AT_ONCE) {
            bytes.clear();
            bytes.extend(corners.iter().flat_map(DVec3::to_array).flat_map(f64::to_le_bytes));
            out.write(&bytes)?;
        }
        for triangles in part.triangles.chunks(AT_ONCE) {
            bytes.clear();
            bytes.extend(triangles.iter().flatten().copied().flat_map(u32::to_le_bytes));
            out.write(&bytes)?;
        }
    }
    let sum = out.sum.finish();
    out.inner.write_all(&sum.to_le_bytes())?;
    out.inner.flush()
}

fn header(model: &Model, fault: Option<Message>) -> EncodedHeader {
    let precision = |run: &CornerPrecision| EncodedPrecision {
        corners: [run.corners.start, run.corners.end],
        step_m: run.step_m,
        is_float: run.is_float,
    };
    let part = |part: &Part| EncodedPart {
        name: part.name.clone(),
        aliases: part.aliases.clone(),
        corners: part.positions.len() as u64,
        triangles: part.triangles.len() as u64,
        coarse: part.coarse.iter().map(precision).collect(),
    };
    let anchor = |anchor: &Anchor| EncodedAnchor {
        said_by: anchor.said_by.to_owned(),
        at: anchor.at.clone(),
        north_rad: anchor.north_rad,
    };
    EncodedHeader {
        fault,
        format: model.format.to_owned(),
        parts: model.parts.iter().map(part).collect(),
        kinds: model.kinds.clone(),
        up: model.up,
        up_is_said: model.up_is_said,
        unit_m: model.unit_m,
        coordinates: model.coordinates.clone(),
        from_ground: model.from_ground.clone(),
        anchors: model.anchors.iter().map(anchor).collect(),
        assumed_map_unit_m: model.assumed_map_unit_m,
        left_out: model.left_out.clone(),
        notes: model.notes.clone(),
        see_through: model.see_through.clone(),
    }
}

/// Reads what [`write()`] wrote: a model, or the error of reading it.
///
/// # Errors
/// [`EncodingError`] for bytes that [`write()`] did not write.
pub(super) fn read(input: &mut impl Read) -> Result<Result<Model, Message>, EncodingError> {
    let mut input = ChecksumStream { inner: input, sum: SipHasher13::new() };
    let (mut mark, mut version, mut length) = ([0; 8], [0; 4], [0; 8]);
    input.read(&mut mark)?;
    input.read(&mut version)?;
    if mark != MARK || u32::from_le_bytes(version) != VERSION {
        return Err(EncodingError::Damaged("they begin with a different mark"));
    }
    input.read(&mut length)?;
    let length = u64::from_le_bytes(length);
    if length > MOST_JSON {
        return Err(EncodingError::Damaged("their JSON is too long"));
    }
    let json = input.read_all(length, 1)?;
    let header: EncodedHeader =
        serde_json::from_slice(&json).map_err(|_| EncodingError::Damaged("their JSON cannot be read"))?;
    header.check()?;
    let mut parts = Vec::with_capacity(header.parts.len());
    for part in &header.parts {
        parts.push(input.part(part)?);
    }
    let (sum, mut told) = (input.sum.finish(), [0; 8]);
    input.inner.read_exact(&mut told)?;
    if sum != u64::from_le_bytes(told) {
        return Err(EncodingError::Damaged("their checksum does not match"));
    }
    match header.fault {
        Some(fault) => Ok(Err(fault)),
        None => Ok(Ok(model(EncodedHeader { parts: Vec::new(), ..header }, parts)?)),
    }
}

impl EncodedHeader {
    /// Refuses impossible contents before memory is allocated for them.
    fn check(&self) -> Result<(), EncodingError> {
        let sum = |count: fn(&EncodedPart) -> u64| {
            self.parts.iter().map(count).try_fold(0_u64, u64::checked_add).unwrap_or(u64::MAX)
        };
        if self.parts.len() > MAX_COMPONENTS
            || sum(|part| part.triangles) > MAX_TRIANGLES
            || sum(|part| part.corners) > 3 * MAX_TRIANGLES
        {
            return Err(EncodingError::Damaged("they contain more than a model may"));
        }
        let count = self.parts.len();
        let parts_are_there = self.see_through.iter().flat_map(|material| &material.parts).all(|part| *part < count);
        let is_of_parts = |length: usize| length == 0 || length == count;
        if !parts_are_there || !is_of_parts(self.kinds.len()) || !is_of_parts(self.from_ground.len()) {
            return Err(EncodingError::Damaged("they refer to parts that do not exist"));
        }
        Ok(())
    }
}

fn model(header: EncodedHeader, parts: Vec<Part>) -> Result<Model, EncodingError> {
    let format = FORMATS.iter().map(|format| format.name()).find(|name| *name == header.format);
    let anchor = |anchor: EncodedAnchor| {
        let said_by =
            lasting(anchor.said_by).ok_or(EncodingError::Damaged("they contain a term that no format has"))?;
        Ok(Anchor { said_by, at: anchor.at, north_rad: anchor.north_rad })
    };
    Ok(Model {
        format: format.ok_or(EncodingError::Damaged("their format is not known"))?,
        parts,
        kinds: header.kinds,
        up: header.up,
        up_is_said: header.up_is_said,
        unit_m: header.unit_m,
        coordinates: header.coordinates,
        from_ground: header.from_ground,
        anchors: header.anchors.into_iter().map(anchor).collect::<Result<_, EncodingError>>()?,
        assumed_map_unit_m: header.assumed_map_unit_m,
        left_out: header.left_out,
        notes: header.notes,
        see_through: header.see_through,
    })
}

/// Makes a format's term static, as readers have it. There are only a few.
fn lasting(text: String) -> Option<&'static str> {
    const MOST: usize = 256;
    const LONGEST: usize = 100;
    static KNOWN: Mutex<BTreeSet<&'static str>> = Mutex::new(BTreeSet::new());
    let mut known = KNOWN.lock().ok()?;
    if let Some(same) = known.get(text.as_str()) {
        return Some(same);
    }
    if known.len() >= MOST || text.len() > LONGEST {
        return None;
    }
    let lasting: &'static str = String::leak(text);
    known.insert(lasting);
    Some(lasting)
}

/// A stream that computes the checksum of what passes through it.
struct ChecksumStream<'a, T> {
    inner: &'a mut T,
    sum: SipHasher13,
}

impl<T: Write> ChecksumStream<'_, T> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.sum.write(bytes);
        self.inner.write_all(bytes)
    }
}

impl<T: Read> ChecksumStream<'_, T> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<()> {
        self.inner.read_exact(bytes)?;
        self.sum.write(bytes);
        Ok(())
    }

    /// Reads `count` things of `size` bytes. Memory grows as they arrive.
    fn read_all(&mut self, count: u64, size: usize) -> io::Result<Vec<u8>> {
        let (mut all, length) = (Vec::new(), count.saturating_mul(size as u64));
        self.inner.take(length).read_to_end(&mut all)?;
        if (all.len() as u64) < length {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        self.sum.write(&all);
        Ok(all)
    }

    fn part(&mut self, encoded: &EncodedPart) -> Result<Part, EncodingError> {
        let mut part = Part { name: encoded.name.clone(), aliases: encoded.aliases.clone(), ..Part::default() };
        let chunks = |count: u64| (0..count).step_by(AT_ONCE).map(move |begin| (count - begin).min(AT_ONCE as u64));
        for count in chunks(encoded.corners) {
            let bytes = self.read_all(count, CORNER)?;
            let (words, _) = bytes.as_chunks::<8>();
            let (corners, _) = words.as_chunks::<3>();
            part.positions.extend(corners.iter().map(|of| DVec3::from_array(of.map(f64::from_le_bytes))));
        }
        for count in chunks(encoded.triangles) {
            let bytes = self.read_all(count, TRIANGLE)?;
            let (words, _) = bytes.as_chunks::<4>();
            let (triangles, _) = words.as_chunks::<3>();
            part.triangles.extend(triangles.iter().map(|triangle| triangle.map(u32::from_le_bytes)));
        }
        let is_there = |corner: &u32| u64::from(*corner) < encoded.corners;
        if !part.triangles.iter().flatten().all(is_there) {
            return Err(EncodingError::Damaged("they refer to corners that do not exist"));
        }
        for run in &encoded.coarse {
            let [start, end] = run.corners;
            if start > end || u64::from(end) > encoded.corners {
                return Err(EncodingError::Damaged("they refer to corners that do not exist"));
            }
            let run = CornerPrecision { corners: start..end, step_m: run.step_m, is_float: run.is_float };
            part.coarse.push(run);
        }
        Ok(part)
    }
}
