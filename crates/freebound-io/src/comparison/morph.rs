//! What is reported of planar morphs through what methods have come to.

use serde::Serialize;

/// Morphs from each planar map of a comparison to the next one.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MorphReport {
    /// Each of them, in their order.
    pub legs: Vec<LegReport>,
    /// Methods that take no part.
    pub left_out: Vec<LeftOutReport>,
}

/// One morph.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LegReport {
    /// The method whose map it begins with.
    pub from: String,
    /// The method whose map it ends with.
    pub to: String,
    /// By what way it goes.
    pub route: &'static str,
    /// How many frames it has, both maps included.
    pub frames: usize,
    /// How many of them are proved one-to-one.
    pub proved: usize,
    /// Smallest determinant of a face's map from the surface in any frame, at equal total areas.
    pub least_determinant: f64,
    /// Seconds that it took to find and to prove.
    pub seconds: f64,
}

/// A method that takes no part in a morph.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct LeftOutReport {
    /// The method, as it is typed.
    pub name: String,
    /// Why, in a few lower-case words.
    pub why: &'static str,
}

impl MorphReport {
    /// A line for each morph, and one for each method that takes no part.
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
