//! What a real axis does beside the nominal equations, where the flight law supports it.
//!
//! ```text
//! T_e = T_c + k rel + b w + b2 w |w| + k_a a_x a_y + dT exp(-(w / v)^2) clamp(w / w_s, -1, 1) + T_m(t) - T_m(t - d)
//! T_m logged = (1 + s) T_m(t - d) + bias        theta logged = (1 + s') theta + bias'
//! ```
//!
//! w is the bearing's rate, rel its integral, from zero at the first row. `T_e` is given to the nominal law with the
//! row's external torque, so that the law itself stays as it is, bit for bit. A torque taken away from the gimbal by a
//! delay of the motor is the same as one added to it: the law's own `T_m` acts at once.
//!
//! Assumptions: phi' in w and rel is the last row's, off by a period's change of it; `T_m` at this row is what the modes
//! make of it without the change of the disturbance over the period; between rows `T_m` is a parabola. The exponential
//! is `(1 - x/64)^64`, off by 0.4 % of dT. Effects of other names are for the reference plant alone.

use crate::build::modes::Modes;
use crate::build::plant::Plant;
use crate::config::{Config as Axis, within};
use crate::error::BuildError;
use crate::free::Heads;
use crate::number::Number;
use crate::row::ScaledRow;
use crate::signals::{Input, Output};
use crate::state::{Regime, State as AxisState};
use crate::stored::stored;

/// Largest rel that is told apart [rad].
const LARGEST_ANGLE_RAD: f64 = 64.0;

/// Sizes of the effects; all zero is the nominal axis.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Config {
    /// `constant_torque` [N m].
    pub constant_torque_nm: f64,
    /// `cable_spring` [N m/rad].
    pub cable_spring_nm_per_rad: f64,
    /// `viscous_friction`, b [N m s/rad].
    pub viscous_friction_nm_s_per_rad: f64,
    /// `quadratic_drag`, b2 [N m s2/rad2].
    pub quadratic_drag_nm_s2_per_rad2: f64,
    /// `anisoelasticity`, `k_a` [N m s4/m2].
    pub anisoelasticity_nm_s4_per_m2: f64,
    /// `stribeck`, dT [N m].
    pub stribeck_excess_nm: f64,
    /// `stribeck`, v [rad/s]; not zero where dT is not.
    pub stribeck_rate_radps: f64,
    /// `loop_delay`, d, at most one period [s].
    pub loop_delay_s: f64,
    /// `torque_scale`, relative change.
    pub torque_scale: f64,
    /// `torque_bias` [N m].
    pub torque_bias_nm: f64,
    /// `pickoff_scale`, relative change.
    pub pickoff_scale: f64,
    /// `pickoff_bias` [rad].
    pub pickoff_bias_rad: f64,
}

/// An axis with effects, ready to step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Law<N: Number> {
    axis: crate::Law<N>,
    constant: N,
    spring: ScaledRow<N, 1>,
    /// From the full scale of phi to that of rel.
    angle_shift: u32,
    /// rel over a period, of both ends' rates added.
    turn: ScaledRow<N, 1>,
    viscous: ScaledRow<N, 1>,
    /// Of `|w| / largest rate`, times w.
    quadratic: ScaledRow<N, 1>,
    /// `w / largest rate`.
    rate_share: ScaledRow<N, 1>,
    /// Of `a_x / largest acceleration`, times `a_y`.
    anisoelasticity: ScaledRow<N, 1>,
    /// `a_x / largest acceleration`.
    accel_share: ScaledRow<N, 1>,
    stribeck: N,
    /// `w / (8 v)`.
    stribeck_share: ScaledRow<N, 1>,
    /// `T_m(t) - T_m(t - d)` of this row's `T_m`, the last and the one before.
    late: ScaledRow<N, 3>,
    /// The same in the full scale of disturbance torques.
    late_torque: ScaledRow<N, 3>,
    delayed: bool,
    /// `T_m` less `T_d`, one period on.
    ahead: ScaledRow<N, { crate::build::poles::ORDER }>,
    torque_scale: ScaledRow<N, 1>,
    torque_bias: N,
    pickoff_scale: ScaledRow<N, 1>,
    pickoff_bias: N,
}

stored!([N: Number] Law<N> {
    axis, constant, spring, angle_shift, turn, viscous, quadratic, rate_share, anisoelasticity, accel_share, stribeck,
    stribeck_share, late, late_torque, delayed, ahead, torque_scale, torque_bias, pickoff_scale, pickoff_bias,
});

/// Memory of an axis with effects.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State<N: Number> {
    axis: AxisState<N>,
    /// The vehicle's turn since the first row, and what its sum has lost.
    turned: N::Wide,
    lost: N::Wide,
    vehicle_rate: N,
    /// `T_m` at the last row and at the one before.
    motor: [N; 2],
    begun: bool,
}

impl Axis {
    /// Builds the law of this axis with effects.
    ///
    /// # Errors
    /// What is wrong with the axis or with a size, by its name.
    pub fn build_with<N: Number>(&self, effects: &Config) -> Result<Law<N>, BuildError> {
        let axis: crate::Law<N> = self.build()?;
        effects.check(self.period_s)?;
        let (plant, units) = (Plant::new(self), axis.units);
        let modes = Modes::new(&plant)?;
        let modes = if N::HAS_SCALES { modes } else { modes.in_steps(self.period_s) };
        let rate = if N::HAS_SCALES { libm::ldexp(1.0, units.rate) } else { self.range.rate_radps };
        let accel = if N::HAS_SCALES { libm::ldexp(1.0, units.accel) } else { self.range.radial_accel_mps2 };
        let angle = N::exponent(LARGEST_ANGLE_RAD);
        let of = |factor: f64, from: i32, to: i32| ScaledRow::build([factor], [from], to);
        let late = effects.late(self.period_s);
        let stribeck_rate = if effects.stribeck_excess_nm == 0.0 { 1.0 } else { effects.stribeck_rate_radps };
        Ok(Law {
            constant: N::quantise(effects.constant_torque_nm, units.torque),
            spring: of(effects.cable_spring_nm_per_rad, angle, units.torque),
            angle_shift: (angle - units.gimbal_angle).max(0).unsigned_abs(),
            turn: of(self.period_s, units.rate, angle),
            viscous: of(effects.viscous_friction_nm_s_per_rad, units.rate, units.torque),
            quadratic: of(effects.quadratic_drag_nm_s2_per_rad2 * rate, units.rate, units.torque),
            rate_share: of(1.0 / rate, units.rate, 0),
            anisoelasticity: of(effects.anisoelasticity_nm_s4_per_m2 * accel, units.accel, units.torque),
            accel_share: of(1.0 / accel, units.accel, 0),
            stribeck: N::quantise(effects.stribeck_excess_nm, units.torque),
            stribeck_share: of(0.125 / stribeck_rate, units.rate, 0),
            late: ScaledRow::build(late, [units.motor_torque; 3], units.motor_torque),
            late_torque: ScaledRow::build(late, [units.motor_torque; 3], units.torque),
            delayed: effects.loop_delay_s > 0.0,
            ahead: ScaledRow::build(
                modes.row(|pole| plant.motor_torque_of(pole) * pole.scale(self.period_s).exp()),
                units.modes,
                units.motor_torque,
            ),
            torque_scale: of(effects.torque_scale, units.motor_torque, units.motor_torque),
            torque_bias: N::quantise(effects.torque_bias_nm, units.motor_torque),
            pickoff_scale: of(effects.pickoff_scale, units.gyro_angle, units.gyro_angle),
            pickoff_bias: N::quantise(effects.pickoff_bias_rad, units.gyro_angle),
            axis,
        })
    }
}

impl Config {
    fn check(&self, period_s: f64) -> Result<(), BuildError> {
        for (field, value) in [
            ("effects.constant_torque.torque_nm", self.constant_torque_nm),
            ("effects.cable_spring.stiffness_nm_per_rad", self.cable_spring_nm_per_rad),
            ("effects.viscous_friction.coefficient_nm_s_per_rad", self.viscous_friction_nm_s_per_rad),
            ("effects.quadratic_drag.coefficient_nm_s2_per_rad2", self.quadratic_drag_nm_s2_per_rad2),
            ("effects.anisoelasticity.coefficient_nm_s4_per_m2", self.anisoelasticity_nm_s4_per_m2),
            ("effects.stribeck.excess_nm", self.stribeck_excess_nm),
            ("effects.torque_scale.relative_change", self.torque_scale),
            ("effects.torque_bias.bias_nm", self.torque_bias_nm),
            ("effects.pickoff_scale.relative_change", self.pickoff_scale),
            ("effects.pickoff_bias.bias_rad", self.pickoff_bias_rad),
        ] {
            within(field, value, -1.0, 1.0)?;
        }
        if self.stribeck_excess_nm != 0.0 {
            within("effects.stribeck.rate_radps", self.stribeck_rate_radps, 1e-4, 1e3)?;
        }
        within("effects.loop_delay.delay_s", self.loop_delay_s, 0.0, period_s)
    }

    /// `T_m(t) - T_m(t - d)` on the parabola through three rows, d in periods.
    fn late(&self, period_s: f64) -> [f64; 3] {
        let d = self.loop_delay_s / period_s;
        [1.0 - 0.5 * (1.0 - d) * (2.0 - d), -d * (2.0 - d), 0.5 * d * (1.0 - d)]
    }
}

impl<N: Number> Law<N> {
    /// The nominal law under the effects.
    #[must_use]
    pub fn axis(&self) -> &crate::Law<N> {
        &self.axis
    }

    /// The state at rest, before the first row.
    #[must_use]
    pub fn start(&self) -> State<N> {
        self.begin(self.axis.start())
    }

    /// The state that has been steady under `row` for long.
    #[must_use]
    pub fn settled(&self, row: Input<N>) -> State<N> {
        let rate = row.vehicle_rate_radps;
        let torque_nm = row.torque_nm + self.of_rate(rate) + self.of_row(&row);
        self.begin(self.axis.settled(Input { torque_nm, ..row }))
    }

    fn begin(&self, axis: AxisState<N>) -> State<N> {
        let zero = N::ZERO.widen();
        let motor = self.axis.output(&axis).motor_torque_nm;
        State { axis, turned: zero, lost: zero, vehicle_rate: N::ZERO, motor: [motor; 2], begun: false }
    }

    /// As [`crate::Law::step`], with the effects; theta and `T_m` as the sensors tell them.
    pub fn step(&self, state: &mut State<N>, input: Input<N>) -> Output<N> {
        let extra = self.torque(state, &input);
        let mut output = self.axis.step(&mut state.axis, Input { torque_nm: input.torque_nm + extra, ..input });
        let motor = output.motor_torque_nm;
        if !state.begun {
            state.motor = [motor; 2];
            state.begun = true;
        }
        let delayed = if self.delayed { motor - self.late.at(&[motor, state.motor[0], state.motor[1]]) } else { motor };
        state.motor = [motor, state.motor[0]];
        output.motor_torque_nm = delayed + self.torque_scale.times(delayed) + self.torque_bias;
        let theta = output.gyro_angle_rad;
        output.gyro_angle_rad = theta + self.pickoff_scale.times(theta) + self.pickoff_bias;
        output
    }

    /// `T_e` at the row that comes.
    fn torque(&self, state: &mut State<N>, input: &Input<N>) -> N {
        let units = &self.axis.units;
        let shift = (units.rate - units.gimbal_rate).unsigned_abs();
        let gimbal_rate = state.axis.sensed_rate;
        let vehicle_rate = input.vehicle_rate_radps;
        if state.begun {
            self.integrate(state, vehicle_rate);
        }
        state.vehicle_rate = vehicle_rate;
        let rate = vehicle_rate - gimbal_rate.shift_down(shift);
        let phi = state.axis.gimbal_angle.shift_down(self.angle_shift);
        let spring = self.spring.times(N::narrow(state.turned) - phi);
        let torque = self.of_rate(rate) + self.of_row(input) + spring;
        if self.delayed && state.begun { torque + self.late_torque.at(&self.motor_ahead(state)) } else { torque }
    }

    /// Torques of the bearing's rate.
    fn of_rate(&self, rate: N) -> N {
        let drag = self.quadratic.times(rate).times(self.rate_share.times(rate).abs());
        self.viscous.times(rate) + drag + self.of_stribeck(rate)
    }

    /// Torques of the row alone.
    fn of_row(&self, row: &Input<N>) -> N {
        self.constant + self.anisoelasticity.times(row.accel_y_mps2).times(self.accel_share.times(row.accel_x_mps2))
    }

    fn of_stribeck(&self, rate: N) -> N {
        let share = self.stribeck_share.times(rate);
        if !share.within(N::ONE) {
            return N::ZERO;
        }
        let mut fall = N::ONE - share.times(share);
        for _ in 0..6 {
            fall = fall.times(fall);
        }
        self.stribeck.times(fall).times(self.axis.friction.clamp(rate))
    }

    /// `T_m` at the row that comes, at the last and at the one before.
    fn motor_ahead(&self, state: &State<N>) -> [N; 3] {
        let [last, before] = state.motor;
        let ahead = match state.axis.regime {
            Regime::Free => {
                let torque = state.axis.torque.half().shift_down(self.axis.motor_shift);
                torque + self.ahead.at(Heads::of(&state.axis.free).modes())
            }
            _ => last + (last - before),
        };
        [ahead, last, before]
    }

    /// A sum that loses nothing of its small terms (Kahan's).
    fn integrate(&self, state: &mut State<N>, vehicle_rate: N) {
        let mean = state.vehicle_rate.half() + vehicle_rate.half();
        let term = self.turn.increment(&[mean]) - state.lost;
        let sum = N::confine(state.turned + term);
        state.lost = (sum - state.turned) - term;
        state.turned = sum;
    }
}

impl<N: Number> State<N> {
    /// The nominal law's state, for its sums.
    #[must_use]
    pub fn axis(&self) -> &AxisState<N> {
        &self.axis
    }
}
