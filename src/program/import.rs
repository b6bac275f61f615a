//! Where imported files come from.
//!
//! Paths are relative to the importing file; those that start with `std/` name the embedded standard library, whatever the
//! importer. A file may be imported from many places, also in a circle: it is read once.

use std::fs;
use std::fs::File;
use std::io;
use std::io::Read;
use std::path::Component;
use std::path::Path;
use std::path::PathBuf;

/// Reads files for `import`.
pub trait Importer {
    /// The text of a file of at most `limit` bytes; of a larger one no more than that is read.
    ///
    /// # Errors
    /// Of kind [`io::ErrorKind::NotFound`] if there is no such file, [`io::ErrorKind::FileTooLarge`] if it is larger.
    fn read(&self, path: &Path, limit: usize) -> io::Result<String>;

    /// Names of the `.imp` files of a folder, for suggestions.
    fn names(&self, folder: &Path) -> Vec<String>;
}

/// Reads from the file system.
#[derive(Debug, Clone, Copy, Default)]
pub struct FileSystem;

impl Importer for FileSystem {
    fn read(&self, path: &Path, limit: usize) -> io::Result<String> {
        // Looked at before it is opened: a pipe without a writer would be waited for, and a device may have no end.
        if !fs::metadata(path)?.is_file() {
            return Err(io::Error::other(if path.is_dir() { "it is a folder" } else { "it is no regular file" }));
        }
        let mut text = String::new();
        File::open(path)?.take((limit as u64).saturating_add(1)).read_to_string(&mut text)?;
        if text.len() > limit { Err(io::ErrorKind::FileTooLarge.into()) } else { Ok(text) }
    }

    fn names(&self, folder: &Path) -> Vec<String> {
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
        let mut names: Vec<String> = entries
            .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
            .filter(|name| name.ends_with(".imp"))
            .collect();
        names.sort();
        names
    }
}

/// Knows no files: only the standard library can be imported.
#[derive(Debug, Clone, Copy, Default)]
pub struct Embedded;

impl Importer for Embedded {
    fn read(&self, _: &Path, _: usize) -> io::Result<String> {
        Err(io::Error::from(io::ErrorKind::NotFound))
    }

    fn names(&self, _: &Path) -> Vec<String> {
        Vec::new()
    }
}

/// The path that `import "path"` means in the file `from`, without `.` and, where possible, without `..`: one file, one
/// path.
pub(super) fn resolve_path(from: &str, path: &str) -> PathBuf {
    let joined = Path::new(from).parent().unwrap_or(Path::new("")).join(path);
    let mut result = PathBuf::new();
    for component in joined.components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir if matches!(result.components().next_back(), Some(Component::Normal(_))) => {
                result.pop();
            }
            other => result.push(other),
        }
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_relative_to_the_importing_file() {
        let table = [
            ("main.imp", "part.imp", "part.imp"),
            ("scenes/main.imp", "part.imp", "scenes/part.imp"),
            ("scenes/main.imp", "./a/../part.imp", "scenes/part.imp"),
            ("scenes/main.imp", "../part.imp", "part.imp"),
            ("main.imp", "../part.imp", "../part.imp"),
            ("/tmp/main.imp", "/lib/part.imp", "/lib/part.imp"),
        ];
        for (from, path, expected) in table {
            assert_eq!(resolve_path(from, path), Path::new(expected), "{path} from {from}");
        }
    }

    #[test]
    fn importers_say_what_is_missing() {
        assert_eq!(Embedded.read(Path::new("x.imp"), 9).unwrap_err().kind(), io::ErrorKind::NotFound);
        assert_eq!(FileSystem.read(Path::new("no/such/file.imp"), 9).unwrap_err().kind(), io::ErrorKind::NotFound);
        assert!(FileSystem.names(Path::new("no/such/folder")).is_empty());
    }

    #[test]
    fn no_more_is_read_than_allowed() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("part.imp");
        fs::write(&path, "let a = 1").unwrap();
        assert_eq!(FileSystem.read(&path, 9).unwrap(), "let a = 1");
        assert_eq!(FileSystem.read(&path, 8).unwrap_err().kind(), io::ErrorKind::FileTooLarge);
        assert!(FileSystem.read(folder.path(), 9).unwrap_err().to_string().contains("folder"));
    }

    #[cfg(unix)]
    #[test]
    fn devices_are_not_read() {
        assert!(FileSystem.read(Path::new("/dev/zero"), 9).unwrap_err().to_string().contains("no regular file"));
    }
}
