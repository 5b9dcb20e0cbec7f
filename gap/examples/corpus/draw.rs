//! Values of an effect by its size: signs and shapes drawn, inside the realistic ranges of the plant's table.

use std::f64::consts::TAU;

use gimbal_plant::{Bound, Effect};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

/// An effect whose size is still open.
#[derive(Debug, Clone)]
pub(crate) struct Drawn {
    pub(crate) effect: Effect,
    sign: f64,
    /// Direction of an effect with two sizes.
    angle_rad: f64,
    shapes: Vec<f64>,
    /// Largest torque without the effect [N m]: a ceiling has its size against it.
    peak_torque_nm: f64,
}

fn between_logs(rng: &mut ChaCha8Rng, low: f64, high: f64) -> f64 {
    low * (high / low).powf(rng.random::<f64>())
}

impl Drawn {
    pub(crate) fn new(effect: Effect, peak_torque_nm: f64, seconds: f64, rng: &mut ChaCha8Rng) -> Self {
        let first = effect.parameters()[0];
        let either = first.bound == Bound::Any && first.low < 0.0;
        let sign = if either && rng.random::<bool>() { -1.0 } else { 1.0 };
        let angle_rad = TAU * rng.random::<f64>();
        let shapes = effect.parameters()[effect.sizes()..]
            .iter()
            .map(|shape| match shape.name {
                "phase_rad" => shape.low + (shape.high - shape.low) * rng.random::<f64>(),
                "cycles_per_revolution" => between_logs(rng, shape.low, shape.high).round(),
                // no slower than the log is long
                "time_constant_s" => between_logs(rng, shape.low, shape.high.min(seconds)),
                _ => between_logs(rng, shape.low, shape.high),
            })
            .collect();
        Self { effect, sign, angle_rad, shapes, peak_torque_nm }
    }

    /// The values of the effect at a size: that of its first parameter; a share for a ceiling of the torque,
    /// `limit = peak / (1 + size)`.
    pub(crate) fn values(&self, size: f64) -> Vec<f64> {
        let mut values = match self.effect.name() {
            "torque_saturation" => vec![self.peak_torque_nm / (1.0 + size)],
            _ if self.effect.sizes() == 2 => vec![size * self.angle_rad.cos(), size * self.angle_rad.sin()],
            _ => vec![self.sign * size],
        };
        values.extend(&self.shapes);
        values
    }

    /// The end of the realistic range.
    pub(crate) fn largest(&self) -> f64 {
        let first = self.effect.parameters()[0];
        match self.effect.name() {
            "torque_saturation" => 0.5,
            _ if self.sign < 0.0 => -first.low,
            _ => first.high,
        }
    }

    /// No size below this is asked for: pre-sliding replaces the clamp however small it is, and the plant finds every step of a
    /// quantised pick-off in time.
    pub(crate) fn least(&self) -> f64 {
        match self.effect.name() {
            "presliding" | "pickoff_quantisation" => self.effect.parameters()[0].low,
            _ => 0.0,
        }
    }

    /// Where a search for the smallest size begins.
    pub(crate) fn typical(&self) -> f64 {
        if self.effect.name() == "torque_saturation" { 0.05 } else { self.effect.parameters()[0].typical.abs() }
    }
}
