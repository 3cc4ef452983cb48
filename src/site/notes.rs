//! Notes on where models stand, on requests far away from them, and on the precision of their numbers.

use super::likeness::{self, Mend};
use crate::mesh::{Component, CornerPrecision, Mesh};
use crate::message::{Message, MessagePart, kilometres, message, place_setting, set_to, setting};
use crate::view::{Grid, Probe};
use glam::{DVec2, DVec3};
use std::ops::Range;

/// The distance from the place beyond which its sun and its flat frame are no longer accurate, metres.
const FAR_M: f64 = 20_000.0;

/// A plan, a camera or a probe farther from the place than this gets a note, metres. It is beyond the size of a town,
/// and below any map coordinates.
const ASKED_FAR_M: f64 = 50_000.0;

/// The point from which far-away models are measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FarFrom {
    /// The place; a file gives the models' position on Earth.
    PlaceOnEarth,
    /// The place.
    Place,
    /// A file's own origin, as there is no place.
    OwnZero,
}

/// The note on all models together.
pub(super) fn of_all(mesh: &Mesh, from: FarFrom) -> Option<Message> {
    let distance = mesh.origin.truncate().length();
    (distance > FAR_M).then(|| {
        let far = kilometres(distance / 1000.0);
        let from_place = || format!("the models stand {far} from the place");
        match from {
            FarFrom::PlaceOnEarth => message![
                from_place();
                "the sun is that of the place: write ", place_setting("the latitude and longitude that are meant in [place]")
            ],
            FarFrom::Place => message![
                from_place();
                "if they are in map coordinates, write ", crs(), ", which turns them and moves them to the place, or ", position()
            ],
            FarFrom::OwnZero => message![
                format!("the models stand {far} from their own zero, as those in map coordinates do");
                "if they are, write ", crs(), ", which turns them to true north and has them where they are"
            ],
        }
    })
}

fn position() -> MessagePart {
    setting("[[model]]", "position", "`position`")
}

fn crs() -> MessagePart {
    set_to("[[model]]", "crs", "EPSG:…".to_owned(), "`crs = \"EPSG:…\"` under [[model]]".to_owned())
}

/// The notes on one of the models, each a sentence without a full stop that begins with its name.
/// `has_crs`: whether a reference system places it.
pub(super) fn of_model(
    mesh: &Mesh,
    model: &str,
    components: Range<usize>,
    mends: &[Mend],
    has_crs: bool,
) -> Vec<Message> {
    let components = &mesh.components[components];
    let mut notes = likeness::notes(model, mends);
    // with the wrong unit everything seems far away
    if !mends.iter().any(|mend| matches!(mend, Mend::Scale(_))) {
        notes.extend(far_off(mesh, model, components, has_crs).into_iter().chain(rounded(model, components)));
    }
    notes
}

/// Notes if the requested plan or camera seems to be in map coordinates. There is none if the models stand as far away,
/// as their own note says it.
pub(super) fn on_view(mesh: &Mesh, grid: &Grid, eye: Option<DVec3>) -> impl Iterator<Item = Message> {
    let [west, south, east, north] = grid.region();
    let middle = DVec2::new(west + east, south + north) / 2.0;
    let plan = asked_far("the middle of the plan lies", setting("[plan]", "region", "`region`"), middle);
    let camera =
        eye.and_then(|eye| asked_far("the camera stands", setting("[camera]", "eye", "`eye`"), eye.truncate()));
    let are_near = mesh.origin.truncate().length() <= ASKED_FAR_M;
    plan.into_iter().chain(camera).filter(move |_| are_near)
}

/// A note on the first probe that seems to be in map coordinates.
pub(super) fn on_probes(probes: &[Probe]) -> Option<Message> {
    let far = |probe: &Probe| {
        let point = setting("[[probe]]", "point", "`point`");
        asked_far(&format!("the probe '{}' lies", probe.name), point, probe.point.truncate())
    };
    probes.iter().find_map(far)
}

fn asked_far(what: &str, key: MessagePart, at: DVec2) -> Option<Message> {
    (at.length() > ASKED_FAR_M).then(|| {
        let far = kilometres(at.length() / 1000.0);
        message![
            format!("{what} {far} from the place");
            "if ", key, " is in map coordinates, write it in metres east and north of the place"
        ]
    })
}

/// A note on the parts of a model that stand far from everything else.
fn far_off(mesh: &Mesh, model: &str, components: &[Component], has_crs: bool) -> Option<Message> {
    let strays = |component: &Component| -> Vec<f64> {
        let faces = &mesh.faces[component.faces.start as usize..component.faces.end as usize];
        let away = |face: &[u32; 3]| {
            face.map(|vertex| if mesh.is_at_home(vertex) { 0.0 } else { away_m(mesh, vertex) })
                .into_iter()
                .fold(0.0, f64::max)
        };
        faces.iter().map(away).filter(|away| *away > 0.0).collect()
    };
    let of_component: Vec<(&Component, Vec<f64>)> = components
        .iter()
        .map(|component| (component, strays(component)))
        .filter(|(_, found)| !found.is_empty())
        .collect();
    let farthest = |found: &[f64]| found.iter().copied().fold(0.0, f64::max);
    let (worst, found) = of_component.iter().max_by(|one, other| farthest(&one.1).total_cmp(&farthest(&other.1)))?;
    let far = kilometres(farthest(found) / 1000.0);
    let triangles: usize = of_component.iter().map(|(_, found)| found.len()).sum();
    if triangles == components.iter().map(|component| component.faces.len()).sum::<usize>() {
        let what = format!("{model} stands {far} from everything else, and the default region and camera leave it out");
        if has_crs {
            return Some(message![what; "check that its reference system is the right one, or write ", position()]);
        }
        return Some(message![
            what;
            "if it is in map coordinates, write ", crs(), ", which turns it and moves it to the place, or ", position()
        ]);
    }
    let others = match of_component.len() - 1 {
        0 => String::new(),
        1 => " and another component".to_owned(),
        more => format!(" and {more} other components"),
    };
    let those = if triangles == 1 { "1 triangle".to_owned() } else { format!("{triangles} triangles") };
    Some(message![
        format!("{model} has {those} of '{}'{others} up to {far} from everything else", worst.name);
        "the default region and camera do not include it: delete it from the model if it is a leftover"
    ])
}

/// A vertex's distance from the box around what stands together, metres.
fn away_m(mesh: &Mesh, vertex: u32) -> f64 {
    let at = mesh.vertices[vertex as usize];
    let [low, high] = mesh.home();
    at.distance(at.clamp(low, high)).into()
}

/// A note if the numbers of a model are coarse.
fn rounded(model: &str, components: &[Component]) -> Option<Message> {
    let coarse = components.iter().filter_map(|component| Some((component, component.coarse.as_ref()?)));
    let (component, CornerPrecision { step_m, is_float, .. }) =
        coarse.max_by(|(_, one), (_, other)| one.step_m.total_cmp(&other.step_m))?;
    let (name, step) = (&component.name, metres(*step_m));
    Some(match is_float {
        true => message![
            format!(
                "{model} has corners rounded to {step} m, as their numbers are too large for single precision ('{name}')"
            );
            "no shadow of them can be more exact: move the origin close to the model before exporting it"
        ],
        false => message![
            format!("{model} has corners rounded to {step} m, as they are written in whole steps ('{name}')");
            "no shadow of them can be more exact: export the model without quantisation, or with more bits"
        ],
    })
}

/// A length in metres with two significant digits.
fn metres(length: f64) -> String {
    let digits = (1.0 - length.log10().floor()).clamp(0.0, 6.0) as usize;
    let text = format!("{length:.digits$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}
