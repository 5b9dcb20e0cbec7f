//! A servo axis of another making: `LuGre` friction, a loop of its own, small steps. It shares nothing with the
//! diagnosis but the columns of its log.
//!
//! ```text
//! J a = k(u) - F - D(q) - b        F = s0 z + s1 dz/dt + B v,  dz/dt = v - s0 |v| z/g(v)
//! g(v) = Fc + (Fs - Fc) exp(-(v/vs)^2)
//! ```

use std::fmt::Write;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

/// The truth.
#[derive(Debug, Clone)]
pub(crate) struct Truth {
    pub(crate) inertia: f64,
    pub(crate) viscous: f64,
    pub(crate) coulomb: f64,
    pub(crate) static_excess: f64,
    pub(crate) stribeck_rate: f64,
    /// Displacement over which friction builds up.
    pub(crate) bristle: f64,
    /// Rate of a friction `tanh(v / rate)` in the place of bristles; none at 0.
    pub(crate) smooth_rate: f64,
    /// Of Coulomb and of viscous friction.
    pub(crate) asymmetry: f64,
    pub(crate) viscous_asymmetry: f64,
    pub(crate) drag: f64,
    /// Friction falls by this share with the time constant given.
    pub(crate) warming: (f64, f64),
    pub(crate) constant: f64,
    /// Waves per unit, amplitude, phase.
    pub(crate) ripple: Vec<(f64, f64, f64)>,
    pub(crate) motor_ripple: Vec<(f64, f64, f64)>,
    pub(crate) spring: f64,
    /// A force in time, whatever the axis does: amplitude, frequency [Hz].
    pub(crate) hum: (f64, f64),
    pub(crate) dead_zone: f64,
    pub(crate) delay_rows: usize,
    /// Pulses of load, as a code of 0 or 5.
    pub(crate) load_per_code: f64,
    pub(crate) gain: f64,
    /// Factors on what is logged.
    pub(crate) position_factor: f64,
    pub(crate) velocity_factor: f64,
    pub(crate) effort_factor: f64,
}

impl Truth {
    /// The nominal axis: what the model file says, and bristles so stiff that they are the nominal friction.
    pub(crate) fn nominal() -> Self {
        Self {
            inertia: 80.0,
            viscous: 150.0,
            coulomb: 25.0,
            static_excess: 0.0,
            stribeck_rate: 0.01,
            bristle: 2e-6,
            smooth_rate: 0.0,
            asymmetry: 0.0,
            viscous_asymmetry: 0.0,
            drag: 0.0,
            warming: (0.0, 5.0),
            constant: 0.0,
            ripple: Vec::new(),
            motor_ripple: Vec::new(),
            spring: 0.0,
            hum: (0.0, 0.0),
            dead_zone: 0.0,
            delay_rows: 0,
            load_per_code: 0.0,
            gain: 1.0,
            position_factor: 1.0,
            velocity_factor: 1.0,
            effort_factor: 1.0,
        }
    }
}

/// What moves it.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Path {
    /// Smooth strokes of changing speed, with stops.
    Strokes,
    /// Sines of several frequencies.
    Sines,
}

pub(crate) const MODEL: &str = "[axis]\nmotion = \"linear\"\neffort_unit = \"N\"\ninertia = 80.0\nviscous = 150.0\n\
coulomb = 25.0\neffort_held = true\nknown_good = []\n[axis.columns]\ntime = { name = \"t\", unit = \"s\" }\n\
position = { name = \"x\", unit = \"m\" }\nvelocity = { name = \"v\", unit = \"m/s\" }\neffort = { name = \"f\", unit = \"N\" }\n\
[axis.columns.auxiliary]\ncode = { name = \"code\", unit = \"1\" }\n";

/// The model file without a rate.
pub(crate) fn position_alone() -> String {
    MODEL.replace("velocity = { name = \"v\", unit = \"m/s\" }\n", "")
}

/// A log of the axis: t, x, v, f, code.
pub(crate) fn log(truth: &Truth, path: Path, length_s: f64, seed: u64) -> String {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut normal = || -> f64 { StandardNormal.sample(&mut random) };
    let period = 1e-3;
    let fine = 40;
    let step = period / f64::from(fine);
    let (mut q, mut v, mut z) = (0.0_f64, 0.0_f64, 0.0_f64);
    let mut out = String::from("t,x,v,f,code\n");
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "rows")]
    let rows = (length_s / period) as usize;
    let mut held = vec![0.0; truth.delay_rows + 1];
    let mut dice = ChaCha8Rng::seed_from_u64(seed.wrapping_add(77));
    let phases: Vec<f64> = (0..6).map(|_| dice.random_range(0.0..std::f64::consts::TAU)).collect();
    for k in 0..rows {
        let t = k as f64 * period;
        let reference = match path {
            Path::Strokes => {
                let stroke = (t / 2.2).floor();
                let share = ((t / 2.2 - stroke) * 1.25).min(1.0);
                let smooth = share * share * share * (10.0 - 15.0 * share + 6.0 * share * share);
                let length = [0.1, 0.2, 0.04, 0.15, 0.02, 0.22][stroke as usize % 6];
                let up = (stroke as usize).is_multiple_of(2);
                let previous = [0.1, 0.2, 0.04, 0.15, 0.02, 0.22][(stroke as usize + 5) % 6];
                let _ = previous;
                if up {
                    length * smooth
                } else {
                    [0.1, 0.2, 0.04, 0.15, 0.02, 0.22][(stroke as usize - 1) % 6] * (1.0 - smooth)
                }
            }
            Path::Sines => (0..6)
                .map(|n| {
                    let hz = [0.13, 0.31, 0.57, 1.1, 2.3, 4.1][n];
                    [0.08, 0.05, 0.03, 0.012, 0.005, 0.002][n]
                        * ((std::f64::consts::TAU * hz * t + phases[n]).sin() - phases[n].sin())
                })
                .sum(),
        };
        let measured = q + 2e-7 * normal();
        let rate = v;
        let mut command = 39_000.0 * (reference - measured) - 240.0 * rate * 4.0;
        let code = if truth.load_per_code != 0.0 && (t % 5.0) > 3.0 && (t % 5.0) < 3.6 { 5.0 } else { 0.0 };
        command = command.clamp(-400.0, 400.0);
        let _ = writeln!(
            out,
            "{t:.4},{:.9},{:.6},{:.5},{code}",
            measured * truth.position_factor,
            ((v + 2e-4 * normal()) * truth.velocity_factor),
            command * truth.effort_factor
        );
        held.rotate_right(1);
        held[0] = command;
        let effort = held[truth.delay_rows];
        let effort =
            if truth.dead_zone > 0.0 { effort.signum() * (effort.abs() - truth.dead_zone).max(0.0) } else { effort };
        let hum = truth.hum.0 * (std::f64::consts::TAU * truth.hum.1 * t).sin();
        for _ in 0..fine {
            let ripple: f64 = truth.ripple.iter().map(|(k, a, p)| a * (k * q - p).cos()).sum();
            let gain =
                truth.gain * (1.0 + truth.motor_ripple.iter().map(|(k, a, p)| a * (k * q - p).cos()).sum::<f64>());
            let warm = 1.0 - truth.warming.0 * (1.0 - (-t / truth.warming.1).exp());
            let level = warm
                * (truth.coulomb + truth.static_excess * (-(v / truth.stribeck_rate).powi(2)).exp())
                * (1.0 + truth.asymmetry * v.signum());
            let stiffness = truth.coulomb / truth.bristle;
            // bristles are stiff: implicit step of z
            z = (z + step * v) / (1.0 + step * stiffness * v.abs() / level);
            let viscous = truth.viscous * (1.0 + truth.viscous_asymmetry * v.signum());
            let friction = if truth.smooth_rate > 0.0 { level * (v / truth.smooth_rate).tanh() } else { stiffness * z };
            let force = friction + viscous * v + truth.drag * v * v.abs();
            let acceleration = (gain * effort
                - force
                - ripple
                - truth.constant
                - hum
                - truth.spring * (q - 0.05)
                - truth.load_per_code * code)
                / truth.inertia;
            v += step * acceleration;
            q += step * v;
        }
    }
    out
}
