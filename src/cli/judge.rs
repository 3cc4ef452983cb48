//! `gnomon judge`: does a site keep a rule?

use super::arguments::{Common, SiteArgs};
use super::commands::lines;
use super::model::ModelArgs;
use super::options::Options;
use super::output::say;
use super::progress::Progress;
use super::wrong_use::WrongUse;
use crate::deliver::Sink;
use crate::deliver::judgement::{JudgeAnswer, JudgeRequest, judge as deliver};
use crate::export::judgement as told;
use crate::rules::{RuleError, Verdict, rule_for_site};
use crate::site::load_judged;
use crate::study::settle;
use clap::Args;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(Debug, Args)]
pub(super) struct JudgeArgs {
    #[command(flatten)]
    site: SiteArgs,
    #[command(flatten)]
    model: ModelArgs,
    /// The rule: the name of a file beside the site, ID.toml, or a built-in one as `gnomon rules` lists them
    #[arg(long, value_name = "ID")]
    rule: String,
    /// What the rule leaves to the authority: hours=2h. May be repeated
    #[arg(long, value_name = "KEY=VALUE", allow_hyphen_values = true)]
    set: Vec<String>,
    /// A table with a line for each area, window, façade or band: verdict, day, point, value, limit, margin, before, shares
    #[arg(long, value_name = "FILE.csv")]
    csv: Option<PathBuf>,
    #[command(flatten)]
    pub(super) common: Common,
}

/// The exit status of a verdict: 0 passes, 1 fails or is close to a limit, 3 only reports.
fn status(verdict: Verdict) -> ExitCode {
    match verdict {
        Verdict::Pass => ExitCode::SUCCESS,
        Verdict::Fail | Verdict::Close => ExitCode::from(1),
        Verdict::Report => ExitCode::from(3),
    }
}

pub(super) fn judge(asked: &JudgeArgs) -> anyhow::Result<ExitCode> {
    if let Some(path) = &asked.csv
        && path.extension().is_none_or(|extension| !extension.eq_ignore_ascii_case("csv"))
    {
        return Err(WrongUse(format!("--csv writes CSV; name a .csv file instead of {}", path.display())).into());
    }
    let folder = folder_of(asked.site.path());
    let rule = rule_for_site(&asked.rule, folder).map_err(wrong_use)?;
    let resolved = rule.resolve(&chosen(&asked.set)?).map_err(wrong_use)?;
    let overrides = asked.model.onto(asked.site.overrides()?);
    let site = settle(load_judged(asked.site.path(), &overrides)?)?;
    let request = JudgeRequest { source: &rule.source, rule: &resolved, table: asked.csv.as_ref() };
    let mut progress = Progress::of("receivers", asked.common.quiet);
    let mut inputs = asked.site.inputs()?;
    inputs.extend(rule_file(&asked.rule, folder));
    let sink = Sink::Paths { inputs: &inputs };
    let JudgeAnswer { judgement, notes, written } = deliver(&site, request, sink, &mut |event| progress.heard(&event))?;
    match asked.common.json {
        true => say(&told::json(&judgement, &site, (&notes, &Options))?)?,
        false => say(&(told::table(&judgement, &site) + &lines(&written)))?,
    }
    Ok(status(judgement.verdict))
}

/// The folder of the site's own rules.
pub(super) fn folder_of(site: &Path) -> &Path {
    if site.is_dir() { site } else { site.parent().unwrap_or(Path::new("")) }
}

/// The file that is read as the rule, if there is one; no table may be written over it.
pub(super) fn rule_file(name: &str, folder: &Path) -> Option<PathBuf> {
    let path = folder.join(if name.ends_with(".toml") { name.to_owned() } else { format!("{name}.toml") });
    path.is_file().then_some(path)
}

/// Reads `hours=2h` for a rule's options.
pub(super) fn chosen(set: &[String]) -> Result<Vec<(&str, &str)>, WrongUse> {
    let mut chosen: Vec<(&str, &str)> = Vec::new();
    for text in set {
        let (name, value) = text
            .split_once('=')
            .filter(|(name, _)| !name.is_empty())
            .ok_or_else(|| WrongUse(format!("--set {text}: write it as --set hours=2h")))?;
        if chosen.iter().any(|(known, _)| *known == name) {
            return Err(WrongUse(format!("--set {name}= stands twice; say it once")));
        }
        chosen.push((name, value));
    }
    Ok(chosen)
}

pub(super) fn wrong_use(error: RuleError) -> WrongUse {
    let hint = match &error {
        RuleError::UnknownRule { .. } => "; gnomon rules lists them",
        RuleError::Unsaid { .. } => "; say each as --set NAME=VALUE",
        RuleError::UnknownOption { .. } | RuleError::OptionValue { .. } => "; gnomon rules lists each rule's options",
        _ => "",
    };
    WrongUse(format!("{error}{hint}"))
}
