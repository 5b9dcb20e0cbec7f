//! Sizes of effects on one scene: how far one stands out of what tolerances make, and the smallest that does.

use super::bench::{Bench, QUANTISATION};
use super::drift::{self, NAMES};
use crate::detect::{DETECTABLE, Projection};
use crate::effects::{Effect, World};

/// Another effect that is no shape in time.
const RANDOM_TORQUE: &str = "coloured_torque";

impl Bench<'_> {
    /// Of an effect's size, what is no gap by itself: a drifting parameter up to its tolerance, exactly, where the
    /// sensitivities are but lines.
    pub(super) fn no_gap(effect: &Effect, size: f64) -> f64 {
        if !NAMES.contains(&effect.name) || matches!(effect.name, "viscous_friction" | "mass_unbalance") {
            return 0.0;
        }
        size.min(drift::tolerance(effect.name))
    }

    /// The world with an effect beyond that, and the one with what is no gap of it.
    pub(super) fn beyond(&self, effect: &Effect, size: f64) -> (World, World) {
        let inside = Self::no_gap(effect, size);
        let without = if inside > 0.0 { self.world(effect, inside) } else { self.base.clone() };
        (self.world(effect, size), without)
    }

    /// Whitened change by an effect beyond that.
    pub(super) fn change(&self, effect: &Effect, size: f64) -> Vec<f64> {
        let (with, without) = self.beyond(effect, size);
        self.between(&with, &without)
    }

    /// d of what is no shape in time: how far its power stands out of the noise. Where a quantised pick-off is rounded to
    /// nobody knows, unless the angle were known to a fraction of a step, and nobody knows the course of a random torque:
    /// the difference itself tells nothing.
    pub(super) fn by_power(&self, effect: &Effect, size: f64) -> Option<f64> {
        match effect.name {
            QUANTISATION => {
                let rows = self.outputs[0].len() as f64;
                Some(size * size / (12.0 * self.pickoff_rad * self.pickoff_rad) * (0.5 * rows).sqrt())
            }
            RANDOM_TORQUE => Some(self.whitener.power_of(&self.seen(&self.world(effect, size)), &self.outputs)),
            _ => None,
        }
    }

    /// d of an effect by itself.
    fn d_of(&self, effect: &Effect, size: f64, projection: &Projection<'_>) -> f64 {
        if let Some(d) = self.by_power(effect, size) {
            return d;
        }
        let (with, without) = self.beyond(effect, size);
        let (difference, projection) = self.left_by_moving(&with, &without, projection, &[]);
        let left = projection.left_of(&difference);
        if left.is_finite() { left } else { f64::INFINITY }
    }

    /// Size with d = 5, if there is one in the range that makes sense.
    pub(super) fn detectable_size(&self, effect: &Effect, projection: &Projection<'_>) -> Option<f64> {
        let range = effect.range();
        let mut size = range.small;
        let mut d = self.d_of(effect, size, projection);
        let (mut low, mut high) = (None, None);
        for _ in 0..14 {
            if d < DETECTABLE {
                low = Some((size, d));
            } else {
                high = Some((size, d));
            }
            let next = match (low, high) {
                (Some((size, d)), None) if size < range.largest => {
                    let factor = if d > 0.5 { (1.3 * DETECTABLE / d).clamp(1.4, 6.0) } else { 6.0 };
                    (size * factor).min(range.largest)
                }
                (_, None) => return None,
                (None, Some((size, d))) => size * (0.7 * DETECTABLE / d).clamp(1e-3, 0.6),
                (Some((small, less)), Some((large, more))) => {
                    if large / small < 1.03 || (more - less).abs() < 0.2 {
                        break;
                    }
                    if less > 0.5 && more.is_finite() {
                        let part = (DETECTABLE - less) / (more - less);
                        small + (large - small) * part.clamp(0.05, 0.95)
                    } else {
                        (small * large).sqrt()
                    }
                }
            };
            if next < 1e-4 * range.small {
                break;
            }
            size = next;
            d = self.d_of(effect, size, projection);
            if (d - DETECTABLE).abs() < 0.05 {
                return Some(size);
            }
        }
        match (low, high) {
            (Some((small, less)), Some((large, more))) => {
                let part = ((DETECTABLE - less) / (more - less)).clamp(0.0, 1.0);
                Some(small + (large - small) * if part.is_finite() { part } else { 0.5 })
            }
            (None, Some((size, _))) => Some(size),
            (_, None) => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use gimbal_servo::Config;

    use super::*;
    use crate::corpus::bench::STEPS;
    use crate::corpus::drift::Drift;
    use crate::draw::Draw;
    use crate::excitation::Excitation;
    use crate::scene::Scene;
    use crate::sensors::Noise;

    /// A manoeuvre, where its parameters lie, and the noise of its instruments.
    fn drawn(seed: u64) -> (Scene, Drift, Noise, Draw) {
        let mut draw = Draw::new(&Draw::seed_of(seed), 0);
        let scene = Scene { track: Excitation::Manoeuvre.track(8000, None, &mut draw), before: 0 };
        let (drift, noise) = (Drift::draw(&mut draw, &[]), Noise::draw(&mut draw));
        (scene, drift, noise, draw)
    }

    #[test]
    fn closed_form_parameters_within_their_tolerance_leave_nothing_however_they_bend_what_is_seen() {
        let (scene, drift, noise, mut draw) = drawn(32);
        let nominal = Config::consistent();
        let base = drift.world(&nominal);
        let bench = Bench::new(&scene, &base, &nominal, &drift, &noise, &[0, 1], &mut draw);
        let mut with = base.clone();
        for name in ["angular_momentum", "gyro_damping", "gimbal_inertia", "loop_gain", "friction_level"] {
            drift::shift(&mut with, &nominal, name, 0.9 * drift::tolerance(name) - drift.of(name));
        }
        let projection = bench.projection();
        let line = projection.left_of(&bench.between(&with, &base));
        let (difference, moved) = bench.left_by_moving(&with, &base, &projection, &[]);
        let left = moved.left_of(&difference);
        assert!(line > DETECTABLE && left < 0.3 * DETECTABLE, "{line} {left}");
    }

    #[test]
    fn what_the_integrator_carries_is_not_seen_without_the_torque() {
        let (scene, drift, noise, draw) = drawn(33);
        let nominal = Config::consistent();
        let base = drift.world(&nominal);
        let size = |used: &[usize]| {
            let bench = Bench::new(&scene, &base, &nominal, &drift, &noise, used, &mut draw.clone());
            bench.detectable_size(&Effect::plain("constant_torque"), &bench.projection())
        };
        assert!(size(&[0, 1]).is_some() && size(&[0]).is_none(), "{:?} {:?}", size(&[0, 1]), size(&[0]));
    }

    #[test]
    fn cross_sizes_are_those_of_the_steps_of_the_logs() {
        let (scene, drift, noise, draw) = drawn(31);
        let nominal = Config::consistent();
        let base = drift.world(&nominal);
        let sizes = |steps: usize| -> Vec<f64> {
            let mut own = draw.clone();
            let bench = Bench::with_steps(&scene, &base, &nominal, &drift, &noise, &[0, 1], &mut own, steps);
            let projection = bench.projection();
            // the fastest parts: two masses, a delay, pre-sliding, a dead zone; and a slow one
            ["flexible_mode", "loop_delay", "presliding", "dead_zone", "cable_spring"]
                .iter()
                .filter_map(|name| bench.detectable_size(&Effect::plain(name), &projection))
                .collect()
        };
        let (coarse, fine) = (sizes(STEPS), sizes(crate::corpus::case::FINE_STEPS));
        println!("{coarse:?}\n{fine:?}");
        assert_eq!(coarse.len(), 5);
        for (a, b) in coarse.iter().zip(&fine) {
            assert!((a / b - 1.0).abs() < 0.03, "{a} {b}");
        }
    }
}
