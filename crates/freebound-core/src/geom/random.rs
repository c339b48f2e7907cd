//! Reproducible pseudo-random numbers: splitmix64 (Steele, Lea, Flood 2014).

/// Stream of pseudo-random numbers, determined by its seed.
#[derive(Clone, Debug)]
pub struct Random(pub u64);

impl Random {
    /// Stream of one of many runs. Streams of other seeds and of other run numbers are unrelated to it.
    pub fn of_run(seed: u64, number: u64) -> Self {
        let seed = Self(seed).bits();
        Self(Self(seed ^ number).bits())
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Integer in `0..limit`.
    ///
    /// # Panics
    ///
    /// If the limit is 0.
    pub fn below(&mut self, limit: u32) -> u32 {
        u32::try_from(self.bits() % u64::from(limit)).expect("smaller than a u32")
    }

    /// Index into a list of `count` items.
    ///
    /// # Panics
    ///
    /// If the list is empty.
    pub fn index(&mut self, count: usize) -> usize {
        usize::try_from(self.bits() % count as u64).expect("smaller than a usize")
    }

    /// Number in `[0, 1)`.
    pub fn unit(&mut self) -> f64 {
        // The upper 53 bits make a multiple of 2⁻⁵³.
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Number in `[low, high)`.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }
}
