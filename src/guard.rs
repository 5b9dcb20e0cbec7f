//! Inputs as the law may take them: finite and inside their ranges.

use crate::config::Range;
use crate::faults::Faults;
use crate::number::Number;
use crate::signals::Input;
use crate::units::Units;

/// Largest inputs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Law<N> {
    pub(crate) radial_accel: N,
    pub(crate) axial_accel: N,
    pub(crate) rate: N,
    pub(crate) torque: N,
}

impl<N: Number> Law<N> {
    pub(crate) fn build(range: &Range, units: &Units) -> Self {
        Self {
            radial_accel: N::quantise(range.radial_accel_mps2, units.accel),
            axial_accel: N::quantise(range.axial_accel_mps2, units.accel),
            rate: N::quantise(range.rate_radps, units.rate),
            torque: N::quantise(range.torque_nm, units.torque),
        }
    }

    /// Makes the row one that the law may take: each value clamped to its range, or replaced by the last good one where
    /// it is not a number.
    #[inline(always)]
    pub(crate) fn admit(&self, last: &Input<N>, row: &mut Input<N>) -> Faults {
        if self.admits(row) { Faults::NONE } else { self.mend(last, row) }
    }

    /// Whether the row may be taken as it is: one branch for all six.
    #[inline(always)]
    pub(crate) fn admits(&self, row: &Input<N>) -> bool {
        row.accel_x_mps2.within(self.radial_accel)
            & row.accel_y_mps2.within(self.radial_accel)
            & row.accel_z_mps2.within(self.axial_accel)
            & row.vehicle_rate_radps.within(self.rate)
            & row.torque_nm.within(self.torque)
            & row.spin_rate_radps.within(self.rate)
    }

    #[cold]
    #[inline(never)]
    fn mend(&self, last: &Input<N>, row: &mut Input<N>) -> Faults {
        let mut faults = Faults::NONE;
        let mut admit = |value: &mut N, last: N, limit: N| {
            if value.within(limit) {
                return;
            }
            if value.is_number() {
                faults |= Faults::INPUT_OUT_OF_RANGE;
                *value = if *value > N::ZERO { limit } else { -limit };
            } else {
                faults |= Faults::INPUT_NOT_FINITE;
                *value = last;
            }
        };
        admit(&mut row.accel_x_mps2, last.accel_x_mps2, self.radial_accel);
        admit(&mut row.accel_y_mps2, last.accel_y_mps2, self.radial_accel);
        admit(&mut row.accel_z_mps2, last.accel_z_mps2, self.axial_accel);
        admit(&mut row.vehicle_rate_radps, last.vehicle_rate_radps, self.rate);
        admit(&mut row.torque_nm, last.torque_nm, self.torque);
        admit(&mut row.spin_rate_radps, last.spin_rate_radps, self.rate);
        faults
    }
}
