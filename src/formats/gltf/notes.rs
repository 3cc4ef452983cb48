//! The notes on a file: what was left out or skipped.

use super::document::Document;
use super::scene::{SceneContents, scenes};
use crate::message::{Message, few, message, setting};

/// The notes, each a sentence without a full stop whose subject is the file. `is_asked`: whether the user chose the
/// scene.
pub(super) fn of(document: &Document, standing: &SceneContents, is_asked: bool) -> Vec<Message> {
    let mut notes = Vec::new();
    let others = |number: usize| (0..document.scenes.len()).filter(move |&other| other != number);
    if let Some(number) = standing.scene.filter(|&number| !is_asked && others(number).next().is_some()) {
        notes.push(message![
            format!("has {} scenes, of which {} is read", document.scenes.len(), scenes(document, [number]));
            setting("[[model]]", "scene", "`scene` under [[model]] in a site file"),
            format!(" selects another, by name or number: {}", scenes(document, others(number)))
        ]);
    }
    if standing.hidden > 0 {
        let hiding = standing.hiding.iter().map(|&node| format!("\"{}\"", document.node_name(node)));
        let (nodes, are) = if standing.hidden == 1 { ("node", "is") } else { ("nodes", "are") };
        notes.push(message![format!(
            "has {} {nodes} with a mesh that {are} hidden (KHR_node_visibility) and left out, at {}",
            standing.hidden,
            few(hiding.collect()),
        )]);
    }
    let past: Vec<String> = document.read_past().map(str::to_owned).collect();
    if !past.is_empty() {
        let verb = if past.len() == 1 { "changes" } else { "change" };
        notes.push(message![format!("requires {}, which {verb} no shape, and so no shadow", few(past))]);
    }
    notes
}

/// What to do if the scene has no triangles.
pub(super) fn way_out(document: &Document, standing: &SceneContents) -> String {
    let is_other = |&other: &usize| Some(other) != standing.scene;
    let mut others = (0..document.scenes.len()).filter(is_other).peekable();
    if standing.hidden > 0 {
        "all nodes with meshes are hidden (KHR_node_visibility); show them, and export the model again".into()
    } else if others.peek().is_some() {
        format!("read another scene with `scene` under [[model]] in a site file: {}", scenes(document, others))
    } else {
        "export the visible faces as a mesh".into()
    }
}
