//! A rule as it is written: its source, its options, and its text.

use super::error::RuleError;
use super::options::{Choices, OptionValue, RuleOption, chosen_in, used};
use super::reader::TableReader;
use super::resolved::ResolvedRule;
use crate::choice::{nearest, words};
use std::collections::BTreeSet;
use toml::{Table, Value};

/// How far a rule binds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RuleKind {
    /// It is law.
    Law,
    /// It binds if a law or a contract refers to it.
    Standard,
    /// It is advice.
    Guidance,
    /// Courts follow it.
    CaseLaw,
    /// It is no longer in force.
    Lapsed,
}

words!(RuleKind, [
    "law" => RuleKind::Law,
    "standard" => RuleKind::Standard,
    "guidance" => RuleKind::Guidance,
    "case-law" => RuleKind::CaseLaw,
    "lapsed" => RuleKind::Lapsed,
]);

/// How well its numbers are known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Confidence {
    /// Read in the rule-maker's own text.
    V,
    /// The rule-maker's text, quoted verbatim by somebody else.
    Vt,
    /// A third party's summary.
    S,
    /// Known only from another program.
    C,
    /// From memory.
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
    /// The meaning of the mark, in words.
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

/// Where a rule comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RuleSource {
    /// The id that asks for it.
    pub id: String,
    /// Its usual name.
    pub name: String,
    /// Where it applies.
    pub region: String,
    /// How far it binds.
    pub kind: RuleKind,
    /// The edition that was read.
    pub edition: String,
    /// How well its numbers are known.
    pub confidence: Confidence,
    /// Where they were read.
    pub sources: Vec<String>,
    /// Assumptions, and what could not be read.
    pub assumes: Vec<String>,
    /// The file beside the site that it was read from; `None` for a built-in rule.
    pub file: Option<String>,
}

/// A rule whose options are not set yet.
#[derive(Clone, Debug)]
pub struct Rule {
    /// Where it comes from.
    pub source: RuleSource,
    /// What it leaves to an authority.
    pub options: Vec<RuleOption>,
    /// Its TOML text.
    pub text: String,
    body: Table,
}

impl Rule {
    /// Reads a rule and tries it with every value of each option, so that mistakes show at once. Errors call it `name`
    /// until its id is known.
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
            what: "it is required, with id, name, region, kind, edition and confidence".to_owned(),
        })?;
        let source = source(TableReader::new(name, "[rule]", head, SOURCE_KEYS)?)?;
        let written = body.remove("options").unwrap_or_else(|| Value::Table(Table::new()));
        let options = options(&source.id, &written)?;
        let rule = Rule { source, options, text: text.to_owned(), body };
        rule.try_all()?;
        rule.check_options()?;
        Ok(rule)
    }

    /// Refuses options that have no effect.
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

    /// Resolves the rule with every value of each option in turn, the other options at their first value.
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

    /// Sets the options, given as pairs of name and written value: `("hours", "2h")`. The others keep their defaults.
    ///
    /// # Errors
    /// An option that the rule does not have, a value that it does not allow, or an option without a default and
    /// without a value.
    pub fn resolve(&self, given: &[(&str, &str)]) -> Result<ResolvedRule, RuleError> {
        let (choices, unsaid) = self.choices(given)?;
        if !unsaid.is_empty() {
            let said = |option: &&RuleOption| format!("`{}`, {} ({})", option.name, option.meaning, option.takes());
            let missing = unsaid.iter().map(said).collect::<Vec<_>>().join("; ");
            return Err(RuleError::Unsaid { rule: self.source.id.clone(), missing, needs: Vec::new() });
        }
        self.with(&choices)
    }

    /// Resolves the rule with every value of each option that has neither a default nor a given value, the others of
    /// them at their first value: for what holds whatever is chosen.
    ///
    /// # Errors
    /// As [`Rule::resolve`], except that all options may be left out.
    pub fn resolve_open(&self, given: &[(&str, &str)]) -> Result<Vec<ResolvedRule>, RuleError> {
        let (mut choices, unsaid) = self.choices(given)?;
        choices.extend(unsaid.iter().map(|option| (option.name.clone(), option.samples()[0].clone())));
        let mut open = vec![self.with(&choices)?];
        for option in unsaid {
            for value in &option.samples()[1..] {
                let mut choices = choices.clone();
                choices.insert(option.name.clone(), value.clone());
                open.push(self.with(&choices)?);
            }
        }
        Ok(open)
    }

    /// The values that are given or are defaults, and the options that have neither.
    fn choices(&self, given: &[(&str, &str)]) -> Result<(Choices, Vec<&RuleOption>), RuleError> {
        let mut choices = Choices::new();
        for (name, text) in given {
            let option = self.option(name)?;
            choices.insert(option.name.clone(), option.value(&self.source.id, text)?);
        }
        let mut unsaid = Vec::new();
        for option in self.options.iter().filter(|option| !given.iter().any(|(name, _)| *name == option.name)) {
            match &option.default {
                Some(default) => {
                    choices.insert(option.name.clone(), default.clone());
                }
                None => unsaid.push(option),
            }
        }
        Ok((choices, unsaid))
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
        // in the order in which the rule lists them
        let chosen = self
            .options
            .iter()
            .filter_map(|option| choices.get(&option.name).map(|value| (option.name.clone(), value.clone())));
        ResolvedRule::read(&self.source.id, &table, chosen.collect())
    }
}

/// The most options of a rule. It is tried with the values of each.
const MOST_OPTIONS: usize = 30;

/// The keys that `[rule]` may have.
pub(super) const SOURCE_KEYS: &[&str] =
    &["id", "name", "region", "kind", "edition", "confidence", "sources", "assumes"];

fn source(table: TableReader) -> Result<RuleSource, RuleError> {
    let owned = |texts: Vec<&str>| texts.into_iter().map(str::to_owned).collect();
    let source = RuleSource {
        id: table.must_text("id")?.to_owned(),
        name: table.must_text("name")?.to_owned(),
        region: table.must_text("region")?.to_owned(),
        kind: table.word("kind")?.ok_or_else(|| table.wrong("kind", "it is required"))?,
        edition: table.must_text("edition")?.to_owned(),
        confidence: table.word("confidence")?.ok_or_else(|| table.wrong("confidence", "it is required"))?,
        sources: owned(table.texts("sources")?),
        assumes: owned(table.texts("assumes")?),
        file: None,
    };
    let is_id = source.id.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-');
    if !is_id {
        return Err(table.wrong("id", "use lower-case letters, digits and hyphens only"));
    }
    table.finish()?;
    Ok(source)
}

fn options(rule: &str, written: &Value) -> Result<Vec<RuleOption>, RuleError> {
    let wrong =
        |what: &str| RuleError::Value { rule: rule.to_owned(), at: "[options]".to_owned(), what: what.to_owned() };
    let each = "write each option as a table of its own, such as [options.hours]";
    let table = written.as_table().ok_or_else(|| wrong(each))?;
    if table.len() > MOST_OPTIONS {
        return Err(wrong(&format!("a rule has at most {MOST_OPTIONS} options")));
    }
    let mut options = Vec::new();
    for (name, value) in table {
        if !name.chars().all(|c| c.is_ascii_lowercase() || c == '_') {
            return Err(wrong(&format!("{name:?} cannot be the name of an option; use lower-case letters and _ only")));
        }
        let table = value.as_table().ok_or_else(|| wrong(each))?;
        let table = TableReader::new(rule, format!("[options.{name}]"), table, RuleOption::KEYS)?;
        options.push(RuleOption::read(rule, name, table)?);
    }
    Ok(options)
}
