//! Random numbers with the same bits on every host: `ChaCha8` streams, Box-Muller by `libm`.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{RngCore, SeedableRng};

/// Seed of a corpus; each log has a stream of its own.
pub type Seed = [u8; 32];

/// One stream of random numbers.
#[derive(Debug, Clone)]
pub struct Draw {
    source: ChaCha8Rng,
}

impl Draw {
    /// The stream `stream` of a seed. Streams do not overlap.
    #[must_use]
    pub fn new(seed: &Seed, stream: u64) -> Self {
        let mut source = ChaCha8Rng::from_seed(*seed);
        source.set_stream(stream);
        Self { source }
    }

    /// A seed made of a number, for tests and for corpora that need no secret.
    #[must_use]
    pub fn seed_of(number: u64) -> Seed {
        let mut seed = [0; 32];
        seed[..8].copy_from_slice(&number.to_le_bytes());
        seed
    }

    /// A new stream that starts from this one.
    #[must_use]
    pub fn fork(&mut self) -> Self {
        let mut seed = [0; 32];
        self.source.fill_bytes(&mut seed);
        Self::new(&seed, 0)
    }

    /// Uniform in 0 (included) to 1 (excluded).
    pub fn unit(&mut self) -> f64 {
        (self.source.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Uniform between two limits.
    pub fn uniform(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.unit()
    }

    /// Uniform in the logarithm between two positive limits.
    pub fn log_uniform(&mut self, from: f64, to: f64) -> f64 {
        libm::exp(self.uniform(libm::log(from), libm::log(to)))
    }

    /// Mean 0, standard deviation 1.
    pub fn normal(&mut self) -> f64 {
        let radius = libm::sqrt(-2.0 * libm::log(1.0 - self.unit()));
        radius * libm::cos(2.0 * core::f64::consts::PI * self.unit())
    }

    /// Normal, drawn again until it lies within `limit` standard deviations.
    pub fn normal_within(&mut self, limit: f64) -> f64 {
        loop {
            let value = self.normal();
            if value.abs() <= limit {
                return value;
            }
        }
    }

    /// True with the given probability.
    pub fn chance(&mut self, probability: f64) -> bool {
        self.unit() < probability
    }

    /// +1 or -1.
    pub fn sign(&mut self) -> f64 {
        if self.chance(0.5) { 1.0 } else { -1.0 }
    }

    /// A number below `count`, which is at least 1.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // below `count`
    pub fn below(&mut self, count: usize) -> usize {
        ((self.unit() * count as f64) as usize).min(count.saturating_sub(1))
    }

    /// One of several.
    pub fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.below(from.len())]
    }

    /// Puts a list in random order.
    pub fn shuffle<T>(&mut self, list: &mut [T]) {
        for last in (1..list.len()).rev() {
            list.swap(last, self.below(last + 1));
        }
    }
}
