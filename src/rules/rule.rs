//! A rule as it is written: where it is from, what it leaves to an authority, and the rest of its text.

use super::error::RuleError;
use super::options::{Choices, OptionValue, RuleOption, chosen_in, used};
use super::reader::TableReader;
use super::resolved::ResolvedRule;
use crate::choice::{nearest, words};
use std::collections::BTreeSet;
use toml::{Table, Value};

/// What a rule is to those who build.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RuleKind {
    /// It binds.
    Law,
    /// It binds where a law or a contract names it.
    Standard,
    /// It advises.
    Guidance,
    /// Courts go by it.
    CaseLaw,
    /// It does not hold any more.
    Lapsed,
}

words!(RuleKind, [
    "law" => RuleKind::Law,
    "standard" => RuleKind::Standard,
    "guidance" => RuleKind::Guidance,
    "case-law" => RuleKind::CaseLaw,
    "lapsed" => RuleKind::Lapsed,
]);

/// How its numbers are known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Confidence {
    /// Read in the rule-maker's own text.
    V,
    /// The rule-maker's text, quoted verbatim by somebody else.
    Vt,
    /// A third party's summary.
    S,
    /// Somebody's program alone.
    C,
    /// Memory.
    M,
}

words!(Confidence, [
    "V" => Confidence::V,
    "Vt" => Confidence::Vt,
    "S" => Confidence::S,
    "C" => Confidence::C,
    "M" => Confidence::M,
]);

impl Confidence {
    /// What the mark means.
    pub fn meaning(self) -> &'static str {
        match self {
            Confidence::V => "read in the rule-maker's own text",
            Confidence::Vt => "the rule-maker's text as others quote it verbatim",
            Confidence::S => "a third party's summary",
            Confidence::C => "another program alone",
            Confidence::M => "memory alone",
        }
    }
}

/// Where a rule is from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RuleSource {
    /// By what it is asked for.
    pub id: String,
    /// What people call it.
    pub name: String,
    /// Where it is in force.
    pub region: String,
    /// What it is.
    pub kind: RuleKind,
    /// Which text of it.
    pub edition: String,
    /// How its numbers are known.
    pub confidence: Confidence,
    /// Where they were read.
    pub sources: Vec<String>,
    /// What is taken for granted, and what could not be read.
    pub assumes: Vec<String>,
}

/// A rule, its options not yet chosen.
#[derive(Clone, Debug)]
pub struct Rule {
    /// Where it is from.
    pub source: RuleSource,
    /// What it leaves to an authority.
    pub options: Vec<RuleOption>,
    /// As it is written.
    pub text: String,
    body: Table,
}

impl Rule {
    /// Reads a rule, and tries it with all values of its options, so that no mistake waits for a choice. `name` is what
    /// errors call it until its id is known.
    ///
    /// # Errors
    /// [`RuleError`].
    pub fn parse(name: &str, text: &str) -> Result<Rule, RuleError> {
        let refused = |error: toml::de::Error| RuleError::Toml {
            rule: name.to_owned(),
            what: error.to_string().split_whitespace().collect::<Vec<_>>().join(" "),
        };
        let mut body: Table = text.parse().map_err(refused)?;
        let head = body.remove("rule");
        let head = head.as_ref().and_then(Value::as_table).ok_or_else(|| RuleError::Value {
            rule: name.to_owned(),
            at: "[rule]".to_owned(),
            what: "it must be written, with id, name, region, kind, edition and confidence".to_owned(),
        })?;
        let source = source(TableReader::new(name, "[rule]", head, SOURCE_KEYS)?)?;
        let written = body.remove("options").unwrap_or_else(|| Value::Table(Table::new()));
        let options = options(&source.id, &written)?;
        let rule = Rule { source, options, text: text.to_owned(), body };
        rule.try_all()?;
        rule.check_options()?;
        Ok(rule)
    }

    /// Refuses options that nothing depends on.
    fn check_options(&self) -> Result<(), RuleError> {
        let mut found = BTreeSet::new();
        self.body.values().for_each(|value| used(value, &mut found));
        match self.options.iter().find(|option| !found.contains(&option.name)) {
            None => Ok(()),
            Some(option) => Err(RuleError::Value {
                rule: self.source.id.clone(),
                at: format!("[options.{}]", option.name),
                what: format!("nothing depends on it; use it as \"${}\" or in a `when`, or leave it out", option.name),
            }),
        }
    }

    /// Resolves it with each value of each option, the others as they are first.
    fn try_all(&self) -> Result<(), RuleError> {
        let samples: Vec<Vec<OptionValue>> = self.options.iter().map(RuleOption::samples).collect();
        let first: Choices =
            self.options.iter().zip(&samples).map(|(option, of)| (option.name.clone(), of[0].clone())).collect();
        self.with(&first)?;
        for (option, of) in self.options.iter().zip(&samples) {
            for value in &of[1..] {
                let mut choices = first.clone();
                choices.insert(option.name.clone(), value.clone());
                self.with(&choices)?;
            }
        }
        Ok(())
    }

    /// The rule with its options chosen, each as it is written: `("hours", "2h")`.
    ///
    /// # Errors
    /// An option that it does not have, a value that the option cannot have, options that must be said and are not.
    pub fn resolve(&self, given: &[(&str, &str)]) -> Result<ResolvedRule, RuleError> {
        let mut choices = Choices::new();
        for (name, text) in given {
            let option = self.option(name)?;
            choices.insert(option.name.clone(), option.value(&self.source.id, text)?);
        }
        let mut missing = Vec::new();
        for option in self.options.iter().filter(|option| !given.iter().any(|(name, _)| *name == option.name)) {
            match &option.default {
                Some(default) => {
                    choices.insert(option.name.clone(), default.clone());
                }
                None => missing.push(format!("`{}`, {} ({})", option.name, option.meaning, option.takes())),
            }
        }
        if !missing.is_empty() {
            return Err(RuleError::Unsaid { rule: self.source.id.clone(), missing: missing.join("; ") });
        }
        self.with(&choices)
    }

    fn option(&self, name: &str) -> Result<&RuleOption, RuleError> {
        let names = || self.options.iter().map(|option| option.name.as_str());
        self.options.iter().find(|option| option.name == name).ok_or_else(|| RuleError::UnknownOption {
            rule: self.source.id.clone(),
            name: name.to_owned(),
            known: nearest(name, names())
                .map_or_else(|| "it has none".to_owned(), |nearest| format!("the nearest is `{nearest}`")),
        })
    }

    fn with(&self, choices: &Choices) -> Result<ResolvedRule, RuleError> {
        let table = chosen_in(&self.source.id, &self.body, choices)?;
        // in the order in which the rule explains them
        let chosen = self
            .options
            .iter()
            .filter_map(|option| choices.get(&option.name).map(|value| (option.name.clone(), value.clone())));
        ResolvedRule::read(&self.source.id, &table, chosen.collect())
    }
}

/// More options than this nobody chooses, and a rule is tried with the values of each.
const MOST_OPTIONS: usize = 30;

/// What [rule] may say.
pub(super) const SOURCE_KEYS: &[&str] =
    &["id", "name", "region", "kind", "edition", "confidence", "sources", "assumes"];

fn source(table: TableReader) -> Result<RuleSource, RuleError> {
    let owned = |texts: Vec<&str>| texts.into_iter().map(str::to_owned).collect();
    let source = RuleSource {
        id: table.must_text("id")?.to_owned(),
        name: table.must_text("name")?.to_owned(),
        region: table.must_text("region")?.to_owned(),
        kind: table.word("kind")?.ok_or_else(|| table.wrong("kind", "it must be written"))?,
        edition: table.must_text("edition")?.to_owned(),
        confidence: table.word("confidence")?.ok_or_else(|| table.wrong("confidence", "it must be written"))?,
        sources: owned(table.texts("sources")?),
        assumes: owned(table.texts("assumes")?),
    };
    let is_id = source.id.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-');
    if !is_id {
        return Err(table.wrong("id", "it is of small letters, digits and hyphens"));
    }
    table.finish()?;
    Ok(source)
}

fn options(rule: &str, written: &Value) -> Result<Vec<RuleOption>, RuleError> {
    let wrong =
        |what: &str| RuleError::Value { rule: rule.to_owned(), at: "[options]".to_owned(), what: what.to_owned() };
    let each = "each option is a table of its own, as [options.hours]";
    let table = written.as_table().ok_or_else(|| wrong(each))?;
    if table.len() > MOST_OPTIONS {
        return Err(wrong(&format!("a rule has at most {MOST_OPTIONS} options")));
    }
    let mut options = Vec::new();
    for (name, value) in table {
        if !name.chars().all(|c| c.is_ascii_lowercase() || c == '_') {
            return Err(wrong(&format!("{name:?} is no name of an option; take small letters and _")));
        }
        let table = value.as_table().ok_or_else(|| wrong(each))?;
        let table = TableReader::new(rule, format!("[options.{name}]"), table, RuleOption::KEYS)?;
        options.push(RuleOption::read(rule, name, table)?);
    }
    Ok(options)
}
