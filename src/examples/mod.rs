//! Built-in meshes and a picture, made by code: no foreign mesh is part of the project.
//!
//! Every mesh is a disk of good triangles, counter-clockwise seen from outside, and the same at every call.

#![allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "counts and cell numbers come from small non-negative floats of our own making"
)]
#![allow(clippy::many_single_char_names, reason = "corners of a triangle are a, b, c and points p, q")]

mod caps;
mod cube;
mod delaunay;
mod face;
mod fill;
mod flat;
mod landmarks;
mod paint;
mod portrait;
mod random;
mod relief;
mod sculpt;

use crate::geom::Picture;
use crate::mesh::TriMesh;

pub use caps::bumpy_cap_of;
pub use landmarks::{Landmark, face_landmarks};
pub use portrait::portrait;

/// Width and height of the face's portrait, pixels.
const PORTRAIT_SIZE: u32 = 768;

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

impl Example {
    /// All examples, in the order of the menu.
    pub const ALL: [Self; 6] = [Self::Face, Self::Cube, Self::Ell, Self::Dome, Self::BumpyCap, Self::Spiral];

    /// Short name, fit for a file or the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Face => "face",
            Self::Cube => "cube",
            Self::Ell => "ell",
            Self::Dome => "dome",
            Self::BumpyCap => "bumpy-cap",
            Self::Spiral => "spiral",
        }
    }

    /// Words for a menu.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Face => "Face",
            Self::Cube => "Open cube",
            Self::Ell => "Flat L",
            Self::Dome => "Dome",
            Self::BumpyCap => "Bumpy cap",
            Self::Spiral => "Spiral strip",
        }
    }

    /// One sentence on what the example is good for.
    pub const fn about(self) -> &'static str {
        match self {
            Self::Face => "A smooth mask of a face with a wavy boundary, to be fitted to the painted portrait.",
            Self::Cube => "A cube without its bottom, after the paper's figure 3: sharp corners, irregular triangles.",
            Self::Ell => "A flat L in an irregular triangulation, which every linear method must return unchanged.",
            Self::Dome => "A cap below its equator, the gentlest surface that cannot lie flat without distortion.",
            Self::BumpyCap => "A bumpy ball open at the bottom, far past its equator, which needs real flattening.",
            Self::Spiral => {
                "A long thin strip wound into a flat spiral, hard on everything that counts on a compact shape."
            }
        }
    }

    /// Makes the mesh.
    pub fn mesh(self) -> TriMesh {
        match self {
            Self::Face => face::face(),
            Self::Cube => cube::cube(),
            Self::Ell => flat::ell(),
            Self::Dome => caps::dome(),
            Self::BumpyCap => caps::bumpy_cap(),
            Self::Spiral => flat::spiral(),
        }
    }

    /// Which of its vertices belong to which places of [`Self::picture`].
    pub fn landmarks(self) -> Vec<Landmark> {
        match self {
            Self::Face => face_landmarks(),
            _ => Vec::new(),
        }
    }

    /// The picture that is made for it.
    pub fn picture(self) -> Option<Picture> {
        match self {
            Self::Face => Some(portrait(PORTRAIT_SIZE)),
            _ => None,
        }
    }
}
