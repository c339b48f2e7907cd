//! Typed element indices: a vertex can never be mistaken for a face.
//!
//! Every index counts from 0, in file order. It has a meaning in one mesh only.

use std::fmt;

macro_rules! index_type {
    ($(#[$doc:meta])* $name:ident, $letter:literal) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        #[cfg_attr(feature = "serde", serde(transparent))]
        pub struct $name(u32);

        impl $name {
            /// The element with this number. Whether it exists is for the mesh to say.
            pub const fn new(index: u32) -> Self {
                Self(index)
            }

            /// The element at this place of an array that holds one value per element.
            ///
            /// # Panics
            ///
            /// If the place is beyond the four thousand million elements that a mesh can have.
            pub fn from_index(index: usize) -> Self {
                Self(u32::try_from(index).expect("a mesh has fewer than 2^32 elements"))
            }

            /// Place in arrays that hold one value per element.
            pub const fn index(self) -> usize {
                self.0 as usize
            }

            /// The bare number, as files and reports show it.
            pub const fn number(self) -> u32 {
                self.0
            }
        }

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, concat!($letter, "{}"), self.0)
            }
        }
    };
}

index_type!(
    /// Index of a vertex.
    VertexId,
    "v"
);
index_type!(
    /// Index of an undirected edge, numbered by first appearance in the face list.
    EdgeId,
    "e"
);
index_type!(
    /// Index of a triangle.
    FaceId,
    "f"
);
index_type!(
    /// Index of a directed side of a triangle, or of the outer side of a boundary edge.
    HalfedgeId,
    "h"
);
