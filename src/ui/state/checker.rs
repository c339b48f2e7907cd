//! Checker over the plane: its squares, and requests to change it.

/// Fewest and most squares along the page.
pub(in crate::ui) const SQUARES: [u32; 2] = [4, 256];

/// Squares of the checker.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CheckerStyle {
    /// Light and dark squares.
    #[default]
    Plain,
    /// Coloured squares with a letter and a number, from A1 to H8.
    Lettered,
    /// Picture of the user, repeated.
    Picture,
}

impl CheckerStyle {
    /// All styles, in the order of menus.
    pub const ALL: [Self; 3] = [Self::Plain, Self::Lettered, Self::Picture];

    /// Style with a name, if there is one.
    pub(in crate::ui) fn called(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|style| style.words()[0] == name)
    }

    /// Name in menus, and description.
    pub const fn words(self) -> [&'static str; 2] {
        match self {
            Self::Plain => ["Plain squares", "Light and dark squares"],
            Self::Lettered => [
                "Letters and numbers",
                "Coloured squares from A1 to H8, which show at once if a chart is mirrored or turned",
            ],
            Self::Picture => ["Own picture…", "A PNG or JPEG file, repeated: it covers 8 × 8 squares"],
        }
    }
}

/// Request to the checker.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CheckerRequest {
    /// Sets the squares. The user's picture is asked for in a dialog.
    SetStyle(CheckerStyle),
    /// Sets the number of squares along the page, rounded to a power of two. `None`: chosen by the program.
    SetSquares(Option<u32>),
    /// Doubles the number of squares.
    Finer,
    /// Halves the number of squares.
    Coarser,
}

/// Nearest number of squares along the page: a power of two within the limits.
pub(in crate::ui) fn nearest_squares(count: u32) -> u32 {
    let [least, most] = SQUARES;
    let (low, count) = (count.clamp(least, most).ilog2(), count.clamp(least, most));
    // The middle between two powers of two is their geometric mean.
    let is_above = u64::from(count).pow(2) > 2 * (1_u64 << (2 * low));
    (1 << low) << u32::from(is_above)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_of_squares_is_the_nearest_power_of_two_within_the_limits() {
        let expected =
            [(0, 4), (4, 4), (5, 4), (6, 8), (11, 8), (12, 16), (40, 32), (64, 64), (200, 256), (u32::MAX, 256)];
        for (typed, squares) in expected {
            assert_eq!(nearest_squares(typed), squares, "{typed}");
        }
    }
}
