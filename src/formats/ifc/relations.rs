//! The storey and the materials of a product: names that select its parts.

use super::scan::IfcScan;
use ifc_lite_core::{DecodedEntity, EntityDecoder, IfcType};
use rustc_hash::FxHashMap;

/// How deeply wholes and parts are followed; a file may contain cycles.
const MAX_DEPTH: usize = 64;

/// The most materials in a product's set; each is a name that selects it.
const MAX_MATERIALS: usize = 64;

/// What products belong to.
#[derive(Default)]
pub(super) struct IfcRelations {
    /// The whole, or the spatial container, of a product.
    above: FxHashMap<u32, u32>,
    /// The record of its materials.
    material: FxHashMap<u32, u32>,
    storeys: FxHashMap<u32, Option<String>>,
    names: FxHashMap<u32, Vec<String>>,
}

/// A name that is not empty.
fn name_of(record: &DecodedEntity, at: usize) -> Option<String> {
    ifc_lite_core::optional_text(record.get_string(at)).map(str::to_owned)
}

impl IfcRelations {
    /// Reads the relations of a file.
    pub(super) fn of(scan: &IfcScan, decoder: &mut EntityDecoder) -> Self {
        let mut relations = IfcRelations::default();
        // containment has priority over aggregation
        for (records, above, below) in [(&scan.containing, 5, 4), (&scan.composing, 4, 5)] {
            for &id in records {
                let Ok(record) = decoder.decode_by_id(id) else { continue };
                let (Some(above), Some(below)) = (record.get_ref(above), record.get_refs(below)) else { continue };
                for id in below {
                    relations.above.entry(id).or_insert(above);
                }
            }
        }
        for &id in &scan.materials {
            let Ok(record) = decoder.decode_by_id(id) else { continue };
            let (Some(of), Some(material)) = (record.get_refs(4), record.get_ref(5)) else { continue };
            relations.material.extend(of.into_iter().map(|id| (id, material)));
        }
        relations
    }

    /// The name of a product's storey, or of its part of a bridge or road.
    pub(super) fn storey(&mut self, product: u32, decoder: &mut EntityDecoder) -> Option<String> {
        let mut at = product;
        for _ in 0..MAX_DEPTH {
            at = *self.above.get(&at)?;
            let storey = self.storeys.entry(at).or_insert_with(|| {
                let record = decoder.decode_by_id(at).ok()?;
                let is_storey = record.ifc_type.is_subtype_of(IfcType::IfcBuildingStorey)
                    || record.ifc_type.is_subtype_of(IfcType::IfcFacilityPart);
                if is_storey { name_of(&record, 2).or_else(|| name_of(&record, 7)) } else { None }
            });
            if storey.is_some() {
                return storey.clone();
            }
        }
        None
    }

    /// The names of a product's materials, including those of its layer set.
    pub(super) fn materials(&mut self, product: u32, decoder: &mut EntityDecoder) -> Vec<String> {
        let Some(&record) = self.material.get(&product) else { return Vec::new() };
        self.names.entry(record).or_insert_with(|| material_names(record, decoder)).clone()
    }
}

/// The names of the materials of a record, which may be a usage of a set of layers of materials.
fn material_names(record: u32, decoder: &mut EntityDecoder) -> Vec<String> {
    let mut names = Vec::new();
    let mut open = vec![(record, 0)];
    let mut visits = 0;
    while let Some((id, depth)) = open.pop() {
        visits += 1;
        let Ok(record) = decoder.decode_by_id(id) else { continue };
        if depth > 4 || visits > 4 * MAX_MATERIALS || names.len() >= MAX_MATERIALS {
            break;
        }
        let below = match record.ifc_type {
            IfcType::IfcMaterial => {
                names.extend(name_of(&record, 0).filter(|name| !names.contains(name)));
                Vec::new()
            }
            IfcType::IfcMaterialList | IfcType::IfcMaterialLayerSet => record.get_refs(0).unwrap_or_default(),
            IfcType::IfcMaterialLayerSetUsage | IfcType::IfcMaterialLayer | IfcType::IfcMaterialProfileSetUsage => {
                record.get_ref(0).into_iter().collect()
            }
            IfcType::IfcMaterialConstituentSet | IfcType::IfcMaterialProfileSet => {
                record.get_refs(2).unwrap_or_default()
            }
            IfcType::IfcMaterialConstituent | IfcType::IfcMaterialProfile => record.get_ref(2).into_iter().collect(),
            _ => Vec::new(),
        };
        open.extend(below.into_iter().rev().map(|id| (id, depth + 1)));
    }
    names
}
