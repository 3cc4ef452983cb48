//! The steps of a judgement, in their order.

use super::super::{OnEvent, StudyError, note_models};
use super::days::{JudgedDays, hulls};
use super::groups::{WindowRulings, groups, of_groups};
use super::judging::{RuleOnSite, Steps};
use super::needs;
use super::on_plot::casting_on_plot;
use super::receivers::{JudgedReceivers, found};
use super::whole::{day_verdicts, grade, notes, with_takers};
use crate::judgement::Judgement;
use crate::rules::{CompareWith, ResolvedRule, RuleSource, Ruling, Verdict};
use crate::site::JudgedSite;

/// Judges a site by a rule.
///
/// # Errors
/// [`StudyError`]; [`StudyError::Rule`] with all that the rule needs and the site does not say.
pub fn judge(
    site: &JudgedSite,
    source: &RuleSource,
    rule: &ResolvedRule,
    on_event: &mut OnEvent<'_>,
) -> Result<Judgement, StudyError> {
    note_models(&site.notes, on_event)?;
    needs::check(rule, site)?;
    let on_plot = casting_on_plot(site, rule)?;
    let (site, neighbours) = on_plot.as_ref().map_or((site, &[][..]), |on_plot| (&on_plot.site, &on_plot.left_out[..]));
    let calendar = rule.calendar(&site.place, site.year)?;
    let hulls = hulls(&site.place, &calendar)?;
    let days = JudgedDays::new(site, rule.cuts, &calendar, &hulls)?;
    // no state of a site is a body that the law allows
    let before = site.before.as_ref().filter(|_| rule.compare != Some(CompareWith::Reference));
    let judging = RuleOnSite { site, rule, days: &days, before };
    let Some(first) = hulls.first() else { return Err(StudyError::NoDay) };
    let mut steps = Steps::new(on_event, judging.count(), first.from)?;
    let JudgedReceivers { mut receivers, windows, open_spaces } = found(&judging, &mut steps)?;
    let rulings: Vec<Ruling> = receivers.iter().map(|(receiver, _)| receiver.ruling.clone()).collect();
    let groups = groups(&WindowRulings {
        rule,
        days: &calendar,
        windows: if windows.is_empty() { &[] } else { &site.windows },
        lights: &windows,
        open_spaces: &open_spaces,
        rulings: &rulings,
    })?;
    with_takers(&judging, &hulls, &mut receivers, &mut steps)?;
    let receivers: Vec<_> = receivers.into_iter().map(|(receiver, _)| receiver).collect();
    let all = || Verdict::all(receivers.iter().map(|receiver| receiver.ruling.verdict));
    let verdict = of_groups(&groups).unwrap_or_else(all);
    Ok(Judgement {
        source: source.clone(),
        rule: rule.clone(),
        day_verdicts: day_verdicts(rule, &calendar, &receivers, &groups),
        verdict,
        grade: grade(rule, verdict, &receivers, &groups),
        notes: notes(&judging, &receivers, neighbours),
        receivers,
        groups,
        days: calendar,
    })
}
