//! Each component in its own colour, and the legend that names them.

use super::scale::{Rgb, mix};
use crate::mesh::Mesh;
use crate::view::Surface;
use glam::Vec3;
use std::f64::consts::TAU;

/// The colours of the largest components, which the legend names. P. Tol's "light" scheme (Colour Schemes, 2021), safe
/// for the colour-blind.
const NAMED: [Rgb; 8] = [
    [68, 187, 153],  // mint
    [238, 221, 136], // light yellow
    [153, 221, 255], // light cyan
    [238, 136, 102], // orange
    [255, 170, 187], // pink
    [119, 170, 221], // light blue
    [187, 204, 51],  // pear
    [170, 170, 0],   // olive
];
/// How much the colours are mixed with white, so that light and shade still show on them.
const SOFTER: f64 = 0.38;

/// The same for a component that casts no shadow.
const CASTS_NOTHING: f64 = 0.72;
const WHITE: Rgb = [255, 252, 246];

/// The colours of the components in one picture.
pub(super) struct Components {
    /// The end of each component's faces, and its colour.
    colours: Vec<(u32, Rgb)>,
    /// The largest visible components, and how many more there are.
    pub legend: Vec<(Rgb, String)>,
}

impl Components {
    /// `casts` says for each component of the mesh whether it casts a shadow. Colours are chosen by area among the
    /// visible components, so that they do not depend on which cast.
    pub(super) fn new(mesh: &Mesh, surface: &Surface, casts: &[bool]) -> Components {
        let mut seen = vec![false; mesh.components.len()];
        for &face in surface.face.iter().filter(|face| **face < Surface::GROUND) {
            let at = mesh.components.partition_point(|component| component.faces.end <= face);
            seen[at.min(mesh.components.len() - 1)] = true;
        }
        let seen = (0..seen.len()).filter(|&component| seen[component]);
        let mut by_size: Vec<(usize, f64)> = seen.map(|component| (component, area(mesh, component))).collect();
        by_size.sort_by(|a, b| b.1.total_cmp(&a.1));

        let mut colours: Vec<_> = mesh.components.iter().map(|component| (component.faces.end, WHITE)).collect();
        let mut legend = Vec::new();
        // a single one left over takes no more room than the line that would count it
        let named = if by_size.len() == NAMED.len() + 1 { by_size.len() } else { NAMED.len() };
        for (rank, &(component, _)) in by_size.iter().enumerate() {
            let casts = casts.get(component).is_none_or(|casts| *casts);
            let colour = colour(rank, casts);
            colours[component].1 = colour;
            if rank < named {
                let name = &mesh.components[component].name;
                legend.push((colour, if casts { name.clone() } else { format!("{name} (does not cast)") }));
            }
        }
        if by_size.len() > named {
            legend.push((WHITE, format!("and {} more", by_size.len() - named)));
        }
        Components { colours, legend }
    }

    /// The colour of a face's component.
    pub(super) fn colour(&self, face: u32) -> Rgb {
        let at = self.colours.partition_point(|(end, _)| *end <= face);
        self.colours.get(at).map_or(WHITE, |(_, colour)| *colour)
    }
}

/// The colour of each component, chosen by its area among all; `casts` says which ones cast.
pub fn of_all(mesh: &Mesh, casts: &[bool]) -> Vec<Rgb> {
    let mut by_size: Vec<(usize, f64)> = (0..mesh.components.len()).map(|at| (at, area(mesh, at))).collect();
    by_size.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut colours = vec![WHITE; mesh.components.len()];
    for (rank, &(component, _)) in by_size.iter().enumerate() {
        colours[component] = colour(rank, casts.get(component).is_none_or(|casts| *casts));
    }
    colours
}

/// The colour of the component with this rank in size.
fn colour(rank: usize, casts: bool) -> Rgb {
    let own = NAMED.get(rank).map(|named| mix(*named, WHITE, SOFTER));
    let own = own.unwrap_or_else(|| further(rank - NAMED.len()));
    if casts { own } else { mix(own, WHITE, CASTS_NOTHING) }
}

/// The area of a component's faces, square metres.
fn area(mesh: &Mesh, component: usize) -> f64 {
    let faces = mesh.components[component].faces.clone();
    let area = |[a, b, c]: [Vec3; 3]| f64::from((b - a).cross(c - a).length()) / 2.0;
    faces.map(|face| area(mesh.corners(face as usize))).sum()
}

/// Muted colours for further components: hues a golden section apart, so that any two in sequence differ.
fn further(index: usize) -> Rgb {
    let hue = (0.55 + index as f64 * 0.618_034).fract() * TAU;
    let light = 232.0 - 10.0 * (index % 3) as f64;
    [0.0, 1.0, 2.0].map(|part| (light + 13.0 * (hue - part * TAU / 3.0).cos()).round() as u8)
}
