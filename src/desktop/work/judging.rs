//! Judges the open site by a rule, in a thread of its own; lists the rules that are known.

use crate::deliver::judgement::{JudgeRequest, judge as deliver};
use crate::deliver::{Folder, Sink};
use crate::desktop::results::judged::JudgedResult;
use crate::desktop::results::verdict_shapes::VerdictShapes;
use crate::desktop::state::judging::RuleChoice;
use crate::desktop::state::project::Project;
use crate::desktop::state::words;
use crate::desktop::work::{WHO, Work};
use crate::rules::{KnownRule, rule_for_site, rules_for_site};
use crate::site::{JudgedSite, Models, Overrides, SiteError, WrittenSite, judged_with_models};
use crate::study::settle;
use eframe::egui;
use std::path::PathBuf;
use std::sync::Arc;

/// Lists the rules for a site in a folder.
pub(in crate::desktop) fn rules(folder: PathBuf, context: egui::Context) -> Work<Vec<KnownRule>> {
    Work::start(context, move |_| Ok(rules_for_site(&folder)))
}

/// Judges the open site by a rule.
pub(in crate::desktop) fn judge(
    project: &Project,
    choice: RuleChoice,
    number: u64,
    context: egui::Context,
) -> Work<JudgedResult> {
    let (written, models, mark) = (project.written.clone(), project.models.clone(), project.models.mark());
    let reading = project.reading.clone();
    let words = words::of_panel(written.site.model.len());
    Work::start_in(context, words, move |on_event| {
        let rule = rule_for_site(&choice.name, &written.folder)?;
        let resolved = rule.resolve(&choice.pairs())?;
        let site = settle(read(&written, models, &Overrides { reading, ..Overrides::default() })?)?;
        let request = JudgeRequest { source: &rule.source, rule: &resolved, table: None };
        let answer = deliver(&site, request, Sink::Memory, on_event)?;
        let lines = JudgedResult::lines_of(&site, &answer.judgement);
        let shapes = VerdictShapes::of_receivers(&site, &answer.judgement);
        Ok(JudgedResult { number, site, answer, choice, rule, written: written.site, mark, lines, shapes })
    })
}

/// Finds what the open site says is judged, to be shown while it is edited.
pub(in crate::desktop) fn sketch(project: &Project, context: egui::Context) -> Work<VerdictShapes> {
    let (mut written, models) = (project.written.clone(), project.models.clone());
    // the other state is not drawn, and may have to be read
    written.site.before = None;
    let words = words::of_panel(written.site.model.len());
    Work::start_in(context, words, move |_| {
        let site = read(&written, models, &Overrides::default())?;
        Ok(VerdictShapes::of_site(&site))
    })
}

fn read(written: &WrittenSite, models: Models, overrides: &Overrides) -> Result<JudgedSite, SiteError> {
    judged_with_models(written, overrides, || Ok(models))
}

/// Writes the verdicts to a folder.
pub(in crate::desktop) fn written(
    project: &Project,
    result: Arc<JudgedResult>,
    folder: PathBuf,
    context: egui::Context,
) -> Work<PathBuf> {
    let inputs = project.inputs(None);
    Work::start(context, move |_| {
        result.write(Sink::Folder(Folder { path: &folder, who: WHO, inputs: &inputs }))?;
        Ok(folder)
    })
}
