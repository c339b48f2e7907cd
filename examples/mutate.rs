//! Reads mutated mesh files of every format and says what went wrong: `cargo run --release --example mutate -- COUNT [SEED]`.
//!
//! Seeds are small files that the project writes itself. Every mutation is read; what can be read is diagnosed, prepared,
//! judged and written in all formats, and small disks are flattened. Nothing may panic, and nothing may take longer than
//! five seconds. A finding is printed with its seed and left as `finding-SEED.EXTENSION`; the exit status is then 1.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use freebound_core::cutting::SeamOptions;
use freebound_core::mesh::{Preparation, Repairs};
use freebound_core::pipeline::PreparedMesh;
use freebound_core::verify::{LayoutOptions, PlaneLayout, layout_verdict};
use freebound_core::{PipelineOptions, unwrap};
use freebound_io::{MeshFile, Precision, Texture, read_stream, write_glb, write_obj, write_ply};
use freebound_testkit::mutation::mutated;
use freebound_testkit::{glb, grid, ply};

/// Longest time that a file may take. The search for a packing takes up to a second, however few charts there are.
const LIMIT: Duration = Duration::from_secs(5);

/// Largest number of faces of a mesh that is flattened.
const FEW: usize = 40;

/// Share of the meshes that are flattened: one in so many.
const FLATTENED: u64 = 16;

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1).map(|word| word.parse::<u64>().expect("a number"));
    let (count, first) = (arguments.next().unwrap_or(100_000), arguments.next().unwrap_or(0));
    std::panic::set_hook(Box::new(|_| {}));
    let seeds = seeds();
    let (next, findings, read) = (AtomicU64::new(first), AtomicU64::new(0), AtomicU64::new(0));
    let work = || {
        loop {
            let seed = next.fetch_add(1, Ordering::Relaxed);
            if seed >= first + count {
                return;
            }
            let (extension, file) = &seeds[usize::try_from(seed % seeds.len() as u64).expect("few seeds")];
            let bytes = mutated(file, seed);
            let begin = Instant::now();
            let what = match catch_unwind(AssertUnwindSafe(|| examine(&bytes, seed))) {
                Err(panic) => Some(format!("panic: {}", words_of(&*panic))),
                Ok(_) if begin.elapsed() > LIMIT => Some(format!("{:.1} s", begin.elapsed().as_secs_f64())),
                Ok(was_read) => {
                    read.fetch_add(u64::from(was_read), Ordering::Relaxed);
                    None
                }
            };
            if let Some(what) = what {
                findings.fetch_add(1, Ordering::Relaxed);
                let name = format!("finding-{seed}.{extension}");
                println!("{name}: {what}");
                if let Err(error) = std::fs::write(&name, &bytes) {
                    println!("{name}: {error}");
                }
            }
        }
    };
    std::thread::scope(|scope| {
        let workers = std::thread::available_parallelism().map_or(1, usize::from);
        (0..workers).for_each(|_| drop(scope.spawn(work)));
    });
    let (findings, read) = (findings.into_inner(), read.into_inner());
    println!("{count} mutations of {} files, seeds from {first}: {read} read, {findings} findings", seeds.len());
    ExitCode::from(u8::from(findings > 0))
}

/// Message of a panic.
fn words_of(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().cloned();
    text.or_else(|| panic.downcast_ref::<&str>().map(|text| (*text).to_owned())).unwrap_or_default()
}

/// Reads a file and puts the mesh through the pipeline. Returns true if the file can be read.
fn examine(bytes: &[u8], seed: u64) -> bool {
    let Ok(mesh) = read_stream(bytes) else { return false };
    let form = Preparation { repair: Repairs::ALL, cut: true, ..Preparation::default() };
    let prepared = PreparedMesh::new(&mesh.polygons, None, form);
    if let Ok((texture, bare)) = mesh.partial_texture_mesh() {
        let groups = Vec::new();
        let layout =
            PlaneLayout { mesh: &texture.mesh, coordinates: &texture.embedding, groups: &groups, bare_faces: &bare };
        layout_verdict(layout, LayoutOptions::default());
    }
    if seed.is_multiple_of(FLATTENED) && mesh.polygons.face_count() <= FEW {
        let distortion = seed.is_multiple_of(2 * FLATTENED).then_some(SeamOptions::DISTORTION);
        let options = PipelineOptions { preparation: prepared.form, distortion, ..PipelineOptions::default() };
        // A failure names its reason.
        let _ = unwrap(&mesh.polygons, &options);
    }
    let own = mesh.texture.clone().unwrap_or_default();
    for texture in [&own, &Texture::default()] {
        write_all(&mesh, texture);
    }
    true
}

/// Writes a mesh in every format, and reads what was written. No run writes a mesh whose positions are not finite.
fn write_all(mesh: &MeshFile, texture: &Texture) {
    if !mesh.polygons.positions.iter().all(|position| position.is_finite()) {
        return;
    }
    let [mut obj, mut ply, mut ply_of_32_bits, mut glb] = [const { Vec::new() }; 4];
    for (format, is_written, bytes) in [
        ("OBJ", write_obj(&mut obj, mesh, texture).is_ok(), &obj),
        ("PLY", write_ply(&mut ply, mesh, texture, Precision::F64).is_ok(), &ply),
        ("PLY of 32 bits", write_ply(&mut ply_of_32_bits, mesh, texture, Precision::F32).is_ok(), &ply_of_32_bits),
        ("GLB", write_glb(&mut glb, mesh, texture).is_ok(), &glb),
    ] {
        if is_written
            && mesh.polygons.face_count() > 0
            && let Err(error) = read_stream(&bytes[..])
        {
            panic!("{format} cannot be read again: {error}");
        }
    }
}

/// Small files of every format and encoding, with their extensions.
fn seeds() -> Vec<(&'static str, Vec<u8>)> {
    let sheet = grid(3, 2);
    let file = MeshFile::from(&sheet);
    let coordinates = sheet.positions.iter().map(|p| p.truncate() / 4.0).collect();
    let texture = Texture::per_vertex(&file.polygons, &coordinates);
    let mut obj = Vec::new();
    write_obj(&mut obj, &file, &texture).expect("a small file");
    let (mut ply_file, mut glb_file) = (Vec::new(), Vec::new());
    write_ply(&mut ply_file, &file, &texture, Precision::F64).expect("a small file");
    write_glb(&mut glb_file, &file, &texture).expect("a small file");
    vec![
        ("obj", obj),
        ("obj", OBJ.into()),
        ("ply", ply_file),
        ("ply", ply::PlyMaker::rich(&file.polygons).bytes()),
        ("ply", PLY.into()),
        ("ply", STRIPS.into()),
        ("off", OFF.into()),
        ("stl", STL.into()),
        ("stl", binary_stl(&sheet)),
        ("glb", glb_file),
        ("glb", glb::plain(3, 5123).glb()),
    ]
}

/// Text with all that an OBJ file can have: groups, materials, normals, negative indices, polygons, continued lines.
const OBJ: &str = "mtllib a.mtl\no thing\nv 0 0 0\nv 1 0 0 0.5 0.5 0.5\nv 1 1 0\nv 0 1 0\nv 2 0 1e-3\nvt 0 0\nvt 1 0\n\
                   vt 1 1\nvn 0 0 1\ng first\nusemtl red\ns 1\nf 1/1/1 2/2/1 3/3/1 4/3/1\ng second\nusemtl blue\n\
                   f 2//1 5//1 3//1\nf -4 -1 \\\n -3\nl 1 2 3\np 1\n# end\n";

/// ASCII file with colours and lists of texture coordinates.
const PLY: &str = "ply\nformat ascii 1.0\ncomment made here\nelement vertex 4\nproperty float x\nproperty float y\n\
                   property float z\nproperty uchar red\nelement face 2\nproperty list uchar int vertex_indices\n\
                   property list uchar float texcoord\nend_header\n0 0 0 255\n1 0 0 0\n1 1 0 7\n0 1 0 9\n\
                   3 0 1 2 6 0 0 1 0 1 1\n3 0 2 3 6 0 0 1 1 0 1\n";

/// ASCII file with triangle strips.
const STRIPS: &str = "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n\
                      element tristrips 1\nproperty list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n\
                      1 1 0\n0 2 0\n7 0 1 2 3 -1 2 4\n";

const OFF: &str = "OFF\n# a comment\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2\n3 0 2 3 255 0 0\n";

const STL: &str = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n\
                   facet normal 0 0 1\nouter loop\nvertex 1 0 0\nvertex 1 1 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n";

fn binary_stl(mesh: &freebound_core::mesh::TriMesh) -> Vec<u8> {
    let mut bytes = vec![b' '; 80];
    bytes.extend(u32::try_from(mesh.face_count()).expect("few").to_le_bytes());
    for triangle in &mesh.triangles {
        bytes.extend([0_u8; 12]);
        for vertex in triangle {
            bytes.extend(mesh.positions[vertex.index()].as_vec3().to_array().iter().flat_map(|x| x.to_le_bytes()));
        }
        bytes.extend([0_u8; 2]);
    }
    bytes
}
