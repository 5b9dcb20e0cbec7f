//! Whether readings can be trusted: missing, stuck, spiking, out of range.
//!
//! A sensor with noise does not give the same reading twice in a row but by chance: an equal reading is taken for no
//! reading, and many of them in a row for a stuck sensor. A change larger than the vehicle can make is held back for one
//! row; if the next row confirms it, it is taken.

use super::config::Config;
use super::flags::Flags;
use super::signals::Measured;
use super::state::State as Memory;
use super::sums::BLOCK;
use crate::faults::Faults;
use crate::number::Number;
use crate::signals::Input;
use crate::stored::stored;
use crate::units::Units;

/// `a_x`, `a_y`, `a_z`, rate.
pub(crate) const INPUTS: usize = 4;

/// Faults of the model's row.
const WRONG: u16 = Faults::INPUT_NOT_FINITE.bits() | Faults::INPUT_OUT_OF_RANGE.bits();

/// Limits of the readings.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Law<N: Number> {
    /// Largest changes of the inputs, as bits.
    jumps: [u32; INPUTS],
    torque_jump: u32,
    gyro_range: N,
    torque_range: N,
    stuck_rows: u32,
    bridge_rows: u32,
    torque_measured: bool,
}

stored!([N: Number] Law<N> { jumps, torque_jump, gyro_range, torque_range, stuck_rows, bridge_rows, torque_measured });

/// Rows in a row, of each trouble.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct State {
    gyro_missing: u32,
    gyro_rejected: u32,
    gyro_equal: u32,
    torque_missing: u32,
    torque_equal: u32,
    torque_held: bool,
    inputs_held: [bool; INPUTS],
}

impl State {
    /// Whether a motor torque that jumped waits for the next row.
    pub(crate) fn torque_waits(&self) -> bool {
        self.torque_held
    }
}

/// Readings that may be used.
pub(crate) struct Admitted<N> {
    pub(crate) gyro: Option<N>,
    pub(crate) torque: Option<N>,
    /// What a jump that has been confirmed would have added to the last period's mean and this one's.
    pub(crate) catch_up: N,
    /// Whether the motor torque held back at the last row was a spike.
    pub(crate) torque_spiked: bool,
    /// Rows in a row without theta, this one included.
    pub(crate) gyro_missing: u32,
    /// Whether theta is back after an outage that was too long for the filter to bridge well.
    pub(crate) gyro_back: bool,
    pub(crate) torque_lost: bool,
    pub(crate) flags: Flags,
}

/// The absolute value's bits, which are in its order.
#[inline(always)]
fn bits_of<N: Number>(value: N) -> u32 {
    value.abs().to_bits()
}

/// Whether a difference is neither zero nor as large as the limit; as bits, in which zero becomes the largest.
#[inline(always)]
fn moved_within<N: Number>(difference: N, limit: u32) -> bool {
    difference.abs().to_bits().wrapping_sub(1) < limit
}

/// Rows of an outage from which on the filter begins anew.
const OUTAGE: u32 = 4;

impl<N: Number> Law<N> {
    pub(crate) fn build(config: &Config, axis: &crate::Config, units: &Units, gyro: i32) -> Self {
        let sensors = &config.sensors;
        let bits = |value: f64, exponent| N::quantise(value, exponent).to_bits();
        let accel = bits(sensors.accel_jump_mps2, units.accel);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 40,000 rows")]
        let bridge_rows = (config.bridge_s / axis.period_s) as u32;
        Self {
            jumps: [accel, accel, accel, bits(sensors.rate_jump_radps, units.rate)],
            torque_jump: bits(sensors.torque_jump_nm, units.motor_torque),
            gyro_range: N::quantise(sensors.gyro_range_rad, gyro),
            torque_range: N::quantise(20.0 * axis.range.torque_nm, units.motor_torque),
            stuck_rows: sensors.stuck_rows,
            bridge_rows,
            torque_measured: sensors.motor_torque_measured,
        }
    }

    /// Whether nothing is wrong: theta and the motor torque have changed, and nothing by more than it may.
    #[allow(clippy::needless_bitwise_bool, reason = "one branch for all")]
    #[inline(always)]
    pub(crate) fn ordinary(&self, memory: &Memory<N>, gyro: N, torque: N, row: &Input<N>, faults: Faults) -> bool {
        let [x, y, z, rate] = memory.inputs;
        // Bits that either has: at least the larger of the two.
        let accel = bits_of(row.accel_x_mps2 - x) | bits_of(row.accel_y_mps2 - y) | bits_of(row.accel_z_mps2 - z);
        let [accel_jump, .., rate_jump] = self.jumps;
        (gyro.to_bits() != memory.gyro.to_bits())
            & moved_within(torque - memory.torque, self.torque_jump)
            & (accel < accel_jump)
            & (bits_of(row.vehicle_rate_radps - rate) < rate_jump)
            & (faults.bits() & WRONG == 0)
    }

    /// Looks at each reading by itself.
    pub(crate) fn admit(
        &self,
        memory: &mut Memory<N>,
        measured: &Measured<N>,
        inputs: &[N; INPUTS],
        faults: Faults,
        zone: N,
    ) -> Admitted<N> {
        let mut flags = Flags::INPUT_WRONG.when(faults.bits() & WRONG != 0);
        let health = &mut memory.health;

        let gyro = measured.gyro_angle_rad.filter(|gyro| gyro.within(self.gyro_range));
        let equal = gyro.is_some_and(|gyro| gyro == memory.gyro);
        health.gyro_equal = if equal { health.gyro_equal.saturating_add(1) } else { 0 };
        let stuck = self.stuck_rows > 0 && health.gyro_equal >= self.stuck_rows;
        flags |= Flags::GYRO_STUCK.when(stuck) | Flags::GYRO_MISSING.when(gyro.is_none());
        // On a stop theta stands still: chance is likelier than a fault.
        let fresh = gyro.filter(|gyro| self.stuck_rows == 0 || !equal || (!stuck && !gyro.within(zone)));
        let before = health.gyro_missing;
        health.gyro_missing = if fresh.is_some() { 0 } else { before.saturating_add(1) };
        // So many equal readings are no chance.
        flags |= Flags::GYRO_MISSING.when(health.gyro_missing >= OUTAGE);
        flags |= Flags::GYRO_LOST.when(health.gyro_missing > self.bridge_rows);

        let (mut torque, mut catch_up, mut spiked) = (None, N::ZERO, false);
        if self.torque_measured {
            torque = measured.motor_torque_nm.filter(|torque| torque.within(self.torque_range));
            let equal = torque.is_some_and(|torque| torque == memory.torque);
            health.torque_equal = if equal { health.torque_equal.saturating_add(1) } else { 0 };
            // On a stop the torque runs off: there a few equal readings are a fault.
            let on_stop = matches!(memory.regime, super::state::Regime::Held(_));
            let rows = if on_stop { self.stuck_rows.min(4) } else { self.stuck_rows };
            let stuck = self.stuck_rows > 0 && health.torque_equal >= rows;
            let jump = N::from_bits(self.torque_jump);
            let jumped = torque.is_some_and(|torque| !(torque - memory.torque).abs().within(jump));
            // The first row has nothing to jump from.
            let hold = jumped && !health.torque_held && memory.regime != super::state::Regime::New;
            let confirmed = jumped && health.torque_held;
            spiked = health.torque_held && !jumped;
            health.torque_held = hold;
            if confirmed {
                catch_up = memory.torque_waiting - memory.torque;
            }
            if let Some(torque) = torque {
                memory.torque_waiting = torque;
            }
            torque = torque.filter(|_| !hold && !stuck);
            flags |= Flags::TORQUE_STUCK.when(stuck) | Flags::TORQUE_MISSING.when(torque.is_none() && !stuck);
            health.torque_missing = if torque.is_some() { 0 } else { health.torque_missing.saturating_add(1) };
            flags |= Flags::TORQUE_LOST.when(health.torque_missing > self.bridge_rows);
        }
        flags |= self.admit_inputs(memory, inputs);
        let health = &memory.health;
        Admitted {
            gyro: fresh,
            torque,
            catch_up,
            torque_spiked: spiked,
            gyro_missing: health.gyro_missing,
            gyro_back: fresh.is_some() && (before >= OUTAGE || health.gyro_rejected >= OUTAGE),
            torque_lost: self.torque_measured && torque.is_none(),
            flags,
        }
    }

    fn admit_inputs(&self, memory: &mut Memory<N>, inputs: &[N; INPUTS]) -> Flags {
        let mut flags = Flags::NONE;
        let first = memory.regime == super::state::Regime::New;
        for (i, (now, last)) in inputs.iter().zip(&mut memory.inputs).enumerate() {
            let held = &mut memory.health.inputs_held[i];
            let jumped = !(*now - *last).abs().within(N::from_bits(self.jumps[i]));
            *held = jumped && !*held && !first;
            if *held {
                flags |= Flags::INPUT_SPIKE;
            } else {
                *last = *now;
            }
        }
        flags
    }

    /// At the end of a block of rows: whether an input has not changed since the last one's.
    pub(crate) fn watch_inputs(&self, memory: &mut Memory<N>) {
        let (now, last) = (memory.inputs.map(N::to_bits), memory.block_inputs.map(N::to_bits));
        if now.iter().zip(&last).all(|(now, last)| now != last) {
            memory.block_inputs = memory.inputs;
            memory.equal_inputs = [0; INPUTS];
            memory.lasting = memory.lasting.without(Flags::INPUT_STUCK);
        } else {
            self.watch_equal(memory);
        }
    }

    #[cold]
    #[inline(never)]
    fn watch_equal(&self, memory: &mut Memory<N>) {
        let mut stuck = false;
        for ((now, last), rows) in memory.inputs.iter().zip(&mut memory.block_inputs).zip(&mut memory.equal_inputs) {
            *rows = if now == last { rows.saturating_add(BLOCK) } else { 0 };
            stuck |= self.stuck_rows > 0 && *rows > self.stuck_rows + BLOCK;
            *last = *now;
        }
        memory.lasting = memory.lasting.without(Flags::INPUT_STUCK) | Flags::INPUT_STUCK.when(stuck);
    }

    /// A reading of theta was held back.
    pub(crate) fn miss_gyro(state: &mut State) {
        state.gyro_missing = state.gyro_missing.saturating_add(1);
        state.gyro_rejected = state.gyro_rejected.saturating_add(1);
    }

    /// A reading of theta was used.
    pub(crate) fn take_gyro(state: &mut State) {
        state.gyro_rejected = 0;
    }

    pub(crate) fn torque_measured(&self) -> bool {
        self.torque_measured
    }

    /// Whether the next row needs a closer look.
    pub(crate) fn watches(&self, state: &State) -> bool {
        !self.torque_measured || *state != State::default()
    }
}
