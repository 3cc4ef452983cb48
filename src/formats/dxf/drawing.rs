//! The sections of a DXF file → its layers, its blocks, and what stands in the model space.

use super::entity;
use super::fields::DxfFields;
use super::group::{DxfGroup, DxfGroups};
use crate::formats::left_out::LeftOutTally;
use crate::formats::polygon::PolygonCutter;
use crate::message::{Message, message};
use glam::{DAffine3, DVec3};
use rustc_hash::FxHashMap;

/// A layer.
#[derive(Clone, Debug, Default)]
pub(super) struct DxfLayer {
    pub name: String,
    pub is_frozen: bool,
    pub is_off: bool,
    /// Entities that were left out as it is frozen or off.
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
    /// World from the block's coordinates, its base point not yet taken away, and before the step to a row and a column.
    pub world_from_block: DAffine3,
    pub columns: u64,
    pub rows: u64,
    /// From one to the next, in the coordinates that the insert stands in.
    pub column_step: DVec3,
    pub row_step: DVec3,
}

/// What a block holds, or the model space.
#[derive(Default)]
pub(super) struct DxfBlock {
    pub base: DVec3,
    pub triangles: Vec<LayerTriangles>,
    triangles_of: FxHashMap<u32, usize>,
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
    /// By number; the first is `0`.
    pub layers: Vec<DxfLayer>,
    layer_of: FxHashMap<String, u32>,
    pub blocks: FxHashMap<String, DxfBlock>,
    pub model_space: DxfBlock,
    pub unit: Option<i64>,
    pub left_out: LeftOutTally,
    pub cutter: PolygonCutter,
    /// Bodies whose shape is ACIS's.
    pub acis: u64,
    /// Polylines that have a width, which is not read.
    pub wide: u64,
    /// Closed outlines with a thickness: walls without a lid.
    pub lidless: u64,
    /// Triangles of all blocks, each once.
    pub triangles: u64,
}

impl Drawing {
    pub(super) fn read(bytes: &[u8]) -> Result<Self, Message> {
        let mut drawing = Self {
            layers: Vec::new(),
            layer_of: FxHashMap::default(),
            blocks: FxHashMap::default(),
            model_space: DxfBlock::default(),
            unit: None,
            left_out: LeftOutTally::default(),
            cutter: PolygonCutter::new(),
            acis: 0,
            wide: 0,
            lidless: 0,
            triangles: 0,
        };
        drawing.layer("0");
        let mut groups = DxfGroups::new(bytes);
        let mut has_end = false;
        while let Some(group) = groups.next()? {
            match (group.code, group.bytes()) {
                (0, b"EOF") => {
                    has_end = true;
                    break;
                }
                (0, b"SECTION") => drawing.section(&mut groups)?,
                _ => (),
            }
        }
        // many a small program leaves the last line out, but no section
        if !has_end && drawing.is_empty() {
            let what = format!("ends in {} without entities", groups.position());
            return Err(message![what; "the file is cut off or damaged: copy or export it again"]);
        }
        Ok(drawing)
    }

    fn is_empty(&self) -> bool {
        self.model_space.triangles.is_empty() && self.model_space.inserts.is_empty()
    }

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

    fn section(&mut self, groups: &mut DxfGroups) -> Result<(), Message> {
        let name = groups.next()?;
        match name.filter(|group| group.code == 2).map(|group| group.bytes().to_vec()).as_deref() {
            Some(b"HEADER") => self.header(groups),
            Some(b"TABLES") => self.tables(groups),
            Some(b"BLOCKS") => self.blocks(groups),
            Some(b"ENTITIES") => self.entities(groups),
            _ => until_end(groups),
        }
    }

    fn header(&mut self, groups: &mut DxfGroups) -> Result<(), Message> {
        let mut variable: &[u8] = &[];
        while let Some(group) = groups.next()? {
            match group.code {
                0 if group.bytes() == b"ENDSEC" => return Ok(()),
                9 => variable = group.bytes(),
                70 if variable == b"$INSUNITS" => self.unit = group.whole(),
                _ => (),
            }
        }
        Err(cut_off(groups))
    }

    fn tables(&mut self, groups: &mut DxfGroups) -> Result<(), Message> {
        let mut is_layer = false;
        let mut layer = DxfLayer::default();
        while let Some(group) = groups.next()? {
            match group.code {
                0 => {
                    if is_layer {
                        self.keep(std::mem::take(&mut layer));
                    }
                    is_layer = group.bytes() == b"LAYER";
                    if group.bytes() == b"ENDSEC" {
                        return Ok(());
                    }
                }
                2 if is_layer => layer.name = group.name(),
                70 if is_layer => layer.is_frozen = group.whole().is_some_and(|flags| flags & 1 != 0),
                62 if is_layer => layer.is_off = group.whole().is_some_and(|colour| colour < 0),
                _ => (),
            }
        }
        Err(cut_off(groups))
    }

    fn keep(&mut self, layer: DxfLayer) {
        let number = self.layer(&layer.name);
        if let Some(known) = self.layers.get_mut(number as usize) {
            *known = layer;
        }
    }

    fn blocks(&mut self, groups: &mut DxfGroups) -> Result<(), Message> {
        let Some(mut group) = groups.next()? else { return Err(cut_off(groups)) };
        loop {
            match group.bytes() {
                b"ENDSEC" => return Ok(()),
                b"BLOCK" => {
                    let (head, next) = DxfFields::read(groups)?;
                    let name = head.name(2);
                    let mut block = DxfBlock { base: head.point(10), ..DxfBlock::default() };
                    group = self.fill(&mut block, next, groups)?;
                    // a definition is written once, and an external one not at all
                    self.blocks.entry(name.to_uppercase()).or_insert(block);
                }
                _ => group = DxfFields::read(groups)?.1,
            }
        }
    }

    fn entities(&mut self, groups: &mut DxfGroups) -> Result<(), Message> {
        let Some(first) = groups.next()? else { return Err(cut_off(groups)) };
        let mut space = std::mem::take(&mut self.model_space);
        self.fill(&mut space, first, groups)?;
        self.model_space = space;
        Ok(())
    }

    /// Reads entities into a block until it ends, or its section does; gives the group behind its end.
    fn fill<'a>(
        &mut self,
        block: &mut DxfBlock,
        first: DxfGroup<'a>,
        groups: &mut DxfGroups<'a>,
    ) -> Result<DxfGroup<'a>, Message> {
        let mut group = first;
        loop {
            match group.bytes() {
                b"ENDSEC" => return Ok(group),
                b"ENDBLK" => return Ok(DxfFields::read(groups)?.1),
                kind => {
                    group = entity::add(self, block, kind, groups)?;
                }
            }
        }
    }
}

fn until_end(groups: &mut DxfGroups) -> Result<(), Message> {
    while let Some(group) = groups.next()? {
        if group.code == 0 && group.bytes() == b"ENDSEC" {
            return Ok(());
        }
    }
    Err(cut_off(groups))
}

pub(super) fn cut_off(groups: &DxfGroups) -> Message {
    let what = format!("is cut off in {}", groups.position());
    message![what; "copy or export it again"]
}
