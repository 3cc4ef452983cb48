//! Work in threads beside the window's own.

pub(in crate::desktop) mod export;
pub(in crate::desktop) mod loading;
pub(in crate::desktop) mod samples;
pub(in crate::desktop) mod studies;

use crate::desktop::state::words::{FileWords, PanelWords};
use crate::fault;
use crate::message::Message;
use crate::study::{Event, OnEvent, gather};
use eframe::egui;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, mpsc};

/// Who works in a folder, for others who want to.
pub(in crate::desktop) const WHO: &str = "the window of gnomon";

/// It can be given up.
pub(in crate::desktop) struct Work<T> {
    progress: Arc<Mutex<(usize, usize)>>,
    /// Why it is done again, until that is taken.
    note: Arc<Mutex<Option<String>>>,
    /// All that was noted so far, each note once.
    notes: Arc<Mutex<Vec<Message>>>,
    cancelled: Arc<AtomicBool>,
    result: mpsc::Receiver<Result<T, String>>,
}

impl<T: Send + 'static> Work<T> {
    /// Begins; the work is given what hears its events.
    pub(in crate::desktop) fn start(
        context: egui::Context,
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
            // who gave it up listens no more
            let _ = tell.send(answer.map_err(|error| fault::line(error.as_ref(), &FileWords)));
            context.request_repaint();
        });
        Work { progress, note, notes, cancelled, result }
    }

    /// How much is done, of how much.
    pub(in crate::desktop) fn progress(&self) -> (usize, usize) {
        self.progress.lock().map(|progress| *progress).unwrap_or_default()
    }

    /// Why it is done again, once where it is.
    pub(in crate::desktop) fn note(&self) -> Option<String> {
        self.note.lock().ok().and_then(|mut note| note.take())
    }

    /// All that was noted so far.
    pub(in crate::desktop) fn notes(&self) -> Vec<Message> {
        self.notes.lock().map(|notes| notes.clone()).unwrap_or_default()
    }

    /// What came of it, once it is done.
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
