//! Everything that needs no screen.

mod linalg;
mod linalg_mean_value;
