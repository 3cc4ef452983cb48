//! Judging a site by a rule: the answer and a table.

use super::{DeliverError, Sink, WrittenFiles};
use crate::export::judgement as encode;
use crate::judgement::Judgement;
use crate::message::Message;
use crate::rules::{ResolvedRule, RuleSource};
use crate::site::JudgedSite;
use crate::study::{self, Event, OnEvent, tell};
use std::path::PathBuf;

/// The rule by which a site is judged.
#[derive(Clone, Copy, Debug)]
pub struct JudgeRequest<'a> {
    /// The rule's source.
    pub source: &'a RuleSource,
    /// The rule with all of its options chosen.
    pub rule: &'a ResolvedRule,
    /// The name of the table with one line per receiver. Without a name there is no table.
    pub table: Option<&'a PathBuf>,
}

/// The names of the files of [`write_judgement`].
pub fn judgement_names() -> [PathBuf; 2] {
    ["judgement.json", "judgement.csv"].map(PathBuf::from)
}

/// Writes a verdict that is found already: everything as JSON, and the table as CSV.
///
/// # Errors
/// [`DeliverError`]. Files that cannot be written.
pub fn write_judgement(site: &JudgedSite, answer: &JudgeAnswer, sink: Sink<'_>) -> Result<WrittenFiles, DeliverError> {
    let names = judgement_names();
    let open = sink.open(&names, None)?;
    let json = encode::json(&answer.judgement, site, (&answer.notes, site.words))?;
    let texts = [json, encode::csv(&answer.judgement)];
    Ok(open.write(names.into_iter().zip(texts.map(String::into_bytes)).collect())?)
}

/// The verdict.
#[derive(Clone, Debug)]
pub struct JudgeAnswer {
    /// The verdicts, with everything that they rest on.
    pub judgement: Judgement,
    /// Notes on the models and on how they were judged.
    pub notes: Vec<Message>,
    /// The files that were written.
    pub written: WrittenFiles,
}

/// Judges a site by a rule.
///
/// # Errors
/// [`DeliverError`]. Files that cannot be written, and everything that the rule needs and the site lacks, are reported
/// before anything is searched.
pub fn judge(
    site: &JudgedSite,
    asked: JudgeRequest<'_>,
    sink: Sink<'_>,
    on_event: &mut OnEvent<'_>,
) -> Result<JudgeAnswer, DeliverError> {
    let names: Vec<PathBuf> = asked.table.into_iter().cloned().collect();
    let open = sink.open(&names, None)?;
    let mut notes = site.notes.clone();
    let judgement = study::judge::judge(site, asked.source, asked.rule, &mut |event| {
        study::gather(&event, &site.notes, &mut notes);
        on_event(event)
    })?;
    for note in &judgement.notes {
        tell(on_event, Event::Note(note.clone()))?;
        notes.push(note.clone());
    }
    let files = names.into_iter().map(|name| (name, encode::csv(&judgement).into_bytes())).collect();
    Ok(JudgeAnswer { written: open.write(files)?, judgement, notes })
}
