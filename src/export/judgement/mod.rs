//! The results of `gnomon judge`: a table for people, JSON with enough to compute it again by hand, and CSV with one
//! line per receiver.

mod csv;
mod json;
mod numbers;
mod rule_report;
mod table;

pub use csv::csv;
pub use json::json;
pub(super) use numbers::CHECK;
pub(super) use rule_report::{RuleReport, SettledReport, rule_report, settled_report};
pub use table::table;
