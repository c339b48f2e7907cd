//! Number of threads of a run.

use super::args::ThreadArguments;
use super::error::CommandError;

/// Sets the number of threads.
pub(super) fn set_threads(threads: ThreadArguments) -> Result<(), CommandError> {
    let Some(count) = threads.count else { return Ok(()) };
    rayon::ThreadPoolBuilder::new()
        .num_threads(count.into())
        .build_global()
        .map_err(|error| CommandError::Usage(format!("--threads: cannot run {count} threads: {error}")))
}
