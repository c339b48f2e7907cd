//! `-` as a file: the mesh from standard input, a result to standard output.

use std::io::{self, Read, stdin};
use std::path::Path;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::thread::Builder;
use std::time::Duration;

use super::args::ReadingArguments;
use super::error::{CommandError, STANDARD_INPUT, is_standard, name_of_input};
use super::progress::is_interrupted;
use crate::session::Model;
use freebound_io::{ReadError, ReadOptions, check_memory, machine_memory_bytes};

/// Maximum number of bytes of one read.
const CHUNK: usize = 256 << 10;

/// Interval of checks for an interrupt while no input arrives.
const TICK: Duration = Duration::from_millis(20);

/// Size limit of files to read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum MemoryLimit {
    /// Files that need at most half of the machine's memory.
    WithinMemory,
    /// All files.
    Any,
}

impl MemoryLimit {
    /// Limit for the value of `--large`.
    pub(super) const fn typed(large: bool) -> Self {
        if large { Self::Any } else { Self::WithinMemory }
    }
}

/// Reads a mesh from a file or from standard input. The mesh is not prepared yet.
pub(super) fn read_model(path: &Path, sizes: MemoryLimit, options: ReadOptions) -> Result<Model, CommandError> {
    if sizes == MemoryLimit::WithinMemory && !is_standard(path) {
        let large = |shortage| CommandError::Memory { path: name_of_input(path), shortage };
        check_memory(path, machine_memory_bytes()).map_err(large)?;
    }
    let read = if is_standard(path) {
        read_standard_input(options)
    } else {
        Model::read_formless(path, options, &is_interrupted)
    };
    read.map_err(|error| CommandError::Read { path: name_of_input(path), error })
}

/// Reads a mesh with the limits and choices of the command line.
pub(super) fn read_typed(path: &Path, reading: ReadingArguments) -> Result<Model, CommandError> {
    read_model(path, MemoryLimit::typed(reading.large), reading.options())
}

fn read_standard_input(options: ReadOptions) -> Result<Model, ReadError> {
    let read = Model::read_stream(STANDARD_INPUT, Input::begin()?, options, &is_interrupted);
    // An interrupted stream ends early, so its mesh is incomplete.
    if is_interrupted() { Err(ReadError::Cancelled) } else { read }
}

/// Standard input, read on a separate thread, so that an interrupt is noticed while no input arrives. The stream ends
/// at its end or when the user interrupts.
struct Input {
    chunks: Receiver<io::Result<Vec<u8>>>,
    chunk: io::Cursor<Vec<u8>>,
}

impl Input {
    fn begin() -> io::Result<Self> {
        let (sender, chunks) = sync_channel(1);
        // The thread may wait forever for input. The end of the process ends it.
        Builder::new().name("standard input".to_owned()).spawn(move || hand_on(&sender))?;
        Ok(Self { chunks, chunk: io::Cursor::default() })
    }
}

/// Sends chunks of standard input until the stream ends, fails, or the receiver is gone.
fn hand_on(sender: &SyncSender<io::Result<Vec<u8>>>) {
    let mut input = stdin().lock();
    loop {
        let mut bytes = vec![0; CHUNK];
        let read = input.read(&mut bytes);
        let is_continued = match &read {
            Ok(count) => *count > 0,
            Err(error) => error.kind() == io::ErrorKind::Interrupted,
        };
        let chunk = read.map(|count| {
            bytes.truncate(count);
            bytes
        });
        if sender.send(chunk).is_err() || !is_continued {
            return;
        }
    }
}

impl Read for Input {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        loop {
            let count = self.chunk.read(buffer)?;
            if count > 0 || is_interrupted() {
                return Ok(count);
            }
            match self.chunks.recv_timeout(TICK) {
                Ok(chunk) => self.chunk = io::Cursor::new(chunk?),
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return Ok(0),
            }
        }
    }
}
