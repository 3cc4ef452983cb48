//! Loses a device for tests.

use std::cell::Cell;

thread_local! {
    /// After this many further checks of a device on this thread, the device is lost.
    static TO_BE_LOST: Cell<Option<u32>> = const { Cell::new(None) };
}

/// Loses the device that is checked on this thread after that many further checks, as if its driver was reset.
pub fn lose_after(checks: u32) {
    TO_BE_LOST.set(Some(checks));
}

pub(super) fn is_to_be_lost() -> bool {
    let left = TO_BE_LOST.get();
    TO_BE_LOST.set(left.and_then(|left| left.checked_sub(1)));
    left == Some(0)
}
