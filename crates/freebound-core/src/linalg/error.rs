//! Everything that can stop a factorization or a solve.

/// Why a system was not solved. Every `row` is a row of the caller's matrix.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LinalgError {
    /// The pattern is not square.
    #[error("the matrix has {rows} rows and {columns} columns, expected as many of both")]
    NotSquare {
        /// Rows of the pattern.
        rows: usize,
        /// Columns of the pattern.
        columns: usize,
    },

    /// The pattern is not one that [`Analysis`](super::Analysis) takes.
    #[error("the pattern is not symmetric with a full diagonal: entry ({row}, {column}) has no counterpart")]
    PatternNotSymmetric {
        /// Row of the entry whose mirror image, or diagonal place, is missing.
        row: usize,
        /// Its column.
        column: usize,
    },

    /// The matrix has other nonzeros than the pattern that was analysed.
    #[error("the matrix does not have the pattern that was analysed")]
    OtherPattern,

    /// A right-hand side of the wrong length.
    #[error("the right-hand side has {found} entries, expected a multiple of {order}")]
    WrongLength {
        /// Order of the matrix.
        order: usize,
        /// Entries given.
        found: usize,
    },

    /// An entry of the matrix or of the right-hand side is infinite or not a number.
    #[error("row {row} has an entry that is not finite")]
    NotFinite {
        /// The row that holds the entry.
        row: usize,
    },

    /// The Hermitian matrix is not definite.
    #[error("the matrix is not definite: elimination stopped at row {row}")]
    NotPositiveDefinite {
        /// The row whose pivot was not positive.
        row: usize,
    },

    /// The matrix is singular to working precision.
    #[error("the matrix is singular to working precision at row {row}")]
    Singular {
        /// A row that depends on the others.
        row: usize,
    },

    /// Refinement ended, but the answer does not satisfy the system.
    #[error("relative residual {residual:.1e} is above the limit {limit:.1e}")]
    ResidualTooLarge {
        /// ‖Ax − b‖ / ‖b‖.
        residual: f64,
        /// The limit in force.
        limit: f64,
    },

    /// The factor would need more entries than indices can count, or more memory than there is.
    #[error("the factorization of {order} unknowns is too large")]
    TooLarge {
        /// Order of the matrix.
        order: usize,
    },

    /// The caller asked to stop.
    #[error("the factorization was cancelled")]
    Cancelled,
}
