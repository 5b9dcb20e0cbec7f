//! Sensitivities of the nominal prediction: to where it begins, to the nominal parameters, to the candidates.

use rayon::prelude::*;

use super::Columns;
use super::signals::{Signals, difference, peak};
use crate::library::{Candidate, Nuisance, apply};
use crate::record::{Record, Signal};
use crate::simulate::{Begin, Physics, Prediction, predict};

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
}

impl Draft<'_> {
    /// Columns of the beginning, of the nominal parameters and of the candidates, with their priors.
    pub(crate) fn columns(
        &self,
        nuisances: &[Nuisance],
        candidates: &[Candidate],
    ) -> (Columns, Vec<Signals>, Vec<f64>) {
        let mut columns = Columns { begin: 0, nuisances: nuisances.len(), first: Vec::new() };
        let mut sigma = Vec::new();
        let states: Vec<usize> =
            (0..10).filter(|&state| state != 9 || self.record.channel(Signal::GimbalAngle).is_some()).collect();
        columns.begin = states.len();
        let mut all: Vec<Signals> = states.par_iter().map(|&state| self.begin_column(state)).collect();
        sigma.extend(states.iter().map(|&state| self.state_sigma(state)));
        all.par_extend(nuisances.par_iter().map(|nuisance| {
            let mut physics = self.base.clone();
            nuisance.shift(&mut physics, nuisance.step);
            self.difference(&physics, nuisance.step)
        }));
        sigma.extend(nuisances.iter().map(|nuisance| nuisance.sigma));
        let probes: Vec<Vec<Signals>> = candidates.par_iter().map(|candidate| self.probes(candidate)).collect();
        for (candidate, probes) in candidates.iter().zip(probes) {
            columns.first.push(all.len());
            sigma.extend(candidate.prior.iter().take(probes.len()).map(|(_, sigma)| *sigma));
            all.extend(probes);
        }
        (columns, all, sigma)
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

    fn begin_column(&self, state: usize) -> Signals {
        let step = STATE_STEP * self.state_sigma(state);
        let mut begin = self.begin.clone();
        begin.state[state] += step;
        // it dies away
        let rows = if state == 9 { usize::MAX } else { remembered_rows(self.record) };
        let moved = predict(self.base, &self.record.inputs, &begin, rows);
        difference(self.record, &moved, self.nominal, step)
    }

    fn difference(&self, physics: &Physics, step: f64) -> Signals {
        let moved = predict(physics, &self.record.inputs, self.begin, usize::MAX);
        difference(self.record, &moved, self.nominal, step)
    }

    /// Columns of a candidate.
    pub(crate) fn probes(&self, candidate: &Candidate) -> Vec<Signals> {
        candidate
            .probes
            .iter()
            .map(|(values, divisor)| {
                let mut physics = self.base.clone();
                apply(candidate.effect, values, &mut physics);
                self.difference(&physics, *divisor)
            })
            .collect()
    }
}

/// Rows for which a prediction remembers where it began.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "rows")]
pub(crate) fn remembered_rows(record: &Record) -> usize {
    (MEMORY_S / record.inputs.period_s) as usize
}
