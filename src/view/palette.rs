//! The colours that a renderer is given. The theme holds their values; shaders get them as uniforms.

/// A colour as designers write it: sRGB with straight alpha.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Srgb(pub [u8; 4]);

impl Srgb {
    /// An opaque colour from `0xRRGGBB`.
    pub const fn from_hex(hex: u32) -> Self {
        let [_, r, g, b] = hex.to_be_bytes();
        Self([r, g, b, 255])
    }

    /// The same colour with another opacity, 0 to 255.
    #[must_use]
    pub const fn with_alpha(self, alpha: u8) -> Self {
        let [r, g, b, _] = self.0;
        Self([r, g, b, alpha])
    }

    /// Linear light, straight alpha: what shaders compute with.
    pub fn to_linear(self) -> [f32; 4] {
        let [r, g, b, a] = self.0.map(|byte| f32::from(byte) / 255.0);
        [linear(r), linear(g), linear(b), a]
    }
}

/// The sRGB transfer function, IEC 61966-2-1.
fn linear(encoded: f32) -> f32 {
    if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// Colours of both panes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Palette {
    /// Behind everything.
    pub background: Srgb,
    /// Grid lines of the embedding; the stronger ones take it at full alpha.
    pub grid: Srgb,
    /// Outline of the unit square.
    pub unit_square: Srgb,
    /// The mesh's front.
    pub clay: Srgb,
    /// The mesh's back.
    pub clay_back: Srgb,
    /// Faces of the embedding, plain.
    pub plane_face: Srgb,
    /// Where faces of the embedding lie over each other the picture is mixed with this.
    pub overlap: Srgb,
    /// The two colours of the checker.
    pub checker: [Srgb; 2],
    /// Wireframe.
    pub wire: Srgb,
    /// Flipped faces.
    pub flipped: Srgb,
}
