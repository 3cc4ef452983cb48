//! The shadow volumes at one instant, as solids in a model.

use super::parts::note;
use super::{DeliverError, Sink, WrittenFiles};
use crate::export::volumes::{self as encode, Volumes};
use crate::message::{Message, message, setting};
use crate::site::{GroundKind, Site, metres};
use crate::study::{self, Event, OnEvent, StudyError, tell};
use crate::sun::Instant;
use crate::volume::solid::{Solids, solids};
use std::path::Path;

/// The length of volumes that gets a note, metres.
const LONG_M: f64 = 10_000.0;

/// The result of making volumes.
#[derive(Clone, Debug)]
pub struct VolumesAnswer {
    /// The model that was written.
    pub written: WrittenFiles,
    /// The report in JSON.
    pub report: String,
    /// The number of solids and the position of the sun, in lines for people.
    pub summary: String,
}

/// Writes the shadow volumes at the first instant of the site's study to a model of that name.
///
/// # Errors
/// [`DeliverError`]. Night, and a file that cannot be written, are refused before anything is made.
pub fn volumes(
    site: &Site,
    name: &Path,
    sink: Sink<'_>,
    on_event: &mut OnEvent<'_>,
) -> Result<VolumesAnswer, DeliverError> {
    let instant = site.track.instants.first().ok_or(StudyError::NoInstant)?;
    if instant.night {
        return Err(DeliverError::Night { time: instant.time, below_deg: -instant.altitude_deg() });
    }
    let open = sink.open(&[name.to_owned()], None)?;
    note(open.note(), on_event)?;
    study::note_site(site, on_event)?;
    let found = solids(&site.mesh, &site.casts, instant.to_sun, site.ground.level)?;
    if found.solids.is_empty() {
        return Err(no_caster(site).into());
    }
    tell(on_event, Event::Stage("volumes"))?;
    let plane = (site.ground.kind == GroundKind::Terrain).then(|| site.by_file.worded(note_plane(site.ground.level)));
    study::note_models(plane.as_slice(), on_event)?;
    let mut notes: Vec<Message> = site.notes.iter().cloned().chain(plane).collect();
    note_extent(&found, instant, &mut |event| {
        study::gather(&event, &site.notes, &mut notes);
        on_event(event)
    })?;
    let volumes = Volumes {
        place: &site.place,
        instant,
        refraction: site.track.refraction,
        ground: site.ground,
        mesh: &site.mesh,
        solids: &found.solids,
        left_out: found.left_out,
        notes: &notes,
        words: site.words,
    };
    let bytes = encode::glb(&volumes)?;
    tell(on_event, Event::Stage("model"))?;
    let written = open.write(vec![(name.to_owned(), bytes)])?;
    Ok(VolumesAnswer { written, report: encode::json(&volumes, name)?, summary: encode::summary(&volumes) })
}

/// That there is no volume to write.
fn no_caster(site: &Site) -> StudyError {
    let message = message![
        "nothing above the ground casts a shadow";
        "see ", setting("[ground]", "level", "`level` in [ground]"), " and ",
        setting("[[model]]", "casts", "`casts` under [[model]]")
    ];
    StudyError::NoVolume(site.by_file.worded(message))
}

/// A note that the volumes end at a plane, above or below the terrain.
fn note_plane(level_m: f64) -> Message {
    message![
        format!("the volumes end at a plane at {}, and not at the terrain", metres(level_m));
        setting("[ground]", "level", "`level` in [ground]"), " sets its height"
    ]
}

/// Notes what is left out, and very long volumes.
fn note_extent(found: &Solids, instant: &Instant, on_event: &mut OnEvent<'_>) -> Result<(), StudyError> {
    let left_out = match found.left_out {
        0 => None,
        1 => {
            let one = "1 component casts nothing on the ground (below it, or edge-on to the sun) and is left out";
            Some(one.to_owned())
        }
        many => Some(format!(
            "{many} components cast nothing on the ground (below it, or edge-on to the sun) and are left out"
        )),
    };
    note(left_out, on_event)?;
    let longest = found.solids.iter().fold(0.0, |longest: f64, solid| longest.max(solid.length_m));
    let long = (longest > LONG_M).then(|| {
        let altitude = instant.altitude_deg();
        format!("the sun is {altitude:.2}° above the horizon: volumes are up to {:.0} km long", longest / 1000.0)
    });
    note(long, on_event)
}
