//! Planar morphs through the results of methods: the maps that take part, and the morph from each map to the next.
//!
//! Each frame is proved twice. [`morph`] accepts only one-to-one frames, and each frame gets its own [`Verdict`]. The
//! verdict also tells if polygons are convex and if the map is planar in 32 bits.

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

/// Default number of frames of a morph between two maps, both included. Odd, so that one frame lies half-way.
pub const MORPH_FRAMES: usize = 49;

/// Bytes of a vertex in a frame: two coordinates of 64 bits. All frames of a tour are kept.
const BYTES_PER_VERTEX: u64 = 16;

/// Divisor of the machine's memory that gives the limit for frames: one half.
const SHARE: u64 = 2;

/// Map at an end of a morph.
#[derive(Clone, Debug)]
pub struct MorphStop {
    /// Name of the method on the command line.
    pub name: String,
    /// Result of the method: planar, one-to-one also with filled holes, without new vertices.
    pub outcome: Arc<Outcome>,
}

/// Maps that take part, in the order of the methods.
#[derive(Clone, Debug, Default)]
pub struct MorphStops {
    /// Maps that take part.
    pub stops: Vec<MorphStop>,
    /// Methods that do not take part, each with the reason.
    pub left_out: Vec<LeftOutReport>,
}

impl MorphStops {
    /// Selects the results that can take part. All of them have the orientation of the first: mirrored or not.
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

    /// Checks that all frames of a tour through these maps fit into half of `memory`, bytes. `None` means no limit.
    ///
    /// # Errors
    ///
    /// [`MorphShortage`] with the memory needed.
    pub fn check_memory(&self, mesh: &DiskMesh, frames: usize, memory: Option<u64>) -> Result<(), MorphShortage> {
        let Some(memory) = memory else { return Ok(()) };
        let counts = [frames, mesh.vertex_count(), self.stops.len().saturating_sub(1)];
        let needed = counts.iter().fold(BYTES_PER_VERTEX, |bytes, &count| bytes.saturating_mul(count as u64));
        if needed > memory / SHARE { Err(MorphShortage { frames, needed, memory }) } else { Ok(()) }
    }
}

/// Error: frames would take more than half of the machine's memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "{frames} frames between maps need {}, more than half of the machine's memory of {}",
    bytes_in_words(*needed),
    bytes_in_words(*memory)
)]
pub struct MorphShortage {
    /// Number of frames from one map to the next, both included.
    pub frames: usize,
    /// Memory of all frames, bytes.
    pub needed: u64,
    /// Memory of the machine, bytes.
    pub memory: u64,
}

/// Map of a method, if a morph can begin or end with it.
///
/// # Errors
///
/// Reason, in a few lower-case words.
pub fn morph_end(method: &Compared) -> Result<&Arc<Outcome>, &'static str> {
    let outcome = method.outcome.as_ref().ok_or("no map")?;
    let step = &outcome.step;
    match &step.verdict {
        verdict if !verdict.planar => Err("not planar"),
        verdict if !verdict.is_one_to_one() => Err("the filling of a hole is folded"),
        _ if step.candidate.refinement.is_some() => Err("new vertices change the mesh"),
        _ => Ok(outcome),
    }
}

/// Morph from one map to the next.
#[derive(Clone, Debug)]
pub struct MorphLeg {
    /// Route that the morph takes.
    pub route: Route,
    /// Both maps and the frames between them.
    pub frames: Vec<Embedding>,
    /// Verdict on each frame.
    pub verdicts: Vec<Verdict>,
    /// Smallest determinant of a face's map from the surface in any frame, each at equal total areas.
    pub least_determinant: f64,
    /// Time to find and to prove the morph, seconds.
    pub seconds: f64,
}

impl MorphLeg {
    /// Finds a morph of `frame_count` frames between two maps of a mesh. `frame_count` is at least 2.
    ///
    /// # Errors
    ///
    /// [`NoMorph`] with the reason.
    ///
    /// # Panics
    ///
    /// If a map belongs to another mesh.
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
            // No progress is reported here: the search reported each frame when it proved it.
            if control.cancel().load(Ordering::Relaxed) {
                return Err(NoMorph::Cancelled);
            }
            verdicts.push(verdict(mesh, frame));
            // At equal total areas the determinant of a face's map is the ratio of the face's areas.
            let least = distortion(mesh, frame).faces.iter().map(|face| face.area).fold(f64::INFINITY, f64::min);
            least_determinant = least_determinant.min(least);
        }
        let seconds = start.elapsed().as_secs_f64();
        Ok(Self { route: found.route, frames: found.frames, verdicts, least_determinant, seconds })
    }

    /// Number of frames that are proved one-to-one.
    pub fn proved(&self) -> usize {
        self.verdicts.iter().filter(|verdict| verdict.is_one_to_one()).count()
    }
}

/// Sequence of morphs through several maps.
#[derive(Clone, Debug)]
pub struct MorphTour {
    /// Maps of the tour.
    pub stops: MorphStops,
    /// Morphs between consecutive maps.
    pub legs: Vec<MorphLeg>,
}

/// Error: a morph of a tour does not exist.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("from {from} to {to}: {reason}")]
pub struct MissingLeg {
    /// Method at the beginning of the morph.
    pub from: String,
    /// Method at the end of the morph.
    pub to: String,
    /// Reason of the failure.
    pub reason: NoMorph,
}

impl MorphTour {
    /// Finds the morphs between consecutive maps, each of `frame_count` frames. `frame_count` is at least 2.
    ///
    /// # Errors
    ///
    /// [`MissingLeg`] for the first morph that is not found.
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

    /// Report on the tour.
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
