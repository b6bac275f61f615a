//! The envelope of certificates: magic bytes that tell the kind, then a zlib stream of the content in postcard's encoding.

use std::io::Read;
use std::io::Write;

use flate2::Compression;
use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::diagnostic::Diagnostic;
use crate::diagnostic::code;

/// The largest unpacked content that is read: a damaged file must not exhaust memory.
const MAX_BYTES: u64 = 1 << 32;

/// The bytes of a file.
///
/// # Panics
/// If the content has no encoding: numbers, texts and lists have one.
pub fn seal(magic: &[u8], content: &impl Serialize) -> Vec<u8> {
    let plain = postcard::to_stdvec(content).expect("numbers and lists have an encoding");
    let mut encoder = ZlibEncoder::new(magic.to_vec(), Compression::fast());
    encoder.write_all(&plain).expect("memory takes all bytes");
    encoder.finish().expect("memory takes all bytes")
}

/// The content of a file.
///
/// # Errors
/// If the bytes are not a whole certificate of this kind (`E0507`).
pub fn open<T: DeserializeOwned>(magic: &[u8], bytes: &[u8]) -> Result<T, Diagnostic> {
    let damaged = || Diagnostic::error(code::NOT_A_CERTIFICATE, "this file is no certificate, or is damaged");
    let packed = bytes.strip_prefix(magic).ok_or_else(damaged)?;
    let mut plain = Vec::new();
    let mut decoder = ZlibDecoder::new(packed).take(MAX_BYTES);
    decoder.read_to_end(&mut plain).map_err(|_| damaged())?;
    match postcard::take_from_bytes(&plain) {
        Ok((content, [])) => Ok(content),
        Ok(_) | Err(_) => Err(damaged()),
    }
}
