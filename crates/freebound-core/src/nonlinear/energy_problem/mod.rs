//! Energy problem: triangles in the plane that resist folding, and Newton's method to lower their energy.
//!
//! ```text
//! E(z) = Σ elements f(J) + Σ springs ½ s |z − t|²
//! ```
//!
//! Some points are held; the others move. While a triangle is folded, ε follows the smallest determinant, as in
//! "Foldover-free maps in 50 lines of code" (see the module `foldover_energy`). Once all triangles are unfolded, ε is
//! 0 and no step folds any again. On request this applies to each triangle by itself: unfolded triangles have a
//! barrier while others unfold.
//!
//! | file | contents |
//! |---|---|
//! | `assembly.rs` | gradient and Hessian of all elements |
//! | `damping.rs` | stiffness of elements that would limit the step of all others |
//! | `descent.rs` | Newton steps with a line search |
//! | `direction.rs` | linear systems of the Hessian |
//! | `own_size.rs` | energy of elements that are measured at their own size |
//! | `reweighted.rs` | a step of SLIM |

mod assembly;
mod damping;
mod descent;
mod direction;
mod own_size;
mod reweighted;

use crate::parallel::prelude::*;
use crate::parallel::reduce;
use glam::DVec2;

use super::foldover_energy::Element;
use crate::linalg::{Analysis, EliminationOrder, Kind};
use crate::linear::block_pattern::{HELD, Neighbours, number};
use crate::problem::{Control, SolveError};
use assembly::elements_of_parts;
pub(crate) use damping::{Damped, Damping};
use descent::Energies;
pub(crate) use descent::{Limits, PassableOutside, Unfolding};

/// Number of elements whose energies one task sums. The sum does not depend on the number of threads.
const CHUNK: usize = 2048;

/// Spring that pulls a point to its target.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spring {
    pub(crate) point: u32,
    pub(crate) target: DVec2,
    pub(crate) stiffness: f64,
}

/// Elements, springs and free points, with the structure of the Hessian.
#[derive(Debug)]
pub(crate) struct EnergyProblem {
    elements: Vec<Element>,
    springs: Vec<Spring>,
    /// Unknown of each point, or `HELD`.
    unknown_of: Vec<u32>,
    unknowns: Vec<u32>,
    /// Index of the first entry of the block of each element and pair of corners (row, column), or `HELD`.
    slots: Vec<[[u32; 3]; 3]>,
    /// Start of each unknown's columns among the Hessian's values, and the end of the last.
    columns: Vec<u32>,
    /// Index of the first entry of each unknown's diagonal block.
    diagonal: Vec<u32>,
    /// Elements that touch each part of the unknowns, ascending.
    of_parts: Vec<Vec<u32>>,
    analysis: Analysis,
    /// Number of leading elements that are measured at their own size; 0 if none are.
    own_count: usize,
}

/// Inputs for the symbolic analysis of an energy problem.
#[derive(Clone, Copy)]
pub(crate) struct Planning<'a> {
    /// Elimination order of another energy problem over these points that shares most of its elements.
    pub(crate) order: Option<&'a EliminationOrder>,
    pub(crate) control: Control<'a>,
}

impl EnergyProblem {
    /// Prepares the energy of `elements` over points of which some are held.
    pub(crate) fn new(
        point_count: usize,
        elements: Vec<Element>,
        springs: Vec<Spring>,
        is_held: impl Fn(u32) -> bool,
        planning: Planning<'_>,
    ) -> Result<Self, SolveError> {
        let mut unknown_of = vec![HELD; point_count];
        let mut unknowns = Vec::new();
        for point in elements.iter().flat_map(|element| element.corners) {
            if unknown_of[point as usize] == HELD && !is_held(point) {
                unknown_of[point as usize] = 0;
            }
        }
        for (point, unknown) in (0..).zip(&mut unknown_of) {
            if *unknown != HELD {
                *unknown = number(unknowns.len());
                unknowns.push(point);
            }
        }
        let springs: Vec<Spring> =
            springs.into_iter().filter(|spring| unknown_of[spring.point as usize] != HELD).collect();
        let of_corners: Vec<[u32; 3]> =
            elements.iter().map(|element| element.corners.map(|corner| unknown_of[corner as usize])).collect();
        planning.control.go_on()?;
        let neighbours = Neighbours::new(&of_corners, unknowns.len());
        planning.control.go_on()?;
        let slot =
            |row: u32, column: u32| if row == HELD || column == HELD { HELD } else { neighbours.slot(row, column) };
        let slots_of = |of: &[u32; 3]| of.map(|row| of.map(|column| slot(row, column)));
        let slots = of_corners.par_iter().with_min_len(CHUNK).map(slots_of).collect();
        let columns = neighbours.columns();
        let diagonal = (0..number(unknowns.len())).map(|unknown| neighbours.slot(unknown, unknown)).collect();
        let of_parts = elements_of_parts(&of_corners, unknowns.len());
        drop(of_corners);
        planning.control.go_on()?;
        let pattern = neighbours.block_pattern(planning.control)?;
        drop(neighbours);
        let cancel = planning.control.cancel();
        let analysis = match planning.order {
            Some(order) => Analysis::in_order(order, &pattern, cancel)?,
            None => Analysis::new(Kind::Hermitian, &pattern, cancel)?,
        };
        let own_count = 0;
        Ok(Self { elements, springs, unknown_of, unknowns, slots, columns, diagonal, of_parts, analysis, own_count })
    }

    /// Elimination order, for reuse by a similar problem.
    pub(crate) fn order(&self) -> Option<EliminationOrder> {
        self.analysis.order()
    }

    /// Number of entries of each of an unknown's columns.
    fn column_length(&self, unknown: usize) -> usize {
        (self.columns[unknown + 1] - self.columns[unknown]) as usize / 2
    }

    fn corners(element: &Element, z: &[DVec2]) -> [DVec2; 3] {
        element.corners.map(|corner| z[corner as usize])
    }

    /// Energy; infinite if a triangle with a barrier is folded.
    fn energy(&self, z: &[DVec2], energies: &Energies) -> f64 {
        self.energy_of_first(self.elements.len(), z, energies)
    }

    /// Energy of the first `count` elements and of the springs.
    fn energy_of_first(&self, count: usize, z: &[DVec2], energies: &Energies) -> f64 {
        let own = energies.own_count();
        let of_own = if own > 0 { self.own_sums(z).energy() } else { 0.0 };
        let of_chunk = |(chunk, elements): (usize, &[Element])| -> f64 {
            let numbered = (own + chunk * CHUNK..).zip(elements);
            numbered.map(|(at, element)| element.energy(Self::corners(element, z), energies.of(at))).sum()
        };
        let sums: Vec<f64> = self.elements[own..count].par_chunks(CHUNK).enumerate().map(of_chunk).collect();
        of_own + sums.iter().sum::<f64>() + self.pull(z)
    }

    /// Energy of the springs.
    pub(crate) fn pull(&self, z: &[DVec2]) -> f64 {
        let of = |spring: &Spring| 0.5 * spring.stiffness * z[spring.point as usize].distance_squared(spring.target);
        self.springs.iter().map(of).sum()
    }

    /// Elements of the problem.
    pub(crate) fn elements(&self) -> &[Element] {
        &self.elements
    }

    /// Sets new targets of the springs, by their points.
    pub(crate) fn aim_springs(&mut self, target_of: impl Fn(u32) -> DVec2) {
        self.springs.iter_mut().for_each(|spring| spring.target = target_of(spring.point));
    }

    pub(crate) fn least_determinant(&self, z: &[DVec2]) -> f64 {
        let of = |element: &Element| element.determinant(Self::corners(element, z));
        reduce(self.elements.par_iter().with_min_len(CHUNK).map(of), || f64::INFINITY, f64::min)
    }

    /// Longest step along a direction that folds none of the first `count` elements.
    pub(crate) fn longest_step(&self, z: &[DVec2], direction: &[DVec2], count: usize) -> f64 {
        let of =
            |element: &Element| Element::longest_step(Self::corners(element, z), Self::corners(element, direction));
        reduce(self.elements[..count].par_iter().with_min_len(CHUNK).map(of), || f64::INFINITY, f64::min)
    }

    /// Returns the gradient by unknown and the Hessian's values.
    fn linearise(
        &self,
        z: &[DVec2],
        energies: &Energies,
        damping: &Damping,
        control: Control<'_>,
    ) -> Result<(Vec<f64>, Vec<f64>), SolveError> {
        let model = |at: usize, element: &Element| {
            let corners = Self::corners(element, z);
            let model = element.model(corners, energies.of(at));
            element.damped(model, corners, damping.of(at))
        };
        self.assembled(z, model, None, control)
    }
}
