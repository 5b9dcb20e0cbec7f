//! One log of a corpus.

use super::chosen::choose;
use super::drift::Drift;
use super::logged::{columns, measured, signals};
use super::setting::setting;
use super::text;
use super::{Answer, Case, Kind, Recipe, log_name};
use crate::draw::Draw;
use crate::excitation::PERIOD_S;

/// Integration steps between the rows of a log that is handed out: 20 kHz.
pub(crate) const FINE_STEPS: usize = 20;
/// Draws and runs one log.
pub(super) fn make(recipe: &Recipe, kind: Kind, index: usize) -> Case {
    let mut draw = Draw::new(&recipe.seed, index as u64 + 1);
    let (setting, world, drift, effects) = loop {
        let setting = setting(recipe, &mut draw);
        let drift_draw = draw.fork();
        let bench_of = |shifted: &[&str]| {
            let drift = Drift::draw(&mut drift_draw.clone(), shifted);
            (drift.world(&setting.nominal), drift)
        };
        if kind == Kind::Nothing {
            let (world, drift) = bench_of(&[]);
            break (setting, world, drift, Vec::new());
        }
        if let Some((world, drift, answers)) = choose(kind, &setting, &bench_of, recipe.multiples, &mut draw) {
            break (setting, world, drift, answers);
        }
    };
    let world = &world;
    let (shaken, beside) = setting.scene.shaken(&world.truth, &setting.noise, &mut draw);
    let samples = setting.scene.run(&shaken, &setting.scene.track, FINE_STEPS);
    let logged = setting.noise.on_inputs(&world.sensors.logged(&setting.scene.track), &mut draw);
    let outputs = measured(&setting, world, &samples, beside, &mut draw);
    let signals = signals(&setting, world, &logged, &outputs, &mut draw);
    let csv = text::csv(&columns(&setting, world, &logged, outputs, &samples, &mut draw));
    let answer = Answer {
        log: log_name(index),
        kind,
        excitation: setting.excitation,
        length_s: setting.scene.rows() as f64 * PERIOD_S,
        mid_run: setting.start_s > 0.0,
        preset: setting.preset.to_owned(),
        columns: setting.columns.names(),
        noise: setting.noise,
        drift,
        effects,
        signals,
    };
    Case { csv, model: text::model(setting.preset, &setting.nominal), answer }
}
