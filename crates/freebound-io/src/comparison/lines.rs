//! Numbers of a method in a few short lines, shown below its embedding.

use super::{Column, MethodReport};

/// Separator between unrelated numbers.
const DOT: &str = " · ";

impl MethodReport {
    /// Result of the method: proved planar, not planar, or failed, with the counts or the reason.
    pub fn verdict_line(&self) -> String {
        let Some(result) = &self.result else {
            return self.error.as_ref().map_or_else(String::new, |error| format!("failed: {}", error.kind));
        };
        let verdict = &result.verdict;
        let mut parts = vec![match (verdict.planar, verdict.mirrored) {
            (true, false) => "planar".to_owned(),
            (true, true) => "planar, mirrored".to_owned(),
            (false, _) => "not planar".to_owned(),
        }];
        let turning =
            verdict.turning_number.map_or_else(|| "–".to_owned(), |turns| turns.to_string().replace('-', "−"));
        parts.push(format!(
            "{}, {}, turning {turning}",
            counted(verdict.flipped_faces, "flip"),
            counted(verdict.boundary_crossings, "crossing")
        ));
        let others = [
            (verdict.overwound_vertices, "overwound"),
            (verdict.concave_polygons, "concave"),
            (verdict.crossed_holes, "crossed hole"),
        ];
        parts.extend(others.into_iter().filter(|(count, _)| *count > 0).map(|(count, what)| format!("{count} {what}")));
        parts.extend(self.error.as_ref().map(|error| format!("then failed: {}", error.kind)));
        parts.join(DOT)
    }

    /// Error message if there is no embedding; empty otherwise.
    pub fn error_words(&self) -> String {
        self.error.as_ref().filter(|_| self.result.is_none()).map(|error| error.message.clone()).unwrap_or_default()
    }

    /// Lines below [`verdict_line`](Self::verdict_line): distortion, work, unmet constraints and new vertices.
    pub fn number_lines(&self) -> Vec<String> {
        let words = |column: Column| column.cell(self).words();
        let steps = counted(self.steps.len(), "step");
        let of_work = format!("{steps}, {} + proof {}", words(Column::Solve), words(Column::Verify));
        let of_work = match self.factor_bytes {
            Some(_) => format!("{of_work}{DOT}{}", words(Column::Memory)),
            None => of_work,
        };
        let Some(result) = &self.result else { return vec![of_work] };
        let of_pins = match result.pins.unmet.len() {
            0 => None,
            count => Some(format!("{count} of {} not met", counted(result.pins.count, "constraint"))),
        };
        let of_vertices = match result.new_vertices {
            0 => None,
            count => Some(counted(count, "new vertex")),
        };
        let of_angle = format!("angle {} (p99 {})", words(Column::Angle), words(Column::AngleP99));
        let of_area = format!("area {}", words(Column::Area));
        let of_stretch = format!("L² {}, L∞ {}", words(Column::StretchL2), words(Column::StretchLinf));
        let of_energy = format!("energy {}", words(Column::Energy));
        let ways: Vec<String> = of_pins.into_iter().chain(of_vertices).collect();
        let lines = [of_angle + DOT + &of_area, of_stretch + DOT + &of_energy, of_work, ways.join(DOT)];
        lines.into_iter().filter(|line| !line.is_empty()).collect()
    }
}

/// Count with its noun.
fn counted(count: usize, noun: &str) -> String {
    match (count, noun.strip_suffix("ex")) {
        (1, _) => format!("1 {noun}"),
        (_, Some(stem)) => format!("{count} {stem}ices"),
        (_, None) => format!("{count} {noun}s"),
    }
}
