//! Picking, cameras and draw arrays.

pub(crate) mod cameras;
pub(crate) mod view_parts;
