//! Numbered sets of landmarks on faces, with a name for each number.
//!
//! Left and right are the person's: on a photo, the right eye is on the left. All sets number what is on the left of the
//! photo first, except the set of 12, which is the list of the built-in face.
//!
//! | points | source of the numbering                                                          |
//! |--------|----------------------------------------------------------------------------------|
//! | 5      | five points of face detectors: eyes, tip of the nose, corners of the mouth       |
//! | 12     | list of the built-in face                                                        |
//! | 68     | Sagonas et al., 300 Faces In-the-Wild (2013), after Multi-PIE: jaw 1–17, brows 18–27, nose 28–36, eyes 37–48, mouth 49–68 |
//!
//! A point has one name in all sets, so that lists of different lengths can be joined.

use super::PinName;

/// Names of the five points of face detectors.
const FIVE: [&str; 5] = [
    "right eye, centre",
    "left eye, centre",
    "tip of the nose",
    "right corner of the mouth",
    "left corner of the mouth",
];

/// Names of the landmarks of the built-in face.
const TWELVE: [&str; 12] = [
    "left eye, outer corner",
    "left eye, inner corner",
    "right eye, inner corner",
    "right eye, outer corner",
    "bridge of the nose",
    "tip of the nose",
    "left wing of the nose",
    "right wing of the nose",
    "upper lip",
    "left corner of the mouth",
    "right corner of the mouth",
    "lower lip",
];

/// Names of the 68 points of 300-W.
const SIXTY_EIGHT: [&str; 68] = [
    "right jaw 1, at the ear",
    "right jaw 2",
    "right jaw 3",
    "right jaw 4",
    "right jaw 5",
    "right jaw 6",
    "right jaw 7",
    "right jaw 8",
    "chin",
    "left jaw 8",
    "left jaw 7",
    "left jaw 6",
    "left jaw 5",
    "left jaw 4",
    "left jaw 3",
    "left jaw 2",
    "left jaw 1, at the ear",
    "right brow, outer end",
    "right brow, outer quarter",
    "right brow, middle",
    "right brow, inner quarter",
    "right brow, inner end",
    "left brow, inner end",
    "left brow, inner quarter",
    "left brow, middle",
    "left brow, outer quarter",
    "left brow, outer end",
    "bridge of the nose",
    "ridge of the nose, upper third",
    "ridge of the nose, lower third",
    "tip of the nose",
    "right wing of the nose",
    "right nostril",
    "base of the nose",
    "left nostril",
    "left wing of the nose",
    "right eye, outer corner",
    "right eye, upper lid, outer",
    "right eye, upper lid, inner",
    "right eye, inner corner",
    "right eye, lower lid, inner",
    "right eye, lower lid, outer",
    "left eye, inner corner",
    "left eye, upper lid, inner",
    "left eye, upper lid, outer",
    "left eye, outer corner",
    "left eye, lower lid, outer",
    "left eye, lower lid, inner",
    "right corner of the mouth",
    "upper lip, right third",
    "upper lip, right peak",
    "upper lip",
    "upper lip, left peak",
    "upper lip, left third",
    "left corner of the mouth",
    "lower lip, left third",
    "lower lip, left of the middle",
    "lower lip",
    "lower lip, right of the middle",
    "lower lip, right third",
    "right corner of the mouth, inside",
    "upper lip, inside, right",
    "upper lip, inside",
    "upper lip, inside, left",
    "left corner of the mouth, inside",
    "lower lip, inside, left",
    "lower lip, inside",
    "lower lip, inside, right",
];

/// Numbered set of landmarks on a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LandmarkSet {
    /// Eyes, tip of the nose, corners of the mouth.
    Five,
    /// Landmarks of the built-in face.
    Twelve,
    /// Landmarks of 300-W.
    SixtyEight,
}

impl LandmarkSet {
    /// All sets, from the largest to the smallest.
    pub const ALL: [Self; 3] = [Self::SixtyEight, Self::Twelve, Self::Five];

    /// Names of the points, in the order of their numbers.
    pub const fn names(self) -> &'static [&'static str] {
        match self {
            Self::Five => &FIVE,
            Self::Twelve => &TWELVE,
            Self::SixtyEight => &SIXTY_EIGHT,
        }
    }

    /// Set with this number of points.
    pub fn of_count(count: usize) -> Option<Self> {
        Self::ALL.into_iter().find(|set| set.names().len() == count)
    }

    /// Name of a point of a list with `count` points; the place counts from 0. Points of an unknown list are numbered
    /// from 1.
    ///
    /// # Panics
    ///
    /// If a name of a set is longer than the longest name; a test reads all of them.
    pub fn name_of(count: usize, place: usize) -> PinName {
        let known = Self::of_count(count).and_then(|set| set.names().get(place));
        let name = known.map_or_else(|| format!("point {}", place + 1), |name| (*name).to_owned());
        PinName::new(&name).expect("a test reads the names of all sets")
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn all_points_of_a_set_have_names_of_their_own() {
        for set in LandmarkSet::ALL {
            let count = set.names().len();
            let names: BTreeSet<String> = (0..count).map(|place| LandmarkSet::name_of(count, place).key()).collect();
            assert_eq!(names.len(), count, "{set:?}");
        }
    }

    #[test]
    fn the_numbers_of_300_w_name_what_their_figure_shows() {
        let name = |number: usize| LandmarkSet::SixtyEight.names()[number - 1];
        // The figure numbers from 1; the person's right is on the left of the picture.
        for (number, expected) in [
            (1, "right jaw 1, at the ear"),
            (9, "chin"),
            (17, "left jaw 1, at the ear"),
            (18, "right brow, outer end"),
            (27, "left brow, outer end"),
            (28, "bridge of the nose"),
            (31, "tip of the nose"),
            (34, "base of the nose"),
            (37, "right eye, outer corner"),
            (40, "right eye, inner corner"),
            (43, "left eye, inner corner"),
            (46, "left eye, outer corner"),
            (49, "right corner of the mouth"),
            (52, "upper lip"),
            (55, "left corner of the mouth"),
            (58, "lower lip"),
            (61, "right corner of the mouth, inside"),
            (65, "left corner of the mouth, inside"),
        ] {
            assert_eq!(name(number), expected, "{number}");
        }
    }

    #[test]
    fn left_and_right_are_mirror_images_in_the_set_of_68() {
        let mirrored = |name: &str| {
            let swapped = name.replace("left", "?").replace("right", "left");
            swapped.replace('?', "right")
        };
        let names: BTreeSet<&str> = SIXTY_EIGHT.into_iter().collect();
        for name in SIXTY_EIGHT {
            assert!(names.contains(mirrored(name).as_str()), "{name}");
        }
    }

    #[test]
    fn the_landmarks_of_the_built_in_face_are_points_of_the_set_of_68() {
        assert!(TWELVE.iter().all(|name| SIXTY_EIGHT.contains(name)));
    }

    #[test]
    fn points_of_an_unknown_list_are_numbered() {
        assert_eq!(LandmarkSet::name_of(29, 28).as_str(), "point 29");
    }
}
