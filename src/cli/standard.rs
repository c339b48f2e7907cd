//! `-` as a file: the mesh from standard input, a result to standard output.

use std::io::{self, Read, stdin};
use std::path::Path;
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::thread::Builder;
use std::time::Duration;

use super::Failure;
use super::progress::is_interrupted;
use crate::io::{ReadError, check_memory, machine_memory_bytes};
use crate::session::Model;

/// What a mesh from standard input is called.
const STANDARD_INPUT: &str = "standard input";

/// Bytes read at once.
const CHUNK: usize = 256 << 10;

/// Time between two looks whether to stop, while nothing comes.
const TICK: Duration = Duration::from_millis(20);

/// Whether a path stands for standard input or output.
pub(super) fn is_standard(path: &Path) -> bool {
    path == Path::new("-")
}

/// What a mesh is called in messages.
pub(super) fn name_of_input(path: &Path) -> String {
    if is_standard(path) { STANDARD_INPUT.to_owned() } else { path.display().to_string() }
}

/// Which files are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sizes {
    /// Those that half of the machine's memory is enough for.
    WithinMemory,
    /// All.
    Any,
}

impl Sizes {
    /// As `--large` says.
    pub(super) const fn typed(large: bool) -> Self {
        if large { Self::Any } else { Self::WithinMemory }
    }
}

/// Reads a mesh from a file or from standard input. It has no form yet.
pub(super) fn read_model(path: &Path, sizes: Sizes) -> Result<Model, Failure> {
    if sizes == Sizes::WithinMemory && !is_standard(path) {
        let large = |shortage| Failure::Memory { path: name_of_input(path), shortage };
        check_memory(path, machine_memory_bytes()).map_err(large)?;
    }
    let read = if is_standard(path) { read_standard_input() } else { Model::read_formless(path, &is_interrupted) };
    read.map_err(|error| Failure::Read { path: name_of_input(path), error })
}

fn read_standard_input() -> Result<Model, ReadError> {
    let read = Model::read_stream(STANDARD_INPUT, Input::begin()?, &is_interrupted);
    // An interrupted stream ends early: what came of it is not the mesh.
    if is_interrupted() { Err(ReadError::Cancelled) } else { read }
}

/// Standard input, read on a thread of its own, so that an interrupt is heard while nothing comes. It ends where the
/// stream does or the user asks to stop.
struct Input {
    chunks: Receiver<io::Result<Vec<u8>>>,
    chunk: io::Cursor<Vec<u8>>,
}

impl Input {
    fn begin() -> io::Result<Self> {
        let (sender, chunks) = sync_channel(1);
        // It may wait for ever for what never comes: the end of the process ends it.
        Builder::new().name("standard input".to_owned()).spawn(move || hand_on(&sender))?;
        Ok(Self { chunks, chunk: io::Cursor::default() })
    }
}

/// Hands on what comes until the stream ends, breaks off, or nobody listens.
fn hand_on(sender: &SyncSender<io::Result<Vec<u8>>>) {
    let mut input = stdin().lock();
    loop {
        let mut bytes = vec![0; CHUNK];
        let read = input.read(&mut bytes);
        let goes_on = match &read {
            Ok(count) => *count > 0,
            Err(error) => error.kind() == io::ErrorKind::Interrupted,
        };
        let chunk = read.map(|count| {
            bytes.truncate(count);
            bytes
        });
        if sender.send(chunk).is_err() || !goes_on {
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
