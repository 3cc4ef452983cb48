//! A rule's options: what it leaves to an authority, and how the values are put into the rule.

use super::days::DayName;
use super::error::RuleError;
use super::reader::{TableReader, number_of, secs_of};
use crate::choice::{listed, words};
use std::collections::{BTreeMap, BTreeSet};
use toml::{Table, Value};

/// The type of an option.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OptionType {
    /// A duration, `2h`.
    Duration,
    /// A number, `0.5`.
    Number,
    /// One of a list of words.
    Word,
    /// `true` or `false`.
    Flag,
    /// `03-21`, or the name of a season's point.
    Day,
}

words!(OptionType, [
    "duration" => OptionType::Duration,
    "number" => OptionType::Number,
    "word" => OptionType::Word,
    "flag" => OptionType::Flag,
    "day" => OptionType::Day,
]);

/// The value of an option.
#[derive(Clone, Debug, PartialEq)]
pub enum OptionValue {
    /// Seconds.
    Duration(i64),
    /// A finite number.
    Number(f64),
    /// A word, or a day.
    Word(String),
    /// True or false.
    Flag(bool),
}

impl OptionValue {
    /// As the value is written in a rule and on the command line.
    pub fn text(&self) -> String {
        match self {
            OptionValue::Duration(secs) => duration_text(*secs),
            OptionValue::Number(number) => number.to_string(),
            OptionValue::Word(word) => word.clone(),
            OptionValue::Flag(flag) => flag.to_string(),
        }
    }

    fn to_toml(&self) -> Value {
        match self {
            // an integer is written without a point, since a count is not read with one
            OptionValue::Number(number) if number.fract() == 0.0 && number.abs() < 1e15 => {
                Value::Integer(*number as i64)
            }
            OptionValue::Number(number) => Value::Float(*number),
            OptionValue::Flag(flag) => Value::Boolean(*flag),
            OptionValue::Duration(_) | OptionValue::Word(_) => Value::String(self.text()),
        }
    }
}

/// Writes a duration as rules read it: `1h30min`.
pub fn duration_text(secs: i64) -> String {
    let parts = [(secs / 3600, "h"), (secs / 60 % 60, "min"), (secs % 60, "s")];
    let text: String =
        parts.iter().filter(|(count, _)| *count > 0).map(|(count, unit)| format!("{count}{unit}")).collect();
    if text.is_empty() { "0s".to_owned() } else { text }
}

/// The most values of an option. A rule is tried with each of them.
const MOST_VALUES: usize = 100;

/// An option of a rule.
#[derive(Clone, Debug, PartialEq)]
pub struct RuleOption {
    /// Its name.
    pub name: String,
    /// What it decides.
    pub meaning: String,
    /// Its type.
    pub kind: OptionType,
    /// The only values that are allowed; empty if there is no such list.
    pub one_of: Vec<OptionValue>,
    /// The least and the greatest value: numbers, durations in seconds, days as 321 for 21 March.
    pub between: [f64; 2],
    /// Words that are allowed besides values of its type.
    pub words: Vec<String>,
    /// Values with names, such as a country's.
    pub known: Vec<(String, OptionValue)>,
    /// Its value if none is given; `None` if one must be given.
    pub default: Option<OptionValue>,
}

impl RuleOption {
    /// The keys that `[options.NAME]` may have.
    pub(super) const KEYS: &[&str] = &["means", "type", "one_of", "least", "most", "words", "known", "default"];

    pub(super) fn read(rule: &str, name: &str, table: TableReader) -> Result<RuleOption, RuleError> {
        let meaning = table.must_text("means")?.to_owned();
        let kind = table.word("type")?.ok_or_else(|| table.wrong("type", "it is required"))?;
        let bound = |key: &'static str, otherwise: f64| match kind {
            OptionType::Duration => Ok(table.secs(key)?.map_or(otherwise, |secs| secs as f64)),
            OptionType::Number => Ok(table.number(key, f64::MIN, f64::MAX)?.unwrap_or(otherwise)),
            OptionType::Day => {
                let day = table.text(key)?.map(DayName::parse).transpose();
                Ok(day.map_err(|what| table.wrong(key, what))?.map_or(otherwise, day_number))
            }
            // words and flags have no bounds; `finish` refuses them
            OptionType::Word | OptionType::Flag => Ok(otherwise),
        };
        let between = [bound("least", f64::NEG_INFINITY)?, bound("most", f64::INFINITY)?];
        let words = table.texts("words")?.into_iter().map(str::to_owned).collect();
        let mut option = RuleOption {
            name: name.to_owned(),
            meaning,
            kind,
            one_of: Vec::new(),
            between,
            words,
            known: Vec::new(),
            default: None,
        };
        let value = |option: &RuleOption, key: &str, value: &Value| {
            written(value)
                .and_then(|text| option.value(rule, &text).ok())
                .ok_or_else(|| table.wrong(key, format!("{value} is not {}", option.takes())))
        };
        if let Some(choices) = table.value("one_of") {
            let list = choices.as_array().ok_or_else(|| table.wrong("one_of", "write a list"))?;
            option.one_of = list.iter().map(|choice| value(&option, "one_of", choice)).collect::<Result<_, _>>()?;
        }
        if let Some(known) = table.value("known") {
            let names = known.as_table().ok_or_else(|| table.wrong("known", "write a table, { DE = 11.0 }"))?;
            let named = names.iter().map(|(name, known)| Ok((name.clone(), value(&option, "known", known)?)));
            option.known = named.collect::<Result<_, RuleError>>()?;
        }
        option.default = table.value("default").map(|default| value(&option, "default", default)).transpose()?;
        if option.one_of.len() + option.known.len() + option.words.len() > MOST_VALUES {
            return Err(table.wrong("one_of", format!("an option has at most {MOST_VALUES} values")));
        }
        if kind == OptionType::Word && option.one_of.is_empty() {
            return Err(table.wrong("one_of", "an option of type \"word\" needs the list of its words"));
        }
        table.finish()?;
        Ok(option)
    }

    /// Reads a value.
    ///
    /// # Errors
    /// [`RuleError::OptionValue`].
    pub fn value(&self, rule: &str, text: &str) -> Result<OptionValue, RuleError> {
        let refused = || RuleError::OptionValue {
            rule: rule.to_owned(),
            name: self.name.clone(),
            value: if text.is_empty() { "nothing".to_owned() } else { text.to_owned() },
            takes: self.takes(),
        };
        let text = text.trim();
        if let Some((_, value)) = self.known.iter().find(|(name, _)| name == text) {
            return Ok(value.clone());
        }
        if self.words.iter().any(|word| word == text) {
            return Ok(OptionValue::Word(text.to_owned()));
        }
        let value = self.of_type(text).ok_or_else(refused)?;
        let is_one = self.one_of.is_empty() || self.one_of.contains(&value);
        if is_one { Ok(value) } else { Err(refused()) }
    }

    fn of_type(&self, text: &str) -> Option<OptionValue> {
        let is_between = |number: f64| number >= self.between[0] && number <= self.between[1];
        match self.kind {
            OptionType::Duration => secs_of(text).filter(|secs| is_between(*secs as f64)).map(OptionValue::Duration),
            OptionType::Number => text
                .parse()
                .ok()
                .filter(|number: &f64| number.is_finite() && is_between(*number))
                .map(OptionValue::Number),
            OptionType::Word => is_word(text).then(|| OptionValue::Word(text.to_owned())),
            OptionType::Flag => text.parse().ok().map(OptionValue::Flag),
            OptionType::Day => {
                let day = DayName::parse(text).ok().filter(|day| is_between(day_number(*day)));
                day.map(|_| OptionValue::Word(text.to_owned()))
            }
        }
    }

    /// What the option allows, in words: `2h or 3h`.
    pub fn takes(&self) -> String {
        let named = self.known.iter().map(|(name, value)| format!("{name} ({})", value.text()));
        let more = self.words.iter().cloned().chain(named);
        let own: Vec<String> = if self.one_of.is_empty() {
            vec![self.takes_type()]
        } else {
            self.one_of.iter().map(OptionValue::text).collect()
        };
        let all: Vec<String> = own.into_iter().chain(more).collect();
        listed(&all.iter().map(String::as_str).collect::<Vec<_>>(), "or")
    }

    fn takes_type(&self) -> String {
        let [least, most] = self.between;
        let bound = |number: f64| match self.kind {
            OptionType::Duration => duration_text(number as i64),
            OptionType::Day => day_text(number),
            _ => number.to_string(),
        };
        let kind = match self.kind {
            OptionType::Duration => "a duration such as 1h30",
            OptionType::Number => "a number",
            OptionType::Word => "a word",
            OptionType::Flag => "true or false",
            OptionType::Day => "a day such as 03-21 or march-equinox",
        };
        match (least.is_finite(), most.is_finite()) {
            (true, true) => format!("{kind} from {} to {}", bound(least), bound(most)),
            (true, false) => format!("{kind} of at least {}", bound(least)),
            (false, true) => format!("{kind} of at most {}", bound(most)),
            (false, false) => kind.to_owned(),
        }
    }

    /// Values with which a rule is tried: all that are allowed, or a few if there is no list.
    pub(super) fn samples(&self) -> Vec<OptionValue> {
        let mut samples = self.one_of.clone();
        samples.extend(self.default.clone());
        samples.extend(self.known.iter().map(|(_, value)| value.clone()));
        samples.extend(self.words.iter().cloned().map(OptionValue::Word));
        let bounds = self.between.iter().copied().filter(|bound| bound.is_finite());
        match self.kind {
            OptionType::Flag => samples.extend([false, true].map(OptionValue::Flag)),
            OptionType::Duration => samples.extend(bounds.map(|secs| OptionValue::Duration(secs as i64))),
            OptionType::Number => samples.extend(bounds.map(OptionValue::Number)),
            OptionType::Day => samples.extend(bounds.map(|day| OptionValue::Word(day_text(day)))),
            OptionType::Word => {}
        }
        if samples.is_empty() {
            samples.push(match self.kind {
                OptionType::Duration => OptionValue::Duration(3600),
                OptionType::Number => OptionValue::Number(0.0),
                OptionType::Flag => OptionValue::Flag(false),
                OptionType::Word | OptionType::Day => OptionValue::Word("march-equinox".to_owned()),
            });
        }
        samples
    }
}

/// A day of the year as a number: 321 for 21 March.
fn day_number(day: DayName) -> f64 {
    let (month, day) = day.month_day();
    f64::from(100 * month + day)
}

fn day_text(number: f64) -> String {
    let number = number as u32;
    format!("{:02}-{:02}", number / 100, number % 100)
}

fn is_word(text: &str) -> bool {
    !text.is_empty() && text.chars().all(|c| c.is_alphanumeric() || c == '-' || c == '_')
}

/// A value as it is written in a rule.
fn written(value: &Value) -> Option<String> {
    match value {
        Value::String(text) => Some(text.clone()),
        Value::Boolean(flag) => Some(flag.to_string()),
        other => number_of(other).map(|number| number.to_string()),
    }
}

/// The options' values by name.
pub(super) type Choices = BTreeMap<String, OptionValue>;

/// A rule's table with the options put in: `"$hours"` becomes the option's value, or its text within a longer text. Of
/// tables in a list, those remain whose `when` holds.
pub(super) fn chosen_in(rule: &str, table: &Table, choices: &Choices) -> Result<Table, RuleError> {
    let mut chosen = Table::new();
    for (key, value) in table {
        chosen.insert(key.clone(), chosen_value(rule, key, value, choices)?);
    }
    Ok(chosen)
}

fn chosen_value(rule: &str, key: &str, value: &Value, choices: &Choices) -> Result<Value, RuleError> {
    match value {
        Value::String(text) => chosen_text(rule, key, text, choices),
        Value::Table(table) => Ok(Value::Table(chosen_in(rule, table, choices)?)),
        Value::Array(list) => {
            let mut chosen = Vec::new();
            for item in list {
                match item.as_table().and_then(|table| Some((table, table.get("when")?))) {
                    None => chosen.push(chosen_value(rule, key, item, choices)?),
                    Some((table, when)) => {
                        if holds(rule, key, when, choices)? {
                            let mut table = table.clone();
                            table.remove("when");
                            chosen.push(Value::Table(chosen_in(rule, &table, choices)?));
                        }
                    }
                }
            }
            Ok(Value::Array(chosen))
        }
        other => Ok(other.clone()),
    }
}

fn chosen_text(rule: &str, key: &str, text: &str, choices: &Choices) -> Result<Value, RuleError> {
    let of = |name: &str| choices.get(name).ok_or_else(|| no_option(rule, key, name, choices));
    let mut parts = text.split('$');
    let mut whole = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (name, rest) = part.split_at(part.find(|c: char| !is_name_letter(c)).unwrap_or(part.len()));
        let value = of(name)?;
        if whole.is_empty() && rest.is_empty() && text.len() == name.len() + 1 {
            return Ok(value.to_toml());
        }
        whole.push_str(&value.text());
        whole.push_str(rest);
    }
    Ok(Value::String(whole))
}

fn is_name_letter(c: char) -> bool {
    c.is_ascii_lowercase() || c == '_'
}

/// Whether all conditions of a `when` hold, such as `{ hokkaido = true, zone = "!low" }`.
fn holds(rule: &str, key: &str, when: &Value, choices: &Choices) -> Result<bool, RuleError> {
    let wrong = |what: String| RuleError::Value { rule: rule.to_owned(), at: format!("[[{key}]], when"), what };
    let table = when.as_table().ok_or_else(|| wrong("write it as a table, { hours = \"2h\" }".to_owned()))?;
    let mut all = true;
    for (name, value) in table {
        let chosen = choices.get(name).ok_or_else(|| no_option(rule, key, name, choices))?;
        let text = written(value).ok_or_else(|| wrong(format!("{value} cannot be the value of an option")))?;
        let (text, negated) = text.strip_prefix('!').map_or((text.as_str(), false), |text| (text, true));
        all &= (chosen.text() == text) != negated;
    }
    Ok(all)
}

fn no_option(rule: &str, key: &str, name: &str, choices: &Choices) -> RuleError {
    let nearest = crate::choice::nearest(name, choices.keys().map(String::as_str));
    let what = match nearest {
        Some(nearest) => format!("`${name}` is not an option of this rule; the nearest is `${nearest}`"),
        None => format!("`${name}` is not an option of this rule, which has none"),
    };
    RuleError::Value { rule: rule.to_owned(), at: key.to_owned(), what }
}

/// Collects the options that a table uses.
pub(super) fn used(value: &Value, found: &mut BTreeSet<String>) {
    match value {
        Value::String(text) => {
            let names = text.split('$').skip(1).map(|part| part.chars().take_while(|c| is_name_letter(*c)).collect());
            found.extend(names);
        }
        Value::Array(list) => list.iter().for_each(|item| used(item, found)),
        Value::Table(table) => {
            if let Some(when) = table.get("when").and_then(Value::as_table) {
                found.extend(when.keys().cloned());
            }
            table.values().for_each(|value| used(value, found));
        }
        _ => {}
    }
}
