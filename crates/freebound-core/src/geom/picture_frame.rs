//! Map between texture coordinates and the plane in which angles are measured.
//!
//! Pictures need not be square: a picture of w × h pixels covers the unit square of u and v. Angles and energies are
//! measured at (u·w/h, v), so that a conformal map is conformal on the picture. The v axis runs up (OBJ files) or
//! down (image files). The y axis of the plane always runs up, so that the picture stands upright in the plane.

use glam::DVec2;

/// Position of v = 0 on the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "kebab-case"))]
pub enum VAxis {
    /// v = 0 at the lower edge of the picture, the convention of OBJ files.
    #[default]
    Up,
    /// v = 0 at the upper edge of the picture, the convention of image files.
    Down,
}

/// Map from u and v to the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PictureFrame {
    /// Width of the picture over its height.
    pub aspect: f64,
    /// Position of v = 0.
    pub v_axis: VAxis,
}

impl Default for PictureFrame {
    fn default() -> Self {
        Self { aspect: 1.0, v_axis: VAxis::Up }
    }
}

impl PictureFrame {
    /// Position of texture coordinates in the plane. Not rounded if the picture is square.
    pub fn plane_from_uv(self, uv: DVec2) -> DVec2 {
        DVec2::new(uv.x * self.aspect, self.signed(uv.y))
    }

    /// Texture coordinates of a point of the plane.
    pub fn uv_from_plane(self, place: DVec2) -> DVec2 {
        DVec2::new(place.x / self.aspect, self.signed(place.y))
    }

    /// Lower left and upper right corner of the picture in the plane.
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
