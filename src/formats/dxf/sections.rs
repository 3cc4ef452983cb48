//! Reads the sections of a DXF file into a drawing.

use super::drawing::{Drawing, DxfBlock, DxfLayer};
use super::entity;
use super::fields::DxfFields;
use super::group::{DxfGroup, DxfGroups, cut_off};
use crate::formats::face_cutter::FaceCutter;
use crate::formats::left_out::LeftOutTally;
use crate::message::{Message, message};
use rustc_hash::FxHashMap;

impl Drawing {
    pub(super) fn read(bytes: &[u8]) -> Result<Self, Message> {
        let mut drawing = Self {
            layers: Vec::new(),
            layer_of: FxHashMap::default(),
            blocks: FxHashMap::default(),
            model_space: DxfBlock::default(),
            unit: None,
            left_out: LeftOutTally::default(),
            cutter: FaceCutter::new(),
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
        // many small programs leave out the last line, but not a section
        if !has_end && drawing.is_empty() {
            let what = format!("ends in {} without entities", groups.position());
            return Err(message![what; "the file is cut off or damaged: copy or export it again"]);
        }
        Ok(drawing)
    }

    fn is_empty(&self) -> bool {
        self.model_space.triangles.is_empty() && self.model_space.inserts.is_empty()
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
                    // the first definition counts; external blocks are not read
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

    /// Reads entities into a block until it or its section ends. Returns the group after that.
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
