//! Argument for the number of threads, used by every command that solves.

use clap::Args;

/// Number of threads to use.
#[derive(Clone, Copy, Debug, Args)]
pub struct ThreadArguments {
    /// Number of threads. Default: all cores.
    #[arg(long = "threads", value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024), hide_short_help = true)]
    pub count: Option<u16>,
}
