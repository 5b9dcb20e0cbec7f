//! Three plants on three gimbals: the attitude error as a vector, by rotation matrices.
//!
//! ```text
//! w = r_o e_o + r_m e_m + r_i e_i     the vehicle's rate in the axes of the middle gimbal, by Cramer's rule
//! phi = R_i^T phi_loops               what the gyros see turns with the inner gimbal; what phi moves on a stop stays
//! dV' = a x phi                       (7), by trapezoids
//! ```
//!
//! Each gimbal's loop is one [`Plant`] with the forces in that gimbal's axes and the rate of its bearing.

use gimbal_servo::platform::{Config, Input};
use gimbal_servo::{BuildError, Config as Loop};

use crate::{Plant, Row, Sample, State, Stop};

type Vector = [f64; 3];
type Matrix = [Vector; 3];

/// A platform of three gimbals, built from the same configuration as the flight code's.
#[derive(Debug, Clone)]
pub struct Platform {
    /// By axis.
    plants: [Plant; 3],
    loops: [Loop; 3],
    /// Axes from the outside in.
    order: [usize; 3],
}

/// The platform at the instant of a row; vectors in the stable member's axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlatformSample {
    /// phi [rad].
    pub attitude_error_rad: Vector,
    /// INS velocity error [m/s].
    pub velocity_error_mps: Vector,
    /// Each loop, by its axis.
    pub axes: [Sample; 3],
}

/// What a run remembers between two rows.
struct Course {
    states: [State; 3],
    rows: [Row; 3],
    /// The stable member's own rate about each axis [rad/s].
    own: Vector,
    /// By axis, whether the gyro was on a stop, and what of phi it had not seen.
    on_stop: [bool; 3],
    not_seen: Vector,
    /// What phi has moved on stops: about the loops' axes, and in the stable member's [rad].
    moved: Vector,
    kept: Vector,
    velocity: Vector,
    accel_error: Vector,
    first: bool,
}

impl Platform {
    /// A platform.
    ///
    /// # Errors
    /// What is wrong with a gimbal's loop.
    pub fn new(config: &Config) -> Result<Self, BuildError> {
        let order = config.gimbals.map(|gimbal| gimbal.axis.index());
        let mut loops = [config.gimbals[0].servo; 3];
        for gimbal in &config.gimbals {
            loops[gimbal.axis.index()] = gimbal.servo;
        }
        let [x, y, z] = &loops;
        Ok(Self { plants: [Plant::new(x)?, Plant::new(y)?, Plant::new(z)?], loops, order })
    }

    /// With another relative tolerance of the integration.
    #[must_use]
    pub fn with_tolerance(mut self, tolerance: f64) -> Self {
        self.plants = self.plants.map(|plant| plant.with_tolerance(tolerance));
        self
    }

    /// Runs rows from rest.
    pub fn run<'a>(
        &'a self,
        rows: impl IntoIterator<Item = Input<f64>> + 'a,
    ) -> impl Iterator<Item = PlatformSample> + 'a {
        let states = std::array::from_fn(|axis| self.plants[axis].start());
        let mut course = Course {
            states,
            rows: [Row::default(); 3],
            own: [0.0; 3],
            on_stop: [false; 3],
            not_seen: [0.0; 3],
            moved: [0.0; 3],
            kept: [0.0; 3],
            velocity: [0.0; 3],
            accel_error: [0.0; 3],
            first: true,
        };
        rows.into_iter().map(move |row| self.step(&mut course, &row))
    }

    fn step(&self, course: &mut Course, input: &Input<f64>) -> PlatformSample {
        let inner = self.order[2];
        let to_middle = rotation(inner, input.gimbal_angle_rad[inner]);
        let rows = self.rows(input, &to_middle, course.own);
        let axes: [Sample; 3] = std::array::from_fn(|axis| {
            let (plant, state) = (&self.plants[axis], &mut course.states[axis]);
            if course.first {
                plant.sample(state, &rows[axis])
            } else {
                plant.step(state, &course.rows[axis], &rows[axis])
            }
        });
        course.own = axes.map(|sample| sample.gimbal_rate_radps);
        course.rows = rows;
        let attitude_error_rad = self.gather(course, &axes, &to_middle);
        let accel_error = cross(input.accel_mps2, attitude_error_rad);
        if !course.first {
            let period_s = self.plants[0].period_s();
            let change = sum(course.accel_error, accel_error).map(|error| 0.5 * period_s * error);
            course.velocity = sum(course.velocity, change);
        }
        (course.accel_error, course.first) = (accel_error, false);
        PlatformSample { attitude_error_rad, velocity_error_mps: course.velocity, axes }
    }

    /// Each gimbal's row: forces in its own axes, the rate of its bearing.
    fn rows(&self, input: &Input<f64>, to_middle: &Matrix, own: Vector) -> [Row; 3] {
        let [outer, middle, inner] = self.order;
        let to_outer = rotation(middle, input.gimbal_angle_rad[middle]);
        let to_vehicle = rotation(outer, input.gimbal_angle_rad[outer]);
        let mut forces = [input.accel_mps2; 3];
        forces[middle] = times(to_middle, input.accel_mps2);
        forces[outer] = times(&to_outer, forces[middle]);
        let rate = times(&transposed(&to_outer), times(&transposed(&to_vehicle), input.vehicle_rate_radps));
        let [o, m, i] = [times(&transposed(&to_outer), unit(outer)), unit(middle), unit(inner)];
        let whole = dot(o, cross(m, i));
        let mut rates = [0.0; 3];
        rates[outer] = dot(rate, cross(m, i)) / whole;
        rates[middle] = dot(o, cross(rate, i)) / whole;
        rates[inner] = dot(o, cross(m, rate)) / whole;
        std::array::from_fn(|axis| {
            let (x, y) = ((axis + 1) % 3, (axis + 2) % 3);
            Row {
                accel_x_mps2: forces[axis][x],
                accel_y_mps2: forces[axis][y],
                accel_z_mps2: forces[axis][axis],
                vehicle_rate_radps: rates[axis],
                torque_nm: input.torque_nm[axis],
                spin_rate_radps: own[x],
                ..Row::default()
            }
        })
    }

    /// phi in the stable member's axes.
    fn gather(&self, course: &mut Course, axes: &[Sample; 3], to_middle: &Matrix) -> Vector {
        let to_inner = transposed(to_middle);
        let not_seen = std::array::from_fn(|axis| {
            let (sample, gyro) = (&axes[axis], &self.loops[axis].gyro);
            let seen =
                gyro.float_inertia_kg_m2 * sample.gyro_rate_radps + gyro.damping_nm_s_per_rad * sample.gyro_angle_rad;
            sample.gimbal_angle_rad - seen / gyro.angular_momentum_nm_s
        });
        let on_stop = axes.map(|sample| sample.stop != Stop::Free);
        let moved = std::array::from_fn(|axis| {
            let hidden = on_stop[axis] || course.on_stop[axis];
            if hidden { not_seen[axis] - course.not_seen[axis] } else { 0.0 }
        });
        (course.on_stop, course.not_seen) = (on_stop, not_seen);
        course.moved = sum(course.moved, moved);
        course.kept = sum(course.kept, times(&to_inner, moved));
        // What has moved on a stop is in the loop's angle too, and does not turn.
        let turning = std::array::from_fn(|axis| axes[axis].gimbal_angle_rad - course.moved[axis]);
        sum(times(&to_inner, turning), course.kept)
    }
}

fn sum(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|axis| a[axis] + b[axis])
}

fn times(m: &Matrix, v: Vector) -> Vector {
    std::array::from_fn(|i| dot(m[i], v))
}

fn transposed(m: &Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| m[j][i]))
}

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn unit(axis: usize) -> Vector {
    std::array::from_fn(|i| f64::from(u8::from(i == axis)))
}

/// The right-handed turn about an axis, after Rodrigues.
fn rotation(axis: usize, angle: f64) -> Matrix {
    let e = unit(axis);
    let columns: Matrix = std::array::from_fn(|j| {
        let v = unit(j);
        let (turned, along) = (cross(e, v), dot(e, v));
        std::array::from_fn(|i| v[i] * angle.cos() + turned[i] * angle.sin() + e[i] * along * (1.0 - angle.cos()))
    });
    transposed(&columns)
}
