//! Repeats work whose graphics device fails.

use super::{Event, OnEvent, StudyError, tell};
use crate::choice::{Engine, Finder};
use crate::gpu::{Gpu, GpuError};
use crate::shadow::ShadowError;
use crate::site::Site;
use std::sync::Arc;

/// Work on a site: on the given adapter, or without one on an adapter that it opens itself.
pub type Attempt<'a, T> = dyn FnMut(&Site, Option<&Arc<Gpu>>, &mut OnEvent<'_>) -> Result<T, StudyError> + 'a;

/// Does work on a site. If the device fails during the work, it is done once more on a new one. If that fails, too, the
/// processor takes over, if it `can` do the work and the request names nothing that only an adapter draws; otherwise a
/// software adapter takes over, so that the technique stays the requested one. Notes say so.
///
/// # Errors
/// The errors of the work itself; [`StudyError::NoDevice`] if every device fails.
pub fn persist<T>(
    site: &Site,
    can: bool,
    on_event: &mut OnEvent<'_>,
    attempt: &mut Attempt<'_, T>,
) -> Result<T, StudyError> {
    let first = attempt(site, None, on_event);
    let Some(lost) = first.as_ref().err().and_then(StudyError::lost_device) else { return first };
    begin_again(&lost.why(), "on a new device", on_event)?;
    let second = attempt(site, None, on_event);
    let Some(why) = failed_device(&second) else { return second };
    let is_free = site.engine == Engine::Auto && site.finder == Finder::Auto && !site.method.row().on_cpu.is_empty();
    if can && is_free {
        begin_again(&why, "on the processor", on_event)?;
        return attempt(&Site { engine: Engine::Cpu, ..site.clone() }, None, on_event);
    }
    let Ok(software) = Gpu::open_software() else { return Err(StudyError::NoDevice(why)) };
    begin_again(&why, &format!("on the processor, by '{}'", software.name()), on_event)?;
    let last = attempt(site, Some(&Arc::new(software)), on_event);
    failed_device(&last).map_or(last, |why| Err(StudyError::NoDevice(why)))
}

/// Reports that a device failed, and on what the work starts again.
fn begin_again(why: &str, on: &str, on_event: &mut OnEvent<'_>) -> Result<(), StudyError> {
    tell(on_event, Event::Note(format!("{why}: the work is done again {on}").into()))?;
    tell(on_event, Event::StartsOver)
}

/// Why a device failed, if that is what ended the work: it was lost, or none was left after a loss.
fn failed_device<T>(done: &Result<T, StudyError>) -> Option<String> {
    match done.as_ref().err()? {
        StudyError::Gpu(error) | StudyError::Shadow(ShadowError::Gpu(error)) => match error {
            GpuError::Failed { .. } => None,
            GpuError::Lost { .. } | GpuError::Unusable { .. } | GpuError::NoAdapter => Some(error.why()),
        },
        StudyError::NoVolumes(why) | StudyError::NoVerification(why) => Some(why.clone()),
        _ => None,
    }
}
