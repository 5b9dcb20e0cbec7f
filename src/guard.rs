//! Inputs as the law may take them: finite and inside their ranges.

use crate::config::Range;
use crate::faults::Faults;
use crate::number::Number;
use crate::signals::Input;
use crate::stored::stored;
use crate::units::Units;

/// Largest inputs, as [`Number::beyond`] compares with them.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub(crate) struct Law {
    pub(crate) radial_accel: u32,
    pub(crate) axial_accel: u32,
    pub(crate) rate: u32,
    pub(crate) torque: u32,
}

stored!([] Law { radial_accel, axial_accel, rate, torque });

impl Law {
    pub(crate) fn build<N: Number>(range: &Range, units: &Units) -> Self {
        Self {
            radial_accel: N::quantise(range.radial_accel_mps2, units.accel).limit(),
            axial_accel: N::quantise(range.axial_accel_mps2, units.accel).limit(),
            rate: N::quantise(range.rate_radps, units.rate).limit(),
            torque: N::quantise(range.torque_nm, units.torque).limit(),
        }
    }

    /// Takes `input` for the row, as the law may take it: each value clamped to its range, or left as it was in the last
    /// row where it is not a number.
    #[inline(always)]
    pub(crate) fn admit<N: Number>(&self, row: &mut Input<N>, input: &Input<N>, faults: &mut Faults) {
        if self.admits(input) {
            *row = *input;
        } else {
            *faults |= self.mend(row, input);
        }
    }

    /// Whether the row may be taken as it is.
    #[inline(always)]
    pub(crate) fn admits<N: Number>(&self, input: &Input<N>) -> bool {
        !(input.accel_x_mps2.beyond(self.radial_accel)
            || input.accel_y_mps2.beyond(self.radial_accel)
            || input.accel_z_mps2.beyond(self.axial_accel)
            || input.vehicle_rate_radps.beyond(self.rate)
            || input.torque_nm.beyond(self.torque)
            || input.spin_rate_radps.beyond(self.rate))
    }

    #[cold]
    #[inline(never)]
    fn mend<N: Number>(&self, row: &mut Input<N>, input: &Input<N>) -> Faults {
        admit(&mut row.accel_x_mps2, input.accel_x_mps2, self.radial_accel)
            | admit(&mut row.accel_y_mps2, input.accel_y_mps2, self.radial_accel)
            | admit(&mut row.accel_z_mps2, input.accel_z_mps2, self.axial_accel)
            | admit(&mut row.vehicle_rate_radps, input.vehicle_rate_radps, self.rate)
            | admit(&mut row.torque_nm, input.torque_nm, self.torque)
            | admit(&mut row.spin_rate_radps, input.spin_rate_radps, self.rate)
    }
}

/// One value; in one place, for the sake of the program's size.
#[inline(never)]
fn admit<N: Number>(value: &mut N, given: N, limit: u32) -> Faults {
    if !given.beyond(limit) {
        *value = given;
        Faults::NONE
    } else if given.is_number() {
        *value = if given > N::ZERO { N::of_limit(limit) } else { -N::of_limit(limit) };
        Faults::INPUT_OUT_OF_RANGE
    } else {
        Faults::INPUT_NOT_FINITE
    }
}
