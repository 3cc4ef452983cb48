//! Reads the libraries, the asset and the scenes of a Collada file.

use super::document::{DaeDocument, DaeGeometry, DaeMaterial, DaeNode, DaeScene, DaeUp};
use super::effect;
use super::xml::{DaeXml, attribute, local_id};
use crate::formats::face_cutter::FaceCutter;
use crate::formats::left_out::{LeftOutTally, label};
use crate::message::{Message, message};
use quick_xml::events::BytesStart;
use rustc_hash::FxHashMap;

impl DaeDocument {
    pub(super) fn read(source: &str) -> Result<Self, Message> {
        let mut document = Self {
            unit_m: None,
            odd_unit: None,
            up: None,
            geometries: FxHashMap::default(),
            nodes: Vec::new(),
            node_of: FxHashMap::default(),
            scenes: Vec::new(),
            scene: None,
            materials: FxHashMap::default(),
            effects: FxHashMap::default(),
            left_out: LeftOutTally::default(),
            cutter: FaceCutter::new(),
            triangles: 0,
        };
        let mut xml = DaeXml::new(source);
        let root = xml.root()?;
        if root.local_name().as_ref() != "COLLADA" {
            let what = format!("is XML, but not Collada: its first element is `{}`", label(root.local_name().as_ref()));
            return Err(message![what; "export it again, as Collada (.dae)"]);
        }
        xml.children(|xml, name, _| document.library(xml, name))?;
        Ok(document)
    }

    fn library(&mut self, xml: &mut DaeXml, name: &str) -> Result<(), Message> {
        match name {
            "asset" => self.asset(xml),
            "library_geometries" => xml.each("geometry", |xml, element| DaeGeometry::read(xml, element, self)),
            "library_nodes" => xml.each("node", |xml, element| DaeNode::read(xml, element, self, 0).map(drop)),
            "library_visual_scenes" => xml.each("visual_scene", |xml, element| self.visual_scene(xml, element)),
            "library_materials" => xml.each("material", |xml, element| self.material(xml, element)),
            "library_effects" => xml.each("effect", |xml, element| {
                let id = attribute(element, "id").unwrap_or_default();
                let effect = effect::read(xml)?;
                self.effects.insert(id, effect);
                Ok(())
            }),
            "scene" => xml.each("instance_visual_scene", |xml, element| {
                self.scene = local_id(element, "url");
                xml.skip()
            }),
            _ => xml.skip(),
        }
    }

    fn asset(&mut self, xml: &mut DaeXml) -> Result<(), Message> {
        xml.children(|xml, name, element| match name {
            "unit" => {
                let metres = attribute(element, "meter").and_then(|text| text.trim().parse::<f64>().ok());
                self.unit_m = metres.filter(|metres| metres.is_finite() && *metres > 0.0);
                let said = |key: &str| attribute(element, key).map(|text| format!(" {key}=\"{}\"", label(&text)));
                let unit = ["name", "meter"].into_iter().filter_map(said).collect::<String>();
                self.odd_unit = self.unit_m.is_none().then(|| format!("<unit{unit}/>"));
                xml.skip()
            }
            "up_axis" => {
                self.up = match xml.word()?.as_str() {
                    "X_UP" => Some(DaeUp::X),
                    "Y_UP" => Some(DaeUp::Y),
                    "Z_UP" => Some(DaeUp::Z),
                    _ => None,
                };
                Ok(())
            }
            _ => xml.skip(),
        })
    }

    fn visual_scene(&mut self, xml: &mut DaeXml, element: &BytesStart) -> Result<(), Message> {
        let mut scene = DaeScene {
            id: attribute(element, "id").unwrap_or_default(),
            name: label(&attribute(element, "name").unwrap_or_default()),
            roots: Vec::new(),
        };
        xml.each("node", |xml, element| {
            scene.roots.push(DaeNode::read(xml, element, self, 0)?);
            Ok(())
        })?;
        self.scenes.push(scene);
        Ok(())
    }

    fn material(&mut self, xml: &mut DaeXml, element: &BytesStart) -> Result<(), Message> {
        let id = attribute(element, "id").unwrap_or_default();
        let name = label(&attribute(element, "name").unwrap_or_else(|| id.clone()));
        let mut material = DaeMaterial { name, effect: None };
        xml.each("instance_effect", |xml, element| {
            material.effect = local_id(element, "url");
            xml.skip()
        })?;
        self.materials.insert(id, material);
        Ok(())
    }
}
