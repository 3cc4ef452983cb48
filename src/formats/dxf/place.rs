//! Makes parts of a drawing's blocks where they are inserted.

use super::drawing::{Drawing, DxfBlock, DxfLayer, LAYER_0};
use super::entity::NO_ACIS;
use super::frame::metres;
use crate::formats::left_out::LeftOutTally;
use crate::formats::{MAX_COMPONENTS, MAX_TRIANGLES, Model, Up};
use crate::mesh::Part;
use crate::message::{Message, message};
use glam::DAffine3;
use rustc_hash::{FxHashMap, FxHashSet};

/// How deeply blocks may be nested.
const MOST_DEPTH: usize = 64;

pub(super) fn model_of(mut drawing: Drawing) -> Result<Model, Message> {
    let mut counts = BlockCounts { blocks: &drawing.blocks, known: FxHashMap::default(), open: FxHashSet::default() };
    let total = counts.of(&drawing.model_space, 0)?;
    let known = counts.known;
    if total > MAX_TRIANGLES {
        let what = format!("has more than {MAX_TRIANGLES} triangles, blocks counted as often as they are inserted");
        return Err(message![what; "export it in parts or with less detail"]);
    }
    if total == 0 && drawing.acis > 0 {
        let what = format!("has {} solids or surfaces, whose shape only CAD programs can read", drawing.acis);
        return Err(message![what; "in AutoCAD, make meshes of them with MESHSMOOTH, or export STL, and open that"]);
    }
    let mut placer = Placer {
        blocks: &drawing.blocks,
        triangles: &known,
        layers: &mut drawing.layers,
        left_out: &mut drawing.left_out,
        parts: Vec::new(),
        part_of: FxHashMap::default(),
    };
    placer.place(
        &drawing.model_space,
        BlockSite { world_from_block: DAffine3::IDENTITY, layer: LAYER_0, top: None },
        0,
    )?;
    let parts = placer.parts;
    let mut model = Model { up: Up::Z, up_is_said: true, ..Model::default() };
    model.unit_m = drawing.unit.and_then(metres);
    model.parts = named(parts, &drawing.layers);
    tell(&mut model, drawing);
    Ok(model)
}

/// Adds to the model what was left out, and the notes.
fn tell(model: &mut Model, mut drawing: Drawing) {
    for layer in drawing.layers.iter().filter(|layer| layer.left_out > 0) {
        let why = if layer.is_frozen { "the layer is frozen" } else { "the layer is off" };
        drawing.left_out.add_many(&format!("entities of the layer {}", layer.name), why, layer.left_out);
    }
    model.notes.extend(drawing.cutter.crossing_note());
    model.left_out = drawing.left_out.into_left_out();
    if drawing.acis > 0 {
        let (solids, cast) = if drawing.acis == 1 { ("solid", "casts") } else { ("solids", "cast") };
        model.notes.push(message![
            format!("has {} {solids} or surfaces of ACIS that {cast} no shadow here", drawing.acis); NO_ACIS
        ]);
    }
    if drawing.lidless > 0 {
        let (outlines, have) = if drawing.lidless == 1 { ("outline", "has") } else { ("outlines", "have") };
        model.notes.push(message![
            format!("has {} closed {outlines} with a thickness that {have} walls but no lid", drawing.lidless);
            "in AutoCAD, add a 3D face on each that should be a roof"
        ]);
    }
    if drawing.wide > 0 {
        let (lines, have) = if drawing.wide == 1 { ("polyline", "has") } else { ("polylines", "have") };
        model.notes.push(message![format!(
            "has {} {lines} that {have} a width, which is not read: each is read as its middle line",
            drawing.wide
        )]);
    }
}

/// Counts the triangles of blocks with those that they insert, before anything is placed.
struct BlockCounts<'a> {
    blocks: &'a FxHashMap<String, DxfBlock>,
    known: FxHashMap<String, u64>,
    /// The blocks that are being counted.
    open: FxHashSet<String>,
}

impl BlockCounts<'_> {
    fn of(&mut self, block: &DxfBlock, depth: usize) -> Result<u64, Message> {
        let mut sum: u64 = block.triangles.iter().map(|layer| layer.triangles.len() as u64).sum();
        for insert in &block.inserts {
            let name = insert.block.to_uppercase();
            let each = match self.known.get(&name) {
                Some(&known) => known,
                None => self.named(&name, depth)?,
            };
            let copies = insert.columns.saturating_mul(insert.rows);
            sum = sum.saturating_add(each.saturating_mul(copies));
        }
        Ok(sum)
    }

    fn named(&mut self, name: &str, depth: usize) -> Result<u64, Message> {
        let blocks = self.blocks;
        let Some(block) = blocks.get(name) else { return Ok(0) };
        if depth >= MOST_DEPTH || !self.open.insert(name.to_owned()) {
            let what =
                format!("has a block that contains itself, or blocks nested more than {MOST_DEPTH} deep: `{name}`");
            return Err(message![what; "repair the drawing and export it again"]);
        }
        let count = self.of(block, depth + 1)?;
        self.open.remove(name);
        self.known.insert(name.to_owned(), count);
        Ok(count)
    }
}

/// Where a block is placed: its layer, and the outermost block that it is in.
#[derive(Clone, Copy)]
struct BlockSite<'a> {
    world_from_block: DAffine3,
    layer: u32,
    top: Option<&'a str>,
}

struct Placer<'a, 'b> {
    blocks: &'a FxHashMap<String, DxfBlock>,
    triangles: &'a FxHashMap<String, u64>,
    layers: &'b mut [DxfLayer],
    left_out: &'b mut LeftOutTally,
    parts: Vec<PlacedLayer<'a>>,
    part_of: FxHashMap<(Option<&'a str>, u32), usize>,
}

/// The placed triangles of a layer, in a block or in the model space.
struct PlacedLayer<'a> {
    block: Option<&'a str>,
    layer: u32,
    part: Part,
}

impl<'a> Placer<'a, '_> {
    /// Places a block. Its triangles are already counted, and its depth is limited.
    fn place(&mut self, block: &'a DxfBlock, site: BlockSite<'a>, depth: usize) -> Result<(), Message> {
        let layer_of = |layer: u32| if layer == LAYER_0 && depth > 0 { site.layer } else { layer };
        for found in &block.triangles {
            let layer = layer_of(found.layer);
            if let Some(known) = self.layers.get_mut(layer as usize)
                && (known.is_frozen || known.is_off)
            {
                known.left_out += found.entities;
                continue;
            }
            let mirrors = site.world_from_block.matrix3.determinant() < 0.0;
            let part = self.part(site.top, layer)?;
            // cannot overflow: a model has too few triangles for that
            let first = part.positions.len() as u32;
            part.positions.extend(found.positions.iter().map(|&point| site.world_from_block.transform_point3(point)));
            let turned = found.triangles.iter().map(|&[a, b, c]| if mirrors { [a, c, b] } else { [a, b, c] });
            part.triangles.extend(turned.map(|triangle| triangle.map(|corner| first + corner)));
            if !part.positions.iter().skip(first as usize).all(|point| point.is_finite()) {
                return Err(
                    message!["has blocks whose scaled coordinates are too large"; "repair the drawing and export it again"],
                );
            }
        }
        for insert in &block.inserts {
            let copies = insert.columns.saturating_mul(insert.rows);
            let layer = layer_of(insert.layer);
            if let Some(known) = self.layers.get_mut(layer as usize)
                && known.is_frozen
            {
                known.left_out += copies;
                continue;
            }
            let key = insert.block.to_uppercase();
            let Some(inner) = self.blocks.get(&key) else {
                self.left_out.add_many("INSERT", "the block is not in the file", copies);
                continue;
            };
            if self.triangles.get(&key).is_none_or(|&count| count == 0) {
                self.left_out.add_many("INSERT", "the block has no surface", copies);
                continue;
            }
            let top = site.top.or(Some(insert.block.as_str()));
            for row in 0..insert.rows {
                for column in 0..insert.columns {
                    let step = insert.column_step * column as f64 + insert.row_step * row as f64;
                    let world_from_block = site.world_from_block
                        * DAffine3::from_translation(step)
                        * insert.world_from_block
                        * DAffine3::from_translation(-inner.base);
                    self.place(inner, BlockSite { world_from_block, layer, top }, depth + 1)?;
                }
            }
        }
        Ok(())
    }

    fn part(&mut self, block: Option<&'a str>, layer: u32) -> Result<&mut Part, Message> {
        let parts = &mut self.parts;
        let at = *self.part_of.entry((block, layer)).or_insert_with(|| {
            parts.push(PlacedLayer { block, layer, part: Part::default() });
            parts.len() - 1
        });
        match self.parts.get_mut(at) {
            Some(placed) if at < MAX_COMPONENTS => Ok(&mut placed.part),
            _ => {
                let what = format!("has more than {MAX_COMPONENTS} components");
                Err(message![what; "join its layers, and export it again"])
            }
        }
    }
}

/// The parts, named after their layer and block.
fn named(parts: Vec<PlacedLayer>, layers: &[DxfLayer]) -> Vec<Part> {
    let mut layers_of: FxHashMap<Option<&str>, usize> = FxHashMap::default();
    for placed in &parts {
        *layers_of.entry(placed.block).or_default() += 1;
    }
    let name = |PlacedLayer { block, layer, mut part }| {
        let layer = layers.get(layer as usize).map_or("0", |layer: &DxfLayer| layer.name.as_str());
        part.name = match block {
            None => layer.to_owned(),
            Some(name) if layers_of.get(&block) == Some(&1) => name.to_owned(),
            Some(name) => format!("{name}/{layer}"),
        };
        part.aliases = block.into_iter().chain([layer]).map(str::to_owned).collect();
        part.aliases.dedup();
        part
    };
    parts.into_iter().map(name).collect()
}
