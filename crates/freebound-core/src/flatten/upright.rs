//! Rotation of an embedding that no pin fixes: the vertical of its mesh becomes the vertical of the plane.
//!
//! Let w(v) be the position of a vertex in the front view of the mesh and z(v) its position in the plane, both complex
//! numbers. The turn is
//!
//! ```text
//! turn = s / |s|,   s = Σ_f A_f (z_f − z̄)* w_f
//! ```
//!
//! over the centroids of the faces, weighted by their areas in space; z̄ is the weighted mean, * the conjugate. Of all
//! turns this one brings the embedding closest to the front view, in the sum of squares. A reflection is never used.
//!
//! The view is from the side that the faces point to, y up. A body whose faces point to no side is seen from the
//! front, z towards the eye. Only a nearly flat mesh that lies down is seen from above or below.

use std::ops::Add;

use crate::parallel::prelude::*;
use glam::{DVec2, DVec3, DVec4, Vec4Swizzles as _};

use crate::geom::power_of_two_near;
use crate::mesh::{DiskMesh, FaceId};
use crate::problem::{Control, Embedding, SolveError};
use crate::weights::equations::length_scale;

/// Length of the mean face normal above which a mesh counts as nearly flat. A hemisphere has 0.5.
const NEARLY_FLAT: f64 = 0.6;

/// Length of a mean normal, or of its horizontal part, below which it has no direction.
const NOWHERE: f64 = 0.1;

/// Ratio of |s| to its upper bound below which the front view does not determine the turn.
const LEAST_AGREEMENT: f64 = 1e-6;

/// Distance from a multiple of 90°, in radians, below which a turn becomes that multiple: then rounding turns nothing.
const NEARLY_QUARTER: f64 = 1e-9;

/// Number of faces per parallel task.
const FACES_PER_TASK: usize = 4096;

/// Turns of an embedding that no pin fixes, as complex numbers of length 1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turns {
    /// Turn to the upright position.
    pub(crate) wished: DVec2,
    /// Multiple of 90° nearest to `wished`, which rounds nothing.
    pub(crate) quarter: DVec2,
}

impl Turns {
    /// No turn.
    pub(crate) const NONE: Self = Self { wished: DVec2::X, quarter: DVec2::X };

    /// Turns that bring an embedding upright.
    ///
    /// # Errors
    ///
    /// [`SolveError::Cancelled`].
    pub(crate) fn upright(mesh: &DiskMesh, embedding: &Embedding, control: Control<'_>) -> Result<Self, SolveError> {
        let Some(wished) = upright_turn(mesh, embedding, control)? else { return Ok(Self::NONE) };
        let quarter = nearest_quarter(wished);
        let is_quarter = wished.distance(quarter) < NEARLY_QUARTER;
        Ok(Self { wished: if is_quarter { quarter } else { wished }, quarter })
    }

    /// Turns restricted to multiples of 90°.
    pub(crate) fn by_quarters(self) -> Self {
        Self { wished: self.quarter, ..self }
    }
}

fn nearest_quarter(turn: DVec2) -> DVec2 {
    let along_x = turn.x.abs() >= turn.y.abs();
    if along_x { DVec2::new(1.0_f64.copysign(turn.x), 0.0) } else { DVec2::new(0.0, 1.0_f64.copysign(turn.y)) }
}

/// Sums over the faces, weighted by twice their areas in space.
#[derive(Clone, Copy, Default)]
struct Sums {
    normal: DVec3,
    area: f64,
    /// Sum of the centroids in the plane.
    in_plane: DVec2,
    /// Sum of the centroids in space.
    in_space: DVec3,
}

impl Add for Sums {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            normal: self.normal + other.normal,
            area: self.area + other.area,
            in_plane: self.in_plane + other.in_plane,
            in_space: self.in_space + other.in_space,
        }
    }
}

fn upright_turn(mesh: &DiskMesh, embedding: &Embedding, control: Control<'_>) -> Result<Option<DVec2>, SolveError> {
    // Both sizes near 1, so that no product overflows or underflows.
    let in_space = length_scale(mesh);
    let in_plane = power_of_two_near(embedding.bounds().size().max_element()).recip();
    let origin = mesh.mesh().positions[0];
    // Vector of twice the area of a face, and its centroids in the plane and in space.
    let face_of = |face: FaceId| {
        let [a, b, c] = mesh.mesh().corners(face).map(|x| (x - origin) * in_space);
        let z = embedding.corners(mesh, face).iter().sum::<DVec2>() / 3.0 * in_plane;
        ((b - a).cross(c - a), z, (a + b + c) / 3.0)
    };
    let weighted = |face| {
        let (normal, z, middle) = face_of(face);
        let area = normal.length();
        Sums { normal, area, in_plane: area * z, in_space: area * middle }
    };
    let sums = sum_over_faces(mesh, control, weighted)?;
    let view = front_view(sums.normal / sums.area);
    let in_view = |x: DVec3| DVec2::from(view.map(|axis| axis.dot(x)));
    let (z_mean, w_mean) = (sums.in_plane / sums.area, in_view(sums.in_space / sums.area));
    let of_products = |face| {
        let (normal, z, middle) = face_of(face);
        let (z, w) = (z - z_mean, in_view(middle) - w_mean);
        // The conjugate of z times w, and both squares.
        normal.length() * DVec4::new(z.dot(w), z.perp_dot(w), z.length_squared(), w.length_squared())
    };
    let products = sum_over_faces(mesh, control, of_products)?;
    let sum = products.xy();
    let is_clear = sum.length() > LEAST_AGREEMENT * (products.z * products.w).sqrt();
    Ok(sum.try_normalize().filter(|_| is_clear))
}

/// Sum of a quantity over the faces of the surface. The result does not depend on the number of threads.
fn sum_over_faces<T: Add<Output = T> + Default + Send>(
    mesh: &DiskMesh,
    control: Control<'_>,
    of: impl Fn(FaceId) -> T + Sync,
) -> Result<T, SolveError> {
    let count = mesh.mesh().real_face_count();
    let of_task = |task: usize| {
        control.go_on()?;
        let faces = task * FACES_PER_TASK..count.min((task + 1) * FACES_PER_TASK);
        Ok(faces.map(|face| of(FaceId::from_index(face))).fold(T::default(), T::add))
    };
    let tasks = (0..count.div_ceil(FACES_PER_TASK)).into_par_iter();
    let sums: Result<Vec<T>, SolveError> = tasks.map(of_task).collect();
    Ok(sums?.into_iter().fold(T::default(), T::add))
}

/// Right and up direction of the view from the side that a surface faces. `mean_normal` has length 1 for a plane
/// surface and 0 for a closed one.
fn front_view(mean_normal: DVec3) -> [DVec3; 2] {
    let across = DVec3::new(mean_normal.x, 0.0, mean_normal.z);
    let right = if across.length() > NOWHERE { DVec3::Y.cross(across) } else { DVec3::X };
    let right = right.try_normalize().unwrap_or(DVec3::X);
    let is_sheet = mean_normal.length() > NEARLY_FLAT;
    let up = if is_sheet { mean_normal.cross(right).try_normalize() } else { None };
    [right, up.unwrap_or(DVec3::Y)]
}
