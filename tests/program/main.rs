//! Tests of the program without a window: the command line, the session, views.
#![allow(clippy::unwrap_used, reason = "a helper that fails fails its test")]
#![allow(clippy::float_cmp, reason = "results are compared to the last bit on purpose")]

mod cli;
mod house;
mod session;
mod view;
