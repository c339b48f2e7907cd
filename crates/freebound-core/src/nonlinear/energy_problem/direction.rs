//! Descent directions, and the response of free points to moves of held points. Each solves one system of the Hessian.
//!
//! With many unknowns the Hessian is factored in single precision, which takes half the memory and time. Conjugate
//! gradients then find the direction. If this fails, double precision is used.

use glam::DVec2;

use super::super::foldover_energy::{Element, Energy};
use super::EnergyProblem;
use crate::linalg::{FactorPrecision, LinalgError, RoughFactor};
use crate::problem::{Control, SolveError};

/// First multiple of the diagonal that is added if the Hessian cannot be factored. Each further attempt adds ten times
/// more.
const REGULARISATION: f64 = 1e-10;

/// Largest multiple of the diagonal that is added.
const MOST_REGULARISATION: f64 = 1e3;

/// Number of free points from which single precision is worth its iterations.
const SINGLE_FROM: usize = 20_000;

/// State passed from a step to the next.
#[derive(Debug)]
pub(super) struct Memory {
    /// Factor of the previous step; its memory is reused.
    factor: Option<RoughFactor>,
    precision: FactorPrecision,
}

impl EnergyProblem {
    /// Initial state before the first step.
    pub(super) fn no_memory(&self) -> Memory {
        let precision =
            if self.unknowns.len() < SINGLE_FROM { FactorPrecision::Double } else { FactorPrecision::Single };
        Memory { factor: None, precision }
    }

    /// Newton direction for the given Hessian values: a move per point.
    pub(super) fn direction(
        &self,
        gradient: &[f64],
        mut hessian: Vec<f64>,
        memory: &mut Memory,
        control: Control<'_>,
    ) -> Result<Vec<DVec2>, SolveError> {
        let rhs: Vec<f64> = gradient.iter().map(|g| -g).collect();
        if memory.precision == FactorPrecision::Single {
            match self.solved_in_single(&hessian, &rhs, memory, control) {
                Ok(x) => return Ok(self.by_point(&x)),
                Err(LinalgError::Cancelled) => return Err(SolveError::Cancelled),
                // The next steps are equally hard.
                Err(_) => *memory = Memory { factor: None, precision: FactorPrecision::Double },
            }
        }
        let factor = self.factor(&mut hessian, memory.factor.take(), control)?;
        let x = factor.solve(&hessian, &rhs, control.cancel())?;
        memory.factor = Some(factor);
        Ok(self.by_point(&x))
    }

    fn solved_in_single(
        &self,
        hessian: &[f64],
        rhs: &[f64],
        memory: &mut Memory,
        control: Control<'_>,
    ) -> Result<Vec<f64>, LinalgError> {
        let earlier = memory.factor.take();
        let factor = self.analysis.factor_roughly(hessian, FactorPrecision::Single, earlier, control.cancel())?;
        let x = factor.solve(hessian, rhs, control.cancel())?;
        memory.factor = Some(factor);
        Ok(x)
    }

    /// Factors a Hessian. If rounding has made it indefinite, adds growing multiples of its diagonal.
    fn factor(
        &self,
        hessian: &mut [f64],
        mut earlier: Option<RoughFactor>,
        control: Control<'_>,
    ) -> Result<RoughFactor, SolveError> {
        let mut share = REGULARISATION;
        loop {
            match self.analysis.factor_roughly(hessian, FactorPrecision::Double, earlier.take(), control.cancel()) {
                Err(LinalgError::NotPositiveDefinite { .. }) if share < MOST_REGULARISATION => {
                    for (unknown, &first) in self.diagonal.iter().enumerate() {
                        let (x, y) = (first as usize, first as usize + self.column_length(unknown) + 1);
                        let most = hessian[x].max(hessian[y]).max(f64::MIN_POSITIVE);
                        hessian[x] += share * most;
                        hessian[y] += share * most;
                    }
                    share *= 10.0;
                }
                other => return Ok(other?),
            }
        }
    }

    /// Values of unknowns arranged by point; 0 for held points.
    fn by_point(&self, x: &[f64]) -> Vec<DVec2> {
        let mut by_point = vec![DVec2::ZERO; self.unknown_of.len()];
        for (&point, x) in self.unknowns.iter().zip(x.chunks_exact(2)) {
            by_point[point as usize] = DVec2::new(x[0], x[1]);
        }
        by_point
    }

    /// First-order response of all points if held points move by `shift`: the moves of all points.
    pub(crate) fn response(
        &self,
        z: &[DVec2],
        shift: &[DVec2],
        control: Control<'_>,
    ) -> Result<Vec<DVec2>, SolveError> {
        let model = |_: usize, element: &Element| element.model(Self::corners(element, z), Energy::Foldover(0.0));
        let (gradient, hessian) = self.assembled(z, model, Some(shift), control)?;
        let mut moves = self.direction(&gradient, hessian, &mut self.no_memory(), control)?;
        for (move_, shift) in moves.iter_mut().zip(shift) {
            *move_ += *shift;
        }
        Ok(moves)
    }
}

#[cfg(test)]
mod tests {
    use super::super::Planning;
    use super::super::damping::Damping;
    use super::super::descent::Energies;
    use super::*;
    use crate::nonlinear::foldover_energy::Stiffness;

    const SIDE: u32 = 9;

    /// A square of unit cells, each of two triangles, with one corner held; and its points, sheared and uneven.
    fn sheared() -> (EnergyProblem, Vec<DVec2>) {
        let at = |point: u32| DVec2::new(f64::from(point % SIDE), f64::from(point / SIDE));
        let first_corners = (0..SIDE * (SIDE - 1)).filter(|point| point % SIDE + 1 < SIDE);
        let triangles = first_corners.flat_map(|a| [[a, a + 1, a + SIDE + 1], [a, a + SIDE + 1, a + SIDE]]);
        let elements = triangles
            .map(|corners| Element::new(corners, corners.map(at), Stiffness { weight: 1.0, thinnest: 0.0 }))
            .collect();
        let planning = Planning { order: None, control: Control::unattended() };
        let count = SIDE * SIDE;
        let problem = EnergyProblem::new(count as usize, elements, Vec::new(), |point| point == 0, planning).unwrap();
        let place = |point: u32| {
            let z = at(point);
            DVec2::new(1.4 * z.x + 0.5 * z.y, 0.8 * z.y + 0.1 * (2.0 * z.x).sin())
        };
        (problem, (0..count).map(place).collect())
    }

    /// First-order change of the energy along a direction.
    fn slope(problem: &EnergyProblem, gradient: &[f64], direction: &[DVec2]) -> f64 {
        let along = |(&point, g): (&u32, &[f64])| DVec2::new(g[0], g[1]).dot(direction[point as usize]);
        problem.unknowns.iter().zip(gradient.chunks_exact(2)).map(along).sum()
    }

    #[test]
    fn a_direction_of_either_precision_promises_the_same_energy() {
        let (problem, z) = sheared();
        let (gradient, hessian) = problem
            .linearise(&z, &Energies::all(Energy::SymmetricDirichlet), &Damping::default(), Control::unattended())
            .unwrap();
        let [single, double] = [FactorPrecision::Single, FactorPrecision::Double].map(|precision| {
            let mut memory = Memory { factor: None, precision };
            let direction = problem.direction(&gradient, hessian.clone(), &mut memory, Control::unattended()).unwrap();
            assert_eq!(memory.precision, precision);
            slope(&problem, &gradient, &direction)
        });
        // The error of the direction is at most 1e-2 of it. The error of its energy is the square of that.
        assert!(double < 0.0 && (single - double).abs() < 2e-4 * double.abs(), "{single} for {double}");
    }

    #[test]
    fn where_single_precision_is_no_good_double_takes_over_for_good() {
        let (problem, z) = sheared();
        let (gradient, mut hessian) = problem
            .linearise(&z, &Energies::all(Energy::SymmetricDirichlet), &Damping::default(), Control::unattended())
            .unwrap();
        // Indefinite: no diagonal shift that rounding could call for repairs it.
        let place = problem.diagonal[40] as usize;
        hessian[place] *= -0.1;
        let mut memory = Memory { factor: None, precision: FactorPrecision::Single };
        let direction = problem.direction(&gradient, hessian, &mut memory, Control::unattended()).unwrap();
        assert_eq!(memory.precision, FactorPrecision::Double);
        assert!(slope(&problem, &gradient, &direction) < 0.0, "a direction of descent");
    }
}
