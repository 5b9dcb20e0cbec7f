//! INS errors over an hour of rows, beside the exact sums of the same phi samples and beside the plant.

use std::f64::consts::TAU;

use gimbal_plant::{Plant, Row};
use gimbal_servo::paper::STANDARD_GRAVITY_MPS2;
use gimbal_servo::{Config, Number};

use crate::axis::Axis;

/// A sum of f64 with what each addition rounds away (Knuth's two-sum): exact to 2^-100 of the largest term.
#[derive(Clone, Copy, Default)]
struct Exact {
    sum: f64,
    rest: f64,
}

impl Exact {
    fn add(&mut self, value: f64) {
        let sum = self.sum + value;
        let back = sum - self.sum;
        self.rest += (self.sum - (sum - back)) + (value - back);
        self.sum = sum;
    }

    fn add_sum(&mut self, other: Self) {
        self.add(other.sum);
        self.rest += other.rest;
    }

    fn value(self) -> f64 {
        self.sum + self.rest
    }
}

/// 20 g held for the hour: the error is made in the first second, and stays.
#[must_use]
pub fn steady(_: u32) -> Row {
    Row { accel_y_mps2: 20.0 * STANDARD_GRAVITY_MPS2, ..Row::default() }
}

/// 20 g that turns about the gimbal axis five times a minute, torqued with it.
#[must_use]
pub fn turning(k: u32) -> Row {
    let (sine, cosine) = (TAU * f64::from(k) * 1e-3 / 12.0).sin_cos();
    let accel = 20.0 * STANDARD_GRAVITY_MPS2;
    // Not quite round, so that neither sum is zero after whole turns.
    Row {
        accel_x_mps2: accel * sine,
        accel_y_mps2: accel * cosine,
        torque_nm: 2e-3 * cosine * (1.0 - f64::from(k) / 8e6),
        ..Row::default()
    }
}

/// Velocity and position errors at the end.
#[derive(Debug, Clone, Copy)]
pub struct Totals {
    velocity: [f64; 2],
    position: [f64; 2],
    exact_velocity: [f64; 2],
    exact_position: [f64; 2],
}

fn length(pair: [f64; 2]) -> f64 {
    pair[0].hypot(pair[1])
}

/// Of the vector's length: an axis that sees nothing has no size of its own.
fn off(pair: [f64; 2], expected: [f64; 2]) -> f64 {
    length([pair[0] - expected[0], pair[1] - expected[1]]) / length(expected)
}

impl Totals {
    /// Off the exact sum.
    #[must_use]
    pub fn velocity_error(&self) -> f64 {
        off(self.velocity, self.exact_velocity)
    }

    /// Off the exact sum.
    #[must_use]
    pub fn position_error(&self) -> f64 {
        off(self.position, self.exact_position)
    }

    /// Off another velocity error.
    #[must_use]
    pub fn velocity_off(&self, expected: [f64; 2]) -> f64 {
        off(self.velocity, expected)
    }

    /// Off another position error.
    #[must_use]
    pub fn position_off(&self, expected: [f64; 2]) -> f64 {
        off(self.position, expected)
    }

    /// Runs the law.
    ///
    /// # Panics
    /// If the configuration does not build.
    #[must_use]
    pub fn of<N: Number>(config: &Config, rows: u32, row: fn(u32) -> Row) -> Self {
        let mut axis = Axis::<N>::new(config).expect("a configuration that builds");
        let units = *axis.law.units();
        let period = config.period_s;
        let mut velocity = [Exact::default(); 2];
        let mut position = [Exact::default(); 2];
        let mut last = [0.0; 2];
        for k in 0..rows {
            let row = row(k);
            let output = axis.step(&row);
            // The acceleration as the law takes it, and the phi that it gives.
            let taken = |value: f64| N::quantise(value, units.accel).to_f64(units.accel);
            let phi = output.gimbal_angle_rad;
            let now = [taken(row.accel_y_mps2) * phi, -taken(row.accel_x_mps2) * phi];
            if k > 0 {
                for i in 0..2 {
                    let before = velocity[i];
                    velocity[i].add(0.5 * period * (last[i] + now[i]));
                    // Trapezoids again, in units of half a period.
                    position[i].add_sum(before);
                    position[i].add_sum(velocity[i]);
                }
            }
            last = now;
        }
        Self {
            velocity: axis.law.velocity_error_mps(&axis.state),
            position: axis.law.position_error_m(&axis.state),
            exact_velocity: velocity.map(Exact::value),
            exact_position: position.map(|sum| 0.5 * period * sum.value()),
        }
    }
}

/// Velocity and position error of the plant at the end.
///
/// # Panics
/// If the configuration is wrong.
#[must_use]
pub fn plant_hour(config: &Config, rows: u32, row: fn(u32) -> Row) -> ([f64; 2], [f64; 2]) {
    let plant = Plant::new(config).expect("a configuration that builds");
    let last = plant.run((0..rows).map(row)).last().expect("rows");
    (last.velocity_error_mps, last.position_error_m)
}
