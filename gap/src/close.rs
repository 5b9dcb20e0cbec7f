//! The corrected model: what was found, in a model file.
//!
//! An effect that changes a nominal parameter becomes that parameter's value; the others stand under `[effects]`. The
//! nominal parameters that were fitted along with them have their fitted values, each with a remark: effects and
//! parameters were fitted together, and fit the log together.

use gimbal_model_file::{ModelEffect, ModelFile, effects, write_model};
use gimbal_plant::Effect;
use gimbal_servo::Config;

use crate::diagnose::Diagnosis;
use crate::fit::Fit;
use crate::judge::{Decision, Found, Verdict};

/// The text of the corrected model file.
///
/// # Errors
/// Why there is nothing to correct.
pub fn corrected(diagnosis: &Diagnosis, model: &ModelFile) -> Result<String, String> {
    let (Some(decision), Some(fit)) = (&diagnosis.decision, &diagnosis.fit) else {
        return Err("the data do not serve".to_owned());
    };
    if diagnosis.verdict() == Verdict::NoGap || decision.found.is_empty() {
        return Err(match diagnosis.verdict() {
            Verdict::NoGap => "there is no gap to close".to_owned(),
            _ => "no effect was found that would close the gap".to_owned(),
        });
    }
    let (config, all) = closing(decision, fit, model);
    let before = gimbal_model_file::write(model.preset, &model.config, &model.tolerance);
    let nominal: Vec<(&str, &str, &str)> = entries(&before).collect();
    let plain = gimbal_model_file::write(model.preset, &config, &model.tolerance);
    let remark = |table: &str, key: &str| remark(table, key, &nominal, &plain, &decision.found);
    Ok(write_model(model.preset, &config, &model.tolerance, &all, &model.known_good, remark))
}

/// Parameters and effects of the model with what was found in it.
pub(crate) fn closing(decision: &Decision, fit: &Fit, model: &ModelFile) -> (Config, Vec<ModelEffect>) {
    let mut config = fitted(fit, model);
    let mut all = model.effects.clone();
    for found in &decision.found {
        let Some(effect) = Effect::from_name(found.effect) else { continue };
        let in_fit = fit.effects.contains(&found.effect);
        // a released parameter is among the fitted ones already
        let mut unused = config;
        if effects::fold(effect, &found.values, if in_fit { &mut unused } else { &mut config }) {
            continue;
        }
        add(&mut all, effect, found);
    }
    (config, all)
}

/// The nominal parameters as fitted.
fn fitted(fit: &Fit, model: &ModelFile) -> Config {
    let physics = &fit.physics;
    let mut config = Config {
        range: model.config.range,
        period_s: model.config.period_s,
        interpolation: model.config.interpolation,
        ..physics.config
    };
    config.bearing.load_torque_nm_per_n *= physics.friction.load_factor;
    config.bearing.lubrication_factor *= physics.friction.viscous_factor;
    // set by what the log reached, not fitted
    config.gyro.stop_angle_rad = model.config.gyro.stop_angle_rad;
    config
}

/// Adds an effect to those of the model: sizes add up, factors multiply.
fn add(all: &mut Vec<ModelEffect>, effect: Effect, found: &Found) {
    let Some(known) = all.iter_mut().find(|known| known.effect == effect) else {
        // the file and the plant know one formulation of each
        let values = found.values.iter().copied().take(effect.parameters().len()).collect();
        all.push(ModelEffect { effect, values });
        return;
    };
    for (known, value) in known.values.iter_mut().zip(&found.values).take(effect.sizes()) {
        *known = if effect.name().ends_with("_scale") { (1.0 + *known) * (1.0 + value) - 1.0 } else { *known + value };
    }
}

/// Table, key and value of every line of a model file.
fn entries(text: &str) -> impl Iterator<Item = (&str, &str, &str)> {
    let mut table = "";
    text.lines().filter_map(move |line| {
        if let Some(name) = line.strip_prefix('[').and_then(|line| line.strip_suffix(']')) {
            table = name;
        }
        let (key, value) = line.split('#').next()?.split_once(" = ")?;
        Some((table, key.trim(), value.trim()))
    })
}

/// What a value was, or how well it is known.
fn remark(table: &str, key: &str, before: &[(&str, &str, &str)], now: &str, found: &[Found]) -> Option<String> {
    if let Some(name) = table.strip_prefix("effects.") {
        let own = found.iter().find(|own| own.effect == name)?;
        let place = Effect::from_name(name)?.parameters().iter().position(|parameter| parameter.name == key)?;
        return Some(format!("found in the log, +- {:.1e}", own.errors.get(place)?));
    }
    let (_, _, old) = before.iter().find(|entry| entry.0 == table && entry.1 == key)?;
    let (_, _, new) = entries(now).find(|entry| entry.0 == table && entry.1 == key)?;
    (*old != new).then(|| format!("fitted to the log; was {old}"))
}
