//! Makes parts of nodes and their geometries.

use super::document::{DaeDocument, DaeGeometry, DaeMaterial, DaeNode, DaeUp, GeometryInstance};
use super::node::MOST_DEPTH;
use crate::formats::left_out::LeftOutTally;
use crate::formats::vertices::VertexPicker;
use crate::formats::{MAX_COMPONENTS, MAX_TRIANGLES, Model, SeeThrough, Up};
use crate::mesh::Part;
use crate::message::{Message, message, setting};
use glam::{DAffine3, DMat3, DVec3};
use std::collections::BTreeMap;

/// The most placed nodes, counted once for each place.
const MOST_NODES: u64 = 4_000_000;

/// The most names of enclosing nodes that select a part.
const MOST_NAMES: usize = 16;

pub(super) fn model_of(mut document: DaeDocument) -> Result<Model, Message> {
    let scene = match &document.scene {
        Some(id) => document.scenes.iter().position(|scene| scene.id == *id),
        None => (!document.scenes.is_empty()).then_some(0),
    };
    let mut model = Model { unit_m: document.unit_m, up_is_said: document.up.is_some(), ..Model::default() };
    if let Some(unit) = &document.odd_unit {
        let what = format!("says {unit}, which is not a length in metres, so its numbers are taken as metres");
        model.notes.push(
            message![what; "write ", setting("[[model]]", "scale", "`scale` under [[model]]"), " if they are not"],
        );
    }
    let upright = match document.up {
        Some(DaeUp::Z) => {
            model.up = Up::Z;
            DAffine3::IDENTITY
        }
        // with x up, the right-hand side is −y
        Some(DaeUp::X) => DAffine3::from_mat3(DMat3::from_cols(DVec3::Y, DVec3::NEG_X, DVec3::Z)),
        Some(DaeUp::Y) | None => DAffine3::IDENTITY,
    };
    let mut left_out = std::mem::take(&mut document.left_out);
    let mut placer = NodePlacer::new(&document, &mut left_out);
    for &root in scene.and_then(|scene| document.scenes.get(scene)).map_or(&[][..], |scene| &scene.roots) {
        placer.place(root, upright, 0)?;
    }
    let see_through = std::mem::take(&mut placer.see_through);
    model.parts = placer.parts;
    model.see_through = see_through.into_iter().map(|(material, parts)| SeeThrough { material, parts }).collect();
    model.notes.extend(document.cutter.crossing_note());
    model.left_out = left_out.into_left_out();
    if let Some(read) = scene.and_then(|scene| document.scenes.get(scene)).filter(|_| document.scenes.len() > 1) {
        let what = format!("has {} scenes, of which only `{}` is read", document.scenes.len(), read.name);
        model.notes.push(message![what; "export the others on their own"]);
    }
    Ok(model)
}

struct NodePlacer<'a> {
    document: &'a DaeDocument,
    left_out: &'a mut LeftOutTally,
    parts: Vec<Part>,
    see_through: BTreeMap<String, Vec<usize>>,
    picker: VertexPicker,
    /// The names of the nodes from the root to the current one.
    path: Vec<&'a str>,
    /// How many of those are placed in a way that is not read.
    astray: usize,
    nodes: u64,
    triangles: u64,
}

/// The triangles of a geometry with one material of an instance.
struct MaterialSurface<'a> {
    material: Option<&'a DaeMaterial>,
    name: &'a str,
    geometry: &'a DaeGeometry,
    triangles: &'a [[u32; 3]],
}

impl<'a> NodePlacer<'a> {
    fn new(document: &'a DaeDocument, left_out: &'a mut LeftOutTally) -> Self {
        Self {
            document,
            left_out,
            parts: Vec::new(),
            see_through: BTreeMap::new(),
            picker: VertexPicker::default(),
            path: Vec::new(),
            astray: 0,
            nodes: 0,
            triangles: 0,
        }
    }

    /// Places a node with everything below it, and the nodes that it instantiates.
    fn place(&mut self, node: usize, model_from_parent: DAffine3, depth: usize) -> Result<(), Message> {
        self.nodes += 1;
        if depth > 2 * MOST_DEPTH || self.nodes > MOST_NODES {
            return Err(message![
                "has nodes that contain themselves, or more nodes than can be placed"; "repair the model and export it again"
            ]);
        }
        let document = self.document;
        let Some(node) = document.nodes.get(node) else { return Ok(()) };
        let model_from_node = model_from_parent * node.parent_from_node;
        if !model_from_node.is_finite() {
            let what = format!("has the node `{}` at coordinates that are too large", node.name);
            return Err(message![what; "repair the model and export it again"]);
        }
        self.path.push(&node.name);
        self.astray += usize::from(node.is_astray);
        self.geometries(node, model_from_node)?;
        for &child in &node.children {
            self.place(child, model_from_node, depth + 1)?;
        }
        for id in &node.instances {
            match document.node_of.get(id) {
                Some(&instance) => self.place(instance, model_from_node, depth + 1)?,
                None => self.left_out.add("instances of nodes", "the node is not in the file"),
            }
        }
        self.path.pop();
        self.astray -= usize::from(node.is_astray);
        Ok(())
    }

    fn geometries(&mut self, node: &'a DaeNode, model_from_node: DAffine3) -> Result<(), Message> {
        let mut surfaces: Vec<MaterialSurface> = Vec::new();
        for instance in &node.geometries {
            match self.document.geometries.get(&instance.geometry) {
                Some(geometry) => surfaces.extend(self.surfaces(instance, geometry)),
                None => self.left_out.add("instances of geometries", "the geometry is not in the file"),
            }
        }
        // each material once, in order of appearance
        let mut names: Vec<&str> = Vec::new();
        for surface in &surfaces {
            if !names.contains(&surface.name) {
                names.push(surface.name);
            }
        }
        let node = self.path.iter().rev().find(|name| !name.is_empty()).copied().unwrap_or("node");
        for &material in &names {
            let of_material = surfaces.iter().filter(|surface| surface.name == material);
            self.part(of_material, (node, material), names.len() == 1, model_from_node)?;
        }
        Ok(())
    }

    fn surfaces<'s>(
        &self,
        instance: &'s GeometryInstance,
        geometry: &'a DaeGeometry,
    ) -> impl Iterator<Item = MaterialSurface<'a>> + use<'a, 's> {
        let document = self.document;
        geometry.surfaces.iter().map(move |(symbol, triangles)| {
            let symbol = symbol.as_deref();
            let bound = instance.materials.iter().find(|(bound, _)| Some(bound.as_str()) == symbol);
            let material = bound.and_then(|(_, id)| document.materials.get(id));
            let name = material.map(|material| material.name.as_str()).or(symbol).unwrap_or("default");
            MaterialSurface { material, name, geometry, triangles }
        })
    }

    fn part<'s>(
        &mut self,
        surfaces: impl Iterator<Item = &'s MaterialSurface<'a>>,
        (node, material): (&str, &str),
        is_one: bool,
        model_from_node: DAffine3,
    ) -> Result<(), Message>
    where
        'a: 's,
    {
        let name = if is_one { node.to_owned() } else { format!("{node}/{material}") };
        let mut part = Part { name, ..Part::default() };
        let mut aliases: Vec<&str> =
            self.path.iter().rev().filter(|name| !name.is_empty()).take(MOST_NAMES).copied().collect();
        let mirrors = model_from_node.matrix3.determinant() < 0.0;
        let mut is_faded = false;
        for surface in surfaces {
            self.triangles += surface.triangles.len() as u64;
            if self.triangles > MAX_TRIANGLES {
                let what = format!("has more than {MAX_TRIANGLES} triangles, instances counted");
                return Err(message![what; "export it in parts or with less detail"]);
            }
            let mut triangles = surface.triangles.to_vec();
            let picked = self.picker.pick(&surface.geometry.positions, &mut triangles);
            // cannot overflow: a part has at most three vertices per triangle
            let first = part.positions.len() as u32;
            part.positions.extend(picked.iter().map(|&point| model_from_node.transform_point3(point)));
            let turned = triangles.iter().map(|&[a, b, c]| if mirrors { [a, c, b] } else { [a, b, c] });
            part.triangles.extend(turned.map(|triangle| triangle.map(|vertex| first + vertex)));
            aliases.extend([surface.geometry.name.as_str()].iter().filter(|name| !name.is_empty()));
            is_faded |= surface.material.is_some_and(|material| self.document.is_see_through(material));
        }
        if part.triangles.is_empty() {
            return Ok(());
        }
        if self.astray > 0 {
            let what =
                format!("places the node `{node}` by a skew, a view or too few numbers, which Gnomon does not read");
            return Err(message![what; "export it again, with matrices"]);
        }
        if !part.positions.iter().all(|point| point.is_finite()) {
            let what = format!("has the node `{node}` at coordinates that are too large");
            return Err(message![what; "repair the model and export it again"]);
        }
        for alias in aliases.into_iter().chain([material]) {
            if !part.aliases.iter().any(|known| known == alias) {
                part.aliases.push(alias.to_owned());
            }
        }
        if is_faded {
            self.see_through.entry(material.to_owned()).or_default().push(self.parts.len());
        }
        self.parts.push(part);
        if self.parts.len() > MAX_COMPONENTS {
            let what = format!("has more than {MAX_COMPONENTS} components");
            return Err(message![what; "join its objects by material, and export it again"]);
        }
        Ok(())
    }
}
