//! The contents of a DXF file: its layers, its blocks, and what stands in the model space.

use crate::formats::face_cutter::FaceCutter;
use crate::formats::left_out::LeftOutTally;
use glam::{DAffine3, DVec3};
use rustc_hash::FxHashMap;

/// A layer.
#[derive(Clone, Debug, Default)]
pub(super) struct DxfLayer {
    pub name: String,
    pub is_frozen: bool,
    pub is_off: bool,
    /// The number of entities that were left out because the layer is frozen or off.
    pub left_out: u64,
}

/// Layer `0`, whose entities have the layer of the insert that places their block.
pub(super) const LAYER_0: u32 = 0;

/// Triangles of one layer, and of how many entities.
#[derive(Default)]
pub(super) struct LayerTriangles {
    pub layer: u32,
    pub positions: Vec<DVec3>,
    pub triangles: Vec<[u32; 3]>,
    pub entities: u64,
}

/// A block that is placed, once or in rows and columns.
pub(super) struct DxfInsert {
    pub layer: u32,
    pub block: String,
    /// Transforms the block's coordinates to the world, before its base point is subtracted, and before the step to a
    /// row and a column.
    pub world_from_block: DAffine3,
    pub columns: u64,
    pub rows: u64,
    /// The step from one column to the next, in the coordinates in which the insert stands.
    pub column_step: DVec3,
    pub row_step: DVec3,
}

/// What a block holds, or the model space.
#[derive(Default)]
pub(super) struct DxfBlock {
    pub base: DVec3,
    pub triangles: Vec<LayerTriangles>,
    pub triangles_of: FxHashMap<u32, usize>,
    pub inserts: Vec<DxfInsert>,
}

impl DxfBlock {
    /// Adds an entity's triangles to those of its layer.
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

/// What a file says.
pub(super) struct Drawing {
    /// The layers by number; the first is `0`.
    pub layers: Vec<DxfLayer>,
    pub layer_of: FxHashMap<String, u32>,
    pub blocks: FxHashMap<String, DxfBlock>,
    pub model_space: DxfBlock,
    pub unit: Option<i64>,
    pub left_out: LeftOutTally,
    pub cutter: FaceCutter,
    /// The number of bodies whose shape is stored as ACIS.
    pub acis: u64,
    /// The number of polylines that have a width, which is not read.
    pub wide: u64,
    /// The number of closed outlines with a thickness: walls without a lid.
    pub lidless: u64,
    /// Triangles of all blocks, each once.
    pub triangles: u64,
}

impl Drawing {
    /// The number of a layer, upper and lower case alike.
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
