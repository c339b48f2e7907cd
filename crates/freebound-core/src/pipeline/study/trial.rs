//! Trial: pins, weights and treatment of one run, drawn at random.
//!
//! | item | distribution |
//! |---|---|
//! | pins | a pair, or 3 to 12 constraints, with equal probability |
//! | position of pins | all on the boundary, some inside, all inside, with equal probability |
//! | second pin of a pair | the ⌊u² n⌋-th nearest to the first of n vertices, u uniform in `[0, 1)`: often near |
//! | targets of a pair | (0, 0) and (1, 0): other targets change the map by a similarity only |
//! | targets of constraints | uniform in a disk around the natural embedding's position; its box has a diagonal of 1 |
//! | radius of that disk | 10ᵉ with e uniform in `[−2.5, −0.3)`: from a 300th to half of the diagonal |
//! | family, treatment | each with equal probability |
//!
//! If the boundary or the interior has too few vertices, the other side provides them.

use std::f64::consts::TAU;

use glam::DVec2;

use super::StudySubject;
use crate::geom::Random;
use crate::mesh::VertexId;
use crate::problem::{Family, Method, NamedOption as _, Pins, Settings, Treatment, hard_pins};

/// Families that a trial draws from (paper §3.1).
const FAMILIES: [Family; 3] = [Family::Conformal, Family::MeanValue, Family::Wachspress];

/// Least and largest number of constraints.
const CONSTRAINTS: [u32; 2] = [3, 12];

/// Exponents of 10 of the least and the largest displacement, as shares of the embedding's diagonal.
const DISPLACEMENTS: [f64; 2] = [-2.5, -0.3];

/// Pins, weights and treatment of one run.
#[derive(Clone, Debug, PartialEq)]
pub struct Trial {
    /// Number of the trial among the runs on a mesh, from 0.
    pub number: u64,
    /// Weights of the first solve.
    pub family: Family,
    /// Treatment of the equations of pinned vertices.
    pub treatment: Treatment,
    /// Hard pins, which the treatment may turn into soft pins.
    pub pins: Pins,
    /// Largest distance of a target from the natural embedding, as a share of its diagonal. Absent for a pair of
    /// pins.
    pub displacement: Option<f64>,
}

/// Position of the pins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Where {
    Boundary,
    Mixed,
    Inside,
}

const WHERE: [Where; 3] = [Where::Boundary, Where::Mixed, Where::Inside];

impl Trial {
    /// Draws a trial. Equal seeds and numbers draw equal trials.
    pub fn draw(subject: &StudySubject<'_>, seed: u64, number: u64) -> Self {
        let mut random = Random::of_run(seed, number);
        let family = FAMILIES[random.index(FAMILIES.len())];
        let treatment = Treatment::ALL[random.index(Treatment::ALL.len())];
        let place = WHERE[random.index(WHERE.len())];
        let is_pair = random.below(2) == 0;
        let mut urn = Urn::new(subject, place);
        let Some(natural) = subject.natural.as_ref().filter(|_| !is_pair) else {
            let first = urn.draw(&mut random);
            let pair = first.and_then(|first| Some([first, urn.draw_near(&mut random, first)?]));
            let places = pair.into_iter().flat_map(|pair| pair.into_iter().zip([DVec2::ZERO, DVec2::X]));
            return Self { number, family, treatment, pins: hard_pins(places), displacement: None };
        };
        let [least, most] = CONSTRAINTS;
        let count = least + random.below(most - least + 1);
        let displacement = 10_f64.powf(random.between(DISPLACEMENTS[0], DISPLACEMENTS[1]));
        let mut places = Vec::new();
        for _ in 0..count {
            let Some(vertex) = urn.draw(&mut random) else { break };
            let radius = displacement * random.unit().sqrt();
            places.push((vertex, natural[vertex] + radius * DVec2::from_angle(random.between(0.0, TAU))));
        }
        Self { number, family, treatment, pins: hard_pins(places), displacement: Some(displacement) }
    }

    /// Settings of the run.
    pub fn settings(&self, max_steps: usize) -> Settings {
        Settings {
            treatment: Some(self.treatment),
            max_steps: Some(max_steps),
            relax_rounds: Some(0),
            ..Settings::new(Method::Iterate, self.family)
        }
    }
}

/// Vertices to draw from, each at most once.
struct Urn<'a> {
    subject: &'a StudySubject<'a>,
    boundary: Vec<VertexId>,
    inside: Vec<VertexId>,
    place: Where,
    drawn: usize,
}

impl<'a> Urn<'a> {
    fn new(subject: &'a StudySubject<'a>, place: Where) -> Self {
        Self { subject, boundary: subject.boundary.clone(), inside: subject.inside.clone(), place, drawn: 0 }
    }

    /// Vertices to draw the next one from. For mixed positions, boundary and interior alternate.
    fn side(&mut self) -> &mut Vec<VertexId> {
        let wants_inside = match self.place {
            Where::Boundary => false,
            Where::Mixed => self.drawn % 2 == 1,
            Where::Inside => true,
        };
        self.drawn += 1;
        let is_inside = if wants_inside { !self.inside.is_empty() } else { self.boundary.is_empty() };
        if is_inside { &mut self.inside } else { &mut self.boundary }
    }

    fn draw(&mut self, random: &mut Random) -> Option<VertexId> {
        let side = self.side();
        (!side.is_empty()).then(|| side.swap_remove(random.index(side.len())))
    }

    /// Draws a vertex that is more likely near to `to` than far from it.
    fn draw_near(&mut self, random: &mut Random, to: VertexId) -> Option<VertexId> {
        let subject = self.subject;
        let side = self.side();
        let rank = nearest_rank(random.unit().powi(2), side.len())?;
        let key = |vertex: &VertexId| (subject.distance(to, *vertex), *vertex);
        let order = |a: &VertexId, b: &VertexId| {
            let ((of_a, a), (of_b, b)) = (key(a), key(b));
            of_a.total_cmp(&of_b).then(a.cmp(&b))
        };
        side.select_nth_unstable_by(rank, order);
        Some(side.swap_remove(rank))
    }
}

/// Index in a list of `count` items with a share of the items before it. `None` for an empty list.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share of a count is a count")]
fn nearest_rank(share: f64, count: usize) -> Option<usize> {
    (count > 0).then(|| ((share * count as f64) as usize).min(count - 1))
}
