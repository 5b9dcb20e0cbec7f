//! The gap monitor over hours of swinging flight, and on effects of a given size.

use std::f64::consts::TAU;
use std::thread;

use gimbal_plant::{Effect, Plant, Row, Sample};
use gimbal_servo::{Config, estimator, monitor};

use super::altered;
use crate::axis::{Axis, si};
use crate::estimate::{Noise, read};
use crate::random::Random;

/// A manoeuvre of its own for each set of six numbers in 0..1.
#[must_use]
pub fn swing(k: usize, shape: &[f64; 6]) -> Row {
    let t = k as f64 * 1e-3;
    let [a, b, phase, c, d, e] = *shape;
    Row {
        accel_x_mps2: 20.0 * a * (TAU * 0.31 * t).sin(),
        accel_y_mps2: 60.0 * b * (TAU * (0.11 * t + phase)).sin(),
        accel_z_mps2: 9.8 + 20.0 * c * (TAU * 0.07 * t).cos(),
        vehicle_rate_radps: (0.2 + 2.0 * d) * (TAU * (0.1 + 0.5 * e) * t).sin(),
        ..Row::default()
    }
}

/// The gap monitor's law for the consistent axis.
///
/// # Panics
/// Never: the configuration builds.
#[must_use]
pub fn monitor_law(model_tolerance: f64) -> monitor::Law<f32> {
    let axis = Config::consistent();
    let gyro = estimator::Config::default().build::<f32>(&axis).expect("an estimator that builds").gyro_exponent();
    let config = monitor::Config { model_tolerance, ..monitor::Config::default() };
    config.build(&axis, gyro).expect("a monitor that builds")
}

/// What the monitor made of simulated minutes.
#[derive(Debug, Clone, Copy, Default)]
pub struct Watch {
    /// Minutes in which it raised an alarm.
    pub alarms: u32,
    /// Largest g over its threshold.
    pub largest: f64,
}

/// Watches `minutes` of swinging flight, each with a shape and noise of its own; parameters drift by up to `drift`. The truth is
/// the law itself, fed without noise: the plant would need hours. All processors share the work.
///
/// # Panics
/// If a thread panics.
#[must_use]
pub fn watch(minutes: u32, drift: f64, model_tolerance: f64, seed: u64) -> Watch {
    let law = monitor_law(model_tolerance);
    let mut random = Random::new(seed);
    let seeds: Vec<u64> = (0..minutes).map(|_| random.bits()).collect();
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let watched =
        &|seeds: &[u64]| seeds.iter().map(|seed| minute(&law, drift, *seed)).fold(Watch::default(), Watch::and);
    thread::scope(|scope| {
        let parts: Vec<_> = seeds.chunks(seeds.len().div_ceil(threads).max(1)).collect();
        let parts: Vec<_> = parts.into_iter().map(|part| scope.spawn(move || watched(part))).collect();
        parts.into_iter().map(|part| part.join().expect("no panic")).fold(Watch::default(), Watch::and)
    })
}

impl Watch {
    fn and(self, other: Self) -> Self {
        Self { alarms: self.alarms + other.alarms, largest: self.largest.max(other.largest) }
    }
}

/// A factor of the rate: one flight in four turns down to a thousand times slower, so that its bearing creeps or rests
/// within the clamp's zone.
fn pace(random: &mut Random) -> f64 {
    let slow = random.between(0.0, 1.0) < 0.25;
    if slow { random.log_between(1e-3, 1.0) } else { 1.0 }
}

/// One minute, up to its first alarm.
fn minute(law: &monitor::Law<f32>, drift: f64, seed: u64) -> Watch {
    let nominal = Config::consistent();
    let (mut random, mut found) = (Random::new(seed), Watch::default());
    let shape = core::array::from_fn(|_| random.between(0.0, 1.0));
    let altered = altered(&nominal, || 1.0 + drift * random.between(-1.0, 1.0));
    let (Ok(mut truth), Ok(mut model)) = (Axis::<f32>::new(&altered), Axis::<f32>::new(&nominal)) else { return found };
    let pace = pace(&mut random);
    let mut quick = Quick(random.bits() | 1);
    let mut state = law.start();
    for k in 0..60_000 {
        let row = swing(k, &shape);
        let row = Row { vehicle_rate_radps: pace * row.vehicle_rate_radps, ..row };
        truth.law.advance(&mut truth.state, &truth.law.units().input(&si(&row)));
        let theta = f64::from(truth.state.gyro_angle_rad()) + 2e-6 * quick.normal();
        let noisy = Row {
            accel_x_mps2: row.accel_x_mps2 + 0.01 * quick.normal(),
            accel_y_mps2: row.accel_y_mps2 + 0.01 * quick.normal(),
            accel_z_mps2: row.accel_z_mps2 + 0.01 * quick.normal(),
            vehicle_rate_radps: row.vehicle_rate_radps + 2e-4 * quick.normal(),
            ..row
        };
        if !see(law, &mut state, &mut model, theta, &noisy, &mut found) {
            break;
        }
    }
    found
}

/// Normal numbers with four uniform ones of 16 bits: quick, for hours of noise.
struct Quick(u64);

impl Quick {
    fn normal(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        let sum: u64 = (0..4).map(|part| (self.0 >> (16 * part)) & 0xFFFF).sum();
        (sum as f64 / 65_536.0 - 2.0) * 3.0_f64.sqrt()
    }
}

/// One row of the monitor; whether there is no alarm yet.
fn see(
    law: &monitor::Law<f32>,
    state: &mut monitor::State<f32>,
    model: &mut Axis<f32>,
    theta: f64,
    row: &Row,
    found: &mut Watch,
) -> bool {
    let step = estimator::Sensors::default().gyro_step_rad;
    let theta = (theta / step).round() * step;
    model.law.advance(&mut model.state, &model.law.units().input(&si(row)));
    if theta.abs() > 8.2e-3 {
        law.pause(state);
    }
    #[allow(clippy::cast_possible_truncation, reason = "as the flight computer holds it")]
    let report = law.step(state, Some(theta as f32), &model.state);
    found.largest = found.largest.max(f64::from(report.score) / law.threshold());
    found.alarms += u32::from(report.disagrees);
    !report.disagrees
}

/// [`watch`] with the plant as truth.
///
/// # Panics
/// If the preset does not build.
#[must_use]
pub fn watch_plant(minutes: u32, seed: u64) -> Watch {
    let (law, nominal) = (monitor_law(0.0), Config::consistent());
    let plant = Plant::new(&nominal).expect("a plant that builds").with_tolerance(1e-8);
    let mut random = Random::new(seed);
    let mut found = Watch::default();
    for _ in 0..minutes {
        let shape = core::array::from_fn(|_| random.between(0.0, 1.0));
        let mut model = Axis::<f32>::new(&nominal).expect("a law that builds");
        let mut state = law.start();
        for sample in plant.run((0..60_000).map(|k| swing(k, &shape))) {
            let reading = read(&sample, &estimator::Sensors::default(), &Noise::default(), &mut random);
            let theta = reading.gyro_angle_rad.unwrap_or(0.0);
            if !see(&law, &mut state, &mut model, theta, &reading.inputs, &mut found) {
                break;
            }
        }
    }
    found
}

/// The ten effects of the table, by a rule that looks at no result: in the order of the list of effects, the first of each
/// of the six blocks, then the second of each, until there are ten.
pub const EFFECTS: [&str; 10] = [
    "friction_level",
    "mass_unbalance",
    "loop_gain",
    "gyro_damping",
    "gimbal_inertia",
    "pickoff_scale",
    "viscous_friction",
    "anisoelasticity",
    "loop_delay",
    "angular_momentum",
];

/// How the monitor sees an effect that begins at 5 s.
#[derive(Debug, Clone, Copy)]
pub struct Seen {
    /// rms change of theta over the five seconds after [rad].
    pub change_rad: f64,
    /// Size relative to the effect's typical one.
    pub factor: f64,
    /// Time until the alarm [s]; `None`: not within 5 s.
    pub after_s: Option<f64>,
}

/// Row at which an effect begins.
const START: usize = 5_000;
const ROWS: usize = 10_000;

/// An effect on a flight of ten seconds, of any size.
#[derive(Debug)]
pub struct Acting {
    effect: Effect,
    nominal: Plant,
    base: Vec<Sample>,
}

/// A flight on which an effect has changed theta by as much as was asked for.
#[derive(Debug)]
pub struct Grown {
    change_rad: f64,
    factor: f64,
    samples: Vec<Sample>,
}

fn fly(plant: &Plant) -> Vec<Sample> {
    let shape = [0.6, 0.8, 0.05, 0.5, 0.5, 0.5];
    plant.run((0..ROWS).map(|k| swing(k, &shape))).collect()
}

impl Acting {
    /// The effect of this name.
    ///
    /// # Panics
    /// If there is no such effect.
    #[must_use]
    pub fn new(name: &str) -> Self {
        let nominal = Plant::new(&Config::consistent()).expect("a plant that builds").with_tolerance(1e-9);
        let effect = Effect::from_name(name).expect("an effect of this name");
        Self { effect, base: fly(&nominal), nominal }
    }

    /// The effect `factor` times its typical size; none where the loop cannot be built.
    fn with(&self, factor: f64) -> Option<Grown> {
        let mut values = self.effect.typical();
        values[..self.effect.sizes()].iter_mut().for_each(|value| *value *= factor);
        let samples = fly(&self.nominal.with_effect(self.effect, &values).ok()?);
        let pairs = samples[START..].iter().zip(&self.base[START..]);
        let square: f64 = pairs.map(|(a, b)| (a.logged.gyro_angle_rad - b.logged.gyro_angle_rad).powi(2)).sum();
        Some(Grown { change_rad: (square / (ROWS - START) as f64).sqrt(), factor, samples })
    }

    /// The effect of the size that changes theta by `change_rad` rms, to 2 % where its size decides on that.
    ///
    /// # Panics
    /// If no size builds.
    #[must_use]
    pub fn grown(&self, change_rad: f64) -> Grown {
        let (mut low, mut high) = (1e-5_f64, 100.0_f64);
        let mut best: Option<Grown> = None;
        let mut factor = 0.1;
        for _ in 0..16 {
            let grown = self.with(factor);
            let change = grown.as_ref().map_or(f64::INFINITY, |grown| grown.change_rad);
            if change < change_rad {
                low = factor;
            } else {
                high = factor;
            }
            if change >= change_rad {
                best = grown;
                if change < 1.02 * change_rad {
                    break;
                }
            }
            // Nearly every effect changes theta in proportion to its size.
            let proportional = factor * 1.01 * change_rad / change;
            let inside = proportional > low && proportional < high;
            factor = if inside { proportional } else { (low * high).sqrt() };
        }
        best.expect("a size that builds")
    }

    /// How a monitor that grants the model `model_tolerance` sees it.
    ///
    /// # Panics
    /// Never: the preset builds.
    #[must_use]
    pub fn seen(&self, grown: &Grown, model_tolerance: f64) -> Seen {
        let (law, mut model) =
            (monitor_law(model_tolerance), Axis::<f32>::new(&Config::consistent()).expect("a law that builds"));
        let (mut state, mut random, mut found) = (law.start(), Random::new(3), Watch::default());
        let mut after_s = None;
        for (k, (sample, without)) in grown.samples.iter().zip(&self.base).enumerate() {
            let sample = if k < START { without } else { sample };
            let reading = read(sample, &estimator::Sensors::default(), &Noise::default(), &mut random);
            let theta = reading.gyro_angle_rad.unwrap_or(0.0);
            if !see(&law, &mut state, &mut model, theta, &reading.inputs, &mut found) {
                after_s = Some((k as f64 - START as f64) * 1e-3);
                break;
            }
        }
        Seen { change_rad: grown.change_rad, factor: grown.factor, after_s }
    }
}

/// The smallest change of theta that is flagged within 5 s, for each of `granted`: tried from 4 urad on in steps of a
/// quarter, from 20 urad on of a half.
///
/// # Panics
/// If there is no such effect.
#[must_use]
pub fn smallest(name: &str, granted: &[f64]) -> Vec<Option<Seen>> {
    let acting = Acting::new(name);
    let mut found = vec![None; granted.len()];
    let mut change_rad = 4e-6;
    while change_rad < 2e-3 && found.iter().any(Option::is_none) {
        let grown = acting.grown(change_rad);
        for (found, granted) in found.iter_mut().zip(granted).filter(|(found, _)| found.is_none()) {
            *found = Some(acting.seen(&grown, *granted)).filter(|seen| seen.after_s.is_some());
        }
        change_rad *= if change_rad < 2e-5 { 1.25 } else { 1.5 };
    }
    found
}
