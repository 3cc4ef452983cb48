//! `[plot]` → the plot, its sides and what adjoins them.

use super::asked_table::AskedTable;
use super::outline_file::outlines;
use super::request::{JudgedPlot, PlotSide};
use super::rings::{self, CheckedRing};
use crate::message::{Message, message};
use crate::site::error::SiteError;
use crate::site::judged_tables::PlotTable;
use crate::site::written::WrittenSite;
use crate::sun::Place;
use glam::DVec2;

/// The greatest width of a road, metres.
const WIDEST_M: f64 = 1000.0;
/// The greatest height of the ground above or below zero, metres.
const HIGHEST_M: f64 = 1e5;

/// The plot of a site file, if there is one, and notes on it.
///
/// # Errors
/// The first error in its table.
pub(super) fn plot(written: &WrittenSite, place: &Place) -> Result<(Option<JudgedPlot>, Vec<Message>), SiteError> {
    let Some(plot) = &written.site.plot else { return Ok((None, Vec::new())) };
    let table = AskedTable { written, name: "plot", at: (0, 1) };
    let key = table.one_of(&[("border", plot.border.is_some()), ("file", plot.file.is_some())])?;
    let mut notes = Vec::new();
    let written_rings = match (&plot.border, &plot.file) {
        (Some(corners), _) => {
            table.needless("crs", plot.crs.is_some(), key)?;
            vec![corners.iter().map(|corner| DVec2::from_array(*corner)).collect::<Vec<_>>()]
        }
        (None, file) => {
            let file = (file.as_deref().unwrap_or_default(), plot.crs.as_deref());
            let (outlines, of_file) = outlines(&table, file, place)?;
            notes = of_file;
            outlines.into_iter().flat_map(|outline| outline.rings).collect()
        }
    };
    if written_rings.len() != 1 {
        let what = format!("has {} borders, and a plot has one", written_rings.len());
        return Err(table.wrong(key, message![what; "name a file with one polygon without holes"]));
    }
    let checked = rings::checked(&written_rings).map_err(|fault| table.wrong(key, fault))?;
    let Some(ring) = checked.into_iter().next() else { return Ok((None, notes)) };
    let sides = sides(&table, plot, &ring)?;
    let mean_ground = table.within("mean_ground", plot.mean_ground, -HIGHEST_M, HIGHEST_M)?;
    Ok((Some(JudgedPlot { border: ring.corners, sides, mean_ground }), notes))
}

/// What adjoins each side of a border.
fn sides(table: &AskedTable, plot: &PlotTable, ring: &CheckedRing) -> Result<Vec<PlotSide>, SiteError> {
    let count = ring.corners.len();
    // a side has the number of the corner at which it begins in the order that was written
    let begins = |side: usize| if ring.is_reversed { (side + 1) % count } else { side };
    let side_of = |key: &str, number: u64| {
        let found = (0..count).find(|side| ring.numbers[begins(*side)] as u64 == number);
        found.ok_or_else(|| {
            let last = ring.numbers.iter().max().copied().unwrap_or_default();
            let what = format!("there is no side {number}");
            table.wrong(
                key,
                message![what; format!("its sides are 1 to {last}, each from the corner of its number to the next")],
            )
        })
    };
    let twice = |key: &str, number: u64| {
        let message = message![format!("side {number} appears twice"); "write each side once"];
        Err(table.wrong(key, message))
    };
    let mut sides = vec![PlotSide::default(); count];
    let mut has = vec![[false; 2]; count];
    for road in plot.roads.iter().flatten() {
        let side = side_of("roads", road.side)?;
        if !(road.width > 0.0 && road.width <= WIDEST_M) {
            let what = format!("a width of {} is not above 0 and at most {WIDEST_M}", road.width);
            return Err(table.wrong("roads", message![what; "write metres, for example { side = 1, width = 6.0 }"]));
        }
        if std::mem::replace(&mut has[side][0], true) {
            return twice("roads", road.side);
        }
        sides[side].road_m = road.width;
    }
    for neighbour in plot.neighbours.iter().flatten() {
        let side = side_of("neighbours", neighbour.side)?;
        if !(-WIDEST_M..=WIDEST_M).contains(&neighbour.higher) {
            let what = format!("a height of {} is not between -{WIDEST_M} and {WIDEST_M}", neighbour.higher);
            return Err(
                table.wrong("neighbours", message![what; "write metres, for example { side = 3, higher = 1.5 }"])
            );
        }
        if std::mem::replace(&mut has[side][1], true) {
            return twice("neighbours", neighbour.side);
        }
        sides[side].neighbour_higher_m = neighbour.higher;
    }
    Ok(sides)
}
