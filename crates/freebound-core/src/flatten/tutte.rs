//! Tutte's map on a circle, the start of SLIM.

use super::Prepared;
use crate::mesh::DiskMesh;
use crate::nonlinear::slim::is_unfolded;
use crate::problem::{BoundaryShape, Control, Family, Method, Pins, Settings, Solution, SolveError};

/// Weights of the initial map of SLIM, in the order of trial: rounding may fold the first map.
const STARTS: [Family; 2] = [Family::Uniform, Family::MeanValue];

/// Tutte's map on a circle, the start of SLIM, with the family of its weights: the first of [`STARTS`] that folds no
/// face, or else the last.
pub(crate) fn tutte(mesh: &DiskMesh, control: Control<'_>) -> Result<(Solution, Family), SolveError> {
    let mut found = Err(SolveError::NotPlanar);
    for family in STARTS {
        let settings = Settings::new(Method::Convex(BoundaryShape::Circle), family);
        let solved = Prepared::new(mesh, &settings, &Pins::new(), control)
            .and_then(|prepared| prepared.solve_unplaced(mesh, &Pins::new(), control));
        match solved {
            Err(SolveError::Cancelled) => return Err(SolveError::Cancelled),
            Err(error) => found = found.or(Err(error)),
            Ok(solution) => {
                let is_unfolded = is_unfolded(mesh, &solution.embedding);
                found = Ok((solution, family));
                if is_unfolded {
                    break;
                }
            }
        }
    }
    found
}
