//! `gnomon verify`: compares every technique with ray casting on the user's own site.

use super::arguments::VerifyArgs;
use super::output::say;
use super::progress::Progress;
use crate::deliver::verification::verification;
use crate::site::Site;

pub(super) fn verify(asked: &VerifyArgs) -> anyhow::Result<()> {
    let site = Site::load(asked.site.path(), &asked.overrides()?)?;
    let mut progress = Progress::new(asked.common.quiet);
    let answer = verification(&site, &mut |event| progress.heard(&event))?;
    say(if asked.common.json { &answer.report } else { &answer.table })?;
    match answer.failure {
        Some(failure) => anyhow::bail!(failure),
        None => Ok(()),
    }
}
