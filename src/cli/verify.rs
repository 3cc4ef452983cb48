//! `gnomon verify`: every technique against ray casting on the user's own site.

use super::arguments::VerifyArgs;
use super::progress::Progress;
use super::{interrupt, say};
use crate::export::verify as told;
use crate::site::Site;
use crate::study;

pub(super) fn verify(asked: &VerifyArgs) -> anyhow::Result<()> {
    let site = Site::load(&asked.site.path, &asked.overrides())?;
    let mut progress = Progress::new(asked.common.quiet);
    let verification = study::verify::verify(&site, &mut |event| {
        progress.hear(&event);
        interrupt::flow()
    })?;
    match asked.common.json {
        true => say(&told::json(&verification, &site)?)?,
        false => say(&told::table(&verification, &site))?,
    }
    match told::failure(&verification) {
        Some(failure) => anyhow::bail!(failure),
        None => Ok(()),
    }
}
