//! Builds parts from city objects, for CityJSON and CityGML: one part for each object and kind of surface.
//!
//! A roof can be selected without its walls, so each kind of an object's semantic surfaces becomes a part: three or
//! four per building, some 20,000 in a tile of 5,000 buildings. One level of detail of each object is used, and the
//! parts of a building replace its own geometry.

use super::face_cutter::FaceCutter;
use super::left_out::{LeftOutTally, counted, label};
use super::{Coordinates, MAX_TRIANGLES, Model, ModelFault, PartKind, Up};
use crate::mesh::{CornerPrecision, Part};
use crate::message::message;
use glam::DVec3;

/// The most kinds of surface of one object that become parts of their own; extensions may add any number.
const MOST_SURFACE_KINDS: usize = 40;

/// A virtual surface that closes an opening.
const CLOSURE: &str = "ClosureSurface";

/// An object's names.
pub(super) struct CityObjectName {
    /// `Building`.
    pub kind: String,
    /// The file's id of the object; empty if it has none.
    pub id: String,
    /// Other names that select it: the object that it is a part of, and its usual name.
    pub others: Vec<String>,
}

/// The quality of an object's geometry; the best one is used.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub(super) struct Rank {
    /// Whether it is closed.
    pub is_solid: bool,
    /// Its level of detail.
    pub lod: f64,
}

impl Rank {
    /// Whether it is a flat outline.
    pub(super) fn is_outline(self) -> bool {
        !self.is_solid && self.lod < 1.0
    }
}

/// Collects the parts of a file's objects, one object after the other.
pub(super) struct CityBuilder {
    parts: Vec<Part>,
    kinds: Vec<PartKind>,
    /// What was left out so far.
    pub tally: LeftOutTally,
    cutter: FaceCutter,
    triangles: u64,
    outlines: u64,
    unnamed: u64,
    /// The current object, and its parts so far, each with its kind of surface.
    open: Option<(CityObjectName, PartKind)>,
    surfaces: Vec<(String, Part)>,
    /// The step of the file's numbers, if it is coarse enough for a note.
    step: Option<f64>,
}

impl CityBuilder {
    /// `step` is that of the file's numbers. There is no note if it is finer than `told_step`.
    pub(super) fn new(step: Option<f64>, told_step: f64) -> Self {
        Self {
            parts: Vec::new(),
            kinds: Vec::new(),
            tally: LeftOutTally::default(),
            cutter: FaceCutter::new(),
            triangles: 0,
            outlines: 0,
            unnamed: 0,
            open: None,
            surfaces: Vec::new(),
            step: step.filter(|&step| step > told_step * (1.0 + 1e-9)),
        }
    }

    /// Begins an object; its faces follow.
    pub(super) fn object(&mut self, name: CityObjectName, rank: Rank) {
        self.close();
        let kind = kind_of(&name.kind, rank.is_solid);
        self.outlines += u64::from(rank.is_outline() && kind == PartKind::Building);
        self.open = Some((name, kind));
    }

    /// Adds a face of the object, with the kind of its surface if the file gives one. `is_turned` if it is seen from
    /// behind.
    pub(super) fn face(
        &mut self,
        surface: &str,
        points: &[DVec3],
        ends: &[usize],
        is_turned: bool,
    ) -> Result<(), ModelFault> {
        if surface == CLOSURE {
            self.tally.add(CLOSURE, "not built");
            return Ok(());
        }
        let cut = match self.cutter.cut(points, ends) {
            Ok(cut) => cut,
            Err(uncut) => {
                self.tally.add("faces", uncut.why());
                return Ok(());
            }
        };
        self.triangles += cut.triangles.len() as u64;
        if self.triangles > MAX_TRIANGLES {
            let what = format!("has more than {MAX_TRIANGLES} triangles, which is the most that a model may have");
            return Err(message![what; "export it in parts or with less detail"].into());
        }
        let known = self.surfaces.iter().position(|(kind, _)| kind == surface);
        let at = known.unwrap_or_else(|| {
            let kind = if self.surfaces.len() < MOST_SURFACE_KINDS { surface } else { "" };
            let joined = self.surfaces.iter().position(|(known, _)| known == kind);
            joined.unwrap_or_else(|| {
                self.surfaces.push((kind.to_owned(), Part::default()));
                self.surfaces.len() - 1
            })
        });
        let part = &mut self.surfaces[at].1;
        let first = u32::try_from(part.positions.len()).unwrap_or(u32::MAX);
        part.positions.extend_from_slice(points);
        part.triangles.extend(cut.triangles.iter().map(|corners| {
            let [a, b, c] = corners.map(|corner| first.saturating_add(corner));
            if is_turned { [a, c, b] } else { [a, b, c] }
        }));
        Ok(())
    }

    /// Ends the object.
    pub(super) fn close(&mut self) {
        let Some((name, kind)) = self.open.take() else { return };
        let id = if name.id.is_empty() {
            self.unnamed += 1;
            self.unnamed.to_string()
        } else {
            label(&name.id)
        };
        let type_name = label(&name.kind);
        for (surface, mut part) in self.surfaces.drain(..) {
            let surface = label(&surface);
            part.name = format!("{type_name} {id}");
            part.aliases = [&name.id, &name.kind].into_iter().chain(&name.others).map(|name| label(name)).collect();
            if !surface.is_empty() {
                part.name = format!("{}/{surface}", part.name);
                part.aliases.push(surface);
            }
            part.name = label(&part.name);
            part.aliases.retain(|alias| !alias.is_empty());
            let corners = u32::try_from(part.positions.len()).unwrap_or(u32::MAX);
            let coarse = self.step.map(|step_m| CornerPrecision { corners: 0..corners, step_m, is_float: false });
            part.coarse = coarse.into_iter().collect();
            self.parts.push(part);
            self.kinds.push(kind);
        }
    }

    /// The model: metres, z up.
    pub(super) fn finish(mut self, coordinates: Coordinates) -> Model {
        self.close();
        let mut notes: Vec<_> = self.cutter.crossing_note().into_iter().collect();
        if self.outlines > 0 {
            notes.push(message![
                format!("has {} with only a flat outline (LoD 0), which is read as a sheet", counted(self.outlines, "object"));
                "export LoD 1 or higher, or the outlines with heights as GeoJSON"
            ]);
        }
        Model {
            parts: self.parts,
            kinds: self.kinds,
            up: Up::Z,
            up_is_said: true,
            unit_m: Some(1.0),
            coordinates,
            left_out: self.tally.into_left_out(),
            notes,
            ..Model::default()
        }
    }
}

/// The default role of an object. For vegetation and water it depends on whether they are solids: a wood is a block
/// that casts, a lake is not.
fn kind_of(kind: &str, is_solid: bool) -> PartKind {
    const COVERS: [&str; 19] = [
        "WaterBody",
        "Road",
        "Railway",
        "Square",
        "TransportSquare",
        "Track",
        "Waterway",
        "LandUse",
        "TransportationComplex",
        "TrafficArea",
        "AuxiliaryTrafficArea",
        "TrafficSpace",
        "AuxiliaryTrafficSpace",
        "ClearanceSpace",
        "Section",
        "Intersection",
        "Marking",
        "Hole",
        "WaterSurface",
    ];
    match kind {
        "TINRelief" | "ReliefFeature" | "RasterRelief" => PartKind::Terrain,
        "PlantCover" if !is_solid => PartKind::GroundCover,
        _ if COVERS.contains(&kind) => PartKind::GroundCover,
        _ => PartKind::Building,
    }
}

/// Whether objects of this kind lie inside others that enclose them.
pub(super) fn is_inside(kind: &str) -> bool {
    const INSIDE: [&str; 13] = [
        "BuildingRoom",
        "Room",
        "BuildingFurniture",
        "BuildingStorey",
        "Storey",
        "BuildingUnit",
        "IntBuildingInstallation",
        "BridgeRoom",
        "BridgeFurniture",
        "IntBridgeInstallation",
        "TunnelFurniture",
        "TunnelHollowSpace",
        "HollowSpace",
    ];
    INSIDE.contains(&kind)
}

/// Whether objects of this kind make up the object that they belong to.
pub(super) fn is_part(kind: &str) -> bool {
    matches!(kind, "BuildingPart" | "BridgePart" | "TunnelPart")
}
