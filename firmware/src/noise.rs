//! Noise of sensors, the same on every board.

/// Nearly normal noise: the sum of four even ones.
#[derive(Debug, Clone)]
pub struct Noise(u32);

impl Noise {
    /// From the beginning.
    #[must_use]
    #[allow(clippy::new_without_default, reason = "a sequence has a beginning, not a default")]
    pub fn new() -> Self {
        Self(1)
    }

    /// The next value.
    pub fn next(&mut self, rms: f64) -> f64 {
        let mut sum = 0.0;
        for _ in 0..4 {
            self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            sum += f64::from(self.0.cast_signed() >> 8) / f64::from(1 << 23);
        }
        0.866 * rms * sum
    }
}
