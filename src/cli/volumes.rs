//! `gnomon volumes`: the shadow volumes of one instant as solids in a file.

use super::arguments::VolumesArgs;
use super::progress::Progress;
use super::{WrongUse, interrupt, say};
use crate::export::{file, volumes};
use crate::site::{Site, inputs};
use crate::study::{self, Event, StudyError};
use crate::volume::solid;
use std::path::Path;
use std::slice;

/// Longer volumes are noted, metres.
const LONG_M: f64 = 10_000.0;

pub(super) fn volumes(asked: &VolumesArgs) -> anyhow::Result<()> {
    let out = &asked.out;
    if out.extension().is_some_and(|extension| !extension.eq_ignore_ascii_case("glb")) {
        return Err(WrongUse(format!("--out writes GLB; name a .glb file instead of {}", out.display())).into());
    }
    let site = Site::load(&asked.site.path, &asked.overrides())?;
    let instant = site.track.instants.first().ok_or(StudyError::NoInstant)?;
    if instant.night {
        anyhow::bail!(
            "no sun at {}: it is {:.1}° below the horizon, and nothing casts a shadow; take a time of day for --at",
            instant.time.format("%Y-%m-%d %H:%M"),
            -instant.altitude_deg(),
        );
    }
    file::check_inputs(&inputs(&asked.site.path)?, slice::from_ref(out))?;
    file::check_folder(out.parent().unwrap_or(Path::new("")))?;
    let mut progress = Progress::new(asked.common.quiet);
    study::note_models(&site.notes, &mut |event| {
        progress.hear(&event);
        interrupt::flow()
    })?;

    let found = solid::solids(&site.mesh, &site.casts, instant.to_sun, site.ground.level)?;
    interrupt::check()?;
    let mut note = |text: String| progress.hear(&Event::Note(text));
    match found.left_out {
        0 => (),
        1 => note("1 component casts nothing on the ground (below it, or edge-on to the sun) and is left out".into()),
        many => note(format!(
            "{many} components cast nothing on the ground (below it, or edge-on to the sun) and are left out"
        )),
    }
    let longest = found.solids.iter().fold(0.0, |longest: f64, solid| longest.max(solid.length_m));
    if longest > LONG_M {
        let altitude = instant.altitude_deg();
        note(format!("the sun is {altitude:.2}° above the horizon: volumes reach {:.0} km far", longest / 1000.0));
    }
    let written = volumes::Volumes {
        place: &site.place,
        instant,
        refraction: site.track.refraction,
        ground: site.ground,
        mesh: &site.mesh,
        solids: &found.solids,
        left_out: found.left_out,
        notes: &site.notes,
    };
    let bytes = volumes::glb(&written)?;
    interrupt::check()?;
    file::write(out, &bytes)?;
    match asked.common.json {
        true => say(&volumes::json(&written, out)?),
        false => say(&format!("{}\n{}\n", out.display(), volumes::summary(&written))),
    }
}
