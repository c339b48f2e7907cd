//! Errors of a factorization or a solve.

/// Reason for which a system was not solved. Every `row` is a row of the caller's matrix.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LinalgError {
    /// The pattern is not square.
    #[error("the matrix has {rows} rows and {columns} columns, expected a square matrix")]
    NotSquare {
        /// Rows of the pattern.
        rows: usize,
        /// Columns of the pattern.
        columns: usize,
    },

    /// The pattern is not symmetric with a full diagonal, as [`Analysis`](super::Analysis) requires.
    #[error("the pattern is not symmetric with a full diagonal: ({row}, {column}) has no counterpart")]
    PatternNotSymmetric {
        /// Row of the entry whose mirror image, or diagonal entry, is missing.
        row: usize,
        /// Column of the entry.
        column: usize,
    },

    /// The nonzeros of the matrix are not those of the analysed pattern.
    #[error("the matrix does not have the pattern that was analysed")]
    OtherPattern,

    /// A right-hand side has the wrong length.
    #[error("the right-hand side has {found} entries, expected a multiple of {order}")]
    WrongLength {
        /// Order of the matrix.
        order: usize,
        /// Number of entries given.
        found: usize,
    },

    /// An entry of the matrix or of the right-hand side is infinite or not a number.
    #[error("row {row} has an entry that is not finite")]
    NotFinite {
        /// Row that holds the entry.
        row: usize,
    },

    /// The Hermitian matrix is not definite.
    #[error("the matrix is not definite: elimination stopped at row {row}")]
    NotPositiveDefinite {
        /// Row whose pivot was not positive.
        row: usize,
    },

    /// The matrix is singular to working precision.
    #[error("the matrix is singular to working precision at row {row}")]
    Singular {
        /// Row that depends on the others.
        row: usize,
    },

    /// Refinement ended, but the solution does not satisfy the system.
    #[error("relative residual {residual:.1e} is above the limit {limit:.1e}")]
    ResidualTooLarge {
        /// Relative residual ‖Ax − b‖ / ‖b‖.
        residual: f64,
        /// Largest accepted residual.
        limit: f64,
    },

    /// The factor needs more entries than indices can count, or more memory than available.
    #[error("the factorization of {order} unknowns is too large")]
    TooLarge {
        /// Order of the matrix.
        order: usize,
    },

    /// The caller cancelled.
    #[error("the factorization was cancelled")]
    Cancelled,
}
