//! Reads the tables of a rule. A key that the table never has is an error at once; a key that the other keys make
//! useless is an error at the end.

use super::error::RuleError;
use crate::choice::{find, nearest};
use crate::sun::parse_duration_secs;
use std::cell::RefCell;
use std::str::FromStr;
use toml::{Table, Value};

/// A reader of one table of a rule.
pub(super) struct TableReader<'a> {
    rule: &'a str,
    at: String,
    table: &'a Table,
    asked: RefCell<Vec<&'static str>>,
}

impl<'a> TableReader<'a> {
    /// A reader of a table that may have these keys.
    pub(super) fn new(
        rule: &'a str,
        at: impl Into<String>,
        table: &'a Table,
        keys: &[&str],
    ) -> Result<TableReader<'a>, RuleError> {
        let at = at.into();
        if let Some(key) = table.keys().find(|key| !keys.contains(&key.as_str())) {
            return Err(RuleError::UnknownKey {
                rule: rule.to_owned(),
                at: if at.is_empty() { "before any table".to_owned() } else { at },
                key: key.clone(),
                nearest: nearest(key, keys.iter().copied()).unwrap_or_default().to_owned(),
            });
        }
        Ok(TableReader { rule, at, table, asked: RefCell::default() })
    }

    pub(super) fn value(&self, key: &'static str) -> Option<&'a Value> {
        self.asked.borrow_mut().push(key);
        self.table.get(key)
    }

    pub(super) fn has(&self, key: &'static str) -> bool {
        self.value(key).is_some()
    }

    /// An error at a key of this table.
    pub(super) fn wrong(&self, key: &str, what: impl Into<String>) -> RuleError {
        let parts = [self.at.as_str(), key];
        let at = parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(", ");
        RuleError::Value { rule: self.rule.to_owned(), at, what: what.into() }
    }

    fn read<T>(
        &self,
        key: &'static str,
        example: &str,
        of: impl Fn(&'a Value) -> Option<T>,
    ) -> Result<Option<T>, RuleError> {
        let Some(value) = self.value(key) else { return Ok(None) };
        of(value).map(Some).ok_or_else(|| self.wrong(key, format!("{value} cannot be read; write it as {example}")))
    }

    pub(super) fn text(&self, key: &'static str) -> Result<Option<&'a str>, RuleError> {
        self.read(key, "text in quotes", Value::as_str)
    }

    /// A text that must not be missing or empty.
    pub(super) fn must_text(&self, key: &'static str) -> Result<&'a str, RuleError> {
        match self.text(key)? {
            Some(text) if !text.trim().is_empty() => Ok(text),
            _ => Err(self.wrong(key, "it is required")),
        }
    }

    pub(super) fn texts(&self, key: &'static str) -> Result<Vec<&'a str>, RuleError> {
        let list = |value: &'a Value| value.as_array()?.iter().map(Value::as_str).collect();
        Ok(self.read(key, "a list of texts, [\"a\", \"b\"]", list)?.unwrap_or_default())
    }

    pub(super) fn flag(&self, key: &'static str) -> Result<bool, RuleError> {
        Ok(self.read(key, "true or false", Value::as_bool)?.unwrap_or(false))
    }

    /// A number within bounds.
    pub(super) fn number(&self, key: &'static str, least: f64, most: f64) -> Result<Option<f64>, RuleError> {
        let Some(number) = self.read(key, "a number", number_of)? else { return Ok(None) };
        if (least..=most).contains(&number) {
            return Ok(Some(number));
        }
        Err(self.wrong(key, format!("{number} is not between {least} and {most}")))
    }

    /// A whole number of at least 1.
    pub(super) fn count(&self, key: &'static str) -> Result<Option<usize>, RuleError> {
        let whole = |value: &Value| usize::try_from(value.as_integer()?).ok().filter(|count| *count > 0);
        self.read(key, "a whole number of at least 1", whole)
    }

    /// A duration, or a sum of durations such as `2h+30min`, in seconds.
    pub(super) fn secs(&self, key: &'static str) -> Result<Option<i64>, RuleError> {
        self.read(key, "a duration, \"2h\", \"1h30\" or \"2h+30min\"", |value| secs_of(value.as_str()?))
    }

    /// One of the words of a type.
    pub(super) fn word<T: FromStr>(&self, key: &'static str) -> Result<Option<T>, RuleError>
    where
        T::Err: std::fmt::Display,
    {
        let Some(word) = self.text(key)? else { return Ok(None) };
        word.parse().map(Some).map_err(|error: T::Err| self.wrong(key, error.to_string()))
    }

    /// One of the words of a list.
    pub(super) fn one_of<T: Copy>(
        &self,
        key: &'static str,
        choices: &[(&'static str, T)],
    ) -> Result<Option<T>, RuleError> {
        let Some(word) = self.text(key)? else { return Ok(None) };
        find(word, choices).map(Some).map_err(|error| self.wrong(key, error.to_string()))
    }

    /// A table within this one.
    pub(super) fn table(&self, key: &'static str, keys: &[&str]) -> Result<Option<TableReader<'a>>, RuleError> {
        let table = self.read(key, &format!("a table, [{key}]"), Value::as_table)?;
        table.map(|table| TableReader::new(self.rule, format!("[{key}]"), table, keys)).transpose()
    }

    /// The tables of a list.
    pub(super) fn tables(&self, key: &'static str, keys: &[&str]) -> Result<Vec<TableReader<'a>>, RuleError> {
        let list = |value: &'a Value| value.as_array()?.iter().map(Value::as_table).collect::<Option<Vec<_>>>();
        let tables = self.read(key, &format!("tables, each headed [[{key}]]"), list)?.unwrap_or_default();
        let reader = |(at, table)| TableReader::new(self.rule, format!("[[{key}]] number {}", at + 1), table, keys);
        tables.into_iter().enumerate().map(reader).collect()
    }

    /// Refuses keys that nothing has read, as they contradict the others.
    pub(super) fn finish(self) -> Result<(), RuleError> {
        let asked = self.asked.borrow();
        let Some(key) = self.table.keys().find(|key| !asked.contains(&key.as_str())) else { return Ok(()) };
        Err(self.wrong(key, "it has no effect with the other keys here; leave it out"))
    }
}

/// A finite number, integer or not.
pub(super) fn number_of(value: &Value) -> Option<f64> {
    let number = value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64));
    number.filter(|number| number.is_finite())
}

/// A duration, or a sum of durations, in seconds.
pub(super) fn secs_of(text: &str) -> Option<i64> {
    text.split('+').map(|part| parse_duration_secs(part).ok().map(i64::from)).sum()
}
