//! Precision of the written coordinates.

use freebound_core::problem::{Labels, NamedOption};
use serde::Serialize;

/// Number of bits of a texture coordinate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Precision {
    /// 64 bits.
    #[default]
    F64,
    /// 32 bits, which most programs read.
    F32,
}

impl NamedOption for Precision {
    const ALL: &'static [Self] = &[Self::F64, Self::F32];

    fn labels(&self) -> Labels {
        match self {
            Self::F64 => Labels::new("f64", "64 bits").about("64 bits"),
            Self::F32 => Labels::new("f32", "32 bits").about("32 bits, as most programs read them"),
        }
    }
}
