//! Tests of the core: everything below the screen.

mod bad_input;
mod common;
mod examples;
mod linalg;
mod distortion;
mod mesh;
mod verdict;
mod verdict_cases;
mod verdict_oracle;
mod verdict_random;
mod diagnosis;
mod disk_oracle;
mod mesh;
mod obj;
mod obj_texture;
mod obj_write;
mod polygon;
