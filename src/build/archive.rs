//! Static libraries: objects with an index of their symbols, as `ar` writes them.

use std::io::Cursor;

use ar_archive_writer::ArchiveKind;
use ar_archive_writer::DEFAULT_OBJECT_READER;
use ar_archive_writer::NewArchiveMember;
use ar_archive_writer::write_archive_to_stream;

use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;

/// The bytes of a static library of objects by name. Times and owners are 0, so that the same objects give the same bytes.
///
/// # Errors
/// A fault of ours: an object that cannot be read back.
pub fn archive(objects: &[(String, Vec<u8>)]) -> Result<Vec<u8>, Diagnostic> {
    let member = |(name, bytes): &(String, Vec<u8>)| {
        NewArchiveMember::new(bytes.clone(), &DEFAULT_OBJECT_READER, format!("{name}.o"))
    };
    let members: Vec<NewArchiveMember> = objects.iter().map(member).collect();
    let mut out = Cursor::new(Vec::new());
    write_archive_to_stream(&mut out, &members, ArchiveKind::Gnu, false, None)
        .map_err(|error| Diagnostic::error(code::INTERNAL, format!("the static library cannot be written: {error}")))?;
    Ok(out.into_inner())
}
