//! Meshes from the reader, in metres → parts in the file's own coordinates. A part is everything of one product that has one
//! material.

use super::super::{MAX_COMPONENTS, MAX_TRIANGLES, PartKind, SeeThrough, composed};
use super::layers::IfcLayers;
use super::relations::IfcRelations;
use crate::mesh::{CornerPrecision, Part};
use glam::DVec3;
use ifc_lite_core::{EntityDecoder, IfcType};
use ifc_lite_processing::{FrameEvent, MeshData, MeshFrame, ProcessingSink, default_color_for_type};
use rustc_hash::{FxHashMap, FxHashSet};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// The longest name; longer ones are cut.
const MAX_NAME_BYTES: usize = 1000;

/// The name of a translucent style without a name.
const TRANSLUCENT: &str = "translucent";

/// Collects parts while the reader builds shapes.
pub(super) struct IfcParts<'a> {
    /// The type and shape of each product.
    asked: FxHashMap<u32, (IfcType, u32)>,
    decoder: EntityDecoder<'a>,
    relations: IfcRelations,
    pub layers: IfcLayers,
    /// The origin and rotation of the reader's coordinates.
    frame: MeshFrame,
    /// Stops the reader when there are too many parts.
    pub stop: Arc<AtomicBool>,
    triangles: u64,
    pub parts: Vec<Part>,
    pub kinds: Vec<PartKind>,
    pub see_through: Vec<SeeThrough>,
    /// The products that have triangles, including hidden ones.
    pub meshed: FxHashSet<u32>,
    /// The number of meshes with invalid corners.
    pub broken: u64,
    /// The number of names that were shortened.
    pub cut_names: u64,
}

impl ProcessingSink for IfcParts<'_> {
    fn on_frame(&mut self, event: &FrameEvent) {
        self.frame = event.frame;
    }

    fn on_batch(&mut self, meshes: &[MeshData], _done: usize, _all: usize) {
        // the meshes of a product are consecutive
        for of_product in meshes.chunk_by(|one, other| one.express_id == other.express_id) {
            self.add(of_product);
        }
        if self.triangles > MAX_TRIANGLES || self.parts.len() > MAX_COMPONENTS {
            self.stop.store(true, Ordering::Relaxed);
        }
    }
}

impl<'a> IfcParts<'a> {
    pub(super) fn new(
        asked: FxHashMap<u32, (IfcType, u32)>,
        decoder: EntityDecoder<'a>,
        relations: IfcRelations,
        layers: IfcLayers,
    ) -> Self {
        IfcParts {
            asked,
            decoder,
            relations,
            layers,
            frame: MeshFrame::RawIfc,
            stop: Arc::default(),
            triangles: 0,
            parts: Vec::new(),
            kinds: Vec::new(),
            see_through: Vec::new(),
            meshed: FxHashSet::default(),
            broken: 0,
            cut_names: 0,
        }
    }

    /// A product's meshes by style, in the order of its shape, and whether each is see-through.
    fn by_style<'m>(
        &mut self,
        meshes: &'m [MeshData],
        kind: &IfcType,
    ) -> Vec<(Option<String>, bool, Vec<&'m MeshData>)> {
        let mut of_style: Vec<(Option<String>, bool, Vec<&MeshData>)> = Vec::new();
        for mesh in meshes.iter().filter(|mesh| !mesh.is_empty()) {
            self.meshed.insert(mesh.express_id);
            if self.layers.hides(mesh.geometry_item_id) {
                continue;
            }
            if !is_sound(mesh) {
                self.broken += 1;
                continue;
            }
            let is_translucent = is_translucent(mesh, kind);
            let style = style_name(mesh).or_else(|| is_translucent.then(|| TRANSLUCENT.to_owned()));
            match of_style.iter_mut().find(|(name, passes, _)| *name == style && *passes == is_translucent) {
                Some((_, _, meshes)) => meshes.push(mesh),
                None => of_style.push((style, is_translucent, vec![mesh])),
            }
        }
        of_style
    }

    /// Adds a product: one part for each material.
    fn add(&mut self, meshes: &[MeshData]) {
        let Some(product) = meshes.first() else { return };
        let Some((kind, shape)) = self.asked.get(&product.express_id).cloned() else { return };
        let of_style = self.by_style(meshes, &kind);
        if of_style.is_empty() {
            return;
        }
        let materials = self.relations.materials(product.express_id, &mut self.decoder);
        let storey = self.relations.storey(product.express_id, &mut self.decoder);
        for (style, is_translucent, meshes) in of_style {
            // a single material names the whole product if its meshes have no style
            let material = style.or_else(|| materials.first().filter(|_| materials.len() == 1).cloned());
            let material = material.map(|name| self.named(&name));
            let name = match &material {
                Some(material) => self.named(&format!("{}/{material}", kind.name())),
                None => kind.name().to_owned(),
            };
            let item = meshes.first().and_then(|mesh| mesh.geometry_item_id);
            let layer = product.presentation_layer.clone();
            let layer = layer.or_else(|| self.layers.styled(item, shape, &mut self.decoder));
            let groups = [product.name.clone(), storey.clone(), layer].into_iter().flatten();
            let mut aliases = vec![kind.name().to_owned()];
            aliases.extend(material.clone());
            for group in groups.chain(materials.iter().cloned()) {
                let group = self.named(&group);
                if !aliases.contains(&group) {
                    aliases.push(group);
                }
            }
            aliases.retain(|alias| !alias.is_empty() && *alias != name);
            if is_translucent {
                self.see_through(material.unwrap_or_else(|| TRANSLUCENT.to_owned()));
            }
            let is_ground = kind.is_subtype_of(IfcType::IfcSite);
            self.kinds.push(if is_ground { PartKind::GroundCover } else { PartKind::Building });
            let part = self.part(name, aliases, &meshes);
            self.parts.push(part);
        }
    }

    /// Records that the next part has a see-through material.
    fn see_through(&mut self, material: String) {
        let part = self.parts.len();
        match self.see_through.iter_mut().find(|known| known.material == material) {
            Some(known) => known.parts.push(part),
            None => self.see_through.push(SeeThrough { material, parts: vec![part] }),
        }
    }

    /// A name in normal form, shortened if it is too long.
    fn named(&mut self, name: &str) -> String {
        let name = composed(name.trim());
        if name.len() <= MAX_NAME_BYTES {
            return name.into_owned();
        }
        self.cut_names += 1;
        let end = (0..=MAX_NAME_BYTES).rev().find(|&at| name.is_char_boundary(at)).unwrap_or(0);
        name[..end].to_owned()
    }

    /// Joins meshes to one part, in the file's coordinates.
    fn part(&mut self, name: String, aliases: Vec<String>, meshes: &[&MeshData]) -> Part {
        let to_file = self.frame.world_mapper();
        let corners = meshes.iter().map(|mesh| mesh.positions.len() / 3).sum();
        let mut part = Part {
            name,
            aliases,
            positions: Vec::with_capacity(corners),
            triangles: Vec::with_capacity(meshes.iter().map(|mesh| mesh.indices.len() / 3).sum()),
            coarse: Vec::new(),
        };
        for mesh in meshes {
            // `is_sound` checked each mesh's corners; their sum must fit in 32 bits, too
            let Ok(first) = u32::try_from(part.positions.len()) else { break };
            let (corners, _) = mesh.positions.as_chunks::<3>();
            let Ok(last) = u32::try_from(part.positions.len() + corners.len()) else { break };
            let place = |&[x, y, z]: &[f32; 3]| {
                let [ox, oy, oz] = mesh.origin;
                DVec3::from_array(to_file([ox + f64::from(x), oy + f64::from(y), oz + f64::from(z)]))
            };
            part.positions.extend(corners.iter().map(place));
            let (triangles, _) = mesh.indices.as_chunks::<3>();
            part.triangles.extend(triangles.iter().map(|triangle| triangle.map(|corner| first + corner)));
            part.coarse.push(CornerPrecision { corners: first..last, step_m: step(mesh), is_float: true });
        }
        self.triangles += part.triangles.len() as u64;
        part
    }

    /// Brings the parts from the reader's metres into the file's own unit, as a model of any format has it. Of the steps
    /// those remain that are coarser than `told_step`, in that unit as well.
    pub(super) fn in_units_of_file(&mut self, unit_m: f64, told_step: f64) {
        for part in &mut self.parts {
            if unit_m != 1.0 {
                part.positions.iter_mut().for_each(|corner| *corner /= unit_m);
                part.coarse.iter_mut().for_each(|run| run.step_m /= unit_m);
            }
            part.coarse.retain(|run| run.step_m > told_step);
        }
    }
}

/// Whether a mesh's corners are finite, and its triangles have valid indices.
fn is_sound(mesh: &MeshData) -> bool {
    let corners = u32::try_from(mesh.positions.len() / 3).unwrap_or(0);
    mesh.positions.iter().all(|number| number.is_finite())
        && mesh.origin.iter().all(|number| number.is_finite())
        && mesh.indices.iter().all(|&corner| corner < corners)
}

/// The step between neighbouring numbers at a mesh's farthest point from its own origin.
fn step(mesh: &MeshData) -> f64 {
    let farthest = mesh.positions.iter().fold(0.0_f32, |farthest, number| farthest.max(number.abs()));
    f64::from(farthest.next_up()) - f64::from(farthest)
}

/// The name of a mesh's style. For parts of windows and doors without a style the reader invents names, which are
/// ignored.
fn style_name(mesh: &MeshData) -> Option<String> {
    let name = mesh.material_name.as_deref()?.trim();
    let is_made_up = ["Window_Glass", "Door_Glass"].contains(&name)
        || ["Window_Frame_", "Door_Frame_"].iter().any(|start| name.starts_with(start));
    (!name.is_empty() && !is_made_up).then(|| name.to_owned())
}

/// Whether the file says that a mesh is translucent. For types without a style the reader invents translucent colours.
fn is_translucent(mesh: &MeshData, kind: &IfcType) -> bool {
    mesh.color[3] < 1.0 && mesh.color != default_color_for_type(kind.clone()).to_array()
}
