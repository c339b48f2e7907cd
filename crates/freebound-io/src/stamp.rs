//! Stamp of a file, to tell one state of it from another.

use std::fs::File;
use std::io::{self, BufReader};
use std::path::Path;

use sha2::{Digest, Sha256};

/// Size of the read buffer, bytes.
const BLOCK: usize = 256 << 10;

/// Length and checksum of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileStamp {
    /// Length of the file, bytes.
    pub bytes: u64,
    /// SHA-256 of the file, in hexadecimal digits.
    pub sha256: String,
}

impl FileStamp {
    /// Computes the stamp of a file.
    ///
    /// # Errors
    ///
    /// If the file cannot be read.
    pub fn read(path: &Path) -> io::Result<Self> {
        let mut digest = Sha256::new();
        let bytes = io::copy(&mut BufReader::with_capacity(BLOCK, File::open(path)?), &mut digest)?;
        Ok(Self { bytes, sha256: format!("{:x}", digest.finalize()) })
    }
}
