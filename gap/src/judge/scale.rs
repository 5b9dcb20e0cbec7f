//! The common scale of all torques: nothing in a log tells it from the units of the torque sensor.
//!
//! ```text
//! every torque, inertia and gain times (1 + e), the torque sensor's scale over (1 + e): the same log
//! ```
//!
//! Sensitivities are differences over steps, and what a ceiling or a stop bends is no line over a step. Where such columns
//! are large, they seem to tell the scale, though nothing does; so what they say along it is taken out.

use gimbal_plant::Effect;
use nalgebra::{DMatrix, DVector};

use crate::fit::{Fit, Hypothesis, Problem};
use crate::record::Signal;
use crate::simulate::TORQUES;

/// The step along it of all that is fitted, relative.
pub(super) fn common_scale(problem: &Problem, hypothesis: &Hypothesis, fit: &Fit) -> DVector<f64> {
    let mut along = vec![0.0; problem.columns.begin];
    for (place, own) in along.iter_mut().enumerate().filter(|(place, _)| TORQUES.contains(place)) {
        *own = fit.begin.state[place];
    }
    let sensor = problem.record.channel(Signal::MotorTorque).is_some();
    along.extend(problem.nuisances.iter().map(|own| match own.name {
        "unbalance x" => problem.base.config.unbalance.x_kg_m,
        "unbalance y" => problem.base.config.unbalance.y_kg_m,
        "torque_scale" if sensor => -1.0,
        "friction_level" | "bearing viscosity" | "loop_gain" | "gyro_damping" | "angular_momentum"
        | "gimbal_inertia" | "float inertia" => 1.0,
        _ => 0.0,
    }));
    along.extend(hypothesis.free.iter().map(|free| {
        let effect = fit.effects[free.effect];
        let unit = Effect::from_name(effect).map_or("", |entry| entry.parameters()[free.value].unit);
        // what the sensor adds is not the platform's
        let is_torque = unit.starts_with("N m") && effect != "torque_bias";
        if !is_torque {
            0.0
        } else if free.log {
            1.0
        } else {
            fit.values[free.effect][free.value]
        }
    }));
    DVector::from_vec(along)
}

/// Normal equations that say nothing along a direction; what they say elsewhere stays, as priors of these weights divide
/// the one from the other.
///
/// ```text
/// Q' G Q        Q = 1 - v w' / (w' v), w = P v
/// ```
pub(super) fn silent_along(gram: &DMatrix<f64>, along: &DVector<f64>, weights: &[f64]) -> DMatrix<f64> {
    let across = DVector::from_iterator(along.len(), along.iter().zip(weights).map(|(own, weight)| own * weight));
    let norm = across.dot(along);
    let seen = gram * along;
    gram - (&seen * across.transpose() + &across * seen.transpose()) / norm
        + &across * across.transpose() * (along.dot(&seen) / (norm * norm))
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::silent_along;

    #[test]
    fn closed_form_what_is_said_along_a_direction_is_taken_out_and_nothing_else() {
        let (along, weights) = (DVector::from_vec(vec![1.0, 1.0, -2.0]), [1.0, 4.0, 0.5]);
        let root = DMatrix::from_row_slice(2, 3, &[1.0, 2.0, 3.0, -1.0, 0.5, 2.0]);
        let gram = root.transpose() * &root;
        let silent = silent_along(&gram, &along, &weights);
        assert!((&silent * &along).norm() < 1e-12);
        // across it, as the weights have it, nothing changes
        let across = DVector::from_vec(vec![4.0, -1.0, 0.0]);
        assert!((&silent * &across - &gram * &across).dot(&across).abs() < 1e-12);
        // and equations that said nothing along it stay as they were
        assert!((silent_along(&silent, &along, &weights) - &silent).norm() < 1e-12);
    }
}
