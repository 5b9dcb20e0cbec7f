//! Many random saturations: how well the lasting offset is found.

use gimbal_plant::Stop;
use gimbal_servo::Config;
use gimbal_servo::estimator::{self, Flags};

use super::altered;
use crate::axis::System;
use crate::estimate::{Flight, Noise, estimate};
use crate::inputs;
use crate::random::Random;

/// Many random saturations.
#[derive(Debug, Clone, Default)]
pub struct Saturations {
    /// Sizes of the offset's error relative to the offset, sorted.
    pub errors: Vec<f64>,
    /// Bounds of the offset relative to it, sorted.
    pub bounds: Vec<f64>,
    /// Runs with the offset within twice its bound.
    pub covered: usize,
    /// Rows with phi within twice its bound, and all: before the contact, on the stop, after.
    pub rows: [(usize, usize); 3],
    /// Runs announced by *saturation ahead* at least 5 ms before the contact.
    pub announced: usize,
}

impl Saturations {
    /// Number of runs.
    #[must_use]
    pub fn runs(&self) -> usize {
        self.errors.len()
    }

    /// Share of runs within twice the bound.
    #[must_use]
    pub fn coverage(&self) -> f64 {
        self.covered as f64 / self.runs() as f64
    }

    /// A quantile of a sorted list.
    #[must_use]
    pub fn quantile(sorted: &[f64], permille: usize) -> f64 {
        sorted[(sorted.len() * permille / 1000).min(sorted.len() - 1)]
    }
}

/// `runs` steps of 2.15e5 to 4e5 dyne cm, kept on, that hold the float on its stop for 0.05 s to 0.7 s. Every parameter of
/// gyro, gimbal and servo is normally distributed with the relative deviation `tolerance`; the estimator is told so.
#[must_use]
pub fn saturations(runs: usize, tolerance: f64, system: System, seed: u64) -> Saturations {
    let nominal = inputs::bare(Config::consistent());
    let known = estimator::Tolerance { friction_level: 0.0, ..estimator::Tolerance::with_default(tolerance) };
    let config = estimator::Config { tolerance: known, ..estimator::Config::default() };
    let mut random = Random::new(seed);
    let mut found = Saturations::default();
    while found.runs() < runs {
        let truth = altered(&nominal, || 1.0 + tolerance * random.normal());
        let sign = if random.between(-1.0, 1.0) < 0.0 { -1.0 } else { 1.0 };
        let dyne_cm = sign * random.between(2.15e5, 4e5);
        let (ramp, start) = (random.between(1.0, 40.0), random.between(100.0, 101.0));
        let mut rows = inputs::torque_step(dyne_cm, 1.5, 1e-3);
        for (k, row) in rows.iter_mut().enumerate() {
            row.torque_nm *= ((k as f64 - start) / ramp).clamp(0.0, 1.0);
        }
        if truth.build::<f32>().is_err() {
            continue;
        }
        let flight = Flight::new(&truth, &config.sensors, &Noise::default(), &rows, random.bits());
        let on_stop = flight.truth.iter().filter(|sample| sample.stop != Stop::Free).count();
        if (50..=700).contains(&on_stop) {
            found.add(&truth, &nominal, &config, &flight, system);
        }
    }
    found.errors.sort_by(f64::total_cmp);
    found.bounds.sort_by(f64::total_cmp);
    found
}

impl Saturations {
    fn add(&mut self, truth: &Config, nominal: &Config, config: &estimator::Config, flight: &Flight, system: System) {
        let estimated = estimate(system, nominal, config, &flight.readings);
        let (last, gyro) = (flight.truth.last().expect("rows"), &truth.gyro);
        let seen = gyro.float_inertia_kg_m2 * last.gyro_rate_radps + gyro.damping_nm_s_per_rad * last.gyro_angle_rad;
        let offset = last.gimbal_angle_rad - seen / gyro.angular_momentum_nm_s;
        let error = estimated.offset_rad - offset;
        self.covered += usize::from(error.abs() <= 2.0 * estimated.offset_bound_rad);
        self.errors.push((error / offset).abs());
        self.bounds.push((estimated.offset_bound_rad / offset).abs());
        for (sample, point) in flight.truth.iter().zip(&estimated.points).skip(100) {
            let place = match (point.flags.contains(Flags::SATURATED), point.flags.contains(Flags::OFFSET_HELD)) {
                (true, _) => 1,
                (_, true) => 2,
                _ => 0,
            };
            let within = (point.angle_rad - sample.gimbal_angle_rad).abs() <= 2.0 * point.bound_rad;
            self.rows[place].0 += usize::from(within);
            self.rows[place].1 += 1;
        }
        let contact = flight.truth.iter().position(|sample| sample.stop != Stop::Free).unwrap_or(0);
        let early = &estimated.points[contact.saturating_sub(6)..contact.saturating_sub(4)];
        self.announced += usize::from(early.iter().any(|point| point.flags.contains(Flags::SATURATION_AHEAD)));
    }
}
