//! Work that is done again where the graphics device fails that it is done on.

use super::{Event, OnEvent, StudyError, tell};
use crate::choice::{Engine, Finder};
use crate::site::Site;

/// Does what is asked of a site. Where the device fails on the way it is done once more on a new one, and where that fails
/// too on the processor: if that `can` do it, and nobody asked for what draws on an adapter alone. Notes say so.
///
/// # Errors
/// What the work says; where the device fails for good, what that says.
pub fn persist<T>(
    site: &Site,
    can: bool,
    on_event: &mut OnEvent<'_>,
    work: &mut dyn FnMut(&Site, &mut OnEvent<'_>) -> Result<T, StudyError>,
) -> Result<T, StudyError> {
    let mut done = work(site, on_event);
    if begins_anew(&done, "on a new device", on_event)? {
        done = work(site, on_event);
        let is_free =
            site.engine == Engine::Auto && site.finder == Finder::Auto && !site.method.row().on_cpu.is_empty();
        if can && is_free && begins_anew(&done, "on the processor", on_event)? {
            done = work(&Site { engine: Engine::Cpu, ..site.clone() }, on_event);
        }
    }
    done
}

/// Whether a device failed; that is told.
fn begins_anew<T>(done: &Result<T, StudyError>, on: &str, on_event: &mut OnEvent<'_>) -> Result<bool, StudyError> {
    let Some(lost) = done.as_ref().err().and_then(StudyError::lost_device) else { return Ok(false) };
    tell(on_event, Event::Note(format!("{}: all is done again {on}", lost.why())))?;
    tell(on_event, Event::Anew)?;
    Ok(true)
}
