//! Sensitivities of the nominal prediction: to where it begins, to the nominal parameters, to the candidates.

use super::Columns;
use super::signals::{Kept, difference, peak, scaled};
use crate::library::{Candidate, Nuisance, apply};
use crate::record::{Record, Signal};
use crate::simulate::{Begin, Physics, Prediction, Push, Variant, predict_each};

/// Places of the beginning that are unknown, and their standard deviations.
const STATE_SIGMA: [f64; 10] = [0.02, 2e-4, 0.1, 0.1, 3.0, 3.0, 3.0, 1e-2, 1e-2, 1.0];
/// Place of the slow section, and what tolerances leave open of its lead over its lag.
const SLOW_SECTION: usize = 3;
const SLOW_UNKNOWN: f64 = 0.05;
/// Steps in which sensitivities to the beginning are taken, over those: inside the friction's clamp, off the stops.
pub(crate) const STATE_STEP: f64 = 1e-3;

/// Time for which the platform remembers where it began [s].
const MEMORY_S: f64 = 25.0;

/// What sensitivities are made from.
pub(crate) struct Draft<'a> {
    pub(crate) record: &'a Record,
    pub(crate) base: &'a Physics,
    pub(crate) begin: &'a Begin,
    pub(crate) nominal: &'a Prediction,
    pub(crate) over_noise: &'a [f64],
}

impl Draft<'_> {
    /// Columns of the beginning, of the nominal parameters and of the candidates, with their priors.
    pub(crate) fn columns(&self, nuisances: &[Nuisance], candidates: &[Candidate]) -> (Columns, Vec<Kept>, Vec<f64>) {
        let mut columns = Columns { begin: 0, nuisances: nuisances.len(), first: Vec::new() };
        let mut sigma = Vec::new();
        let states = self.states();
        columns.begin = states.len();
        let mut variants: Vec<(Variant, f64)> = states.iter().map(|&state| self.begun(state)).collect();
        sigma.extend(states.iter().map(|&state| self.state_sigma(state)));
        variants.extend(nuisances.iter().map(|nuisance| {
            let mut physics = self.base.clone();
            nuisance.shift(&mut physics, nuisance.step);
            (self.variant(physics), nuisance.step)
        }));
        sigma.extend(nuisances.iter().map(|nuisance| nuisance.sigma));
        for candidate in candidates {
            columns.first.push(variants.len());
            sigma.extend(candidate.prior.iter().take(candidate.probes.len()).map(|(_, sigma)| *sigma));
            variants.extend(self.probes(candidate));
        }
        let all = self.differences(variants);
        (columns, all, sigma)
    }

    /// Places of the state that show.
    fn states(&self) -> Vec<usize> {
        (0..10).filter(|&state| state != 9 || self.record.channel(Signal::GimbalAngle).is_some()).collect()
    }

    /// What each place of the state does that is off by its standard deviation at some rows.
    pub(crate) fn pushed(&self, rows: &[usize]) -> Vec<Kept> {
        let pushed = |state: usize| {
            let mut by = [0.0; 10];
            by[state] = STATE_STEP * self.state_sigma(state);
            Variant { pushed: Some(Push { rows, by }), ..self.variant(self.base.clone()) }
        };
        self.differences(self.states().into_iter().map(|state| (pushed(state), STATE_STEP)).collect())
    }

    /// How far a place of the beginning may be from where the log seems to begin. The slow section remembers what
    /// the integrator took in, a step of the torque over its time constant, and shows the part of it that lead and
    /// lag do not cancel.
    fn state_sigma(&self, state: usize) -> f64 {
        if state != SLOW_SECTION {
            return STATE_SIGMA[state];
        }
        let servo = &self.base.config.servo;
        let (lead_s, lag_s) = (servo.lead_time_constants_s[0], servo.lag_time_constants_s[0]);
        2.0 * ((1.0 - lead_s / lag_s).abs() + SLOW_UNKNOWN) * peak(&self.nominal.motor_torque_nm) / lag_s
    }

    /// Begun elsewhere, and by how much.
    fn begun(&self, state: usize) -> (Variant<'static>, f64) {
        let step = STATE_STEP * self.state_sigma(state);
        let mut variant = self.variant(self.base.clone());
        variant.begin.state[state] += step;
        // it dies away
        if state != 9 {
            variant.rows = remembered_rows(self.record);
        }
        (variant, step)
    }

    /// A platform that begins there.
    pub(super) fn variant(&self, physics: Physics) -> Variant<'static> {
        Variant { physics, begin: self.begin.clone(), rate_radps: None, pushed: None, rows: usize::MAX }
    }

    /// A candidate's probes, and what their differences are divided by.
    pub(crate) fn probes(&self, candidate: &Candidate) -> Vec<(Variant<'static>, f64)> {
        let one = |(values, divisor): &(Vec<f64>, f64)| {
            let mut physics = self.base.clone();
            apply(candidate.effect, values, &mut physics);
            (self.variant(physics), *divisor)
        };
        candidate.probes.iter().map(one).collect()
    }

    /// What variants change, over their steps and the noise.
    pub(crate) fn differences(&self, variants: Vec<(Variant, f64)>) -> Vec<Kept> {
        let (variants, steps): (Vec<Variant>, Vec<f64>) = variants.into_iter().unzip();
        predict_each(&variants, &self.record.inputs, |index, moved| {
            Kept::new(&scaled(difference(self.record, &moved, self.nominal, steps[index]), self.over_noise))
        })
    }
}

/// Rows for which a prediction remembers where it began.
pub(crate) fn remembered_rows(record: &Record) -> usize {
    record.inputs.rows_of(MEMORY_S)
}
