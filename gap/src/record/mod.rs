//! A log made ready: one grid, inputs filled in, outputs with a mask, and what is wrong with the data.

mod anew;
mod channel;
mod colour;
mod converter;
mod dwell;
mod faults;
mod force_noise;
mod grid;
mod hum;
mod missing;
mod part;
mod plateau;
mod quiet;
mod rough;
mod series;
mod spikes;
mod stuck;

use std::ops::Range;

use gimbal_log::{Column, Log};
use gimbal_servo::Config;

use self::anew::worst;
use self::converter::is_rounded;
use self::grid::{Grid, filled};
use self::missing::{Whole, whole};
use crate::simulate::{Begin, Inputs, Physics};
pub use channel::{Channel, Signal};
pub(crate) use converter::{least_noise, phase, whole_step};
pub use faults::{Data, faults};
pub use force_noise::ForceNoise;
pub(crate) use force_noise::slow;
pub(crate) use part::BEGINNING_S;
pub(crate) use plateau::{LEAST_STOP, peak_rad, plateau};
pub use quiet::RateNoise;
pub(crate) use quiet::between;
pub(crate) use rough::{rough, tails};

/// Shortest log that a diagnosis is made from [s].
const SHORTEST_S: f64 = 6.0;
/// Least rms change of the vehicle rate [rad/s] and of the acceleration [m/s2] that excite anything.
const LEAST_RATE_RADPS: f64 = 1.5e-3;
const LEAST_ACCEL_MPS2: f64 = 0.1;
/// Shares of the nominal stop between which the float may have touched it.
const NEAR_STOP: [f64; 2] = [0.95, 1.05];

/// A log on its grid.
#[derive(Debug, Clone)]
pub struct Record {
    /// Time of the first row in the log [s].
    pub first_s: f64,
    /// What drives the platform.
    pub inputs: Inputs,
    /// What is compared, `gyro_angle_rad` first.
    pub channels: Vec<Channel>,
    /// Angle of the stop as the pick-off shows it, when it was reached [rad].
    pub plateau_rad: Option<f64>,
    /// The longest run of rows away from it; none where it was not reached.
    away_from_stop: Option<Range<usize>>,
    /// Runs of rows whose inputs are not known.
    unknown: Vec<Range<usize>>,
    /// Runs of rows that count and in which the platform begins anew, after a stop or after what is not known.
    anew: Vec<Range<usize>>,
    /// Whether the rate changes in steps that are no small part of its noise: what writes the log makes such.
    pub(crate) is_rounded: bool,
    /// Noise of the rate.
    pub rate_noise: RateNoise,
    /// Rms of the motor's torque that the loop makes of its pick-off's noise [N m].
    pub(crate) motor_noise_nm: f64,
    /// Noise of the specific force along each axis.
    pub force_noise: [ForceNoise; 3],
    /// What makes a diagnosis impossible, in words.
    pub faults: Vec<String>,
    /// What is worth knowing.
    pub notes: Vec<String>,
}

impl Record {
    /// Reads a log against the nominal parameters.
    #[must_use]
    pub fn new(log: &Log, config: &Config) -> Self {
        let time = log.column(Column::Time).unwrap_or_default();
        let mut faults = Vec::new();
        let mut notes: Vec<String> = Vec::new();
        let report = &log.time;
        let period_s = if report.period_s > 0.0 { report.period_s } else { 1e-3 };
        let grid = Grid::new(time, period_s);
        let period_s = grid.period_s;
        if report.jitter_rms_s > 0.05 * period_s {
            faults.push(format!(
                "the time stamps jitter by {:.2} ms rms: samples are not where they claim to be",
                1e3 * report.jitter_rms_s
            ));
        }
        if report.repeats > 0 || report.gaps > 0 {
            notes.push(report.to_string());
        }
        if report.rates.len() > 1 {
            faults.push("the log has no constant rate".to_owned());
        }
        if grid.filled * 5 > grid.rows {
            faults.push(format!("{} of {} rows are missing", grid.filled, grid.rows));
        }
        let mut unknown: Vec<Range<usize>> = Vec::new();
        let mut driven = |column: Column| -> Vec<f64> {
            let Some(values) = log.column(column) else { return Vec::new() };
            if let Some(stuck) = stuck::told(column.name(), values, period_s) {
                // nothing but one effect hangs on it; a table that turns at one rate is read at one value
                if column == Column::CrossRate && !config.gyro.cross_coupling {
                    notes.push(format!("{stuck}: it is not used"));
                    return Vec::new();
                }
                faults.push(stuck);
            }
            let Whole { values, unknown: own } = whole(&grid.place(values));
            unknown.extend(own);
            values
        };
        let accel_mps2 = [Column::AccelX, Column::AccelY, Column::AccelZ].map(&mut driven);
        let (rate_radps, cross_radps) = (driven(Column::VehicleRate), driven(Column::CrossRate));
        let begin_rad = log.column(Column::RelativeAngle).and_then(|values| values.first().copied()).unwrap_or(0.0);
        let mut inputs = Inputs { period_s, start_s: 0.0, accel_mps2, rate_radps, cross_radps, ..Inputs::default() };
        inputs.complete(&config.bearing, if begin_rad.is_finite() { begin_rad } else { 0.0 });
        let mut channels = Vec::new();
        for signal in Signal::ALL {
            let Some(values) = log.column(signal.column()) else { continue };
            if values.iter().all(|value| value.is_nan()) {
                continue;
            }
            if let Some(stuck) = stuck::told(signal.column().name(), values, period_s) {
                faults.push(stuck);
                continue;
            }
            if is_constant(values) {
                faults.push(format!("{} never changes", signal.column().name()));
                continue;
            }
            let mut channel = Channel::new(signal, grid.place(values));
            if let Some(told) = channel.told_sparse() {
                if signal == Signal::GyroAngle {
                    faults.push(format!("{told}: bring all columns to its rate"));
                } else {
                    notes.push(format!("{told}: it is not used"));
                }
                continue;
            }
            notes.extend(channel.without_spikes());
            channels.push(channel);
        }
        let is_rounded = is_rounded(&inputs.rate_radps);
        let rate_noise = RateNoise::logged(&inputs.rate_radps);
        let force_noise = inputs.accel_mps2.each_ref().map(|axis| ForceNoise::logged(axis));
        let mut record = Self {
            first_s: time.first().copied().unwrap_or(0.0),
            inputs,
            channels,
            plateau_rad: None,
            away_from_stop: None,
            unknown: worst(unknown),
            anew: Vec::new(),
            is_rounded,
            rate_noise,
            motor_noise_nm: 0.0,
            force_noise,
            faults,
            notes,
        };
        record.begins_anew_after_gaps();
        if let Some(longest) = record.unknown.iter().map(ExactSizeIterator::len).max() {
            record.notes.push(format!(
                "inputs are missing {} times, for up to {:.3} s, and shake meanwhile: the platform begins anew after each",
                record.unknown.len(),
                longest as f64 * period_s
            ));
        }
        record.find_plateau(config);
        record.look_at_excitation(grid.rows as f64 * period_s);
        record
    }

    /// Number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.inputs.len()
    }

    /// A channel by its signal.
    #[must_use]
    pub fn channel(&self, signal: Signal) -> Option<&Channel> {
        self.channels.iter().find(|channel| channel.signal == signal)
    }

    /// Where a platform begins that reads as the first rows do.
    #[must_use]
    pub fn begin(&self, physics: &Physics, inputs: &Inputs) -> Begin {
        let first = |signal| self.channel(signal).and_then(|channel| channel.beginning(self.inputs.period_s));
        Begin::at(physics, inputs, first(Signal::GyroAngle).unwrap_or(0.0), first(Signal::MotorTorque))
    }

    /// Whether the float touches a stop, or may have.
    pub(crate) fn comes_near_a_stop(&self) -> bool {
        self.away_from_stop.is_some()
    }

    /// Runs of rows that count after the float was on or near a stop, or after what is not known, each to the next.
    pub(crate) fn anew(&self) -> &[Range<usize>] {
        &self.anew
    }

    fn look_at_excitation(&mut self, length_s: f64) {
        if length_s < SHORTEST_S {
            self.faults.push(format!("{length_s:.1} s are too short; {SHORTEST_S} s are the least"));
        }
        let rate = deviation(&self.inputs.rate_radps);
        let accel = self.inputs.accel_mps2.iter().map(|axis| deviation(axis)).fold(0.0, f64::max);
        if rate < LEAST_RATE_RADPS && accel < LEAST_ACCEL_MPS2 {
            self.faults.push("the inputs are constant: nothing is excited".to_owned());
        }
        if !self.channels.iter().any(|channel| channel.signal == Signal::GyroAngle) {
            self.faults.push("no usable gyro_angle_rad".to_owned());
        }
    }

    /// Looks for time on the stop, or so near it that the float may have touched it.
    fn find_plateau(&mut self, config: &Config) {
        let Some(theta) = self.channel(Signal::GyroAngle) else { return };
        let (peak, stop) = (peak_rad(&theta.values), config.gyro.stop_angle_rad);
        let plateau = plateau(&theta.values, self.inputs.period_s, stop);
        let level_rad = plateau.as_ref().map(|plateau| plateau.level_rad);
        let on_stop: Vec<bool> = if let Some(plateau) = plateau {
            plateau.on_stop
        } else {
            // a touch too short to be seen, wherever the stop is within its tolerance
            let [near, beyond] = NEAR_STOP.map(|share| share * stop);
            if peak < near || peak > beyond {
                return;
            }
            theta.values.iter().map(|value| value.abs() > near).collect()
        };
        self.plateau_rad = level_rad;
        self.leave_out(&on_stop);
    }

    /// Takes the float to have been on a stop that its plateaus are too short to show.
    pub(crate) fn touches(&mut self, level_rad: f64, on_stop: &[bool]) {
        self.plateau_rad = Some(level_rad);
        self.notes.push(format!(
            "the float touched a stop at {level_rad:.3e} rad: the loop's answer tells it, no plateau does"
        ));
        self.leave_out(on_stop);
    }

    /// Takes the motor to be as noisy, and the gimbal to be shaken so much beside what the logged rate has of noise.
    pub(crate) fn is_shaken(&mut self, motor_nm: f64, rate_radps: f64) {
        self.motor_noise_nm = motor_nm;
        if rate_radps > 0.0 {
            self.rate_noise.rms_radps = self.rate_noise.rms_radps.hypot(rate_radps);
            self.notes.push(format!("the loop shakes the gimbal with its own noise, by {rate_radps:.1e} rad/s"));
        }
    }

    /// Whether the specific force is at rest across the gimbal's axis: an unbalance is a constant torque then.
    pub(crate) fn is_still(&self) -> bool {
        self.inputs.accel_mps2[..2].iter().all(|axis| is_constant(axis))
    }

    /// Takes these inputs, in which the specific force is at rest.
    pub(crate) fn stands_still(&mut self, inputs: Inputs) {
        for (noise, axis) in self.force_noise.iter_mut().zip(&inputs.accel_mps2) {
            if is_constant(axis) {
                *noise = ForceNoise::default();
            }
        }
        self.inputs = inputs;
        self.notes.push("the specific force stands still: what the log has of it beside its mean is noise".to_owned());
    }
}

pub(crate) fn is_constant(values: &[f64]) -> bool {
    values.windows(2).all(|pair| pair[0].to_bits() == pair[1].to_bits())
}

pub(crate) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

pub(crate) fn deviation(values: &[f64]) -> f64 {
    let mean = mean(values);
    (values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>() / values.len().max(1) as f64).sqrt()
}
