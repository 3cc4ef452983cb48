//! `gnomon convert`: a model as glTF.

use super::arguments::Common;
use super::model::ModelArgs;
use super::options::{Options, nothing_asked};
use super::output::say;
use super::progress::Progress;
use super::wrong_use::WrongUse;
use crate::deliver::Sink;
use crate::deliver::conversion::convert as deliver;
use crate::formats::{is_model, refusal};
use crate::site::{inputs, load_model};
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(super) struct ConvertArgs {
    /// A model of any format
    #[arg(value_name = "MODEL")]
    model: PathBuf,
    /// The file
    #[arg(value_name = "OUT.glb")]
    out: PathBuf,
    #[command(flatten)]
    reading: ModelArgs,
    #[command(flatten)]
    pub(super) common: Common,
}

/// `gnomon convert`
pub(super) fn convert(asked: &ConvertArgs) -> anyhow::Result<()> {
    let ConvertArgs { model, out, .. } = asked;
    if !out.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("glb")) {
        return Err(WrongUse(format!("convert writes GLB; name a .glb file instead of {}", out.display())).into());
    }
    // a site may have several models, each with its own place
    if model.is_dir() || (model.is_file() && !is_model(model) && refusal(model).is_none()) {
        return Err(WrongUse(format!(
            "convert reads one model, and {} is not a model; name a model file, for example tower.glb",
            model.display()
        ))
        .into());
    }
    let inputs = inputs(model)?;
    let placed = load_model(model, &asked.reading.onto(nothing_asked()))?;
    let mut progress = Progress::new(asked.common.quiet);
    let sink = Sink::Paths { inputs: &inputs };
    let answer = deliver(&placed, out, &Options, sink, &mut |event| progress.heard(&event))?;
    match asked.common.json {
        true => say(&answer.report),
        false => say(&format!("{}\n{}", out.display(), answer.summary)),
    }
}
