//! Random numbers with the same bits on every host.

use core::f64::consts::TAU;

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// One stream.
#[derive(Debug, Clone)]
pub(crate) struct Random(ChaCha8Rng);

impl Random {
    /// The stream `stream` of a seed; streams do not overlap.
    pub(crate) fn new(seed: u64, stream: u64) -> Self {
        let mut source = ChaCha8Rng::seed_from_u64(seed);
        source.set_stream(stream);
        Self(source)
    }

    /// Uniform from 0, included, to 1, excluded.
    pub(crate) fn share(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / 9_007_199_254_740_992.0
    }

    /// Whether something of this probability happens.
    pub(crate) fn happens(&mut self, probability: f64) -> bool {
        self.share() < probability
    }

    /// Uniform below `end`.
    pub(crate) fn below(&mut self, end: usize) -> usize {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "below a small number")]
        let index = (self.share() * end as f64) as usize;
        index.min(end.saturating_sub(1))
    }

    /// Normal, of variance 1 (Box and Muller, 1958).
    pub(crate) fn normal(&mut self) -> f64 {
        libm::sqrt(-2.0 * libm::log(1.0 - self.share())) * libm::cos(TAU * self.share())
    }

    /// A byte.
    pub(crate) fn byte(&mut self) -> u8 {
        self.0.next_u32().to_be_bytes()[0]
    }
}
