//! Tests of the core: everything below the screen.

mod common;
mod mesh;
mod view;
