//! The result of `gnomon check`: JSON, and a table of the parts that are not clean with their most important defects.

use super::contents::{self, MostLines};
use super::model_lines::{self, ModelLines};
use super::places::{self, DefectKind};
use super::{ExportError, report};
use crate::formats::Up;
use crate::mesh::Mesh;
use crate::mesh::report::ComponentReport;
use crate::message::{Field, Message, Words, message};
use crate::site::{CoordinateFrame, ModelContents, ModelReference};
use serde::Serialize;
use serde_json::Value;
use std::fmt::Write;

/// A table is cut to about this many rows, one screen, unless all are requested.
const MOST_ROWS: usize = 40;
/// The number of rows that are always there, and of those that each kind of defect needs for its worst places.
const FIXED_ROWS: usize = 11;
const PLACES_A_KIND: usize = 3;

#[derive(Serialize)]
struct MeshReport<'a> {
    triangles: usize,
    vertices: usize,
    #[serde(flatten)]
    models: ModelLines<'a>,
    frame: &'static str,
    components: Vec<ComponentLine<'a>>,
    notes: Vec<String>,
}

#[derive(Serialize)]
struct ComponentLine<'a> {
    name: &'a str,
    triangles: usize,
    closed: bool,
    open_edges: usize,
    crowded_edges: usize,
    flipped_edges: usize,
    degenerate_triangles: usize,
    duplicate_triangles: usize,
    t_junctions: usize,
    places: Value,
}

/// The checked mesh: all models of a site together.
#[derive(Clone, Copy, Debug)]
pub struct CheckedMesh<'a> {
    /// The mesh of all models, welded.
    pub mesh: &'a Mesh,
    /// The defects of each part.
    pub components: &'a [ComponentReport],
    /// The coordinate frame of the mesh.
    pub frame: CoordinateFrame,
    /// Notes from reading the models.
    pub notes: &'a [Message],
    /// The content of each file.
    pub models: &'a [ModelContents],
    /// The georeference of each model.
    pub references: &'a [ModelReference],
}

/// How much a table lists.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableExtent {
    /// The most important, on about one screen.
    Screen,
    /// Everything: all names, all that was left out, and all parts that are not clean.
    Whole,
}

/// The JSON of `gnomon check`: triangles as in the files, vertices as welded, and the places of defects.
///
/// # Errors
/// [`ExportError::Encode`] if the encoder fails.
pub fn json(checked: CheckedMesh<'_>, words: &dyn Words) -> Result<String, ExportError> {
    let CheckedMesh { mesh, components, frame, notes, models, references } = checked;
    let lines = components.iter().map(|component| ComponentLine {
        name: &component.name,
        triangles: component.triangles,
        closed: component.closed,
        open_edges: component.open_edges,
        crowded_edges: component.crowded_edges,
        flipped_edges: component.flipped_edges,
        degenerate_triangles: component.degenerate_triangles,
        duplicate_triangles: component.duplicate_triangles,
        t_junctions: component.t_junctions,
        places: places::json(&component.places),
    });
    report::json(&MeshReport {
        triangles: triangles(components),
        vertices: mesh.vertices.len(),
        models: ModelLines::of(references, models),
        frame: places::frame(frame, is_turned(references)),
        components: lines.collect(),
        notes: report::said(notes, words),
    })
}

/// Whether a file has y up.
fn is_turned(references: &[ModelReference]) -> bool {
    references.iter().any(|model| model.up == Up::Y)
}

/// The totals and how the models were read, then a line for each part that is not clean, the meaning of the words, and
/// the worst places. Ends with a line break.
pub fn table(checked: CheckedMesh<'_>, extent: TableExtent, words: &dyn Words) -> String {
    let CheckedMesh { mesh, components, frame, notes, models, references } = checked;
    let mut table = format!(
        "{}, {}, {}\n",
        counted(components.len(), "component", "components"),
        counted(triangles(components), "triangle", "triangles"),
        counted(mesh.vertices.len(), "vertex", "vertices"),
    );
    let most = match extent {
        TableExtent::Screen => MostLines::OrSee(Field::All),
        TableExtent::Whole => MostLines::All,
    };
    table.push_str(&contents::table(models, most, words));
    table.push_str(&model_lines::table(references));
    for note in notes {
        // Writing to a String cannot fail.
        let _ = writeln!(table, "note: {}", plain(&note.in_words(words)));
    }
    let mut dirty: Vec<_> = components.iter().filter(|component| !component.clean()).collect();
    if dirty.is_empty() {
        table.push_str("nothing wrong: every component is closed and well wound\n");
        return table;
    }
    dirty.sort_by(|one, other| faulty_m(other).total_cmp(&faulty_m(one)));
    let sum = |kind: &DefectKind| dirty.iter().map(|component| (kind.count)(component)).sum::<usize>();
    let kinds: Vec<&DefectKind> = places::KINDS.iter().filter(|kind| sum(kind) > 0).collect();
    rows(&mut table, &dirty, &kinds, extent, words);
    let clean = components.len() - dirty.len();
    let _ = writeln!(
        table,
        "\n{} not clean, {clean} clean; where: {}",
        dirty.len(),
        places::frame(frame, is_turned(references))
    );
    for kind in kinds {
        let _ = writeln!(table, "{} ({}): {}", kind.head, sum(kind), kind.meaning);
        let mut worst: Vec<(f64, &str, String)> = Vec::new();
        for component in &dirty {
            let places = (kind.places)(&component.places, PLACES_A_KIND);
            worst.extend(places.into_iter().map(|(length_m, words)| (length_m, component.name.as_str(), words)));
        }
        worst.sort_by(|one, other| other.0.total_cmp(&one.0));
        for (_, name, words) in worst.into_iter().take(PLACES_A_KIND) {
            let _ = writeln!(table, "  {}: {words}", plain(name));
        }
    }
    table.push_str(&shadows(mesh));
    table
}

/// What the defects mean for shadows: nothing, unless welding has changed triangles.
fn shadows(mesh: &Mesh) -> String {
    let flattened: usize = mesh.components.iter().map(|component| component.flattened).sum();
    let is_coarse = mesh.components.iter().any(|component| component.coarse.is_some());
    match (flattened, is_coarse) {
        (0, false) => "their shadows are still right: every triangle casts its own\n".to_owned(),
        (0, true) => "every triangle casts its own shadow, as it is rounded in the file\n".to_owned(),
        (1, _) => {
            "every triangle casts its own shadow except one, which became flat when coincident corners were joined\n"
                .to_owned()
        }
        (more, _) => format!(
            "every triangle casts its own shadow except {more}, which became flat when coincident corners were joined\n"
        ),
    }
}

/// One line per component, the worst first.
fn rows(table: &mut String, dirty: &[&ComponentReport], kinds: &[&DefectKind], extent: TableExtent, words: &dyn Words) {
    let most = match extent {
        TableExtent::Screen => MOST_ROWS.saturating_sub(FIXED_ROWS + kinds.len() * (1 + PLACES_A_KIND)),
        TableExtent::Whole => usize::MAX,
    };
    let shown = &dirty[..dirty.len().min(most)];
    let width = shown.iter().map(|component| plain(&component.name).chars().count()).max().unwrap_or(0).max(9);
    // Writing to a String cannot fail.
    let _ = write!(table, "\n{:<width$}  {:>9}", "component", "triangles");
    for kind in kinds {
        let _ = write!(table, "  {:>10}", kind.head);
    }
    table.push('\n');
    for component in shown {
        let _ = write!(table, "{:<width$}  {:>9}", plain(&component.name), component.triangles);
        for kind in kinds {
            let _ = write!(table, "  {:>10}", (kind.count)(component));
        }
        table.push('\n');
    }
    if dirty.len() > shown.len() {
        let more = message![format!("… and {} more", dirty.len() - shown.len()); Field::All, " lists all"];
        let _ = writeln!(table, "{}", more.in_words(words));
    }
}

/// The total length of defective edges, metres; the table is sorted by it.
fn faulty_m(component: &ComponentReport) -> f64 {
    let places = &component.places;
    let edges = places.crowded.iter().chain(&places.flipped).map(|edge| edge.length_m);
    places.open.iter().map(|open| open.length_m).chain(edges).sum()
}

/// A name without characters that would break the line.
fn plain(name: &str) -> String {
    name.replace(char::is_control, " ")
}

fn triangles(components: &[ComponentReport]) -> usize {
    components.iter().map(|component| component.triangles).sum()
}

fn counted(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}
