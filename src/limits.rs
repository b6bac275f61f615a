//! What a source may cost before it is refused: bytes, nodes, operations and time. For sources from strangers, as behind
//! a web page, there is [`Limits::untrusted`].
//!
//! Everything but the time is counted, so that the same source is accepted or refused on every machine; the time is the
//! last resort. What is compiled is bounded too: a kernel is straight-line code of at most [`Limits::operations`]
//! operations on vectors in one loop over its packets, so that one packet costs at most some nanoseconds for each of them.

use std::fmt;
use std::sync::atomic::AtomicU32;
use std::sync::atomic::AtomicUsize;
use std::sync::atomic::Ordering;
use std::time::Duration;
use std::time::Instant;

use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;

/// The most that compiling one source may take. [`Limits::default`] is for people's own files, [`Limits::untrusted`] for
/// those of strangers; single limits change with `Limits { time, ..Limits::untrusted() }`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Limits {
    /// Bytes of text in all: the source and the files that it imports. The standard library does not count.
    pub source_bytes: usize,
    /// Files that may be imported. The standard library does not count.
    pub files: usize,
    /// Steps of inlining functions: expressions copied and nodes of derivatives.
    pub steps: usize,
    /// Nodes of the graph of all formulas, after every stage.
    pub nodes: usize,
    /// Operations on vectors in one kernel.
    pub operations: usize,
    /// From the text to the machine code of one kernel. Looked at every few microseconds, but not within the code
    /// generator, which takes up to 3 us for each of [`Limits::operations`].
    pub time: Duration,
}

impl Default for Limits {
    /// 1 MiB of text, a million steps, 250 000 nodes, a minute.
    fn default() -> Self {
        Self {
            source_bytes: 1 << 20,
            files: 1000,
            steps: 1_000_000,
            nodes: 250_000,
            operations: 4_000_000,
            time: Duration::from_secs(60),
        }
    }
}

impl Limits {
    /// No limit at all, for what was held to limits before.
    pub const fn unlimited() -> Self {
        let all = usize::MAX;
        Self { source_bytes: all, files: all, steps: all, nodes: all, operations: all, time: Duration::MAX }
    }

    /// For formulas from strangers: 64 KiB of text, no files but the standard library, 20 000 nodes, half a second.
    pub fn untrusted() -> Self {
        Self {
            source_bytes: 64 << 10,
            files: 0,
            steps: 100_000,
            nodes: 20_000,
            operations: 100_000,
            time: Duration::from_millis(500),
        }
    }
}

/// Looks of the budget's user for one look at the clock.
const LOOKS: u32 = 64;

/// Limits and the time at which work under them began: one for each source.
#[derive(Debug)]
pub struct Budget {
    limits: Limits,
    start: Instant,
    looks: AtomicU32,
    /// Bytes of text taken so far.
    source: AtomicUsize,
}

impl Budget {
    /// Begins now.
    pub fn new(limits: &Limits) -> Self {
        Self { limits: *limits, start: Instant::now(), looks: AtomicU32::new(0), source: AtomicUsize::new(0) }
    }

    pub fn limits(&self) -> &Limits {
        &self.limits
    }

    /// Whether there is time left. Cheap: most calls only count.
    ///
    /// # Errors
    /// If there is none.
    pub fn tick(&self) -> Result<(), Exceeded> {
        // A count lost between threads delays a look at the clock by a few calls.
        let looks = self.looks.load(Ordering::Relaxed).wrapping_add(1);
        self.looks.store(looks, Ordering::Relaxed);
        if looks.is_multiple_of(LOOKS) { self.time() } else { Ok(()) }
    }

    /// Whether there is time left, by the clock.
    ///
    /// # Errors
    /// If there is none.
    pub fn time(&self) -> Result<(), Exceeded> {
        let taken = self.start.elapsed();
        let allowed = self.limits.time;
        if taken <= allowed { Ok(()) } else { Err(Exceeded::Time { taken, allowed }) }
    }

    /// Bytes of text that may still be read.
    pub fn source_left(&self) -> usize {
        self.limits.source_bytes.saturating_sub(self.source.load(Ordering::Relaxed))
    }

    /// Counts a text.
    ///
    /// # Errors
    /// If it is one too much.
    pub fn source(&self, bytes: usize) -> Result<(), Exceeded> {
        let before = self.source.fetch_add(bytes, Ordering::Relaxed);
        Exceeded::counted("bytes of text", before.saturating_add(bytes), self.limits.source_bytes)
    }

    /// Whether so many files may be imported.
    ///
    /// # Errors
    /// If not.
    pub fn files(&self, files: usize) -> Result<(), Exceeded> {
        Exceeded::counted("imported files", files, self.limits.files)
    }

    /// Whether so many steps of inlining are allowed.
    ///
    /// # Errors
    /// If not.
    pub fn steps(&self, steps: usize) -> Result<(), Exceeded> {
        Exceeded::counted("steps of inlining", steps, self.limits.steps)
    }

    /// Whether a graph of so many nodes is allowed.
    ///
    /// # Errors
    /// If it is not.
    pub fn nodes(&self, nodes: usize) -> Result<(), Exceeded> {
        Exceeded::counted("operations in its graph", nodes, self.limits.nodes)
    }

    /// Whether a kernel of so many operations is allowed.
    ///
    /// # Errors
    /// If it is not.
    pub fn operations(&self, operations: usize) -> Result<(), Exceeded> {
        Exceeded::counted("operations in its kernel", operations, self.limits.operations)
    }
}

/// Which limit was exceeded, and by how much.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Exceeded {
    Time {
        taken: Duration,
        allowed: Duration,
    },
    /// `found` is how many there are at least.
    Count {
        what: &'static str,
        found: usize,
        allowed: usize,
    },
}

impl Exceeded {
    fn counted(what: &'static str, found: usize, allowed: usize) -> Result<(), Exceeded> {
        if found <= allowed { Ok(()) } else { Err(Exceeded::Count { what, found, allowed }) }
    }
}

impl fmt::Display for Exceeded {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Exceeded::Time { taken, allowed } => {
                let (taken, allowed) = (taken.as_millis(), allowed.as_millis());
                write!(f, "this formula takes longer to compile than allowed: {taken} ms, and {allowed} are allowed")
            }
            Exceeded::Count { what, found, allowed } => {
                write!(f, "this formula is larger than allowed: {found} {what}, and {allowed} are allowed")
            }
        }
    }
}

impl From<Exceeded> for Diagnostic {
    fn from(exceeded: Exceeded) -> Self {
        let code = match exceeded {
            Exceeded::Time { .. } => code::TOO_SLOW,
            Exceeded::Count { .. } => code::LARGER_THAN_ALLOWED,
        };
        Diagnostic::error(code, exceeded.to_string())
            .help("make it shorter: fewer shapes, fewer calls, fewer derivatives")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_runs_out() {
        let budget = Budget::new(&Limits { time: Duration::ZERO, ..Limits::default() });
        assert!((0..2 * LOOKS).any(|_| budget.tick().is_err()));
        let diagnostic = Diagnostic::from(budget.time().unwrap_err());
        assert_eq!(diagnostic.code, code::TOO_SLOW);
        assert!(diagnostic.title.ends_with("and 0 are allowed"), "{}", diagnostic.title);
        assert!(Budget::new(&Limits::default()).time().is_ok());
    }

    #[test]
    fn counts_are_inclusive() {
        let budget = Budget::new(&Limits { nodes: 7, ..Limits::untrusted() });
        assert!(budget.nodes(7).is_ok());
        let diagnostic = Diagnostic::from(budget.nodes(8).unwrap_err());
        assert_eq!(diagnostic.code, code::LARGER_THAN_ALLOWED);
        assert!(diagnostic.title.contains("8 operations in its graph, and 7"), "{}", diagnostic.title);
    }
}
