//! The motion of an axis as its log shows it: position, rate, acceleration, zero-phase and band-limited, and the rows
//! at which the balance is made.

use std::f64::consts::TAU;

use gimbal_model_file::AxisModel;
use gimbal_model_file::axis::Motion as Kind;

use super::noise::{noise, step};
use super::smooth::{HALF_POWER, Kernel};
use super::table::AxisLog;

/// Shares of the sampling rate that the band may end at, the widest first.
const BANDS: [f64; 6] = [0.1, 0.0667, 0.04, 0.025, 0.0167, 0.01];
/// Noise that the acceleration may bring into the balance, as a share of the effort: of a small gap and of a large one.
pub(super) const NARROW: f64 = 0.01;
pub(super) const WIDE: f64 = 0.04;
/// Blocks of time: what is held out, and what the bootstrap draws.
pub(super) const BLOCKS: usize = 32;
/// An axis is at rest when it stays slow this long [s].
const DWELL_S: f64 = 0.015;
/// Rows away from slow passages, over those that move, from which on they are enough for a balance.
const ENOUGH: f64 = 0.15;
/// Waves that the travel must hold for their number to be searched.
pub(super) const LEAST_WAVES: f64 = 0.7;
/// Rows of the balance at most.
const MOST_ROWS: usize = 12_000;
/// Below this share of moving rows the axis is taken to stand.
const STANDS: f64 = 0.1;

/// Where position and rate come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MotionFrom {
    /// The position column, differentiated.
    Position,
    /// The velocity column; its integral is the position.
    Velocity,
}

/// How friction comes up to its level about zero rate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Corner {
    /// Along a line that ends at a rate.
    Line(f64),
    /// `tanh(v / rate)`.
    Smooth(f64),
}

impl Corner {
    /// Share of the level, with the sign of the rate.
    pub(super) fn share(self, rate: f64) -> f64 {
        match self {
            Self::Line(full_at) => (rate / full_at).clamp(-1.0, 1.0),
            Self::Smooth(own) => (rate / own).tanh(),
        }
    }
}

/// Motion at every row, and the grid of the balance.
#[derive(Debug, Clone)]
pub(super) struct Motion {
    pub(super) from: MotionFrom,
    pub(super) period_s: f64,
    pub(super) band_hz: f64,
    pub(super) rotary: bool,
    /// Position, rate, acceleration: smoothed with g.
    pub(super) q: Vec<f64>,
    pub(super) v: Vec<f64>,
    pub(super) a: Vec<f64>,
    /// Direction: rate over that of full friction, clamped; of a standing axis the direction of its last motion.
    pub(super) s: Vec<f64>,
    /// Effort; held efforts moved to the middle of what they act over.
    pub(super) effort: Vec<f64>,
    /// Middle of the positions and size of the effort needed, from which some shapes are counted: of the log that is
    /// fitted, on any other too.
    pub(super) middle: f64,
    pub(super) size: f64,
    /// Inertia, viscous and Coulomb friction of the model.
    pub(super) nominal: [f64; 3],
    /// Effort that the parameters alone need: for effects that hang on the effort.
    pub(super) needed: Vec<f64>,
    pub(super) auxiliary: Vec<(String, Vec<f64>)>,
    /// What each is counted from as a gain: its mean where it stays away from zero, as a bus voltage does.
    pub(super) references: Vec<f64>,
    /// Further smoothing of what is already smoothed, and both together.
    pub(super) rest: Kernel,
    pub(super) whole: Kernel,
    /// Rows of the balance and the block of each.
    pub(super) rows: Vec<usize>,
    pub(super) block: Vec<usize>,
    /// Rows of the log from one row of the grid to the next.
    pub(super) thin: usize,
    /// Rate below which the direction is not known, and how friction comes up to its level.
    pub(super) quiet: f64,
    pub(super) corner: Corner,
    /// Largest rate, and the span of positions.
    pub(super) fastest: f64,
    pub(super) travel: f64,
    /// Noise of one position [m or rad], or of one rate.
    pub(super) position_noise: f64,
    /// Noise that motion and effort bring into the balance, and that of the motion alone.
    pub(super) floor: f64,
    pub(super) own_noise: f64,
    /// Noise of rate and acceleration on the grid.
    pub(super) rate_noise: f64,
    pub(super) acceleration_noise: f64,
    /// Share of the rows at rest; whether the axis stands all the time.
    pub(super) at_rest: f64,
    pub(super) stands: bool,
    /// Whether effort and motion may have been read at moments apart.
    pub(super) apart: bool,
}

/// Mean of a channel that goes up and down by less than that; zero of one that comes and goes.
fn reference(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
    let high = values.iter().fold(f64::MIN, |high, value| high.max(*value));
    let low = values.iter().fold(f64::MAX, |low, value| low.min(*value));
    if high - low < mean.abs() { mean } else { 0.0 }
}

impl Motion {
    #[allow(clippy::too_many_lines, reason = "one chain from the columns to the grid")]
    pub(super) fn new(log: &AxisLog, model: &AxisModel, from: MotionFrom, effort_sign: f64, noise_share: f64) -> Self {
        let period_s = log.period_s;
        let rate_hz = 1.0 / period_s;
        let position: Vec<f64> = match (from, &log.position, &log.velocity) {
            (MotionFrom::Position, Some(position), _) => position.clone(),
            (_, _, Some(velocity)) => {
                let mut sum = 0.0;
                let mut last = velocity[0];
                velocity
                    .iter()
                    .map(|v| {
                        sum += 0.5 * (v + last) * period_s;
                        last = *v;
                        sum
                    })
                    .collect()
            }
            _ => vec![0.0; log.effort.len()],
        };
        let mut effort: Vec<f64> = log.effort.iter().map(|value| value * effort_sign).collect();
        let effort_noise = if model.effort_held { step(&effort) / 12_f64.sqrt() } else { noise(&effort) };
        if model.effort_held {
            effort = (0..effort.len()).map(|k| 0.5 * (effort[k] + effort[k.saturating_sub(1)])).collect();
        }
        let mean = effort.iter().sum::<f64>() / effort.len() as f64;
        let spread = (effort.iter().map(|u| (u - mean).powi(2)).sum::<f64>() / effort.len() as f64).sqrt();
        let position_noise = match (from, &log.velocity) {
            (MotionFrom::Velocity, Some(velocity)) => noise(velocity),
            _ => noise(&position),
        };
        // acceleration noise of a band: kernels of both smoothings in one
        let noise_at = |band_hz: f64| {
            let sigma = HALF_POWER / band_hz * rate_hz * 2.0_f64.sqrt();
            let order = if from == MotionFrom::Velocity { 1 } else { 2 };
            position_noise * Kernel::new(sigma, order, period_s).noise_gain()
        };
        let band_hz = model.band_hz.unwrap_or_else(|| {
            let good = |share: &&f64| model.inertia * noise_at(**share * rate_hz) < noise_share * spread;
            BANDS.iter().find(good).unwrap_or(&BANDS[BANDS.len() - 1]) * rate_hz
        });
        let sigma = HALF_POWER / band_hz * rate_hz;
        let rest = Kernel::new(sigma, 0, period_s);
        let whole = Kernel::new(sigma * 2.0_f64.sqrt(), 0, period_s);
        let (q, v, a) = if let (MotionFrom::Velocity, Some(velocity)) = (from, &log.velocity) {
            (position, Kernel::new(sigma, 0, period_s).apply(velocity), Kernel::new(sigma, 1, period_s).apply(velocity))
        } else {
            let of = |order| Kernel::new(sigma, order, period_s).apply(&position);
            (of(0), of(1), of(2))
        };
        let rate_noise = match from {
            MotionFrom::Position => position_noise * Kernel::new(sigma, 1, period_s).noise_gain(),
            MotionFrom::Velocity => position_noise * Kernel::new(sigma, 0, period_s).noise_gain(),
        };
        let fastest = v.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        let (low, high) = q.iter().fold((f64::MAX, f64::MIN), |(low, high), q| (low.min(*q), high.max(*q)));
        let quiet = (4.0 * rate_noise).max(1e-3 * fastest);
        // runs of slow rows are rest
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count of rows")]
        let dwell = (DWELL_S / period_s).ceil() as usize;
        // and so are the rows that smoothing reaches from there; in a shorter one it may stick, for all that the rate shows
        let reach = whole.half();
        let (mut resting, mut turning) = (vec![false; v.len()], vec![false; v.len()]);
        let mut start = 0_usize;
        for k in 0..=v.len() {
            if k == v.len() || v[k].abs() > quiet {
                let reached = start.saturating_sub(reach)..(k + reach).min(v.len());
                if k - start >= dwell {
                    resting[reached.clone()].fill(true);
                }
                let passes = k > start || k > 0 && k < v.len() && v[k] * v[k - 1] < 0.0;
                if passes {
                    turning[reached].fill(true);
                }
                start = k + 1;
            }
        }
        let at_rest = resting.iter().filter(|rest| **rest).count() as f64 / v.len() as f64;
        let stands = 1.0 - at_rest < STANDS;
        let s = if stands {
            super::memory::play_state(&q, (8.0 * position_noise).max(2e-3 * (high - low)))
        } else {
            v.iter().map(|v| Corner::Line(quiet).share(*v)).collect()
        };
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small factor")]
        let thin = ((rate_hz / (4.0 * band_hz)).floor() as usize).max(v.len() / MOST_ROWS).max(1);
        let margin = whole.half() + 2;
        let good = |row: &usize| {
            (stands || !resting[*row])
                && log.valid[row - margin.min(*row)..(row + margin).min(v.len())].iter().all(|valid| *valid)
        };
        let last = v.len().saturating_sub(margin);
        let mut rows: Vec<usize> = (margin..last).step_by(thin).filter(good).collect();
        let steady: Vec<usize> = rows.iter().copied().filter(|row| !turning[*row]).collect();
        if !stands && steady.len() as f64 >= ENOUGH * rows.len() as f64 {
            rows = steady;
        }
        let block = rows.iter().map(|row| row * BLOCKS / v.len()).collect();
        let own_noise = model.inertia * noise_at(band_hz);
        let floor = own_noise.hypot(effort_noise * whole.noise_gain());
        Self {
            from,
            period_s,
            band_hz,
            rotary: model.motion == Kind::Rotary,
            middle: q.iter().sum::<f64>() / q.len().max(1) as f64,
            size: 1.0,
            nominal: [model.inertia, model.viscous, model.coulomb],
            needed: vec![0.0; v.len()],
            auxiliary: log.auxiliary.clone(),
            references: log.auxiliary.iter().map(|(_, values)| reference(values)).collect(),
            q,
            v,
            a,
            s,
            effort,
            rest,
            whole,
            rows,
            block,
            thin,
            quiet,
            corner: Corner::Line(quiet),
            fastest,
            travel: high - low,
            position_noise,
            floor,
            own_noise,
            rate_noise,
            acceleration_noise: noise_at(band_hz),
            at_rest,
            stands,
            apart: !stands,
        }
    }

    /// Has friction come up to its level along such a corner.
    pub(super) fn set_corner(&mut self, corner: Corner) {
        if !self.stands {
            self.corner = corner;
            self.s = self.v.iter().map(|v| corner.share(*v)).collect();
        }
    }

    /// Standard deviation of the whole smoothing [rows].
    pub(super) fn whole_sigma(&self) -> f64 {
        HALF_POWER / self.band_hz / self.period_s * 2.0_f64.sqrt()
    }

    /// Noise of a derivative of the position, smoothed with everything. White noise of deviation n at rows of period T,
    /// through a Gaussian of standard deviation S:
    ///
    /// ```text
    /// variance = n^2 T gamma(k + 1/2)/(2 pi S^(2k + 1))        k: order, of a logged rate one less
    /// ```
    pub(super) fn derivative_noise(&self, order: u32) -> f64 {
        let order = if self.from == MotionFrom::Velocity { order - 1 } else { order };
        let sigma_s = self.whole_sigma() * self.period_s;
        let gamma = (0..order).fold(std::f64::consts::PI.sqrt(), |gamma, k| gamma * (f64::from(k) + 0.5));
        self.position_noise * (self.period_s * gamma / (TAU * sigma_s.powi(2 * order.cast_signed() + 1))).sqrt()
    }

    /// A smoothed signal on the grid of the balance.
    pub(super) fn smoothed(&self, values: &[f64]) -> Vec<f64> {
        self.rows.iter().map(|&row| self.rest.at(values, row)).collect()
    }

    /// A signal, or a function of the motion, on the grid of the balance.
    pub(super) fn raw(&self, values: &[f64]) -> Vec<f64> {
        self.rows.iter().map(|&row| self.whole.at(values, row)).collect()
    }

    /// Values at the rows of the grid as they are.
    pub(super) fn pick(&self, values: &[f64]) -> Vec<f64> {
        self.rows.iter().map(|&row| values[row]).collect()
    }

    /// What is on the grid of the balance in time, zero where a row does not count.
    pub(super) fn in_time(&self, on_grid: impl IntoIterator<Item = f64>) -> Vec<f64> {
        let mut even = vec![0.0; self.q.len() / self.thin + 1];
        for (value, row) in on_grid.into_iter().zip(&self.rows) {
            even[row / self.thin] = value;
        }
        even
    }

    /// Time from one row of the grid to the next.
    pub(super) fn grid_s(&self) -> f64 {
        self.period_s * self.thin as f64
    }

    /// Time since the first row.
    pub(super) fn time_s(&self, row: usize) -> f64 {
        row as f64 * self.period_s
    }

    /// Length of the log.
    pub(super) fn length_s(&self) -> f64 {
        self.time_s(self.q.len())
    }

    /// Derivative with respect to time of a signal at every row.
    pub(super) fn derivative(&self, values: &[f64]) -> Vec<f64> {
        let last = values.len() - 1;
        (0..values.len())
            .map(|k| {
                let (from, to) = (k.saturating_sub(1), (k + 1).min(last));
                (values[to] - values[from]) / ((to - from) as f64 * self.period_s)
            })
            .collect()
    }

    /// Waves per unit of position that the travel can hold.
    pub(super) fn wave_numbers(&self) -> Vec<f64> {
        if self.travel <= 0.0 {
            return Vec::new();
        }
        if self.rotary {
            let least = (LEAST_WAVES * TAU / self.travel).max(1.0).ceil();
            (0..220).map(|k| least + f64::from(k)).filter(|k| *k <= 220.0).collect()
        } else {
            (3..400).map(|half| f64::from(half) * 0.5 * TAU / self.travel).collect()
        }
    }
}
