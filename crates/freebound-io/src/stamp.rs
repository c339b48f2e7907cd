//! What tells one state of a file from another.

use std::fs::File;
use std::io::{self, BufReader};
use std::path::Path;

use sha2::{Digest, Sha256};

/// Bytes read at a time.
const BLOCK: usize = 256 << 10;

/// A file's length and checksum.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileStamp {
    /// Its length.
    pub bytes: u64,
    /// Its SHA-256, in hexadecimal digits.
    pub sha256: String,
}

impl FileStamp {
    /// Takes the stamp of a file as it is now.
    ///
    /// # Errors
    ///
    /// Where it cannot be read.
    pub fn read(path: &Path) -> io::Result<Self> {
        let mut digest = Sha256::new();
        let bytes = io::copy(&mut BufReader::with_capacity(BLOCK, File::open(path)?), &mut digest)?;
        Ok(Self { bytes, sha256: format!("{:x}", digest.finalize()) })
    }
}
