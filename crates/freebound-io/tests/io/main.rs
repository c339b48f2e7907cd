//! Tests of reading and writing files.
#![allow(clippy::unwrap_used, reason = "a helper that fails fails its test")]
#![allow(clippy::float_cmp, reason = "results are compared to the last bit on purpose")]

mod bad_input;
mod bake;
mod corner_data;
mod formats;
mod full_disk;
mod gltf_hostile;
mod gltf_pictures;
mod gltf_read;
mod gltf_write;
mod obj;
mod obj_large;
mod obj_texture;
mod obj_write;
mod odd_obj;
mod raster;
