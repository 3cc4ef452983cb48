//! Judging dwellings by their rooms, and houses by their dwellings.

use super::rule;
use gnomon::rules::{DwellingSun, Quantity, ResolvedRule, RoomRuling, Rule, Verdict, built_in_text};

fn rooms(verdicts: &[Verdict]) -> Vec<RoomRuling> {
    verdicts.iter().map(|verdict| RoomRuling { verdict: *verdict, floor_m2: 10.0 }).collect()
}

#[test]
fn one_room_of_a_dwelling_or_two_of_four() {
    use Verdict::{Close, Fail, Pass};
    let verdict = |rule: &ResolvedRule, of: &[Verdict]| {
        rule.judge_dwelling(&rooms(of)).expect("a ruling").expect("rooms").verdict
    };
    let poland = rule("pl-wt-60", &[("clock", "legal")]);
    assert_eq!(verdict(&poland, &[Fail, Fail, Pass]), Pass);
    assert_eq!(verdict(&poland, &[Fail, Close]), Close);
    assert_eq!(verdict(&poland, &[Fail, Fail]), Fail);
    let russia = rule("ru-sanpin-1-2-3685-21", &[("latitude", "central"), ("edge", "1h"), ("gap", "10min")]);
    assert_eq!(verdict(&russia, &[Pass, Fail, Fail]), Pass);
    assert_eq!(verdict(&russia, &[Pass, Fail, Fail, Fail]), Fail);
    assert_eq!(verdict(&russia, &[Pass, Pass, Fail, Fail]), Pass);
    assert_eq!(verdict(&russia, &[Pass, Close, Fail, Fail, Fail]), Close);
    assert!(poland.judge_dwelling(&[]).is_err());
    let korea = rule("kr-court-tolerance", &[("clock", "legal")]);
    assert_eq!(korea.judge_dwelling(&rooms(&[Pass])), Ok(None));
}

#[test]
fn a_third_of_the_floor_area() {
    let text = built_in_text("pl-wt-60").expect("a rule").replace("rooms = 1", "floor_area = 0.5");
    let rule = Rule::parse("floor", &text).expect("a rule").resolve(&[("clock", "legal")]).expect("options");
    let of = |lit: f64, dark: f64| {
        let room = |verdict, floor_m2| RoomRuling { verdict, floor_m2 };
        rule.judge_dwelling(&[room(Verdict::Pass, lit), room(Verdict::Fail, dark)])
    };
    let verdict = |lit, dark| of(lit, dark).expect("a ruling").expect("rooms").verdict;
    assert_eq!(verdict(20.0, 20.0), Verdict::Pass);
    assert_eq!(verdict(19.9, 20.0), Verdict::Fail);
    assert_eq!(of(30.0, 10.0).expect("a ruling").expect("rooms").value, Quantity::Share(0.75));
    assert!(of(0.0, 20.0).is_err_and(|error| error.to_string().contains("floor area")));
    assert!(of(f64::NAN, 20.0).is_err());
}

/// Apartments: how many have sun in both uses, how many in one; the rest have none.
fn house(both: usize, one: usize, none: usize) -> Vec<Vec<DwellingSun>> {
    let dwelling = |living, open| DwellingSun {
        name: "apartment".to_owned(),
        uses: vec![("living".to_owned(), living), ("open-space".to_owned(), open)],
    };
    let mut dwellings = vec![dwelling(7200, 9000); both];
    dwellings.extend(vec![dwelling(7199, 7200); one]);
    dwellings.extend(vec![dwelling(0, 0); none]);
    vec![dwellings; 2]
}

#[test]
fn seventy_percent_of_the_apartments() {
    let sydney = rule("au-nsw-adg-4a1", &[("hours", "2h")]);
    let verdict = |both, one, none| sydney.judge_house(&house(both, one, none)).expect("a ruling").verdict;
    assert_eq!(verdict(70, 30, 0), Verdict::Pass);
    assert_eq!(verdict(69, 31, 0), Verdict::Fail);
    assert_eq!(verdict(7, 3, 0), Verdict::Pass);
    assert_eq!(verdict(85, 0, 15), Verdict::Pass);
    assert_eq!(verdict(84, 0, 16), Verdict::Fail);
    assert_eq!(verdict(17, 0, 3), Verdict::Pass);
    let ruling = sydney.judge_house(&house(69, 31, 0)).expect("a ruling");
    let finding = &ruling.findings[ruling.deciding.expect("one")];
    assert_eq!((finding.value, finding.limit), (Quantity::Share(0.69), Some(Quantity::Share(0.7))));
}

#[test]
fn an_apartment_without_sun_is_one_of_two_things() {
    let half_dark = vec![
        vec![
            DwellingSun {
                name: "1".to_owned(),
                uses: vec![("living".to_owned(), 0), ("open-space".to_owned(), 9000)]
            };
            4
        ];
        2
    ];
    let share = |sunless| {
        let rule = rule("au-nsw-adg-4a1", &[("hours", "2h"), ("sunless", sunless)]);
        rule.judge_house(&half_dark).expect("a ruling").findings[1].value
    };
    assert_eq!(share("one"), Quantity::Share(1.0));
    assert_eq!(share("all"), Quantity::Share(0.0));
}

#[test]
fn a_use_that_is_not_there_is_asked_for() {
    let sydney = rule("au-nsw-adg-4a1", &[("hours", "3h")]);
    let without = vec![vec![DwellingSun { name: "unit 7".to_owned(), uses: vec![("living".to_owned(), 9000)] }]; 2];
    let error = sydney.judge_house(&without).expect_err("no open space").to_string();
    assert!(error.contains("open-space in unit 7"), "{error}");
    assert!(sydney.judge_house(&[]).is_err());
}
