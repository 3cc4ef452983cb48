//! What `[before]` says to be demolished: it stands in the state before alone, and in no study of the site as it is.

use super::error::SiteError;
use super::file::Names;
use super::names::names_of;
use super::written::WrittenSite;
use crate::mesh::Component;
use crate::message::{Message, few};

/// The names that are written.
fn names(written: &WrittenSite) -> Option<Names> {
    let before = written.site.before.as_ref()?;
    before.demolished.as_ref().map(|names| Names::Some(names.0.clone()))
}

/// The indices of the components that are demolished.
///
/// # Errors
/// [`SiteError::UnknownName`].
pub(super) fn components(written: &WrittenSite, of: &[Component]) -> Result<Vec<usize>, SiteError> {
    let Some(names) = names(written) else { return Ok(Vec::new()) };
    if let Some((name, nearest)) = names.unknown(&names_of(of)) {
        return Err(SiteError::UnknownName { at: written.key("before", "demolished"), name, nearest });
    }
    let chosen = names.chosen(of);
    Ok((0..of.len()).filter(|at| chosen[*at]).collect())
}

/// That some are.
pub(super) fn note(written: &WrittenSite, of: &[Component]) -> Option<Message> {
    let gone = names(written)?.chosen(of);
    let names: Vec<String> =
        of.iter().zip(gone).filter(|(_, gone)| *gone).map(|(component, _)| format!("\"{}\"", component.name)).collect();
    let (components, they) = match names.len() {
        0 => return None,
        1 => ("1 component is".to_owned(), "it casts and receives"),
        more => (format!("{more} components are"), "they cast and receive"),
    };
    Some(Message::from(format!("{components} demolished by [before], so that {they} nothing: {}", few(names))))
}
