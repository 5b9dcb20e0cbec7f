//! The smallest size of an effect that a log can show, from the plant with and without it.
//!
//! ```text
//! d(size) = min over |p_i| <= tolerance_i of | W (y(size) - y(0) - S p) |        smallest size: d = 5
//! ```
//!
//! y: theta and motor torque without their first second. W: one over the amplitude spectrum of the noise, which is the sensors'
//! own and that of the logged inputs carried through the plant. S: finite differences of y by every nominal parameter, each of
//! which may go from where it truly is to either end of its tolerance.

use gimbal_plant::{Effect, Plant, Row};
use gimbal_servo::Config;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;
use rayon::prelude::*;
use realfft::RealFftPlanner;
use realfft::num_complex::Complex;

use super::draw::Drawn;
use super::{ACCEL_NOISE_MPS2, PICKOFF_NOISE_RAD, PICKOFF_STEP_RAD, RATE_NOISE_RADPS, TORQUE_NOISE_NM};

/// d of the smallest size.
const DETECTABLE: f64 = 5.0;
/// Local error of the plant's steps: what is left of it in theta is a thousandth of the noise.
const TOLERANCE: f64 = 1e-7;
/// Rows that are not looked at.
const UNSCORED: usize = 1000;
/// Rows of one piece of the noise spectrum.
const PIECE: usize = 2048;
/// Step of a sensitivity over the tolerance.
const STEP: f64 = 0.2;
/// Rows of a window of half a second.
const WINDOW: usize = 500;
/// A run whose theta grows by more than this has left its work.
const LOST: f64 = 20.0;

/// theta and motor torque.
pub(crate) type Outputs = [Vec<f64>; 2];

/// A nominal parameter of the platform.
struct Parameter {
    /// The effect that it is beyond its tolerance.
    name: &'static str,
    tolerance: f64,
    of: fn(&mut Config) -> &mut f64,
}

macro_rules! parameter {
    ($name:literal, $tolerance:literal, $config:ident => $field:expr) => {
        Parameter { name: $name, tolerance: $tolerance, of: |$config| &mut $field }
    };
}

static PARAMETERS: [Parameter; 20] = [
    parameter!("gimbal_inertia", 0.03, c => c.servo.gimbal_inertia_kg_m2),
    parameter!("loop_gain", 0.03, c => c.servo.gain_nm_per_rad_s),
    parameter!("motor_lag", 0.03, c => c.servo.motor_lag_s),
    parameter!("T1", 0.03, c => c.servo.lead_time_constants_s[0]),
    parameter!("T2", 0.03, c => c.servo.lead_time_constants_s[1]),
    parameter!("T3", 0.03, c => c.servo.lead_time_constants_s[2]),
    parameter!("T4", 0.03, c => c.servo.lead_time_constants_s[3]),
    parameter!("T5", 0.03, c => c.servo.lead_time_constants_s[4]),
    parameter!("T6", 0.03, c => c.servo.lag_time_constants_s[0]),
    parameter!("T7", 0.03, c => c.servo.lag_time_constants_s[1]),
    parameter!("T8", 0.03, c => c.servo.lag_time_constants_s[2]),
    parameter!("T9", 0.03, c => c.servo.lag_time_constants_s[3]),
    parameter!("float_inertia", 0.03, c => c.gyro.float_inertia_kg_m2),
    parameter!("gyro_damping", 0.03, c => c.gyro.damping_nm_s_per_rad),
    parameter!("angular_momentum", 0.03, c => c.gyro.angular_momentum_nm_s),
    parameter!("stop_angle", 0.03, c => c.gyro.stop_angle_rad),
    parameter!("friction_level", 0.15, c => c.bearing.load_torque_nm_per_n),
    parameter!("viscosity", 0.03, c => c.bearing.lubrication_factor),
    parameter!("slip_rate", 0.03, c => c.bearing.slip_rate_radps),
    parameter!("mass_unbalance", 0.03, c => c.unbalance.x_kg_m),
];

/// The platform whose own parameter of an effect's name is nominal: the effect's value is then the whole change.
pub(crate) fn without_own_drift(platform: &Config, nominal: &Config, effect: Effect) -> Config {
    let (mut platform, mut nominal) = (*platform, *nominal);
    for parameter in PARAMETERS.iter().filter(|parameter| parameter.name == effect.name()) {
        *(parameter.of)(&mut platform) = *(parameter.of)(&mut nominal);
    }
    platform
}

/// theta and torque as logged, without noise, and the inputs as logged; none where the platform is lost.
fn run(rows: &[Row], platform: &Config, effect: Option<(Effect, &[f64])>) -> Option<(Outputs, Vec<Row>)> {
    let mut plant = Plant::new(platform).ok()?.with_tolerance(TOLERANCE);
    if let Some((effect, values)) = effect {
        plant = plant.with_effect(effect, values).ok()?;
    }
    let mut outputs: Outputs = Default::default();
    let mut inputs = Vec::with_capacity(rows.len());
    for sample in plant.run_from(plant.settled(&rows[0]), rows.iter().copied()) {
        let logged = sample.logged;
        if !(logged.gyro_angle_rad.is_finite() && sample.gimbal_angle_rad.abs() < 1.0) {
            return None;
        }
        outputs[0].push(logged.gyro_angle_rad);
        outputs[1].push(logged.motor_torque_nm);
        inputs.push(logged.inputs);
    }
    Some((outputs, inputs))
}

fn less(a: &Outputs, b: &Outputs) -> Outputs {
    [0, 1].map(|place| a[place].iter().zip(&b[place]).map(|(a, b)| a - b).collect())
}

/// One over the noise amplitude by frequency, for each output.
struct Whitener {
    length: usize,
    weights: [Vec<f64>; 2],
}

/// Power by frequency, mean over pieces that overlap by half; white noise of rms 1 gives 1.
fn spectrum(series: &[f64]) -> Vec<f64> {
    let forward = RealFftPlanner::<f64>::new().plan_fft_forward(PIECE);
    let window: Vec<f64> =
        (0..PIECE).map(|k| (std::f64::consts::PI * (k as f64 + 0.5) / PIECE as f64).sin().powi(2)).collect();
    let norm: f64 = window.iter().map(|value| value * value).sum();
    let mut output = forward.make_output_vec();
    let mut power = vec![0.0; output.len()];
    let mut pieces = 0.0;
    for piece in series.windows(PIECE).step_by(PIECE / 2) {
        let mut input: Vec<f64> = piece.iter().zip(&window).map(|(value, weight)| value * weight).collect();
        forward.process(&mut input, &mut output).expect("lengths that were planned");
        power.iter_mut().zip(&output).for_each(|(sum, line)| *sum += line.norm_sqr() / norm);
        pieces += 1.0;
    }
    power.iter().map(|sum| sum / pieces).collect()
}

impl Whitener {
    fn new(noise: &Outputs) -> Self {
        let count = noise[0].len() - UNSCORED;
        let length = count.next_power_of_two();
        let weights = noise.each_ref().map(|series| {
            let power = spectrum(&series[UNSCORED..]);
            let of = |line: usize| {
                let place = line as f64 * PIECE as f64 / length as f64;
                let low = (place as usize).min(power.len() - 2);
                let value = power[low] + (power[low + 1] - power[low]) * (place - low as f64);
                1.0 / value.sqrt()
            };
            (0..=length / 2).map(of).collect()
        });
        Self { length, weights }
    }

    /// The whitened spectra of a difference.
    fn lines(&self, difference: &Outputs) -> [Vec<Complex<f64>>; 2] {
        let forward = RealFftPlanner::<f64>::new().plan_fft_forward(self.length);
        [0, 1].map(|place| {
            let series = &difference[place][UNSCORED..];
            let edge = 0.02 * series.len() as f64;
            let fade = |k: usize| {
                let near = (k.min(series.len() - 1 - k) as f64 + 0.5) / edge;
                if near < 1.0 { (0.5 * std::f64::consts::PI * near).sin().powi(2) } else { 1.0 }
            };
            let mut input: Vec<f64> = series.iter().enumerate().map(|(k, value)| value * fade(k)).collect();
            input.resize(self.length, 0.0);
            let mut output = forward.make_output_vec();
            forward.process(&mut input, &mut output).expect("lengths that were planned");
            output.iter_mut().zip(&self.weights[place]).for_each(|(line, weight)| *line *= *weight);
            output
        })
    }

    /// A list whose squares sum to those of the whitened rows (Parseval).
    fn column(&self, difference: &Outputs) -> Vec<f64> {
        let half = self.length / 2;
        let scale = |line: usize| (if line == 0 || line == half { 1.0 } else { 2.0 } / self.length as f64).sqrt();
        let lines = self.lines(difference);
        let parts = |(line, value): (usize, &Complex<f64>)| [value.re * scale(line), value.im * scale(line)];
        lines.iter().flat_map(|lines| lines.iter().enumerate().flat_map(parts)).collect()
    }

    /// Power of the whitened rows in each window of half a second from the first row on.
    fn windows(&self, difference: &Outputs) -> Vec<f64> {
        let back = RealFftPlanner::<f64>::new().plan_fft_inverse(self.length);
        let rows = difference[0].len();
        let mut powers = vec![0.0; rows.div_ceil(WINDOW)];
        for mut lines in self.lines(difference) {
            let half = lines.len() - 1;
            (lines[0].im, lines[half].im) = (0.0, 0.0);
            let mut series = back.make_output_vec();
            back.process(&mut lines, &mut series).expect("lengths that were planned");
            for (k, value) in series[..rows - UNSCORED].iter().enumerate() {
                powers[(k + UNSCORED) / WINDOW] += (value / self.length as f64).powi(2);
            }
        }
        powers
    }
}

/// What a nominal parameter may do.
struct Nuisance {
    name: &'static str,
    column: Vec<f64>,
    limits: (f64, f64),
}

/// One motion of one platform with its noise and sensitivities.
pub(crate) struct Bench {
    pub(crate) rows: Vec<Row>,
    pub(crate) platform: Config,
    nominal: Config,
    pub(crate) outputs: Outputs,
    whitener: Whitener,
    nuisances: Vec<Nuisance>,
    products: Vec<Vec<f64>>,
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

impl Bench {
    pub(crate) fn new(rows: Vec<Row>, nominal: &Config, platform: &Config, rng: &mut ChaCha8Rng) -> Self {
        let outputs = run(&rows, platform, None).expect("a platform that works").0;
        let mut white = |sigma: f64| -> f64 { sigma * rng.sample::<f64, _>(StandardNormal) };
        let noisy: Vec<Row> = rows
            .iter()
            .map(|row| Row {
                accel_x_mps2: row.accel_x_mps2 + white(ACCEL_NOISE_MPS2),
                accel_y_mps2: row.accel_y_mps2 + white(ACCEL_NOISE_MPS2),
                accel_z_mps2: row.accel_z_mps2 + white(ACCEL_NOISE_MPS2),
                vehicle_rate_radps: row.vehicle_rate_radps + white(RATE_NOISE_RADPS),
                cross_rate_radps: row.cross_rate_radps + white(RATE_NOISE_RADPS),
                ..*row
            })
            .collect();
        let mut noise = less(&run(&noisy, platform, None).expect("a platform that works").0, &outputs);
        let pickoff = PICKOFF_NOISE_RAD.hypot(PICKOFF_STEP_RAD / 12.0_f64.sqrt());
        noise[0].iter_mut().for_each(|value| *value += white(pickoff));
        noise[1].iter_mut().for_each(|value| *value += white(TORQUE_NOISE_NM));
        let whitener = Whitener::new(&noise);
        let moved = |parameter: &Parameter| {
            let (mut moved, mut truth, mut printed) = (*platform, *platform, *nominal);
            let now = *(parameter.of)(&mut truth) / *(parameter.of)(&mut printed) - 1.0;
            let step = STEP * parameter.tolerance;
            *(parameter.of)(&mut moved) += step * *(parameter.of)(&mut printed);
            let difference = less(&run(&rows, &moved, None)?.0, &outputs);
            let column: Vec<f64> = whitener.column(&difference).iter().map(|value| value / step).collect();
            Some(Nuisance {
                name: parameter.name,
                column,
                limits: (-parameter.tolerance - now, parameter.tolerance - now),
            })
        };
        let mut nuisances: Vec<Nuisance> = PARAMETERS.par_iter().filter_map(moved).collect();
        let nothing = vec![0.0; outputs[0].len()];
        for (name, shown) in
            [("pickoff_scale", [outputs[0].clone(), nothing.clone()]), ("torque_scale", [nothing, outputs[1].clone()])]
        {
            nuisances.push(Nuisance { name, column: whitener.column(&shown), limits: (-0.03, 0.03) });
        }
        let products =
            nuisances.iter().map(|a| nuisances.iter().map(|b| dot(&a.column, &b.column)).collect()).collect();
        Self { rows, platform: *platform, nominal: *nominal, outputs, whitener, nuisances, products }
    }

    /// What an effect shows: outputs with it less those without, as far as the logged inputs do not tell them.
    fn shown(&self, effect: Effect, values: &[f64]) -> Option<Outputs> {
        let platform = without_own_drift(&self.platform, &self.nominal, effect);
        let own = PARAMETERS.iter().any(|parameter| parameter.name == effect.name());
        let without = if own { run(&self.rows, &platform, None)?.0 } else { self.outputs.clone() };
        let (with, logged) = run(&self.rows, &platform, Some((effect, values)))?;
        let difference = less(&with, &without);
        let rms = |series: &[f64]| series.iter().map(|value| value * value).sum::<f64>().sqrt();
        if rms(&with[0]) > LOST * rms(&without[0]) {
            return None;
        }
        if !effect.columns().contains(&"accel_x_mps2") {
            return Some(difference);
        }
        // inputs that are logged wrong make the model expect something else
        let expected = run(&logged, &platform, None)?.0;
        Some(less(&difference, &less(&expected, &without)))
    }

    /// d after the nuisances have taken what they can.
    fn d(&self, effect: Effect, values: &[f64]) -> Option<f64> {
        let column = self.whitener.column(&self.shown(effect, values)?);
        let limits: Vec<(f64, f64)> = self
            .nuisances
            .iter()
            .map(|own| {
                let half = 0.5 * (own.limits.1 - own.limits.0);
                if own.name == effect.name() { (-half, half) } else { own.limits }
            })
            .collect();
        let pulls: Vec<f64> = self.nuisances.iter().map(|own| dot(&own.column, &column)).collect();
        let mut moves = vec![0.0; pulls.len()];
        // one after the other: the problem is convex
        for _ in 0..20_000 {
            let mut largest = 0.0_f64;
            for (place, products) in self.products.iter().enumerate() {
                let own = products[place];
                if own < 1e-12 {
                    continue;
                }
                let best = moves[place] + (pulls[place] - dot(products, &moves)) / own;
                let next = best.clamp(limits[place].0, limits[place].1);
                largest = largest.max((next - moves[place]).abs() * own.sqrt());
                moves[place] = next;
            }
            if largest < 1e-3 {
                break;
            }
        }
        let taken: f64 = moves
            .iter()
            .zip(&self.products)
            .zip(&pulls)
            .map(|((own, products), pull)| own * (2.0 * pull - dot(products, &moves)))
            .sum();
        Some((dot(&column, &column) - taken).max(0.0).sqrt())
    }

    /// The size with d = 5 to 5 %, or the least that is asked for; none where the realistic range ends before it.
    pub(crate) fn smallest(&self, drawn: &Drawn) -> Option<f64> {
        // what is lost shows, and is too large
        let d = |size: f64| self.d(drawn.effect, &drawn.values(size)).unwrap_or(f64::INFINITY);
        let largest = drawn.largest();
        let [mut low, mut high]: [Option<(f64, f64)>; 2] = [None; 2];
        let mut size = drawn.typical().min(largest);
        for _ in 0..12 {
            let now = d(size);
            if (now / DETECTABLE - 1.0).abs() < 0.05 {
                return Some(size);
            }
            if now < DETECTABLE {
                low = Some((size, now));
            } else {
                high = Some((size, now));
            }
            if high.is_some_and(|(size, _)| size <= drawn.least()) {
                return Some(drawn.least());
            }
            size = match (low, high) {
                (Some((size, d)), None) if size < largest => {
                    (size * (1.2 * DETECTABLE / d).clamp(1.5, 30.0)).min(largest)
                }
                (None, Some((size, d))) => (size * (0.8 * DETECTABLE / d).clamp(1e-3, 0.7)).max(drawn.least()),
                (Some((small, less)), Some((large, more))) if more.is_finite() && less > 0.0 => {
                    let part = ((DETECTABLE / less).ln() / (more / less).ln()).clamp(0.1, 0.9);
                    small * (large / small).powf(part)
                }
                (Some((small, _)), Some((large, _))) => (small * large).sqrt(),
                (Some(_) | None, None) => return None,
            };
        }
        high.map(|(size, _)| size)
    }

    /// Half-second windows in which an effect stands out of the noise by three standard deviations.
    pub(crate) fn windows(&self, effect: Effect, values: &[f64]) -> Vec<bool> {
        let shown = self.shown(effect, values);
        shown.map_or(Vec::new(), |shown| self.whitener.windows(&shown).iter().map(|power| *power > 9.0).collect())
    }
}
