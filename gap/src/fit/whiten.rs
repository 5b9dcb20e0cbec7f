//! Whitening: each channel divided by the spectrum of its noise.
//!
//! Where the bearing turns around, [`Slips`] whitens the noise of the logged rate; where it does so slowly, what they leave
//! of that noise, and all of it where it turns around most of the time, comes through the slope of the friction law:
//! `P + s^2 W(f) |G(f)|^2`, P as in [`super::power`], s the torque that the rate's noise makes, W Wiener's filter: of noise
//! and motion it leaves that much to be off.

use super::noise::Noise;
use super::plans::Plans;
use super::power::{Bands, Of, SEGMENT};
use super::shapes::Shapes;
use super::signals::of_channel;
use super::slip::Slips;
use crate::record::RateNoise;

/// Least power of noise, over the white noise that the samples themselves show.
const LEAST_POWER: f64 = 1e-3;

/// A whitening filter.
#[derive(Debug, Clone)]
pub struct Whitener {
    /// The noise of each channel.
    pub noise: Vec<Noise>,
    /// Rows that count.
    pub valid: Vec<bool>,
    /// `1 / sqrt(P)` at the lines of the transform.
    gains: Vec<Vec<f64>>,
    /// The same while the bearing turns around slowly.
    turning_gains: Vec<Vec<f64>>,
    turning: Vec<bool>,
    slips: Slips,
    plans: Plans,
}

/// Where the noise of inputs acts.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Loop<'a> {
    /// Transforms of the record's rows ([`Whitener::plans_of`]).
    pub(super) plans: &'a Plans,
    /// What noise looks like in each channel.
    pub shapes: &'a [Shapes],
    /// Rows at which the bearing may turn around, and those just after.
    pub turning: &'a [bool],
    /// s of the rate's noise as logged, in units of the impulse; zero where all of it is whitened turn by turn.
    pub turning_noise: f64,
    /// What is left of that noise.
    pub rate_noise: &'a RateNoise,
    /// Time between two rows [s].
    pub period_s: f64,
}

impl Whitener {
    /// Transforms with room for what a filter remembers.
    pub(super) fn plans_of(rows: usize) -> Plans {
        Plans::new(rows + SEGMENT.min(rows))
    }

    /// Fits the filter to a residual, channel by channel.
    #[must_use]
    pub(crate) fn new(residual: &[Vec<f64>], valid: &[bool], behind: Loop) -> Self {
        let plans = behind.plans;
        let step_hz = 1.0 / (plans.length() as f64 * behind.period_s);
        let quiet: Vec<bool> = valid.iter().zip(behind.turning).map(|(valid, turning)| *valid && !turning).collect();
        let turns: Vec<bool> = valid.iter().zip(behind.turning).map(|(valid, turning)| *valid && *turning).collect();
        let slow = behind.turning_noise > 0.0;
        let mut noise = Vec::new();
        let (mut gains, mut turning_gains) = (Vec::new(), Vec::new());
        for (channel, shapes) in residual.iter().zip(behind.shapes) {
            // where hardly anything else is, the rows that turn around show their noise themselves
            let aside = Some(Bands::new(channel, &quiet, Of::Most, behind.period_s));
            let aside = aside.filter(|bands| enough(&quiet) && bands.any());
            let most = if aside.is_some() { behind.turning_noise.powi(2) } else { 0.0 };
            let own = aside.unwrap_or_else(|| Bands::new(channel, valid, Of::Most, behind.period_s)).fit(shapes);
            let passed = |hz: f64| behind.rate_noise.pass(2.0 * hz * behind.period_s) * shapes.at(hz)[0];
            // at most what the slope makes of it: the gimbal follows the bearing and takes a part away
            let turning_power = if most > 0.0 {
                let turns = Bands::new(channel, &turns, Of::All, behind.period_s);
                turns.fit_more(&|hz| own.power(hz, shapes.at(hz)), &passed, most)
            } else {
                0.0
            };
            let powers = own.powers(shapes, plans.length() / 2, step_hz);
            let gain = |more: f64| -> Vec<f64> {
                let of = |(line, power): (usize, &f64)| power + more * passed(line as f64 * step_hz);
                powers.iter().enumerate().map(of).map(white).collect()
            };
            gains.push(gain(0.0));
            turning_gains.push(if slow { gain(turning_power) } else { Vec::new() });
            noise.push(own);
        }
        let turning = behind.turning.iter().map(|turning| slow && *turning).collect();
        Self {
            noise,
            valid: valid.to_vec(),
            gains,
            turning_gains,
            turning,
            slips: Slips::default(),
            plans: plans.clone(),
        }
    }

    /// The same with the filter fitted to what this one makes white.
    pub(crate) fn measured_again(mut self, residual: &[Vec<f64>], behind: Loop) -> Self {
        let whitened = self.apply(residual);
        let step_hz = 1.0 / (self.plans.length() as f64 * behind.period_s);
        for (channel, shapes) in behind.shapes.iter().enumerate() {
            let own = self.unwhitened(&whitened, &self.valid, channel, shapes, behind.period_s).fit(shapes);
            let powers = own.powers(shapes, self.plans.length() / 2, step_hz);
            self.gains[channel] = powers.into_iter().map(white).collect();
            self.noise[channel] = own;
        }
        self
    }

    /// How sure it is that a channel's noise of low frequency was taken too high, from what whitening leaves of it [nats].
    pub(crate) fn too_high(&self, whitened: &[f64], period_s: f64) -> f64 {
        let channels = self.gains.len();
        let of = |channel: usize| {
            let series: Vec<f64> = of_channel(whitened, channel, channels).collect();
            Bands::new(&series, &self.valid, Of::Most, period_s).below_one()
        };
        (0..channels).map(of).fold(0.0, f64::max)
    }

    /// What speaks for more noise behind the loop than the logged inputs can have, in what whitening left of some rows, summed
    /// over the channels [nats].
    pub(crate) fn beyond_inputs(
        &self,
        whitened: &[f64],
        rows: &[bool],
        shapes: &[Shapes],
        most: f64,
        period_s: f64,
    ) -> f64 {
        let of =
            |(channel, shapes)| self.unwhitened(whitened, rows, channel, shapes, period_s).beyond_inputs(shapes, most);
        shapes.iter().enumerate().map(of).sum()
    }

    /// Powers of a channel from what whitening left of some rows of it.
    fn unwhitened(&self, whitened: &[f64], rows: &[bool], channel: usize, shapes: &Shapes, period_s: f64) -> Bands {
        let series: Vec<f64> = of_channel(whitened, channel, self.gains.len()).collect();
        let mut bands = Bands::new(&series, rows, Of::Most, period_s);
        for (power, &hz) in bands.power.iter_mut().zip(&bands.hz) {
            *power *= self.noise[channel].power(hz, shapes.at(hz));
        }
        bands
    }

    /// The same with what whitens the noise of the rate turn by turn.
    pub(crate) fn with_slips(self, slips: Slips) -> Self {
        Self { slips, ..self }
    }

    /// The whitened samples of all channels, row after row; masked rows are zero.
    #[must_use]
    pub fn apply(&self, signals: &[Vec<f64>]) -> Vec<f64> {
        let mut whitened = self.filter(signals);
        self.slips.apply(&mut whitened);
        whitened
    }

    /// Through the filters of frequencies alone.
    pub(crate) fn filter(&self, signals: &[Vec<f64>]) -> Vec<f64> {
        let (channels, rows) = (signals.len(), self.valid.len());
        let mut out = vec![0.0; channels * rows];
        for (channel, signal) in signals.iter().enumerate() {
            let masked = signal.iter().zip(&self.valid).map(|(value, valid)| if *valid { *value } else { 0.0 });
            let lines = self.plans.lines(masked);
            let filters = [(&self.gains[channel], false), (&self.turning_gains[channel], true)];
            for (gain, turning) in filters.into_iter().filter(|(gain, _)| !gain.is_empty()) {
                let mut lines = lines.clone();
                for (line, gain) in lines.iter_mut().zip(gain) {
                    *line *= gain / self.plans.length() as f64;
                }
                let series = self.plans.series(&mut lines);
                let counts = self.valid.iter().zip(&self.turning).map(|(valid, turns)| *valid && *turns == turning);
                for ((row, value), counts) in out.chunks_exact_mut(channels).zip(&series).zip(counts) {
                    if counts {
                        row[channel] = *value;
                    }
                }
            }
        }
        out
    }

    /// The transforms, and what each line is divided by for the noise while nothing turns around.
    pub(super) fn plans(&self) -> &Plans {
        &self.plans
    }

    pub(super) fn slips(&self) -> &Slips {
        &self.slips
    }

    pub(super) fn gains(&self) -> &[Vec<f64>] {
        &self.gains
    }

    /// Samples of all channels.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.gains.len() * self.valid.len()
    }

    /// Samples that count.
    #[must_use]
    pub fn count(&self) -> usize {
        self.gains.len() * self.valid.iter().filter(|valid| **valid).count()
    }
}

/// What makes noise of such a power white.
fn white(power: f64) -> f64 {
    1.0 / power.max(LEAST_POWER).sqrt()
}

fn enough(valid: &[bool]) -> bool {
    4 * valid.iter().filter(|valid| **valid).count() > valid.len()
}
