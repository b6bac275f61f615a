//! `imp eval --json`: one request a line in, one answer a line out, in order. What has arrived is answered before more is
//! waited for, so that a program can ask and read in turns; what arrives faster is worked on by all threads.

use std::io;
use std::io::Read;
use std::path::Path;
use std::sync::Mutex;
use std::sync::PoisonError;
use std::sync::mpsc;
use std::sync::mpsc::Receiver;
use std::thread;

use rayon::iter::ParallelIterator;
use rayon::slice::ParallelSlice;

use crate::cli::eval::request::Evaluator;
use crate::cli::failure::Failure;
use crate::cli::files;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;
use crate::session;
use crate::session::expression::Workspace;

/// Bytes asked for at once.
const BLOCK: usize = 1 << 18;
/// Blocks read ahead of the work.
const AHEAD: usize = 16;
/// A longer line is refused; no request needs that.
const MAX_LINE: usize = 1 << 24;
/// Fewer lines are not worth a second thread.
const CHUNK: usize = 64;

/// Answers the requests of a file, or of stdin for `-`.
///
/// # Errors
/// If they cannot be read or the answers not be written; what is wrong with one request is its answer.
pub fn serve(source: &str, workspace: Workspace, arithmetic: Option<&str>) -> Result<(), Failure> {
    // Said once, not in every line.
    Evaluator::new(&workspace, arithmetic)?;
    let pool = Pool { workspace: &workspace, arithmetic, idle: Mutex::new(Vec::new()) };
    let blocks =
        if source == "-" { blocks(io::stdin()) } else { blocks(io::Cursor::new(session::bytes(Path::new(source))?)) };
    let mut splitter = Splitter::default();
    while let Ok(block) = blocks.recv() {
        splitter.take(&block.map_err(unreadable)?);
        while splitter.data.len() < AHEAD * BLOCK
            && let Ok(block) = blocks.try_recv()
        {
            splitter.take(&block.map_err(unreadable)?);
        }
        files::print(&splitter.complete(|lines| pool.answer(lines)))?;
    }
    files::print(&splitter.finish(|lines| pool.answer(lines)))
}

fn unreadable(error: io::Error) -> Failure {
    Diagnostic::error(code::CANNOT_OPEN, format!("cannot read the requests: {error}")).into()
}

/// What can be read, as it arrives, from a thread of its own.
fn blocks(mut source: impl Read + Send + 'static) -> Receiver<io::Result<Vec<u8>>> {
    let (sender, receiver) = mpsc::sync_channel(AHEAD);
    thread::spawn(move || {
        loop {
            let mut block = vec![0; BLOCK];
            let read = match source.read(&mut block) {
                Ok(0) => break,
                Ok(length) => {
                    block.truncate(length);
                    Ok(block)
                }
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                Err(error) => Err(error),
            };
            let failed = read.is_err();
            if sender.send(read).is_err() || failed {
                break;
            }
        }
    });
    receiver
}

/// One line of input.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Line<'d> {
    Request(&'d [u8]),
    TooLong,
}

/// Bytes to lines.
#[derive(Debug, Default)]
struct Splitter {
    data: Vec<u8>,
    /// Whether the beginning of the first line was thrown away.
    cut: bool,
}

impl Splitter {
    fn take(&mut self, block: &[u8]) {
        self.data.extend_from_slice(block);
    }

    /// Hands over the lines that are complete.
    fn complete(&mut self, answer: impl FnOnce(&[Line]) -> Vec<u8>) -> Vec<u8> {
        let end = self.data.iter().rposition(|&byte| byte == b'\n').map_or(0, |at| at + 1);
        let answers = if end > 0 { answer(&lines(&self.data[..end - 1], self.cut)) } else { Vec::new() };
        if end > 0 {
            self.cut = false;
            self.data.drain(..end);
        }
        if self.data.len() > MAX_LINE {
            self.cut = true;
            self.data.clear();
        }
        answers
    }

    /// Hands over what is left when nothing more comes.
    fn finish(&mut self, answer: impl FnOnce(&[Line]) -> Vec<u8>) -> Vec<u8> {
        answer(&lines(&self.data, self.cut))
    }
}

/// The lines that are not blank.
fn lines(data: &[u8], cut: bool) -> Vec<Line<'_>> {
    let mut lines: Vec<Line> = Vec::new();
    for (number, text) in data.split(|&byte| byte == b'\n').enumerate() {
        if number == 0 && cut || text.len() > MAX_LINE {
            lines.push(Line::TooLong);
        } else if !text.trim_ascii().is_empty() {
            lines.push(Line::Request(text));
        }
    }
    lines
}

/// Evaluators that keep what they have compiled.
struct Pool<'w> {
    workspace: &'w Workspace,
    arithmetic: Option<&'w str>,
    idle: Mutex<Vec<Evaluator<'w>>>,
}

impl Pool<'_> {
    /// Answers of all lines, in their order.
    fn answer(&self, lines: &[Line]) -> Vec<u8> {
        let share = (lines.len() / (4 * rayon::current_num_threads())).max(CHUNK);
        match lines.len() {
            0..=CHUNK => self.answer_some(lines),
            _ => lines.par_chunks(share).map(|lines| self.answer_some(lines)).collect::<Vec<_>>().concat(),
        }
    }

    fn answer_some(&self, lines: &[Line]) -> Vec<u8> {
        let idle = self.idle.lock().unwrap_or_else(PoisonError::into_inner).pop();
        // The arithmetic was checked before the first line.
        let Some(mut evaluator) = idle.or_else(|| Evaluator::new(self.workspace, self.arithmetic).ok()) else {
            return Vec::new();
        };
        let mut out = Vec::with_capacity(64 * lines.len());
        for line in lines {
            match line {
                Line::Request(text) => evaluator.answer(text, &mut out),
                Line::TooLong => evaluator.refuse(format!("a line has at most {} MiB", MAX_LINE >> 20), &mut out),
            }
            out.push(b'\n');
        }
        self.idle.lock().unwrap_or_else(PoisonError::into_inner).push(evaluator);
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The lines found when the input arrives in blocks of the given size.
    fn split(input: &[u8], size: usize) -> Vec<String> {
        let mut splitter = Splitter::default();
        let mut found = Vec::new();
        let mut keep = |lines: &[Line]| {
            for line in lines {
                found.push(match line {
                    Line::Request(text) => String::from_utf8_lossy(text).into_owned(),
                    Line::TooLong => "too long".to_owned(),
                });
            }
            Vec::new()
        };
        for block in input.chunks(size) {
            splitter.take(block);
            splitter.complete(&mut keep);
        }
        splitter.finish(&mut keep);
        found
    }

    #[test]
    fn lines_do_not_depend_on_how_they_arrive() {
        for size in 1..20 {
            assert_eq!(split(b"one\n\n  \r\ntwo\r\nthree", size), ["one", "two\r", "three"], "{size}");
        }
        assert!(split(b"", 1).is_empty() && split(b"\n\n", 1).is_empty());
    }

    #[test]
    fn endless_lines_are_refused_and_nothing_after_them() {
        let long = vec![b'x'; 3 * MAX_LINE];
        let input = [b"one\n", &long[..], b"\ntwo\n", &long[..]].concat();
        for size in [BLOCK, 5 * MAX_LINE, 20 * MAX_LINE] {
            assert_eq!(split(&input, size), ["one", "too long", "two", "too long"], "{size}");
        }
    }
}
