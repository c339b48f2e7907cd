//! To be written.

mod picture;

pub use picture::Picture;
