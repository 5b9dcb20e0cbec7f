//! A run through the flight code and through the plant, side by side.

use std::fmt::Write;

use gimbal_servo::{Config, Input};

use super::refused;
use super::sheet::{Difference, MARKED};
use crate::exit::Failure;
use crate::interrupt;
use crate::run::flight::Flight;
use crate::run::model::{Drive, Initial, Model, Sample};
use crate::run::reference::Reference;

/// Both runs.
pub(super) struct Trace {
    pub(super) times_s: Vec<f64>,
    pub(super) inputs: Vec<Input<f64>>,
    pub(super) flight: Vec<Sample>,
    pub(super) plant: Vec<Sample>,
}

/// A signal of a sample.
pub(super) type Signal = fn(&Sample) -> f64;

impl Trace {
    /// Runs rows at the configuration's period.
    pub(super) fn run(config: &Config, initial: Initial, rows: Vec<Input<f64>>) -> Result<Self, Failure> {
        let mut flight = Flight::<f32>::new(config, initial).map_err(refused)?;
        let mut plant = Reference::new(config, initial).map_err(refused)?;
        let take = |model: &mut dyn Model| {
            let samples = rows.iter().map(|row| {
                model.step(&Drive::from(*row));
                model.sample()
            });
            samples.collect()
        };
        let (flight, plant) = (take(&mut flight), take(&mut plant));
        interrupt::check()?;
        let times_s = (0..rows.len()).map(|k| k as f64 * config.period_s).collect();
        Ok(Self { times_s, inputs: rows, flight, plant })
    }

    /// A signal of the flight code over time.
    pub(super) fn flight_points(&self, signal: Signal, factor: f64) -> Vec<(f64, f64)> {
        self.times_s.iter().zip(&self.flight).map(|(&time_s, sample)| (time_s, factor * signal(sample))).collect()
    }

    /// A signal of the plant over time.
    pub(super) fn plant_points(&self, signal: Signal, factor: f64) -> Vec<(f64, f64)> {
        self.times_s.iter().zip(&self.plant).map(|(&time_s, sample)| (time_s, factor * signal(sample))).collect()
    }

    /// Largest difference of a signal.
    pub(super) fn difference(&self, name: &'static str, signal: Signal) -> Difference {
        let peak = self.peak(signal);
        let (at, most) = self
            .shares(signal, peak)
            .enumerate()
            .fold((0, 0.0), |most, (k, share)| if share > most.1 { (k, share) } else { most });
        Difference { signal: name, of_peak: most, at: format!("{:.3} s", self.times_s[at]) }
    }

    /// Spans of time in which any of the signals differs by more than the marked share of its peak.
    pub(super) fn marked(&self, signals: &[Signal]) -> Vec<(f64, f64)> {
        let mut above = vec![false; self.times_s.len()];
        for signal in signals {
            for (above, share) in above.iter_mut().zip(self.shares(*signal, self.peak(*signal))) {
                *above |= share > MARKED;
            }
        }
        let mut spans: Vec<(f64, f64)> = Vec::new();
        let mut open = false;
        for (&time_s, above) in self.times_s.iter().zip(above) {
            match spans.last_mut().filter(|_| open) {
                Some(span) if above => span.1 = time_s,
                _ if above => spans.push((time_s, time_s)),
                _ => {}
            }
            open = above;
        }
        spans
    }

    fn peak(&self, signal: Signal) -> f64 {
        self.plant.iter().map(|sample| signal(sample).abs()).fold(0.0, f64::max)
    }

    fn shares(&self, signal: Signal, peak: f64) -> impl Iterator<Item = f64> {
        let whole = if peak > 0.0 { peak } else { 1.0 };
        self.flight.iter().zip(&self.plant).map(move |(flight, plant)| (signal(flight) - signal(plant)).abs() / whole)
    }

    /// Every row, with the signals of both.
    pub(super) fn csv(&self) -> String {
        let mut text = "time_s,accel_y_mps2,vehicle_rate_radps,torque_nm".to_owned();
        for name in ["gimbal_angle_rad", "gyro_angle_rad", "motor_torque_nm", "velocity_error_mps", "position_error_m"]
        {
            let _ = write!(text, ",flight_{name},plant_{name}");
        }
        text.push('\n');
        for (k, &time_s) in self.times_s.iter().enumerate() {
            let input = &self.inputs[k];
            let (flight, plant) = (&self.flight[k], &self.plant[k]);
            let _ = write!(text, "{time_s:.6},{},{},{}", input.accel_y_mps2, input.vehicle_rate_radps, input.torque_nm);
            for signal in [PHI, THETA, MOTOR, VELOCITY, POSITION] {
                let _ = write!(text, ",{:.7e},{:.7e}", signal(flight), signal(plant));
            }
            text.push('\n');
        }
        text
    }
}

/// phi [rad].
pub(super) const PHI: Signal = |sample| sample.gimbal_angle_rad;
/// theta [rad].
pub(super) const THETA: Signal = |sample| sample.gyro_angle_rad;
/// Motor torque [N m].
pub(super) const MOTOR: Signal = |sample| sample.motor_torque_nm;
/// Velocity error along the acceleration's normal, x [m/s].
pub(super) const VELOCITY: Signal = |sample| sample.velocity_error_mps[0];
/// Position error, likewise [m].
pub(super) const POSITION: Signal = |sample| sample.position_error_m[0];

#[cfg(test)]
mod tests {
    use gimbal_servo::{Config, Input};

    use super::{PHI, THETA, Trace};
    use crate::run::model::{Initial, held};

    /// What is above 0.1 % of the peak is marked, there and nowhere else; what is below is not.
    #[test]
    fn contract_differences_above_a_thousandth_of_the_peak_are_marked() {
        let config = held(Config::consistent());
        let rows = vec![Input { torque_nm: 0.01, ..Input::default() }; 1000];
        let mut trace = Trace::run(&config, Initial::Zero, rows).expect("a preset");
        assert!(trace.marked(&[PHI, THETA]).is_empty());
        let peak = trace.peak(PHI);
        for (k, sample) in trace.flight.iter_mut().enumerate() {
            sample.gimbal_angle_rad += match k {
                200..300 => 2e-3 * peak,
                600..700 => 5e-4 * peak,
                _ => 0.0,
            };
        }
        let spans = trace.marked(&[PHI, THETA]);
        assert_eq!(spans.len(), 1);
        assert!((spans[0].0 - 0.2).abs() < 1e-9 && (spans[0].1 - 0.299).abs() < 1e-9, "{spans:?}");
        let difference = trace.difference("phi", PHI);
        let told = difference.text();
        assert!((difference.of_peak / 2e-3 - 1.0).abs() < 0.05 && told.ends_with("above 0.1 %: marked"), "{told}");
        assert!(!trace.difference("theta", THETA).text().contains("marked"));
    }
}
