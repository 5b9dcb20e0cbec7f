//! Axes of any origin: everything about one drawn over wide ranges.

use std::f64::consts::TAU;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::effect::{BEYOND, Kind, LIBRARY, Term};
use super::path::{Course, Path};

/// Step of the simulation [s]: 20 kHz.
pub const STEP_S: f64 = 5e-5;
/// Relative tolerance of inertia, viscous and Coulomb friction in every model file.
pub const TOLERANCE: [f64; 3] = [0.03, 0.03, 0.15];

/// What closes the loop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Law {
    /// `kp e - kd v`.
    Pd,
    /// `kp e + ki int e - kd v`.
    Pid,
    /// `kv (kp e - v)`, with an integral of that.
    Cascade,
    /// `kv (rate reference - v)`: a rate loop.
    Rate,
}

/// One axis with its loop, its sensors and its log.
#[derive(Debug, Clone)]
pub struct Axis {
    pub seed: u64,
    pub rotary: bool,
    pub unit: &'static str,
    /// True parameters and those of the model file.
    pub inertia: f64,
    pub viscous: f64,
    pub coulomb: f64,
    pub nominal: [f64; 3],
    /// Sizes of the motion.
    pub rate: f64,
    pub acceleration: f64,
    pub travel: f64,
    /// Bristles (`LuGre`) or slip blocks (Maxwell), and the displacement over which they build up.
    pub maxwell: bool,
    pub bristle: f64,
    pub terms: Vec<Term>,
    pub law: Law,
    /// Angular frequency of the loop, share of its integral, gains of the model over the true ones.
    pub loop_radps: f64,
    pub integral: f64,
    pub gain_off: f64,
    pub law_known: bool,
    /// Rows of the log, steps of the controller, in steps of the simulation.
    pub log_every: usize,
    pub loop_every: usize,
    /// Delay of the command in steps of the controller.
    pub delay: usize,
    pub limit: f64,
    /// The logged effort is the command, or what a sensor says.
    pub held: bool,
    pub counts: f64,
    pub position_noise: f64,
    pub position: bool,
    pub velocity: bool,
    pub rate_noise: f64,
    pub effort_noise: f64,
    pub effort_step: f64,
    pub load: bool,
    pub path: Path,
    pub seconds: f64,
}

/// A stream of an axis; one for each purpose.
pub fn rng(seed: u64, stream: u64) -> ChaCha8Rng {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(stream);
    rng
}

/// Uniform in the logarithm.
pub fn log_uniform(rng: &mut impl RngExt, low: f64, high: f64) -> f64 {
    (low.ln() + rng.random::<f64>() * (high / low).ln()).exp()
}

fn pick<T: Copy>(rng: &mut impl RngExt, of: &[T]) -> T {
    of[rng.random_range(0..of.len())]
}

/// What the log of a seed has: none, one, two effects, or one beyond the library.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Group {
    None,
    One,
    Two,
    Beyond,
    /// A rate loop of low inertia under a ripple larger than friction: its motion is the loop's answer to the ripple.
    Swamped,
}

/// Of ten three have none, four one, two two; the tenth an effect beyond the library, or its motion is a ripple's.
pub fn group(seed: u64) -> Group {
    match seed % 10 {
        0..=2 => Group::None,
        3..=6 => Group::One,
        7 | 8 => Group::Two,
        _ if seed / 10 % 4 == 3 => Group::Swamped,
        _ => Group::Beyond,
    }
}

/// The axis of a seed, its effects without their sizes; another attempt is another axis with the same effects.
#[allow(clippy::too_many_lines, reason = "one draw after another")]
pub fn axis(seed: u64, attempt: u64) -> Axis {
    let rng = &mut rng(seed, 16 + attempt);
    let rotary = rng.random();
    let strength = log_uniform(rng, 0.05, 20.0);
    let unit = pick(rng, if rotary { &["N m", "A", "V"] } else { &["N", "A", "V"] });
    let strength = if unit.starts_with('N') { 1.0 } else { strength };
    let mass = if rotary { log_uniform(rng, 1e-5, 10.0) } else { log_uniform(rng, 0.01, 300.0) };
    let rate = if rotary { log_uniform(rng, 0.3, 60.0) } else { log_uniform(rng, 0.02, 1.5) };
    let hz = log_uniform(rng, 0.15, 2.0);
    let acceleration = TAU * hz * rate;
    let travel = 2.0 * rate / (TAU * hz);
    let inertia = mass / strength;
    let level = inertia * acceleration;
    let coulomb = level * log_uniform(rng, 0.08, 2.0);
    let viscous = level / rate * log_uniform(rng, 0.02, 1.0);
    let mut off = |tolerance: f64| 1.0 + tolerance * (2.0 * rng.random::<f64>() - 1.0);
    let nominal = [inertia / off(TOLERANCE[0]), viscous / off(TOLERANCE[1]), coulomb / off(TOLERANCE[2])];
    let log_hz = pick(rng, &[200, 250, 500, 1000, 1000, 2000, 4000, 5000]);
    let log_every: usize = 20_000 / log_hz;
    let loop_every = log_every.min(pick(rng, &[4, 5, 10, 20]));
    let loop_every = if log_every.is_multiple_of(loop_every) { loop_every } else { log_every.min(5) };
    let law = pick(rng, &[Law::Pd, Law::Pid, Law::Cascade, Law::Cascade, Law::Rate]);
    let maxwell = rng.random();
    // bristles too stiff for the step are not drawn
    let least = if maxwell { 0.0 } else { 0.9 * STEP_S * rate };
    let least = f64::max(least, 4.0 * coulomb / inertia * STEP_S * STEP_S);
    let bristle = (travel * log_uniform(rng, 2e-6, 5e-5)).max(least);
    let mut path = Path::draw(rng, law == Law::Rate);
    path.rate = rate;
    path.hz = hz;
    let held = loop_every == log_every;
    let top = 1.5 * level + 1.3 * coulomb + 1.3 * viscous * rate;
    let encoder = rng.random_bool(0.85);
    let terms = effects(seed, &mut self::rng(seed, 2), travel, rate);
    let has = |kinds: &[Kind]| terms.iter().any(|term| kinds.contains(&term.kind));
    let columns = has(&[Kind::VelocityDelay, Kind::VelocityScale]);
    // what hangs on the place needs one to come back to
    if has(&[Kind::Spring, Kind::CubicSpring, Kind::Taper, Kind::LocalFriction]) && path.course == Course::Rates {
        path.course = Course::Sines;
    }
    Axis {
        seed,
        rotary,
        unit,
        inertia,
        viscous,
        coulomb,
        nominal,
        rate,
        acceleration,
        travel,
        maxwell,
        bristle,
        load: has(&[Kind::Load, Kind::LoadFriction]) || rng.random_bool(0.25),
        position: encoder || columns,
        velocity: !encoder || columns || rng.random_bool(0.4),
        terms,
        law,
        loop_radps: TAU
            * log_uniform(rng, 4.0 * hz.max(0.5), 30.0_f64.max(6.0 * hz)).min(0.02 * 20_000.0 / loop_every as f64),
        integral: if law == Law::Pid || rng.random_bool(0.3) { rng.random_range(0.05..0.3) } else { 0.0 },
        gain_off: 1.0 + 0.02 * (2.0 * rng.random::<f64>() - 1.0),
        law_known: rng.random_bool(0.5),
        log_every,
        loop_every,
        delay: if held { 0 } else { rng.random_range(0..2) },
        limit: top * log_uniform(rng, 1.0, 5.0),
        held,
        counts: travel / log_uniform(rng, 5e3, 1e6),
        position_noise: rng.random_range(0.0..0.5),
        rate_noise: rate * log_uniform(rng, 2e-4, 8e-3),
        effort_noise: top * log_uniform(rng, 1e-4, 5e-3),
        effort_step: top / pick(rng, &[512.0, 2048.0, 32_768.0]),
        path,
        seconds: rng.random_range(12.0..30.0_f64).max(6.0 / hz).min(40.0),
    }
}

/// The axis of a seed as a rate loop that its ripple drives: constant rates, two waves, little friction.
pub fn swamped(seed: u64, attempt: u64) -> Axis {
    let base = axis(seed, attempt);
    let rng = &mut rng(seed, 64 + attempt);
    let log_every = pick(rng, &[20, 20, 10, 40]);
    let rate = rng.random_range(2.0..9.0);
    // the wave's frequency stays far below the rows'
    let most = 0.1 * TAU / (STEP_S * log_every as f64) / rate;
    let waves = (rng.random_range(0.4..1.0) * most).round().max(8.0);
    let ripple_radps = waves * rate;
    let level = base.inertia * ripple_radps * rate * rng.random_range(0.2..0.6);
    let coulomb = level * rng.random_range(0.2..0.6);
    let viscous = coulomb / rate * rng.random_range(0.02..0.2);
    let mut off = |tolerance: f64| 1.0 + tolerance * (2.0 * rng.random::<f64>() - 1.0);
    let nominal = [base.inertia / off(TOLERANCE[0]), viscous / off(TOLERANCE[1]), coulomb / off(TOLERANCE[2])];
    let wave = |size: f64, number: f64, phase: f64| Term { kind: Kind::Ripple, size, number, phase };
    let terms = vec![
        wave(level, waves, rng.random_range(0.0..TAU)),
        wave(level * rng.random_range(0.15..0.4), (waves / 4.0).round(), rng.random_range(0.0..TAU)),
    ];
    let mut path = base.path.clone();
    (path.course, path.rate, path.hz) = (Course::Rates, rate, rng.random_range(0.5..1.5));
    let limit = 6.0 * (level + coulomb);
    let (position_noise, rate_noise) = (0.3, rate * log_uniform(rng, 1e-4, 3e-3));
    Axis {
        rotary: true,
        unit: pick(rng, &["N m", "A"]),
        viscous,
        coulomb,
        nominal,
        rate,
        acceleration: level / base.inertia,
        travel: TAU,
        maxwell: true,
        bristle: 1e-5,
        terms,
        law: Law::Rate,
        loop_radps: ripple_radps * rng.random_range(0.5..1.5),
        integral: 0.0,
        log_every,
        loop_every: log_every,
        delay: 0,
        held: true,
        limit,
        counts: TAU / pick(rng, &[65_536.0, 262_144.0]),
        position_noise,
        position: true,
        velocity: true,
        rate_noise,
        effort_noise: 1e-4 * limit,
        effort_step: limit / 32_768.0,
        path,
        seconds: rng.random_range(12.0..30.0),
        ..base
    }
}

fn effects(seed: u64, rng: &mut ChaCha8Rng, travel: f64, rate: f64) -> Vec<Term> {
    let place = seed / 10;
    let at = |index: u64, of: usize| usize::try_from(index).unwrap_or(0) % of;
    let kinds: Vec<Kind> = match group(seed) {
        Group::None | Group::Swamped => Vec::new(),
        // every kind in turn
        Group::One => vec![LIBRARY[at(4 * place + seed % 10 - 3, LIBRARY.len())]],
        Group::Two => {
            let first = LIBRARY[at(2 * place + seed % 10 - 7, 27)];
            let second = loop {
                let other = LIBRARY[rng.random_range(0..27)];
                if other != first {
                    break other;
                }
            };
            vec![first, second]
        }
        Group::Beyond => vec![BEYOND[at(place, BEYOND.len())]],
    };
    kinds
        .into_iter()
        .map(|kind| {
            let number = match kind {
                Kind::Stribeck => rate * log_uniform(rng, 0.01, 0.15),
                Kind::Curve => rate,
                Kind::FrictionDrift | Kind::ViscousDrift | Kind::BiasDrift => rng.random_range(3.0..12.0),
                // whole waves a turn of a rotary axis: the drawing of the axis says which one is rotary
                Kind::PositionFriction => TAU / travel * rng.random_range(1.0..6.0),
                Kind::Ripple | Kind::MotorRipple => TAU / travel * rng.random_range(2.0..25.0),
                Kind::Presliding => travel * log_uniform(rng, 1e-3, 2e-2),
                Kind::Hysteresis => travel * rng.random_range(0.05..0.4),
                Kind::Backlash => travel * log_uniform(rng, 1e-3, 1e-2),
                Kind::CubicSpring => 0.5 * travel,
                Kind::HiddenPulses => rng.random_range(2.0..6.0),
                Kind::Vibration => TAU * rng.random_range(2.0..12.0),
                Kind::LocalFriction => travel * rng.random_range(0.05..0.15),
                Kind::StickyThird => rng.random_range(4.0..8.0),
                _ => 1.0,
            };
            let phase = match kind {
                Kind::Curve => rng.random_range(0.5..0.8),
                Kind::LocalFriction => travel * rng.random_range(-0.3..0.3),
                _ => rng.random_range(0.0..TAU),
            };
            Term { kind, size: 0.0, number, phase }
        })
        .collect()
}
