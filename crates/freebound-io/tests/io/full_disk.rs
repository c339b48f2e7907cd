//! Writers on a disk that is full after any number of bytes.

use std::io::{self, Write};

use freebound_io::{MeshFile, Precision, Texture, write_glb, write_obj, write_ply};
use freebound_testkit::{glb, grid, ply};

/// Writer of one file to a disk.
type Writer<'a> = Box<dyn Fn(&mut Disk) -> io::Result<()> + 'a>;

/// Disk with room for so many bytes.
struct Disk {
    room: usize,
    bytes: Vec<u8>,
}

impl Write for Disk {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let fits = bytes.len().min(self.room);
        if fits == 0 && !bytes.is_empty() {
            return Err(io::ErrorKind::StorageFull.into());
        }
        self.room -= fits;
        self.bytes.extend_from_slice(&bytes[..fits]);
        Ok(fits)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

fn mesh_and_texture() -> (MeshFile, Texture) {
    let sheet = grid(3, 2);
    let file = MeshFile::from(&sheet);
    let coordinates = sheet.positions.iter().map(|p| p.truncate() / 4.0).collect();
    let texture = Texture::per_vertex(&file.polygons, &coordinates);
    (file, texture)
}

#[test]
fn every_writer_says_that_the_disk_is_full_wherever_that_happens() {
    let (file, texture) = mesh_and_texture();
    let read = |bytes: &[u8]| freebound_io::read_stream(bytes).expect("a mesh");
    let of_ply = read(&ply::PlyMaker::rich(&file.polygons).bytes());
    let of_glb = read(&glb::plain(3, 5123).glb());
    let own = |mesh: &MeshFile| mesh.texture.clone().unwrap_or_default();
    let writers: [(&str, Writer<'_>); 6] = [
        ("OBJ", Box::new(|disk| write_obj(disk, &file, &texture))),
        ("PLY", Box::new(|disk| write_ply(disk, &file, &texture, Precision::F32))),
        ("PLY of 64 bits", Box::new(|disk| write_ply(disk, &file, &texture, Precision::F64))),
        ("GLB", Box::new(|disk| write_glb(disk, &file, &texture))),
        ("PLY as it was read", Box::new(|disk| write_ply(disk, &of_ply, &Texture::default(), Precision::F64))),
        ("GLB as it was read", Box::new(|disk| write_glb(disk, &of_glb, &own(&of_glb)))),
    ];
    for (name, write) in writers {
        let mut whole = Disk { room: usize::MAX, bytes: Vec::new() };
        write(&mut whole).expect("there is room");
        for room in 0..whole.bytes.len() {
            let mut disk = Disk { room, bytes: Vec::new() };
            let error = write(&mut disk).expect_err("the disk is full");
            assert_eq!(error.kind(), io::ErrorKind::StorageFull, "{name} after {room} bytes");
            assert_eq!(disk.bytes, whole.bytes[..room], "{name} after {room} bytes");
        }
    }
}
