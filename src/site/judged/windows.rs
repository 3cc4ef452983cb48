//! `[[window]]` → windows.

use super::asked_table::{AskedTable, TakenNames};
use super::glass::{Pane, outward, pane, rectangle};
use super::glazing::joined;
use super::request::JudgedWindow;
use super::window_names::telling_names;
use crate::mesh::Mesh;
use crate::message::{Message, few, message};
use crate::site::error::SiteError;
use crate::site::judged_tables::{WindowTable, WrittenNames};
use crate::site::laid::pieces;
use crate::site::written::WrittenSite;
use glam::DVec3;

/// The most windows that are judged at once.
const MOST_WINDOWS: usize = 100_000;
/// A pane that fills a smaller share of its rectangle gets a note.
const RECTANGLE: f64 = 0.9;
/// The greatest distance of a floor or sill from the place's point, metres.
const FARTHEST_M: f64 = 1e5;
/// The greatest thickness of a wall, metres.
const THICKEST_M: f64 = 10.0;
/// The greatest area of a room, square metres.
const LARGEST_M2: f64 = 1e6;

/// The windows of a site file.
#[derive(Debug, Default)]
pub(super) struct AskedWindows {
    /// All windows.
    pub(super) list: Vec<JudgedWindow>,
    /// For each window, the index of its table.
    pub(super) of_table: Vec<usize>,
    /// For each component, whether its pieces are windows.
    pub(super) is_glass: Vec<bool>,
    /// Notes on them.
    pub(super) notes: Vec<Message>,
}

/// The windows of a site file, without what a table of rooms says about them.
///
/// # Errors
/// The first window that is wrong.
pub(super) fn windows(written: &WrittenSite, mesh: &Mesh) -> Result<AskedWindows, SiteError> {
    let mut asked = AskedWindows { is_glass: vec![false; mesh.components.len()], ..AskedWindows::default() };
    for (index, window) in written.site.window.iter().enumerate() {
        let table = AskedTable { written, name: "window", at: (index, written.site.window.len()) };
        let key = table.one_of(&[("component", window.component.is_some()), ("corners", window.corners.is_some())])?;
        let plain = plain(&table, window)?;
        if let Some(names) = &window.component {
            add_panes(&mut asked, &table, &plain, (names, mesh))?;
        }
        if let Some(corners) = window.corners {
            let corners = rectangle(corners).map_err(|fault| table.wrong(key, fault))?;
            let name = table.named(window.name.as_ref()).map_or_else(|| format!("window {}", index + 1), str::to_owned);
            asked.list.push(JudgedWindow { name, corners, outward: outward(&corners), ..plain });
            asked.of_table.push(index);
        }
        if asked.list.len() > MOST_WINDOWS {
            let what = format!("there are more than {MOST_WINDOWS} windows");
            return Err(table.wrong(key, message![what; "judge fewer at once"]));
        }
    }
    tell_apart(&mut asked, written)?;
    Ok(asked)
}

/// What a table says about all of its windows.
fn plain(table: &AskedTable, window: &WindowTable) -> Result<JudgedWindow, SiteError> {
    let reveal = table.within("reveal", window.reveal, 0.0, THICKEST_M)?;
    Ok(JudgedWindow {
        name: String::new(),
        component: None,
        corners: [DVec3::ZERO; 4],
        outward: DVec3::ZERO,
        other_side: None,
        reveal_m: reveal.unwrap_or(0.0),
        reveal_is_said: reveal.is_some(),
        inner_m: table.within("inner", window.inner, 0.0, THICKEST_M)?,
        floor: table.within("floor", window.floor, -FARTHEST_M, FARTHEST_M)?,
        room: table.named(window.room.as_ref()).map(str::to_owned),
        dwelling: table.named(window.dwelling.as_ref()).map(str::to_owned),
        usage: table.named(window.usage.as_ref()).map(str::to_owned),
        room_m2: table.within("room_area", window.room_area, f64::MIN_POSITIVE, LARGEST_M2)?,
    })
}

/// Adds the flat pieces of components, each a window; those close behind each other are one.
fn add_panes(
    asked: &mut AskedWindows,
    table: &AskedTable,
    plain: &JudgedWindow,
    (names, mesh): (&WrittenNames, &Mesh),
) -> Result<(), SiteError> {
    let chosen = table.chosen("component", names, mesh)?;
    let told = telling_names(&mesh.components, &chosen);
    let (mut found, mut bulky, mut odd, mut doubled) = (0_usize, Vec::new(), Vec::new(), Vec::new());
    for (index, component) in mesh.components.iter().enumerate().filter(|(index, _)| chosen[*index]) {
        if std::mem::replace(&mut asked.is_glass[index], true) {
            let what = format!("\"{}\" is glass of another [[window]], too", component.name);
            return Err(table.wrong("component", message![what; "name each once"]));
        }
        let name = table.named(table.written.site.window[table.at.0].name.as_ref()).unwrap_or(&told[index]);
        let panes: Vec<Option<Pane>> = pieces(mesh, component).iter().map(|piece| pane(mesh, piece)).collect();
        let said = || format!("\"{}\"", component.name);
        bulky.extend(panes.iter().filter(|pane| pane.is_none()).map(|_| said()));
        let (panes, count) = joined(panes.into_iter().flatten().collect());
        doubled.extend((0..count).map(|_| said()));
        for pane in panes {
            odd.extend((pane.share < RECTANGLE).then(said));
            found += 1;
            let [corners, other_side] = pane.sides;
            asked.list.push(JudgedWindow {
                name: name.to_owned(),
                component: Some(index as u32),
                corners,
                outward: outward(&corners),
                other_side: Some(other_side),
                ..plain.clone()
            });
            asked.of_table.push(table.at.0);
            if asked.list.len() > MOST_WINDOWS {
                // the caller reports that
                return Ok(());
            }
        }
    }
    if found == 0 {
        let what = "has no flat piece, as a pane is: at most 25 cm thick, and half as thick as wide and high";
        return Err(table.wrong("component", message![what; "name the glass alone"]));
    }
    asked.notes.extend(note_pieces(bulky, ["is", "are"], "not flat, as panes are, and no windows"));
    asked.notes.extend(note_pieces(odd, ["is", "are"], "no rectangles: the rectangle around each is judged"));
    let behind =
        "at most 20 cm behind others, as in double glazing: together they are one window, judged at its outer pane";
    asked.notes.extend(note_pieces(doubled, ["lies", "lie"], behind));
    Ok(())
}

/// A note on pieces of some components, with a verb for one piece and for more.
fn note_pieces(mut of: Vec<String>, [one, more]: [&str; 2], what: &str) -> Option<Message> {
    let count = of.len();
    of.dedup();
    let (pieces, verb) = if count == 1 { ("piece", one) } else { ("pieces", more) };
    let note = || message![format!("{count} {pieces} of {} {verb} {what}", few(of)); "name the glass alone"];
    (count > 0).then(note)
}

/// Numbers the windows that share a name, and refuses names that are written twice.
fn tell_apart(asked: &mut AskedWindows, written: &WrittenSite) -> Result<(), SiteError> {
    let mut names = TakenNames::default();
    let count = written.site.window.len();
    let single = asked.list.iter().zip(&asked.of_table).filter(|(window, _)| window.component.is_none());
    for (window, index) in single {
        if !names.take(&window.name) {
            let what = format!("\"{}\" is the name of another window, too", window.name);
            let table = AskedTable { written, name: "window", at: (*index, count) };
            return Err(table.wrong("name", message![what; "give each its own name"]));
        }
    }
    let mut counts: rustc_hash::FxHashMap<String, usize> = rustc_hash::FxHashMap::default();
    for window in asked.list.iter().filter(|window| window.component.is_some()) {
        *counts.entry(window.name.clone()).or_default() += 1;
    }
    let mut numbers: rustc_hash::FxHashMap<String, usize> = rustc_hash::FxHashMap::default();
    for window in asked.list.iter_mut().filter(|window| window.component.is_some()) {
        let plain = std::mem::take(&mut window.name);
        let is_alone = counts.get(&plain) == Some(&1);
        let number = numbers.entry(plain.clone()).or_default();
        window.name = loop {
            *number += 1;
            let name = match is_alone && *number == 1 {
                true => plain.clone(),
                // a second number in a row would be read as one
                false if plain.ends_with(|last: char| last.is_ascii_digit()) => format!("{plain} ({number})"),
                false => format!("{plain} {number}"),
            };
            if names.take(&name) {
                break name;
            }
        };
    }
    Ok(())
}
