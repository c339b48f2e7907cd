//! How texture coordinates lie in the plane where angles are measured.
//!
//! Pictures are not square: a picture of w × h pixels covers the unit square of u and v, but angles and energies are
//! measured at (u·w/h, v), so that what is conformal is conformal on the picture. And v runs up, as in OBJ files, or
//! down, as in image files; the plane's y always runs up, so that the picture stands upright in it.

use glam::DVec2;

/// Where v = 0 is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum VAxis {
    /// At the picture's lower edge, as OBJ files have it.
    #[default]
    Up,
    /// At its upper edge.
    Down,
}

/// The map from u and v to the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PictureFrame {
    /// Width of the picture over its height.
    pub aspect: f64,
    /// Where v = 0 is.
    pub v_axis: VAxis,
}

impl Default for PictureFrame {
    fn default() -> Self {
        Self { aspect: 1.0, v_axis: VAxis::Up }
    }
}

impl PictureFrame {
    /// The place of texture coordinates in the plane. Nothing is rounded where the picture is square.
    pub fn plane_from_uv(self, uv: DVec2) -> DVec2 {
        DVec2::new(uv.x * self.aspect, self.signed(uv.y))
    }

    /// The texture coordinates of a place in the plane.
    pub fn uv_from_plane(self, place: DVec2) -> DVec2 {
        DVec2::new(place.x / self.aspect, self.signed(place.y))
    }

    /// The picture's lower left and upper right corner in the plane.
    pub fn corners(self) -> [DVec2; 2] {
        let bottom = match self.v_axis {
            VAxis::Up => 0.0,
            VAxis::Down => -1.0,
        };
        [DVec2::new(0.0, bottom), DVec2::new(self.aspect, bottom + 1.0)]
    }

    fn signed(self, v: f64) -> f64 {
        match self.v_axis {
            VAxis::Up => v,
            VAxis::Down => -v,
        }
    }
}
