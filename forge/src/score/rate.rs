//! Shares with Wilson's interval.

use serde::{Deserialize, Serialize};

/// Quantile of the normal distribution for 95 %.
const Z: f64 = 1.959_963_984_540_054;

/// So many of so many.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Rate {
    /// Times that it was so.
    pub hits: usize,
    /// Times that it could have been.
    pub of: usize,
}

impl Rate {
    /// Counts one more.
    pub fn add(&mut self, hit: bool) {
        self.hits += usize::from(hit);
        self.of += 1;
    }

    /// Counts how often a condition holds.
    pub fn over<T>(all: impl IntoIterator<Item = T>, hit: impl Fn(&T) -> bool) -> Self {
        let mut rate = Self::default();
        for one in all {
            rate.add(hit(&one));
        }
        rate
    }

    /// The share; none of nothing.
    #[must_use]
    pub fn share(self) -> Option<f64> {
        (self.of > 0).then(|| self.hits as f64 / self.of as f64)
    }

    /// Wilson's 95 % interval of the share.
    #[must_use]
    pub fn wilson(self) -> (f64, f64) {
        let Some(share) = self.share() else { return (0.0, 1.0) };
        let count = self.of as f64;
        let scale = 1.0 + Z * Z / count;
        let middle = (share + Z * Z / (2.0 * count)) / scale;
        let half = Z / scale * (share * (1.0 - share) / count + Z * Z / (4.0 * count * count)).sqrt();
        ((middle - half).max(0.0), (middle + half).min(1.0))
    }

    /// For tables: `93.3 % (88-96) 140/150`.
    #[must_use]
    pub fn text(self) -> String {
        let (low, high) = self.wilson();
        match self.share() {
            None => "-".to_owned(),
            Some(share) => {
                format!("{:.1} % ({:.0}-{:.0}) {}/{}", 100.0 * share, 100.0 * low, 100.0 * high, self.hits, self.of)
            }
        }
    }
}
