//! One log of a corpus.

use gimbal_servo::Config;

use super::drift::Drift;
use super::sizing::{Bench, STEPS};
use super::text::{self, Column};
use super::{Answer, AnswerEffect, Case, Kind, Recipe, SignalGap, log_name};
use crate::detect::{DETECTABLE, UNSCORED_S};
use crate::draw::Draw;
use crate::effects::{BEYOND, Effect, World, library_names};
use crate::excitation::{Excitation, PERIOD_S};
use crate::machine::Sample;
use crate::scene::{CHANNELS, Outputs, Scene};
use crate::sensors::{Noise, pickoff_rounded, rounded, torque_rounded};
use crate::track::Track;

/// Integration steps between the rows of a log that is handed out: 20 kHz.
pub(crate) const FINE_STEPS: usize = 20;
/// How often effects are drawn for one log before it is drawn anew.
const TRIES: usize = 40;

/// Which columns a log has beside the needed ones.
#[derive(Debug, Clone, Copy)]
#[allow(clippy::struct_excessive_bools)] // one for each column of the contract
struct Columns {
    torque: bool,
    gimbal: bool,
    relative: bool,
    cross: bool,
    temperature: bool,
}

impl Columns {
    fn draw(excitation: Excitation, draw: &mut Draw) -> Self {
        let (torque, gimbal, relative) = (draw.chance(0.85), draw.chance(0.5), draw.chance(0.5));
        Self {
            torque,
            gimbal: gimbal && excitation.in_laboratory(),
            relative,
            cross: draw.chance(0.7),
            temperature: draw.chance(0.4),
        }
    }

    fn names(self) -> Vec<String> {
        [
            (self.torque, "motor_torque_nm"),
            (self.gimbal, "gimbal_angle_rad"),
            (self.relative, "relative_angle_rad"),
            (self.cross, "cross_rate_radps"),
            (self.temperature, "temperature_c"),
        ]
        .into_iter()
        .filter(|(there, _)| *there)
        .map(|(_, name)| name.to_owned())
        .collect()
    }

    /// Places in [`CHANNELS`].
    fn channels(self) -> Vec<usize> {
        [true, self.torque, self.gimbal]
            .iter()
            .enumerate()
            .filter(|(_, there)| **there)
            .map(|(place, _)| place)
            .collect()
    }
}

/// What a log is made of before effects.
struct Setting {
    excitation: Excitation,
    preset: &'static str,
    nominal: Config,
    scene: Scene,
    columns: Columns,
    noise: Noise,
    start_s: f64,
}

fn nominal(draw: &mut Draw) -> (&'static str, Config) {
    let (preset, mut config) =
        if draw.chance(0.1) { ("as-printed", Config::as_printed()) } else { ("consistent", Config::consistent()) };
    if draw.chance(0.3) {
        // another tuning of the same loop
        config.servo.gain_nm_per_rad_s *= 0.8;
    }
    if draw.chance(0.3) {
        let u = config.unbalance.x_kg_m;
        (config.unbalance.x_kg_m, config.unbalance.y_kg_m) = (draw.uniform(-1.0, 1.0) * u, draw.uniform(-1.0, 1.0) * u);
    }
    (preset, config)
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // seconds and rows of one log
fn setting(recipe: &Recipe, draw: &mut Draw) -> Setting {
    let place = draw.unit();
    // five rich kinds with 16 % each, quiet and sway with 10 % each
    let excitation = if place < 0.8 {
        Excitation::ALL[((place / 0.16) as usize).min(4)]
    } else if place < 0.9 {
        Excitation::Quiet
    } else {
        Excitation::Sway
    };
    let (preset, nominal) = nominal(draw);
    let rows = (libm::round(draw.uniform(recipe.length_s.0, recipe.length_s.1)) / PERIOD_S) as usize;
    let mid_run = draw.chance(0.5);
    let before = if mid_run { (draw.uniform(0.5, 3.0) / PERIOD_S) as usize } else { 0 };
    let start_s = if mid_run { libm::floor(draw.log_uniform(5.0, 900.0)) + before as f64 * PERIOD_S } else { 0.0 };
    let track = excitation.track(rows + before, recipe.rocket.as_ref(), draw);
    let columns = Columns::draw(excitation, draw);
    let noise = Noise::draw(draw);
    Setting { excitation, preset, nominal, scene: Scene { track, before }, columns, noise, start_s }
}

fn names_for(kind: Kind, columns: Columns) -> Vec<&'static str> {
    if kind == Kind::Beyond {
        return BEYOND.to_vec();
    }
    // without the rate about x nobody can see what it does
    library_names().filter(|name| columns.cross || *name != "cross_axis_coupling").collect()
}

fn choose(
    kind: Kind,
    setting: &Setting,
    bench_of: &dyn Fn(&[&str]) -> (World, Drift),
    multiples: (f64, f64),
    draw: &mut Draw,
) -> Option<(World, Drift, Vec<AnswerEffect>)> {
    let names = names_for(kind, setting.columns);
    for _ in 0..TRIES {
        let mut drawn: Vec<&'static str> = Vec::new();
        while drawn.len() < kind.effects() {
            let name = draw.pick(&names);
            if !drawn.contains(&name) {
                drawn.push(name);
            }
        }
        let (base, drift) = bench_of(&drawn);
        let bench = Bench::new(
            &setting.scene,
            &base,
            &setting.nominal,
            &drift,
            &setting.noise,
            &setting.columns.channels(),
            &mut draw.fork(),
        );
        if let Some((world, answers)) = size_all(&bench, &drawn, multiples, draw) {
            return Some((world, drift, answers));
        }
    }
    None
}

fn size_all(
    bench: &Bench<'_>,
    drawn: &[&'static str],
    multiples: (f64, f64),
    draw: &mut Draw,
) -> Option<(World, Vec<AnswerEffect>)> {
    let projection = bench.projection();
    let mut world = bench.base.clone();
    let mut effects = Vec::new();
    for name in drawn {
        let effect = Effect::draw(name, draw);
        let detectable = bench.detectable_size(&effect, &projection)?;
        let range = effect.range();
        let most = (range.largest / detectable).min(multiples.1);
        if most < 1.05 * multiples.0 {
            return None;
        }
        let size = (detectable * draw.log_uniform(multiples.0, most)).max(range.small);
        effect.apply(size, &bench.scale, &mut world);
        effects.push((effect, size, detectable));
    }
    if !bench.works(&world) {
        return None;
    }
    let answers = answers(bench, &effects, &world);
    Some((world, answers))
}

fn answers(bench: &Bench<'_>, effects: &[(Effect, f64, f64)], world: &World) -> Vec<AnswerEffect> {
    if effects.is_empty() {
        return Vec::new();
    }
    let projection = bench.projection();
    let alone: Vec<Vec<f64>> = effects.iter().map(|(effect, size, _)| bench.change(effect, *size)).collect();
    // what cannot be seen has no need of what it could be taken for
    let faint = effects.len() == 1 && projection.left_of(&alone[0]) < DETECTABLE;
    let tangents = if faint { Vec::new() } else { bench.tangents() };
    effects
        .iter()
        .enumerate()
        .map(|(place, (effect, size, detectable))| {
            let others = || alone.iter().enumerate().filter(|(index, _)| *index != place);
            let marginal = if effects.len() == 1 {
                alone[place].clone()
            } else {
                let mut without = bench.base.clone();
                for (index, (other, other_size, _)) in effects.iter().enumerate() {
                    let size = if index == place { Bench::no_gap(effect, *size) } else { *other_size };
                    if size > 0.0 {
                        other.apply(size, &bench.scale, &mut without);
                    }
                }
                bench.between(world, &without)
            };
            let beside: Vec<&[f64]> = others().map(|(_, column)| &column[..]).collect();
            let among: Vec<&(&str, Vec<f64>)> = tangents.iter().filter(|(name, _)| *name != effect.name).collect();
            // below the detectable size nothing can be told from anything
            let seen = projection.left_with(&marginal, &beside) >= DETECTABLE;
            let equivalents = among
                .iter()
                .filter(|(_, column)| {
                    if !seen {
                        return false;
                    }
                    let mut free = beside.clone();
                    free.push(column);
                    projection.left_with(&marginal, &free) < DETECTABLE
                })
                .map(|(name, _)| (*name).to_owned())
                .collect();
            let mut all: Vec<&[f64]> = among.iter().map(|(_, column)| &column[..]).collect();
            all.extend(&beside);
            let by_power = bench.by_power(effect, *size);
            let of = |d: f64| by_power.unwrap_or(d);
            AnswerEffect {
                name: effect.name.to_owned(),
                block: crate::effects::block_of(effect.name).to_owned(),
                parameters: effect.parameters(*size, &bench.scale),
                size: *size,
                detectable_size: *detectable,
                multiple: size / detectable,
                d: of(projection.left_of(&alone[place])),
                d_beside_others: of(projection.left_with(&marginal, &beside)),
                d_beyond_library: of(projection.left_with(&marginal, &all)),
                equivalents,
            }
        })
        .collect()
}

/// The logged channels: outputs with noise and least counts.
fn measured(setting: &Setting, world: &World, samples: &[Sample], draw: &mut Draw) -> Outputs {
    let rows = samples.len();
    let mut series = |white: f64| setting.noise.series(white, rows, PERIOD_S, draw);
    let noise = [
        series(setting.noise.gyro_angle_rad),
        series(setting.noise.motor_torque_nm),
        series(setting.noise.gimbal_angle_rad),
    ];
    let mut outputs = Scene::outputs(world, samples);
    for (channel, noise) in outputs.iter_mut().zip(&noise) {
        for (value, noise) in channel.iter_mut().zip(noise) {
            *value += noise;
        }
    }
    let [gyro, torque, gimbal] = &mut outputs;
    for value in gyro {
        *value = pickoff_rounded(&world.sensors, *value);
    }
    for value in torque {
        *value = torque_rounded(*value);
    }
    for value in gimbal {
        *value = rounded(*value, 1e-7);
    }
    outputs
}

fn columns(
    setting: &Setting,
    world: &World,
    logged: &Track,
    outputs: Outputs,
    samples: &[Sample],
    draw: &mut Draw,
) -> Vec<Column> {
    let rows = &logged.rows[setting.scene.before..];
    let [gyro, torque, gimbal] = outputs;
    let time = (0..rows.len()).map(|index| setting.start_s + index as f64 * PERIOD_S).collect();
    let of = |value: &dyn Fn(&crate::track::Row) -> f64| rows.iter().map(value).collect::<Vec<f64>>();
    let gyro_digits = if world.sensors.pickoff_step_rad.is_some() { 10 } else { 8 };
    let relative =
        samples.iter().map(|s| s.relative_angle_rad + setting.noise.relative_angle_rad * draw.normal()).collect();
    let all = [
        (true, "time_s", 3, time),
        (true, "accel_x_mps2", 4, of(&|row| row.accel_mps2[0])),
        (true, "accel_y_mps2", 4, of(&|row| row.accel_mps2[1])),
        (true, "accel_z_mps2", 4, of(&|row| row.accel_mps2[2])),
        (true, "vehicle_rate_radps", 6, of(&|row| row.rate_radps)),
        (true, "gyro_angle_rad", gyro_digits, gyro),
        (setting.columns.torque, "motor_torque_nm", 7, torque),
        (setting.columns.gimbal, "gimbal_angle_rad", 7, gimbal),
        (setting.columns.relative, "relative_angle_rad", 6, relative),
        (setting.columns.cross, "cross_rate_radps", 6, of(&|row| row.cross_rate_radps)),
        (setting.columns.temperature, "temperature_c", 4, of(&|row| row.temperature_c)),
    ];
    all.into_iter()
        .filter(|(there, ..)| *there)
        .map(|(_, name, digits, values)| Column { name, digits, values })
        .collect()
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a thousand rows
fn rms(a: &[f64], b: &[f64]) -> f64 {
    let skip = (UNSCORED_S / PERIOD_S) as usize;
    let pairs = a.iter().zip(b).skip(skip);
    let count = a.len().saturating_sub(skip).max(1);
    (pairs.map(|(x, y)| (x - y) * (x - y)).sum::<f64>() / count as f64).sqrt()
}

/// Residuals of the nominal and of the true model, both driven by logged inputs.
fn signals(setting: &Setting, world: &World, logged: &Track, outputs: &Outputs, draw: &mut Draw) -> Vec<SignalGap> {
    let nominal =
        Drift { relative: std::collections::BTreeMap::new(), misalignment_rad: [0.0; 3] }.world(&setting.nominal);
    let scene = &setting.scene;
    let before = Scene::outputs(&nominal, &scene.run(&nominal.truth, logged, STEPS));
    // the true model knows skew and turns, and has the noise of the logged inputs
    let own = setting.noise.on_inputs(&scene.track, draw);
    let best = Scene::outputs(world, &scene.run(&world.truth, &own, STEPS));
    setting
        .columns
        .channels()
        .into_iter()
        .map(|channel| SignalGap {
            name: CHANNELS[channel].to_owned(),
            before: rms(&before[channel], &outputs[channel]),
            best: rms(&best[channel], &outputs[channel]),
        })
        .collect()
}

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
    let samples = setting.scene.run(&world.truth, &setting.scene.track, FINE_STEPS);
    let logged = setting.noise.on_inputs(&world.sensors.logged(&setting.scene.track), &mut draw);
    let outputs = measured(&setting, world, &samples, &mut draw);
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
