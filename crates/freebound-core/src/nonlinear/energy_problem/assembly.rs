//! Parallel assembly of the gradient and Hessian of an energy problem.
//!
//! Elements are processed block by block. The models of a block are computed in parallel. Then each part of the
//! unknowns adds the entries of its own columns. So no two threads write to one entry, and every entry is summed in
//! the order of the elements for any number of threads.

use std::ops::Range;

use crate::parallel::prelude::*;
use glam::DVec2;

use super::super::foldover_energy::{Element, EnergyModel};
use super::{CHUNK, EnergyProblem, Spring};
use crate::linear::block_pattern::{HELD, number};
use crate::problem::{Control, SolveError};

/// Number of elements whose models are held at one time.
const MODELS: usize = 2 * CHUNK;

/// Number of parts of the unknowns, an upper bound on the threads that add entries.
const PARTS: usize = 16;

/// Smallest number of elements per task that computes models.
const TOGETHER: usize = CHUNK / 8;

/// Consecutive unknowns with their part of the gradient and of the Hessian's values.
struct Part<'a> {
    unknowns: Range<usize>,
    /// Index of the part's first value among all values.
    first_value: usize,
    gradient: &'a mut [f64],
    values: &'a mut [f64],
    /// Elements that touch the part and are not yet added.
    elements: &'a [u32],
}

/// First unknown of a part.
fn begin(part: usize, count: usize) -> usize {
    part * count / PARTS
}

/// Elements that touch each part of `count` unknowns, ascending. `of_corners` has the unknowns of each element's
/// corners.
pub(super) fn elements_of_parts(of_corners: &[[u32; 3]], count: usize) -> Vec<Vec<u32>> {
    let of_part = |part: usize| {
        let unknowns = number(begin(part, count))..number(begin(part + 1, count));
        let touched = (0..).zip(of_corners).filter(|(_, of)| of.iter().any(|unknown| unknowns.contains(unknown)));
        touched.map(|(element, _)| element).collect()
    };
    (0..PARTS).into_par_iter().map(of_part).collect()
}

impl EnergyProblem {
    /// Returns the gradient by unknown and the Hessian's values. `model_of` gives the model of each element by its
    /// number. With `shift`, the gradient is that of the models at points moved by `shift`.
    pub(super) fn assembled(
        &self,
        z: &[DVec2],
        model_of: impl Fn(usize, &Element) -> EnergyModel + Sync,
        shift: Option<&[DVec2]>,
        control: Control<'_>,
    ) -> Result<(Vec<f64>, Vec<f64>), SolveError> {
        let mut gradient = vec![0.0; 2 * self.unknowns.len()];
        let mut values = vec![0.0; self.columns[self.unknowns.len()] as usize];
        let mut parts = self.parts(&mut gradient, &mut values);
        let mut models: Vec<EnergyModel> = Vec::new();
        for (first, block) in (0..).step_by(MODELS).zip(self.elements.chunks(MODELS)) {
            control.go_on()?;
            let model = |(at, element): (usize, &Element)| {
                let model = model_of(first + at, element);
                match shift {
                    Some(shift) => shifted(model, Self::corners(element, shift)),
                    None => model,
                }
            };
            block.par_iter().enumerate().with_min_len(TOGETHER).map(model).collect_into_vec(&mut models);
            let end = first + block.len();
            parts.par_iter_mut().for_each(|part| {
                let (now, later) = part.elements.split_at(part.elements.partition_point(|&at| (at as usize) < end));
                part.elements = later;
                for at in now.iter().map(|&at| at as usize) {
                    self.add(at, &models[at - first], part);
                }
            });
        }
        self.add_springs(z, &mut gradient, &mut values);
        Ok((gradient, values))
    }

    /// Splits the unknowns into parts.
    fn parts<'a>(&'a self, mut gradient: &'a mut [f64], mut values: &'a mut [f64]) -> Vec<Part<'a>> {
        let count = self.unknowns.len();
        let cut = |(part, elements): (usize, &'a Vec<u32>)| {
            let unknowns = begin(part, count)..begin(part + 1, count);
            let offset = |unknown: usize| self.columns[unknown] as usize;
            let (first_value, length) = (offset(unknowns.start), offset(unknowns.end) - offset(unknowns.start));
            let gradient = gradient.split_off_mut(..2 * unknowns.len()).expect("two numbers an unknown");
            let values = values.split_off_mut(..length).expect("the columns' own");
            Part { unknowns, first_value, gradient, values, elements }
        };
        self.of_parts.iter().enumerate().map(cut).collect()
    }

    /// Adds the entries of an element's model that belong to the columns of a part.
    fn add(&self, element: usize, model: &EnergyModel, part: &mut Part<'_>) {
        let (corners, slots) = (self.elements[element].corners, &self.slots[element]);
        for (l, corner) in corners.into_iter().enumerate() {
            let unknown = self.unknown_of[corner as usize];
            if unknown == HELD || !part.unknowns.contains(&(unknown as usize)) {
                continue;
            }
            let own = 2 * (unknown as usize - part.unknowns.start);
            part.gradient[own] += model.gradient[2 * l];
            part.gradient[own + 1] += model.gradient[2 * l + 1];
            for (k, slots) in slots.iter().enumerate() {
                if slots[l] == HELD {
                    continue;
                }
                let first = slots[l] as usize - part.first_value;
                let second = first + self.column_length(unknown as usize);
                part.values[first] += model.hessian[2 * k][2 * l];
                part.values[first + 1] += model.hessian[2 * k + 1][2 * l];
                part.values[second] += model.hessian[2 * k][2 * l + 1];
                part.values[second + 1] += model.hessian[2 * k + 1][2 * l + 1];
            }
        }
    }

    fn add_springs(&self, z: &[DVec2], gradient: &mut [f64], values: &mut [f64]) {
        for Spring { point, target, stiffness } in &self.springs {
            let unknown = self.unknown_of[*point as usize] as usize;
            let pull = *stiffness * (z[*point as usize] - *target);
            gradient[2 * unknown] += pull.x;
            gradient[2 * unknown + 1] += pull.y;
            let at = self.diagonal[unknown] as usize;
            values[at] += stiffness;
            values[at + self.column_length(unknown) + 1] += stiffness;
        }
    }
}

/// Moves the point at which a model's gradient is taken by the given shifts of its corners.
fn shifted(mut model: EnergyModel, [a, b, c]: [DVec2; 3]) -> EnergyModel {
    let by = [a.x, a.y, b.x, b.y, c.x, c.y];
    for (g, row) in model.gradient.iter_mut().zip(&model.hessian) {
        *g += row.iter().zip(by).map(|(h, by)| h * by).sum::<f64>();
    }
    model
}
