//! Makes a model of a file's text: the products that the reader builds, and notes on the others.

use super::super::{Coordinates, LeftOut, MAX_COMPONENTS, MAX_TRIANGLES, Model, ModelFault, ReadOptions, Up};
use super::anchors::{self, IfcFrame};
use super::container::IfcText;
use super::layers::IfcLayers;
use super::lost;
use super::marks::{is_ifc_text, is_whole};
use super::parts::IfcParts;
use super::relations::IfcRelations;
use super::scan::{IfcProduct, IfcScan, renamed, scan};
use crate::message::{Message, few, message, pieces};
use ifc_lite_core::{EntityDecoder, IfcType};
use ifc_lite_processing::{Batching, Features, ProcessingRequest, ProcessingResult, process, run_on_geometry_pool};
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::Ordering;

/// Why rooms and openings are left out.
const NOT_STANDING: &str = "not built";

/// The number of products that are built at once, before their meshes become parts.
const BATCH: usize = 400;

/// The model of a file.
pub(super) fn model(file: IfcText, options: &ReadOptions) -> Result<Model, ModelFault> {
    // the reader would print this; it is counted below instead
    ifc_lite_core::set_report_sink(|_| {});
    let is_one_of_several = !file.ignored.is_empty();
    let read = || run_on_geometry_pool(|| read(file, options));
    let model = match catch_unwind(AssertUnwindSafe(read)) {
        Ok(Ok(model)) => model,
        Ok(Err(error)) => Err(message![format!("cannot be read: {error}")].into()),
        Err(_) => Err(message![
            "makes the reader of IFC fail";
            "check it with the program that wrote it, and export it again"
        ]
        .into()),
    };
    model.map_err(|fault| if is_one_of_several { first_of_several(fault) } else { fault })
}

/// The error in the first model of an archive: another one may be meant.
fn first_of_several(fault: ModelFault) -> ModelFault {
    let ModelFault::Unusable(Message { what, hint }) = fault else { return fault };
    let another = if hint.is_empty() { "unpack it to open another" } else { ", or unpack it to open another" };
    Message {
        what: [pieces!["is an archive of several models, of which the first "], what].concat(),
        hint: [hint, pieces![another]].concat(),
    }
    .into()
}

fn read(file: IfcText, options: &ReadOptions) -> Result<Model, ModelFault> {
    let (text, scan, mut notes) = prepared(file)?;
    // a decoder caches its records, so each pass has its own
    let decoder = || EntityDecoder::with_arc_index(&text, scan.index.clone());
    let layers = IfcLayers::of(&scan, &mut decoder());
    let relations = IfcRelations::of(&scan, &mut decoder());
    let asked: Vec<&IfcProduct> =
        scan.products.iter().filter(|product| !layers.products.contains(&product.id)).collect();
    let known = asked.iter().map(|product| (product.id, (product.kind.clone(), product.shape))).collect();
    let mut parts = IfcParts::new(known, decoder(), relations, layers);
    let made = shapes(&text, &scan, &asked, &mut parts)?;
    let lost: Vec<&IfcProduct> = asked.iter().copied().filter(|product| !parts.meshed.contains(&product.id)).collect();
    let count = count_note(asked.len(), &lost);
    let lost = lost::left_out(&lost, &mut decoder());
    if parts.meshed.is_empty() && !asked.is_empty() {
        return Err(Message { hint: message![""; lost::way_out(&lost)].hint, ..count }.into());
    }
    notes.insert(0, count);
    notes.extend(loss_notes(&scan, &parts, &made));
    let frame = frame_of(&made);
    let is_unit_said = frame.unit_m != 1.0 || says_unit(&scan, &mut decoder());
    if !is_unit_said {
        notes.push(message!["gives no unit of length, so its numbers are taken as metres"]);
    }
    parts.in_units_of_file(frame.unit_m, options.told_step(frame.unit_m));
    let places = anchors::of(&scan, &frame, &mut decoder());
    notes.extend(places.notes);
    let mut left_out = left_out(&scan, &parts);
    left_out.extend(lost);
    left_out.extend(unknown(&scan, &mut decoder()));
    Ok(Model {
        parts: parts.parts,
        kinds: parts.kinds,
        up: Up::Z,
        up_is_said: true,
        unit_m: is_unit_said.then_some(frame.unit_m),
        coordinates: Coordinates::Local,
        anchors: places.anchors,
        assumed_map_unit_m: places.assumed_map_unit_m,
        left_out,
        notes,
        see_through: parts.see_through,
        ..Model::default()
    })
}

/// A file's text as the reader needs it, its contents, and notes on them.
fn prepared(file: IfcText) -> Result<(Vec<u8>, IfcScan, Vec<Message>), ModelFault> {
    let mut text = file.bytes;
    if !is_ifc_text(&text) {
        return Err(message!["is no IFC file, whatever its name says"; "export it again as IFC 2x3, 4 or 4.3"].into());
    }
    if !is_whole(&text) {
        return Err(message!["is cut off: its end is missing"; "copy or export it again"].into());
    }
    let mut found = scan(&text);
    let mut notes = Vec::new();
    if !file.ignored.is_empty() {
        let what = format!("is an archive of several models; the first is read, not {}", few(file.ignored));
        notes.push(message![what; "unpack it to open the others"]);
    }
    if !found.old_shapes.is_empty() {
        let count = found.old_shapes.len();
        text = renamed(&text, &found.old_shapes);
        found = scan(&text);
        notes.push(message![format!(
            "calls shapes IFCPRODUCTREPRESENTATION ({count}), which is read as IFCPRODUCTDEFINITIONSHAPE"
        )]);
    }
    if found.index.is_empty() {
        return Err(message!["has no records that can be read"; "export it again as IFC 2x3, 4 or 4.3"].into());
    }
    Ok((text, found, notes))
}

/// Builds the shapes of the requested products as parts.
fn shapes(
    text: &[u8],
    scan: &IfcScan,
    asked: &[&IfcProduct],
    parts: &mut IfcParts,
) -> Result<ProcessingResult, ModelFault> {
    let request = ProcessingRequest::full_pass()
        .batching(Batching::new(BATCH, BATCH))
        .features(Features::default().properties(false))
        .retain_meshes(false)
        .ids(Some(Arc::new(asked.iter().map(|product| product.id).collect())))
        .index(scan.index.clone())
        .cancel(parts.stop.clone());
    let made = process(text, &request, parts);
    if let Some(unit) = made.metadata.length_unit_refused {
        let what = format!("has a unit of length that is not a number, in #{unit}");
        return Err(message![what; "export it again in metres"].into());
    }
    if parts.stop.load(Ordering::Relaxed) {
        let what = format!("has more than {MAX_TRIANGLES} triangles or {MAX_COMPONENTS} components");
        return Err(message![what; "export it storey by storey"].into());
    }
    Ok(made)
}

/// Whether the file says a unit of length.
fn says_unit(scan: &IfcScan, decoder: &mut EntityDecoder) -> bool {
    let mut units = || {
        let (project, _) = scan.georeference.iter().find(|(_, kind)| *kind == IfcType::IfcProject)?;
        let assignment = decoder.decode_by_id(*project).ok()?.get_ref(8)?;
        decoder.decode_by_id(assignment).ok()?.get_refs(0)
    };
    let units = units().unwrap_or_default();
    let is_length = |unit: &u32| {
        let kind = decoder.decode_by_id(*unit).ok().and_then(|unit| unit.get(1)?.as_enum().map(str::to_owned));
        kind.is_some_and(|kind| kind.eq_ignore_ascii_case("LENGTHUNIT"))
    };
    units.iter().any(is_length)
}

/// What the reader found about units and the site.
fn frame_of(made: &ProcessingResult) -> IfcFrame {
    let site = made.site_transform.as_deref().and_then(|matrix| matrix.get(12..15)?.try_into().ok());
    let site = site.filter(|at: &[f64; 3]| at.iter().all(|number| number.is_finite()));
    IfcFrame { unit_m: made.metadata.length_unit_scale.unwrap_or(1.0), site }
}

/// A note, always given, on the number of products with a shape, and those without.
fn count_note(asked: usize, lost: &[&IfcProduct]) -> Message {
    let mut counts: BTreeMap<&str, u64> = BTreeMap::new();
    for product in lost {
        *counts.entry(product.kind.name()).or_default() += 1;
    }
    let mut counts: Vec<(&str, u64)> = counts.into_iter().collect();
    counts.sort_by_key(|&(_, count)| std::cmp::Reverse(count));
    let types = counts.into_iter().map(|(name, count)| format!("{name} {count}")).collect::<Vec<_>>().join(", ");
    let shaped = match asked - lost.len() {
        0 => "no product with a shape".to_owned(),
        1 => "1 product with a shape".to_owned(),
        many => format!("{many} products with a shape"),
    };
    let others = match (lost.len(), asked - lost.len()) {
        (0, _) => String::new(),
        (1, 0) => format!("; 1 product has no geometry ({types})"),
        (1, _) => format!("; 1 further product has no geometry ({types})"),
        (many, 0) => format!("; {many} products have no geometry ({types})"),
        (many, _) => format!("; {many} further products have no geometry ({types})"),
    };
    message![format!("has {shaped}{others}")]
}

/// Notes on what is missing of products that were built.
fn loss_notes(scan: &IfcScan, parts: &IfcParts, made: &ProcessingResult) -> Vec<Message> {
    let mut notes = Vec::new();
    if let Some(found) = &made.stats.geometry_diagnostics {
        let lost = found.unsupported_items_by_type.iter().map(|kind| format!("{} {}", kind.reason, kind.count));
        let lost: Vec<String> = lost.collect();
        if !lost.is_empty() {
            notes.push(message![format!("has pieces of shapes that could not be built: {}", few(lost))]);
        }
        // the reader's remarks on results that it accepted
        let is_failure = |reason: &str| reason != "KernelError" && reason != "NoBoundsOverlap";
        let failures: Vec<String> = found
            .failures_by_reason
            .iter()
            .filter(|kind| is_failure(&kind.reason))
            .map(|kind| format!("{} {}", kind.reason, kind.count))
            .collect();
        if !failures.is_empty() {
            notes.push(message![format!(
                "has cuts that failed or are approximate, so a wall may lack an opening: {}",
                few(failures)
            )]);
        }
    }
    let refused = scan.malformed.max(made.stats.refused_input_elements);
    if refused > 0 {
        let what = match refused {
            1 => "has 1 record that cannot be read, so what it describes is missing".to_owned(),
            many => format!("has {many} records that cannot be read, so what they describe is missing"),
        };
        notes.push(message![what; "export it again"]);
    }
    if parts.cut_names > 0 {
        notes.push(message![format!("has names of more than 1000 bytes ({}), which are shortened", parts.cut_names)]);
    }
    notes
}

/// What was not built, what is hidden, and what is broken.
fn left_out(scan: &IfcScan, parts: &IfcParts) -> Vec<LeftOut> {
    let mut apart: Vec<LeftOut> = scan
        .apart
        .iter()
        .map(|(what, &count)| LeftOut { what: what.clone(), count, why: NOT_STANDING.to_owned() })
        .collect();
    apart.sort_by(|one, other| one.what.cmp(&other.what));
    apart.extend(parts.layers.counts.iter().map(|(layer, &count)| LeftOut {
        what: format!("layer \"{layer}\""),
        count,
        why: "switched off or frozen in the file".to_owned(),
    }));
    if parts.broken > 0 {
        let why = "a corner is not a point".to_owned();
        apart.push(LeftOut { what: "shape".to_owned(), count: parts.broken, why });
    }
    apart
}

/// Records of types that the reader does not know, if they have a shape.
fn unknown(scan: &IfcScan, decoder: &mut EntityDecoder) -> Vec<LeftOut> {
    let mut counts: BTreeMap<&str, u64> = BTreeMap::new();
    for (name, shape) in &scan.unknown {
        let is_shape = decoder
            .decode_by_id(*shape)
            .is_ok_and(|record| record.ifc_type.is_subtype_of(IfcType::IfcProductRepresentation));
        if is_shape {
            *counts.entry(name).or_default() += 1;
        }
    }
    let why = "of a type that the reader does not know";
    counts.into_iter().map(|(what, count)| LeftOut { what: what.to_owned(), count, why: why.to_owned() }).collect()
}
