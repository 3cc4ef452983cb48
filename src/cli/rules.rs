//! `gnomon rules`: the built-in rules.

use super::output::say;
use super::wrong_use::WrongUse;
use crate::rules::{Rule, RuleOption, built_in_rules, built_in_text};
use clap::{Args, Subcommand};
use std::fmt::Write;

#[derive(Debug, Args)]
#[command(disable_help_subcommand = true)]
pub(super) struct RulesArgs {
    #[command(subcommand)]
    action: Option<RulesAction>,
}

#[derive(Debug, Subcommand)]
enum RulesAction {
    /// Print a rule as it is written, in TOML
    Show(ShowRuleArgs),
}

#[derive(Debug, Args)]
struct ShowRuleArgs {
    /// The rule, by its name in the list
    #[arg(value_name = "ID")]
    id: String,
}

/// `gnomon rules`
pub(super) fn rules(asked: &RulesArgs) -> anyhow::Result<()> {
    match &asked.action {
        Some(RulesAction::Show(asked)) => {
            say(built_in_text(&asked.id).map_err(|error| WrongUse(format!("{error}; gnomon rules lists them")))?)
        }
        None => say(&list(&built_in_rules()?)),
    }
}

/// Lists every rule in a few lines, with advice on relying on them.
fn list(rules: &[Rule]) -> String {
    let mut text = String::new();
    for rule in rules {
        let of = &rule.source;
        // writing to a String cannot fail
        let _ = writeln!(text, "{}\n  {}, {}", of.id, of.name, of.region);
        let _ = writeln!(text, "  {}: {}", of.kind, of.edition);
        let _ = writeln!(text, "  {} ({}): {}", of.confidence, of.confidence.meaning(), of.sources.join(", "));
        for option in &rule.options {
            let _ = writeln!(text, "  {}", said(option));
        }
        text.push('\n');
    }
    text.push_str("This is not legal advice: check with your authority which rule, edition and values hold.\n");
    text.push_str("gnomon rules show ID prints a rule as it is written, with its assumptions.\n");
    text
}

/// An option in a line.
fn said(option: &RuleOption) -> String {
    let takes = option.takes();
    match &option.default {
        Some(default) => format!("option {}: {takes} [default: {}]", option.name, default.text()),
        None => format!("option {}: {takes} [required]", option.name),
    }
}
