//! Where within a period a signal crosses a level: the root of the cubic through its ends and slopes.

use crate::number::Number;

/// A signal over one period, less the level: values and changes per period at both ends.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Arc<N: Number> {
    pub(crate) start: N,
    pub(crate) end: N,
    pub(crate) start_slope: N,
    pub(crate) end_slope: N,
}

/// Newton steps from the chord's root; the cubic's is met to 1e-5 of a period.
const STEPS: usize = 2;

impl<N: Number> Arc<N> {
    /// The share of the period before the crossing, 0..=1, for `start <= 0 <= end`.
    #[inline(never)]
    pub(crate) fn root(&self) -> N {
        if self.start >= N::ZERO {
            return N::ZERO;
        }
        let mut root = (-self.start).ratio(self.end - self.start);
        let bend = self.bend();
        for _ in 0..STEPS {
            let (value, slope) = (self.at(root, bend), self.slope_at(root, bend));
            // On a falling or flat arc the chord's root stands.
            if slope > value.abs() {
                root = (root - value.ratio(slope)).most(N::ZERO).least(N::ONE);
            }
        }
        root
    }

    /// Change per period at `share` of the period.
    pub(crate) fn slope(&self, share: N) -> N {
        self.slope_at(share, self.bend())
    }

    #[inline(always)]
    fn slope_at(&self, share: N, (quadratic, cubic): (N, N)) -> N {
        let twice = (quadratic + cubic.times(share)).times(share);
        self.start_slope + twice + twice + cubic.times(share).times(share)
    }

    #[inline(always)]
    fn at(&self, share: N, (quadratic, cubic): (N, N)) -> N {
        self.start + (self.start_slope + (quadratic + cubic.times(share)).times(share)).times(share)
    }

    /// Factors of the share's square and cube.
    #[inline(always)]
    fn bend(&self) -> (N, N) {
        let chord = self.end - self.start;
        let start_lag = chord - self.start_slope;
        let end_lag = chord - self.end_slope;
        (start_lag + start_lag + end_lag, -(start_lag + end_lag))
    }
}
