//! How far a correction goes on a log that it was not made from: all logs but one fitted together, and that one
//! predicted.
//!
//! ```text
//! p = the least of sum over the other logs of |r_m - B_m (p - a_m)|^2 + priors        everything shared but how a log begins
//! rms of the log predicted free from its first row under the nominal model, and under p
//! ```

use gimbal_model_file::ModelFile;

use super::climb::Fitted;
use super::joint::{Local, solve};
use super::material::Material;
use super::parameters::Unit;
use crate::fit::raw_residual;
use crate::judge::{Yardstick, in_step};
use crate::library::platform;
use crate::simulate::{Physics, predict};

/// Each log under what the others say.
pub(super) fn unseen(materials: &[Material], fitted: &Fitted, model: &ModelFile) -> Vec<(usize, Vec<Yardstick>)> {
    if materials.len() < 2 || fitted.effects.names.is_empty() {
        return Vec::new();
    }
    let hypotheses = super::climb::hypotheses(materials, &fitted.effects);
    let begins: Vec<bool> = fitted.parameters.iter().map(|own| own.unit == Unit::Beginning).collect();
    let of = |log: usize| {
        let others = fitted.locals.iter().enumerate().filter(|(other, _)| *other != log);
        let others: Vec<Local> = others.map(|(_, local)| local.clone()).collect();
        let joint = solve(&others, &fitted.parameters, &begins)?;
        let begin = others[0].begin.len();
        let mut x = fitted.locals[log].at.clone();
        for place in (0..begins.len()).filter(|&place| !begins[place]) {
            x[fitted.locals[log].begin.len() + place] = joint.x[0][begin + place];
        }
        let mut corrected = hypotheses[log].physics(&super::climb::placed(&hypotheses[log], &fitted.points[log], &x));
        let record = materials[log].problem.record;
        let mut nominal = platform(model);
        nominal.config.period_s = record.inputs.period_s;
        // the stop of a log is that log's own reading
        corrected.config.gyro.stop_angle_rad = nominal.config.gyro.stop_angle_rad;
        let rms = |physics: &Physics| {
            let begin = record.begin(physics, &record.inputs);
            in_step(record, &raw_residual(record, &predict(physics, &record.inputs, &begin, usize::MAX)))
        };
        Some((materials[log].log, Yardstick::of_channels(record, &rms(&nominal), &rms(&corrected))))
    };
    (0..materials.len()).filter_map(of).collect()
}
