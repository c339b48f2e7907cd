//! Typed element indices: a vertex can never be mistaken for a face.
//!
//! Every index counts from 0, in file order, and is valid in one mesh only.

use std::fmt;

macro_rules! index_type {
    ($(#[$doc:meta])* $name:ident, $letter:literal) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
        #[cfg_attr(feature = "serde", serde(transparent))]
        pub struct $name(u32);

        impl $name {
            /// Index with this number. The mesh decides if the element exists.
            pub const fn new(index: u32) -> Self {
                Self(index)
            }

            /// Index of the element at this position of an array with one value per element.
            ///
            /// # Panics
            ///
            /// If the position is 2^32 or larger.
            pub fn from_index(index: usize) -> Self {
                Self(u32::try_from(index).expect("a mesh has fewer than 2^32 elements"))
            }

            /// Position in arrays with one value per element.
            pub const fn index(self) -> usize {
                self.0 as usize
            }

            /// Plain number for files and reports.
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
