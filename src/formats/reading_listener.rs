//! Who hears which file is being read, so that a face can show it.

use std::fmt;
use std::path::Path;
use std::sync::Arc;

/// Is called with each file when its reading begins, and with `None` when it has ended.
type ReadingCall = dyn Fn(Option<&Path>) + Send + Sync;

/// Hears of each file when its reading begins, and `None` when it has ended. The default hears nothing.
#[derive(Clone, Default)]
pub struct ReadingListener(Option<Arc<ReadingCall>>);

impl ReadingListener {
    /// Calls with what is heard.
    pub fn new(hear: impl Fn(Option<&Path>) + Send + Sync + 'static) -> ReadingListener {
        ReadingListener(Some(Arc::new(hear)))
    }

    /// The reading of a file begins; it ends when what is returned is dropped.
    pub(super) fn begin(&self, path: &Path) -> ReadingNotice<'_> {
        self.hear(Some(path));
        ReadingNotice(self)
    }

    fn hear(&self, path: Option<&Path>) {
        if let Some(hear) = &self.0 {
            hear(path);
        }
    }
}

impl fmt::Debug for ReadingListener {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if self.0.is_some() { "ReadingListener(..)" } else { "ReadingListener(nobody)" })
    }
}

/// The reading of a file, as long as it lasts.
pub(super) struct ReadingNotice<'a>(&'a ReadingListener);

impl Drop for ReadingNotice<'_> {
    fn drop(&mut self) {
        self.0.hear(None);
    }
}
