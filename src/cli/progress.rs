//! Progress and notes on stderr: a bar on a terminal, plain lines otherwise, nothing with `--quiet`.

use super::interrupt;
use super::options::Options;
use super::output::words;
use crate::study::Event;
use indicatif::{HumanDuration, ProgressBar, ProgressStyle};
use std::collections::HashSet;
use std::io::{self, IsTerminal, Write};
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

/// The display of progress.
pub(super) struct Progress {
    quiet: bool,
    /// What is counted.
    what: &'static str,
    bar: Option<ProgressBar>,
    /// The last tenth of the work that was reported.
    told: usize,
    /// The notes so far, since one for both states of a site is printed once.
    noted: HashSet<String>,
    /// The number of instants done before, and the time of the start.
    begun: (usize, Instant),
}

impl Progress {
    pub(super) fn new(quiet: bool) -> Progress {
        Progress::of("instants", quiet)
    }

    /// A display for work that is counted in something else.
    pub(super) fn of(what: &'static str, quiet: bool) -> Progress {
        Progress { quiet, what, bar: None, told: 0, noted: HashSet::new(), begun: (0, Instant::now()) }
    }

    /// Shows an event.
    pub(super) fn hear(&mut self, event: &Event<'_>) {
        if self.quiet {
            return;
        }
        match event {
            Event::Note(note) => {
                let note = note.in_words(&Options);
                if self.noted.insert(note.clone()) {
                    self.line(&format!("note: {}", words(&note)));
                }
            }
            Event::Started { instants, tiles } => {
                if *tiles > 1 {
                    self.what = "instants, counted in each tile";
                }
                (self.begun, self.told) = ((0, Instant::now()), 0);
                // a single instant is done before a bar is seen
                if *instants > 1 && io::stderr().is_terminal() {
                    self.bar = Some(bar(*instants, self.what));
                }
            }
            Event::GoesOn { done } => {
                self.begun.0 = *done;
                self.line(&format!("note: continues where it was stopped, after {done} {}", self.what));
                if let Some(bar) = &self.bar {
                    bar.set_position(*done as u64);
                    bar.reset_eta();
                }
            }
            Event::StartsOver => {
                if let Some(bar) = self.bar.take() {
                    bar.finish_and_clear();
                }
            }
            Event::Resumes { .. }
            | Event::Prepared { .. }
            | Event::Tile(_)
            | Event::Summed(_)
            | Event::Between
            | Event::Kept(_)
            | Event::Stage(_) => {}
            Event::Drawn { index, count, time, .. } => {
                let done = index + 1;
                let time = time.format("%Y-%m-%d %H:%M");
                if let Some(bar) = &self.bar {
                    bar.set_message(time.to_string());
                    bar.set_position(done as u64);
                    if done == *count {
                        bar.finish_and_clear();
                    }
                } else if *count > 1 && done * 10 / count > self.told {
                    self.told = done * 10 / count;
                    let left = self.left(done, *count);
                    self.line(&format!("{:>3}%  {done} of {count} {}, {time}{left}", done * 100 / count, self.what));
                }
            }
        }
    }

    /// Shows an event. Returns whether the work continues: not after Ctrl-C.
    pub(super) fn heard(&mut self, event: &Event<'_>) -> ControlFlow<()> {
        self.hear(event);
        interrupt::flow()
    }

    /// The time that the rest takes, if that is at least seconds.
    fn left(&self, done: usize, count: usize) -> String {
        let (before, since) = self.begun;
        let each = since.elapsed().as_secs_f64() / (done.saturating_sub(before)).max(1) as f64;
        let secs = (each * (count - done) as f64).round();
        if secs < 2.0 { String::new() } else { format!(", {} left", HumanDuration(Duration::from_secs_f64(secs))) }
    }

    fn line(&self, line: &str) {
        match &self.bar {
            Some(bar) => bar.println(line),
            None => {
                // if stderr is closed there is nobody to tell
                let _ = writeln!(io::stderr(), "{line}");
            }
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

fn bar(count: usize, what: &str) -> ProgressBar {
    let style = ProgressStyle::with_template(&format!("{{bar:32}} {{pos}} of {{len}} {what}, {{msg}}, {{eta}} left"));
    ProgressBar::new(count as u64).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}
