//! Zipped Collada: finds the document in an archive.

use super::xml::{DaeXml, text_of};
use crate::formats::ModelFault;
use crate::formats::archive::ModelArchive;
use crate::formats::whole::MOST_BYTES;
use crate::message::{Message, few, message};

/// The ending of documents.
pub(super) const ENDING: &str = ".dae";

/// The file in an archive that names the main document.
const MANIFEST: &str = "manifest.xml";

/// The longest manifest that is read.
const MOST_MANIFEST_BYTES: u64 = 1 << 20;

/// A document of an archive.
pub(super) struct ZippedDocument {
    pub bytes: Vec<u8>,
    /// A note if the archive contains other documents.
    pub note: Option<Message>,
}

/// The document named by the archive's manifest, otherwise the first one.
pub(super) fn document(bytes: &[u8]) -> Result<ZippedDocument, ModelFault> {
    let archive = ModelArchive::open(bytes, ENDING)?;
    let root = archive.unpacked(MANIFEST, MOST_MANIFEST_BYTES)?.and_then(|manifest| root_of(&text_of(manifest)));
    let named = root.filter(|root| archive.models().any(|name| name == root));
    let Some(name) = named.or_else(|| archive.models().next().map(str::to_owned)) else {
        return Err(message!["is a zip archive with no .dae in it"; "export the model as Collada (.dae)"].into());
    };
    let others: Vec<String> = archive.models().filter(|other| *other != name).map(str::to_owned).collect();
    let note = (!others.is_empty()).then(|| {
        let what = format!("is an archive of several models; {name} is read, not {}", few(others));
        message![what; "unpack it to open the others"]
    });
    let unpacked = archive.unpacked(&name, MOST_BYTES)?;
    Ok(ZippedDocument { bytes: unpacked.unwrap_or_default(), note })
}

/// The document that a manifest names (Collada 1.5, "The Zipped Archive"); `None` if it names a part of one, or is
/// damaged.
fn root_of(manifest: &str) -> Option<String> {
    let mut xml = DaeXml::new(manifest);
    let root = xml.root().ok().filter(|root| root.local_name().as_ref() == "dae_root")?;
    drop(root);
    let address = xml.word().ok()?;
    let path = address.split('#').next().unwrap_or_default();
    Some(path.strip_prefix("./").unwrap_or(path).to_owned())
}
