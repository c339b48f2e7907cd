//! A picture in memory.

/// A picture of 8-bit sRGB colours with opacity, row by row from the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Red, green, blue, opacity of each pixel: 4 × width × height bytes.
    pub pixels: Vec<u8>,
}

impl Picture {
    /// A picture of one colour.
    pub fn filled(width: u32, height: u32, colour: [u8; 4]) -> Self {
        Self { width, height, pixels: colour.repeat(width as usize * height as usize) }
    }

    /// Colour of a pixel, `None` outside the picture.
    pub fn pixel(&self, x: u32, y: u32) -> Option<[u8; 4]> {
        if x >= self.width || y >= self.height {
            return None;
        }
        let at = 4 * (y as usize * self.width as usize + x as usize);
        Some([self.pixels[at], self.pixels[at + 1], self.pixels[at + 2], self.pixels[at + 3]])
    }

    /// This picture on the left, another on the right, top aligned; white where one is less high.
    #[must_use]
    pub fn beside(&self, right: &Self) -> Self {
        let mut both = Self::filled(self.width + right.width, self.height.max(right.height), [255; 4]);
        let row = 4 * both.width as usize;
        for (part, start) in [(self, 0), (right, 4 * self.width as usize)] {
            let length = 4 * part.width as usize;
            if length == 0 {
                continue;
            }
            for (y, source) in part.pixels.chunks_exact(length).enumerate() {
                both.pixels[y * row + start..y * row + start + length].copy_from_slice(source);
            }
        }
        both
    }
}
