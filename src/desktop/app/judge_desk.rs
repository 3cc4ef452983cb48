//! What belongs to judging the open site: the rule, the verdicts with their table, and the tool that edits what is judged.

use crate::desktop::parts::verdict_layer::VerdictLayer;
use crate::desktop::results::judged::{JudgedResult, LineOf, SortBy};
use crate::desktop::results::verdict_shapes::VerdictShapes;
use crate::desktop::state::judging::{JudgeTool, RuleChoice, option_label};
use crate::desktop::work::Work;
use crate::rules::KnownRule;
use crate::site::file::SiteFile;
use std::path::PathBuf;
use std::sync::Arc;

/// The title of the panel's section.
pub(in crate::desktop) const SECTION: &str = "Judge by a rule";

/// What belongs to judging the open site.
#[derive(Default)]
pub(in crate::desktop) struct JudgeDesk {
    /// The rules that are known in a folder, once they are listed.
    pub(in crate::desktop) known: Vec<KnownRule>,
    /// The folder whose rules these are.
    pub(in crate::desktop) listed: Option<PathBuf>,
    pub(in crate::desktop) listing: Option<Work<Vec<KnownRule>>>,
    pub(in crate::desktop) choice: RuleChoice,
    /// Whether the panel's section opens in this frame.
    pub(in crate::desktop) opens: bool,
    pub(in crate::desktop) tool: Option<JudgeTool>,
    /// How many times the site was judged.
    pub(in crate::desktop) answers: u64,
    pub(in crate::desktop) judging: Option<Work<JudgedResult>>,
    pub(in crate::desktop) judged: Option<Arc<JudgedResult>>,
    /// Whether the table is open, and the picture in the colours of the verdicts.
    pub(in crate::desktop) shows: bool,
    pub(in crate::desktop) table: JudgedTable,
    pub(in crate::desktop) layer: VerdictLayer,
    pub(in crate::desktop) sketch: JudgedSketch,
}

/// How the table is shown.
#[derive(Default)]
pub(in crate::desktop) struct JudgedTable {
    pub(in crate::desktop) sort: SortBy,
    pub(in crate::desktop) is_reversed: bool,
    /// The indices of the lines in the order in which they are shown.
    pub(in crate::desktop) order: Vec<usize>,
    /// The line that was clicked.
    pub(in crate::desktop) chosen: Option<LineOf>,
    /// Whether the table is beside the picture, where its card has room below the lines.
    pub(in crate::desktop) is_beside: bool,
    /// Which of its days is shown.
    pub(in crate::desktop) day: usize,
}

/// What is judged, as it is shown while it is edited.
#[derive(Default)]
pub(in crate::desktop) struct JudgedSketch {
    pub(in crate::desktop) work: Option<Work<VerdictShapes>>,
    /// The site of which it is found, and its number.
    pub(in crate::desktop) of: Option<(u64, SiteFile)>,
    pub(in crate::desktop) shapes: VerdictShapes,
    /// Grows with every sketch.
    pub(in crate::desktop) number: u64,
    /// What is wrong with what is judged.
    pub(in crate::desktop) fault: Option<String>,
}

impl JudgeDesk {
    /// What has to be chosen before the site can be judged, or what is wrong with the choice.
    pub(in crate::desktop) fn unready(&self) -> Option<String> {
        let rule = match self.choice.of(&self.known) {
            None => return Some(format!("Choose a rule under \"{SECTION}\" first")),
            Some(Err(error)) => return Some(error.to_string()),
            Some(Ok(rule)) => rule,
        };
        let lacking = self.choice.lacking(rule);
        if lacking.is_empty() {
            return rule.resolve(&self.choice.pairs()).err().map(|error| error.to_string());
        }
        let names: Vec<String> = lacking.iter().map(|option| format!("\"{}\"", option_label(&option.name))).collect();
        Some(format!("{} leaves a choice to you: choose {} first", rule.source.name, names.join(" and ")))
    }

    /// Shows new verdicts, what fails first.
    pub(in crate::desktop) fn lay(&mut self, result: JudgedResult) {
        self.table =
            JudgedTable { sort: self.table.sort, is_reversed: self.table.is_reversed, ..JudgedTable::default() };
        self.table.order = result.sorted(self.table.sort, self.table.is_reversed);
        // its file may be newer than the list
        let listed = self.known.iter_mut().find(|(name, _)| *name == result.choice.name);
        listed.into_iter().for_each(|(_, rule)| *rule = Ok(result.rule.clone()));
        self.judged = Some(Arc::new(result));
        (self.shows, self.tool) = (true, None);
    }

    /// Sorts the table by a column; by the same one again in the opposite order.
    pub(in crate::desktop) fn sort_by(&mut self, by: SortBy) {
        self.table.is_reversed = by == self.table.sort && !self.table.is_reversed;
        self.table.sort = by;
        if let Some(judged) = &self.judged {
            self.table.order = judged.sorted(by, self.table.is_reversed);
        }
    }

    /// The verdicts, if they are shown.
    pub(in crate::desktop) fn shown(&self) -> Option<&Arc<JudgedResult>> {
        self.judged.as_ref().filter(|_| self.shows)
    }

    /// The verdicts with the line that was clicked, if they are shown.
    pub(in crate::desktop) fn chosen(&self) -> Option<(&Arc<JudgedResult>, LineOf)> {
        self.shown().zip(self.table.chosen)
    }

    /// Whether no work is running for it.
    #[cfg(feature = "test-hooks")]
    pub(in crate::desktop) fn is_settled(&self) -> bool {
        let shown = self.shown().is_none_or(|judged| self.tool.is_some() || self.layer.is_done(&judged.shapes));
        self.listing.is_none() && self.judging.is_none() && self.sketch.work.is_none() && shown
    }
}
