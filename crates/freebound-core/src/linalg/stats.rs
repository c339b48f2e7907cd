//! Size of a factorization.

/// Size of a factorization, and the number of pivots replaced to make it possible.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FactorStats {
    /// Number of pivots that were too small and were replaced. Zero for a Hermitian definite matrix; for an augmented
    /// matrix, 1 stands for any number.
    pub replaced_pivots: usize,
    /// Memory of the stored numbers in bytes, explicit zeros included.
    pub factor_bytes: usize,
    /// Peak numeric memory in bytes while factoring, the factors included.
    pub peak_bytes: usize,
}
