//! Ctrl-C: the first one ends the work at the next instant or stage, and the second one ends the program at once.

use crate::study::StudyError;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, LazyLock};

static ASKED: LazyLock<Arc<AtomicBool>> = LazyLock::new(Arc::default);

/// Set by Ctrl-C.
pub(super) fn asked() -> &'static Arc<AtomicBool> {
    &ASKED
}

/// Handles Ctrl-C from now on. If the system does not allow that, Ctrl-C ends the program as usual.
pub(super) fn listen() {
    let _ = ctrlc::set_handler(|| {
        if ASKED.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
    });
}

/// Breaks after Ctrl-C.
pub(super) fn flow() -> ControlFlow<()> {
    if ASKED.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}

/// Fails after Ctrl-C: between stages.
pub(super) fn check() -> Result<(), StudyError> {
    if flow().is_break() { Err(StudyError::Interrupted) } else { Ok(()) }
}
