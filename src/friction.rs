//! Mean friction over a period, with the clamp that stands in for stiction solved implicitly.
//!
//! Over one period the bearing's rate w changes by what acts on it without friction, and by friction itself:
//!
//! ```text
//! w(1) = w_free - b m        m = mean over the period of clamp(w / w_s, -1, 1)        b = level * (phi' per N m)
//! ```
//!
//! m depends on w(1). The period is divided where w enters or leaves the clamp's zone `|w| < w_s`: outside it m is
//! +-1 and w a straight line; inside it the mean of both ends is taken, which is stable for every b. A rate that crosses
//! the zone within the period spends equal times on either side of zero in it.

use crate::number::Number;
use crate::row::ScaledRow;
use crate::units::Units;

/// The clamp.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Law<N: Number> {
    /// `w_s`.
    pub(crate) slip_rate: N,
    /// `1 / w_s`.
    pub(crate) steepness: ScaledRow<N, 1>,
}

/// A period that starts in the clamp's zone: `w(1) = w_s level / stiffness` if it ends there, too.
#[derive(Clone, Copy)]
pub(crate) struct Zone<N> {
    /// The clamp at the start.
    here: N,
    level: N,
    stiffness: N,
}

impl<N: Number> Zone<N> {
    /// Whether the period ends in the zone.
    #[inline(always)]
    pub(crate) fn is_kept(&self) -> bool {
        self.level.abs() <= self.stiffness
    }

    /// m, if it does.
    #[inline(always)]
    pub(crate) fn mean(&self) -> N {
        self.here.half() + self.level.ratio(self.stiffness).half()
    }
}

impl<N: Number> Law<N> {
    pub(crate) fn build(slip_rate_radps: f64, units: &Units) -> Self {
        Self {
            slip_rate: N::quantise(slip_rate_radps, units.rate),
            steepness: ScaledRow::build([1.0 / slip_rate_radps], [units.rate], 0),
        }
    }

    /// `clamp(w / w_s, -1, 1)`.
    #[inline(always)]
    pub(crate) fn clamp(&self, rate: N) -> N {
        if rate >= self.slip_rate {
            N::ONE
        } else if rate <= -self.slip_rate {
            -N::ONE
        } else {
            self.steepness.times(rate)
        }
    }

    /// m, for the rate `start` at the start of the period, `free_end` at its end without friction, and b.
    #[inline(always)]
    pub(crate) fn mean(&self, start: N, free_end: N, brake: N) -> N {
        let slip = self.slip_rate;
        // Slipping one way throughout: the common case.
        if start >= slip && free_end - brake >= slip {
            return N::ONE;
        }
        if start <= -slip && free_end + brake <= -slip {
            return -N::ONE;
        }
        if start > slip {
            self.mean_from_slip(start, free_end, brake)
        } else if start < -slip {
            -self.mean_from_slip(-start, -free_end, brake)
        } else {
            self.mean_from_zone(start, free_end, brake)
        }
    }

    /// The zone is entered from above, and perhaps left below.
    #[inline(never)]
    fn mean_from_slip(&self, start: N, free_end: N, brake: N) -> N {
        let slip = self.slip_rate;
        let before = (start - slip).ratio(start - (free_end - brake));
        let rest = N::ONE - before;
        let drive = free_end - start;
        let half_brake = brake.times(rest).half();
        let level = slip + drive.times(rest) - half_brake;
        let stiffness = slip + half_brake;
        if level >= -stiffness {
            before + rest.times((N::ONE.half()) + level.ratio(stiffness).half())
        } else {
            let crossing = (slip + slip).ratio(-drive);
            before - (rest - crossing)
        }
    }

    /// What decides whether the zone, in which the period starts, is left.
    #[inline(always)]
    pub(crate) fn zone(&self, start: N, free_end: N, brake: N) -> Zone<N> {
        let here = self.clamp(start);
        let half_brake = brake.half();
        Zone { here, level: free_end - half_brake.times(here), stiffness: self.slip_rate + half_brake }
    }

    /// The zone is where the period starts; it may be left on either side.
    #[inline(never)]
    fn mean_from_zone(&self, start: N, free_end: N, brake: N) -> N {
        let zone = self.zone(start, free_end, brake);
        let Zone { here, level, .. } = zone;
        if zone.is_kept() {
            zone.mean()
        } else if level > N::ZERO {
            self.mean_out_of_zone(start, free_end, brake, here)
        } else {
            -self.mean_out_of_zone(-start, -free_end, brake, -here)
        }
    }

    /// The zone is left above.
    #[inline(never)]
    fn mean_out_of_zone(&self, start: N, free_end: N, brake: N, here: N) -> N {
        let inside = here.half() + N::ONE.half();
        let before = (self.slip_rate - start).ratio(free_end - start - brake.times(inside));
        before.times(inside) + (N::ONE - before)
    }
}
