//! Tests of the core: everything below the screen.

mod bad_input;
mod common;
mod diagnosis;
mod disk_oracle;
mod mesh;
mod obj;
mod obj_texture;
mod obj_write;
mod polygon;
