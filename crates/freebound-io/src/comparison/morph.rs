//! Report of planar morphs between the maps of a comparison.

use serde::Serialize;

/// Morphs from each planar map of a comparison to the next one.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MorphReport {
    /// Morphs in their order.
    pub legs: Vec<LegReport>,
    /// Methods that are left out.
    pub left_out: Vec<LeftOutReport>,
}

/// Morph between two maps.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LegReport {
    /// Method of the first map.
    pub from: String,
    /// Method of the last map.
    pub to: String,
    /// Name of the route that the morph takes.
    pub route: &'static str,
    /// Number of frames, both maps included.
    pub frames: usize,
    /// Number of frames proved one-to-one.
    pub proved: usize,
    /// Smallest determinant of a face's map from the surface in any frame, at equal total areas.
    pub least_determinant: f64,
    /// Seconds to compute and verify the morph.
    pub seconds: f64,
}

/// Method that is left out of the morphs.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct LeftOutReport {
    /// Name of the method, in the form of the command line.
    pub name: String,
    /// Reason, in a few lower-case words.
    pub why: &'static str,
}

impl MorphReport {
    /// Text with a line for each morph and for each method that is left out.
    pub fn lines(&self) -> Vec<String> {
        let leg = |leg: &LegReport| {
            let LegReport { from, to, route, frames, proved, least_determinant, seconds } = leg;
            format!(
                "morph {from} to {to}: {proved} of {frames} frames proved one-to-one, route {route}, \
                 smallest determinant {least_determinant:.2e}, {seconds:.3} s"
            )
        };
        let left_out = |left: &LeftOutReport| format!("morph without {}: {}", left.name, left.why);
        self.legs.iter().map(leg).chain(self.left_out.iter().map(left_out)).collect()
    }
}
