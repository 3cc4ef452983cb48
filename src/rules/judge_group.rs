//! Judges dwellings by their rooms, and buildings by their dwellings.

use super::criterion::{Criterion, Demand, DwellingShare, Extent, SunlessWhen};
use super::error::{RuleError, RuleNeed};
use super::receiver::RuleReceiver;
use super::resolved::ResolvedRule;
use super::verdict::{DayCase, Finding, Quantity, Ruling, Verdict};
use super::weigh::reaches;

/// A room's result.
#[derive(Clone, Debug, PartialEq)]
pub struct RoomRuling {
    /// Its verdict.
    pub verdict: Verdict,
    /// Its floor area, square metres; not used if rooms are counted.
    pub floor_m2: f64,
}

/// A dwelling's result.
#[derive(Clone, Debug, PartialEq)]
pub struct DwellingRuling {
    /// Its verdict.
    pub verdict: Verdict,
    /// The number of rooms, or the share of the floor area, that keeps the criteria.
    pub value: Quantity,
    /// The number or share that must keep them.
    pub limit: Quantity,
}

/// The time in which each use of a dwelling is lit.
#[derive(Clone, Debug, PartialEq)]
pub struct DwellingSun {
    /// The dwelling's name.
    pub name: String,
    /// Each use with its time, seconds, as the criterion counts it.
    pub uses: Vec<(String, i64)>,
}

impl ResolvedRule {
    /// Returns the verdict on a dwelling by its rooms, or `None` if the rule has no criteria for dwellings.
    ///
    /// # Errors
    /// [`RuleError::Needs`] for a dwelling without rooms, or if floor areas count and one is missing.
    pub fn judge_dwelling(&self, rooms: &[RoomRuling]) -> Result<Option<DwellingRuling>, RuleError> {
        let needs = |what: &str, key| RuleError::Needs {
            rule: self.id.clone(),
            needs: vec![RuleNeed::of_key(what, "[[window]]", key)],
        };
        let Some(share) = &self.dwelling else { return Ok(None) };
        if rooms.is_empty() {
            return Err(needs("dwellings with rooms", "room"));
        }
        let passing = |with: &[Verdict]| rooms.iter().filter(|room| with.contains(&room.verdict)).collect::<Vec<_>>();
        let (sure, perhaps) = (passing(&[Verdict::Pass]), passing(&[Verdict::Pass, Verdict::Close]));
        let is_report = rooms.iter().all(|room| room.verdict == Verdict::Report);
        let of = |sure: bool, perhaps: bool| match (is_report, sure, perhaps) {
            (true, ..) => Verdict::Report,
            (_, true, _) => Verdict::Pass,
            (_, false, true) => Verdict::Close,
            (_, false, false) => Verdict::Fail,
        };
        Ok(Some(match share {
            DwellingShare::Rooms(lines) => {
                let needed = DwellingShare::rooms_of(lines, rooms.len());
                DwellingRuling {
                    verdict: of(sure.len() >= needed, perhaps.len() >= needed),
                    value: Quantity::Count(sure.len()),
                    limit: Quantity::Count(needed),
                }
            }
            DwellingShare::FloorArea(least) => {
                let floor: f64 = rooms.iter().map(|room| room.floor_m2).sum();
                let has_all = rooms.iter().all(|room| room.floor_m2.is_finite() && room.floor_m2 > 0.0);
                if !has_all {
                    return Err(needs("the floor area of each room", "room_area"));
                }
                let share = |rooms: &[&RoomRuling]| rooms.iter().map(|room| room.floor_m2).sum::<f64>() / floor;
                DwellingRuling {
                    verdict: of(reaches(share(&sure), *least), reaches(share(&perhaps), *least)),
                    value: Quantity::Share(share(&sure)),
                    limit: Quantity::Share(*least),
                }
            }
        }))
    }

    /// Returns the ruling on a building by its dwellings. `counted` has one list for each criterion on dwellings, in
    /// their order: the dwellings with the times that the criterion counts.
    ///
    /// # Errors
    /// [`RuleError::Needs`] for a building without dwellings, or a dwelling without one of the uses.
    pub fn judge_house(&self, counted: &[Vec<DwellingSun>]) -> Result<Ruling, RuleError> {
        let of_dwellings = self.criteria.iter().enumerate().filter(|(_, criterion)| criterion.is_of_dwellings());
        let mut findings = Vec::new();
        for (at, (number, criterion)) in of_dwellings.enumerate() {
            let dwellings = counted.get(at).map_or(&[][..], Vec::as_slice);
            findings.push(self.of_house(number, criterion, dwellings)?);
        }
        Ok(self.ruling(vec![DayCase { set: 0, findings }]))
    }

    fn of_house(&self, number: usize, criterion: &Criterion, dwellings: &[DwellingSun]) -> Result<Finding, RuleError> {
        let needs = |what: String, key| RuleError::Needs {
            rule: self.id.clone(),
            needs: vec![RuleNeed::of_key(what, "[[window]]", key)],
        };
        if dwellings.is_empty() {
            return Err(needs("dwellings".to_owned(), "dwelling"));
        }
        let uses: &[String] = match &self.receiver {
            RuleReceiver::Window { all_of, .. } => all_of,
            _ => &[],
        };
        let least = if let Demand::AtLeast { secs, .. } = criterion.demand { secs } else { 0 };
        let mut having = 0;
        for dwelling in dwellings {
            let secs = |name: &String| dwelling.uses.iter().find(|(of, _)| of == name).map(|(_, secs)| *secs);
            let secs: Vec<i64> = uses
                .iter()
                .map(|name| {
                    secs(name)
                        .ok_or_else(|| needs(format!("a window or area of use {name} in {}", dwelling.name), "usage"))
                })
                .collect::<Result<_, _>>()?;
            let is_one_sunless = secs.contains(&0);
            let are_all_sunless = secs.iter().all(|secs| *secs == 0);
            let counts = match criterion.extent {
                Extent::Sunless { counts: SunlessWhen::OneUse, .. } => is_one_sunless,
                Extent::Sunless { counts: SunlessWhen::AllUses, .. } => are_all_sunless,
                _ => secs.iter().all(|secs| *secs >= least),
            };
            having += usize::from(counts);
        }
        let share = having as f64 / dwellings.len() as f64;
        let (limit, margin) = match criterion.extent {
            Extent::Sunless { most, .. } => (most, most - share),
            Extent::Dwellings(least) => (least, share - least),
            Extent::Whole | Extent::Part { .. } | Extent::OfBefore(_) => (0.0, 0.0),
        };
        let is_kept = reaches(margin, 0.0) || margin.abs() < 1e-9;
        Ok(Finding {
            criterion: number,
            date: None,
            verdict: if is_kept { Verdict::Pass } else { Verdict::Fail },
            value: Quantity::Share(share),
            longest_secs: None,
            before: None,
            limit: Some(Quantity::Share(limit)),
            margin: Some(margin),
            excuse: None,
            no_sun_left_secs: None,
        })
    }
}
