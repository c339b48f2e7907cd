//! Landmarks of a picture in PTS files.
//!
//! ```text
//! version: 1
//! n_points: 2
//! {
//! 185.345840 248.114906
//! 184.628280 274.246696
//! }
//! ```
//!
//! A line is the x and y of a point, in pixels from the top left. The format comes without a convention of its own; the
//! files of 300-W count pixels from 1, after MATLAB: the centre of the top left pixel is (1, 1). This reader and this
//! writer do the same. A point therefore lies `(x − 0.5)/width` of the picture's width from its left side.
//!
//! PTS files have no names: [`LandmarkSet`] names the points by their number.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::{LandmarkSet, PinName};

/// Greatest number of points of a file.
const MOST_POINTS: usize = 10_000;

/// Greatest number of characters of a line that an error quotes.
const QUOTED: usize = 40;

/// Pixel coordinate of the left and of the upper side of a picture: half a pixel before the centre of the first pixel.
const SIDE: f64 = 0.5;

/// Named point of a picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PictureLandmark {
    /// Name of the point.
    pub name: PinName,
    /// Distances from the left and from the upper side, as shares of the picture's width and height.
    #[serde(with = "share_list")]
    pub place: DVec2,
}

/// Failure to read a file of landmarks.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PtsError {
    /// The file cannot be read.
    #[error("{}: the landmarks cannot be read: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// A line is invalid.
    #[error("{}: line {line}: {fault}", path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// Line, counted from 1.
        line: u64,
        /// Fault of the line.
        fault: PtsFault,
    },
}

/// Fault of a file of landmarks.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PtsFault {
    /// The line belongs to no part of the format.
    #[error("expected \"{expected}\", not \"{found}\"")]
    Unexpected {
        /// Text that the format has here.
        expected: &'static str,
        /// Start of the line.
        found: String,
    },
    /// The file has another version.
    #[error("version \"{0}\" is unknown: only version 1 is supported")]
    Version(String),
    /// The number of points is no number, zero, or too large.
    #[error("\"{0}\" is no number of points: use 1 to {MOST_POINTS}")]
    Count(String),
    /// The line of a point does not consist of two numbers.
    #[error("write a point as \"x y\" in pixels, not \"{0}\"")]
    Point(String),
    /// The file has fewer or more points than it announces.
    #[error("the file has {found} points, but n_points says {announced}: correct one of them")]
    OtherCount {
        /// Number in the head of the file.
        announced: usize,
        /// Number of points found.
        found: usize,
    },
    /// The file ends too early.
    #[error("the file ends before \"{0}\"")]
    End(&'static str),
}

impl PtsError {
    /// Remedy for the error.
    pub const fn remedy(&self) -> &'static str {
        match self {
            Self::File { .. } => "check the path and the permissions",
            Self::Line { .. } => "nothing was opened: repair the file and open it again",
        }
    }
}

/// Reads the landmarks of a picture of `size` pixels.
///
/// # Errors
///
/// If the file cannot be read, or for the first faulty line.
pub fn read_pts(path: &Path, size: [u32; 2]) -> Result<Vec<PictureLandmark>, PtsError> {
    let bytes = std::fs::read(path).map_err(|source| PtsError::File { path: path.to_owned(), source })?;
    let text = String::from_utf8_lossy(&bytes);
    let pixels = parse_pts(&text).map_err(|(line, fault)| PtsError::Line { path: path.to_owned(), line, fault })?;
    let count = pixels.len();
    let landmark = |(place, pixel): (usize, DVec2)| PictureLandmark {
        name: LandmarkSet::name_of(count, place),
        place: (pixel - SIDE) / size_of(size),
    };
    Ok(pixels.into_iter().enumerate().map(landmark).collect())
}

fn size_of(size: [u32; 2]) -> DVec2 {
    DVec2::from(size.map(f64::from))
}

/// Parses the text of a PTS file: its points, in pixels that count from 1.
///
/// # Errors
///
/// The first fault and its line, counted from 1.
pub fn parse_pts(text: &str) -> Result<Vec<DVec2>, (u64, PtsFault)> {
    let mut lines = Lines::new(text);
    let version = lines.entry("version:", "version: 1")?;
    if version.words != "1" {
        return Err((version.number, PtsFault::Version(quoted(version.words))));
    }
    let head = lines.entry("n_points:", "n_points:")?;
    let announced = head.words.parse().ok().filter(|count| (1..=MOST_POINTS).contains(count));
    let announced: usize = announced.ok_or_else(|| (head.number, PtsFault::Count(quoted(head.words))))?;
    lines.entry("{", "{")?;
    let mut points = Vec::new();
    let end = loop {
        let line = lines.next().ok_or_else(|| lines.end("}"))?;
        if line.words == "}" {
            break line.number;
        }
        if points.len() == announced {
            let found = announced + 1 + lines.by_ref().take_while(|line| line.words != "}").count();
            return Err((line.number, PtsFault::OtherCount { announced, found }));
        }
        points.push(point(line.words).ok_or_else(|| (line.number, PtsFault::Point(quoted(line.words))))?);
    };
    match lines.next() {
        Some(line) => Err((line.number, PtsFault::Unexpected { expected: "the end", found: quoted(line.words) })),
        None if points.len() < announced => Err((end, PtsFault::OtherCount { announced, found: points.len() })),
        None => Ok(points),
    }
}

/// Line that is not empty.
struct Line<'a> {
    number: u64,
    words: &'a str,
}

/// Lines that are not empty, with their numbers.
struct Lines<'a> {
    rest: std::str::Lines<'a>,
    read: u64,
}

impl<'a> Lines<'a> {
    fn new(text: &'a str) -> Self {
        Self { rest: text.trim_start_matches('\u{feff}').lines(), read: 0 }
    }

    /// Rest of the next line, which has to begin with `word`.
    fn entry(&mut self, word: &str, expected: &'static str) -> Result<Line<'a>, (u64, PtsFault)> {
        let Some(Line { number, words }) = self.next() else { return Err(self.end(expected)) };
        let unexpected = || (number, PtsFault::Unexpected { expected, found: quoted(words) });
        let words = words.strip_prefix(word).ok_or_else(unexpected)?.trim();
        if word == "{" && !words.is_empty() {
            return Err(unexpected());
        }
        Ok(Line { number, words })
    }

    fn end(&self, before: &'static str) -> (u64, PtsFault) {
        (self.read + 1, PtsFault::End(before))
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = Line<'a>;

    fn next(&mut self) -> Option<Line<'a>> {
        loop {
            let words = self.rest.next()?.trim();
            self.read += 1;
            if !words.is_empty() {
                return Some(Line { number: self.read, words });
            }
        }
    }
}

fn point(line: &str) -> Option<DVec2> {
    let mut words = line.split_whitespace();
    let mut number = || words.next()?.parse::<f64>().ok().filter(|number| number.is_finite());
    let pixel = DVec2::new(number()?, number()?);
    words.next().is_none().then_some(pixel)
}

/// Start of a line, for an error.
fn quoted(line: &str) -> String {
    let mut letters = line.chars().map(|letter| if letter.is_control() { ' ' } else { letter });
    let start: String = letters.by_ref().take(QUOTED).collect();
    if letters.next().is_some() { format!("{start}…") } else { start }
}

/// Places that are no complete list of a known set.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{} of the {} points are missing, first \"{first}\"", missing, set.names().len())]
pub struct IncompleteSet {
    /// Set with the fewest missing points.
    pub set: LandmarkSet,
    /// Number of missing points.
    pub missing: usize,
    /// First missing point.
    pub first: &'static str,
}

/// Landmarks in the order of the largest set that they are complete for.
///
/// # Errors
///
/// [`IncompleteSet`] if a point is missing in every set.
pub fn in_order_of_a_set(landmarks: &[PictureLandmark]) -> Result<Vec<&PictureLandmark>, IncompleteSet> {
    let with_name = |name: &&str| landmarks.iter().find(|landmark| landmark.name.key() == name.to_lowercase());
    let mut nearest = IncompleteSet { set: LandmarkSet::SixtyEight, missing: usize::MAX, first: "" };
    for set in LandmarkSet::ALL {
        let missing: Vec<&'static str> = set.names().iter().filter(|name| with_name(name).is_none()).copied().collect();
        let Some(&first) = missing.first() else {
            return Ok(set.names().iter().filter_map(with_name).collect());
        };
        if missing.len() < nearest.missing {
            nearest = IncompleteSet { set, missing: missing.len(), first };
        }
    }
    Err(nearest)
}

/// Writes landmarks of a picture of `size` pixels, in their order, as a PTS file. Coordinates have six decimals.
///
/// # Errors
///
/// If `out` cannot be written, or a coordinate is infinite or not a number.
pub fn write_pts<'a>(
    out: &mut impl Write,
    landmarks: impl IntoIterator<Item = &'a PictureLandmark>,
    size: [u32; 2],
) -> io::Result<()> {
    let pixels: Vec<DVec2> = landmarks.into_iter().map(|landmark| landmark.place * size_of(size) + SIDE).collect();
    super::finite::check_finite(&pixels)?;
    writeln!(out, "version: 1\nn_points: {}\n{{", pixels.len())?;
    for pixel in pixels {
        writeln!(out, "{:.6} {:.6}", pixel.x, pixel.y)?;
    }
    writeln!(out, "}}")
}

/// Place on a picture as a list of two numbers.
mod share_list {
    use glam::DVec2;
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub(super) fn serialize<S: Serializer>(place: &DVec2, serializer: S) -> Result<S::Ok, S::Error> {
        place.to_array().serialize(serializer)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<DVec2, D::Error> {
        <[f64; 2]>::deserialize(deserializer).map(DVec2::from)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TWO: &str = "version: 1\nn_points: 2\n{\n1 1\n320.5 240.25\n}\n";

    fn fault(text: &str) -> (u64, PtsFault) {
        parse_pts(text).expect_err("faulty")
    }

    #[test]
    fn points_are_read_in_their_order() {
        let expected = vec![DVec2::ONE, DVec2::new(320.5, 240.25)];
        assert_eq!(parse_pts(TWO), Ok(expected.clone()));
        // Files of the data sets differ in white space and line ends.
        let loose = "\u{feff}version:1\r\nn_points:  2\r\n{\r\n  1.0\t1.0\r\n\r\n3.205e2 240.25 \r\n}";
        assert_eq!(parse_pts(loose), Ok(expected));
    }

    #[test]
    fn the_centre_of_the_first_pixel_is_1_1() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("two.pts");
        std::fs::write(&path, "version: 1\nn_points: 2\n{\n1 1\n4.5 2.5\n}\n").unwrap();
        let landmarks = read_pts(&path, [4, 2]).unwrap();
        assert_eq!(landmarks[0].place, DVec2::new(0.125, 0.25));
        assert_eq!(landmarks[1].place, DVec2::ONE, "the corner at the lower right");
        assert_eq!(landmarks[1].name.as_str(), "point 2");
    }

    #[test]
    fn a_written_file_comes_back_to_its_decimals() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("five.pts");
        let text = "version: 1\nn_points: 5\n{\n10.123457 20.000001\n30.5 20.25\n20 30\n12 40\n639.999999 480.5\n}\n";
        std::fs::write(&path, text).unwrap();
        let landmarks = read_pts(&path, [640, 480]).unwrap();
        let mut out = Vec::new();
        write_pts(&mut out, &landmarks, [640, 480]).unwrap();
        let written = String::from_utf8(out).unwrap();
        assert_eq!(parse_pts(&written), parse_pts(text));
        assert!(written.starts_with("version: 1\nn_points: 5\n{\n10.123457 20.000001\n"), "{written}");
    }

    #[test]
    fn a_fault_names_its_line() {
        for (text, line) in [
            ("", 1),
            ("\n\nversion: 2\n", 3),
            ("points\n", 1),
            ("version: 1\nn_points: many\n", 2),
            ("version: 1\nn_points: 0\n", 2),
            ("version: 1\nn_points: -1\n", 2),
            ("version: 1\nn_points: 99999999999999999999\n", 2),
            ("version: 1\nn_points: 1000000\n", 2),
            ("version: 1\nn_points: 2\n1 1\n", 3),
            ("version: 1\nn_points: 2\n{ 1 1\n", 3),
            ("version: 1\nn_points: 2\n{\n1 1\n2\n}\n", 5),
            ("version: 1\nn_points: 2\n{\n1 1\n2 2 2\n}\n", 5),
            ("version: 1\nn_points: 2\n{\n1 1\nnan 2\n}\n", 5),
            ("version: 1\nn_points: 2\n{\n1 1\n1e999 2\n}\n", 5),
            ("version: 1\nn_points: 2\n{\n1 1\n", 5),
            ("version: 1\nn_points: 2\n{\n1 1\n}\n", 5),
            ("version: 1\nn_points: 1\n{\n1 1\n2 2\n3 3\n}\n", 5),
            ("version: 1\nn_points: 1\n{\n1 1\n}\nmore\n", 6),
        ] {
            assert_eq!(fault(text).0, line, "{text:?} {:?}", fault(text));
        }
        let (_, more) = fault("version: 1\nn_points: 1\n{\n1 1\n2 2\n3 3\n}\n");
        assert_eq!(more, PtsFault::OtherCount { announced: 1, found: 3 });
    }

    #[test]
    fn hostile_text_is_refused_in_short_words() {
        let long = "x".repeat(1 << 20);
        for text in [
            long.clone(),
            format!("version: 1\nn_points: {long}\n"),
            format!("version: 1\nn_points: 1\n{{\n{long}\n}}\n"),
            "version: \u{1b}[31m1\n".to_owned(),
            "\0\0\0\0".to_owned(),
        ] {
            let words = fault(&text).1.to_string();
            assert!(words.chars().count() < 120 && !words.chars().any(char::is_control), "{words}");
        }
    }

    #[test]
    fn any_damage_to_a_file_gives_points_or_a_fault() {
        for cut in 0..TWO.len() {
            drop(parse_pts(&TWO[..cut]));
            for byte in [b'0', b'{', b'}', b'\n', b' ', b'-', b'e'] {
                let mut damaged = TWO.as_bytes().to_vec();
                damaged[cut] = byte;
                if let Ok(points) = parse_pts(&String::from_utf8(damaged).unwrap()) {
                    assert!(points.iter().all(|point| point.is_finite()));
                }
            }
        }
    }

    #[test]
    fn landmarks_are_written_in_the_order_of_the_largest_complete_set() {
        let landmark = |name: &str| PictureLandmark { name: PinName::new(name).unwrap(), place: DVec2::ZERO };
        let mut landmarks: Vec<PictureLandmark> =
            LandmarkSet::Twelve.names().iter().rev().map(|name| landmark(name)).collect();
        landmarks.push(landmark("a mole"));
        let ordered = in_order_of_a_set(&landmarks).unwrap();
        let names: Vec<&str> = ordered.iter().map(|landmark| landmark.name.as_str()).collect();
        assert_eq!(names, LandmarkSet::Twelve.names());
        landmarks.retain(|landmark| landmark.name.as_str() != "lower lip");
        let error = in_order_of_a_set(&landmarks).unwrap_err();
        assert_eq!((error.set, error.missing, error.first), (LandmarkSet::Twelve, 1, "lower lip"));
    }
}
