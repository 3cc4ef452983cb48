//! `gnomon rules`: the list of rules, and printing a rule.

use crate::shared::program::{done, fails};
use gnomon::rules::{BUILT_IN, Rule};

#[test]
fn rules_are_listed_with_what_they_rest_on() {
    let folder = tempfile::tempdir().unwrap();
    let list = done(folder.path(), "rules");
    for (id, text) in BUILT_IN {
        let source = Rule::parse(id, text).unwrap().source;
        for part in [*id, source.name.as_str(), &source.region, &source.edition, &source.sources[0]] {
            assert!(list.contains(part), "{id}: the list does not say {part}");
        }
    }
    for part in [
        "check with your authority",
        "option hours: 2h or 3h [required]",
        "option loss: both or either [default: both]",
        "option above: a number from 0 to 45 or DE (11) [required]",
    ] {
        assert!(list.contains(part), "{list}");
    }
}

#[test]
fn a_rule_is_shown_as_it_is_written() {
    let folder = tempfile::tempdir().unwrap();
    for (id, text) in BUILT_IN {
        assert_eq!(done(folder.path(), &format!("rules show {id}")), *text);
    }
}

#[test]
fn a_rule_that_is_none_names_the_nearest() {
    let folder = tempfile::tempdir().unwrap();
    fails(folder.path(), "rules show uk-bre", 2, &["no rule `uk-bre`", "uk-bre-209-sun-on-ground", "gnomon rules"]);
    fails(folder.path(), "rules show", 2, &["<ID>"]);
    fails(folder.path(), "rules list", 2, &["list"]);
}
