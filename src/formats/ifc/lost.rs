//! Products that have a shape in the file but no triangles. The kind of shape is reported, so that the author of the
//! file can tell what is missing.

use super::super::LeftOut;
use super::scan::IfcProduct;
use ifc_lite_core::{DecodedEntity, EntityDecoder, IfcType};
use std::collections::BTreeMap;

/// How deeply operands and mapped shapes are followed to name their contents.
const MAX_DEPTH: usize = 16;

/// Representations that are not bodies: axes, plans, boxes and the like.
const NOT_SOLID: [&str; 10] =
    ["Axis", "FootPrint", "Box", "Annotation", "Plan", "Profile", "Reference", "CoG", "Clearance", "Lighting"];

/// Whether a representation may be a body.
pub(super) fn is_solid(representation: &DecodedEntity) -> bool {
    let identifier = representation.get_string(1).unwrap_or_default();
    !NOT_SOLID.iter().any(|other| identifier.eq_ignore_ascii_case(other))
}

/// Why a product has no triangles if its shape is missing in the file.
const MISSING: &str = "the records of the shape are missing";

/// Why a product has no triangles if it has no body.
const NO_BODY: &str = "only lines, boxes or points";

/// The products without triangles, by type and by kind of shape.
pub(super) fn left_out(lost: &[&IfcProduct], decoder: &mut EntityDecoder) -> Vec<LeftOut> {
    let mut counts: BTreeMap<(String, String), u64> = BTreeMap::new();
    for product in lost {
        let why = why(product.shape, decoder);
        *counts.entry((product.kind.name().to_owned(), why)).or_default() += 1;
    }
    counts.into_iter().map(|((what, why), count)| LeftOut { what, count, why }).collect()
}

/// What to do if no product has triangles, by what most products lack.
pub(super) fn way_out(lost: &[LeftOut]) -> &'static str {
    let of = |why: &str| lost.iter().filter(|left| left.why == why).map(|left| left.count).sum::<u64>();
    let all: u64 = lost.iter().map(|left| left.count).sum();
    let (missing, no_body) = (of(MISSING), of(NO_BODY));
    if missing > 0 && missing >= all - missing {
        "the records of their shapes are missing in the file: export it again"
    } else if no_body >= all - no_body {
        "it has only lines, boxes or points: export it with shapes as solids or as meshes"
    } else {
        "the reader cannot build these shapes: export them as meshes, or check the file with the program that wrote it"
    }
}

/// Why a product has no triangles: the contents of its body's first item, such as `IfcExtrudedAreaSolid of
/// IfcEllipseProfileDef`, which could not be built; or that there is no body.
fn why(shape: u32, decoder: &mut EntityDecoder) -> String {
    let Ok(shape) = decoder.decode_by_id(shape) else { return MISSING.to_owned() };
    let mut is_missing = false;
    for id in shape.get_refs(2).unwrap_or_default() {
        let Ok(representation) = decoder.decode_by_id(id) else {
            is_missing = true;
            continue;
        };
        if is_solid(&representation) {
            let first = representation.get_refs(3).and_then(|items| items.first().copied());
            return match first {
                Some(item) if decoder.decode_by_id(item).is_err() => MISSING.to_owned(),
                Some(item) => format!("shape that could not be built ({})", item_name(item, decoder)),
                None => "shape without an item".to_owned(),
            };
        }
    }
    if is_missing { MISSING } else { NO_BODY }.to_owned()
}

fn item_name(item: u32, decoder: &mut EntityDecoder) -> String {
    let mut names: Vec<String> = Vec::new();
    let mut at = Some(item);
    for _ in 0..MAX_DEPTH {
        let Some(id) = at else { break };
        let Ok(record) = decoder.decode_by_id(id) else {
            names.push(format!("a missing record #{id}"));
            break;
        };
        let repeated = |decoder: &mut EntityDecoder| {
            let map = decoder.decode_by_id(record.get_ref(0)?).ok()?;
            decoder.decode_by_id(map.get_ref(1)?).ok()?.get_refs(3)?.first().copied()
        };
        at = match record.ifc_type {
            IfcType::IfcMappedItem => repeated(decoder),
            IfcType::IfcBooleanResult | IfcType::IfcBooleanClippingResult => record.get_ref(1),
            _ if record.ifc_type.is_subtype_of(IfcType::IfcSweptAreaSolid) => record.get_ref(0),
            _ => None,
        };
        // a chain of cuts is named once
        let name = record.ifc_type.name().to_owned();
        if names.last() != Some(&name) {
            names.push(name);
        }
    }
    names.join(" of ")
}
