//! Sums the time in the sun on patches: the instants, and the times between them at which texels change.

use super::StudyError;
use super::gaps::{Gap, Gaps};
use crate::shadow::soft_texture::{Moment, Sample, SoftTexture};
use crate::site::Site;
use crate::sun::{Instant, SunError, disc};
use glam::DVec3;

/// The running sum for the texels of a texture.
pub(super) struct PatchSum<'a> {
    site: &'a Site,
    gaps: Gaps<'a>,
    texture: &'a mut SoftTexture,
    /// The instant at which the current gap begins, and which texels see the sun then.
    before: Option<(usize, Vec<u8>)>,
}

impl<'a> PatchSum<'a> {
    pub(super) fn new(site: &'a Site, resolution_secs: u32, texture: &'a mut SoftTexture) -> PatchSum<'a> {
        PatchSum { site, gaps: Gaps::new(site, resolution_secs), texture, before: None }
    }

    /// Continues from earlier sums.
    pub(super) fn begin_with(&mut self, sums: &[u32]) {
        self.texture.begin_with(sums);
    }

    /// The sums so far.
    pub(super) fn so_far(&self) -> Result<Vec<u32>, StudyError> {
        Ok(self.texture.so_far()?)
    }

    /// Adds an instant and the gap before it.
    pub(super) fn add(&mut self, at: usize) -> Result<(), StudyError> {
        let instant = &self.site.track.instants[at];
        if instant.night {
            return Ok(());
        }
        if !self.gaps.touch(at) {
            return Ok(self.texture.add(&samples_of(instant, self.site.settings.sun_samples))?);
        }
        if self.texture.is_on_adapter() {
            return self.add_by_steps(at);
        }
        let gap = self.gaps.before(at);
        let before = match (gap, self.before.take()) {
            (None, _) => None,
            (_, Some((last, seen))) if last + 1 == at => Some(seen),
            // the study continues here
            _ => Some(self.texture.seen(self.site.track.instants[at - 1].to_sun)?),
        };
        let after = self.texture.seen(instant.to_sun)?;
        self.texture.add_seen(&after, self.gaps.own_secs(at));
        if let (Some(gap), Some(before)) = (gap, before) {
            self.texture.add_between([&before, &after], &searched(&gap)?);
        }
        self.before = Some((at, after));
        Ok(())
    }

    /// The same for an adapter, which fills textures that stay on it. All moments are drawn, like the instants of a
    /// study whose step is the resolution, so that a texel that changes several times in a gap is right, too.
    fn add_by_steps(&mut self, at: usize) -> Result<(), StudyError> {
        let sample = |to_sun: DVec3, weight: u32| Sample { light: to_sun.extend(0.0), weight };
        let mut samples = Vec::new();
        for moment in self.gaps.before(at).iter().flat_map(Gap::moments) {
            let (to_sun, secs) = moment?;
            samples.push(sample(to_sun, secs));
        }
        samples.push(sample(self.site.track.instants[at].to_sun, self.gaps.secs_among_moments(at)));
        Ok(self.texture.add(&samples)?)
    }
}

/// The moments of a gap, including its ends.
fn searched(gap: &Gap<'_>) -> Result<Vec<Moment>, SunError> {
    let moment = |step| Ok(Moment { to_sun: gap.sun_at(step)?, secs_before_change: gap.secs_before_change(step) });
    (0..=gap.steps()).map(moment).collect()
}

/// The samples of an instant: the sun's centre, or points of its disc.
fn samples_of(instant: &Instant, sun_samples: Option<u32>) -> Vec<Sample> {
    let sample = |to_sun: DVec3| Sample { light: to_sun.extend(0.0), weight: instant.weight_secs };
    match sun_samples {
        None => vec![sample(instant.to_sun)],
        Some(samples) => disc(instant.to_sun, samples).map(sample).collect(),
    }
}
