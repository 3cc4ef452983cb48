//! Reads subtree files of implicit tilings: JSON, and bits for the nodes of a tree that have a tile, a content or a
//! further subtree.

use serde::Deserialize;

/// The first bytes of the binary form; the JSON may also be a file of its own.
const MAGIC: &[u8] = b"subt";

/// The bytes before the JSON: magic, version, and the lengths of JSON and binary.
const HEADER_BYTES: usize = 24;

/// Which nodes have something.
pub(super) enum Availability {
    All(bool),
    /// The first node's bit is the lowest bit of the first byte.
    Bits(Vec<u8>),
}

impl Availability {
    pub(super) fn has(&self, bit: Option<usize>) -> bool {
        match (self, bit) {
            (Availability::All(all), _) => *all,
            (Availability::Bits(bytes), Some(bit)) => bytes.get(bit / 8).is_some_and(|byte| byte >> (bit % 8) & 1 == 1),
            (Availability::Bits(_), None) => false,
        }
    }
}

/// The contents of a subtree file.
pub(super) struct Subtree {
    pub tiles: Availability,
    /// The availability of each content of a tile.
    pub contents: Vec<Availability>,
    /// Which of the nodes below its last level are roots of further subtrees.
    pub below: Availability,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct SubtreeDocument {
    #[serde(default)]
    buffers: Vec<SubtreeBuffer>,
    #[serde(default)]
    buffer_views: Vec<SubtreeView>,
    tile_availability: AvailabilitySource,
    /// One for each content; in the extension before 1.1 a single one.
    #[serde(default)]
    content_availability: ContentSources,
    child_subtree_availability: AvailabilitySource,
    #[serde(default)]
    extensions: SubtreeExtensions,
}

#[derive(Default, Deserialize)]
struct SubtreeExtensions {
    #[serde(rename = "3DTILES_multiple_contents")]
    contents: Option<SeveralSources>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct SeveralSources {
    content_availability: Vec<AvailabilitySource>,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum ContentSources {
    Several(Vec<AvailabilitySource>),
    One(AvailabilitySource),
}

impl Default for ContentSources {
    fn default() -> Self {
        ContentSources::Several(Vec::new())
    }
}

#[derive(Clone, Copy, Deserialize)]
struct AvailabilitySource {
    constant: Option<u8>,
    /// The index of a buffer view.
    #[serde(alias = "bufferView")]
    bitstream: Option<usize>,
}

#[derive(Deserialize)]
struct SubtreeBuffer {
    uri: Option<String>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct SubtreeView {
    buffer: usize,
    #[serde(default)]
    byte_offset: usize,
    byte_length: usize,
}

impl Subtree {
    /// Reads a subtree; `beside` returns the bytes of a file that it refers to. `None` if it is damaged.
    pub(super) fn read(bytes: &[u8], beside: impl Fn(&str) -> Option<Vec<u8>>) -> Option<Self> {
        let (json, binary) = if bytes.starts_with(MAGIC) { halves(bytes)? } else { (bytes, &[][..]) };
        let document: SubtreeDocument = serde_json::from_slice(json.trim_ascii()).ok()?;
        let available = |source: &AvailabilitySource| match source.bitstream {
            Some(view) => document.bits(view, binary, &beside).map(Availability::Bits),
            None => Some(Availability::All(source.constant? != 0)),
        };
        let contents = match &document.content_availability {
            ContentSources::Several(several) => several.iter().collect(),
            ContentSources::One(one) => vec![one],
        };
        let further = document.extensions.contents.iter().flat_map(|several| &several.content_availability);
        Some(Self {
            tiles: available(&document.tile_availability)?,
            contents: contents.into_iter().chain(further).map(available).collect::<Option<_>>()?,
            below: available(&document.child_subtree_availability)?,
        })
    }
}

impl SubtreeDocument {
    fn bits(&self, view: usize, binary: &[u8], beside: impl Fn(&str) -> Option<Vec<u8>>) -> Option<Vec<u8>> {
        let view = self.buffer_views.get(view)?;
        let range = view.byte_offset..view.byte_offset.checked_add(view.byte_length)?;
        match &self.buffers.get(view.buffer)?.uri {
            Some(uri) => Some(beside(uri)?.get(range)?.to_vec()),
            None => Some(binary.get(range)?.to_vec()),
        }
    }
}

/// The JSON and the binary after it.
fn halves(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let number = |at: usize| {
        let bytes = bytes.get(at..at + 8)?.try_into().ok()?;
        usize::try_from(u64::from_le_bytes(bytes)).ok()
    };
    let (json, binary) = (number(8)?, number(16)?);
    let (json, rest) = bytes.get(HEADER_BYTES..)?.split_at_checked(json)?;
    Some((json, rest.get(..binary)?))
}
