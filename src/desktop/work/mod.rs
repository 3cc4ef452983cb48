//! Work in other threads.

pub(in crate::desktop) mod export;
pub(in crate::desktop) mod judging;
pub(in crate::desktop) mod loading;
pub(in crate::desktop) mod samples;
pub(in crate::desktop) mod studies;

use crate::desktop::state::words::{FileWords, PanelWords};
use crate::fault;
use crate::message::{Message, Words};
use crate::study::{Event, OnEvent, gather};
use eframe::egui;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, mpsc};

/// The window's name in the lock of a folder.
pub(in crate::desktop) const WHO: &str = "the window of gnomon";

/// Work in progress, which can be cancelled.
pub(in crate::desktop) struct Work<T> {
    progress: Arc<Mutex<(usize, usize)>>,
    /// Why the work started over, until that is read.
    note: Arc<Mutex<Option<String>>>,
    /// All notes so far, without repetition.
    notes: Arc<Mutex<Vec<Message>>>,
    cancelled: Arc<AtomicBool>,
    result: mpsc::Receiver<Result<T, String>>,
}

impl<T: Send + 'static> Work<T> {
    /// Starts work, which gets a listener for its events. Its errors are about files.
    pub(in crate::desktop) fn start(
        context: egui::Context,
        work: impl FnOnce(&mut OnEvent<'_>) -> anyhow::Result<T> + Send + 'static,
    ) -> Work<T> {
        Work::start_in(context, &FileWords, work)
    }

    /// The same with these words for its errors.
    pub(in crate::desktop) fn start_in(
        context: egui::Context,
        words: &'static dyn Words,
        work: impl FnOnce(&mut OnEvent<'_>) -> anyhow::Result<T> + Send + 'static,
    ) -> Work<T> {
        let (tell, result) = mpsc::channel();
        let progress = Arc::new(Mutex::new((0, 0)));
        let cancelled = Arc::new(AtomicBool::new(false));
        let note = Arc::new(Mutex::new(None));
        let (done_so_far, noted, heard) = (Arc::clone(&progress), Arc::clone(&note), Arc::clone(&cancelled));
        let notes = Arc::new(Mutex::new(Vec::new()));
        let gathered = Arc::clone(&notes);
        std::thread::spawn(move || {
            let mut last = None;
            let answer = work(&mut |event| {
                match &event {
                    Event::Drawn { index, count, .. } => {
                        if let Ok(mut done_so_far) = done_so_far.lock() {
                            *done_so_far = (index + 1, *count);
                        }
                    }
                    Event::Note(note) => {
                        last = Some(note.in_words(&PanelWords));
                        if let Ok(mut gathered) = gathered.lock() {
                            gather(&event, &[], &mut gathered);
                        }
                    }
                    // the note before it says why
                    Event::StartsOver => {
                        if let Ok(mut noted) = noted.lock() {
                            *noted = last.take();
                        }
                    }
                    _ => {}
                }
                if !matches!(event, Event::Between) {
                    context.request_repaint();
                }
                if heard.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            });
            // after a cancellation nobody receives this
            let _ = tell.send(answer.map_err(|error| fault::line(error.as_ref(), words)));
            context.request_repaint();
        });
        Work { progress, note, notes, cancelled, result }
    }

    /// The finished part of the work, and the whole.
    pub(in crate::desktop) fn progress(&self) -> (usize, usize) {
        self.progress.lock().map(|progress| *progress).unwrap_or_default()
    }

    /// Why the work started over; returned once.
    pub(in crate::desktop) fn note(&self) -> Option<String> {
        self.note.lock().ok().and_then(|mut note| note.take())
    }

    /// All notes so far.
    pub(in crate::desktop) fn notes(&self) -> Vec<Message> {
        self.notes.lock().map(|notes| notes.clone()).unwrap_or_default()
    }

    /// The result, once it is done.
    pub(in crate::desktop) fn done(&self) -> Option<Result<T, String>> {
        match self.result.try_recv() {
            Ok(result) => Some(result),
            Err(mpsc::TryRecvError::Empty) => None,
            Err(mpsc::TryRecvError::Disconnected) => Some(Err("the work ended early".to_owned())),
        }
    }
}

impl<T> Drop for Work<T> {
    fn drop(&mut self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }
}
