//! What a rule needs and a site does not say, all of it in one error.

use super::{area, nothing, site, tried, window};
use glam::{DVec3, dvec3};
use gnomon::rules::{Rule, built_in_text};
use gnomon::site::{JudgedPlot, JudgedSite, PlotSide};
use gnomon::study::StudyError;

fn lacks(site: &JudgedSite, id: &str, options: &[(&str, &str)], words: &[&str]) {
    let error = tried(site, id, options).expect_err(id);
    assert!(matches!(error, StudyError::Rule(_)), "{error}");
    let text = error.to_string();
    for word in words {
        assert!(text.contains(word), "{id}: {text:?} does not say {word:?}");
    }
}

#[test]
fn all_of_it_is_one_error() {
    let mut asked = site(super::london(), vec![nothing()], None);
    lacks(&asked, "uk-bre-209-sun-on-ground", &[], &["an area", "the state before"]);
    lacks(&asked, "nl-the-hague", &[], &["a façade; add [[facade]] to the site file"]);
    let japan = [("plane", "4"), ("near", "3h"), ("far", "2h")];
    lacks(&asked, "jp-bsa-56-2", &japan, &["the plot; add [plot] to the site file"]);
    lacks(&asked, "eu-en-17037-sunlight", &[("above", "DE")], &["a window; add [[window]] to the site file"]);
    asked.windows =
        vec![window("one", dvec3(0.0, 0.0, 1.0), DVec3::NEG_Y), window("two", dvec3(5.0, 0.0, 1.0), DVec3::NEG_Y)];
    asked.windows[1].floor = Some(0.0);
    let all = [
        "the room of window \"one\", \"two\"",
        "the dwelling of",
        "height of the floor",
        "inner plane",
        "`floor` under [[window]]",
        " and `room` under [[window]] to the site file",
    ];
    lacks(&asked, "eu-en-17037-sunlight", &[("above", "DE")], &all);
    asked.areas = vec![area("court", [0.0, 0.0], [9.0, 9.0])];
    lacks(&asked, "au-vic-b21", &[], &["the state before"]);
    let border = vec![super::corner(0.0, 0.0), super::corner(9.0, 0.0), super::corner(9.0, 9.0)];
    asked.plot = Some(JudgedPlot { border, sides: vec![PlotSide::default(); 3], mean_ground: None });
    lacks(
        &asked,
        "jp-bsa-56-2",
        &japan,
        &["mean level of the ground", "; add `mean_ground` under [plot] to the site file"],
    );
}

#[test]
fn the_keys_that_would_say_it_are_named_once() {
    let mut asked = site(super::london(), vec![nothing()], None);
    let text = tried(&asked, "us-sf-295", &[]).expect_err("no area").to_string();
    let both = "an area; the state before, with which it compares; add [[area]] and [before] to the site file";
    assert_eq!(text, format!("rule us-sf-295 needs {both}"));
    // no key would make a strip wider
    asked.areas = vec![area("strip", [0.0, 0.0], [9.0, 1.0])];
    asked.before = Some(super::state(vec![nothing()]));
    let error = tried(&asked, "au-vic-b21", &[]).expect_err("too narrow");
    assert!(
        error.to_string().contains("at least 3 m wide in area \"strip\"") && !error.to_string().contains("add "),
        "{error}"
    );
}

#[test]
fn a_dwelling_without_one_of_its_uses_is_none_that_passes() {
    let mut asked = site(super::london(), vec![nothing()], None);
    let mut own = window("one", dvec3(0.0, 0.0, 1.0), DVec3::NEG_Y);
    (own.dwelling, own.usage) = (Some("unit 1".into()), Some("living".into()));
    asked.windows = vec![own];
    lacks(&asked, "au-nsw-adg-4a1", &[("hours", "2h")], &["open-space", "unit 1"]);
}

#[test]
fn a_listener_can_end_it() {
    let mut asked = site(super::london(), vec![nothing()], Some(vec![nothing()]));
    asked.areas = vec![area("court", [0.0, 0.0], [9.0, 9.0])];
    let id = "uk-bre-209-sun-on-ground";
    let rule = gnomon::rules::Rule::parse(id, gnomon::rules::built_in_text(id).expect("built in")).expect("a rule");
    let resolved = rule.resolve(&[]).expect("options");
    let ended = gnomon::study::judge::judge(&asked, &rule.source, &resolved, &mut |_| std::ops::ControlFlow::Break(()));
    assert!(matches!(ended, Err(StudyError::Interrupted)));
}

#[test]
fn an_option_that_nobody_chose_and_what_the_site_lacks_are_one_error() {
    let rule = Rule::parse("jp-bsa-56-2", built_in_text("jp-bsa-56-2").expect("built in")).expect("a rule");
    let mut asked = site(super::london(), vec![nothing()], None);
    let error = |asked: &JudgedSite, given: &[(&str, &str)]| {
        let error = rule.resolve(given).expect_err("options are not chosen");
        StudyError::from(gnomon::study::judge::with_needs(error, &rule, given, asked)).to_string()
    };
    let all = error(&asked, &[("near", "3h")]);
    for word in ["`plane`", "`far`", "it also needs the plot", "add [plot] to the site file"] {
        assert!(all.contains(word), "{all}");
    }
    assert!(!all.contains("`near`"), "{all}");
    let border = vec![super::corner(0.0, 0.0), super::corner(9.0, 0.0), super::corner(9.0, 9.0)];
    asked.plot = Some(JudgedPlot { border, sides: vec![PlotSide::default(); 3], mean_ground: Some(0.0) });
    let options = error(&asked, &[]);
    assert!(options.contains("`plane`") && !options.contains("also needs"), "{options}");
}
