//! Container of a glTF file: its JSON, and the concatenated bytes of all its buffers.

use std::collections::HashMap;
use std::fs::File;
use std::io::{Error, ErrorKind, Read};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use base64::Engine as _;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};

use super::document::{Buffer, Document};
use crate::mesh_file::{FaultPlace, ParseFaultKind, ReadError, fault_at, fault_in};
use crate::obj::split_mark;

/// First bytes of a GLB file, and types of its chunks.
pub(super) const MAGIC: &[u8; 4] = b"glTF";
pub(super) const JSON: &[u8; 4] = b"JSON";
pub(super) const BINARY: &[u8; 4] = b"BIN\0";

/// Size of the header of a file and of a chunk, bytes.
pub(super) const FILE_HEAD: usize = 12;
pub(super) const CHUNK_HEAD: usize = 8;

/// Alignment of buffers, bytes.
pub(super) const ALIGNMENT: usize = 8;

/// Maximum number of buffers that may name one file.
const NAMED: usize = 16;

/// Decoder for base64, with or without padding.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// Ranges of the JSON and of the binary chunk, if there is one.
pub(super) struct Chunks {
    pub(super) json: Range<usize>,
    pub(super) binary: Option<Range<usize>>,
}

impl Chunks {
    /// Finds the chunks of a file.
    pub(super) fn of(bytes: &[u8]) -> Result<Self, ReadError> {
        if !bytes.starts_with(MAGIC) {
            let (mark, _) = split_mark(bytes);
            return Ok(Self { json: mark.len()..bytes.len(), binary: None });
        }
        if number(bytes, 4)? != 2 {
            return Err(ReadError::NotReadYet("glTF of a version other than 2"));
        }
        let length = number(bytes, 8)?;
        if length > bytes.len() {
            let kind = ParseFaultKind::TooMany { element: "byte".to_owned(), count: length as u64 };
            return Err(fault_at(FaultPlace::Byte(8), kind));
        }
        let mut at = FILE_HEAD;
        let json = chunk(&bytes[..length], at, *JSON)?.ok_or_else(|| {
            let expected = "a JSON chunk";
            fault_at(
                FaultPlace::Byte(FILE_HEAD as u64),
                ParseFaultKind::Unexpected { found: "a chunk".to_owned(), expected },
            )
        })?;
        at = json.end;
        let binary = if at + CHUNK_HEAD <= length { chunk(&bytes[..length], at, *BINARY)? } else { None };
        Ok(Self { json, binary })
    }

    /// JSON and binary chunk of a file. The chunk is empty if there is none.
    pub(super) fn split(mut bytes: Vec<u8>) -> Result<(Vec<u8>, Vec<u8>), ReadError> {
        let Self { json, binary } = Self::of(&bytes)?;
        let json = bytes[json].to_vec();
        let Some(range) = binary else { return Ok((json, Vec::new())) };
        bytes.truncate(range.end);
        bytes.drain(..range.start);
        Ok((json, bytes))
    }
}

/// Content of the chunk at an offset; `None` if it has another type.
fn chunk(bytes: &[u8], at: usize, kind: [u8; 4]) -> Result<Option<Range<usize>>, ReadError> {
    let length = number(bytes, at)?;
    let begin = at + CHUNK_HEAD;
    let Some(end) = begin.checked_add(length).filter(|&end| end <= bytes.len()) else {
        let kind = ParseFaultKind::TooMany { element: "byte".to_owned(), count: length as u64 };
        return Err(fault_at(FaultPlace::Byte(at as u64), kind));
    };
    Ok((bytes[at + 4..begin] == kind).then_some(begin..end))
}

/// 32-bit number at an offset. Fails unless the 8 bytes of a chunk header fit there; at offset 8 of the file, 4
/// suffice.
fn number(bytes: &[u8], at: usize) -> Result<usize, ReadError> {
    let end = || fault_at(FaultPlace::Byte(bytes.len() as u64), ParseFaultKind::EndsEarly);
    let four = bytes.get(at..at + CHUNK_HEAD).or_else(|| bytes.get(at..at + 4).filter(|_| at == 8)).ok_or_else(end)?;
    let four = four[..4].try_into().expect("four bytes");
    Ok(u32::from_le_bytes(four) as usize)
}

/// Concatenated bytes of all buffers, and the offset of each.
#[derive(Debug)]
pub(super) struct Buffers {
    pub(super) bytes: Arc<Vec<u8>>,
    pub(super) starts: Vec<usize>,
}

impl Buffers {
    /// Collects the buffers: from the binary chunk, from the JSON, from files in the folder.
    pub(super) fn of(document: &Document, binary: Vec<u8>, folder: Option<&Path>) -> Result<Self, ReadError> {
        let (mut bytes, mut starts) = (Vec::new(), Vec::new());
        let mut binary = Some(binary);
        let mut names: HashMap<&str, usize> = HashMap::new();
        for (index, buffer) in document.buffers.iter().enumerate() {
            let found = match &buffer.uri {
                // The binary chunk is the first buffer, if it has no address.
                None => binary.take().filter(|chunk| index == 0 && !chunk.is_empty()),
                Some(uri) => {
                    let times = names.entry(uri).or_default();
                    *times += 1;
                    if *times > NAMED {
                        let error = Error::new(ErrorKind::InvalidData, format!("more than {NAMED} buffers have it"));
                        return Err(beside_fault(uri, index, error));
                    }
                    Some(of_uri(uri, buffer, index, folder)?)
                }
            };
            let missing = || ReadError::Beside {
                buffer: index,
                uri: "its content".to_owned(),
                source: Error::from(ErrorKind::NotFound),
            };
            let mut found = found.ok_or_else(missing)?;
            let length = usize::try_from(buffer.byte_length).ok().filter(|&length| length <= found.len());
            found.truncate(length.ok_or_else(|| {
                fault_in(
                    "buffer",
                    index,
                    ParseFaultKind::TooMany { element: "byte".to_owned(), count: buffer.byte_length },
                )
            })?);
            bytes.resize(bytes.len().next_multiple_of(ALIGNMENT), 0);
            starts.push(bytes.len());
            if bytes.is_empty() {
                bytes = found;
            } else {
                bytes.extend(found);
            }
        }
        Ok(Self { bytes: Arc::new(bytes), starts })
    }
}

fn beside_fault(uri: &str, buffer: usize, source: Error) -> ReadError {
    ReadError::Beside { buffer, uri: uri.chars().take(80).collect(), source }
}

fn of_uri(uri: &str, buffer: &Buffer, index: usize, folder: Option<&Path>) -> Result<Vec<u8>, ReadError> {
    let fault = |source: Error| beside_fault(uri, index, source);
    if let Some(bytes) = embedded(uri) {
        return bytes.map_err(fault);
    }
    let folder = folder.ok_or_else(|| fault(Error::new(ErrorKind::NotFound, "standard input has no folder")))?;
    let path =
        beside(uri, folder).ok_or_else(|| fault(Error::new(ErrorKind::NotFound, "not a file beside this one")))?;
    read_at_most(&path, buffer.byte_length).map_err(fault)
}

/// Bytes within an address; `None` for an address of a file.
pub(super) fn embedded(uri: &str) -> Option<Result<Vec<u8>, Error>> {
    let data = uri.strip_prefix("data:")?;
    let text = data.split_once(";base64,").map(|(_, text)| text);
    let text = text.ok_or_else(|| Error::new(ErrorKind::InvalidData, "not base64"));
    Some(text.and_then(|text| BASE64.decode(text).map_err(|error| Error::new(ErrorKind::InvalidData, error))))
}

/// Path of the file at a relative address; `None` for an absolute one.
pub(super) fn beside(uri: &str, folder: &Path) -> Option<PathBuf> {
    let path = PathBuf::from(unescaped(uri)?);
    let is_elsewhere = uri.contains(':') || path.is_absolute() || uri.starts_with(['/', '\\']);
    (!is_elsewhere).then(|| folder.join(path))
}

/// Decodes percent escapes, such as `%20`.
fn unescaped(uri: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let Some((&first, behind)) = rest.split_first() {
        let escaped = behind.get(..2).filter(|_| first == b'%').and_then(|two| std::str::from_utf8(two).ok());
        let code = escaped.and_then(|two| u8::from_str_radix(two, 16).ok());
        bytes.push(code.unwrap_or(first));
        rest = &behind[if code.is_some() { 2 } else { 0 }..];
    }
    String::from_utf8(bytes).ok()
}

/// First `length` bytes of a file. Fails if it is shorter or not a regular file.
fn read_at_most(path: &Path, length: u64) -> Result<Vec<u8>, Error> {
    let file = File::open(path)?;
    let data = file.metadata()?;
    if !data.is_file() {
        return Err(Error::new(ErrorKind::InvalidData, "not a regular file"));
    }
    if data.len() < length {
        return Err(Error::new(ErrorKind::UnexpectedEof, format!("it has {} bytes, not {length}", data.len())));
    }
    let mut bytes = Vec::new();
    file.take(length).read_to_end(&mut bytes)?;
    Ok(bytes)
}
