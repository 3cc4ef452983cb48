//! `gnomon volumes`: the shadow volumes at one instant, as solids in a file.

use super::arguments::VolumesArgs;
use super::output::say;
use super::progress::Progress;
use super::wrong_use::WrongUse;
use crate::deliver::Sink;
use crate::deliver::volumes::volumes as deliver;
use crate::site::Site;

pub(super) fn volumes(asked: &VolumesArgs) -> anyhow::Result<()> {
    let out = &asked.out;
    if out.extension().is_some_and(|extension| !extension.eq_ignore_ascii_case("glb")) {
        return Err(WrongUse(format!("--out writes GLB; name a .glb file instead of {}", out.display())).into());
    }
    let site = Site::load(asked.site.path(), &asked.overrides()?)?;
    let mut progress = Progress::new(asked.common.quiet);
    let sink = Sink::Paths { inputs: &asked.site.inputs()? };
    let answer = deliver(&site, out, sink, &mut |event| progress.heard(&event))?;
    match asked.common.json {
        true => say(&answer.report),
        false => say(&format!("{}\n{}\n", out.display(), answer.summary)),
    }
}
