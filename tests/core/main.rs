//! Tests of the core: everything below the screen.

mod common;
mod examples;
mod linalg;
mod distortion;
mod mesh;
mod verdict;
mod verdict_cases;
mod verdict_oracle;
mod verdict_random;
