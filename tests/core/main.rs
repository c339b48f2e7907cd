//! Tests of the core: everything below the screen.

mod bad_input;
mod common;
mod mesh;
mod obj;

mod obj_write;
mod polygon;
