//! Output: whole files or none, and pipes whose reader may leave.

use std::io;
use std::io::Write;
use std::path::Path;
use std::path::PathBuf;
use std::process;
use std::sync::atomic::AtomicBool;
use std::sync::atomic::Ordering;

use crate::cli::failure::Failure;
use crate::session;

/// What shells report of a command ended by Ctrl-C.
const INTERRUPTED: i32 = 130;

/// Whether work is under way that stops when it is asked to.
static INTERRUPTIBLE: AtomicBool = AtomicBool::new(false);

/// Asks that work to stop.
static STOP: AtomicBool = AtomicBool::new(false);

/// Makes Ctrl-C end the process between writes, never within one; or ask interruptible work to stop, the first time.
pub fn exit_on_interrupt() {
    // Without a handler the process ends all the same, only less tidily.
    let _ = ctrlc::set_handler(|| {
        if INTERRUPTIBLE.load(Ordering::SeqCst) && !STOP.swap(true, Ordering::SeqCst) {
            return;
        }
        let _writing = session::finish_writing();
        process::exit(INTERRUPTED);
    });
}

/// Does work that stops with what it has when a flag is set, which the first Ctrl-C does; the second one ends the process.
/// The result, and whether it was asked to stop.
pub fn interruptible<T>(work: impl FnOnce(&AtomicBool) -> T) -> (T, bool) {
    INTERRUPTIBLE.store(true, Ordering::SeqCst);
    let result = work(&STOP);
    INTERRUPTIBLE.store(false, Ordering::SeqCst);
    (result, STOP.load(Ordering::SeqCst))
}

/// Ends the process as interrupted, with a word on stderr.
pub fn leave_interrupted(word: &str) -> ! {
    // Nobody is left to be told when stderr is closed.
    let _ = writeln!(io::stderr(), "{word}");
    process::exit(INTERRUPTED)
}

/// Writes a file as a whole, as [`session::write`].
///
/// # Errors
/// As there.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    Ok(session::write(path, bytes)?)
}

/// Whether there is a folder for a file that will be written later, as [`session::check_folder`].
///
/// # Errors
/// As there.
pub fn check_folder(path: &Path) -> Result<(), Failure> {
    Ok(session::check_folder(path)?)
}

/// Writes to stdout.
///
/// # Errors
/// If stdout cannot be written. A reader that has read enough (`imp emit ... | head`) is none: the process ends as done.
pub fn print(bytes: &[u8]) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Ok(()) => Ok(()),
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => process::exit(0),
        Err(error) => Err(session::cannot_write(Path::new("stdout"), &error).into()),
    }
}

/// The file of one of several pictures: `out.png`, 7, 120 gives `out_007.png`.
pub fn numbered(path: &Path, number: u64, last: u64) -> PathBuf {
    let digits = last.to_string().len();
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let ending = path.extension().map_or(String::new(), |ending| format!(".{}", ending.to_string_lossy()));
    path.with_file_name(format!("{stem}_{number:0digits$}{ending}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_the_same_width() {
        assert_eq!(numbered(Path::new("a/out.png"), 7, 120), Path::new("a/out_007.png"));
        assert_eq!(numbered(Path::new("out"), 0, 9), Path::new("out_0"));
    }
}
