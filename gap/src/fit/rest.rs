//! A first residual to take the noise from: nominal parameters and the few effects that take most away, fitted with
//! white noise. More columns would fit the noise too.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::Columns;
use super::normal::{drive, gram, slices, solve};
use super::signals::{Kept, Signals};

/// Every so many rows are fitted.
const THIN: usize = 6;
/// Most effects.
const EFFECTS: usize = 4;
/// Evidence that one more must bring [nats].
const WORTH: f64 = 12.0;
/// How far nominal parameters may go here, over their standard deviations.
const WIDE: f64 = 3.0;

/// Sensitivities that are not whitened yet.
pub(crate) struct Raw<'a> {
    pub(crate) columns: &'a [Kept],
    pub(crate) layout: &'a Columns,
    /// Prior standard deviations of the columns.
    pub(crate) sigma: &'a [f64],
    /// Rows that count.
    pub(crate) valid: &'a [bool],
}

/// The residual of that fit.
pub(crate) fn rest(raw: &Raw, target: &Signals) -> Signals {
    let picks: Vec<usize> = (0..raw.valid.len()).step_by(THIN).filter(|&k| raw.valid[k]).collect();
    let thin = |column: &Kept| -> Vec<f32> {
        column.channels().iter().flat_map(|signal| picks.iter().map(|&k| signal[k])).collect()
    };
    let thinned: Vec<Vec<f32>> = raw.columns.par_iter().map(thin).collect();
    let right: Vec<f64> = target.iter().flat_map(|signal| picks.iter().map(|&k| signal[k])).collect();
    let columns = slices(&thinned);
    let gram = gram(&columns, 0..right.len());
    let drive = drive(&columns, &right);
    let (chosen, coefficients) = greedy(raw, &gram, &drive);
    let channel = |index: usize| -> Vec<f64> {
        let mut rest = target[index].clone();
        for (&column, coefficient) in chosen.iter().zip(&coefficients) {
            for (rest, value) in rest.iter_mut().zip(&raw.columns[column].channels()[index]) {
                *rest -= coefficient * f64::from(*value);
            }
        }
        rest
    };
    (0..target.len()).into_par_iter().map(channel).collect()
}

/// Columns of the best effects, one after the other, and the fit of all of them.
fn greedy(raw: &Raw, gram: &DMatrix<f64>, drive: &DVector<f64>) -> (Vec<usize>, Vec<f64>) {
    let fixed = raw.layout.begin + raw.layout.nuisances;
    let precision = |chosen: &[usize]| -> Vec<f64> {
        let wide = |column: usize| if (raw.layout.begin..fixed).contains(&column) { WIDE } else { 1.0 };
        chosen.iter().map(|&column| (wide(column) * raw.sigma[column]).powi(-2)).collect()
    };
    let fit = |chosen: &[usize]| solve(gram, drive, chosen, &precision(chosen));
    let mut chosen: Vec<usize> = (0..fixed).collect();
    let mut best = fit(&chosen);
    for _ in 0..EFFECTS {
        let wider = |candidate: usize| {
            let mut wider = chosen.clone();
            wider.extend(raw.layout.probes(candidate, raw.columns.len()).filter(|column| !chosen.contains(column)));
            let found = fit(&wider).filter(|_| wider.len() > chosen.len())?;
            Some((wider, found))
        };
        let next = (0..raw.layout.first.len())
            .into_par_iter()
            .filter_map(wider)
            .max_by(|a, b| a.1.evidence.total_cmp(&b.1.evidence));
        let Some((wider, found)) = next else { break };
        if best.as_ref().is_some_and(|best| found.evidence < best.evidence + WORTH) {
            break;
        }
        (chosen, best) = (wider, Some(found));
    }
    let coefficients = best.map_or_else(|| vec![0.0; chosen.len()], |found| found.coefficients.as_slice().to_vec());
    (chosen, coefficients)
}
