//! Where rules are found: beside the site, or built in.

use gnomon::rules::{RuleError, built_in_text, rule_for_site};
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
