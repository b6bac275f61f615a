//! Files written as a whole or not at all.

use std::fs;
use std::io;
use std::io::Write;
use std::path::Path;
use std::sync::Mutex;
use std::sync::MutexGuard;
use std::sync::PoisonError;

use tempfile::Builder;

use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;

/// Held while a temporary file exists, so that an interrupt waits until it has its final name.
static WRITING: Mutex<()> = Mutex::new(());

/// Waits until no file is being written; none will be before the guard is dropped.
pub fn finish_writing() -> MutexGuard<'static, ()> {
    WRITING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Writes a file as a whole: under a temporary name beside it, then renamed. What is no regular file, such as a device,
/// is written in place.
///
/// # Errors
/// If the folder is missing or not writable, or the disk is full; then nothing has changed.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), Diagnostic> {
    // A link keeps pointing where it points.
    let target = fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
    let present = fs::metadata(&target).ok();
    let written = match &present {
        Some(metadata) if !metadata.is_file() && !metadata.is_dir() => fs::write(&target, bytes),
        Some(metadata) if metadata.is_dir() => Err(io::Error::from(io::ErrorKind::IsADirectory)),
        _ => replace(&target, bytes, present.map(|metadata| metadata.permissions())),
    };
    written.map_err(|error| cannot_write(path, &error))
}

fn replace(target: &Path, bytes: &[u8], permissions: Option<fs::Permissions>) -> io::Result<()> {
    let folder = match target.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let _writing = finish_writing();
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

/// Whether there is a folder for a file that will be written later.
///
/// # Errors
/// If there is none, or the file's name is that of a folder.
pub fn check_folder(path: &Path) -> Result<(), Diagnostic> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let kind = match folder {
        _ if path.is_dir() => io::ErrorKind::IsADirectory,
        Some(folder) if !folder.is_dir() => io::ErrorKind::NotFound,
        _ => return Ok(()),
    };
    Err(cannot_write(path, &kind.into()))
}

/// Why a file cannot be written.
pub fn cannot_write(path: &Path, error: &io::Error) -> Diagnostic {
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
}
