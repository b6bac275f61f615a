//! Output: whole files or none, and pipes whose reader may leave.

use std::fs;
use std::io;
use std::io::Write;
use std::path::Path;
use std::path::PathBuf;
use std::process;
use std::sync::Mutex;
use std::sync::PoisonError;

use tempfile::Builder;

use crate::cli::failure::Failure;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;

/// Held while a temporary file exists, so that an interrupt waits until it has its final name.
static WRITING: Mutex<()> = Mutex::new(());

/// What shells report of a command ended by Ctrl-C.
const INTERRUPTED: i32 = 130;

/// Makes Ctrl-C end the process between writes, never within one.
pub fn exit_on_interrupt() {
    // Without a handler the process ends all the same, only less tidily.
    let _ = ctrlc::set_handler(|| {
        let _writing = WRITING.lock().unwrap_or_else(PoisonError::into_inner);
        process::exit(INTERRUPTED);
    });
}

/// Writes a file as a whole: under a temporary name beside it, then renamed. What is no regular file, such as a device,
/// is written in place.
///
/// # Errors
/// If the folder is missing or not writable, or the disk is full; then nothing has changed.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    // A link keeps pointing where it points.
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
    let present = fs::metadata(&target).ok();
    let written = match &present {
        Some(metadata) if !metadata.is_file() && !metadata.is_dir() => fs::write(&target, bytes),
        Some(metadata) if metadata.is_dir() => Err(io::Error::from(io::ErrorKind::IsADirectory)),
        _ => replace(&target, bytes, present.map(|metadata| metadata.permissions())),
    };
    written.map_err(|error| cannot_write(path, &error).into())
}

/// Whether there is a folder for a file that will be written later.
///
/// # Errors
/// If there is none, or the file's name is that of a folder.
pub fn check_folder(path: &Path) -> Result<(), Failure> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let kind = match folder {
        _ if path.is_dir() => io::ErrorKind::IsADirectory,
        Some(folder) if !folder.is_dir() => io::ErrorKind::NotFound,
        _ => return Ok(()),
    };
    Err(cannot_write(path, &kind.into()).into())
}

fn replace(target: &Path, bytes: &[u8], permissions: Option<fs::Permissions>) -> io::Result<()> {
    let folder = match target.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let _writing = WRITING.lock().unwrap_or_else(PoisonError::into_inner);
    let mut builder = Builder::new();
    builder.prefix(".imp-");
    // Temporary files are private by default; this one becomes an ordinary file.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let mut file = builder.tempfile_in(folder)?;
    file.write_all(bytes)?;
    if let Some(permissions) = permissions {
        fs::set_permissions(file.path(), permissions)?;
    }
    file.persist(target).map_err(|error| error.error)?;
    Ok(())
}

fn cannot_write(path: &Path, error: &io::Error) -> Diagnostic {
    let name = path.display();
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    match folder {
        Some(folder) if error.kind() == io::ErrorKind::NotFound => {
            let folder = folder.display();
            Diagnostic::error(code::CANNOT_WRITE, format!("cannot write `{name}`: there is no folder `{folder}`"))
                .help(format!("make it first: `mkdir -p {folder}`"))
        }
        _ if error.kind() == io::ErrorKind::IsADirectory => {
            Diagnostic::error(code::CANNOT_WRITE, format!("cannot write `{name}`: it is a folder"))
                .help(format!("name a file in it: `{}`", path.join("picture.png").display()))
        }
        _ => Diagnostic::error(code::CANNOT_WRITE, format!("cannot write `{name}`: {error}")),
    }
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
        Err(error) => Err(cannot_write(Path::new("stdout"), &error).into()),
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
    fn files_are_replaced_whole_and_nothing_else_is_left() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        write(&path, b"one").unwrap();
        write(&path, b"two").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"two");
        assert!(write(folder.path(), b"x").is_err());
        assert!(write(&folder.path().join("no/b.png"), b"x").is_err());
        assert!(check_folder(&path).is_ok() && check_folder(Path::new("a.png")).is_ok());
        assert!(check_folder(folder.path()).is_err() && check_folder(&folder.path().join("no/b.png")).is_err());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[cfg(unix)]
    #[test]
    fn links_and_permissions_stay() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let (path, link) = (folder.path().join("a.imp"), folder.path().join("b.imp"));
        fs::write(&path, "one").unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).unwrap();
        std::os::unix::fs::symlink(&path, &link).unwrap();
        write(&link, b"two").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::metadata(&path).unwrap().permissions().mode() & 0o777, 0o640);
        assert_eq!(fs::read(&path).unwrap(), b"two");
        // A device is written, not replaced.
        write(Path::new("/dev/null"), b"x").unwrap();
        assert!(!fs::metadata("/dev/null").unwrap().is_file());
    }

    #[test]
    fn numbers_have_the_same_width() {
        assert_eq!(numbered(Path::new("a/out.png"), 7, 120), Path::new("a/out_007.png"));
        assert_eq!(numbered(Path::new("out"), 0, 9), Path::new("out_0"));
    }
}
