//! The hours of sun on the model's patches as files: numbers in `surfaces.csv`, a coloured model in `surfaces.glb`. The
//! drawing is [`figure::patches`](super::figure::patches).

mod glb;
pub(super) mod pages;

pub use glb::glb;
pub use pages::Atlas;

use super::figure::duration;
use super::figure::scale::Bands;
use super::names::{field, plain};
use crate::mesh::Mesh;
use crate::mesh::patches::{Patch, Patches};
use crate::sun::{Place, SunTrack};
use crate::sunlight::{Exposure, PatchHours};
use std::fmt::Write;

/// The hours of sun on patches, with their context.
#[derive(Clone, Copy, Debug)]
pub struct PatchContext<'a> {
    /// The place on Earth.
    pub place: &'a Place,
    /// The instants studied.
    pub track: &'a SunTrack,
    /// The mesh that has the patches.
    pub mesh: &'a Mesh,
    /// For each component of the mesh, whether it receives.
    pub receives: &'a [bool],
    /// The patches of the components that receive.
    pub patches: &'a Patches,
    /// Their time in the sun.
    pub hours: &'a PatchHours,
}

impl PatchContext<'_> {
    /// The bands of the drawing's colours.
    pub fn bands(&self) -> Bands {
        Bands::new(self.track.step_secs, self.hours.day_secs)
    }

    /// Components with patches, in the mesh's order.
    pub(super) fn components(&self) -> impl Iterator<Item = (&str, &[Patch], Exposure)> {
        self.mesh.components.iter().enumerate().filter_map(|(index, component)| {
            let exposure = self.hours.of_component(self.patches, index as u32)?;
            let patches = &self.patches.list[self.patches.of_component(index as u32)];
            Some((component.name.as_str(), patches, exposure))
        })
    }
}

/// `surfaces.csv`: for each component a line with the patch `all`, then a line for each of its patches, numbered from
/// 1, the largest first. Lines end in CR LF (RFC 4180).
/// Areas are in square metres; hours are hours of sun. Azimuths are clockwise from true north, and absent for level
/// patches and in lines for `all`. Tilts are 0 for surfaces that face up, 90 for walls, 180 for surfaces that face
/// down. Shares, 0 to 1, are the part of the area that has at least the hours in the column's name.
pub fn csv(found: &PatchContext) -> String {
    let mut text = "component,patch,area_m2,azimuth_deg,tilt_deg,hours_mean,hours_min,hours_max,\
                    share_1h,share_2h,share_3h,share_4h\r\n"
        .to_owned();
    let mut line = |name: &str, patch: &str, azimuth: &str, tilt: &str, exposure: &Exposure| {
        let Exposure { area_m2, hours_mean, hours_min, hours_max, shares: [one, two, three, four] } = exposure;
        // Writing to a String cannot fail.
        let _ = write!(
            text,
            "{name},{patch},{area_m2:.6},{azimuth},{tilt},{hours_mean:.4},{hours_min:.4},{hours_max:.4},\
             {one:.4},{two:.4},{three:.4},{four:.4}\r\n"
        );
    };
    for (name, patches, exposure) in found.components() {
        let name = field(name);
        line(&name, "all", "", "", &exposure);
        for (index, patch) in patches.iter().enumerate() {
            let azimuth = patch.azimuth_deg().map(azimuth_text).unwrap_or_default();
            let tilt = format!("{:.2}", patch.tilt_deg());
            line(&name, &(index + 1).to_string(), &azimuth, &tilt, &found.hours.of_patch(patch));
        }
    }
    text
}

/// An angle from 0 to below 360 degrees, so that north is always 0.
fn azimuth_text(azimuth_deg: f64) -> String {
    let hundredths = (azimuth_deg * 100.0).round().rem_euclid(36_000.0);
    // + 0 turns −0 into 0
    format!("{:.2}", hundredths / 100.0 + 0.0)
}

/// The result, one line per component, the largest areas first; ends with a line break.
pub(crate) fn summary(found: &PatchContext) -> String {
    let patches = found.patches;
    let mut text = format!(
        "{} patches, {} texels of {:.3} m; {} of daylight\n",
        patches.list.len(),
        patches.texels.len(),
        patches.cell,
        duration(found.hours.day_secs)
    );
    let mut components: Vec<_> = found.components().collect();
    components.sort_by(|(_, _, one), (_, _, other)| other.area_m2.total_cmp(&one.area_m2));
    for (name, _, exposure) in components.iter().take(MOST_LINES) {
        let Exposure { area_m2, hours_mean, hours_min, hours_max, .. } = exposure;
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "{}: {area_m2:.0} m², {hours_mean:.2} h of sun ({hours_min:.2} to {hours_max:.2})",
            plain(name)
        );
    }
    if let Some(more) = components.len().checked_sub(MOST_LINES).filter(|more| *more > 0) {
        let _ = writeln!(text, "and {more} smaller components");
    }
    text
}

/// The greatest number of components that the terminal lists.
const MOST_LINES: usize = 12;
