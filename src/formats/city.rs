//! The part that CityJSON and CityGML share: city objects → parts, one for each object and kind of surface.
//!
//! A roof can be selected without its walls, so an object's semantic surfaces are parts of their own: three or four per
//! building, some 20,000 in a tile of 5,000 buildings. One LoD of each object is taken, and parts of a building replace
//! the building's own geometry.

use super::face_cutter::FaceCutter;
use super::left_out::{LeftOutTally, counted, label};
use super::{Coordinates, MAX_TRIANGLES, Model, ModelFault, PartKind, Up};
use crate::mesh::{CornerPrecision, Part};
use crate::message::message;
use glam::DVec3;

/// Kinds of surface of one object that are told apart; extensions may name any number.
const MOST_SURFACE_KINDS: usize = 40;

/// A surface that a model closes its openings with, and that is not built.
const CLOSURE: &str = "ClosureSurface";

/// What an object is.
pub(super) struct CityObjectName {
    /// `Building`.
    pub kind: String,
    /// The file's id of the object; empty if it has none.
    pub id: String,
    /// Other names by which it can be selected: the object that it is a part of, and its name for people.
    pub others: Vec<String>,
}

/// How good a geometry of an object is: the best is what stands there.
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
    /// What was left out.
    pub tally: LeftOutTally,
    cutter: FaceCutter,
    triangles: u64,
    outlines: u64,
    unnamed: u64,
    /// The open object, and its parts so far, each with the kind of its surfaces.
    open: Option<(CityObjectName, PartKind)>,
    surfaces: Vec<(String, Part)>,
    /// The step of the file's numbers, where it is so coarse that a note says it.
    step: Option<f64>,
}

impl CityBuilder {
    /// `step` is that of the file's numbers; where it is finer than `told_step`, there is no note.
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

    /// A face of the object, with the kind of its surface where the file says it. `is_turned` where it is seen from behind.
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
                format!("has {} of which there is a flat outline alone (LoD 0), which lies there as a sheet", counted(self.outlines, "object"));
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

/// What an object does where nobody says it. Vegetation and water that are given as solids: a wood is a block that casts, a
/// lake is not.
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

/// Whether objects of this kind lie inside of others, which enclose them already.
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
