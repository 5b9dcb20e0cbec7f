//! The quantised, immutable law of one axis.

use crate::build::modes::Modes;
use crate::build::plant::Plant;
use crate::config::{Config, Interpolation};
use crate::error::BuildError;
use crate::number::Number;
use crate::row::{Row, ScaledRow};
use crate::signals::{Input, Output};
use crate::state::State;
use crate::stored::stored;
use crate::units::Units;
use crate::{bearing, free, friction, guard, ins, stop};

/// One axis, ready to step: built once from a [`Config`], never changed.
///
/// `N` is `f32` or [`Fixed`](crate::Fixed).
///
/// In this order in memory: what every step reads comes first, within reach of a short offset.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Law<N: Number> {
    pub(crate) guard: guard::Law,
    /// Inputs are held or axes coupled: off the straight path.
    pub(crate) unusual: bool,
    pub(crate) held_inputs: bool,
    pub(crate) cross_coupling: bool,
    pub(crate) unbalance: Row<N, 2>,
    pub(crate) level: bearing::level::Law<N>,
    pub(crate) friction: friction::Law<N>,
    pub(crate) free: free::Law<N>,
    /// What theta is compared with.
    pub(crate) stop_limit: u32,
    pub(crate) small_angle: u32,
    /// phi' to the full scale of rates.
    pub(crate) rate_shift: u32,
    pub(crate) ins: ins::Law<N>,
    pub(crate) tables: bearing::level::Tables<N>,
    /// What a change of regime needs of the free loop.
    pub(crate) instant: free::Instant<N>,
    /// Disturbance torques to the full scale of motor torques.
    pub(crate) motor_shift: u32,
    /// 1 rad, beyond which phi does not go.
    pub(crate) largest_angle: N,
    pub(crate) stop: stop::Law<N>,
    /// Torque that makes phi' jump by 1 over a period: `Jg / T`.
    pub(crate) drift_torque: ScaledRow<N, 1>,
    /// phi lost over a period to a drift of 1.
    pub(crate) drift_angle: ScaledRow<N, 1>,
    /// theta's full scale times the rates', to that of phi'.
    pub(crate) drift_shift: u32,
    pub(crate) largest_drift_torque: N,
    pub(crate) units: Units,
    pub(crate) identity: u32,
}

stored!([N: Number] Law<N> {
    identity, guard, unusual, held_inputs, cross_coupling, unbalance, level, friction, free, stop_limit, small_angle,
    rate_shift, ins, tables, instant, motor_shift, largest_angle, stop, drift_torque, drift_angle, drift_shift,
    largest_drift_torque, units,
});

impl Config {
    /// Builds the law of this axis.
    ///
    /// # Errors
    /// The first field that is wrong, or the pole that makes the loop unstable.
    pub fn build<N: Number>(&self) -> Result<Law<N>, BuildError> {
        self.check()?;
        let plant = Plant::new(self);
        let modes = Modes::new(&plant)?;
        let units = Units::new::<N>(self, &plant, &modes);
        let period = self.period_s;
        let range = &self.range;
        let (level, tables) = bearing::level::Law::build(self, &units);
        let (held_inputs, cross_coupling) = (self.interpolation == Interpolation::Held, self.gyro.cross_coupling);
        Ok(Law {
            unusual: held_inputs || cross_coupling,
            held_inputs,
            cross_coupling,
            guard: guard::Law::build::<N>(range, &units),
            unbalance: Row::build([-self.unbalance.y_kg_m, self.unbalance.x_kg_m], [units.accel; 2], units.torque),
            level,
            tables,
            friction: friction::Law::build(self.bearing.slip_rate_radps, &units),
            free: free::Law::build(&plant, &modes, &units, period),
            instant: free::Instant::build(&plant, &modes, &units, period),
            stop: stop::Law::build(&plant, &units, self.gyro.stop_angle_rad, period),
            ins: ins::Law::build(&units, range.radial_accel_mps2.max(range.axial_accel_mps2), period),
            rate_shift: (units.rate - units.gimbal_rate).unsigned_abs(),
            motor_shift: (units.motor_torque - units.torque).unsigned_abs(),
            drift_torque: ScaledRow::build([plant.gimbal_inertia / period], [units.gimbal_rate], units.torque),
            drift_angle: ScaledRow::build([-0.5 * period], [units.gimbal_rate], units.gimbal_angle),
            drift_shift: (units.gyro_angle + units.rate - units.gimbal_rate).max(0).unsigned_abs(),
            largest_drift_torque: N::quantise(range.torque_nm, units.torque),
            stop_limit: N::quantise(self.gyro.stop_angle_rad, units.gyro_angle).limit(),
            small_angle: N::quantise(0.1, units.gimbal_angle).limit(),
            largest_angle: N::quantise(1.0, units.gimbal_angle),
            identity: self.identity(N::TAG),
            units,
        })
    }
}

impl<N: Number> Law<N> {
    /// The state at rest, before the first row: everything zero.
    #[must_use]
    pub fn start(&self) -> State<N> {
        State::new()
    }

    /// The state that has been steady under `row` for long: theta zero, the motor carrying the disturbance.
    #[must_use]
    pub fn settled(&self, row: Input<N>) -> State<N> {
        let mut state = State::new();
        let output = self.step(&mut state, row);
        let torque = output.friction_torque_nm + state.other_torque;
        state.torque = torque + torque;
        state
    }

    /// The full scales of inputs and outputs; all 1 for `f32`.
    #[must_use]
    pub fn units(&self) -> &Units {
        &self.units
    }

    /// Velocity error so far, along x and y [m/s].
    #[must_use]
    pub fn velocity_error_mps(&self, state: &State<N>) -> [f64; 2] {
        self.ins.velocity_error_mps(&state.ins, self.products(state))
    }

    /// Position error so far, along x and y [m].
    #[must_use]
    pub fn position_error_m(&self, state: &State<N>) -> [f64; 2] {
        self.ins.position_error_m(&state.ins, self.products(state))
    }

    /// `(a_y phi, -a_x phi)` at the last row.
    fn products(&self, state: &State<N>) -> [f64; 2] {
        let angle = state.gimbal_angle.to_f64(self.units.gimbal_angle);
        let accel = |signal: N| signal.to_f64(self.units.accel);
        [accel(state.row.accel_y_mps2) * angle, -accel(state.row.accel_x_mps2) * angle]
    }

    /// What phi has moved unseen by the gyro up to its last release [rad].
    #[must_use]
    pub fn residual_offset_rad(&self, state: &State<N>) -> f64 {
        N::narrow(state.offset).to_f64(self.units.gimbal_angle)
    }
}

impl Units {
    /// A row in SI as the law's input.
    #[must_use]
    pub fn input<N: Number>(&self, si: &Input<f64>) -> Input<N> {
        Input {
            accel_x_mps2: N::quantise(si.accel_x_mps2, self.accel),
            accel_y_mps2: N::quantise(si.accel_y_mps2, self.accel),
            accel_z_mps2: N::quantise(si.accel_z_mps2, self.accel),
            vehicle_rate_radps: N::quantise(si.vehicle_rate_radps, self.rate),
            torque_nm: N::quantise(si.torque_nm, self.torque),
            spin_rate_radps: N::quantise(si.spin_rate_radps, self.rate),
        }
    }

    /// The law's output in SI.
    #[must_use]
    pub fn output<N: Number>(&self, output: &Output<N>) -> Output<f64> {
        Output {
            gimbal_angle_rad: output.gimbal_angle_rad.to_f64(self.gimbal_angle),
            gimbal_rate_radps: output.gimbal_rate_radps.to_f64(self.gimbal_rate),
            gyro_angle_rad: output.gyro_angle_rad.to_f64(self.gyro_angle),
            motor_torque_nm: output.motor_torque_nm.to_f64(self.motor_torque),
            friction_torque_nm: output.friction_torque_nm.to_f64(self.torque),
            unbalance_torque_nm: output.unbalance_torque_nm.to_f64(self.torque),
            disturbance_torque_nm: output.disturbance_torque_nm.to_f64(self.torque),
            relative_rate_radps: output.relative_rate_radps.to_f64(self.rate),
            stop: output.stop,
            stop_change_age: output.stop_change_age.to_f64(0),
            faults: output.faults,
        }
    }
}
