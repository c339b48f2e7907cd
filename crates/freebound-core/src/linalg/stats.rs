//! Size of a factorization.

/// Size of a factorization, and the number of pivots replaced to make it possible.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FactorStats {
    /// Pivots that were too small and were replaced. Zero for a Hermitian definite matrix; for an augmented one 1 stands for
    /// any number.
    pub replaced_pivots: usize,
    /// Memory of the numbers that are kept, explicit zeros included, in bytes.
    pub factor_bytes: usize,
    /// The most numeric memory in use at one time while factoring, the factors included, in bytes.
    pub peak_bytes: usize,
}
