//! The numbers that decide, as they are printed.

use crate::judgement::{Judgement, ReceiverRuling, SpellBound};
use crate::rules::{CountedTime, Demand, Excuse, Finding, Quantity, Ruling};
use crate::site::JudgedState;
use crate::sun::{Place, Zone};
use chrono::{DateTime, NaiveDate, TimeZone};

/// The sentence that stands beside every verdict.
pub const CHECK: &str = "Nothing here is legal advice: check with your authority which rule, edition and values hold.";

/// Why a number that misses its limit is accepted all the same.
pub(super) fn excuse(why: Excuse) -> String {
    match why {
        Excuse::Ratio => "enough of what was before".to_owned(),
        Excuse::NoWorse => "no worse than before".to_owned(),
        Excuse::Reference => "no worse than a lawful body".to_owned(),
    }
}

/// The finding that decides.
pub(super) fn deciding(ruling: &Ruling) -> Option<&Finding> {
    ruling.deciding.and_then(|at| ruling.findings.get(at))
}

/// A number and its unit, as in JSON and CSV.
pub(super) fn number(quantity: Quantity) -> (f64, &'static str) {
    match quantity {
        Quantity::Secs(secs) => (secs as f64, "s"),
        Quantity::Share(share) => (share, "share"),
        Quantity::AreaM2(m2) => (m2, "m2"),
        Quantity::AreaTime(m2_secs) => (m2_secs, "m2 s"),
        Quantity::Count(count) => (count as f64, "count"),
    }
}

/// A number of seconds.
pub(super) fn secs_of(quantity: Option<Quantity>) -> Option<i64> {
    quantity.and_then(|quantity| if let Quantity::Secs(secs) = quantity { Some(secs) } else { None })
}

/// The share of an area that a number of square metres is.
pub(super) fn share_of(quantity: Option<Quantity>, m2: f64) -> Option<f64> {
    quantity.and_then(|quantity| if let Quantity::AreaM2(part) = quantity { Some(part / m2) } else { None })
}

/// The seconds that are reported for a receiver if no finding has any: those of the day with the least sun, or with the
/// most shadow if that is counted.
pub(super) fn worst_counted(judgement: &Judgement, receiver: &ReceiverRuling) -> Option<(usize, i64)> {
    let of_sun = judgement.rule.counting.what == CountedTime::Sun;
    let counted = receiver.counts.iter().map(|count| count.now_secs).enumerate();
    counted.min_by_key(|(_, secs)| if of_sun { *secs } else { -*secs })
}

/// The day that decides; if none does, the worst one.
pub(super) fn date_of(judgement: &Judgement, receiver: &ReceiverRuling) -> Option<NaiveDate> {
    let of_finding = deciding(&receiver.ruling).and_then(|finding| finding.date);
    of_finding.or_else(|| worst_counted(judgement, receiver).map(|(day, _)| judgement.days[day].date))
}

/// The time from which the loss of all sun is significant, by the finding's criterion.
pub(super) fn no_sun_left_limit(judgement: &Judgement, finding: &Finding) -> Option<i64> {
    let criterion = judgement.rule.criteria.get(finding.criterion)?;
    if let Demand::Report { no_sun_left_secs } = criterion.demand { no_sun_left_secs } else { None }
}

/// The local time at a second since 1970.
pub(super) fn time(place: &Place, secs: i64) -> DateTime<Zone> {
    // spells are within the years that chrono supports
    let utc = DateTime::from_timestamp(secs, 0).unwrap_or_default().naive_utc();
    place.time_zone.from_utc_datetime(&utc)
}

/// What blocks the sun, as a word or as the component's name. A component whose name is one of the words gets a
/// distinct name.
pub(super) fn blocker(state: &JudgedState, bound: SpellBound) -> String {
    match bound {
        SpellBound::Window => "window".to_owned(),
        SpellBound::Horizon => "horizon".to_owned(),
        SpellBound::Behind => "behind".to_owned(),
        SpellBound::Cut => "cut".to_owned(),
        SpellBound::Reveal => "reveal".to_owned(),
        SpellBound::Ground => "ground".to_owned(),
        SpellBound::Component(component) => component_name(state, component),
    }
}

/// A component's name.
pub(super) fn component_name(state: &JudgedState, component: u32) -> String {
    match state.mesh.components.get(component as usize).map_or("", |component| component.name.as_str()) {
        word @ ("window" | "horizon" | "behind" | "cut" | "reveal" | "ground") => format!("{word} (component)"),
        name => name.to_owned(),
    }
}
