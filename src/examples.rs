//! Built-in meshes and a picture, from the files of `assets/`. The project contains no mesh by others.
//!
//! `cargo run --release --example assets` generates the files; a test checks that they are up to date. Every mesh is
//! a disk of well-shaped triangles, counter-clockwise seen from outside.

use freebound_core::geom::Picture;
use freebound_core::mesh::{TriMesh, VertexId};
use freebound_io::{PictureFile, decode_picture, read_stream};
use freebound_run::Model;
use std::sync::Arc;

/// Built-in mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Example {
    /// Mask of a human face.
    Face,
    /// Cube without its bottom.
    Cube,
    /// Flat L.
    Ell,
    /// Spherical cap that reaches below the equator.
    Dome,
    /// Bumpy ball, open at the bottom.
    BumpyCap,
    /// Flat spiral strip.
    Spiral,
}

/// Vertex of the face mesh with its position in the portrait.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Landmark {
    /// Name of the landmark; left and right are the portrayed person's.
    pub name: &'static str,
    /// Vertex of [`Example::Face`] nearest to the landmark.
    pub vertex: VertexId,
    /// u and v in the portrait, v up.
    pub target: [f64; 2],
}

/// Data of a built-in mesh.
struct Entry {
    name: &'static str,
    title: &'static str,
    about: &'static str,
    obj: &'static [u8],
}

impl Example {
    /// All examples, in the order of the menu.
    pub const ALL: [Self; 6] = [Self::Face, Self::Cube, Self::Ell, Self::Dome, Self::BumpyCap, Self::Spiral];

    const fn entry(self) -> Entry {
        match self {
            Self::Face => Entry {
                name: "face",
                title: "Face",
                about: "A smooth mask of a face with a wavy boundary, to be fitted to the painted portrait.",
                obj: include_bytes!("../assets/face.obj"),
            },
            Self::Cube => Entry {
                name: "cube",
                title: "Open cube",
                about: "A cube without its bottom, after the paper's figure 3: sharp corners, irregular triangles.",
                obj: include_bytes!("../assets/cube.obj"),
            },
            Self::Ell => Entry {
                name: "ell",
                title: "Flat L",
                about: "A flat L in an irregular triangulation, which every linear method must return unchanged.",
                obj: include_bytes!("../assets/ell.obj"),
            },
            Self::Dome => Entry {
                name: "dome",
                title: "Dome",
                about: "A cap of a ball, smaller than a hemisphere: it cannot lie flat without distortion.",
                obj: include_bytes!("../assets/dome.obj"),
            },
            Self::BumpyCap => Entry {
                name: "bumpy-cap",
                title: "Bumpy cap",
                about: "A bumpy ball, open at the bottom and much larger than a hemisphere: hard to flatten.",
                obj: include_bytes!("../assets/bumpy-cap.obj"),
            },
            Self::Spiral => Entry {
                name: "spiral",
                title: "Spiral strip",
                about: "A long thin strip wound into a flat spiral: hard for methods that expect a compact shape.",
                obj: include_bytes!("../assets/spiral.obj"),
            },
        }
    }

    /// Short name for a file or the command line.
    pub const fn name(self) -> &'static str {
        self.entry().name
    }

    /// Title for a menu.
    pub const fn title(self) -> &'static str {
        self.entry().title
    }

    /// Sentence on the purpose of the example.
    pub const fn about(self) -> &'static str {
        self.entry().about
    }

    /// Reads the mesh.
    ///
    /// # Panics
    ///
    /// If the built-in file was damaged when the program was built.
    pub fn mesh(self) -> TriMesh {
        read_stream(self.entry().obj).expect("a test reads all built-in meshes").polygons.triangulate()
    }

    /// Vertices that belong to places of [`Self::picture`]; only the face has them.
    pub fn landmarks(self) -> Vec<Landmark> {
        match self {
            Self::Face => include_str!("../assets/face-landmarks.txt").lines().filter_map(landmark).collect(),
            _ => Vec::new(),
        }
    }

    /// Picture made for the example; only the face has one.
    ///
    /// # Panics
    ///
    /// If the built-in file was damaged when the program was built.
    pub fn picture(self) -> Option<Picture> {
        let portrait =
            || decode_picture(include_bytes!("../assets/portrait.png")).expect("a test decodes the portrait");
        (self == Self::Face).then(portrait)
    }

    /// Picture that belongs to the mesh, as if it came from a file.
    pub fn picture_file(self) -> Option<Arc<PictureFile>> {
        let pixels = Arc::new(self.picture()?);
        Some(Arc::new(PictureFile { name: "portrait".to_owned(), path: None, stamp: None, pixels }))
    }

    /// Model of the mesh, prepared for flattening.
    pub fn model(self) -> Model {
        Model::built_in(self.name(), self.title(), &self.mesh())
    }
}

/// Files of a built-in example, for tutorials and trials on the command line.
#[derive(Clone, Copy, Debug)]
pub struct ExampleFiles {
    /// Name of the example.
    pub name: &'static str,
    /// Sentence on the example.
    pub about: &'static str,
    /// Names and contents of the files; the mesh comes first.
    pub files: &'static [(&'static str, &'static [u8])],
}

macro_rules! asset {
    ($name:literal) => {
        ($name, include_bytes!(concat!("../assets/", $name)).as_slice())
    };
}

impl ExampleFiles {
    /// All examples: those of the window, and meshes that are no disks.
    pub const ALL: [Self; 9] = [
        Self {
            name: "face",
            about: Example::Face.about(),
            files: &[asset!("face.obj"), asset!("portrait.png"), asset!("face-landmarks.txt")],
        },
        Self { name: "cube", about: Example::Cube.about(), files: &[asset!("cube.obj")] },
        Self { name: "ell", about: Example::Ell.about(), files: &[asset!("ell.obj")] },
        Self { name: "dome", about: Example::Dome.about(), files: &[asset!("dome.obj")] },
        Self { name: "bumpy-cap", about: Example::BumpyCap.about(), files: &[asset!("bumpy-cap.obj")] },
        Self { name: "spiral", about: Example::Spiral.about(), files: &[asset!("spiral.obj")] },
        Self {
            name: "ball",
            about: "A closed, bumpy ball of quads, which must be cut before it is flattened.",
            files: &[asset!("ball.obj")],
        },
        Self {
            name: "scan",
            about: "The face with faults of a scan: three holes, a duplicate face and unreferenced vertices.",
            files: &[asset!("scan.obj")],
        },
        Self {
            name: "table",
            about: "A table of five closed boxes: several charts in one layout.",
            files: &[asset!("table.obj")],
        },
    ];
}

/// Parses a landmark from a line of a constraint file, "vertex u v # name"; `None` if the line is a comment.
fn landmark(line: &'static str) -> Option<Landmark> {
    let (numbers, name) = line.split_once('#')?;
    let mut numbers = numbers.split_whitespace();
    let vertex = VertexId::new(numbers.next()?.parse().ok()?);
    let mut coordinate = || numbers.next()?.parse().ok();
    Some(Landmark { name: name.trim(), vertex, target: [coordinate()?, coordinate()?] })
}
