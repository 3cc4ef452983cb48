//! How days and criteria are combined to one verdict.

use super::{calendar, hours, lit, lit_in, minutes, rule, spells};
use gnomon::rules::{DayLight, Excuse, Quantity, ResolvedRule, RuleDay, Ruling, Verdict};

/// The ruling over days, each with one spell of sun of the given seconds.
fn ruling_of(rule: &ResolvedRule, days: &[RuleDay], secs: impl Fn(usize) -> i64) -> Ruling {
    let lit: Vec<_> = days.iter().enumerate().map(|(at, day)| spells(day, &[secs(at)])).collect();
    let lights: Vec<_> = days
        .iter()
        .zip(&lit)
        .map(|(day, lit)| DayLight { day, open: &day.windows, lit, before: None, newly_shaded: None })
        .collect();
    rule.judge_time(None, &lights).expect("a ruling")
}

#[test]
fn verdicts_of_many_are_one() {
    use Verdict::{Close, Fail, Pass, Report};
    assert_eq!(Verdict::all([Pass, Close, Pass]), Close);
    assert_eq!(Verdict::all([Pass, Fail, Close]), Fail);
    assert_eq!(Verdict::all([Report, Pass]), Pass);
    assert_eq!(Verdict::any([Fail, Close, Report]), Close);
    assert_eq!(Verdict::any([Fail, Pass]), Pass);
    assert_eq!(Verdict::all([]), Report);
    assert_eq!(Verdict::any([Report, Fail]), Fail);
}

/// Every day must pass; the worst decides, and the others are reported.
#[test]
fn the_worst_day_of_a_range_decides() {
    let light = rule("nl-tno-light", &[]);
    let days = calendar(&light);
    let ruling = |worst: usize, secs: i64| ruling_of(&light, &days, |at| if at == worst { secs } else { hours(5) });
    let fails = ruling(100, hours(2) - 1);
    assert_eq!(fails.verdict, Verdict::Fail);
    assert_eq!(fails.deciding, Some(100));
    let finding = &fails.findings[100];
    assert_eq!((finding.date, finding.margin), (Some(days[100].date), Some(-1.0)));
    assert_eq!((finding.value, finding.limit), (Quantity::Secs(hours(2) - 1), Some(Quantity::Secs(hours(2)))));
    assert_eq!(fails.findings.len(), 245);
    let passes = ruling(7, hours(2));
    assert_eq!((passes.verdict, passes.deciding), (Verdict::Pass, Some(7)));
    assert_eq!(passes.findings[7].margin, Some(0.0));
}

/// One day is enough; the best decides.
#[test]
fn the_best_day_of_a_range_decides() {
    let exposure = rule("eu-en-17037-sunlight", &[("above", "11")]);
    let days = calendar(&exposure);
    let ruling = |best: usize, secs: i64| ruling_of(&exposure, &days, |at| if at == best { secs } else { minutes(20) });
    for (secs, verdict, grade) in [
        (minutes(90) - 1, Verdict::Fail, None),
        (minutes(90), Verdict::Pass, Some("minimum")),
        (hours(3) - 1, Verdict::Pass, Some("minimum")),
        (hours(3), Verdict::Pass, Some("medium")),
        (hours(4) - 1, Verdict::Pass, Some("medium")),
        (hours(4), Verdict::Pass, Some("high")),
    ] {
        let ruling = ruling(30, secs);
        assert_eq!((ruling.verdict, ruling.grade.as_deref()), (verdict, grade), "{secs}");
        let deciding = &ruling.findings[ruling.deciding.expect("one decides")];
        assert_eq!(deciding.date, Some(days[30].date));
    }
}

/// If all days must pass, the grade is that of the worst.
#[test]
fn the_grade_of_several_days_is_the_lowest() {
    let text = gnomon::rules::built_in_text("eu-en-17037-sunlight")
        .expect("a rule")
        .replace("judge = \"best\"", "judge = \"worst\"");
    let rule = gnomon::rules::Rule::parse("every-day", &text).expect("a rule");
    let every = rule.resolve(&[("above", "11")]).expect("options");
    let days = calendar(&every);
    let grade = |odd: i64, others: i64| {
        let ruling = ruling_of(&every, &days, |at| if at == 20 { odd } else { others });
        (ruling.verdict, ruling.grade)
    };
    let named = |grade: &str| (Verdict::Pass, Some(grade.to_owned()));
    assert_eq!(grade(hours(3), hours(5)), named("medium"));
    assert_eq!(grade(hours(5), hours(3)), named("medium"));
    assert_eq!(grade(minutes(90), hours(5)), named("minimum"));
    assert_eq!(grade(minutes(89), hours(5)), (Verdict::Fail, None));
}

/// Days with different limits: those of the equinox are not those of winter.
#[test]
fn criteria_are_of_their_own_days() {
    let din = rule("de-din-5034-1", &[]);
    let days = calendar(&din);
    assert_eq!(days.len(), 2);
    let ruling = |equinox: i64, winter: i64| ruling_of(&din, &days, |at| [equinox, winter][at]);
    assert_eq!(ruling(hours(4), hours(1)).verdict, Verdict::Pass);
    let winter = ruling(hours(4), hours(1) - 1);
    assert_eq!(winter.verdict, Verdict::Fail);
    assert_eq!(winter.findings[winter.deciding.expect("one")].date, Some(days[1].date));
    assert_eq!(ruling(hours(4) - 1, hours(8)).verdict, Verdict::Fail);
    assert_eq!(winter.findings.len(), 2);
}

/// A body that the law allows excuses the same shadow, and not more.
#[test]
fn a_lawful_body_excuses_as_much_shadow() {
    let zurich = rule("ch-zh-abv", &[]);
    // lit for so much of nine hours; the rest is shadow
    let ruling =
        |shadow: i64, reference: Option<i64>| lit(&zurich, hours(9) - shadow, reference.map(|of| hours(9) - of));
    assert_eq!(ruling(hours(3), None).verdict, Verdict::Pass);
    assert_eq!(ruling(hours(3) + 1, None).verdict, Verdict::Fail);
    let excused = ruling(hours(4), Some(hours(4)));
    assert_eq!(excused.verdict, Verdict::Pass);
    assert_eq!(excused.findings[0].excuse, Some(Excuse::Reference));
    assert_eq!(excused.findings[0].margin, Some(-3600.0));
    assert_eq!(ruling(hours(4) + 1, Some(hours(4))).verdict, Verdict::Fail);
}

/// New shadow is reported, and whether it takes all sun for longer than ten minutes.
#[test]
fn a_report_tells_and_does_not_judge() {
    let nyc = rule("us-nyc-ceqr-shadows", &[]);
    let ruling = lit(&nyc, hours(1), Some(hours(3)));
    assert_eq!((ruling.verdict, ruling.findings.len()), (Verdict::Report, 4));
    assert_eq!(ruling.findings[0].value, Quantity::Secs(hours(2)));
    assert_eq!(ruling.findings[0].no_sun_left_secs, Some(hours(2)));
    assert!(nyc.is_report());
    // of an area new shadow lies in a part, while another part is still lit
    let days = calendar(&nyc);
    let lit = spells(&days[0], &[hours(3)]);
    let shaded = spells(&days[0], &[hours(1)]);
    let light =
        DayLight { day: &days[0], open: &days[0].windows, lit: &lit, before: Some(&lit), newly_shaded: Some(&shaded) };
    let part = nyc.judge_time(None, &[light]).expect("a ruling");
    assert_eq!(part.findings[0].value, Quantity::Secs(hours(1)));
    assert_eq!(part.findings[0].no_sun_left_secs, Some(0));
    // without the state before there is no new shadow
    let alone = DayLight { before: None, newly_shaded: None, ..light };
    assert!(nyc.judge_time(None, &[alone]).is_err_and(|error| error.to_string().contains("state before")));
}

/// Neither the night nor the time with the sun behind a façade counts as shadow.
#[test]
fn shadow_is_counted_while_the_sun_would_shine() {
    let zurich = rule("ch-zh-abv", &[]);
    let days = calendar(&zurich);
    let open: Vec<_> = days.iter().map(|day| spells(day, &[hours(5)])).collect();
    let ruling = |lit: i64| {
        let lit: Vec<_> = days.iter().map(|day| spells(day, &[lit])).collect();
        let lights: Vec<_> = days
            .iter()
            .zip(open.iter().zip(&lit))
            .map(|(day, (open, lit))| DayLight { day, open, lit, before: None, newly_shaded: None })
            .collect();
        zurich.judge_time(None, &lights).expect("a ruling")
    };
    assert_eq!(ruling(hours(2)).findings[0].value, Quantity::Secs(hours(3)));
    assert_eq!([ruling(hours(2)).verdict, ruling(hours(2) - 1).verdict], [Verdict::Pass, Verdict::Fail]);
}

#[test]
fn days_that_are_added_up_are_one_number() {
    let text = gnomon::rules::built_in_text("nl-tno-light").expect("a rule");
    let text = text.replace("judge = \"worst\"", "judge = \"sum\"").replace("at_least = \"2h\"", "at_least = \"490h\"");
    let sum = gnomon::rules::Rule::parse("sum", &text).expect("a rule").resolve(&[]).expect("options");
    // 245 days of 2 h
    let ruling = lit(&sum, hours(2), None);
    assert_eq!((ruling.verdict, ruling.findings.len()), (Verdict::Pass, 1));
    assert_eq!((ruling.findings[0].value, ruling.findings[0].date), (Quantity::Secs(hours(490)), None));
    assert_eq!(lit(&sum, hours(2) - 1, None).findings[0].margin, Some(-245.0));
}

/// Of two tests of which one is enough the better decides.
#[test]
fn one_of_two_tests_is_enough() {
    let korea = rule("kr-court-tolerance", &[("clock", "legal")]);
    let days = calendar(&korea);
    let day = &days[0];
    let ruling = |lengths: &[i64]| {
        // from 9 on, so that both windows have them
        let mut start = day.windows[0].start + hours(1);
        let mut lit = Vec::new();
        for secs in lengths {
            lit.push(gnomon::rules::Spell::new(start, start + secs));
            start += secs + 60;
        }
        let light = DayLight { day, open: &day.windows, lit: &lit, before: None, newly_shaded: None };
        korea.judge_time(None, &[light]).expect("a ruling")
    };
    // the published case: 1 h 59 at most on end, and 4 h in all
    let total = ruling(&[minutes(119), minutes(119), minutes(2)]);
    assert_eq!((total.verdict, total.deciding), (Verdict::Pass, Some(1)));
    let longest = ruling(&[hours(2)]);
    assert_eq!((longest.verdict, longest.deciding), (Verdict::Pass, Some(0)));
    assert_eq!(ruling(&[hours(2) - 1, minutes(119)]).verdict, Verdict::Fail);
    // two hours on end before 9 are not in the first test's window
    let early = [gnomon::rules::Spell::new(day.windows[0].start, day.windows[0].start + hours(2))];
    let light = DayLight { day, open: &day.windows, lit: &early, before: None, newly_shaded: None };
    assert_eq!(korea.judge_time(None, &[light]).expect("a ruling").verdict, Verdict::Fail);
}

#[test]
fn a_ratio_and_no_worse_hold_for_points_too() {
    let text = gnomon::rules::built_in_text("au-vic-b21").expect("a rule");
    let of = |demand: &str| {
        let text = text.replace("share = 0.75\nor_area = 40.0\nno_worse_where_before_fails = true", demand);
        gnomon::rules::Rule::parse("point", &text).expect("a rule").resolve(&[]).expect("options")
    };
    let ratio = of("or_ratio = 0.8");
    assert_eq!(lit(&ratio, hours(4), Some(hours(5))).findings[0].excuse, Some(Excuse::Ratio));
    assert_eq!(lit(&ratio, hours(4) - 1, Some(hours(5))).verdict, Verdict::Fail);
    let no_worse = of("no_worse_where_before_fails = true");
    assert_eq!(lit(&no_worse, hours(2), Some(hours(2))).findings[0].excuse, Some(Excuse::NoWorse));
    assert_eq!(lit(&no_worse, hours(2) - 1, Some(hours(2))).verdict, Verdict::Fail);
    assert_eq!(lit(&no_worse, hours(4), Some(hours(5))).verdict, Verdict::Fail);
    assert_eq!(lit_in(&no_worse, &[hours(3), hours(2)], Some(0)).verdict, Verdict::Pass);
}
