//! Planar morphs through what methods have come to: which of their maps take part, and the way from one to the next, every
//! frame proved by itself.
//!
//! A frame is proved twice: [`morph`] takes no frame that is not one-to-one, and each frame gets a [`Verdict`] of its own, which also
//! says whether polygons are convex and whether it holds in 32 bits.

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Instant;

use super::Compared;
use freebound_core::bijective::{MorphOptions, NoMorph, Route, morph};
use freebound_core::mesh::DiskMesh;
use freebound_core::pipeline::Outcome;
use freebound_core::problem::{Control, Embedding};
use freebound_core::verify::{Verdict, distortion, verdict};
use freebound_io::{LeftOutReport, LegReport, MorphReport, bytes_in_words};

/// Frames of a morph between two maps where nobody says how many, both maps included: an odd number, so that one is half way.
pub const MORPH_FRAMES: usize = 49;

/// Bytes of a vertex in a frame: two coordinates of 64 bits. All frames of a tour are kept.
const BYTES_PER_VERTEX: u64 = 16;

/// The share of the machine's memory that they may take: one half.
const SHARE: u64 = 2;

/// A map that a morph begins or ends with.
#[derive(Clone, Debug)]
pub struct MorphStop {
    /// The method, as it is typed.
    pub name: String,
    /// What it has come to: planar, one-to-one as the mesh is filled, of the mesh as given.
    pub outcome: Arc<Outcome>,
}

/// The maps that take part, in the order of the methods.
#[derive(Clone, Debug, Default)]
pub struct MorphStops {
    /// Those that do.
    pub stops: Vec<MorphStop>,
    /// The other methods, each with the reason.
    pub left_out: Vec<LeftOutReport>,
}

impl MorphStops {
    /// Chooses among what methods on one mesh have come to. All are mirror images where the first is one, and none where it is not.
    pub fn of(methods: &[&Compared]) -> Self {
        let mut found = Self::default();
        for method in methods {
            let end = morph_end(method).and_then(|outcome| {
                let is_mirrored = |outcome: &Outcome| outcome.step.verdict.mirrored;
                let first = found.stops.first().map(|stop| is_mirrored(&stop.outcome));
                let is_alike = first.is_none_or(|first| first == is_mirrored(outcome));
                if is_alike { Ok(outcome) } else { Err("a mirror image of the first map") }
            });
            let name = method.report.name.clone();
            match end {
                Ok(outcome) => found.stops.push(MorphStop { name, outcome: Arc::clone(outcome) }),
                Err(why) => found.left_out.push(LeftOutReport { name, why }),
            }
        }
        found
    }

    /// Whether all frames of a tour through these maps of a mesh fit into half of this memory, bytes; without a number they do.
    ///
    /// # Errors
    ///
    /// [`MorphShortage`] says what they would take.
    pub fn check_memory(&self, mesh: &DiskMesh, frames: usize, memory: Option<u64>) -> Result<(), MorphShortage> {
        let Some(memory) = memory else { return Ok(()) };
        let counts = [frames, mesh.vertex_count(), self.stops.len().saturating_sub(1)];
        let needed = counts.iter().fold(BYTES_PER_VERTEX, |bytes, &count| bytes.saturating_mul(count as u64));
        if needed > memory / SHARE { Err(MorphShortage { frames, needed, memory }) } else { Ok(()) }
    }
}

/// Frames that would take more than half of the machine's memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{frames} frames from map to map take {} in all, more than half of the machine's memory of {}",
    bytes_in_words(*needed),
    bytes_in_words(*memory)
)]
pub struct MorphShortage {
    /// From one map to the next, both included.
    pub frames: usize,
    /// What all of them take, bytes.
    pub needed: u64,
    /// What the machine has, bytes.
    pub memory: u64,
}

/// The map of a method, where a morph can begin or end with it; else why not, in a few lower-case words.
///
/// # Errors
///
/// The reason.
pub fn morph_end(method: &Compared) -> Result<&Arc<Outcome>, &'static str> {
    let outcome = method.outcome.as_ref().ok_or("no map")?;
    let step = &outcome.step;
    match &step.verdict {
        verdict if !verdict.planar => Err("not planar"),
        verdict if !verdict.is_one_to_one() => Err("the filling of a hole folds"),
        _ if step.candidate.refinement.is_some() => Err("new vertices: of another mesh"),
        _ => Ok(outcome),
    }
}

/// The way from one map to the next.
#[derive(Clone, Debug)]
pub struct MorphLeg {
    /// By what way.
    pub route: Route,
    /// Both maps and what lies between.
    pub frames: Vec<Embedding>,
    /// The verdict on each frame.
    pub verdicts: Vec<Verdict>,
    /// Smallest determinant of a face's map from the surface in any frame, each at equal total areas.
    pub least_determinant: f64,
    /// Seconds that it took to find and to prove.
    pub seconds: f64,
}

impl MorphLeg {
    /// Finds a morph between two maps of a mesh, with so many frames, two at least.
    ///
    /// # Errors
    ///
    /// [`NoMorph`] with the reason.
    ///
    /// # Panics
    ///
    /// If a map is of another mesh.
    pub fn between(
        mesh: &DiskMesh,
        ends: [&Outcome; 2],
        frame_count: usize,
        control: Control<'_>,
    ) -> Result<Self, NoMorph> {
        let start = Instant::now();
        let options = MorphOptions { frame_count, ..MorphOptions::default() };
        let found = morph(mesh, ends.map(|end| &end.step.candidate.solution.embedding), &options, control)?;
        let mut verdicts = Vec::with_capacity(found.frames.len());
        let mut least_determinant = f64::INFINITY;
        for frame in &found.frames {
            // Not announced: each frame was, when the search proved it.
            if control.cancel().load(Ordering::Relaxed) {
                return Err(NoMorph::Cancelled);
            }
            verdicts.push(verdict(mesh, frame));
            // At equal total areas the determinant of a face's map is the ratio of its areas.
            let least = distortion(mesh, frame).faces.iter().map(|face| face.area).fold(f64::INFINITY, f64::min);
            least_determinant = least_determinant.min(least);
        }
        let seconds = start.elapsed().as_secs_f64();
        Ok(Self { route: found.route, frames: found.frames, verdicts, least_determinant, seconds })
    }

    /// How many of its frames are proved one-to-one.
    pub fn proved(&self) -> usize {
        self.verdicts.iter().filter(|verdict| verdict.is_one_to_one()).count()
    }
}

/// Morphs from each of some maps to the next.
#[derive(Clone, Debug)]
pub struct MorphTour {
    /// The maps.
    pub stops: MorphStops,
    /// The ways between them, one fewer.
    pub legs: Vec<MorphLeg>,
}

/// A morph of a tour that there is not.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("from {from} to {to}: {reason}")]
pub struct MissingLeg {
    /// The method that it was to begin with.
    pub from: String,
    /// The method that it was to end with.
    pub to: String,
    /// Why there is none.
    pub reason: NoMorph,
}

impl MorphTour {
    /// Finds all ways, each with so many frames, two at least.
    ///
    /// # Errors
    ///
    /// The first that there is not.
    pub fn through(
        mesh: &DiskMesh,
        stops: MorphStops,
        frame_count: usize,
        control: Control<'_>,
    ) -> Result<Self, MissingLeg> {
        let leg = |pair: &[MorphStop]| {
            let found = MorphLeg::between(mesh, [&pair[0].outcome, &pair[1].outcome], frame_count, control);
            found.map_err(|reason| MissingLeg { from: pair[0].name.clone(), to: pair[1].name.clone(), reason })
        };
        let legs = stops.stops.windows(2).map(leg).collect::<Result<_, _>>()?;
        Ok(Self { stops, legs })
    }

    /// What is reported of it.
    pub fn report(&self) -> MorphReport {
        let leg = |(leg, pair): (&MorphLeg, &[MorphStop])| LegReport {
            from: pair[0].name.clone(),
            to: pair[1].name.clone(),
            route: leg.route.name(),
            frames: leg.frames.len(),
            proved: leg.proved(),
            least_determinant: leg.least_determinant,
            seconds: leg.seconds,
        };
        let legs = self.legs.iter().zip(self.stops.stops.windows(2)).map(leg).collect();
        MorphReport { legs, left_out: self.stops.left_out.clone() }
    }
}
