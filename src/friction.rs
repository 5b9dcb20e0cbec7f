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
use crate::stored::stored;
use crate::units::Units;

/// The clamp.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Law<N: Number> {
    /// `w_s`.
    pub(crate) slip_rate: N,
    /// `1 / w_s`, of rates times `2^steepness_shift`, halved.
    pub(crate) steepness: N::Coef,
    pub(crate) steepness_shift: u32,
}

stored!([N: Number] Law<N> { slip_rate, steepness, steepness_shift });

/// A period that starts in the clamp's zone: `w(1) = w_s level / stiffness` if it ends there, too.
#[derive(Clone, Copy)]
pub(crate) struct Zone<N> {
    /// Half of the clamp at the start.
    half_here: N,
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
        self.half_here + self.level.ratio(self.stiffness).half()
    }
}

impl<N: Number> Law<N> {
    pub(crate) fn build(slip_rate_radps: f64, units: &Units) -> Self {
        // A rate in the zone times this still fits.
        let shift = (units.rate - N::exponent(slip_rate_radps)).max(0);
        Self {
            slip_rate: N::quantise(slip_rate_radps, units.rate),
            steepness: N::coef(N::rescaled(0.5 / slip_rate_radps, units.rate - shift)),
            steepness_shift: shift.unsigned_abs(),
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
            let half = self.half_part(rate);
            half + half
        }
    }

    /// `w / (2 w_s)` within the zone.
    #[inline(always)]
    fn half_part(&self, rate: N) -> N {
        N::head(self.steepness * rate.times_power(self.steepness_shift))
    }

    /// m, for the rate `start` at the start of the period, `free_end` at its end without friction, and b.
    #[inline(always)]
    pub(crate) fn mean(&self, start: N, free_end: N, brake: N) -> N {
        let slip = self.slip_rate;
        if start >= slip {
            // Slipping one way throughout.
            if free_end - brake >= slip { N::ONE } else { self.mean_from_slip(start, free_end, brake) }
        } else if start <= -slip {
            if free_end + brake <= -slip { -N::ONE } else { -self.mean_from_slip(-start, -free_end, brake) }
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
        let half_here = self.half_part(start);
        Zone { half_here, level: free_end - brake.times(half_here), stiffness: self.slip_rate + brake.half() }
    }

    /// The zone is where the period starts; it may be left on either side.
    #[inline(always)]
    fn mean_from_zone(&self, start: N, free_end: N, brake: N) -> N {
        let zone = self.zone(start, free_end, brake);
        if zone.is_kept() {
            zone.mean()
        } else if zone.level > N::ZERO {
            self.mean_out_of_zone(start, free_end, brake, zone.half_here)
        } else {
            -self.mean_out_of_zone(-start, -free_end, brake, -zone.half_here)
        }
    }

    /// The zone is left above.
    #[inline(never)]
    fn mean_out_of_zone(&self, start: N, free_end: N, brake: N, half_here: N) -> N {
        let inside = half_here + N::ONE.half();
        let before = (self.slip_rate - start).ratio(free_end - start - brake.times(inside));
        before.times(inside) + (N::ONE - before)
    }
}
