//! One row of the platform.

use core::f64::consts::TAU;

use super::config::Config;
use super::resolver::{Order, Resolver};
use super::signals::{Estimate, Input, Output};
use super::state::{State, Vector};
use super::turn::{self, ANGLE_SCALE, across};
use crate::BuildError;
use crate::estimator::{self, Flags, Measured, sums};
use crate::faults::Faults;
use crate::number::Number;
use crate::signals;

/// Least cosine of the middle gimbal's angle.
const LEAST_COSINE: f64 = 0.1;

/// A platform, ready to step: built once, never changed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Law<N: Number> {
    /// By axis.
    axes: [crate::Law<N>; 3],
    estimators: [estimator::Law<N>; 3],
    order: Order,
    turns: turn::Law<N>,
    least_cosine: N,
    sums: sums::Law<N>,
    /// From each axis' full scale of phi to the common one.
    shifts: [u32; 3],
    /// The common full scale of phi.
    angle: i32,
    period_s: f64,
}

impl<N: Number> Law<N> {
    pub(crate) fn build(config: &Config) -> Result<Self, BuildError> {
        let order = config.gimbals.map(|gimbal| gimbal.axis.index());
        let mut place = [0; 3];
        for (gimbal, axis) in order.into_iter().enumerate() {
            place[axis] = gimbal;
        }
        let [x, y, z] = place.map(|gimbal| &config.gimbals[gimbal]);
        let axes = [x.servo.build::<N>()?, y.servo.build::<N>()?, z.servo.build::<N>()?];
        let estimators = [x.estimator.build(&x.servo)?, y.estimator.build(&y.servo)?, z.estimator.build(&z.servo)?];
        let exponents = [&axes[0], &axes[1], &axes[2]].map(|axis| axis.units().gimbal_angle);
        let angle = exponents.into_iter().fold(i32::MIN, i32::max);
        let mut units = *axes[0].units();
        units.gimbal_angle = angle;
        let range = &x.servo.range;
        let largest = range.radial_accel_mps2.max(range.axial_accel_mps2);
        Ok(Self {
            axes,
            estimators,
            order,
            turns: turn::Law::build(),
            least_cosine: N::quantise(LEAST_COSINE, 0),
            sums: sums::Law::build(&units, largest, x.servo.period_s),
            shifts: exponents.map(|exponent| (angle - exponent).unsigned_abs()),
            angle,
            period_s: x.servo.period_s,
        })
    }

    /// The state at rest, before the first row.
    #[must_use]
    pub fn start(&self) -> State<N> {
        State::new()
    }

    /// A row in SI as the law takes it; gimbal angles are taken within a half turn.
    #[must_use]
    pub fn input(&self, si: &Input<f64>) -> Input<N> {
        let units = self.axes[0].units();
        let mut torque = [N::ZERO; 3];
        for ((torque, axis), si) in torque.iter_mut().zip(&self.axes).zip(si.torque_nm) {
            *torque = N::quantise(si, axis.units().torque);
        }
        Input {
            accel_mps2: si.accel_mps2.map(|accel| N::quantise(accel, units.accel)),
            vehicle_rate_radps: si.vehicle_rate_radps.map(|rate| N::quantise(rate, units.rate)),
            gimbal_angle_rad: si
                .gimbal_angle_rad
                .map(|angle| N::quantise(angle - TAU * libm::round(angle / TAU), ANGLE_SCALE)),
            torque_nm: torque,
        }
    }

    /// Readings in SI as the law takes them, theta and `T_m` of each axis.
    #[must_use]
    pub fn measured(&self, gyro_angle_rad: [Option<f64>; 3], motor_torque_nm: [Option<f64>; 3]) -> [Measured<N>; 3] {
        core::array::from_fn(|axis| self.estimators[axis].measured(gyro_angle_rad[axis], motor_torque_nm[axis]))
    }

    /// An attitude error or a bound in SI [rad].
    #[must_use]
    pub fn angle_rad(&self, angle: [N; 3]) -> [f64; 3] {
        angle.map(|angle| angle.to_f64(self.angle))
    }

    /// Advances the model of all three axes by a row.
    pub fn step(&self, state: &mut State<N>, input: &Input<N>) -> Output<N> {
        let mut faults = self.admit_angles(state, &input.gimbal_angle_rad);
        let [outer, middle, inner] = self.order;
        let resolver = Resolver {
            outer: self.turns.of(state.angles[outer]),
            middle: self.turns.of(state.angles[middle]),
            inner: self.turns.of(state.angles[inner]),
        };
        let forces = resolver.forces(self.order, input.accel_mps2);
        let rates = resolver.bearing_rates(self.order, input.vehicle_rate_radps, self.least_cosine);
        // The stable member's own rate, of the last row.
        let own: [N; 3] = core::array::from_fn(|axis| {
            let last = &state.axes[axis];
            (last.sensed_rate - last.drift).shift_down(self.axes[axis].rate_shift)
        });
        let mut rows = [signals::Input::default(); 3];
        for ((axis, force), rate) in self.order.into_iter().zip(forces).zip(rates) {
            let (x, y) = across(axis);
            rows[axis] = signals::Input {
                accel_x_mps2: force[x],
                accel_y_mps2: force[y],
                accel_z_mps2: force[axis],
                vehicle_rate_radps: rate,
                torque_nm: input.torque_nm[axis],
                spin_rate_radps: own[x],
            };
        }
        let [x, y, z] = &mut state.axes;
        let axes = [self.axes[0].step(x, rows[0]), self.axes[1].step(y, rows[1]), self.axes[2].step(z, rows[2])];
        state.faults = axes.map(|output| output.faults);
        for fault in state.faults {
            faults |= fault;
        }
        for (kept, now) in state.accel.iter_mut().zip(input.accel_mps2) {
            // As the axes do: a value that is no number is the last one again.
            if now.is_number() {
                *kept = now;
            }
        }
        state.resolver = resolver;
        let angles = axes.map(|output| output.gimbal_angle_rad);
        let unseen = core::array::from_fn(|axis| N::narrow(state.axes[axis].offset));
        let accel = state.accel;
        self.gather(&mut state.modelled, &resolver, angles, unseen, accel);
        Output {
            attitude_error_rad: state.modelled.angle,
            axes,
            faults,
            gimbal_lock: resolver.middle.cosine.within(self.least_cosine),
        }
    }

    /// Estimates all three axes at the row that `step` has just taken.
    pub fn estimate(&self, state: &mut State<N>, measured: &[Measured<N>; 3]) -> Estimate<N> {
        let State { axes, estimators, faults, .. } = state;
        let [x, y, z] = estimators;
        let step = |axis: usize, state: &mut estimator::State<N>| {
            self.estimators[axis].step(state, &measured[axis], &self.axes[axis], &axes[axis], faults[axis])
        };
        let estimates = [step(0, x), step(1, y), step(2, z)];
        let angles = estimates.map(|estimate| estimate.gimbal_angle_rad);
        let unseen = core::array::from_fn(|axis| N::narrow(state.estimators[axis].offset));
        let (resolver, accel) = (state.resolver, state.accel);
        self.gather(&mut state.estimated, &resolver, angles, unseen, accel);
        let inner = self.order[2];
        let bounds = self.common(estimates.map(|estimate| estimate.bound_rad));
        Estimate {
            attitude_error_rad: state.estimated.angle,
            bound_rad: self.turned_bounds(&resolver, bounds, inner),
            axes: estimates,
            flags: estimates.iter().fold(Flags::NONE, |flags, estimate| flags | estimate.flags),
        }
    }

    /// Modelled velocity error so far, in the stable member's axes [m/s].
    #[must_use]
    pub fn velocity_error_mps(&self, state: &State<N>) -> [f64; 3] {
        self.velocity_mps(&state.modelled, state)
    }

    /// What the navigation adds to its velocity [m/s].
    #[must_use]
    pub fn velocity_correction_mps(&self, state: &State<N>) -> [f64; 3] {
        self.velocity_mps(&state.estimated, state).map(|error| -error)
    }

    /// Keeps the last angle for one that is no number or beyond a half turn.
    fn admit_angles(&self, state: &mut State<N>, angles: &[N; 3]) -> Faults {
        let mut faults = Faults::NONE;
        for (kept, angle) in state.angles.iter_mut().zip(angles) {
            if self.turns.admits(*angle) {
                *kept = *angle;
            } else {
                faults |= Faults::INPUT_OUT_OF_RANGE.when(angle.is_number());
                faults |= Faults::INPUT_NOT_FINITE.when(!angle.is_number());
            }
        }
        faults
    }

    /// In the common full scale.
    fn common(&self, angles: [N; 3]) -> [N; 3] {
        core::array::from_fn(|axis| angles[axis].shift_down(self.shifts[axis]))
    }

    /// phi in the stable member's axes: what the gyros see turns with the inner gimbal, what they have not seen stays.
    fn gather(&self, vector: &mut Vector<N>, resolver: &Resolver<N>, angles: [N; 3], unseen: [N; 3], accel: [N; 3]) {
        let inner = self.order[2];
        let (angles, unseen) = (self.common(angles), self.common(unseen));
        let change = core::array::from_fn(|axis| unseen[axis] - vector.last[axis]);
        let change = resolver.inner.inward_wide(change, inner);
        for (sum, change) in vector.unseen.iter_mut().zip(change) {
            *sum = N::confine(*sum + change);
        }
        vector.last = unseen;
        let seen = resolver.inner.inward(core::array::from_fn(|axis| angles[axis] - unseen[axis]), inner);
        vector.angle = core::array::from_fn(|axis| seen[axis] + N::narrow(vector.unseen[axis]));
        for (axis, sums) in vector.sums.iter_mut().enumerate() {
            let (x, y) = across(axis);
            sums::Law::step(sums, [accel[x], accel[y]], vector.angle[axis]);
        }
        vector.rows += 1;
        if vector.rows >= sums::BLOCK {
            vector.rows = 0;
            vector.sums.iter_mut().for_each(|sums| self.sums.close(sums));
        }
    }

    /// Root sum of the parts that a turn about the inner axis makes of two bounds.
    fn turned_bounds(&self, resolver: &Resolver<N>, bounds: [N; 3], inner: usize) -> [N; 3] {
        let (i, j) = across(inner);
        let root_sum = &self.estimators[inner].root_sum;
        let part = |axis: usize| {
            let mut alone = [N::ZERO; 3];
            alone[axis] = bounds[axis];
            resolver.inner.inward(alone, inner)
        };
        let (first, second) = (part(i), part(j));
        let mut turned = bounds;
        for axis in [i, j] {
            turned[axis] = root_sum.of(first[axis].abs(), second[axis].abs());
        }
        turned
    }

    fn velocity_mps(&self, vector: &Vector<N>, state: &State<N>) -> [f64; 3] {
        let units = self.axes[0].units();
        let mut velocity = [0.0; 3];
        for (axis, sums) in vector.sums.iter().enumerate() {
            let (x, y) = across(axis);
            let angle = vector.angle[axis].to_f64(self.angle);
            let [ax, ay] = [state.accel[x], state.accel[y]].map(|accel| accel.to_f64(units.accel));
            let [along_x, along_y] = self.sums.velocity_mps(sums, [ay * angle, -ax * angle]);
            velocity[x] += along_x;
            velocity[y] += along_y;
        }
        velocity
    }

    /// Time between two rows [s].
    #[must_use]
    pub fn period_s(&self) -> f64 {
        self.period_s
    }
}
