//! A solve with its proof: what the screen shows and what files say.

use std::sync::Arc;
use std::time::Instant;

use glam::DVec2;

use crate::mesh::DiskMesh;
use crate::solver::{
    Control, Distortion, Phase, Pins, Prepared, Settings, Solution, SolveError, Verdict, distortion, to_unit_square,
    verdict,
};

/// What to do with the size of an embedding that the user's pins do not fix.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OutputFit {
    /// Scale it uniformly into the unit square, as texture coordinates want it.
    #[default]
    Unit,
    /// Keep the area of the surface.
    True,
}

/// A finished solve: embedding, verdict and distortion.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// What was asked for.
    pub settings: Settings,
    /// The user's pins that it was solved for.
    pub pins: Pins,
    /// The embedding and its numbers.
    pub solution: Solution,
    /// The exact verdict on it.
    pub verdict: Verdict,
    /// How faces are distorted.
    pub distortion: Distortion,
    /// Seconds that the proof took.
    pub verify_seconds: f64,
    /// What a solve for other targets can use again.
    pub prepared: Arc<Prepared>,
}

impl Outcome {
    /// Solves, proves and measures. Uses `prepared` again where it serves.
    ///
    /// # Errors
    ///
    /// As [`Prepared::new`] and [`Prepared::solve`].
    pub fn compute(
        mesh: &DiskMesh,
        settings: &Settings,
        pins: &Pins,
        prepared: Option<Arc<Prepared>>,
        control: Control<'_>,
    ) -> Result<Self, SolveError> {
        let prepared = match prepared.filter(|prepared| prepared.serves(settings, pins)) {
            Some(prepared) => prepared,
            None => Arc::new(Prepared::new(mesh, settings, pins, control)?),
        };
        let solution = prepared.solve(mesh, pins, control)?;
        control.enter(Phase::Verify)?;
        let start = Instant::now();
        let (verdict, distortion) = (verdict(mesh, &solution.embedding), distortion(mesh, &solution.embedding));
        let verify_seconds = start.elapsed().as_secs_f64();
        Ok(Self { settings: *settings, pins: pins.clone(), solution, verdict, distortion, verify_seconds, prepared })
    }

    /// The coordinates that go into a file. The user's pins keep their places; without any, `fit` decides the size.
    pub fn output(&self, fit: OutputFit) -> Vec<DVec2> {
        let mut coordinates = self.solution.embedding.clone();
        if fit == OutputFit::Unit && self.pins_in_use().next().is_none() {
            to_unit_square(&mut coordinates);
        }
        coordinates
    }

    /// Largest distance of a pinned vertex from its target.
    pub fn pin_error(&self) -> f64 {
        let distance =
            |(v, target): (&crate::mesh::VertexId, &DVec2)| self.solution.embedding[v.index()].distance(*target);
        self.pins_in_use().map(distance).fold(0.0, f64::max)
    }

    /// The user's pins, where the method takes any.
    fn pins_in_use(&self) -> impl Iterator<Item = (&crate::mesh::VertexId, &DVec2)> {
        self.pins.iter().filter(|_| self.settings.method.uses_pins())
    }
}
