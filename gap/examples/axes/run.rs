//! Loop, drive and sensors around the plant, and the log that they leave.

use std::fmt::Write;

use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};

use super::draw::{Axis, Law, STEP_S, TOLERANCE, rng};
use super::effect::{Kind, State};
use super::path::Path;
use super::plant::Plant;

/// What a run leaves: truth at the rows, and the log's text.
#[derive(Debug)]
pub struct Run {
    pub rows: Vec<State>,
    pub text: String,
    /// Share of the rows at the drive's limit.
    pub clipped: f64,
}

/// Gains of the loop: position, rate; of an ideal axis without friction.
pub fn gains(axis: &Axis) -> (f64, f64) {
    let w = axis.loop_radps;
    match axis.law {
        Law::Pd | Law::Pid => (axis.inertia * w * w, 1.6 * axis.inertia * w),
        Law::Cascade => (0.25 * w * axis.inertia * w, axis.inertia * w),
        Law::Rate => (0.0, axis.inertia * w),
    }
}

/// Whether the model file may know the law: it has no integral and its effort is logged as it is given.
pub fn law_known(axis: &Axis) -> bool {
    axis.law_known && axis.held && axis.integral == 0.0 && (axis.position || axis.law == Law::Rate)
}

/// The model file of an axis.
pub fn model(axis: &Axis) -> String {
    let [inertia, viscous, coulomb] = axis.nominal;
    let (motion, length) = if axis.rotary { ("rotary", "rad") } else { ("linear", "m") };
    let mut out = format!(
        "[axis]\nmotion = \"{motion}\"\neffort_unit = \"{}\"\ninertia = {inertia:e}\nviscous = {viscous:e}\n\
         coulomb = {coulomb:e}\neffort_limit = {:e}\neffort_held = {}\n[axis.tolerance]\ninertia = {}\nviscous = {}\n\
         coulomb = {}\n",
        axis.unit, axis.limit, axis.held, TOLERANCE[0], TOLERANCE[1], TOLERANCE[2]
    );
    if law_known(axis) {
        let (kp, kv) = gains(axis);
        let _ = write!(
            out,
            "[axis.controller]\noutput = \"effort\"\nposition_gain = {:e}\nvelocity_gain = {:e}\n",
            kp * axis.gain_off,
            kv * axis.gain_off
        );
    }
    let mut column = |key: &str, name: &str, unit: &str| {
        let _ = writeln!(out, "{key} = {{ name = \"{name}\", unit = \"{unit}\" }}");
    };
    column("[axis.columns]\ntime", "t", "s");
    if axis.position {
        column("position", "q", length);
    }
    if axis.velocity {
        column("velocity", "v", &format!("{length}/s"));
    }
    if axis.law == Law::Rate {
        column("velocity_reference", "r", &format!("{length}/s"));
    } else {
        column("position_reference", "r", length);
    }
    column("effort", "u", axis.unit);
    if axis.load {
        column("[axis.columns.auxiliary]\nload", "load", "1");
    }
    out
}

fn fault(axis: &Axis, kind: Kind) -> Option<f64> {
    axis.terms.iter().find(|term| term.kind == kind).map(|term| term.size)
}

/// Runs an axis along a path; `stream` of its noise.
#[allow(clippy::too_many_lines, reason = "one step of loop and sensors after the other")]
pub fn run(axis: &Axis, path: &Path, stream: u64) -> Run {
    let mut noise = rng(axis.seed, stream);
    let mut normal = move || -> f64 { StandardNormal.sample(&mut noise) };
    let mut dice = rng(axis.seed, 1000 + stream);
    let (mut load, mut load_until) = (0.0, 0.8);
    let mut plant = Plant::new(axis);
    let (kp, kv) = gains(axis);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a count of steps")]
    let steps = (axis.seconds / STEP_S) as usize;
    let period = axis.loop_every as f64 * STEP_S;
    let filter = 1.0 - (-period * (6.0 * axis.loop_radps).max(600.0)).exp();
    let (mut integral, mut last, mut difference) = (0.0, 0.0, 0.0);
    let mut queue = vec![0.0; axis.delay + 1];
    let (mut force, mut wander) = (0.0, 0.0);
    let force_rate = std::f64::consts::TAU * 6.0 * STEP_S;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few rows")]
    let late_rows = fault(axis, Kind::VelocityDelay).map_or(0, |s| (s / STEP_S) as usize);
    let mut past = vec![0.0; late_rows + 1];
    let (mut rows, mut text) = (Vec::new(), String::from("t,q,v,r,u,load\n"));
    let (mut u, mut clipped) = (0.0, 0usize);
    for step in 0..steps {
        let t = step as f64 * STEP_S;
        past[step % (late_rows + 1)] = plant.state.v;
        let seen = past[(step + 1) % (late_rows + 1)];
        if step % axis.loop_every == 0 {
            let before = u;
            let position = axis.counts * ((plant.state.q / axis.counts + axis.position_noise * normal()).round());
            let tacho = plant.state.v + axis.rate_noise * normal();
            let late = seen + (tacho - plant.state.v);
            difference += filter * ((position - last) / period - difference);
            last = position;
            let rate = if axis.velocity { tacho } else { difference };
            let (to, to_rate) = path.at(t, axis.seconds);
            let error = if axis.law == Law::Rate { to_rate - rate } else { to - position };
            let law = if axis.law == Law::Rate { kv * error } else { kp * error - kv * rate };
            let gain = if axis.law == Law::Rate { kv } else { kp };
            let wanted = law + integral;
            let command = wanted.clamp(-axis.limit, axis.limit);
            if (wanted - command).abs() < 1e-12 {
                integral += axis.integral * axis.loop_radps * gain * error * period;
            }
            queue.rotate_right(1);
            queue[0] = command;
            u = queue[axis.delay];
            if step % axis.log_every == 0 {
                wander = 0.98 * wander + 0.2 * normal();
                let logged = if axis.held {
                    (command / axis.effort_step).round() * axis.effort_step
                } else {
                    let sensed = 0.5 * (before + u) + axis.effort_noise * (normal() + 0.5 * wander);
                    (sensed / axis.effort_step).round() * axis.effort_step
                };
                let sign = if fault(axis, Kind::TorqueSign).is_some() { -1.0 } else { 1.0 };
                let factor = fault(axis, Kind::VelocityScale).unwrap_or(1.0);
                let step_of_rate = axis.rate * 2e-5;
                let told_rate = (late / step_of_rate).round() * step_of_rate * factor;
                let reference = if axis.law == Law::Rate { to_rate } else { to };
                let told = sign * logged;
                let _ = writeln!(text, "{t:.5},{position:e},{told_rate:e},{reference:e},{told:e},{load}");
                clipped += usize::from(command.abs() >= axis.limit);
                rows.push(State { u, ..plant.state });
            }
        }
        if t > load_until {
            load = if load == 0.0 { f64::from(dice.random_range(1..4_u8)) } else { 0.0 };
            load_until = t + dice.random_range(0.4..1.6);
        }
        if !axis.load {
            load = 0.0;
        }
        force += force_rate * (-force) + (2.0 * force_rate).sqrt() * normal();
        plant.step(u, t, load, force);
    }
    let clipped = clipped as f64 / rows.len().max(1) as f64;
    Run { rows, text, clipped }
}
