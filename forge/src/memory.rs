//! Parts of the true plant that remember the path of the relative angle.
//!
//! Each is advanced exactly over the displacement since the last committed step; none
//! of them is a differential equation for the integrator, so none is stiff.
//!
//! ```text
//! bristles       dz/d|r| = (c - z)/d                   c: the nominal curve clamp(w/w_s)
//! Maxwell-slip   m_i' = (w - w_s m_i)/d_i, |m_i| <= 1          friction = level * sum weight_i m_i
//! stop operator  e_i <- clamp(e_i + dr/d_i, -1, 1)             torque = sum torque_i e_i
//! snap           the side changes where r passes +-half width against it
//! brush          b <- b + dr/d; at |b| > 1 it slips back to 0.3 of its side
//! ```

use crate::truth::{Presliding, Truth};

/// Share of the torque that is left after a brush has slipped.
const LEFT_AFTER_SLIP: f64 = 0.3;

/// What is remembered.
#[derive(Debug, Clone, Default)]
pub(crate) struct Memory {
    presliding: Vec<f64>,
    cable: Vec<f64>,
    /// Side of the snapping spring.
    pub(crate) side: f64,
    brush: f64,
    /// Relative rate when the memory was committed [rad/s].
    rate_radps: f64,
}

/// Where the relative angle goes within a step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Path {
    /// Displacement since the memory was committed [rad].
    pub(crate) moved_rad: f64,
    /// Time since then [s].
    pub(crate) time_s: f64,
    /// Relative rate now [rad/s].
    pub(crate) rate_radps: f64,
    /// The nominal friction curve now, -1 to 1.
    pub(crate) curve: f64,
    /// Half width of that curve [rad/s].
    pub(crate) slip_radps: f64,
}

fn bristle(before: f64, displacement: f64, path: Path) -> f64 {
    path.curve + (before - path.curve) * libm::exp(-path.moved_rad.abs() / displacement)
}

/// Exact for a rate that runs along a line.
fn maxwell(before: f64, displacement: f64, rate_before: f64, path: Path) -> f64 {
    let stiffness = path.time_s * path.slip_radps / displacement;
    if stiffness <= 0.0 {
        return before;
    }
    let left = libm::exp(-stiffness);
    let mean = -libm::expm1(-stiffness) / stiffness;
    let now = path.rate_radps / path.slip_radps * (1.0 - mean);
    (before * left + now + rate_before / path.slip_radps * (mean - left)).clamp(-1.0, 1.0)
}

fn stop(before: f64, displacement: f64, path: Path) -> f64 {
    (before + path.moved_rad / displacement).clamp(-1.0, 1.0)
}

impl Memory {
    /// Nothing has moved yet.
    #[must_use]
    pub(crate) fn new(truth: &Truth) -> Self {
        let presliding = match &truth.friction.presliding {
            None => 0,
            Some(Presliding::Bristles(_)) => 1,
            Some(Presliding::MaxwellSlip(elements)) => elements.len(),
        };
        Self {
            presliding: vec![0.0; presliding],
            cable: vec![0.0; truth.torque.hysteresis.len()],
            side: 1.0,
            brush: 0.0,
            rate_radps: 0.0,
        }
    }

    /// Friction over its level.
    #[must_use]
    pub(crate) fn friction(&self, kind: Option<&Presliding>, path: Path) -> f64 {
        match kind {
            None => path.curve,
            Some(Presliding::Bristles(displacement)) => bristle(self.presliding[0], *displacement, path),
            Some(Presliding::MaxwellSlip(elements)) => elements
                .iter()
                .zip(&self.presliding)
                .map(|((displacement, weight), before)| weight * maxwell(*before, *displacement, self.rate_radps, path))
                .sum(),
        }
    }

    /// Torque of the cable's stop operators [N m].
    #[must_use]
    pub(crate) fn cable_nm(&self, elements: &[(f64, f64)], path: Path) -> f64 {
        elements
            .iter()
            .zip(&self.cable)
            .map(|((displacement, torque), before)| torque * stop(*before, *displacement, path))
            .sum()
    }

    /// Deflection of the brush, -1 to 1.
    #[must_use]
    pub(crate) fn brush(&self, displacement: f64, path: Path) -> f64 {
        (self.brush + path.moved_rad / displacement).clamp(-1.2, 1.2)
    }

    /// Takes over the end of a step; `relative_rad` is the angle there.
    pub(crate) fn commit(&mut self, truth: &Truth, path: Path, relative_rad: f64) {
        match &truth.friction.presliding {
            None => {}
            Some(Presliding::Bristles(displacement)) => {
                self.presliding[0] = bristle(self.presliding[0], *displacement, path);
            }
            Some(Presliding::MaxwellSlip(elements)) => {
                let rate_before = self.rate_radps;
                for (before, (displacement, _)) in self.presliding.iter_mut().zip(elements) {
                    *before = maxwell(*before, *displacement, rate_before, path);
                }
            }
        }
        self.rate_radps = path.rate_radps;
        for (before, (displacement, _)) in self.cable.iter_mut().zip(&truth.torque.hysteresis) {
            *before = stop(*before, *displacement, path);
        }
        if let Some([_, half_width]) = truth.torque.snap
            && relative_rad * self.side < -half_width
        {
            self.side = -self.side;
        }
        if let Some([_, displacement, _]) = truth.torque.chatter {
            self.brush = self.brush(displacement, path);
            if self.brush.abs() > 1.0 {
                self.brush = LEFT_AFTER_SLIP.copysign(self.brush);
            }
        }
    }
}
