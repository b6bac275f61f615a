//! How a caller watches and stops work under way.

use std::sync::atomic::AtomicBool;
use std::sync::atomic::AtomicUsize;
use std::sync::atomic::Ordering;

/// Progress out, cancellation in; shared by every thread of the work.
#[derive(Default)]
pub struct Control<'a> {
    /// Called with steps done and steps in all, from any thread.
    pub progress: Option<&'a (dyn Fn(usize, usize) + Sync)>,
    /// Set from anywhere to stop the work.
    pub cancel: Option<&'a AtomicBool>,
    done: AtomicUsize,
}

impl<'a> Control<'a> {
    pub fn new(progress: Option<&'a (dyn Fn(usize, usize) + Sync)>, cancel: Option<&'a AtomicBool>) -> Self {
        Self { progress, cancel, done: AtomicUsize::new(0) }
    }

    pub fn is_cancelled(&self) -> bool {
        self.cancel.is_some_and(|flag| flag.load(Ordering::Relaxed))
    }

    /// One more of `total` steps is done.
    pub fn advance(&self, total: usize) {
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        if let Some(progress) = self.progress {
            progress(done, total);
        }
    }

    /// Before the work starts over.
    pub fn reset(&self) {
        self.done.store(0, Ordering::Relaxed);
    }
}
