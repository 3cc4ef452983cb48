//! The rule by which the open site is judged, and the tool with which its judged things are drawn.

use crate::rules::{KnownRule, Rule, RuleError, RuleOption};
use glam::DVec2;
use std::collections::BTreeMap;

/// The chosen rule and what is chosen in it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(in crate::desktop) struct RuleChoice {
    /// The name that asks for the rule; empty before one is chosen.
    pub(in crate::desktop) name: String,
    /// The options that are set, as they are written.
    pub(in crate::desktop) values: BTreeMap<String, String>,
}

impl RuleChoice {
    /// Another rule. Options that it has, too, keep their values if it allows them.
    pub(in crate::desktop) fn take(&mut self, name: &str, rule: &Rule) {
        name.clone_into(&mut self.name);
        self.values.retain(|option, value| {
            let of_rule = rule.options.iter().find(|of| of.name == *option);
            of_rule.is_some_and(|of| of.value(&rule.source.id, value).is_ok())
        });
    }

    /// The options that must be chosen and are not.
    pub(in crate::desktop) fn lacking<'a>(&self, rule: &'a Rule) -> Vec<&'a RuleOption> {
        let lacks = |option: &&RuleOption| option.default.is_none() && !self.values.contains_key(&option.name);
        rule.options.iter().filter(lacks).collect()
    }

    /// The options as a rule takes them.
    pub(in crate::desktop) fn pairs(&self) -> Vec<(&str, &str)> {
        self.values.iter().map(|(name, value)| (name.as_str(), value.as_str())).collect()
    }

    /// The chosen rule among those that are known.
    pub(in crate::desktop) fn of<'a>(&self, known: &'a [KnownRule]) -> Option<&'a Result<Rule, RuleError>> {
        known.iter().find(|(name, _)| *name == self.name).map(|(_, rule)| rule)
    }
}

/// A name of an option as a label: `hours_of_sun` is "hours of sun".
pub(in crate::desktop) fn option_label(name: &str) -> String {
    name.replace('_', " ")
}

/// What clicks on the picture do, instead of asking for a point's sun.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::desktop) enum JudgeTool {
    /// They are the corners of an area on the plan.
    Area(Vec<DVec2>),
    /// They are the corners of the plot's border on the plan.
    Plot(Vec<DVec2>),
    /// They choose windows.
    Windows,
}

impl JudgeTool {
    /// The corners that are drawn so far.
    pub(in crate::desktop) fn corners(&self) -> Option<&Vec<DVec2>> {
        match self {
            JudgeTool::Area(corners) | JudgeTool::Plot(corners) => Some(corners),
            JudgeTool::Windows => None,
        }
    }

    /// The same, to add to them or to take the last one back.
    pub(in crate::desktop) fn corners_mut(&mut self) -> Option<&mut Vec<DVec2>> {
        match self {
            JudgeTool::Area(corners) | JudgeTool::Plot(corners) => Some(corners),
            JudgeTool::Windows => None,
        }
    }
}
