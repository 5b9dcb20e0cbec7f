//! INS velocity and position error over an hour: sums that do not drift.

use std::f64::consts::TAU;

use gimbal_plant::Plant;
use gimbal_servo::paper::STANDARD_GRAVITY_MPS2;
use gimbal_servo::{Config, Fixed, Number};
use host_tests::Row;
use host_tests::axis::Axis;
use host_tests::compare::relative;

/// One hour; a debug build sums a quarter of one.
const ROWS: u32 = if cfg!(debug_assertions) { 900_000 } else { 3_600_000 };

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
fn steady(_: u32) -> Row {
    Row { accel_y_mps2: 20.0 * STANDARD_GRAVITY_MPS2, ..Row::default() }
}

/// 20 g that turns about the gimbal axis five times a minute, torqued with it.
fn turning(k: u32) -> Row {
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

struct Totals {
    velocity: [f64; 2],
    position: [f64; 2],
    exact_velocity: [f64; 2],
    exact_position: [f64; 2],
}

fn hour<N: Number>(config: &Config, row: fn(u32) -> Row) -> Totals {
    let mut axis = Axis::<N>::new(config).unwrap();
    let units = *axis.law.units();
    let period = config.period_s;
    let mut velocity = [Exact::default(); 2];
    let mut position = [Exact::default(); 2];
    let mut last = [0.0; 2];
    for k in 0..ROWS {
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
    Totals {
        velocity: axis.law.velocity_error_mps(&axis.state),
        position: axis.law.position_error_m(&axis.state),
        exact_velocity: velocity.map(Exact::value),
        exact_position: position.map(|sum| 0.5 * period * sum.value()),
    }
}

fn check_sums<N: Number>(name: &str, row: fn(u32) -> Row) -> Totals {
    let config = Config::consistent().without_friction();
    let totals = hour::<N>(&config, row);
    let length = |pair: [f64; 2]| pair[0].hypot(pair[1]);
    for i in 0..2 {
        // Of the vector's length: an axis that sees nothing has no size of its own.
        let velocity = (totals.velocity[i] - totals.exact_velocity[i]).abs() / length(totals.exact_velocity);
        let position = (totals.position[i] - totals.exact_position[i]).abs() / length(totals.exact_position);
        println!("{name} axis {i}: {} m, off by {position:.2e}; velocity off by {velocity:.2e}", totals.position[i]);
        assert!(position <= 1e-6 && velocity <= 1e-6, "{name} axis {i}: {position:e} {velocity:e}");
    }
    totals
}

/// Asked for: 1e-6 of the exact sum of the same phi samples. Counts are 2^-31 of the full scales' product with nothing
/// lost between them, so that what is left over at the end is one count: far below.
#[test]
fn closed_form_an_hour_of_sums_is_exact() {
    for (name, row) in [("steady", steady as fn(u32) -> Row), ("turning", turning)] {
        check_sums::<f32>(&format!("{name} f32"), row);
        check_sums::<Fixed>(&format!("{name} fixed"), row);
    }
}

/// Asked for: 1e-3 of the plant. In fixed point phi is rounded down, by half a bit on average: 2.3e-10 rad, which 20 g
/// held for the hour make 1.6e-4 m/s, 1.5e-3 of the velocity error of the steady case, and half of that of its position.
#[test]
fn cross_an_hour_at_20_g_agrees_with_the_plant() {
    let config = Config::consistent().without_friction();
    for (name, row) in [("steady", steady as fn(u32) -> Row), ("turning", turning)] {
        let plant = Plant::new(&config).unwrap();
        let last = plant.run((0..ROWS).map(row)).last().unwrap();
        let length = |pair: [f64; 2]| pair[0].hypot(pair[1]);
        for (system, totals) in [("f32", hour::<f32>(&config, row)), ("fixed", hour::<Fixed>(&config, row))] {
            let velocity = relative(length(totals.velocity), length(last.velocity_error_mps));
            let position = relative(length(totals.position), length(last.position_error_m));
            let apart = [0, 1].map(|i| totals.position[i] - last.position_error_m[i]);
            let apart = length(apart) / length(last.position_error_m);
            println!(
                "{name} {system}: velocity off by {velocity:.2e}, position by {position:.2e} ({apart:.2e} as a vector)"
            );
            let velocity_bound = if (name, system) == ("steady", "fixed") { 2e-3 } else { 1e-3 };
            assert!(
                velocity <= velocity_bound && apart <= 1e-3,
                "{name} {system}: {velocity:e} {position:e} {apart:e}"
            );
        }
    }
}
