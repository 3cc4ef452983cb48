//! Time in the sun on flat patches, texel by texel.

use crate::mesh::patches::{Patch, Patches};

/// The time in the sun of every judged texel.
///
/// Sums are exact integers, the same on every machine.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PatchHours {
    /// For each texel of [`Patches::texels`], the seconds in the sun, each counted once for every sample that is seen.
    pub lit: Vec<u32>,
    /// The number of samples per instant: 1 for the sun's centre, more for points of its disc.
    pub samples: u32,
    /// Seconds of the window with the sun above the horizon.
    pub day_secs: u32,
    /// Seconds of the window with the sun below the horizon.
    pub night_secs: u32,
}

/// The hours of a patch, or of several together.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Exposure {
    /// The area of faces, square metres. Surfaces that exist twice, or lie between parts that touch, are left out here
    /// and in everything below.
    pub area_m2: f64,
    /// Mean hours of sun over the area.
    pub hours_mean: f64,
    /// Hours in the darkest texel.
    pub hours_min: f64,
    /// Hours in the sunniest texel.
    pub hours_max: f64,
    /// The shares of the area with at least 1, 2, 3 and 4 hours, 0 to 1.
    pub shares: [f64; 4],
}

impl PatchHours {
    /// Hours of sun of a texel, 0 to `day_secs / 3600`.
    pub fn hours(&self, texel: usize) -> f64 {
        f64::from(self.lit[texel]) / (f64::from(self.samples) * 3600.0)
    }

    /// The hours of a patch. Texels that count have equal weights.
    pub fn of_patch(&self, patch: &Patch) -> Exposure {
        let counts = |texel: &usize| patch.uncounted.binary_search(&(*texel as u32)).is_err();
        let texels = || (patch.texels.start as usize..patch.texels.end as usize).filter(counts);
        let count = (patch.texels.len() - patch.uncounted.len()) as f64;
        if count == 0.0 {
            return Exposure::default();
        }
        // whole seconds, so that an hour is an hour
        let at_least = |hours: u64| {
            let least = hours * 3600 * u64::from(self.samples);
            texels().filter(|&texel| u64::from(self.lit[texel]) >= least).count() as f64 / count
        };
        let hours = || texels().map(|texel| self.hours(texel));
        Exposure {
            area_m2: patch.area_m2,
            hours_mean: hours().sum::<f64>() / count,
            hours_min: hours().fold(f64::INFINITY, f64::min),
            hours_max: hours().fold(0.0, f64::max),
            shares: [1, 2, 3, 4].map(at_least),
        }
    }

    /// The hours of several patches together, weighted by their areas; `None` without a patch.
    pub fn of_patches<'a>(&self, patches: impl IntoIterator<Item = &'a Patch>) -> Option<Exposure> {
        let mut patches = patches.into_iter().peekable();
        patches.peek()?;
        let mut whole = Exposure { hours_min: f64::INFINITY, ..Exposure::default() };
        for of_patch in patches.map(|patch| self.of_patch(patch)).filter(|of_patch| of_patch.area_m2 > 0.0) {
            whole.area_m2 += of_patch.area_m2;
            whole.hours_mean += of_patch.hours_mean * of_patch.area_m2;
            whole.hours_min = whole.hours_min.min(of_patch.hours_min);
            whole.hours_max = whole.hours_max.max(of_patch.hours_max);
            for (whole, share) in whole.shares.iter_mut().zip(of_patch.shares) {
                *whole += share * of_patch.area_m2;
            }
        }
        if whole.area_m2 <= 0.0 {
            return Some(Exposure::default());
        }
        Some(Exposure {
            hours_mean: whole.hours_mean / whole.area_m2,
            shares: whole.shares.map(|share| share / whole.area_m2),
            ..whole
        })
    }

    /// The hours of a component; `None` if it has no patch.
    pub fn of_component(&self, patches: &Patches, component: u32) -> Option<Exposure> {
        self.of_patches(&patches.list[patches.of_component(component)])
    }
}
