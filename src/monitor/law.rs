//! The test itself.

use crate::BuildError;
use crate::build::modes::{BLOCKS, Modes};
use crate::build::plant::Plant;
use crate::build::poles::ORDER;
use crate::config::within;
use crate::number::Number;
use crate::row::ScaledRow;

use crate::state::{Regime as ModelRegime, State as ModelState};
use crate::stored::stored;

/// Rows of a block.
const BLOCK: u32 = 32;
/// Largest m that a block may add; no single block raises an alarm.
const LARGEST: f64 = 8.0;
/// k: what m must exceed for g to grow.
const ALLOWANCE: f64 = 1.25;
/// Full scales of m and of g. A mean of squares has the residual's twice, a variance likewise.
const M_SCALE: i32 = 4;
const G_SCALE: i32 = 10;
/// Blocks in a row within the clamp's zone from which the bearing creeps instead of passing through.
const CREEP: u32 = 3;
/// Rows after a saturation in which theta and its model may differ for the offset's sake.
const PAUSE: u32 = 1_000;

/// What the test is told, in SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Config {
    /// Alarms an hour that are allowed while the model is right.
    pub false_alarms_per_hour: f64,
    /// Noise of the pick-off, quantisation included, rms [rad].
    pub gyro_noise_rad: f64,
    /// Noise of the rate, rms [rad/s].
    pub rate_noise_radps: f64,
    /// Error of theta that the model is granted, relative to theta's recent peak: 0 for exact parameters.
    pub model_tolerance: f64,
}

impl Default for Config {
    /// One in ten thousand hours; 2.01 urad, 2e-4 rad/s, an exact model.
    fn default() -> Self {
        Self { false_alarms_per_hour: 1e-4, gyro_noise_rad: 2.01e-6, rate_noise_radps: 2e-4, model_tolerance: 0.0 }
    }
}

/// What the axis does.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Regime {
    /// The bearing slips one way.
    #[default]
    Slip,
    /// The bearing's rate is, or has just been, within the clamp's zone.
    Reversal,
    /// The gyro is on a stop, or has just left it: not tested.
    Saturated,
}

/// What the test says at one row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Report<N> {
    /// *Model disagrees*: stays set until [`State::acknowledge`].
    pub disagrees: bool,
    /// The regime in which it began to.
    pub regime: Regime,
    /// theta measured less modelled [rad], in the full scale of [`Law::residual_exponent`].
    pub residual_rad: N,
    /// g over its threshold.
    pub score: N,
}

/// The test, built once.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Law<N: Number> {
    /// From theta's full scale as modelled to that as measured, and from there to the residual's: theta itself may be far
    /// larger than any residual.
    modelled_shift: u32,
    residual_shift: u32,
    slip_rate: N,
    /// Variance of a block's sum for the pick-off's noise.
    noise: N,
    /// The same for a friction level of 1 within the clamp's zone; its root.
    zone: ScaledRow<N, 1>,
    /// The same for theta's recent peak.
    share: ScaledRow<N, 1>,
    /// Of the peak, over a block.
    decay: N::Coef,
    /// One over the rows of a block.
    share_of_block: N::Coef,
    allowance: N,
    largest: N,
    threshold: N,
    exponent: i32,
    /// Rows over which a reversal is felt.
    felt: u32,
}

stored!([N: Number] Law<N> {
    modelled_shift, residual_shift, slip_rate, noise, zone, share, decay, share_of_block, allowance, largest,
    threshold, exponent, felt,
});

/// The test's memory.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[allow(clippy::struct_excessive_bools, reason = "each holds over a span of its own")]
pub struct State<N: Number> {
    sum: N,
    rows: u32,
    score: N,
    /// Friction level of the last reversal, and rows since.
    level: N,
    /// Whether there was one within this block; blocks in a row with one; whether they were [`CREEP`] and are still felt.
    reversed: bool,
    dwell: u32,
    crept: bool,
    saturated: bool,
    since_reversal: u32,
    since_saturation: u32,
    peak: N,
    regime: Regime,
    begun: Regime,
    disagrees: bool,
}

impl<N: Number> State<N> {
    /// Takes the alarm back.
    pub fn acknowledge(&mut self) {
        self.disagrees = false;
        self.score = N::ZERO;
    }
}

impl Config {
    /// Builds the test for an axis; theta as measured has the full scale `2^gyro_exponent`
    /// ([`crate::estimator::Law::gyro_exponent`]).
    ///
    /// # Errors
    /// The first field that is wrong, of this configuration or of the axis'.
    pub fn build<N: Number>(&self, axis: &crate::Config, gyro_exponent: i32) -> Result<Law<N>, BuildError> {
        within("false_alarms_per_hour", self.false_alarms_per_hour, 1e-9, 1e3)?;
        within("gyro_noise_rad", self.gyro_noise_rad, 1e-9, 1e-3)?;
        within("rate_noise_radps", self.rate_noise_radps, 0.0, 1.0)?;
        within("model_tolerance", self.model_tolerance, 0.0, 1.0)?;
        let units = *axis.build::<N>()?.units();
        let modes = Modes::new(&Plant::new(axis))?;
        let (gain, felt) = response(&modes, axis.period_s);
        let noise = self.gyro_noise_rad;
        let exponent = N::exponent(256.0 * noise);
        // Sums of a block are means, so that they fit: 32 squares, each over 32.
        let square = 2 * exponent;
        let rows_an_hour = 3600.0 / (f64::from(BLOCK) * axis.period_s);
        let root = lundberg();
        let threshold = libm::log(rows_an_hour / self.false_alarms_per_hour) / root;
        // The clamp turns the rate's noise into torque; this is what theta would have if the bearing stayed there.
        let zone = gain * self.rate_noise_radps / axis.bearing.slip_rate_radps;
        Ok(Law {
            modelled_shift: (units.gyro_angle - gyro_exponent).max(0).unsigned_abs(),
            residual_shift: (gyro_exponent - exponent).max(0).unsigned_abs(),
            slip_rate: N::quantise(axis.bearing.slip_rate_radps + 4.0 * self.rate_noise_radps, units.rate),
            noise: N::quantise(noise * noise, square),
            zone: ScaledRow::build([zone], [units.torque], exponent),
            share: ScaledRow::build([self.model_tolerance], [units.gyro_angle], exponent),
            decay: N::coef(libm::exp(-f64::from(BLOCK) * axis.period_s / 0.5)),
            share_of_block: N::coef(1.0 / f64::from(BLOCK)),
            allowance: N::quantise(ALLOWANCE, G_SCALE),
            largest: N::quantise(LARGEST, M_SCALE),
            threshold: N::quantise(threshold, G_SCALE),
            exponent,
            felt,
        })
    }
}

impl<N: Number> Law<N> {
    /// The test's memory before the first row: it begins with a pause.
    #[must_use]
    pub fn start(&self) -> State<N> {
        State { since_saturation: 0, since_reversal: self.felt, ..State::default() }
    }

    /// Exponent of the residual's full scale.
    #[must_use]
    pub fn residual_exponent(&self) -> i32 {
        self.exponent
    }

    /// h, and k per block.
    #[must_use]
    pub fn threshold(&self) -> f64 {
        self.threshold.to_f64(G_SCALE)
    }

    /// Takes theta as measured at this row, and the axis' state after the same row.
    pub fn step(&self, state: &mut State<N>, measured: Option<N>, model: &ModelState<N>) -> Report<N> {
        let modelled = model.gyro_angle;
        if model.relative_rate.within(self.slip_rate) {
            state.reversed = true;
            state.level = model.friction_level;
        }
        let mut residual = N::ZERO;
        if let Some(measured) = measured {
            residual = (measured - modelled.shift_up(self.modelled_shift)).shift_up(self.residual_shift);
        }
        if matches!(model.regime, ModelRegime::Held(_)) {
            state.saturated = true;
        }
        // Without a sign the bits are in the order of the values, and no flag of a float has to be fetched.
        let size = modelled.abs().to_bits();
        if size > state.peak.to_bits() {
            state.peak = N::from_bits(size);
        }
        let square = residual.times(residual);
        state.sum = state.sum + if N::HAS_SCALES { N::head(self.share_of_block * square) } else { square };
        state.rows += 1;
        if state.rows >= BLOCK {
            self.close(state);
        }
        let score = state.score;
        Report { disagrees: state.disagrees, regime: state.begun, residual_rad: residual, score }
    }

    /// The end of a block.
    #[inline(never)]
    fn close(&self, state: &mut State<N>) {
        let rows_since = |since: u32, now: bool| if now { 0 } else { since.saturating_add(BLOCK) };
        state.since_reversal = rows_since(state.since_reversal, state.reversed);
        state.since_saturation = rows_since(state.since_saturation, state.saturated);
        state.dwell = if state.reversed { state.dwell.saturating_add(1) } else { 0 };
        state.crept |= state.dwell >= CREEP;
        (state.reversed, state.saturated) = (false, false);
        let mut variance = self.noise;
        state.regime = Regime::Slip;
        state.crept &= state.since_reversal < self.felt;
        if state.since_reversal < self.felt {
            state.regime = Regime::Reversal;
            // A passage is over before the noise has made all of this. Where the bearing creeps it has, and neighbouring
            // rows of theta then go together, so that a block has few degrees of freedom: four times the deviation.
            let passing = self.zone.at(&[state.level]);
            let twice = passing + passing;
            let deviation = if state.crept { twice + twice } else { passing };
            variance = variance + deviation.times(deviation);
        }
        let share = self.share.at(&[state.peak]);
        variance = variance + share.times(share);
        state.peak = N::head(self.decay * state.peak);
        // A mean of 32 squares; fixed point has room for nothing else on the way, either.
        let mean = if N::HAS_SCALES { state.sum } else { N::head(self.share_of_block * state.sum) };
        let m = mean.shift_down(M_SHIFT).ratio(variance).least(self.largest);
        (state.sum, state.rows) = (N::ZERO, 0);
        if state.since_saturation < PAUSE {
            state.regime = Regime::Saturated;
            state.score = N::ZERO;
            return;
        }
        if state.score == N::ZERO && !state.disagrees {
            state.begun = state.regime;
        }
        state.score = (state.score + m.shift_down(G_SHIFT) - self.allowance).most(N::ZERO).least(self.threshold);
        state.disagrees |= state.score >= self.threshold;
    }

    /// theta on or near a stop as measured: the test pauses.
    pub fn pause(&self, state: &mut State<N>) {
        state.saturated = true;
    }
}

const M_SHIFT: u32 = M_SCALE.unsigned_abs();
const G_SHIFT: u32 = (G_SCALE - M_SCALE).unsigned_abs();

/// The positive root a of `E[e^(a (m - k))] = 1` for m the mean of [`BLOCK`] squares of normal numbers:
/// `-(B/2) ln(1 - 2 a / B) = a k`.
fn lundberg() -> f64 {
    let half = 0.5 * f64::from(BLOCK);
    let (mut low, mut high) = (1e-6, half * (1.0 - 1e-12));
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if -half * libm::log1p(-middle / half) < middle * ALLOWANCE {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// rms of theta for white torque of rms 1, one value a period; and periods until the response has died away.
fn response(modes: &Modes, period: f64) -> (f64, u32) {
    let (blocks, single) = modes.transition(period);
    let drive = modes.drive(period);
    let mut x: [f64; ORDER] = drive;
    let (mut sum, mut last, mut felt) = (0.0, 0.0, 0);
    let mut peak = 0.0_f64;
    for step in 0..2_000_u32 {
        // The pulse ends after one period: the step's response less that of a period before.
        let theta: f64 = x.iter().sum();
        let pulse = theta - last;
        last = theta;
        sum += pulse * pulse;
        peak = peak.max(pulse.abs());
        if pulse.abs() > 0.03 * peak {
            felt = step;
        }
        for block in 0..BLOCKS {
            let [a, b, c, d] = blocks[block];
            let (u, v) = (x[2 * block], x[2 * block + 1]);
            x[2 * block] = u + a * u + b * v;
            x[2 * block + 1] = v + c * u + d * v;
        }
        x[ORDER - 1] += single * x[ORDER - 1];
    }
    (libm::sqrt(sum), felt + BLOCK)
}
