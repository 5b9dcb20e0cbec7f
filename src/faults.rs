//! Fault bits of a step.

use crate::bits::bit_set;

bit_set! {
    /// A set of fault bits.
    Faults {
        /// The gyro sits on a stop: what phi does meanwhile is not seen by it.
        GYRO_SATURATED = 0 "gyro_saturated",
        /// The gyro has left a stop and phi keeps an offset that theta does not show.
        OFFSET_LEFT = 1 "offset_left",
        /// An input lay outside its range and was clamped.
        INPUT_OUT_OF_RANGE = 2 "input_out_of_range",
        /// An input was not finite; the last good value was used.
        INPUT_NOT_FINITE = 3 "input_not_finite",
        /// The load or the rate lay beyond the friction tables, which were read at their end.
        TABLE_END = 4 "table_end",
        /// A sum did not fit: phi beyond 1 rad, a torque beyond its full scale, or the INS sums full.
        ARITHMETIC_SATURATED = 5 "arithmetic_saturated",
        /// phi is beyond 0.1 rad, where the model's linear equations no longer hold.
        SMALL_ANGLE_EXCEEDED = 6 "small_angle_exceeded",
    }
}
