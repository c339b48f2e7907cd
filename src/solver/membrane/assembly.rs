//! Gradient and Hessian of a membrane, put together on all threads.
//!
//! Elements are taken block by block. Their models are made side by side; then each part of the unknowns takes from them
//! what belongs to its own columns. So no two threads write to one place, and every entry is summed in the order of the
//! elements however many threads there are.

use std::ops::Range;

use glam::DVec2;
use nalgebra_sparse::CscMatrix;
use rayon::prelude::*;

use super::super::block_pattern::HELD;
use super::super::foldover_energy::{Element, Model};
use super::{CHUNK, Membrane, Spring};

/// Elements whose models are held at one time.
const MODELS: usize = 8 * CHUNK;

/// Parts that the unknowns are cut into: work for so many threads.
const PARTS: usize = 8;

/// Elements whose models are made by one task.
const TOGETHER: usize = CHUNK / 8;

/// Consecutive unknowns with their part of the gradient and of the Hessian's values.
struct Part<'a> {
    unknowns: Range<usize>,
    /// Where its values begin among all.
    first_value: usize,
    gradient: &'a mut [f64],
    values: &'a mut [f64],
}

impl Membrane {
    /// Gradient by unknown, and Hessian, of these models of the elements, which are numbered. Where points are moved by
    /// `shift`, the gradient is that of the models there.
    pub(super) fn assembled(
        &self,
        z: &[DVec2],
        model_of: impl Fn(usize, &Element) -> Model + Sync,
        shift: Option<&[DVec2]>,
    ) -> (Vec<f64>, CscMatrix<f64>) {
        let mut gradient = vec![0.0; 2 * self.unknowns.len()];
        let mut values = vec![0.0; self.pattern.nnz()];
        let mut parts = self.parts(&mut gradient, &mut values);
        let blocks = self.elements.chunks(MODELS).zip(self.slots.chunks(MODELS));
        for (first, (block, slots)) in (0..).step_by(MODELS).zip(blocks) {
            let model = |(at, element): (usize, &Element)| {
                let model = model_of(first + at, element);
                match shift {
                    Some(shift) => shifted(model, Self::corners(element, shift)),
                    None => model,
                }
            };
            let models: Vec<Model> = block.par_iter().enumerate().with_min_len(TOGETHER).map(model).collect();
            parts.par_iter_mut().for_each(|part| {
                for ((element, slots), model) in block.iter().zip(slots).zip(&models) {
                    self.add(element, slots, model, part);
                }
            });
        }
        self.add_springs(z, &mut gradient, &mut values);
        let hessian = CscMatrix::try_from_pattern_and_values(self.pattern.clone(), values).expect("one value an entry");
        (gradient, hessian)
    }

    /// Cuts the unknowns into parts.
    fn parts<'a>(&self, mut gradient: &'a mut [f64], mut values: &'a mut [f64]) -> Vec<Part<'a>> {
        let count = self.unknowns.len();
        let begin = |part: usize| part * count / PARTS;
        let cut = |part: usize| {
            let unknowns = begin(part)..begin(part + 1);
            let offset = |unknown: usize| self.pattern.major_offsets()[2 * unknown];
            let (first_value, length) = (offset(unknowns.start), offset(unknowns.end) - offset(unknowns.start));
            let gradient = gradient.split_off_mut(..2 * unknowns.len()).expect("two numbers an unknown");
            let values = values.split_off_mut(..length).expect("the columns' own");
            Part { unknowns, first_value, gradient, values }
        };
        (0..PARTS).map(cut).collect()
    }

    /// Adds what of an element's model belongs to the columns of a part.
    fn add(&self, element: &Element, slots: &[[u32; 3]; 3], model: &Model, part: &mut Part<'_>) {
        for (l, corner) in element.corners.into_iter().enumerate() {
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
                let second = first + self.column_length[unknown as usize] as usize;
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
            values[at + self.column_length[unknown] as usize + 1] += stiffness;
        }
    }
}

/// A model with its gradient taken where the corners are moved by so much.
fn shifted(mut model: Model, [a, b, c]: [DVec2; 3]) -> Model {
    let by = [a.x, a.y, b.x, b.y, c.x, c.y];
    for (g, row) in model.gradient.iter_mut().zip(&model.hessian) {
        *g += row.iter().zip(by).map(|(h, by)| h * by).sum::<f64>();
    }
    model
}
