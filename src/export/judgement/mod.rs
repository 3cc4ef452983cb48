//! The results of `gnomon judge`: a table for people, JSON with enough to compute it again by hand, and CSV with one
//! line per receiver.

mod csv;
mod json;
mod numbers;
mod rows;
mod rule_report;
mod strip;
mod table;

pub use csv::csv;
pub use json::json;
pub use numbers::CHECK;
pub use rows::{ReceiverRow, TakerRow, group_said, receiver_row, taker_row};
pub(super) use rule_report::{RuleReport, SettledReport, rule_report, settled_report};
pub use strip::{BarKind, DayStrip, StripBar, StripSpell, day_strips};
pub use table::table;
