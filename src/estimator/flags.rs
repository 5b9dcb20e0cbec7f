//! What an estimate says of itself.

use crate::bits::bit_set;

bit_set! {
    /// A set of flags.
    Flags {
        /// The gyro sits on a stop: phi is carried by torque balance.
        SATURATED = 0 "saturated",
        /// phi keeps an offset from a saturation, which the gyro does not show; the estimate holds it.
        OFFSET_HELD = 1 "offset_held",
        /// The bound is wider than the widest that is of use.
        BOUND_TOO_WIDE = 2 "bound_too_wide",
        /// theta is predicted to reach its stop within the horizon.
        SATURATION_AHEAD = 3 "saturation_ahead",
        /// The filter settles: after the first row, a release or an outage.
        SETTLING = 4 "settling",
        /// No theta at this row: missing, not finite, beyond the pick-off's range, or held back as a spike.
        GYRO_MISSING = 5 "gyro_missing",
        /// theta has not changed for too many rows.
        GYRO_STUCK = 6 "gyro_stuck",
        /// theta has been missing for longer than can be bridged.
        GYRO_LOST = 7 "gyro_lost",
        /// No motor torque at this row: missing, not finite, out of range, or held back as a spike.
        TORQUE_MISSING = 8 "torque_missing",
        /// The motor torque has not changed for too many rows.
        TORQUE_STUCK = 9 "torque_stuck",
        /// The motor torque has been missing for longer than can be bridged.
        TORQUE_LOST = 10 "torque_lost",
        /// An acceleration or the rate was not finite or out of range.
        INPUT_WRONG = 11 "input_wrong",
        /// An acceleration or the rate jumped, and was held for a row.
        INPUT_SPIKE = 12 "input_spike",
        /// An acceleration or the rate has not changed for too many rows.
        INPUT_STUCK = 13 "input_stuck",
        /// A sensor was not well while phi was carried through a saturation: the offset kept since may be wrong by more
        /// than its bound. Stays set.
        OFFSET_DOUBTFUL = 14 "offset_doubtful",
    }
}

impl Flags {
    /// The faults of theta.
    pub(crate) const GYRO: Self = Self::GYRO_MISSING.union(Self::GYRO_STUCK).union(Self::GYRO_LOST);
    /// Those of the motor torque.
    pub(crate) const TORQUE: Self = Self::TORQUE_MISSING.union(Self::TORQUE_STUCK).union(Self::TORQUE_LOST);
    /// The sensors' faults.
    pub const SENSORS: Self =
        Self::GYRO.union(Self::TORQUE).union(Self::INPUT_WRONG).union(Self::INPUT_SPIKE).union(Self::INPUT_STUCK);
}
