//! Everything that needs no screen.

mod linalg;
