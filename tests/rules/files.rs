//! Where rules are found: beside the site, or built in.

use gnomon::rules::{BUILT_IN, RuleError, built_in_text, rule_for_site, rules_for_site};
use std::fs;

#[test]
fn a_rule_beside_the_site_goes_first() {
    let folder = tempfile::tempdir().expect("a folder");
    let found = |name: &str| rule_for_site(name, folder.path());
    assert_eq!(found("nl-tno-light").expect("built in").source.edition, "TNO, lichte norm");
    let text = built_in_text("nl-tno-light").expect("built in");
    let own = text.replace("TNO, lichte norm", "our town's").replace("\"2h\"", "\"1h\"");
    fs::write(folder.path().join("nl-tno-light.toml"), &own).expect("written");
    assert_eq!(found("nl-tno-light").expect("beside").source.edition, "our town's");
    // by any name, too, with its own id
    fs::write(folder.path().join("mine.toml"), &own).expect("written");
    for name in ["mine", "mine.toml"] {
        assert_eq!(found(name).expect("beside").text, own, "{name}");
    }
}

/// The list has what can be asked for: files that say a rule, also broken ones, and what is built in.
#[test]
fn rules_of_a_site_are_listed() {
    let folder = tempfile::tempdir().expect("a folder");
    let own = built_in_text("nl-tno-light").expect("built in").replace("TNO, lichte norm", "our town's");
    for (name, text) in [
        ("nl-tno-light.toml", own.as_str()),
        ("broken.toml", "[rule]\nid = 1\n"),
        ("site.toml", "[place]\nlatitude = 1.0\n"),
        ("notes.txt", "[rule]\n"),
    ] {
        fs::write(folder.path().join(name), text).expect("written");
    }
    let known = rules_for_site(folder.path());
    assert_eq!(known.len(), BUILT_IN.len() + 1, "the built-in ones, of which one is replaced, and the broken one");
    let (broken, light) = (&known[0], &known[1]);
    assert!(broken.0 == "broken" && broken.1.is_err(), "{broken:?}");
    assert_eq!(light.0, "nl-tno-light");
    assert_eq!(light.1.as_ref().expect("a rule").source.edition, "our town's");
    assert!(known[2..].iter().all(|(_, rule)| rule.is_ok()));
    assert_eq!(rules_for_site(&folder.path().join("nowhere")).len(), BUILT_IN.len());
}

#[test]
fn what_is_no_rule_says_so() {
    let folder = tempfile::tempdir().expect("a folder");
    let error = |name: &str| rule_for_site(name, folder.path()).expect_err(name);
    let unknown = error("nl-tno-lite");
    assert!(matches!(&unknown, RuleError::UnknownRule { nearest, .. } if nearest == "nl-tno-light"), "{unknown}");
    assert!(matches!(error("mine.toml"), RuleError::File { .. }));
    fs::write(folder.path().join("latin.toml"), b"# caf\xe9\n[rule]\n").expect("written");
    assert!(error("latin").to_string().contains("UTF-8"));
    fs::write(folder.path().join("site.toml"), "[place]\nlatitude = 1.0\n").expect("written");
    assert!(error("site").to_string().contains("[rule]"));
    fs::write(folder.path().join("large.toml"), vec![b'#'; (64 << 10) + 1]).expect("written");
    assert!(error("large").to_string().contains("64 KiB"));
    fs::create_dir(folder.path().join("folder.toml")).expect("made");
    assert!(matches!(error("folder.toml"), RuleError::File { .. }));
}
