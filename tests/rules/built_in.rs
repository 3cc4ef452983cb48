//! Each built-in rule on either side of its limits, and its page.

use super::{calendar, hours, lit, lit_in, minutes, rule, spells};
use gnomon::rules::{BUILT_IN, DayLight, DwellingShare, RULE_KEYS, Rule, Verdict, built_in_rules};
use std::path::Path;

/// Options as given on the command line.
type Given = &'static [(&'static str, &'static str)];

/// Rules of windows and façades that demand a total time, with their required options.
const AT_LEAST: &[(&str, Given, i64)] = &[
    ("eu-en-17037-sunlight", &[("above", "DE")], 5400),
    ("eu-en-17037-sunlight", &[("above", "13"), ("date", "02-14")], 5400),
    ("cn-gb-50180-dwelling", &[("day", "great-cold"), ("hours", "2h")], 7200),
    ("cn-gb-50180-dwelling", &[("day", "great-cold"), ("hours", "3h")], 10_800),
    ("cn-gb-50180-dwelling", &[("day", "december-solstice"), ("hours", "1h")], 3600),
    ("pl-wt-60", &[("clock", "legal")], 10_800),
    ("pl-wt-60", &[("clock", "true-solar"), ("use", "children")], 10_800),
    ("pl-wt-60", &[("clock", "standard"), ("hours", "1h30")], 5400),
    ("nl-tno-light", &[], 7200),
    ("nl-tno-strict", &[], 10_800),
    ("nl-the-hague", &[], 7200),
    ("de-din-5034-1", &[], 14_400),
    ("de-din-5034-1", &[("winter", "false")], 14_400),
];

#[test]
fn each_limit_is_kept_by_its_own_seconds_and_missed_by_one_less() {
    for (id, given, limit) in AT_LEAST {
        let rule = rule(id, given);
        let kept = lit(&rule, *limit, None);
        assert_eq!(kept.verdict, Verdict::Pass, "{id} {given:?}");
        let missed = lit(&rule, limit - 1, None);
        assert_eq!(missed.verdict, Verdict::Fail, "{id} {given:?}");
        let deciding = &missed.findings[missed.deciding.expect("one decides")];
        assert_eq!(deciding.margin, Some(-1.0), "{id}");
    }
}

#[test]
fn short_spells_in_beijing() {
    let given = [("day", "great-cold"), ("hours", "2h"), ("shortest", "5min")];
    let rule = rule("cn-gb-50180-dwelling", &given);
    assert_eq!(lit_in(&rule, &[minutes(115), minutes(5)], None).verdict, Verdict::Pass);
    assert_eq!(lit_in(&rule, &[minutes(116), minutes(5) - 1], None).verdict, Verdict::Fail);
}

/// The worked cases of the rule of interrupted sun: 2 h on end, or 2 h 30 with a spell of an hour.
#[test]
fn interrupted_sun_in_russia() {
    let of = |given: [(&str, &str); 3], lengths: &[i64]| {
        lit_in(&rule("ru-sanpin-1-2-3685-21", &given), lengths, None).verdict
    };
    let central = [("latitude", "central"), ("edge", "1h"), ("gap", "10min")];
    let verdict = |lengths: &[i64]| of(central, &lengths.iter().map(|length| minutes(*length)).collect::<Vec<_>>());
    assert_eq!(verdict(&[120]), Verdict::Pass);
    assert_eq!(of(central, &[hours(2) - 1]), Verdict::Fail);
    assert_eq!(verdict(&[70, 80]), Verdict::Pass);
    assert_eq!(of(central, &[minutes(70), minutes(80) - 1]), Verdict::Fail);
    assert_eq!(verdict(&[70, 70]), Verdict::Fail);
    assert_eq!(verdict(&[50, 55, 50]), Verdict::Fail);
    assert_eq!(of(central, &[hours(1) - 1, minutes(55), minutes(55)]), Verdict::Fail);
    assert_eq!(of(central, &[hours(1), minutes(45), minutes(45)]), Verdict::Pass);
    // the gaps between the spells are of 20 minutes: a longer bridge makes one spell of them
    assert_eq!(
        of([("latitude", "central"), ("edge", "1h"), ("gap", "20min")], &[minutes(60), minutes(60)]),
        Verdict::Pass
    );
    assert_eq!(of(central, &[minutes(60), minutes(60)]), Verdict::Fail);
    let with = |latitude| [("latitude", latitude), ("edge", "0s"), ("gap", "0s")];
    for (latitude, limit) in [("north", minutes(150)), ("south", minutes(90))] {
        assert_eq!(of(with(latitude), &[limit]), Verdict::Pass, "{latitude}");
        assert_eq!(of(with(latitude), &[limit - 1]), Verdict::Fail, "{latitude}");
        assert_eq!(of(with(latitude), &[hours(1), limit - hours(1) + minutes(30)]), Verdict::Pass, "{latitude}");
    }
}

/// Each strip around the plot has its own limit.
#[test]
fn two_strips_in_japan() {
    let given = [("plane", "4"), ("near", "4h"), ("far", "2h30")];
    let japan = rule("jp-bsa-56-2", &given);
    let days = calendar(&japan);
    let whole = days[0].windows[0].secs();
    let verdict = |band: usize, shadow: i64| {
        let lit = spells(&days[0], &[whole - shadow]);
        let light = DayLight { day: &days[0], open: &days[0].windows, lit: &lit, before: None, newly_shaded: None };
        let ruling = japan.judge_time(Some(band), &[light]).expect("a ruling");
        assert_eq!(ruling.findings.len(), 1);
        ruling.verdict
    };
    assert_eq!([verdict(0, hours(4)), verdict(0, hours(4) + 1)], [Verdict::Pass, Verdict::Fail]);
    assert_eq!([verdict(1, minutes(150)), verdict(1, minutes(150) + 1)], [Verdict::Pass, Verdict::Fail]);
    // within 5 m of the border nothing is asked
    let light = DayLight { day: &days[0], open: &days[0].windows, lit: &[], before: None, newly_shaded: None };
    assert_eq!(japan.judge_time(None, &[light]).expect("a ruling").verdict, Verdict::Report);
    let hokkaido = rule("jp-bsa-56-2", &[("plane", "4"), ("near", "3h"), ("far", "2h"), ("hokkaido", "true")]);
    let day = calendar(&hokkaido)[0].clone();
    assert!((day.windows[0].secs() - hours(6)).abs() < 15);
}

#[test]
fn zurich_counts_shadow_on_both_days() {
    let zurich = rule("ch-zh-abv", &[]);
    let days = calendar(&zurich);
    let dates: Vec<String> = days.iter().map(|day| day.date.format("%m-%d").to_string()).collect();
    assert_eq!(dates, ["11-03", "02-08"]);
    // one day in shadow for a second too long
    let lit = [spells(&days[0], &[hours(6)]), spells(&days[1], &[hours(6) - 1])];
    let lights: Vec<_> = days
        .iter()
        .zip(&lit)
        .map(|(day, lit)| DayLight { day, open: &day.windows, lit, before: None, newly_shaded: None })
        .collect();
    let ruling = zurich.judge_time(None, &lights).expect("a ruling");
    assert_eq!((ruling.verdict, ruling.deciding), (Verdict::Fail, Some(1)));
    let two = rule("ch-zh-abv", &[("hours", "2h"), ("season", "summer")]);
    assert_eq!(super::lit(&two, hours(7), None).verdict, Verdict::Pass);
    assert_eq!(super::lit(&two, hours(7) - 1, None).verdict, Verdict::Fail);
}

/// In all rules of dwellings one room is enough, except for larger dwellings in Russia.
#[test]
fn rules_of_dwellings() {
    let with_rooms: Vec<&str> = BUILT_IN.iter().map(|(id, _)| *id).filter(|id| sample(id).dwelling.is_some()).collect();
    let expected =
        ["cn-gb-50180-dwelling", "de-din-5034-1", "eu-en-17037-sunlight", "pl-wt-60", "ru-sanpin-1-2-3685-21"];
    assert_eq!(with_rooms, expected);
    let Some(DwellingShare::Rooms(lines)) = sample("ru-sanpin-1-2-3685-21").dwelling else { panic!("no rooms") };
    assert_eq!([1, 3, 4, 9].map(|rooms| DwellingShare::rooms_of(&lines, rooms)), [1, 1, 2, 2]);
}

/// A rule with any values that its options can have.
fn sample(id: &str) -> gnomon::rules::ResolvedRule {
    let given: &[(&str, &str)] = match id {
        "au-nsw-adg-4a1" => &[("hours", "2h")],
        "ca-montreal" => &[("space", "park")],
        "cn-gb-50180-dwelling" => &[("day", "great-cold"), ("hours", "2h")],
        "eu-en-17037-sunlight" => &[("above", "10")],
        "jp-bsa-56-2" => &[("plane", "1.5"), ("near", "3h"), ("far", "2h")],
        "kr-court-tolerance" | "pl-wt-60" => &[("clock", "legal")],
        "ru-sanpin-1-2-3685-21" => &[("latitude", "central"), ("edge", "1h"), ("gap", "10min")],
        _ => &[],
    };
    rule(id, given)
}

#[test]
fn each_rule_has_days_and_windows() {
    for (id, _) in BUILT_IN {
        let days = calendar(&sample(id));
        assert!(!days.is_empty(), "{id}");
        for day in days {
            assert!(
                !day.windows.is_empty() && day.windows.iter().all(|window| window.secs() > 3600),
                "{id} {}",
                day.date
            );
        }
    }
}

/// Every rule has a page that names its options, what is taken for granted, and what its numbers rest on.
#[test]
fn each_rule_has_its_page() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/rules");
    let list = std::fs::read_to_string(folder.join("README.md")).expect("docs/rules/README.md");
    for rule in built_in_rules().expect("rules") {
        let id = &rule.source.id;
        let page =
            std::fs::read_to_string(folder.join(format!("{id}.md"))).unwrap_or_else(|_| panic!("no page of {id}"));
        assert!(list.contains(&format!("({id}.md)")), "{id} is not in the list");
        for heading in ["## What is judged", "## What is assumed", "## What could not be read"] {
            assert!(page.contains(heading), "{id}: {heading}");
        }
        for option in &rule.options {
            assert!(page.contains(&format!("`{}`", option.name)), "{id}: {}", option.name);
        }
        assert!(page.contains(&rule.source.edition), "{id}: edition");
        assert!(page.contains("heck with your authority"), "{id}");
        assert!(page.contains(&format!("**{}**", rule.source.confidence)), "{id}: mark");
    }
    let pages = std::fs::read_dir(&folder).expect("pages").count();
    assert_eq!(pages, BUILT_IN.len() + 1, "pages of rules that are not built in");
}

/// The page on how a rule is written has each key in the paragraph of its table.
#[test]
fn each_key_is_explained() {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/rules/README.md");
    let page = std::fs::read_to_string(page).expect("docs/rules/README.md");
    for (table, keys) in RULE_KEYS {
        let paragraph = page.lines().find(|line| line.starts_with(&format!("- `{table}`")));
        let paragraph = paragraph.unwrap_or_else(|| panic!("{table} is not explained"));
        for key in *keys {
            assert!(paragraph.contains(&format!("`{key}`")), "{table}: `{key}` is not explained");
        }
    }
}

#[test]
fn each_file_of_the_folder_is_built_in() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("rules");
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).expect("rules") {
        let path = entry.expect("an entry").path();
        let stem = path.file_stem().expect("a name").to_string_lossy().into_owned();
        let text = std::fs::read_to_string(&path).expect("a rule");
        assert_eq!(Rule::parse(&stem, &text).expect("a rule").source.id, stem);
        found.push(stem);
    }
    found.sort();
    let ids: Vec<_> = BUILT_IN.iter().map(|(id, _)| (*id).to_owned()).collect();
    assert_eq!(found, ids);
}
