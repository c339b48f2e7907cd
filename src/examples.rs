//! Built-in meshes and a picture, from the files of `assets/`: no foreign mesh is part of the project.
//!
//! `cargo run --release --example assets` makes the files; a test says that they are what it makes. Every mesh is a disk of
//! good triangles, counter-clockwise seen from outside.

use freebound_core::geom::Picture;
use freebound_core::mesh::{TriMesh, VertexId};
use freebound_io::{decode_picture, read_stream};

/// A built-in mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Example {
    /// A mask of a human face.
    Face,
    /// A cube without its bottom.
    Cube,
    /// A flat L.
    Ell,
    /// A cap below its equator.
    Dome,
    /// A bumpy ball that is open at the bottom.
    BumpyCap,
    /// A flat spiral strip.
    Spiral,
}

/// A vertex of the face mesh and its place in the portrait.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Landmark {
    /// What it is; left and right are the person's.
    pub name: &'static str,
    /// The vertex of [`Example::Face`] nearest to it.
    pub vertex: VertexId,
    /// u and v of the portrait, v up.
    pub target: [f64; 2],
}

/// What is known of a built-in mesh.
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
                about: "A cap below its equator, the gentlest surface that cannot lie flat without distortion.",
                obj: include_bytes!("../assets/dome.obj"),
            },
            Self::BumpyCap => Entry {
                name: "bumpy-cap",
                title: "Bumpy cap",
                about: "A bumpy ball open at the bottom, far past its equator, which needs real flattening.",
                obj: include_bytes!("../assets/bumpy-cap.obj"),
            },
            Self::Spiral => Entry {
                name: "spiral",
                title: "Spiral strip",
                about: "A long thin strip wound into a flat spiral, hard on everything that counts on a compact shape.",
                obj: include_bytes!("../assets/spiral.obj"),
            },
        }
    }

    /// Short name, fit for a file or the command line.
    pub const fn name(self) -> &'static str {
        self.entry().name
    }

    /// Words for a menu.
    pub const fn title(self) -> &'static str {
        self.entry().title
    }

    /// One sentence on what the example is good for.
    pub const fn about(self) -> &'static str {
        self.entry().about
    }

    /// The mesh.
    ///
    /// # Panics
    ///
    /// If its file was damaged when the program was built.
    pub fn mesh(self) -> TriMesh {
        read_stream(self.entry().obj).expect("a test reads all built-in meshes").polygons.triangulate()
    }

    /// Which of its vertices belong to which places of [`Self::picture`].
    pub fn landmarks(self) -> Vec<Landmark> {
        match self {
            Self::Face => include_str!("../assets/face-landmarks.txt").lines().filter_map(landmark).collect(),
            _ => Vec::new(),
        }
    }

    /// The picture that is made for it.
    ///
    /// # Panics
    ///
    /// If its file was damaged when the program was built.
    pub fn picture(self) -> Option<Picture> {
        let portrait =
            || decode_picture(include_bytes!("../assets/portrait.png")).expect("a test decodes the portrait");
        (self == Self::Face).then(portrait)
    }
}

/// A landmark from its line of a constraint file, "vertex u v # name"; `None` where the line is a comment.
fn landmark(line: &'static str) -> Option<Landmark> {
    let (numbers, name) = line.split_once('#')?;
    let mut numbers = numbers.split_whitespace();
    let vertex = VertexId::new(numbers.next()?.parse().ok()?);
    let mut coordinate = || numbers.next()?.parse().ok();
    Some(Landmark { name: name.trim(), vertex, target: [coordinate()?, coordinate()?] })
}
