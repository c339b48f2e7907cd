//! Tests of the core: everything below the screen.

mod common;
mod examples;
mod linalg;
mod mesh;
