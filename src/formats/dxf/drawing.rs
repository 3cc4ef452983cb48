//! The contents of a DXF file: its layers, its blocks, and the model space.

use crate::formats::face_cutter::FaceCutter;
use crate::formats::left_out::LeftOutTally;
use glam::{DAffine3, DVec3};
use rustc_hash::FxHashMap;

#[derive(Clone, Debug, Default)]
pub(super) struct DxfLayer {
    pub name: String,
    pub is_frozen: bool,
    pub is_off: bool,
    /// The number of entities that were left out because the layer is frozen or off.
    pub left_out: u64,
}

/// Layer `0`: its entities take the layer of the insert that places their block.
pub(super) const LAYER_0: u32 = 0;

/// The triangles of one layer, and the number of entities they come from.
#[derive(Default)]
pub(super) struct LayerTriangles {
    pub layer: u32,
    pub positions: Vec<DVec3>,
    pub triangles: Vec<[u32; 3]>,
    pub entities: u64,
}

/// A placed block: once, or in rows and columns.
pub(super) struct DxfInsert {
    pub layer: u32,
    pub block: String,
    /// Transforms the block's coordinates to the world, before its base point is subtracted, and before the step to a
    /// row and a column.
    pub world_from_block: DAffine3,
    pub columns: u64,
    pub rows: u64,
    /// The step from one column to the next, in the coordinates around the insert.
    pub column_step: DVec3,
    pub row_step: DVec3,
}

/// The contents of a block or of the model space.
#[derive(Default)]
pub(super) struct DxfBlock {
    pub base: DVec3,
    pub triangles: Vec<LayerTriangles>,
    pub triangles_of: FxHashMap<u32, usize>,
    pub inserts: Vec<DxfInsert>,
}

impl DxfBlock {
    /// Adds an entity's triangles to its layer.
    pub(super) fn of_layer(&mut self, layer: u32, entity: LayerTriangles) {
        let triangles = &mut self.triangles;
        let at = *self.triangles_of.entry(layer).or_insert_with(|| {
            triangles.push(LayerTriangles { layer, ..LayerTriangles::default() });
            triangles.len() - 1
        });
        if let Some(of_layer) = self.triangles.get_mut(at) {
            let first = of_layer.positions.len() as u32;
            of_layer.positions.extend(entity.positions);
            of_layer.triangles.extend(entity.triangles.iter().map(|triangle| triangle.map(|corner| first + corner)));
            of_layer.entities += 1;
        }
    }
}

/// The contents of a file.
pub(super) struct Drawing {
    /// The layers by index; the first is `0`.
    pub layers: Vec<DxfLayer>,
    pub layer_of: FxHashMap<String, u32>,
    pub blocks: FxHashMap<String, DxfBlock>,
    pub model_space: DxfBlock,
    pub unit: Option<i64>,
    pub left_out: LeftOutTally,
    pub cutter: FaceCutter,
    /// The number of bodies whose shape is stored as ACIS.
    pub acis: u64,
    /// The number of polylines with a width, which is not read.
    pub wide: u64,
    /// The number of closed outlines with a thickness: walls without a lid.
    pub lidless: u64,
    /// The triangles of all blocks, each block counted once.
    pub triangles: u64,
}

impl Drawing {
    /// The index of a layer; upper and lower case are the same.
    pub(super) fn layer(&mut self, name: &str) -> u32 {
        let key = name.to_uppercase();
        if let Some(&number) = self.layer_of.get(&key) {
            return number;
        }
        let number = self.layers.len() as u32;
        self.layers.push(DxfLayer { name: name.to_owned(), ..DxfLayer::default() });
        self.layer_of.insert(key, number);
        number
    }
}
