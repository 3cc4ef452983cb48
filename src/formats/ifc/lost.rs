//! Products that have a shape in the file and no triangles: what their shape is, so that whoever exported it can tell.

use super::super::LeftOut;
use super::scan::IfcProduct;
use ifc_lite_core::{DecodedEntity, EntityDecoder, IfcType};
use std::collections::BTreeMap;

/// How deep operands and repeated shapes are followed to name what they are made of.
const MAX_DEPTH: usize = 16;

/// Representations that are no body: axes, plans, boxes and the like.
const NOT_SOLID: [&str; 10] =
    ["Axis", "FootPrint", "Box", "Annotation", "Plan", "Profile", "Reference", "CoG", "Clearance", "Lighting"];

/// Whether a representation may be of a body.
pub(super) fn is_solid(representation: &DecodedEntity) -> bool {
    let identifier = representation.get_string(1).unwrap_or_default();
    !NOT_SOLID.iter().any(|other| identifier.eq_ignore_ascii_case(other))
}

/// The products without triangles, by type and by what their shape is.
pub(super) fn left_out(lost: &[&IfcProduct], decoder: &mut EntityDecoder) -> Vec<LeftOut> {
    let mut counts: BTreeMap<(String, String), u64> = BTreeMap::new();
    for product in lost {
        let why = match shape_of(product.shape, decoder) {
            Some(shape) => format!("their shape ({shape}) could not be built"),
            None => "they have lines, boxes or points alone".to_owned(),
        };
        *counts.entry((product.kind.name().to_owned(), why)).or_default() += 1;
    }
    counts.into_iter().map(|((what, why), count)| LeftOut { what, count, why }).collect()
}

/// What the first item of a product's body is made of: `IfcExtrudedAreaSolid of IfcEllipseProfileDef`.
fn shape_of(shape: u32, decoder: &mut EntityDecoder) -> Option<String> {
    let shape = decoder.decode_by_id(shape).ok()?;
    for id in shape.get_refs(2)? {
        let Ok(representation) = decoder.decode_by_id(id) else { continue };
        if is_solid(&representation) {
            let first = representation.get_refs(3).and_then(|items| items.first().copied());
            return Some(first.map_or_else(|| "no item".to_owned(), |item| item_name(item, decoder)));
        }
    }
    None
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
        // a chain of equal cuts is one name
        let name = record.ifc_type.name().to_owned();
        if names.last() != Some(&name) {
            names.push(name);
        }
    }
    names.join(" of ")
}
