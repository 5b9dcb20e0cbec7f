//! A torque T on the gyro's float, as what the sensors take it for: a drift T / H of the vehicle's rate, and a torque on
//! the gimbal.
//!
//! ```text
//! Jo theta'' + Bo theta' = H phi' + T        psi' = phi' + T / H
//! Jg psi'' = T_d(rate + T / H - psi') - T_m + Jg (T / H)'
//! ```

use crate::fit::{Fit, Problem, difference, narrow};
use crate::record::Signal;
use crate::simulate::{Variant, predict_each};

/// Step of a sensitivity, over a drift: inside the friction's clamp nothing else is linear.
const STEP: f64 = 1e-2;

/// What drifts of the float do to the whitened channels at a fit [rad/s].
pub(super) fn columns(problem: &Problem, fit: &Fit, drifts_radps: &[Vec<f64>]) -> Vec<Vec<f32>> {
    let record = problem.record;
    let (inputs, inertia) = (&record.inputs, fit.physics.config.servo.gimbal_inertia_kg_m2);
    let moved = |drift: &Vec<f64>| inputs.rate_radps.iter().zip(drift).map(|(rate, own)| rate + STEP * own).collect();
    let rates: Vec<Vec<f64>> = drifts_radps.iter().map(moved).collect();
    let variant = |rate_radps| Variant {
        physics: fit.physics.clone(),
        begin: fit.begin.clone(),
        rate_radps: Some(rate_radps),
        pushed: None,
        rows: usize::MAX,
    };
    let variants: Vec<Variant> = rates.iter().map(|rates| variant(&rates[..])).collect();
    predict_each(&variants, inputs, |index, prediction| {
        let drift = &drifts_radps[index];
        let mut signals = difference(record, &prediction, &fit.prediction, STEP);
        // phi is psi less what has drifted
        for (signal, _) in signals.iter_mut().zip(&record.channels).filter(|(_, own)| own.signal == Signal::GimbalAngle)
        {
            let mut drifted_rad = 0.0;
            for (value, own) in signal.iter_mut().zip(drift) {
                *value -= drifted_rad;
                drifted_rad += own * inputs.period_s;
            }
        }
        let given: Vec<f64> = changes(drift).iter().map(|rise| inertia / inputs.period_s * rise).collect();
        let mut column = narrow(&problem.whiten(signals));
        column.iter_mut().zip(problem.torque_column(&given)).for_each(|(own, given)| *own += given);
        column
    })
}

/// Change a row: what the gimbal is given in the place of a torque on the float, up to a factor; at the ends nothing.
pub(super) fn changes(of: &[f64]) -> Vec<f64> {
    let mut changes = vec![0.0; of.len()];
    for (change, around) in changes.iter_mut().skip(1).zip(of.windows(3)) {
        *change = 0.5 * (around[2] - around[0]);
    }
    changes
}

/// What a drive of torques on the gimbal is to torques on the float: the other way around, and backwards.
pub(super) fn driven(drive: &[f64]) -> Vec<f64> {
    let mut driven = vec![0.0; drive.len()];
    for (place, own) in drive.iter().enumerate().skip(1).take(drive.len().saturating_sub(2)) {
        driven[place + 1] += 0.5 * own;
        driven[place - 1] -= 0.5 * own;
    }
    driven
}

/// Square of the gain of the first at a frequency, over that of rows.
pub(super) fn gain(cycles_a_row: f64) -> f64 {
    (std::f64::consts::TAU * cycles_a_row).sin().powi(2)
}

#[cfg(test)]
mod tests {
    use super::{changes, driven, gain};

    fn dot(a: &[f64], b: &[f64]) -> f64 {
        a.iter().zip(b).map(|(a, b)| a * b).sum()
    }

    #[test]
    fn a_drive_is_the_adjoint() {
        let torque: Vec<f64> = (0..50).map(|k| f64::from(k * k % 17)).collect();
        let drive: Vec<f64> = (0..50).map(|k| f64::from(k * 7 % 13)).collect();
        assert!((dot(&changes(&torque), &drive) - dot(&torque, &driven(&drive))).abs() < 1e-9);
    }

    #[test]
    fn closed_form_the_gain_of_a_line() {
        let wave: Vec<f64> = (0..4000).map(|k| (0.3 * f64::from(k)).sin()).collect();
        let power = |of: &[f64]| dot(of, of) / of.len() as f64;
        assert!((power(&changes(&wave)) / power(&wave) - gain(0.3 / std::f64::consts::TAU)).abs() < 1e-3);
    }
}
