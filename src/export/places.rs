//! The kinds of defects in a mesh, and their places: in words that help to mend the model, and as JSON.

use crate::mesh::report::{ComponentReport, EdgePlace, FacePlace, OpenKind, OpenPlace, Places};
use crate::site::CoordinateFrame;
use glam::DVec3;
use serde_json::{Map, Value, json};

/// One kind of defect.
pub(super) struct DefectKind {
    /// Its name.
    pub(super) head: &'static str,
    /// The number of these defects in a component.
    pub(super) count: fn(&ComponentReport) -> usize,
    /// What it means.
    pub(super) meaning: &'static str,
    /// The longest places, at most as many as given: length in metres, and description.
    pub(super) places: fn(&Places, usize) -> Vec<(f64, String)>,
}

pub(super) const KINDS: [DefectKind; 6] = [
    DefectKind {
        head: "open",
        count: |part| part.open_edges,
        meaning: "edges with one face: the part bounds no solid, something may be missing",
        places: |places, most| places.open.iter().take(most).map(|place| (place.length_m, open(place))).collect(),
    },
    DefectKind {
        head: "T-junction",
        count: |part| part.t_junctions,
        meaning: "corners within an open edge that is not split there: the faces only seem to meet",
        places: |places, most| {
            let words =
                |at: DVec3, edge: &EdgePlace| format!("corner at {} within the {}", point(at), line("edge", edge));
            let found = places.t_junctions.iter().take(most);
            found.map(|found| (found.edge.length_m, words(found.at, &found.edge))).collect()
        },
    },
    DefectKind {
        head: "crowded",
        count: |part| part.crowded_edges,
        meaning: "edges with more than two faces: walls meet inside of the part",
        places: |places, most| {
            let words = |edge: &EdgePlace| format!("{}, with {} faces", line("edge", edge), edge.faces);
            places.crowded.iter().take(most).map(|edge| (edge.length_m, words(edge))).collect()
        },
    },
    DefectKind {
        head: "flipped",
        count: |part| part.flipped_edges,
        meaning: "edges whose two faces face opposite sides: one is wound wrongly",
        places: |places, most| {
            places.flipped.iter().take(most).map(|edge| (edge.length_m, line("edge", edge))).collect()
        },
    },
    DefectKind {
        head: "degenerate",
        count: |part| part.degenerate_triangles,
        meaning: "triangles without area",
        places: |places, most| places.degenerate.iter().take(most).map(triangle).collect(),
    },
    DefectKind {
        head: "duplicate",
        count: |part| part.duplicate_triangles,
        meaning: "triangles that coincide with another one",
        places: |places, most| places.duplicate.iter().take(most).map(triangle).collect(),
    },
];

/// The coordinate frame of places, in words; `is_turned` if the file has y up.
pub(super) fn frame(frame: CoordinateFrame, is_turned: bool) -> &'static str {
    match frame {
        CoordinateFrame::Place => "metres east, north, up from the place",
        CoordinateFrame::Model if is_turned => "metres along the file's own axes, turned z up (x, −z, y of the file)",
        CoordinateFrame::Model => "metres along the file's own axes",
    }
}

fn open(place: &OpenPlace) -> String {
    let OpenPlace { kind, edges, length_m, from, to, near } = place;
    let (long, near) = (length(*length_m), point(*near));
    let [from, to] = [from, to].map(|end| point(*end));
    match kind {
        OpenKind::Edge => format!("open edge {long} long from {from} to {to}"),
        OpenKind::Hole => format!("a hole of {edges} edges, {long} around, near {near}"),
        OpenKind::Rim => format!("an open sheet with a rim of {edges} edges, {long} around, near {near}"),
        OpenKind::Seam => {
            let long = length(length_m / 2.0);
            format!("a seam of {edges} edges that coincide but are not joined, {long} long, near {near}")
        }
        OpenKind::Run => format!("{edges} open edges in a row, {long} long, from {from} to {to}"),
        OpenKind::Net => format!("{edges} open edges that branch, {long} long, near {near}"),
    }
}

fn line(what: &str, EdgePlace { from, to, length_m, .. }: &EdgePlace) -> String {
    format!("{what} {} long from {} to {}", length(*length_m), point(*from), point(*to))
}

fn triangle(FacePlace { near, length_m }: &FacePlace) -> (f64, String) {
    (*length_m, format!("triangle {} long near {}", length(*length_m), point(*near)))
}

/// A length in metres, or in millimetres if it is short.
fn length(metres: f64) -> String {
    if metres < 0.1 { format!("{:.1} mm", metres * 1000.0) } else { format!("{metres:.2} m") }
}

/// A point to the millimetre.
fn point(at: DVec3) -> String {
    // + 0 turns −0 into 0
    let [x, y, z] = at.to_array().map(|metres| (metres * 1e3).round() / 1e3 + 0.0);
    format!("({x:.3}, {y:.3}, {z:.3})")
}

/// The places of a component in JSON: one list for each kind that it has.
pub(super) fn json(places: &Places) -> Value {
    let edge = |edge: &EdgePlace| json!({"from": at(edge.from), "to": at(edge.to), "length_m": edge.length_m});
    let triangle = |place: &FacePlace| json!({"near": at(place.near), "length_m": place.length_m});
    let open = places.open.iter().map(|place| {
        json!({
            "kind": word(place.kind), "edges": place.edges, "length_m": place.length_m,
            "from": at(place.from), "to": at(place.to), "near": at(place.near),
        })
    });
    let t_junctions = places.t_junctions.iter().map(|found| {
        let mut place = edge(&found.edge);
        place["at"] = at(found.at);
        place
    });
    let crowded = places.crowded.iter().map(|crowded| {
        let mut place = edge(crowded);
        place["faces"] = json!(crowded.faces);
        place
    });
    let lists: [(&str, Vec<Value>); 6] = [
        ("open", open.collect()),
        ("t_junctions", t_junctions.collect()),
        ("crowded", crowded.collect()),
        ("flipped", places.flipped.iter().map(edge).collect()),
        ("degenerate", places.degenerate.iter().map(triangle).collect()),
        ("duplicate", places.duplicate.iter().map(triangle).collect()),
    ];
    let found = lists.into_iter().filter(|(_, list)| !list.is_empty());
    Value::Object(found.map(|(kind, list)| (kind.to_owned(), Value::Array(list))).collect::<Map<_, _>>())
}

fn word(kind: OpenKind) -> &'static str {
    match kind {
        OpenKind::Edge => "edge",
        OpenKind::Hole => "hole",
        OpenKind::Rim => "rim",
        OpenKind::Seam => "seam",
        OpenKind::Run => "run",
        OpenKind::Net => "net",
    }
}

/// A point in metres, to the micrometre.
fn at(point: DVec3) -> Value {
    json!(point.to_array().map(|metres| (metres * 1e6).round() / 1e6 + 0.0))
}
