//! What `gnomon check` says of a mesh: `check --json`, and a table of the parts that are not clean.

use super::{ExportError, report};
use crate::mesh::Mesh;
use crate::mesh::report::ComponentReport;
use serde::Serialize;
use std::fmt::Write;

/// Longer tables are cut; `--json` has all.
const MOST_ROWS: usize = 40;

#[derive(Serialize)]
struct MeshReport<'a> {
    triangles: usize,
    vertices: usize,
    components: Vec<ComponentLine<'a>>,
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
}

/// `check --json`: triangles as the files have them, vertices as welded.
///
/// # Errors
/// [`ExportError::Encode`] where the encoder refuses.
pub fn json(mesh: &Mesh, components: &[ComponentReport]) -> Result<String, ExportError> {
    let lines = components.iter().map(|component| ComponentLine {
        name: &component.name,
        triangles: component.triangles,
        closed: component.closed,
        open_edges: component.open_edges,
        crowded_edges: component.crowded_edges,
        flipped_edges: component.flipped_edges,
        degenerate_triangles: component.degenerate_triangles,
        duplicate_triangles: component.duplicate_triangles,
    });
    report::json(&MeshReport {
        triangles: triangles(components),
        vertices: mesh.vertices.len(),
        components: lines.collect(),
    })
}

/// A number of a row: its head, the number itself, and what it means.
type Column = (&'static str, fn(&ComponentReport) -> usize, &'static str);

const COLUMNS: [Column; 5] = [
    ("open", |part| part.open_edges, "edges with one face: the part bounds no solid, something may be missing"),
    ("crowded", |part| part.crowded_edges, "edges with more than two faces: walls meet inside of the part"),
    ("flipped", |part| part.flipped_edges, "edges whose two faces look to different sides: one is wound wrongly"),
    ("degenerate", |part| part.degenerate_triangles, "triangles without area"),
    ("duplicate", |part| part.duplicate_triangles, "triangles that lie on another one"),
];

/// The totals, then a line a part that is not clean, then what the words mean; ends with a line break.
pub fn table(mesh: &Mesh, components: &[ComponentReport]) -> String {
    let mut table = format!(
        "{}, {}, {}\n",
        counted(components.len(), "component", "components"),
        counted(triangles(components), "triangle", "triangles"),
        counted(mesh.vertices.len(), "vertex", "vertices"),
    );
    let dirty: Vec<_> = components.iter().filter(|component| !component.clean()).collect();
    if dirty.is_empty() {
        table.push_str("nothing wrong: every component is closed and well wound\n");
        return table;
    }
    let shown = &dirty[..dirty.len().min(MOST_ROWS)];
    let name = |component: &ComponentReport| component.name.replace(char::is_control, " ");
    let width = shown.iter().map(|component| name(component).chars().count()).max().unwrap_or(0).max(9);
    // Writing to a String cannot fail.
    let _ = write!(table, "\n{:<width$}  {:>9}", "component", "triangles");
    for (head, ..) in COLUMNS {
        let _ = write!(table, "  {head:>10}");
    }
    table.push('\n');
    for component in shown {
        let _ = write!(table, "{:<width$}  {:>9}", name(component), component.triangles);
        for (_, count, _) in COLUMNS {
            let _ = write!(table, "  {:>10}", count(component));
        }
        table.push('\n');
    }
    if dirty.len() > shown.len() {
        let _ = writeln!(table, "… and {} more; --json has all", dirty.len() - shown.len());
    }
    let clean = components.len() - dirty.len();
    let _ = writeln!(table, "\n{} not clean, {clean} clean", dirty.len());
    for (head, count, meaning) in COLUMNS {
        let sum: usize = dirty.iter().map(|component| count(component)).sum();
        if sum > 0 {
            let _ = writeln!(table, "{head} ({sum}): {meaning}");
        }
    }
    table.push_str("their shadows are right all the same: every triangle casts its own\n");
    table
}

fn triangles(components: &[ComponentReport]) -> usize {
    components.iter().map(|component| component.triangles).sum()
}

fn counted(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}
