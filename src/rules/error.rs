//! Why a rule cannot be read, found, or applied.

/// What is wrong with a rule, or with what is chosen of it; each says where it is, and the way out.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RuleError {
    /// The text is no TOML.
    #[error("rule {rule}: {what}")]
    Toml {
        /// Which rule.
        rule: String,
        /// What the reader of TOML says.
        what: String,
    },
    /// A key that no rule has.
    #[error("rule {rule}, {at}: there is no key `{key}` here; the nearest is `{nearest}`")]
    UnknownKey {
        /// Which rule.
        rule: String,
        /// In which table.
        at: String,
        /// As written.
        key: String,
        /// What was probably meant.
        nearest: String,
    },
    /// A value that the key cannot have, or a key that is missing or does not go with the others.
    #[error("rule {rule}, {at}: {what}")]
    Value {
        /// Which rule.
        rule: String,
        /// At which key.
        at: String,
        /// What is wrong, and what can be written.
        what: String,
    },
    /// An option that the rule does not have.
    #[error("rule {rule} has no option `{name}`; {known}")]
    UnknownOption {
        /// Which rule.
        rule: String,
        /// As written.
        name: String,
        /// The nearest one, or that it has none.
        known: String,
    },
    /// An option that cannot have the value.
    #[error("rule {rule}, option `{name}`: {value} is not {takes}")]
    OptionValue {
        /// Which rule.
        rule: String,
        /// The option.
        name: String,
        /// As written.
        value: String,
        /// What it can be.
        takes: String,
    },
    /// Options without a default that nobody has chosen, all of them.
    #[error("rule {rule} leaves to the authority, and you must say: {missing}")]
    Unsaid {
        /// Which rule.
        rule: String,
        /// Each with its meaning and its choices.
        missing: String,
    },
    /// A rule that is neither beside the site nor built in.
    #[error("there is no rule {id}; the nearest is {nearest}")]
    UnknownRule {
        /// As written.
        id: String,
        /// What was probably meant.
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
    /// What the rule needs and the site does not say.
    #[error("rule {rule} needs {what}")]
    Needs {
        /// Which rule.
        rule: String,
        /// What is missing.
        what: String,
    },
}
