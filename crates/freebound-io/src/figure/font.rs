//! Letters made of strokes, for pictures. No font file is needed, and the pixels are equal on every system.
//!
//! A glyph is a width and a path on a grid with y up from the baseline: capitals are 7 high, small letters 5. `M`
//! moves, `L` draws a line, `Q` a quadratic curve, `O` a whole ellipse. `A` draws an arc of an ellipse (centre,
//! radii, first and last angle in degrees, clockwise if decreasing). An arc is joined to the previous point unless it
//! begins the path or follows `O`.

use glam::DVec2;

/// Type size in units of the grid.
const UNITS_PER_SIZE: f64 = 10.0;

/// Space after each glyph, units.
const SPACING: f64 = 1.5;

/// Width of a space, units.
const SPACE: f64 = 2.2;

/// Degrees between two points of an arc.
const ARC_STEP: f64 = 15.0;

/// Number of segments of a quadratic curve.
const CURVE_STEPS: u32 = 6;

/// Character, width, path.
const GLYPHS: &[(char, f64, &str)] = &[
    ('0', 4.8, "O2.4 3.5 2.4 3.5"),
    ('1', 2.8, "M0.4 5.6L2.4 7L2.4 0"),
    ('2', 4.8, "A2.4 4.9 2.1 2.1 165 -35L0.2 0L4.8 0"),
    ('3', 4.7, "A2.3 5.25 1.9 1.75 150 -90M2.3 3.5A2.3 1.75 2.3 1.75 90 -150"),
    ('4', 5.0, "M3.8 0L3.8 7L0 2L5 2"),
    ('5', 4.7, "M4.3 7L0.8 7L0.5 3.7A2.3 2.2 2.4 2.2 135 -150"),
    ('6', 4.8, "O2.4 2.2 2.3 2.2M0.1 2.2Q0.1 6.1 3.9 7"),
    ('7', 4.7, "M0 7L4.7 7L1.6 0"),
    ('8', 4.8, "O2.4 5.3 1.9 1.7O2.4 1.8 2.4 1.8"),
    ('9', 4.8, "O2.4 4.8 2.3 2.2M4.7 4.8Q4.7 0.9 0.9 0"),
    ('A', 5.4, "M0 0L2.7 7L5.4 0M1 2.4L4.4 2.4"),
    ('B', 4.9, "M0 0L0 7L2.6 7A2.6 5.3 1.9 1.7 90 -90L0 3.6M2.6 3.6A2.7 1.8 2.2 1.8 90 -90L0 0"),
    ('C', 5.3, "A3 3.5 3 3.5 45 315"),
    ('D', 5.3, "M0 0L0 7L2 7A2 3.5 3.3 3.5 90 -90L0 0"),
    ('E', 4.3, "M4.3 7L0 7L0 0L4.3 0M0 3.6L3.7 3.6"),
    ('F', 4.1, "M4.1 7L0 7L0 0M0 3.5L3.5 3.5"),
    ('G', 5.8, "A3 3.5 3 3.5 45 345M3.4 3.2L5.9 3.2L5.9 0.8"),
    ('H', 5.0, "M0 0L0 7M5 0L5 7M0 3.6L5 3.6"),
    ('I', 0.8, "M0.4 0L0.4 7"),
    ('J', 3.6, "M3.6 7L3.6 1.9A1.8 1.9 1.8 1.9 0 -170"),
    ('K', 4.9, "M0 0L0 7M4.7 7L0 2.6M1.5 4L4.9 0"),
    ('L', 4.0, "M0 7L0 0L4 0"),
    ('M', 6.0, "M0 0L0 7L3 1.2L6 7L6 0"),
    ('N', 5.0, "M0 0L0 7L5 0L5 7"),
    ('O', 6.0, "O3 3.5 3 3.5"),
    ('P', 4.5, "M0 0L0 7L2.5 7A2.5 5.1 2 1.9 90 -90L0 3.2"),
    ('Q', 6.0, "O3 3.5 3 3.5M3.8 1.6L5.8 -0.4"),
    ('R', 4.8, "M0 0L0 7L2.5 7A2.5 5.2 2 1.8 90 -90L0 3.4M2.6 3.4L4.8 0"),
    ('S', 4.6, "A2.3 5.25 2.1 1.75 40 270M2.3 3.5A2.3 1.75 2.3 1.75 90 -145"),
    ('T', 5.0, "M0 7L5 7M2.5 7L2.5 0"),
    ('U', 5.0, "M0 7L0 2.5A2.5 2.5 2.5 2.5 180 360L5 7"),
    ('V', 5.2, "M0 7L2.6 0L5.2 7"),
    ('W', 7.2, "M0 7L1.8 0L3.6 7L5.4 0L7.2 7"),
    ('X', 5.0, "M0 0L5 7M0 7L5 0"),
    ('Y', 5.0, "M0 7L2.5 3.4L5 7M2.5 3.4L2.5 0"),
    ('Z', 4.8, "M0 7L4.8 7L0 0L4.8 0"),
    ('a', 4.5, "O2.2 2.5 2.2 2.5M4.4 5L4.4 0"),
    ('b', 4.5, "M0 7.3L0 0O2.2 2.5 2.2 2.5"),
    ('c', 4.0, "A2.3 2.5 2.3 2.5 48 312"),
    ('d', 4.5, "M4.4 7.3L4.4 0O2.2 2.5 2.2 2.5"),
    ('e', 4.5, "M0 2.6L4.5 2.6A2.25 2.5 2.25 2.5 0 312"),
    ('f', 2.9, "M2.9 7.2Q1.1 7.5 1.1 5.6L1.1 0M0 5L2.6 5"),
    ('g', 4.5, "O2.2 2.5 2.2 2.5M4.4 5L4.4 0A2.3 0 2.1 2 0 -150"),
    ('h', 4.1, "M0 7.3L0 0M0 3A2.05 3 2.05 2 180 0L4.1 0"),
    ('i', 0.8, "M0.4 5L0.4 0M0.4 6.9L0.4 7"),
    ('j', 1.6, "M1.3 5L1.3 -0.6Q1.3 -2 0 -1.9M1.3 6.9L1.3 7"),
    ('k', 4.1, "M0 7.3L0 0M3.8 5L0 1.8M1.5 3.1L4.1 0"),
    ('l', 0.8, "M0.4 7.3L0.4 0"),
    ('m', 6.8, "M0 5L0 0M0 3.1A1.7 3.1 1.7 1.9 180 0L3.4 0M3.4 3.1A5.1 3.1 1.7 1.9 180 0L6.8 0"),
    ('n', 4.1, "M0 5L0 0M0 3A2.05 3 2.05 2 180 0L4.1 0"),
    ('o', 4.6, "O2.3 2.5 2.3 2.5"),
    ('p', 4.5, "M0 5L0 -2O2.2 2.5 2.2 2.5"),
    ('q', 4.5, "M4.4 5L4.4 -2O2.2 2.5 2.2 2.5"),
    ('r', 2.6, "M0 5L0 0M0 2.6Q0.3 5 2.6 4.9"),
    ('s', 3.7, "A1.85 3.75 1.65 1.25 40 270M1.85 2.5A1.85 1.25 1.85 1.25 90 -145"),
    ('t', 2.9, "M1.1 6.6L1.1 1.4Q1.1 0 2.9 0.1M0 5L2.7 5"),
    ('u', 4.1, "M0 5L0 2A2.05 2 2.05 2 180 360M4.1 5L4.1 0"),
    ('v', 4.1, "M0 5L2.05 0L4.1 5"),
    ('w', 6.2, "M0 5L1.55 0L3.1 5L4.65 0L6.2 5"),
    ('x', 4.0, "M0 0L4 5M0 5L4 0"),
    ('y', 4.1, "M0 5L2.05 0M4.1 5L1.5 -1.4Q1.2 -2 0.2 -1.9"),
    ('z', 3.8, "M0 5L3.8 5L0 0L3.8 0"),
    ('é', 4.5, "M0 2.6L4.5 2.6A2.25 2.5 2.25 2.5 0 312M1.9 6.1L3.2 7.5"),
    ('(', 1.6, "A2.6 2.8 2.6 5 125 235"),
    (')', 1.6, "A-1 2.8 2.6 5 55 -55"),
    ('.', 0.8, "M0.4 0.1L0.4 0.2"),
    (',', 1.0, "M0.7 0.3L0.2 -1.3"),
    (':', 0.8, "M0.4 0.1L0.4 0.2M0.4 4.1L0.4 4.2"),
    (';', 1.0, "M0.7 0.3L0.2 -1.3M0.6 4.1L0.6 4.2"),
    ('\'', 0.8, "M0.4 7.2L0.3 5.4"),
    ('-', 2.4, "M0 2.6L2.4 2.6"),
    ('+', 4.4, "M0 2.8L4.4 2.8M2.2 0.6L2.2 5"),
    ('=', 4.4, "M0 3.6L4.4 3.6M0 1.9L4.4 1.9"),
    ('/', 3.0, "M0 -0.8L3 7.4"),
    ('·', 0.8, "M0.4 2.7L0.4 2.8"),
    ('@', 6.6, "A3.3 2.6 3.3 3.6 -50 300M4.8 4.2L4.8 1.9Q4.9 0.9 5.7 1.2M4.8 2.6A3.4 2.6 1.4 1.5 0 360"),
    ('%', 6.4, "O1.4 5.5 1.4 1.5O5 1.5 1.4 1.5M1.3 0L5.1 7"),
    ('–', 4.6, "M0 2.6L4.6 2.6"),
    ('−', 4.4, "M0 2.8L4.4 2.8"),
    ('×', 4.0, "M0.3 1L3.7 4.6M0.3 4.6L3.7 1"),
    ('²', 2.8, "A1.4 6.1 1.2 1.2 165 -35L0.1 3.5L2.8 3.5"),
    ('∞', 7.2, "O1.8 2.8 1.8 1.7O5.4 2.8 1.8 1.7"),
    ('µ', 4.1, "M0 5L0 -2M0 2A2.05 2 2.05 2 180 360L4.1 5M4.1 2L4.1 0"),
    ('½', 6.6, "M0.2 6.2L1.4 7L1.4 3.6M1 0L5.4 7M4.1 2.2A5.2 2.2 1.1 1.1 165 -35L4 0L6.4 0"),
    ('¼', 6.6, "M0.2 6.2L1.4 7L1.4 3.6M1 0L5.4 7M5.8 0L5.8 3.2L4 1L6.5 1"),
    ('≤', 4.4, "M4.4 5.6L0 3.6L4.4 1.6M0 0L4.4 0"),
    ('^', 3.2, "M0 4.6L1.6 7L3.2 4.6"),
    ('_', 4.0, "M0 -0.6L4 -0.6"),
    ('!', 0.8, "M0.4 7L0.4 2.2M0.4 0.1L0.4 0.2"),
];

/// True if a character can be drawn.
pub fn has_glyph(c: char) -> bool {
    c == ' ' || glyph(c).is_some()
}

fn glyph(c: char) -> Option<(f64, &'static str)> {
    GLYPHS.iter().find(|entry| entry.0 == c).map(|&(_, width, path)| (width, path))
}

/// Width of a text, in points.
pub(super) fn width_of(text: &str, size: f64) -> f64 {
    let units: f64 = text.chars().map(advance).sum();
    (units - SPACING).max(0.0) * size / UNITS_PER_SIZE
}

/// Distance to the next character, units.
fn advance(c: char) -> f64 {
    glyph(c).map_or(SPACE, |(width, _)| width) + SPACING
}

/// Strokes of a text with its baseline starting at `at`.
pub(super) fn strokes_of(text: &str, at: DVec2, size: f64) -> Vec<Vec<DVec2>> {
    let scale = size / UNITS_PER_SIZE;
    let mut lines = Vec::new();
    let mut x = 0.0;
    for c in text.chars() {
        if let Some((_, path)) = glyph(c) {
            let place = |p: DVec2| at + scale * DVec2::new(x + p.x, -p.y);
            lines.extend(lines_of(path).into_iter().map(|line| line.into_iter().map(place).collect::<Vec<_>>()));
        }
        x += advance(c);
    }
    lines
}

/// Lines of a path on the grid.
fn lines_of(path: &str) -> Vec<Vec<DVec2>> {
    let mut lines: Vec<Vec<DVec2>> = vec![Vec::new()];
    for (letter, n) in commands(path) {
        if matches!(letter, 'M' | 'O') {
            lines.push(Vec::new());
        }
        let line = lines.last_mut().expect("there is always a last line");
        let at = |k: usize| DVec2::new(n[k], n[k + 1]);
        match letter {
            'M' | 'L' => line.push(at(0)),
            'Q' => {
                let from = line.last().copied().unwrap_or(at(0));
                let share = |k: u32| f64::from(k) / f64::from(CURVE_STEPS);
                let point = |t: f64| from.lerp(at(0), t).lerp(at(0).lerp(at(2), t), t);
                line.extend((1..=CURVE_STEPS).map(|k| point(share(k))));
            }
            'A' => line.extend(arc(at(0), at(2), [n[4], n[5]])),
            _ => {
                line.extend(arc(at(0), at(2), [0.0, 360.0]));
                // The next command starts a new line.
                lines.push(Vec::new());
            }
        }
    }
    lines.retain(|line| line.len() > 1);
    lines
}

/// Points of an arc of an ellipse, from one angle to another, degrees.
fn arc(centre: DVec2, radii: DVec2, [from, to]: [f64; 2]) -> Vec<DVec2> {
    let steps = ((to - from).abs() / ARC_STEP).ceil();
    let angle = |k: f64| (from + (to - from) * k / steps).to_radians();
    let mut k = 0.0;
    let mut points = Vec::new();
    while k <= steps {
        points.push(centre + radii * DVec2::from_angle(angle(k)));
        k += 1.0;
    }
    points
}

/// Commands of a path: letters with their numbers.
fn commands(path: &str) -> Vec<(char, Vec<f64>)> {
    let mut found: Vec<(char, String)> = Vec::new();
    for c in path.chars() {
        match found.last_mut() {
            Some((_, text)) if !c.is_ascii_uppercase() => text.push(c),
            _ => found.push((c, String::new())),
        }
    }
    let numbers = |text: String| text.split_whitespace().map(|n| n.parse().expect("a number of the table")).collect();
    found.into_iter().map(|(letter, text)| (letter, numbers(text))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_glyph_lies_within_its_width() {
        for &(c, width, path) in GLYPHS {
            let lines = lines_of(path);
            assert!(!lines.is_empty(), "{c}");
            for p in lines.iter().flatten() {
                assert!(p.x > -0.2 && p.x < width + 0.2 && p.y >= -2.1 && p.y <= 7.6, "{c} at {p}");
            }
        }
    }

    #[test]
    fn a_text_is_as_wide_as_its_strokes() {
        let right = |text: &str| strokes_of(text, DVec2::ZERO, 10.0).iter().flatten().fold(0.0, |m: f64, p| m.max(p.x));
        assert!((width_of("HHH", 10.0) - right("HHH")).abs() < 1e-9);
        assert!(width_of("HH H", 10.0) > width_of("HHH", 10.0));
    }
}
