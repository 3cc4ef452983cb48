//! Each component in its own colour, and the legend that names them.

use super::scale::{Rgb, mix};
use crate::mesh::Mesh;
use crate::view::Surface;
use std::f64::consts::TAU;

/// The colours of the largest components, which the legend names. P. Tol's "light" scheme (Colour Schemes, 2021), safe
/// for the colour-blind; its yellows come last, as volumes are yellow.
const NAMED: [Rgb; 8] = [
    [119, 170, 221], // light blue
    [238, 136, 102], // orange
    [68, 187, 153],  // mint
    [255, 170, 187], // pink
    [187, 204, 51],  // pear
    [153, 221, 255], // light cyan
    [170, 170, 0],   // olive
    [238, 221, 136], // light yellow
];

/// What casts no shadow is so much nearer to white.
const CASTS_NOTHING: f64 = 0.72;
const WHITE: Rgb = [255, 252, 246];

/// The colours of one picture's components.
pub(super) struct Components {
    /// Where each component's faces end, and its colour.
    colours: Vec<(u32, Rgb)>,
    /// The largest ones, and how many more there are.
    pub legend: Vec<(Rgb, String)>,
}

impl Components {
    /// `casts` says for each component of the mesh whether it casts. The larger a component is in the picture, the
    /// earlier it is named; what is not seen is not.
    pub(super) fn new(mesh: &Mesh, surface: &Surface, casts: &[bool]) -> Components {
        let at = |face: u32| mesh.components.partition_point(|component| component.faces.end <= face);
        let mut cells = vec![0_u32; mesh.components.len()];
        for &face in surface.face.iter().filter(|face| **face < Surface::GROUND) {
            if let Some(cells) = cells.get_mut(at(face)) {
                *cells += 1;
            }
        }
        let mut by_size: Vec<usize> = (0..cells.len()).filter(|&component| cells[component] > 0).collect();
        by_size.sort_by_key(|&component| std::cmp::Reverse(cells[component]));

        let mut colours: Vec<_> = mesh.components.iter().map(|component| (component.faces.end, WHITE)).collect();
        let mut legend = Vec::new();
        // one too many for its own line takes the line that would say so
        let named = if by_size.len() <= NAMED.len() + 1 { by_size.len() } else { NAMED.len() };
        for (rank, &component) in by_size.iter().enumerate() {
            let casts = casts.get(component).is_none_or(|casts| *casts);
            let own = NAMED.get(rank).copied().unwrap_or_else(|| further(rank - NAMED.len()));
            let colour = if casts { own } else { mix(own, WHITE, CASTS_NOTHING) };
            colours[component].1 = colour;
            if rank < named {
                let name = &mesh.components[component].name;
                legend.push((colour, if casts { name.clone() } else { format!("{name} (does not cast)") }));
            }
        }
        if by_size.len() > named {
            let last = by_size[by_size.len() - 1];
            legend.push((colours[last].1, format!("and {} more", by_size.len() - named)));
        }
        Components { colours, legend }
    }

    /// The colour of a face's component.
    pub(super) fn colour(&self, face: u32) -> Rgb {
        let at = self.colours.partition_point(|(end, _)| *end <= face);
        self.colours.get(at).map_or(WHITE, |(_, colour)| *colour)
    }
}

/// Quiet tones for the components that the legend does not name: hues a golden section apart, so that any two of them
/// that follow each other differ.
fn further(index: usize) -> Rgb {
    let hue = (0.55 + index as f64 * 0.618_034).fract() * TAU;
    let light = 214.0 - 14.0 * (index % 3) as f64;
    [0.0, 1.0, 2.0].map(|part| (light + 22.0 * (hue - part * TAU / 3.0).cos()).round() as u8)
}
