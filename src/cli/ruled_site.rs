//! A site of which something is judged, and the rule of an authority, as `gnomon judge` and `gnomon envelope` take them.

use super::arguments::SiteArgs;
use super::model::ModelArgs;
use super::wrong_use::WrongUse;
use crate::message::Message;
use crate::rules::{ResolvedRule, Rule, RuleError, RuleSource, rule_for_site};
use crate::site::{JudgedSite, Overrides, SiteError, load_judged};
use crate::study::judge::with_needs;
use crate::study::{StudyError, settle};
use clap::Args;
use std::path::{Path, PathBuf};

/// A site of which something is judged.
#[derive(Debug, Args)]
pub(super) struct JudgedSiteArgs {
    #[command(flatten)]
    site: SiteArgs,
    #[command(flatten)]
    model: ModelArgs,
}

#[derive(Debug, Args)]
pub(super) struct RuledSiteArgs {
    #[command(flatten)]
    judged: JudgedSiteArgs,
    /// The rule: the name of a file beside the site, ID.toml, or a built-in one as `gnomon rules` lists them
    #[arg(long, value_name = "ID")]
    rule: String,
    /// What the rule leaves to the authority: hours=2h. May be repeated
    #[arg(long, value_name = "KEY=VALUE", allow_hyphen_values = true)]
    set: Vec<String>,
}

/// A rule with its options chosen.
pub(super) struct ChosenRule {
    pub(super) source: RuleSource,
    pub(super) rule: ResolvedRule,
}

/// What was read of a site.
pub(super) struct ReadSite {
    pub(super) site: JudgedSite,
    /// The files that were read, over which nothing may be written.
    pub(super) inputs: Vec<PathBuf>,
}

impl RuledSiteArgs {
    /// Reads the rule first, as that is quick, and then the site with its models.
    pub(super) fn read(&self) -> anyhow::Result<(ChosenRule, ReadSite)> {
        let (written, given) = (self.judged.written(&self.rule)?, chosen(&self.set)?);
        let read = || self.judged.read(Some(&self.rule), &self.judged.overrides()?);
        match written.resolve(&given) {
            Ok(rule) => Ok((ChosenRule { source: written.source, rule }, read()?)),
            Err(error @ RuleError::Unsaid { .. }) => {
                Err(unsaid(with_needs(error, &written, &given, &read()?.site)).into())
            }
            Err(error) => Err(wrong_use(error).into()),
        }
    }
}

impl JudgedSiteArgs {
    /// A rule for this site, from its folder or built in.
    pub(super) fn rule(&self, name: &str, set: &[String]) -> anyhow::Result<ChosenRule> {
        let written = self.written(name)?;
        let rule = written.resolve(&chosen(set)?).map_err(wrong_use)?;
        Ok(ChosenRule { source: written.source, rule })
    }

    /// The same before its options are chosen.
    fn written(&self, name: &str) -> Result<Rule, WrongUse> {
        rule_for_site(name, folder_of(self.site.path())).map_err(wrong_use)
    }

    pub(super) fn path(&self) -> &Path {
        self.site.path()
    }

    pub(super) fn overrides(&self) -> Result<Overrides, SiteError> {
        Ok(self.model.onto(self.site.overrides()?))
    }

    /// Reads the site with its models.
    pub(super) fn read(&self, rule: Option<&str>, asked: &Overrides) -> anyhow::Result<ReadSite> {
        let site = settle(load_judged(self.site.path(), asked)?)?;
        let mut inputs = self.site.inputs()?;
        inputs.extend(rule.and_then(|rule| rule_file(rule, folder_of(self.site.path()))));
        Ok(ReadSite { site, inputs })
    }
}

/// The folder of the site's own rules.
fn folder_of(site: &Path) -> &Path {
    if site.is_dir() { site } else { site.parent().unwrap_or(Path::new("")) }
}

/// The file that is read as the rule, if there is one; no table may be written over it.
fn rule_file(name: &str, folder: &Path) -> Option<PathBuf> {
    let path = folder.join(if name.ends_with(".toml") { name.to_owned() } else { format!("{name}.toml") });
    path.is_file().then_some(path)
}

/// Reads `hours=2h` for a rule's options.
fn chosen(set: &[String]) -> Result<Vec<(&str, &str)>, WrongUse> {
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

/// The error of options that nobody chose, and of what the site lacks besides.
fn unsaid(error: RuleError) -> StudyError {
    const SET: &str = "say each option as --set NAME=VALUE";
    match StudyError::from(error) {
        StudyError::Rule(Message { what, hint }) => {
            let first = if hint.is_empty() { SET.to_owned() } else { format!("{SET}, and ") };
            StudyError::Rule(Message { what, hint: [first.into()].into_iter().chain(hint).collect() })
        }
        other => other,
    }
}

fn wrong_use(error: RuleError) -> WrongUse {
    let hint = match &error {
        RuleError::UnknownRule { .. } => "; gnomon rules lists them",
        RuleError::Unsaid { .. } => "; say each as --set NAME=VALUE",
        RuleError::UnknownOption { .. } | RuleError::OptionValue { .. } => "; gnomon rules lists each rule's options",
        _ => "",
    };
    WrongUse(format!("{error}{hint}"))
}
