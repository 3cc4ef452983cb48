//! The verdicts of a judged site, ready to be shown as a table and on the picture.

use crate::deliver::Sink;
use crate::deliver::judgement::{JudgeAnswer, judgement_names, write_judgement};
use crate::desktop::results::verdict_shapes::VerdictShapes;
use crate::desktop::state::judging::RuleChoice;
use crate::desktop::state::project::Project;
use crate::export::judgement::{group_said, receiver_row, taker_row};
use crate::judgement::{GroupKind, GroupRuling, Judgement, ReceiverRuling};
use crate::rules::{KnownRule, Quantity, Rule, RuleError, Ruling, Verdict};
use crate::site::file::SiteFile;
use crate::site::{JudgedSite, Site};
use std::cmp::Ordering;
use std::path::PathBuf;

/// A judged site.
pub(in crate::desktop) struct JudgedResult {
    /// Grows with every answer.
    pub(in crate::desktop) number: u64,
    pub(in crate::desktop) site: JudgedSite,
    pub(in crate::desktop) answer: JudgeAnswer,
    /// The rule that was asked for, as it was read.
    pub(in crate::desktop) choice: RuleChoice,
    pub(in crate::desktop) rule: Rule,
    /// The site as it was written.
    pub(in crate::desktop) written: SiteFile,
    /// The hash of its models.
    pub(in crate::desktop) mark: u64,
    /// The table.
    pub(in crate::desktop) lines: Vec<JudgedLine>,
    /// The shapes of the receivers.
    pub(in crate::desktop) shapes: VerdictShapes,
}

/// What a line of the table is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::desktop) enum LineOf {
    /// A receiver, by its index.
    Receiver(usize),
    /// A group, by its index.
    Group(usize),
}

/// A line of the table.
#[derive(Clone, Debug)]
pub(in crate::desktop) struct JudgedLine {
    pub(in crate::desktop) of: LineOf,
    pub(in crate::desktop) name: String,
    pub(in crate::desktop) verdict: Verdict,
    pub(in crate::desktop) value: String,
    pub(in crate::desktop) limit: String,
    pub(in crate::desktop) margin: String,
    pub(in crate::desktop) day: String,
    /// Who takes the most sun.
    pub(in crate::desktop) taker: String,
    /// Why the number is accepted though it misses the limit.
    pub(in crate::desktop) excuse: Option<String>,
    /// The margin as a share of the limit.
    slack: f64,
}

/// The columns of the table by which it can be sorted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::desktop) enum SortBy {
    /// What fails goes first.
    #[default]
    Verdict,
    /// By name.
    Name,
    /// By margin, as a share of the limit.
    Margin,
    /// By the deciding day.
    Day,
}

impl JudgedResult {
    pub(in crate::desktop) fn judgement(&self) -> &Judgement {
        &self.answer.judgement
    }

    /// The lines of the table: receivers, then groups.
    pub(in crate::desktop) fn lines_of(site: &JudgedSite, judgement: &Judgement) -> Vec<JudgedLine> {
        let receivers = judgement.receivers.iter().enumerate();
        let groups = judgement.groups.iter().enumerate();
        let of_receivers = receivers.map(|(at, receiver)| receiver_line(site, judgement, (at, receiver)));
        of_receivers.chain(groups.map(group_line)).collect()
    }

    /// The order of the lines.
    pub(in crate::desktop) fn sorted(&self, by: SortBy, is_reversed: bool) -> Vec<usize> {
        let by_margin = |one: &JudgedLine, other: &JudgedLine| one.slack.total_cmp(&other.slack);
        let compare = |one: &usize, other: &usize| {
            let (one, other) = (&self.lines[*one], &self.lines[*other]);
            match by {
                SortBy::Verdict => rank(one.verdict).cmp(&rank(other.verdict)).then_with(|| by_margin(one, other)),
                SortBy::Name => natural(&one.name, &other.name),
                SortBy::Margin => by_margin(one, other),
                SortBy::Day => one.day.cmp(&other.day),
            }
        };
        let mut order: Vec<usize> = (0..self.lines.len()).collect();
        order.sort_by(|one, other| if is_reversed { compare(other, one) } else { compare(one, other) });
        order
    }

    /// How many receivers have each verdict: those that fail, are too close to say, pass, and are only reported.
    pub(in crate::desktop) fn totals(&self) -> String {
        let receivers = &self.judgement().receivers;
        let count = |verdict: Verdict| receivers.iter().filter(|of| of.ruling.verdict == verdict).count();
        let all = receivers.len();
        let words = [
            (Verdict::Fail, "fail"),
            (Verdict::Close, "too close to say"),
            (Verdict::Pass, "pass"),
            (Verdict::Report, "only reported"),
        ];
        let counted = words.into_iter().map(|(verdict, word)| (count(verdict), word)).filter(|(count, _)| *count > 0);
        let counted: Vec<String> = counted.map(|(count, word)| format!("{count} {word}")).collect();
        format!("{all} judged: {}", counted.join(", "))
    }

    /// Whether it still belongs to the scene.
    pub(in crate::desktop) fn lies_on(&self, site: &Site) -> bool {
        let mesh = &self.site.now.mesh;
        mesh.vertices == site.mesh.vertices && mesh.faces == site.mesh.faces && self.site.place == site.place
    }

    /// Whether it is what would be judged now.
    pub(in crate::desktop) fn is_asked(&self, project: &Project, choice: &RuleChoice, known: &[KnownRule]) -> bool {
        let (then, now) = (&self.written, &project.written.site);
        let same_models = then.model == now.model && self.mark == project.models.mark();
        let same_place = then.ground == now.ground && then.place == now.place;
        // only the year of the study counts
        let days = |site: &SiteFile| (site.study.date.clone(), site.study.dates.clone(), site.study.from.clone());
        // a file of that name may have changed
        let is_same = |rule: &Result<Rule, RuleError>| rule.as_ref().is_ok_and(|rule| rule.text == self.rule.text);
        let same_rule = self.choice == *choice && choice.of(known).is_some_and(is_same);
        let same_judged = then.area == now.area
            && then.window == now.window
            && then.facade == now.facade
            && then.plot == now.plot
            && then.before == now.before;
        same_models && same_place && same_judged && days(then) == days(now) && same_rule
    }

    /// The receivers of a line: its own, or those of a group and of the groups in it.
    pub(in crate::desktop) fn receivers_of(&self, line: LineOf) -> Vec<usize> {
        let judgement = self.judgement();
        let at = match line {
            LineOf::Receiver(at) => return vec![at],
            LineOf::Group(at) => at,
        };
        let Some(group) = judgement.groups.get(at) else { return Vec::new() };
        let is_of = |receiver: &ReceiverRuling| match group.kind {
            GroupKind::Room => receiver.room.as_ref() == Some(&group.name) && receiver.dwelling == group.dwelling,
            GroupKind::Dwelling => receiver.dwelling.as_ref() == Some(&group.name),
            GroupKind::House => true,
        };
        judgement.receivers.iter().enumerate().filter(|(_, of)| is_of(of)).map(|(at, _)| at).collect()
    }

    /// The names of its files.
    pub(in crate::desktop) fn names() -> Vec<PathBuf> {
        judgement_names().to_vec()
    }

    /// Writes its files, as JSON and as a table.
    ///
    /// # Errors
    /// Files that cannot be written.
    pub(in crate::desktop) fn write(&self, sink: Sink<'_>) -> anyhow::Result<()> {
        write_judgement(&self.site, &self.answer, sink)?;
        Ok(())
    }
}

/// Failing first.
fn rank(verdict: Verdict) -> u8 {
    match verdict {
        Verdict::Fail => 0,
        Verdict::Close => 1,
        Verdict::Report => 2,
        Verdict::Pass => 3,
    }
}

/// Names in the order of their numbers: "window 2" goes before "window 10".
fn natural(one: &str, other: &str) -> Ordering {
    let parts = |name: &str| {
        let stem = name.trim_end_matches(|c: char| c.is_ascii_digit());
        (stem.to_lowercase(), name[stem.len()..].parse::<u64>().unwrap_or(0), name.to_owned())
    };
    parts(one).cmp(&parts(other))
}

fn receiver_line(site: &JudgedSite, judgement: &Judgement, (at, receiver): (usize, &ReceiverRuling)) -> JudgedLine {
    let row = receiver_row(judgement, receiver);
    JudgedLine {
        of: LineOf::Receiver(at),
        name: row.name,
        verdict: row.verdict,
        value: row.value,
        limit: row.limit,
        margin: row.margin,
        day: row.day,
        taker: receiver.takers.first().map_or_else(String::new, |taker| taker_row(site, taker).name),
        excuse: row.excuse,
        slack: slack(Some(&receiver.ruling)),
    }
}

fn group_line((at, group): (usize, &GroupRuling)) -> JudgedLine {
    let of_dwelling = group.dwelling.as_ref().map_or_else(String::new, |of| format!(" of {of}"));
    JudgedLine {
        of: LineOf::Group(at),
        name: format!("{} {}{of_dwelling}", group.kind, group.name).trim_end().to_owned(),
        verdict: group.verdict,
        value: group_said(group).trim_start_matches(", ").to_owned(),
        limit: String::new(),
        margin: String::new(),
        day: String::new(),
        taker: String::new(),
        excuse: None,
        slack: slack(group.ruling.as_ref()),
    }
}

/// The margin as a share of the limit; what has none goes last.
fn slack(ruling: Option<&Ruling>) -> f64 {
    let finding = ruling.and_then(|ruling| ruling.findings.get(ruling.deciding?));
    let Some((margin, limit)) = finding.and_then(|finding| finding.margin.zip(finding.limit)) else {
        return f64::INFINITY;
    };
    let limit = match limit {
        Quantity::Secs(secs) => secs as f64,
        Quantity::Share(number) | Quantity::AreaM2(number) | Quantity::AreaTime(number) => number,
        Quantity::Count(count) => count as f64,
    };
    if limit > 0.0 { margin / limit } else { margin }
}
