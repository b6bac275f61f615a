//! Files as bytes, with messages that help to find the right one.

use std::fs::File;
use std::io;
use std::io::Read;
use std::path::Path;

use crate::diagnostic::Diagnostic;
use crate::diagnostic::FileId;
use crate::diagnostic::SourceMap;
use crate::diagnostic::code;
use crate::diagnostic::did_you_mean;
use crate::limits::Budget;
use crate::program::FileSystem;
use crate::program::Importer;

/// Files beyond this are refused: what is meant is another file, or a device that never ends. A certificate of a large
/// picture has tens of megabytes.
pub const MAX_BYTES: u64 = 1 << 30;

/// Adds a file to the sources.
///
/// # Errors
/// As [`bytes`], and if it is not text or more than may be read.
pub(super) fn load(sources: &mut SourceMap, path: &Path, budget: &Budget) -> Result<FileId, Diagnostic> {
    let bytes = at_most(path, budget.source_left() as u64)?;
    // Within what is left, as was asked.
    let _ = budget.source(bytes.len());
    let (file, fault) = sources.add_bytes(path.display().to_string(), &bytes);
    fault.map_or(Ok(file), Err)
}

/// The bytes of a file.
///
/// # Errors
/// If the file is missing (with the similar names of its folder), is a folder, is too large or cannot be read.
pub fn bytes(path: &Path) -> Result<Vec<u8>, Diagnostic> {
    at_most(path, MAX_BYTES)
}

fn at_most(path: &Path, limit: u64) -> Result<Vec<u8>, Diagnostic> {
    let name = path.display().to_string();
    if path.is_dir() {
        return Err(folder(path, &name));
    }
    let mut bytes = Vec::new();
    let read = File::open(path).and_then(|file| file.take(limit.saturating_add(1)).read_to_end(&mut bytes));
    match read {
        Err(error) => Err(unreadable(path, &name, &error)),
        Ok(_) if bytes.len() as u64 > limit => {
            Err(Diagnostic::error(code::FILE_TOO_LARGE, format!("`{name}` is larger than {} KiB", limit >> 10)))
        }
        Ok(_) => Ok(bytes),
    }
}

fn folder(path: &Path, name: &str) -> Diagnostic {
    let diagnostic = Diagnostic::error(code::CANNOT_OPEN, format!("`{name}` is a folder"));
    match FileSystem.names(path).first() {
        Some(first) => diagnostic.help(format!("name a file in it, such as `{}`", path.join(first).display())),
        None => diagnostic.help("name a file that holds a scene"),
    }
}

fn unreadable(path: &Path, name: &str, error: &io::Error) -> Diagnostic {
    if error.kind() != io::ErrorKind::NotFound {
        return Diagnostic::error(code::CANNOT_OPEN, format!("cannot read `{name}`: {error}"));
    }
    let folder = path.parent().unwrap_or(Path::new(""));
    if !folder.as_os_str().is_empty() && !folder.is_dir() {
        let title = format!("there is no file `{name}`, nor a folder `{}`", folder.display());
        return Diagnostic::error(code::CANNOT_OPEN, title);
    }
    let diagnostic = Diagnostic::error(code::CANNOT_OPEN, format!("there is no file `{name}`"));
    let scenes = FileSystem.names(folder);
    let wanted = path.file_name().unwrap_or_default().to_string_lossy();
    // The ending is what is left out most often.
    let near = scenes.iter().find(|scene| scene.strip_suffix(".imp") == Some(&wanted)).map(String::as_str);
    match near.or_else(|| did_you_mean(&wanted, scenes.iter().map(String::as_str))) {
        Some(near) => diagnostic.help(format!("did you mean `{}`?", folder.join(near).display())),
        None => diagnostic,
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::limits::Limits;

    fn message(path: &Path) -> String {
        let diagnostic = load(&mut SourceMap::default(), path, &Budget::new(&Limits::default())).unwrap_err();
        [vec![diagnostic.title], diagnostic.help].concat().join("; ").replace('\\', "/")
    }

    #[test]
    fn near_names_are_offered() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("torus.imp"), "x = 1").unwrap();
        for typed in ["torsu.imp", "torus", "Torus.imp"] {
            let path = folder.path().join(typed);
            if !path.exists() {
                assert!(message(&path).contains("/torus.imp`?"), "{}", message(&path));
            }
        }
        assert!(message(&folder.path().join("nothing/at/all.imp")).contains("nor a folder"));
        assert!(message(folder.path()).contains("such as"));
        let mut sources = SourceMap::default();
        let file = load(&mut sources, &folder.path().join("torus.imp"), &Budget::new(&Limits::default())).unwrap();
        assert_eq!(&*sources.get(file).text, "x = 1");
        fs::write(folder.path().join("latin.imp"), b"# caf\xe9").unwrap();
        assert!(message(&folder.path().join("latin.imp")).contains("UTF-8"));
    }

    #[cfg(unix)]
    #[test]
    fn endless_files_end() {
        assert!(message(Path::new("/dev/zero")).contains("larger than"));
    }
}
