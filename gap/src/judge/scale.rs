//! Scales that nothing in a log tells: that of all torques, and that of the float's angle.
//!
//! ```text
//! every torque, inertia and gain times (1 + e), the torque sensor's scale over (1 + e)                     the same log
//! theta over (1 + e), H, gain and the pick-off's scale times (1 + e), Jo and Bo times (1 + e)^2            the same log
//! ```
//!
//! Sensitivities are differences over steps, and what a ceiling or a stop bends is no line over a step. Where such columns
//! are large, they seem to tell the scales, though nothing does; so what they say along them is taken out.

use gimbal_plant::{Block, Effect};
use nalgebra::{DMatrix, DVector};

use crate::fit::{Fit, Hypothesis, Problem};
use crate::record::Signal;
use crate::simulate::{ANGLES, Physics, TORQUES};

/// A scale: what all that is fitted changes by along it, relative.
struct Scale {
    state: fn(usize) -> f64,
    nominal: fn(&str) -> f64,
    torque: fn(Block) -> f64,
}

const SCALES: [Scale; 2] = [
    Scale {
        state: |place| if TORQUES.contains(&place) { 1.0 } else { 0.0 },
        nominal: |name| match name {
            "friction_level" | "bearing viscosity" | "unbalance x" | "unbalance y" | "loop_gain" | "gyro_damping"
            | "angular_momentum" | "gimbal_inertia" | "float inertia" => 1.0,
            "torque_scale" => -1.0,
            _ => 0.0,
        },
        torque: |_| 1.0,
    },
    Scale {
        state: |place| if ANGLES.contains(&place) { -1.0 } else { 0.0 },
        nominal: |name| match name {
            "angular_momentum" | "loop_gain" | "pickoff_scale" => 1.0,
            "gyro_damping" | "float inertia" => 2.0,
            _ => 0.0,
        },
        torque: |block| if block == Block::Gyro { 1.0 } else { 0.0 },
    },
];

/// Normal equations that say nothing along the scales; what they say elsewhere stays, as priors of these weights divide the
/// one from the other.
pub(super) fn silent(
    gram: DMatrix<f64>,
    weights: &[f64],
    problem: &Problem,
    hypothesis: &Hypothesis,
    fit: &Fit,
) -> DMatrix<f64> {
    let [torques, angles] = SCALES.map(|scale| along(&scale, problem, hypothesis, fit));
    let weighed =
        |own: &DVector<f64>| own.iter().zip(weights).zip(&torques).map(|((a, weight), b)| a * weight * b).sum::<f64>();
    let angles = &angles - &torques * (weighed(&angles) / weighed(&torques));
    [torques, angles].iter().fold(gram, |gram, along| silent_along(&gram, along, weights))
}

/// The step along a scale of all that is fitted.
fn along(scale: &Scale, problem: &Problem, hypothesis: &Hypothesis, fit: &Fit) -> DVector<f64> {
    let mut along: Vec<f64> =
        (0..problem.columns.begin).map(|place| (scale.state)(place) * fit.begin.state[place]).collect();
    let sensor = problem.record.channel(Signal::MotorTorque).is_some();
    along.extend(problem.nuisances.iter().map(|own| match own.name {
        "torque_scale" if !sensor => 0.0,
        name => (scale.nominal)(name) * unit(name, &problem.base),
    }));
    along.extend(hypothesis.free.iter().map(|free| {
        let effect = fit.effects[free.effect];
        let Some(entry) = Effect::from_name(effect) else { return 0.0 };
        let Some(unit) = entry.parameters().get(free.value).map(|own| own.unit) else { return 0.0 };
        // what a sensor adds is not the platform's
        let is_torque = entry.block() != Block::Measurement && (unit.starts_with("N m") || unit.starts_with("kg m"));
        let own = if free.log { 1.0 } else { fit.values[free.effect][free.value] };
        if is_torque { (scale.torque)(entry.block()) * own } else { 0.0 }
    }));
    DVector::from_vec(along)
}

/// What a relative change of one is, in the units of the shift of a nominal parameter.
fn unit(name: &str, base: &Physics) -> f64 {
    match name {
        "unbalance x" => base.config.unbalance.x_kg_m,
        "unbalance y" => base.config.unbalance.y_kg_m,
        _ => 1.0,
    }
}

/// The same along one direction.
///
/// ```text
/// Q' G Q        Q = 1 - v w' / (w' v), w = P v
/// ```
fn silent_along(gram: &DMatrix<f64>, along: &DVector<f64>, weights: &[f64]) -> DMatrix<f64> {
    let across = DVector::from_iterator(along.len(), along.iter().zip(weights).map(|(own, weight)| own * weight));
    let norm = across.dot(along);
    let seen = gram * along;
    gram - (&seen * across.transpose() + &across * seen.transpose()) / norm
        + &across * across.transpose() * (along.dot(&seen) / (norm * norm))
}

#[cfg(test)]
mod tests {
    use gimbal_model_file::ModelFile;
    use nalgebra::{DMatrix, DVector};

    use super::{SCALES, silent_along, unit};
    use crate::library::{nuisances, platform};
    use crate::simulate::{Begin, Inputs, predict};

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
    #[test]
    fn closed_form_along_a_scale_the_sensors_show_the_same() {
        let wave = |size: f64, hz: f64| -> Vec<f64> {
            (0..4000).map(|k| size * (std::f64::consts::TAU * hz * f64::from(k) * 1e-3).sin()).collect()
        };
        let mut inputs = Inputs {
            period_s: 1e-3,
            accel_mps2: [wave(3.0, 0.7), wave(5.0, 1.1), wave(9.0, 0.4)],
            rate_radps: wave(0.3, 2.3),
            ..Inputs::default()
        };
        let model = ModelFile::default();
        inputs.complete(&model.config.bearing, 0.0);
        let mut base = platform(&model);
        base.float_nm = 1e-6;
        let begin = Begin::at(&base, &inputs, 1e-4, None);
        let nominal = predict(&base, &inputs, &begin, usize::MAX);
        let by: f64 = 0.1;
        for scale in SCALES {
            let (mut physics, mut from) = (base.clone(), begin.clone());
            for own in nuisances(&model.tolerance, &base) {
                own.shift(&mut physics, by * (scale.nominal)(own.name) * unit(own.name, &base));
            }
            physics.float_nm *= (by * (scale.torque)(gimbal_plant::Block::Gyro)).exp();
            for (place, state) in from.state.iter_mut().enumerate() {
                *state *= (by * (scale.state)(place)).exp();
            }
            let scaled = predict(&physics, &inputs, &from, usize::MAX);
            for (a, b) in [
                (&nominal.gyro_angle_rad, &scaled.gyro_angle_rad),
                (&nominal.motor_torque_nm, &scaled.motor_torque_nm),
                (&nominal.gimbal_angle_rad, &scaled.gimbal_angle_rad),
            ] {
                let apart = a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                let size = a.iter().map(|a| a.abs()).fold(0.0, f64::max);
                assert!(apart < 1e-6 * size, "{apart:e} of {size:e}");
            }
        }
    }
}
