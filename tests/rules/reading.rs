//! Reading rules, and what is refused.

use gnomon::rules::{
    BUILT_IN, Confidence, DayName, Demand, OptionValue, Rule, RuleError, built_in_rules, duration_text,
};

/// A small rule; tests change parts of it.
const SMALL: &str = r#"
[rule]
id = "town"
name = "A town's rule"
region = "Town"
kind = "law"
edition = "2026"
confidence = "V"

[options.hours]
means = "hours of sun"
type = "duration"
one_of = ["1h", "2h"]

[options.low]
means = "lowest sun"
type = "number"
least = 0.0
most = 30.0
known = { DE = 11.0 }
default = 5

[options.late]
means = "whether the afternoon counts alone"
type = "flag"
default = false

[clock]
kind = "legal"

[[day]]
when = { late = false }
days = ["03-21"]
windows = "day"

[[day]]
when = { late = true }
days = ["03-21"]
windows = [["12:00", "18:00"]]

[sun]
above = "$low"

[receiver]
kind = "area"

[count]
what = "sun"
how = "total"

[[pass]]
at_least = "$hours+30min"
share = 0.5
"#;

fn error(text: &str) -> String {
    Rule::parse("town", text).expect_err(text).to_string()
}

/// The rule with a piece replaced.
fn with(old: &str, new: &str) -> String {
    assert!(SMALL.contains(old), "{old}");
    SMALL.replacen(old, new, 1)
}

#[test]
fn options_become_plain_values() {
    let rule = Rule::parse("town", SMALL).expect("a rule");
    let of = |given: &[(&str, &str)]| rule.resolve(given).expect("options");
    let plain = of(&[("hours", "2h")]);
    assert_eq!(plain.criteria[0].demand, Demand::AtLeast { secs: 9000, longest_secs: 0 });
    assert_eq!(plain.cuts.above_deg, 5.0);
    assert_eq!(plain.days.len(), 1);
    let names: Vec<_> = plain.chosen.iter().map(|(name, value)| (name.as_str(), value.text())).collect();
    let said = [("hours", "2h"), ("late", "false"), ("low", "5")];
    assert_eq!(names, said.map(|(name, text)| (name, text.to_owned())));
    // a country's number, and a number of one's own
    assert_eq!(of(&[("hours", "1h"), ("low", "DE")]).cuts.above_deg, 11.0);
    assert_eq!(of(&[("hours", "60min"), ("low", "7.5")]).cuts.above_deg, 7.5);
    assert_ne!(of(&[("hours", "1h"), ("late", "true")]).days, plain.days);
}

#[test]
fn what_must_be_said_is_asked_for_at_once() {
    let two = with("default = 5\n", "");
    let rule = Rule::parse("town", &two).expect("a rule");
    let text = rule.resolve(&[]).expect_err("nothing said").to_string();
    for part in ["`hours`, hours of sun (1h or 2h)", "`low`, lowest sun (a number from 0 to 30 or DE (11))"] {
        assert!(text.contains(part), "{text}");
    }
    let refused = |given: &[(&str, &str)]| rule.resolve(given).expect_err("refused").to_string();
    assert!(refused(&[("hour", "2h")]).contains("the nearest is `hours`"));
    for (name, value) in [
        ("hours", "3h"),
        ("hours", ""),
        ("hours", "2"),
        ("low", "31"),
        ("low", "-1"),
        ("low", "nan"),
        ("low", "FR"),
        ("late", "yes"),
    ] {
        let text = refused(&[(name, value)]);
        assert!(text.contains(&format!("option `{name}`")), "{text}");
    }
}

#[test]
fn a_misspelt_key_is_an_error_that_names_the_nearest() {
    let mut tried = 0;
    for (id, text) in BUILT_IN {
        let lines: Vec<&str> = text.lines().collect();
        for (at, line) in lines.iter().enumerate() {
            let Some((key, _)) =
                line.split_once(" = ").filter(|(key, _)| key.chars().all(|c| c.is_ascii_lowercase() || c == '_'))
            else {
                continue;
            };
            if key == "when" {
                continue;
            }
            let mut wrong = lines.clone();
            let misspelt = line.replacen(key, &format!("{key}x"), 1);
            wrong[at] = &misspelt;
            match Rule::parse(id, &wrong.join("\n")) {
                Err(RuleError::UnknownKey { key: found, nearest, .. }) => {
                    assert_eq!((found, nearest.as_str()), (format!("{key}x"), key), "{id}: {line}");
                }
                other => panic!("{id}: {misspelt}: {other:?}"),
            }
            tried += 1;
        }
    }
    assert!(tried > 300, "only {tried} keys were tried");
}

#[test]
fn misspelt_tables_and_whens_are_errors() {
    for (old, new, part) in [
        ("[clock]", "[clok]", "rule town, before any table: there is no key `clok` here; the nearest is `clock`"),
        ("[[pass]]", "[[pas]]", "`pas`"),
        ("[sun]\nabove = \"$low\"", "[[day]]\nabove = 1", "[[day]] number 2: there is no key `above`"),
        ("[[day]]\nwhen = { late = false }", "[[days]]\nwhen = { late = false }", "`days`"),
        ("when = { late = false }", "when = { lat = false }", "the nearest is `$late`"),
        ("when = { late = false }", "when = 1", "as a table"),
        ("\"$low\"", "\"$lo\"", "the nearest is `$low`"),
        ("[sun]\n", "[sun]\nwhen = { late = true }\n", "`when`"),
        ("[options.low]", "[options.Low]", "cannot be the name of an option"),
        ("[[pass]]", "[pass]", "[[pass]]"),
    ] {
        let text = error(&with(old, new));
        assert!(text.contains(part), "{new}: {text}");
    }
}

#[test]
fn values_that_cannot_be_are_errors() {
    for (old, new, part) in [
        ("kind = \"law\"", "kind = \"lawe\"", "nearest is \"law\""),
        ("confidence = \"V\"", "confidence = 1", "text in quotes"),
        ("id = \"town\"", "id = \"Town!\"", "lower-case letters"),
        ("edition = \"2026\"", "edition = \" \"", "is required"),
        ("kind = \"legal\"", "kind = \"fixed\"", "offset"),
        ("kind = \"legal\"", "kind = \"legal\"\noffset = \"-05:00\"", "fixed"),
        ("days = [\"03-21\"]", "days = [\"02-29\"]", "every year"),
        ("days = [\"03-21\"]", "days = [\"winter\"]", "every year"),
        ("days = [\"03-21\"]", "days = [\"03-21\", \"06-21\"]", "judge"),
        ("days = [\"03-21\"]", "range = [\"03-21\"]", "range"),
        ("windows = \"day\"", "windows = \"night\"", "windows"),
        ("windows = \"day\"", "windows = []", "windows"),
        ("[[\"12:00\", \"18:00\"]]", "[[\"18:00\", \"12:00\"]]", "ends before it begins"),
        ("[[\"12:00\", \"18:00\"]]", "[[\"2026-01-01T12:00\", \"18:00\"]]", "windows"),
        ("kind = \"area\"", "kind = \"area\"\nsill = 1.0", "has no effect with"),
        ("kind = \"area\"", "kind = \"area\"\nleast_width = -1", "between"),
        ("kind = \"area\"", "kind = \"facade\"", "kind = \"area\""),
        ("how = \"total\"", "how = \"instants\"", "step"),
        ("how = \"total\"", "how = \"total\"\nbridge_counts = true", "bridge"),
        ("how = \"total\"", "how = \"area-time\"", "area-time"),
        ("what = \"sun\"", "what = \"new-shadow\"", "before"),
        ("share = 0.5", "share = 1.5", "rule town, [[pass]] number 1, share: 1.5 is not between 0 and 1"),
        ("share = 0.5", "or_area = 40.0", "share"),
        ("share = 0.5", "ratio = 0.8", "before"),
        ("share = 0.5", "share = 0.5\nof = \"rooms\"", "dwellings"),
        ("share = 0.5", "share = 0.5\nof = \"dwellings\"", "all_of"),
        ("share = 0.5", "share = 0.5\nband = 1", "0 bands"),
        ("share = 0.5", "share = 0.5\nband = 0", "at least 1"),
        ("share = 0.5", "on = \"winter\"", "winter"),
        ("share = 0.5", "report = true", "one of"),
        ("share = 0.5", "at_most = \"2h\"", "one of"),
        ("share = 0.5", "no_sun_left = \"10min\"", "report"),
        ("at_least = \"$hours+30min\"", "at_least = \"soon\"", "duration"),
        ("at_least = \"$hours+30min\"", "at_least = 2", "duration"),
        ("default = 5\n", "default = 50\n", "default"),
        ("type = \"flag\"", "type = \"flag\"\nleast = 0", "has no effect with"),
        ("type = \"flag\"", "type = \"word\"", "the list of its words"),
        ("means = \"lowest sun\"", "means = \"\"", "is required"),
        ("[sun]\nabove = \"$low\"", "[sun]\nabove = 3.0", "nothing depends on it"),
        ("[sun]\n", "[sun]\noff_facade = 12.0\n", "off_facade_in"),
        ("[clock]", "[dwelling]\n[clock]", "rooms"),
        ("[clock]", "[dwelling]\nrooms = [[2, 1]]\n[clock]", "rooms"),
        ("[rule]", "[rules]", "[rule]"),
        ("[rule]", "[rule", "town"),
    ] {
        let text = error(&with(old, new));
        assert!(text.contains(part), "{new}: {text}");
    }
}

/// An error that only one value of an option causes is found before anybody chooses that value.
#[test]
fn mistakes_do_not_wait_for_a_choice() {
    let broken = with("one_of = [\"1h\", \"2h\"]", "one_of = [\"1h\", \"2h\"]\nwords = [\"much\"]");
    assert!(error(&broken).contains("at_least"), "{}", error(&broken));
    let late = with("[[\"12:00\", \"18:00\"]]", "[[\"12:00\", \"noon\"]]");
    assert!(error(&late).contains("windows"), "{}", error(&late));
}

#[test]
fn grades_are_a_ladder() {
    let graded = |first: &str, second: &str| {
        let new = format!("{first}\nat_least = \"2h\"\n\n[[pass]]\n{second}\nat_least = \"3h\"");
        Rule::parse("town", &with("at_least = \"$hours+30min\"\nshare = 0.5", &new.replace("\"3h\"", "\"$hours+2h\"")))
    };
    assert!(graded("grade = \"low\"", "grade = \"high\"").is_ok());
    assert!(graded("grade = \"low\"", "").is_err());
    let falling = SMALL.replace(
        "at_least = \"$hours+30min\"",
        "grade = \"a\"\nat_least = \"$hours+30min\"\n[[pass]]\ngrade = \"b\"\nat_least = \"1h\"",
    );
    assert!(error(&falling).contains("lowest first"), "{}", error(&falling));
}

#[test]
fn built_in_rules_say_where_they_are_from() {
    let rules = built_in_rules().expect("rules");
    assert_eq!(rules.len(), BUILT_IN.len());
    for (rule, (id, text)) in rules.iter().zip(BUILT_IN) {
        assert_eq!(rule.source.id, *id);
        assert_eq!(rule.text, *text);
        assert!(!rule.source.sources.is_empty() && !rule.source.assumes.is_empty(), "{id}");
        // another program's word, or memory, is no ground for a rule
        assert!(matches!(rule.source.confidence, Confidence::V | Confidence::Vt | Confidence::S), "{id}");
        for option in &rule.options {
            assert!(option.meaning.len() > 10, "{id}: {}", option.name);
        }
    }
    let ids: Vec<_> = BUILT_IN.iter().map(|(id, _)| *id).collect();
    assert!(ids.is_sorted() && ids.len() == 17, "{ids:?}");
}

#[test]
fn durations_and_days_are_written_as_they_are_read() {
    for (secs, text) in [(0, "0s"), (5400, "1h30min"), (7200, "2h"), (61, "1min1s"), (90, "1min30s")] {
        assert_eq!(duration_text(secs), text);
        assert_eq!(gnomon::sun::parse_duration_secs(text).ok(), u32::try_from(secs).ok());
    }
    assert_eq!(OptionValue::Duration(5400).text(), "1h30min");
    assert_eq!(DayName::parse("03-21"), Ok(DayName::MonthDay(3, 21)));
    for wrong in ["3-21", "03-32", "13-01", "02-29", "03/21", "", "equinox", "é", "٠٣-٢١"] {
        assert!(DayName::parse(wrong).is_err(), "{wrong}");
    }
}

/// No text of a rule makes the reader panic.
#[test]
fn cut_and_changed_rules_are_refused_or_read() {
    for (id, text) in BUILT_IN {
        let stops = (0..text.len()).step_by(97).filter(|stop| text.is_char_boundary(*stop));
        for stop in stops {
            let _ = Rule::parse(id, &text[..stop]);
        }
        for (old, new) in [("0", "9e99"), ("\"$", "\"$$"), ("[[", "["), ("h\"", "h$\""), ("= ", "= -"), ("1", "nan")] {
            let _ = Rule::parse(id, &text.replace(old, new));
        }
    }
}
