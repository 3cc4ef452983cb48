//! What was left out of each model of a site: the complete list for `gnomon check`, and a short note for everything
//! else.

use super::contents::{ModelContents, ReadContents};
use super::file::Names;
use super::models::{Models, name};
use super::names::names_of;
use super::written::WrittenSite;
use crate::formats::LeftOut;
use crate::mesh::Component;
use crate::message::{Field, Message, MessagePart, few, message, pieces, setting};

impl Models {
    /// The contents of each model, in the models' order.
    pub fn contents(&self, written: &WrittenSite) -> Vec<ModelContents> {
        let told = |(index, (read, components)): (usize, (&ReadContents, &[Component]))| {
            read.told(name(written, index), &names_of(components))
        };
        self.by_model().enumerate().map(told).collect()
    }

    /// Returns for each component of one of the models whether it casts under the value `names` of `casts`.
    pub fn casts_of(&self, model: usize, names: &Names) -> Vec<bool> {
        self.by_model().nth(model).map_or_else(Vec::new, |(read, components)| read.casts(names, components))
    }

    /// Notes on what was left out, and on ground cover that does not cast: at most one of each per model.
    pub(super) fn notes_on_contents(&self, written: &WrittenSite) -> Vec<Message> {
        let mut notes = Vec::new();
        for (index, (read, components)) in self.by_model().enumerate() {
            let file = name(written, index);
            notes.extend(note_left_out(file, &read.left_out));
            let is_said = written.site.model.get(index).is_some_and(|table| table.casts.means_only_named(components));
            notes.extend(note_covers(file, read, components).filter(|_| !is_said));
        }
        notes
    }
}

/// A short note on what was left out of a model: the most frequent reason, and the number of other things.
fn note_left_out(name: &str, left_out: &[LeftOut]) -> Option<Message> {
    let most = left_out.iter().max_by_key(|left| left.count)?;
    let others: u64 = left_out.iter().map(|left| left.count).fold(0_u64, u64::saturating_add) - most.count;
    let first = most.counted();
    let what = match others {
        0 => format!("{name}: {first} left out"),
        1 => format!("{name}: {first} and another thing left out"),
        more => format!("{name}: {first} and {more} others left out"),
    };
    let lists = MessagePart::Where(Field::Check, pieces!["`", Field::Check, "` lists them"]);
    Some(message![what; lists])
}

/// A note on the components of a model that lie on the ground and so do not cast unless they are named.
fn note_covers(name: &str, contents: &ReadContents, components: &[Component]) -> Option<Message> {
    let covers = components.iter().zip(contents.covers(components.len())).filter(|(_, covers)| *covers);
    let names: Vec<String> = covers.map(|(component, _)| format!("\"{}\"", component.name)).collect();
    let (count, they) = match names.len() {
        0 => return None,
        1 => ("1 component that lies".to_owned(), "receives and does not cast"),
        more => (format!("{more} components that lie"), "receive and do not cast"),
    };
    Some(message![
        format!("{name} has {count} on the ground, {}, which {they}", few(names));
        setting("[[model]]", "casts", "`casts` under [[model]]"), " lets what it names cast"
    ])
}
