//! Sums the time in the sun on patches: the instants, and the times between them at which texels change.

use super::gaps::{Gap, Gaps};
use super::{Event, OnEvent, StudyError, tell};
use crate::shadow::soft_texture::{Sample, SoftTexture, TextureGap};
use crate::site::Site;
use crate::sun::{Instant, disc};
use glam::DVec3;

/// So many texels are searched before a listener is asked whether to go on: a fraction of a second.
const TEXELS_AT_ONCE: usize = 1 << 18;
/// The same, of moments that an adapter draws.
const MOMENTS_AT_ONCE: usize = 4;

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

    /// Whether the time before an instant is searched.
    pub(super) fn searches_before(&self, at: usize) -> bool {
        self.gaps.before(at).is_some()
    }

    /// Adds an instant and the gap before it.
    ///
    /// # Errors
    /// [`StudyError::Interrupted`] within the gap if the listener ends the work; the sums are of no use then.
    pub(super) fn add(&mut self, at: usize, on_event: &mut OnEvent<'_>) -> Result<(), StudyError> {
        let instant = &self.site.track.instants[at];
        if instant.night {
            return Ok(());
        }
        if !self.gaps.touch(at) {
            return Ok(self.texture.add(&samples_of(instant, self.site.settings.sun_samples))?);
        }
        if self.texture.is_on_adapter() {
            return self.add_by_steps(at, on_event);
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
            let suns = (0..=gap.steps()).map(|step| gap.sun_at(step)).collect::<Result<Vec<_>, _>>()?;
            let secs_before_change = |step: u32| gap.secs_before_change(step);
            let between = TextureGap { ends: [&before, &after], suns: &suns, secs_before_change };
            for part in self.texture.parts(TEXELS_AT_ONCE) {
                self.texture.add_between(part, &between);
                tell(on_event, Event::Between)?;
            }
        }
        self.before = Some((at, after));
        Ok(())
    }

    /// The same for an adapter, which fills textures that stay on it. All moments are drawn, like the instants of a
    /// study whose step is the resolution, so that a texel that changes several times in a gap is right, too.
    fn add_by_steps(&mut self, at: usize, on_event: &mut OnEvent<'_>) -> Result<(), StudyError> {
        let sample = |to_sun: DVec3, weight: u32| Sample { light: to_sun.extend(0.0), weight };
        let mut samples = Vec::new();
        for moment in self.gaps.before(at).iter().flat_map(Gap::moments) {
            let (to_sun, secs) = moment?;
            samples.push(sample(to_sun, secs));
        }
        samples.push(sample(self.site.track.instants[at].to_sun, self.gaps.secs_among_moments(at)));
        for samples in samples.chunks(MOMENTS_AT_ONCE) {
            self.texture.add(samples)?;
            tell(on_event, Event::Between)?;
        }
        Ok(())
    }
}

/// An instant's samples: the sun's centre, or points of its disc.
fn samples_of(instant: &Instant, sun_samples: Option<u32>) -> Vec<Sample> {
    let sample = |to_sun: DVec3| Sample { light: to_sun.extend(0.0), weight: instant.weight_secs };
    match sun_samples {
        None => vec![sample(instant.to_sun)],
        Some(samples) => disc(instant.to_sun, samples).map(sample).collect(),
    }
}
