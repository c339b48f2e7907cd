//! Reads any bytes as a mesh file of any format: accepted or refused, repaired if possible, and written again.
#![no_main]

use freebound_io::{Texture, read_stream, write_obj};
use freebound_core::mesh::Preparation;
use libfuzzer_sys::fuzz_target;

/// Corner limit: larger meshes only take longer.
const MOST_CORNERS: usize = 3_000;

fuzz_target!(|bytes: &[u8]| {
    let Ok(file) = read_stream(bytes) else { return };
    // Numbers that are not finite are accepted by the reader, for the diagnosis, and refused by the writer.
    let are_finite = file.polygons.positions.iter().all(|at| at.is_finite());
    let texture = file.texture.clone().unwrap_or_default();
    if file.polygons.corners.len() > MOST_CORNERS || !are_finite || !texture.coordinates.iter().all(|uv| uv.is_finite()) {
        return;
    }
    write_obj(&mut Vec::new(), &file, &texture).expect("memory takes all");
    drop(file.texture_mesh());
    let repaired = Preparation::default().with_all_repairs().repaired(&file.polygons);
    let coordinates = repaired.polygons().positions.iter().map(|at| at.truncate()).collect();
    let texture = Texture::of_repaired(&repaired, &file.polygons, &coordinates);
    write_obj(&mut Vec::new(), &file, &texture).expect("memory takes all");
});
