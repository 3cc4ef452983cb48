//! Layers that are switched off or frozen: the author does not see what is only on them. Also the names of layers with
//! a style, which the reader does not report.

use super::lost::is_solid;
use super::scan::{IfcProduct, IfcScan};
use ifc_lite_core::{DecodedEntity, EntityDecoder, IfcType};
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::BTreeMap;
use std::rc::Rc;

/// The layers of items.
#[derive(Default)]
pub(super) struct IfcLayers {
    /// The hidden layer of representations and items, by name.
    on: FxHashMap<u32, Rc<str>>,
    /// The same for visible layers with a style.
    styled: FxHashMap<u32, Rc<str>>,
    /// The products whose whole shape is on hidden layers.
    pub products: FxHashSet<u32>,
    /// The number of those on each hidden layer, including pieces of other products.
    pub counts: BTreeMap<Rc<str>, u64>,
}

/// Whether a three-valued attribute has a value.
fn says(layer: &DecodedEntity, at: usize, value: &str) -> bool {
    layer.get(at).and_then(|attribute| attribute.as_enum()).is_some_and(|said| said.eq_ignore_ascii_case(value))
}

impl IfcLayers {
    /// Reads the layers of a file.
    pub(super) fn of(scan: &IfcScan, decoder: &mut EntityDecoder) -> Self {
        let mut layers = IfcLayers::default();
        let mut shown = FxHashSet::default();
        for &id in scan.layers.iter().chain(&scan.styled_layers) {
            let Ok(layer) = decoder.decode_by_id(id) else { continue };
            let items = layer.get_refs(2).unwrap_or_default();
            let name: Rc<str> = layer.get_string(0).unwrap_or_default().into();
            let named = items.iter().map(|&item| (item, name.clone()));
            if layer.ifc_type != IfcType::IfcPresentationLayerWithStyle {
                shown.extend(items);
            // LayerOn and LayerFrozen; unknown means visible
            } else if says(&layer, 4, "F") || says(&layer, 5, "T") {
                layers.on.extend(named);
            } else {
                layers.styled.extend(named);
                shown.extend(items);
            }
        }
        layers.on.retain(|item, _| !shown.contains(item));
        if !layers.on.is_empty() {
            for product in &scan.products {
                if let Some(layer) = layers.whole(product, decoder) {
                    layers.products.insert(product.id);
                    layers.count(&layer);
                }
            }
        }
        layers
    }

    /// The name of the styled layer of an item, otherwise of its product's shape.
    pub(super) fn styled(&self, item: Option<u32>, shape: u32, decoder: &mut EntityDecoder) -> Option<String> {
        if self.styled.is_empty() {
            return None;
        }
        let on = |id: u32| self.styled.get(&id).map(|name| name.to_string());
        if let Some(name) = item.and_then(on).or_else(|| on(shape)) {
            return Some(name);
        }
        for id in decoder.decode_by_id(shape).ok()?.get_refs(2)? {
            let Ok(representation) = decoder.decode_by_id(id) else { continue };
            let items = || representation.get_refs(3).unwrap_or_default();
            if let Some(name) = on(id).or_else(|| items().into_iter().find_map(on)) {
                return Some(name);
            }
        }
        None
    }

    fn count(&mut self, layer: &Rc<str>) {
        *self.counts.entry(layer.clone()).or_default() += 1;
    }

    /// Whether an item is on a hidden layer; if so, it is counted.
    pub(super) fn hides(&mut self, item: Option<u32>) -> bool {
        let layer = item.and_then(|item| self.on.get(&item)).cloned();
        layer.inspect(|layer| self.count(layer)).is_some()
    }

    /// The hidden layer that a product's whole solid shape is on.
    fn whole(&self, product: &IfcProduct, decoder: &mut EntityDecoder) -> Option<Rc<str>> {
        if let Some(layer) = self.on.get(&product.shape) {
            return Some(layer.clone());
        }
        let shape = decoder.decode_by_id(product.shape).ok()?;
        let mut layer = None;
        for id in shape.get_refs(2)? {
            let representation = decoder.decode_by_id(id).ok()?;
            if is_solid(&representation) {
                layer = Some(self.representation(id, &representation, decoder)?);
            }
        }
        layer
    }

    /// The hidden layer of a representation: its own, or that of all its items or mapped representations.
    fn representation(&self, id: u32, representation: &DecodedEntity, decoder: &mut EntityDecoder) -> Option<Rc<str>> {
        if let Some(layer) = self.on.get(&id) {
            return Some(layer.clone());
        }
        let mut layer = None;
        for item in representation.get_refs(3)? {
            let of_item = self.on.get(&item).cloned();
            layer = Some(of_item.or_else(|| self.repeated(item, decoder))?);
        }
        layer
    }

    /// The hidden layer of an item's mapped representation.
    fn repeated(&self, item: u32, decoder: &mut EntityDecoder) -> Option<Rc<str>> {
        let item = decoder.decode_by_id(item).ok()?;
        if item.ifc_type != IfcType::IfcMappedItem {
            return None;
        }
        let map = decoder.decode_by_id(item.get_ref(0)?).ok()?;
        let id = map.get_ref(1)?;
        if let Some(layer) = self.on.get(&id) {
            return Some(layer.clone());
        }
        let items = decoder.decode_by_id(id).ok()?.get_refs(3)?;
        let mut layers = items.iter().map(|item| self.on.get(item).cloned());
        let first = layers.next()??;
        layers.all(|layer| layer.is_some()).then_some(first)
    }
}
