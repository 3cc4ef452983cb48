//! The JSON of a judgement.

use super::super::ExportError;
use super::super::report::{self, GroundReport, PlaceReport, ground_report, place_report, stamp, tz_version};
use super::numbers::{
    CHECK, blocker, component_name, date_of, deciding, no_sun_left_limit, number, secs_of, share_of, time,
    worst_counted,
};
use super::rule_report::{RuleReport, SettledReport, rule_report, settled_report};
use crate::judgement::{ERROR_ODDS, GroupRuling, Judgement, LitSpell, ReceiverRuling, ReceiverSpells, Taker};
use crate::message::{Message, Words};
use crate::rules::{Finding, Quantity, Ruling, Spell};
use crate::site::{JudgedSite, JudgedState};
use crate::sun::Place;
use serde::Serialize;

#[derive(Serialize)]
struct JudgementReport<'a> {
    gnomon: &'static str,
    place: PlaceReport<'a>,
    tz_version: String,
    #[serde(flatten)]
    ground: GroundReport,
    ground_before: Option<f64>,
    refraction: bool,
    year: i32,
    rule: RuleReport<'a>,
    check_with_your_authority: &'static str,
    #[serde(flatten)]
    settled: SettledReport<'a>,
    verdict: String,
    grade: Option<&'a str>,
    days: Vec<RuleDayReport>,
    receivers: Vec<ReceiverReport<'a>>,
    groups: Vec<GroupReport<'a>>,
    notes: Vec<String>,
}

#[derive(Serialize)]
struct RuleDayReport {
    date: String,
    verdict: String,
    windows: Vec<SpellReport>,
    criteria_windows: Vec<Option<Vec<SpellReport>>>,
}

#[derive(Serialize)]
struct SpellReport {
    start: String,
    end: String,
    seconds: i64,
}

#[derive(Serialize)]
struct LitSpellReport {
    start: String,
    end: String,
    seconds: i64,
    before: String,
    after: String,
}

#[derive(Serialize)]
struct ReceiverReport<'a> {
    name: &'a str,
    kind: String,
    room: Option<&'a str>,
    dwelling: Option<&'a str>,
    #[serde(rename = "use")]
    usage: Option<&'a str>,
    verdict: String,
    grade: Option<&'a str>,
    value_secs: Option<i64>,
    limit_secs: Option<i64>,
    margin_secs: Option<i64>,
    longest_secs: Option<i64>,
    before_secs: Option<i64>,
    difference_secs: Option<i64>,
    area_m2: Option<f64>,
    narrow_m2: Option<f64>,
    /// The error of area times time.
    error_m2_secs: Option<f64>,
    /// The greatest distance between points where new shadow is looked for.
    points_apart_m: Option<f64>,
    area_points: Option<usize>,
    share: Option<f64>,
    share_limit: Option<f64>,
    share_margin: Option<f64>,
    share_before: Option<f64>,
    share_difference: Option<f64>,
    share_error: Option<f64>,
    share_error_odds: Option<f64>,
    excuse: Option<String>,
    worst: WorstReport,
    points: Vec<[f64; 3]>,
    normal: Option<[f64; 3]>,
    seconds_by_day: Vec<i64>,
    seconds_before_by_day: Option<Vec<i64>>,
    findings: Vec<FindingReport<'a>>,
    spells: Vec<LitSpellReport>,
    spells_before: Option<Vec<LitSpellReport>>,
    open: Vec<SpellReport>,
    newly_shaded: Option<Vec<SpellReport>>,
    takes: Vec<TakerReport>,
}

#[derive(Serialize)]
struct WorstReport {
    date: Option<String>,
    point: Option<[f64; 3]>,
}

#[derive(Serialize)]
struct FindingReport<'a> {
    date: Option<String>,
    criterion: usize,
    grade: Option<&'a str>,
    verdict: String,
    unit: &'static str,
    value: f64,
    longest_secs: Option<i64>,
    before: Option<f64>,
    limit: Option<f64>,
    margin: Option<f64>,
    excuse: Option<String>,
    no_sun_left_secs: Option<i64>,
    /// The time from which the loss of all sun is significant by the rule, and whether it is.
    no_sun_left_limit_secs: Option<i64>,
    significant: Option<bool>,
}

#[derive(Serialize)]
struct TakerReport {
    component: String,
    secs: f64,
    with_others_secs: f64,
}

#[derive(Serialize)]
struct GroupReport<'a> {
    name: &'a str,
    kind: String,
    dwelling: Option<&'a str>,
    verdict: String,
    grade: Option<&'a str>,
    value: Option<f64>,
    limit: Option<f64>,
    unit: Option<&'static str>,
    findings: Vec<FindingReport<'a>>,
    of: &'a [String],
    uses: Vec<UseReport<'a>>,
}

#[derive(Serialize)]
struct UseReport<'a> {
    #[serde(rename = "use")]
    usage: &'a str,
    seconds: i64,
}

/// The most days for which all findings are reported; if there are more, only the deciding one is.
const MOST_TOLD: usize = 8;

/// The JSON of `gnomon judge`: `gnomon`, `place`, `tz_version`, the ground and `refraction` as in `profile.json`, the `year`,
/// then
///
/// - the `rule` with its `edition`, `sources`, `confidence` and what it `assumes`, the `options` as they are chosen, the
///   `clock`, the `sun` that counts, how it is `counted`, what it is compared with, and the `criteria`, numbered from 1;
/// - the `verdict` of the whole (`pass`, `fail`, `close`, `report`) and its `grade`;
/// - `days`, each with its date, its verdict over all receivers, and the counted `windows`, with those of each criterion
///   (null if it is bound to other days);
/// - `receivers`: the deciding number with its limit, its margin (negative if it is missed), the number before and the
///   difference, in seconds or, for areas, as a share of the area with the error `share_error`, which is exceeded with a
///   probability of at most `share_error_odds`; the `worst` day and point;
///   what is counted on each day (`seconds_by_day`, in the order of `days`); the `findings` of each criterion on each day
///   (only the deciding one if there are more than 8 days); the spells of the same days at the point, also in the state
///   before (`start` is the first second in the sun, `end` the first after it; `before` and `after` say what blocks);
///   `open`, when a sun that counts would shine with nothing in its way; and, if it does not pass, `takes`: the seconds of
///   the deciding day that each component takes alone (`secs`) and together with others, for an area as the mean over
///   points that do not keep the demand;
///   of an area its size (`area_m2`), without what is too narrow to count (`narrow_m2`);
/// - `groups`: rooms, dwellings and the house;
/// - `notes` as in `profile.json`, with those on how it was judged.
///
/// # Errors
/// [`ExportError::Encode`] if the encoder fails.
pub fn json(
    judgement: &Judgement,
    site: &JudgedSite,
    (notes, words): (&[Message], &dyn Words),
) -> Result<String, ExportError> {
    let day = |(at, day): (usize, &crate::rules::RuleDay)| RuleDayReport {
        date: day.date.to_string(),
        verdict: judgement.day_verdicts[at].to_string(),
        windows: spells(&day.windows, &site.place),
        criteria_windows: day
            .criteria
            .iter()
            .map(|windows| windows.as_ref().map(|windows| spells(windows, &site.place)))
            .collect(),
    };
    report::json(&JudgementReport {
        gnomon: env!("CARGO_PKG_VERSION"),
        place: place_report(&site.place),
        tz_version: tz_version(&site.place),
        ground: ground_report(&site.now.ground),
        ground_before: site.before.as_ref().map(|before| before.ground.level),
        refraction: site.refraction,
        year: site.year,
        rule: rule_report(&judgement.source),
        check_with_your_authority: CHECK,
        settled: settled_report(&judgement.rule),
        verdict: judgement.verdict.to_string(),
        grade: judgement.grade.as_deref(),
        days: judgement.days.iter().enumerate().map(day).collect(),
        receivers: judgement.receivers.iter().map(|receiver| receiver_report(judgement, site, receiver)).collect(),
        groups: judgement.groups.iter().map(|group| group_report(judgement, group)).collect(),
        notes: report::said(notes, words),
    })
}

fn spells(spells: &[Spell], place: &Place) -> Vec<SpellReport> {
    let of = |spell: &Spell| SpellReport {
        start: stamp(&time(place, spell.start)),
        end: stamp(&time(place, spell.end)),
        seconds: spell.secs(),
    };
    spells.iter().map(of).collect()
}

fn lit(spells: &[LitSpell], place: &Place, state: &JudgedState) -> Vec<LitSpellReport> {
    let of = |lit: &LitSpell| LitSpellReport {
        start: stamp(&time(place, lit.spell.start)),
        end: stamp(&time(place, lit.spell.end)),
        seconds: lit.spell.secs(),
        before: blocker(state, lit.before),
        after: blocker(state, lit.after),
    };
    spells.iter().map(of).collect()
}

fn worst(judgement: &Judgement, of: &ReceiverRuling) -> WorstReport {
    WorstReport {
        date: date_of(judgement, of).map(|date| date.to_string()),
        point: of.points.first().map(|point| point.to_array()),
    }
}

fn receiver_report<'a>(judgement: &'a Judgement, site: &JudgedSite, of: &'a ReceiverRuling) -> ReceiverReport<'a> {
    let finding = deciding(&of.ruling);
    let value = finding.map(|finding| finding.value);
    let (before, limit) = (finding.and_then(|finding| finding.before), finding.and_then(|finding| finding.limit));
    let m2 = of.area.map(|area| area.m2);
    let share = |quantity: Option<Quantity>| m2.and_then(|m2| share_of(quantity, m2));
    let counted = || worst_counted(judgement, of).filter(|_| finding.is_none()).map(|(_, secs)| secs);
    let value_secs = secs_of(value).or_else(counted);
    let is_secs = secs_of(value).is_some();
    let margin = finding.and_then(|finding| finding.margin);
    let has_before = of.counts.iter().all(|count| count.before_secs.is_some()) && !of.counts.is_empty();
    let each = |told: &dyn Fn(&ReceiverSpells) -> Vec<SpellReport>| of.spells.iter().flat_map(told).collect();
    let all_before = of.spells.iter().map(|spells| spells.before.as_ref()).collect::<Option<Vec<_>>>();
    let all_new = of.spells.iter().map(|spells| spells.newly_shaded.as_ref()).collect::<Option<Vec<_>>>();
    ReceiverReport {
        name: &of.name,
        kind: of.kind.to_string(),
        room: of.room.as_deref(),
        dwelling: of.dwelling.as_deref(),
        usage: of.usage.as_deref(),
        verdict: of.ruling.verdict.to_string(),
        grade: of.ruling.grade.as_deref(),
        value_secs,
        limit_secs: secs_of(limit),
        margin_secs: margin.filter(|_| is_secs).map(|margin| margin as i64),
        longest_secs: finding.and_then(|finding| finding.longest_secs),
        before_secs: secs_of(before),
        difference_secs: secs_of(value).zip(secs_of(before)).map(|(now, before)| now - before),
        area_m2: m2,
        narrow_m2: of.area.map(|area| area.narrow_m2),
        error_m2_secs: of.area.and_then(|area| area.error_m2_secs),
        points_apart_m: of.area.and_then(|area| area.apart_m),
        area_points: of.area.map(|area| area.points),
        share: share(value),
        share_limit: share(limit),
        share_margin: margin.filter(|_| share(value).is_some()).zip(m2).map(|(margin, m2)| margin / m2),
        share_before: share(before),
        share_difference: share(value).zip(share(before)).map(|(now, before)| now - before),
        share_error: of.area.filter(|_| share(value).is_some()).map(|area| area.error_m2 / area.m2),
        share_error_odds: of.area.filter(|_| share(value).is_some()).map(|_| ERROR_ODDS),
        excuse: finding.and_then(|finding| finding.excuse).map(super::numbers::excuse),
        worst: worst(judgement, of),
        points: of.points.iter().map(|point| point.to_array()).collect(),
        normal: of.normal.map(|normal| normal.to_array()),
        seconds_by_day: of.counts.iter().map(|count| count.now_secs).collect(),
        seconds_before_by_day: has_before.then(|| of.counts.iter().filter_map(|count| count.before_secs).collect()),
        findings: findings(judgement, &of.ruling),
        spells: of.spells.iter().flat_map(|spells| lit(&spells.now, &site.place, &site.now)).collect(),
        spells_before: all_before
            .zip(site.before.as_ref())
            .map(|(before, state)| before.into_iter().flat_map(|spells| lit(spells, &site.place, state)).collect()),
        open: each(&|told| spells(&told.open, &site.place)),
        newly_shaded: all_new
            .filter(|all| !all.is_empty())
            .map(|new| new.into_iter().flat_map(|new| spells(new, &site.place)).collect()),
        takes: of.takers.iter().map(|taker| taker_report(site, taker)).collect(),
    }
}

fn taker_report(site: &JudgedSite, taker: &Taker) -> TakerReport {
    TakerReport {
        component: component_name(&site.now, taker.component),
        secs: taker.alone_secs,
        with_others_secs: taker.with_others_secs,
    }
}

fn findings<'a>(judgement: &'a Judgement, ruling: &'a Ruling) -> Vec<FindingReport<'a>> {
    let of = |finding: &'a Finding| {
        let (value, unit) = number(finding.value);
        FindingReport {
            date: finding.date.map(|date| date.to_string()),
            criterion: finding.criterion + 1,
            grade: judgement.rule.criteria.get(finding.criterion).and_then(|criterion| criterion.grade.as_deref()),
            verdict: finding.verdict.to_string(),
            unit,
            value,
            longest_secs: finding.longest_secs,
            before: finding.before.map(|before| number(before).0),
            limit: finding.limit.map(|limit| number(limit).0),
            margin: finding.margin,
            excuse: finding.excuse.map(super::numbers::excuse),
            no_sun_left_secs: finding.no_sun_left_secs,
            no_sun_left_limit_secs: no_sun_left_limit(judgement, finding),
            significant: finding
                .no_sun_left_secs
                .zip(no_sun_left_limit(judgement, finding))
                .map(|(secs, limit)| secs >= limit),
        }
    };
    match judgement.days.len() <= MOST_TOLD {
        true => ruling.findings.iter().map(of).collect(),
        false => deciding(ruling).into_iter().map(of).collect(),
    }
}

fn group_report<'a>(judgement: &'a Judgement, of: &'a GroupRuling) -> GroupReport<'a> {
    let by_rooms = of.by_rooms.as_ref().map(|by| (by.value, Some(by.limit)));
    let by_ruling = || of.ruling.as_ref().and_then(deciding).map(|finding| (finding.value, finding.limit));
    let numbers = by_rooms.or_else(by_ruling);
    GroupReport {
        name: &of.name,
        kind: of.kind.to_string(),
        dwelling: of.dwelling.as_deref(),
        verdict: of.verdict.to_string(),
        grade: of.ruling.as_ref().and_then(|ruling| ruling.grade.as_deref()),
        value: numbers.map(|(value, _)| number(value).0),
        limit: numbers.and_then(|(_, limit)| limit).map(|limit| number(limit).0),
        unit: numbers.map(|(value, _)| number(value).1),
        findings: of.ruling.as_ref().map(|ruling| findings(judgement, ruling)).unwrap_or_default(),
        of: &of.of,
        uses: of.uses.iter().map(|(usage, seconds)| UseReport { usage, seconds: *seconds }).collect(),
    }
}
