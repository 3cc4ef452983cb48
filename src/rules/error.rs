//! Errors of reading, finding and applying rules.

/// What is wrong with a rule or with the values of its options. Each message says where, and what to do.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RuleError {
    /// The text is not TOML.
    #[error("rule {rule}: {what}")]
    Toml {
        /// The rule's id, or its file until the id is known.
        rule: String,
        /// The message of the TOML parser.
        what: String,
    },
    /// A key that its table does not have.
    #[error("rule {rule}, {at}: there is no key `{key}` here; the nearest is `{nearest}`")]
    UnknownKey {
        /// The rule.
        rule: String,
        /// The table.
        at: String,
        /// The key as written.
        key: String,
        /// The nearest key that exists.
        nearest: String,
    },
    /// A value that the key does not allow, or a key that is missing or contradicts the others.
    #[error("rule {rule}, {at}: {what}")]
    Value {
        /// The rule.
        rule: String,
        /// The table and the key.
        at: String,
        /// What is wrong, and what can be written.
        what: String,
    },
    /// An option that the rule does not have.
    #[error("rule {rule} has no option `{name}`; {known}")]
    UnknownOption {
        /// The rule.
        rule: String,
        /// The option as written.
        name: String,
        /// The nearest option, or that the rule has none.
        known: String,
    },
    /// A value that the option does not allow.
    #[error("rule {rule}, option `{name}`: {value} is not {takes}")]
    OptionValue {
        /// The rule.
        rule: String,
        /// The option.
        name: String,
        /// The value as written.
        value: String,
        /// What the option allows.
        takes: String,
    },
    /// Options without a default that were not given a value, all of them.
    #[error("rule {rule} has options without a default, and you must choose: {missing}{}", also(needs))]
    Unsaid {
        /// The rule.
        rule: String,
        /// The options, each with its meaning and its values.
        missing: String,
        /// What the site does not have and the rule needs, whatever is chosen; empty where no site is known yet.
        needs: Vec<RuleNeed>,
    },
    /// A rule that is neither in the site's folder nor built in.
    #[error("there is no rule `{id}`; the nearest is `{nearest}`")]
    UnknownRule {
        /// The id as written.
        id: String,
        /// The nearest id.
        nearest: String,
    },
    /// A file that cannot be read as a rule.
    #[error("{path}: {what}")]
    File {
        /// The file.
        path: String,
        /// What is wrong with it.
        what: String,
    },
    /// Information that the rule needs and the site does not have.
    #[error("rule {rule} needs {}", listed(needs))]
    Needs {
        /// The rule.
        rule: String,
        /// What is missing, all of it.
        needs: Vec<RuleNeed>,
    },
}

/// Something that a rule needs and a site does not have.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RuleNeed {
    /// What is missing.
    pub what: String,
    /// Where a site file says it, a table with its brackets and a key; an empty key is the table itself. `None` where no
    /// key would help.
    pub said_at: Option<[&'static str; 2]>,
}

impl RuleNeed {
    /// What a key of a site file says.
    pub fn of_key(what: impl Into<String>, table: &'static str, key: &'static str) -> RuleNeed {
        RuleNeed { what: what.into(), said_at: Some([table, key]) }
    }

    /// What no key of a site file would add.
    pub fn without_key(what: impl Into<String>) -> RuleNeed {
        RuleNeed { what: what.into(), said_at: None }
    }
}

fn also(needs: &[RuleNeed]) -> String {
    if needs.is_empty() { String::new() } else { format!("; it also needs {}", listed(needs)) }
}

fn listed(needs: &[RuleNeed]) -> String {
    needs.iter().map(|need| need.what.as_str()).collect::<Vec<_>>().join("; ")
}
