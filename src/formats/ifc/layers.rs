//! Layers that the file has switched off or frozen: whoever drew the model does not see what lies on them alone. Also
//! the names of layers with a style, which the reader does not report.

use super::lost::is_solid;
use super::scan::{IfcProduct, IfcScan};
use ifc_lite_core::{DecodedEntity, EntityDecoder, IfcType};
use rustc_hash::{FxHashMap, FxHashSet};
use std::collections::BTreeMap;
use std::rc::Rc;

/// What lies on which layer.
#[derive(Default)]
pub(super) struct IfcLayers {
    /// Representations and their items on hidden layers, each with its layer's name.
    on: FxHashMap<u32, Rc<str>>,
    /// The same of layers with a style that are shown.
    styled: FxHashMap<u32, Rc<str>>,
    /// The products whose whole shape lies on hidden layers.
    pub products: FxHashSet<u32>,
    /// The number of them on each hidden layer, including pieces of others.
    pub counts: BTreeMap<Rc<str>, u64>,
}

/// Whether an attribute of three values is one of them.
fn says(layer: &DecodedEntity, at: usize, value: &str) -> bool {
    layer.get(at).and_then(|attribute| attribute.as_enum()).is_some_and(|said| said.eq_ignore_ascii_case(value))
}

impl IfcLayers {
    /// Those of a file.
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
            // LayerOn and LayerFrozen; what is unknown is seen
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

    /// The name of the layer with a style on which an item lies, or else the shape of its product.
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

    /// Whether an item lies on a hidden layer; if so, it is counted.
    pub(super) fn hides(&mut self, item: Option<u32>) -> bool {
        let layer = item.and_then(|item| self.on.get(&item)).cloned();
        layer.inspect(|layer| self.count(layer)).is_some()
    }

    /// The hidden layer on which all of a product's solid shape lies.
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

    /// The hidden layer of a representation: its own, or that of all its items or of what they repeat.
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

    /// The hidden layer of what an item repeats.
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
