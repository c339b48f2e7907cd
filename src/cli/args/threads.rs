//! How many threads do the work, of every command that solves.

use clap::Args;

/// How many threads do the work.
#[derive(Clone, Copy, Debug, Args)]
pub struct ThreadArguments {
    /// Threads to use; all cores without it.
    #[arg(long = "threads", value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub count: Option<u16>,
}
