//! The program: the editor and the command line over `freebound-core` and `freebound-io`.
//!
//! Modules are public so that the tests of this package reach them. Programs should depend on `freebound-core`.

#[cfg(feature = "gui")]
pub mod app;
pub mod cli;
pub mod examples;
#[cfg(feature = "gui")]
pub mod render;
pub mod session;
#[cfg(feature = "gui")]
pub mod ui;
pub mod view;
