//! The work of counting as colours of cells, after figures 3-5 and 3-9 of E. Chan's thesis (*Efficient Shadow
//! Algorithms on Graphics Hardware*, 2004).

use super::scale::{Rgb, mix};
use crate::view::{Decider, FragmentCounts};

/// The diagrams of the work of counting.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Diagram {
    /// Which method decided each cell, and with what result.
    Mask,
    /// The number of counted fragments, as brightness.
    Overdraw,
}

/// The thesis's colours, a little quieter.
const MAP_SHADOW: Rgb = [196, 60, 48];
const MAP_LIGHT: Rgb = [122, 164, 220];
const VOLUME_SHADOW: Rgb = [12, 12, 14];
const VOLUME_LIGHT: Rgb = [70, 190, 80];

/// The colours for no fragment, and for the most in the picture.
const NO_FRAGMENT: Rgb = [18, 18, 22];
const MOST_FRAGMENTS: Rgb = [255, 255, 255];

/// The colours of a diagram, and their meaning.
#[derive(Clone, Debug)]
pub struct Colours {
    /// The colour of each cell, row 0 first.
    pub of_cells: Vec<Rgb>,
    /// What the colours measure.
    pub legend_head: String,
    /// Each colour with its meaning.
    pub legend: Vec<(Rgb, String)>,
}

impl Diagram {
    /// The title of the diagram's drawing.
    pub(super) fn title(self) -> &'static str {
        match self {
            Diagram::Mask => "Computation mask",
            Diagram::Overdraw => "Overdraw",
        }
    }
}

impl Colours {
    /// `None` if the mask is requested but there was none.
    pub fn of(counted: &FragmentCounts, diagram: Diagram) -> Option<Colours> {
        match diagram {
            Diagram::Mask => Some(of_mask(counted.decided.as_ref()?)),
            Diagram::Overdraw => Some(of_overdraw(counted)),
        }
    }
}

fn of_mask(decided: &[Decider]) -> Colours {
    let colour = |decided: &Decider| match decided {
        Decider::MapShadow => MAP_SHADOW,
        Decider::MapLight => MAP_LIGHT,
        Decider::VolumeShadow => VOLUME_SHADOW,
        Decider::VolumeLight => VOLUME_LIGHT,
    };
    let volumes = decided.iter().filter(|it| matches!(it, Decider::VolumeShadow | Decider::VolumeLight)).count();
    let legend = [
        (MAP_LIGHT, "sun, by the map"),
        (MAP_SHADOW, "shadow, by the map"),
        (VOLUME_LIGHT, "sun, by volumes"),
        (VOLUME_SHADOW, "shadow, by volumes"),
    ];
    Colours {
        of_cells: decided.iter().map(colour).collect(),
        legend_head: format!("Decided by volumes: {:.1}%", 100.0 * volumes as f64 / decided.len().max(1) as f64),
        legend: legend.map(|(colour, what)| (colour, what.to_owned())).to_vec(),
    }
}

/// Brightness grows with the square root of the number of fragments, since otherwise a few dense cells would leave all
/// others black.
fn of_overdraw(counted: &FragmentCounts) -> Colours {
    let most = counted.reached.iter().copied().max().unwrap_or(0).max(1);
    let colour = |fragments: u32| mix(NO_FRAGMENT, MOST_FRAGMENTS, (f64::from(fragments) / f64::from(most)).sqrt());
    let mut legend: Vec<u32> = vec![0, most.div_ceil(16), most.div_ceil(4), most];
    legend.dedup();
    let sum: u64 = counted.reached.iter().map(|&fragments| u64::from(fragments)).sum();
    Colours {
        of_cells: counted.reached.iter().map(|&fragments| colour(fragments)).collect(),
        legend_head: format!("Fragments counted a cell: {:.2}", sum as f64 / counted.reached.len().max(1) as f64),
        legend: legend.into_iter().map(|fragments| (colour(fragments), fragments.to_string())).collect(),
    }
}
