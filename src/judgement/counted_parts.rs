//! The parts of an area that count, as triangles.

use super::narrow::{union, wide_rings, within_both};
use super::triangles::{PartTriangle, triangles, triangles_of_faces};
use crate::rules::RuleReceiver;
use crate::site::{AreaSurface, JudgedArea};
use glam::{DVec2, DVec3};

/// The parts of an area that count.
#[derive(Clone, Debug)]
pub struct CountedParts {
    /// Triangles that cover them.
    pub triangles: Vec<PartTriangle>,
    /// The square metres of what is too narrow to count, in plan.
    pub narrow_m2: f64,
}

impl CountedParts {
    /// The parts of an area that a rule counts.
    pub fn of(receiver: &RuleReceiver, area: &JudgedArea) -> CountedParts {
        let least_m = if let RuleReceiver::Area { least_width_m } = receiver { *least_width_m } else { 0.0 };
        let AreaSurface::Faces(faces) = &area.surface else {
            let (rings, narrow_m2) = wide_rings(&area.rings, least_m);
            return CountedParts { triangles: triangles(&rings), narrow_m2 };
        };
        if least_m <= 0.0 {
            return CountedParts { triangles: triangles_of_faces(faces), narrow_m2: 0.0 };
        }
        let plans: Vec<Vec<DVec2>> = faces.iter().map(|face| face.map(DVec3::truncate).to_vec()).collect();
        let (wide, narrow_m2) = wide_rings(&union(&plans), least_m);
        let triangles = match narrow_m2 > 0.0 {
            true => {
                faces.iter().zip(plans).flat_map(|(face, plan)| on_face(face, &within_both(&[plan], &wide))).collect()
            }
            false => triangles_of_faces(faces),
        };
        CountedParts { triangles, narrow_m2 }
    }

    /// Their size, square metres.
    pub fn m2(&self) -> f64 {
        self.triangles.iter().map(|part| part.m2).sum()
    }
}

/// Rings in plan as triangles of the face below them.
fn on_face([a, b, c]: &[DVec3; 3], rings: &[Vec<DVec2>]) -> Vec<PartTriangle> {
    let normal = (b - a).cross(c - a);
    let raised = |at: DVec3| at.with_z(a.z - normal.truncate().dot(at.truncate() - a.truncate()) / normal.z);
    let faces: Vec<[DVec3; 3]> = triangles(rings).iter().map(|part| part.corners.map(raised)).collect();
    triangles_of_faces(&faces)
}
