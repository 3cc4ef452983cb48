//! Finds the relevant records in a file's text, and the position of each record, in one pass before shapes are built.

use ifc_lite_core::{EntityDecoder, EntityIndex, EntityScanner, IfcType};
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// The contents of a file.
#[derive(Default)]
pub(super) struct IfcScan {
    /// The position of each record.
    pub index: Arc<EntityIndex>,
    /// The products that are or may be built, in file order.
    pub products: Vec<IfcProduct>,
    /// The number of products with a shape, of types that are not built.
    pub apart: FxHashMap<String, u64>,
    /// Records of types that the reader does not know, each with the record that would be its shape.
    pub unknown: Vec<(String, u32)>,
    /// Relations of containment and of aggregation, whose records are read later.
    pub containing: Vec<u32>,
    pub composing: Vec<u32>,
    pub materials: Vec<u32>,
    /// The layers; those with a style may be off.
    pub layers: Vec<u32>,
    pub styled_layers: Vec<u32>,
    pub sites: Vec<u32>,
    pub contexts: Vec<u32>,
    /// Records that may give the model's position on a map.
    pub georeference: Vec<(u32, IfcType)>,
    /// The keyword positions of shapes that have an old name.
    pub old_shapes: Vec<(usize, usize)>,
    /// The number of records that could not be parsed.
    pub malformed: u64,
}

/// A product that has a shape.
pub(super) struct IfcProduct {
    pub id: u32,
    pub kind: IfcType,
    pub shape: u32,
}

/// The relevance of a keyword.
#[derive(Clone, PartialEq)]
enum RecordClass {
    Product { kind: IfcType, stands: bool },
    Unknown(String),
    Containing,
    Composing,
    Material,
    Layer,
    StyledLayer,
    Context,
    Georeference(IfcType),
    OldShape,
    Other,
}

/// The keyword that old exporters write instead of IFCPRODUCTDEFINITIONSHAPE, its subtype.
const OLD_SHAPE: &str = "IFCPRODUCTREPRESENTATION";

/// Types of products that are not physical: rooms, openings, annotations and the like.
fn stands_apart(kind: &IfcType) -> bool {
    use IfcType as Kind;
    [
        Kind::IfcSpace,
        Kind::IfcSpatialZone,
        Kind::IfcExternalSpatialStructureElement,
        Kind::IfcFeatureElementSubtraction,
        Kind::IfcVirtualElement,
        Kind::IfcPositioningElement,
        Kind::IfcGrid,
        Kind::IfcAnnotation,
        Kind::IfcPort,
        Kind::IfcStructuralActivity,
        Kind::IfcStructuralItem,
    ]
    .into_iter()
    .any(|apart| kind.is_subtype_of(apart))
}

fn class_of(keyword: &str) -> RecordClass {
    use IfcType as Kind;
    let upper = keyword.to_ascii_uppercase();
    let kind = Kind::from_str(&upper);
    match kind {
        _ if upper == OLD_SHAPE => RecordClass::OldShape,
        Kind::Unknown(_) => RecordClass::Unknown(keyword.to_owned()),
        Kind::IfcRelContainedInSpatialStructure => RecordClass::Containing,
        Kind::IfcRelAggregates | Kind::IfcRelNests => RecordClass::Composing,
        Kind::IfcRelAssociatesMaterial => RecordClass::Material,
        Kind::IfcPresentationLayerAssignment => RecordClass::Layer,
        Kind::IfcPresentationLayerWithStyle => RecordClass::StyledLayer,
        Kind::IfcGeometricRepresentationContext => RecordClass::Context,
        Kind::IfcMapConversion
        | Kind::IfcMapConversionScaled
        | Kind::IfcRigidOperation
        | Kind::IfcProjectedCRS
        | Kind::IfcGeographicCRS
        | Kind::IfcWellKnownText
        | Kind::IfcPropertySet
        | Kind::IfcProject => RecordClass::Georeference(kind),
        kind if kind.is_subtype_of(Kind::IfcProduct) => {
            let stands = !stands_apart(&kind);
            RecordClass::Product { kind, stands }
        }
        _ => RecordClass::Other,
    }
}

/// Scans a file's text.
pub(super) fn scan(text: &[u8]) -> IfcScan {
    let mut scan = IfcScan::default();
    let mut index = EntityIndex::default();
    let mut classes: FxHashMap<&str, RecordClass> = FxHashMap::default();
    let decoder = EntityDecoder::with_index(text, EntityIndex::default());
    let mut scanner = EntityScanner::new(text);
    let mut unread = 0;
    while let Some((id, keyword, start, end)) = scanner.next_entity() {
        index.insert(id, (start, end));
        let shape = || decoder.decode_at_uncached(start, end).map(|record| record.get_ref(6));
        match classes.entry(keyword).or_insert_with(|| class_of(keyword)) {
            RecordClass::Product { kind, stands } => {
                if *kind == IfcType::IfcSite {
                    scan.sites.push(id);
                }
                match shape() {
                    Ok(Some(shape)) if *stands => {
                        scan.products.push(IfcProduct { id, kind: kind.clone(), shape });
                    }
                    Ok(Some(_)) => *scan.apart.entry(kind.name().to_owned()).or_default() += 1,
                    Ok(None) => {}
                    Err(_) => unread += 1,
                }
            }
            RecordClass::Unknown(name) => {
                if let Ok(Some(shape)) = shape() {
                    scan.unknown.push((name.clone(), shape));
                }
            }
            RecordClass::Containing => scan.containing.push(id),
            RecordClass::Composing => scan.composing.push(id),
            RecordClass::Material => scan.materials.push(id),
            RecordClass::Layer => scan.layers.push(id),
            RecordClass::StyledLayer => scan.styled_layers.push(id),
            RecordClass::Context => scan.contexts.push(id),
            RecordClass::Georeference(kind) => scan.georeference.push((id, kind.clone())),
            RecordClass::OldShape => scan.old_shapes.extend(keyword_in(text, keyword, start)),
            RecordClass::Other => {}
        }
    }
    scan.malformed = unread + (scanner.skipped_oversized_ids() + scanner.malformed_record_starts().len()) as u64;
    scan.index = Arc::new(index);
    scan
}

/// The position of a record's keyword in the text.
fn keyword_in(text: &[u8], keyword: &str, start: usize) -> Option<(usize, usize)> {
    let at = text.get(start..)?.windows(keyword.len()).position(|word| word == keyword.as_bytes())?;
    Some((start + at, start + at + keyword.len()))
}

/// The text with the old names of shapes replaced by the one that the reader knows. Their attributes are the same.
pub(super) fn renamed(text: &[u8], old_shapes: &[(usize, usize)]) -> Vec<u8> {
    let mut renamed = Vec::with_capacity(text.len() + old_shapes.len());
    let mut from = 0;
    for &(start, end) in old_shapes {
        renamed.extend_from_slice(text.get(from..start).unwrap_or_default());
        renamed.extend_from_slice(b"IFCPRODUCTDEFINITIONSHAPE");
        from = end;
    }
    renamed.extend_from_slice(text.get(from..).unwrap_or_default());
    renamed
}
