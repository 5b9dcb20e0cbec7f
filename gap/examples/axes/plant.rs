//! The axis in motion: fourth-order Runge-Kutta at 20 kHz, `LuGre` bristles or Maxwell slip blocks.
//!
//! ```text
//! J1 a1 = delivered(u) - B v1 - F - forces - T      J2 a2 = T - B2(v2)
//! LuGre:    dz/dt = (v - |v| z/G)/z0,  F = Fc z + sigma1 dz/dt        G = level/Fc
//! Maxwell:  F = Fc sum e_i,  de_i = w_i dq/d_i clamped to w_i G
//! T: spring and damper, of a backlash beyond its play alone
//! ```

use super::draw::{Axis, STEP_S};
use super::effect::{Kind, State, Term};

/// Slip blocks: their shares, and their displacements over the bristle's.
const BLOCKS: [(f64, f64); 4] = [(0.25, 0.4), (0.25, 0.8), (0.25, 1.2), (0.25, 1.6)];

/// Two masses: inertia of the load, stiffness, damping, half of the play, friction of the load.
#[derive(Debug, Clone, Copy)]
struct Load {
    inertia: f64,
    stiffness: f64,
    damping: f64,
    play: f64,
    friction: f64,
}

/// Its memory.
#[derive(Debug, Clone)]
pub struct Plant<'a> {
    axis: &'a Axis,
    inertia: f64,
    coulomb: f64,
    load: Option<Load>,
    lag_s: f64,
    heat_s: f64,
    heat_effort: f64,
    /// Motor position and rate, bristle, load position and rate, lagged effort.
    x: [f64; 6],
    blocks: [f64; 4],
    pub state: State,
}

fn term(axis: &Axis, kind: Kind) -> Option<&Term> {
    axis.terms.iter().find(|term| term.kind == kind)
}

impl<'a> Plant<'a> {
    pub fn new(axis: &'a Axis) -> Self {
        let mut inertia = axis.inertia + term(axis, Kind::Inertia).map_or(0.0, |t| t.size);
        let mut coulomb = axis.coulomb;
        let mut load = None;
        if let Some(flexible) = term(axis, Kind::Flexible) {
            let own = 0.4 * inertia;
            let stiffness = own * flexible.number * flexible.number;
            let damping = 0.04 * own * flexible.number;
            load = Some(Load { inertia: own, stiffness, damping, play: 0.0, friction: 0.0 });
            inertia -= own;
        }
        if let Some(backlash) = term(axis, Kind::Backlash) {
            let own = backlash.size * inertia;
            let (stiffness, friction) = (own * 1200.0_f64.powi(2), 0.4 * coulomb);
            load = Some(Load {
                inertia: own,
                stiffness,
                damping: 0.6 * own * 1200.0,
                play: 0.5 * backlash.number,
                friction,
            });
            inertia -= own;
            coulomb -= friction;
        }
        Self {
            axis,
            inertia,
            coulomb,
            load,
            lag_s: term(axis, Kind::Lag).map_or(0.0, |t| t.size),
            heat_s: 8.0,
            heat_effort: axis.coulomb + axis.inertia * axis.acceleration,
            x: [0.0; 6],
            blocks: [0.0; 4],
            state: State::default(),
        }
    }

    /// Bristle's displacement: that of the effect, where it is one.
    fn bristle(&self) -> f64 {
        term(self.axis, Kind::Presliding).map_or(self.axis.bristle, |t| t.number)
    }

    /// Friction without its viscous part, and the derivative of the bristle.
    fn friction(&self, x: &[f64; 6], level: f64) -> (f64, f64) {
        let z0 = self.bristle();
        let over = (level / self.coulomb).max(0.05);
        if self.axis.maxwell {
            let moved = x[0] - self.x[0];
            let force: f64 = BLOCKS
                .iter()
                .zip(&self.blocks)
                .map(|((w, d), e)| (e + w * moved / (d * z0)).clamp(-w * over, w * over))
                .sum();
            return (self.coulomb * force, 0.0);
        }
        let dz = (x[1] - x[1].abs() * x[2] / over) / z0;
        let damping = 0.2 * (self.coulomb * self.inertia / z0).sqrt() * z0;
        (self.coulomb * x[2] + damping * dz * (-(x[1] / (0.01 * self.axis.rate)).powi(2)).exp(), dz)
    }

    fn level(&self, state: &State) -> f64 {
        self.coulomb + self.axis.terms.iter().map(|term| term.level(state)).sum::<f64>()
    }

    /// Direction through pre-sliding.
    fn direction(&self, x: &[f64; 6]) -> f64 {
        if self.axis.maxwell {
            // of the last step: blocks move with the position
            (self.blocks.iter().sum::<f64>() + (x[0] - self.x[0]) / self.bristle()).clamp(-1.0, 1.0)
        } else {
            x[2].clamp(-1.0, 1.0)
        }
    }

    fn rates(&self, x: &[f64; 6], u: f64) -> [f64; 6] {
        let mut state = State { q: x[0], v: x[1], s: self.direction(x), u, ..self.state };
        let (effort, du) = if self.lag_s > 0.0 { (x[5], (u - x[5]) / self.lag_s) } else { (u, 0.0) };
        let delivered = self.axis.terms.iter().fold(effort, |u, term| term.delivered(u, &state));
        state.u = delivered;
        let (friction, dz) = self.friction(x, self.level(&state));
        let forces: f64 = self.axis.terms.iter().map(|term| term.force(&state)).sum();
        let mut torque = 0.0;
        let mut a2 = 0.0;
        if let Some(load) = &self.load {
            let gap = x[0] - x[3];
            let deep = gap - gap.clamp(-load.play, load.play);
            if deep != 0.0 || load.play == 0.0 {
                torque = load.stiffness * deep + load.damping * (x[1] - x[4]);
            }
            a2 = (torque - load.friction * (x[4] / (2e-3 * self.axis.rate)).tanh()) / load.inertia;
        }
        let a = (delivered - self.axis.viscous * x[1] - friction - forces - torque) / self.inertia;
        [x[1], a, dz, x[4], a2, du]
    }

    /// One step under an effort; time, load and the random force are those of the step.
    pub fn step(&mut self, u: f64, t: f64, load: f64, random: f64) {
        (self.state.t, self.state.load, self.state.random) = (t, load, random);
        let x = self.x;
        let add = |k: &[f64; 6], h: f64| std::array::from_fn(|i| x[i] + h * k[i]);
        let k1 = self.rates(&x, u);
        let k2 = self.rates(&add(&k1, 0.5 * STEP_S), u);
        let k3 = self.rates(&add(&k2, 0.5 * STEP_S), u);
        let k4 = self.rates(&add(&k3, STEP_S), u);
        let next: [f64; 6] = std::array::from_fn(|i| x[i] + STEP_S / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
        let moved = next[0] - x[0];
        if self.axis.maxwell {
            let over = (self.level(&State { u, ..self.state }) / self.coulomb).max(0.05);
            let z0 = self.bristle();
            for ((w, d), e) in BLOCKS.iter().zip(&mut self.blocks) {
                *e = (*e + w * moved / (d * z0)).clamp(-w * over, w * over);
            }
        }
        if let Some(hysteresis) = term(self.axis, Kind::Hysteresis) {
            self.state.play = (self.state.play + 2.0 * moved / hysteresis.number).clamp(-1.0, 1.0);
        }
        self.state.heat += STEP_S / self.heat_s * ((u / self.heat_effort).powi(2) - self.state.heat);
        self.x = next;
        let s = self.direction(&next);
        self.state = State { q: next[0], v: next[1], a: (next[1] - x[1]) / STEP_S, s, u, ..self.state };
    }
}
