//! A scene with what its instruments show of any world, and what nominal parameters may do about a difference.

use gimbal_servo::Config;

use super::drift::{self, BEGINNING, Drift, NAMES, TURNS};
use crate::detect::{DETECTABLE, Nuisance, Projection, Whitener};
use crate::draw::Draw;
use crate::effects::{Effect, Scale, World, block_of, library_names};
use crate::machine::{Loads, Sample};
use crate::scene::{Outputs, Scene};
use crate::sensors::Noise;

/// Integration steps between rows where only differences count: 4 kHz.
pub(super) const STEPS: usize = 4;
/// An effect that is no shape in time.
pub(super) const QUANTISATION: &str = "pickoff_quantisation";
/// Share of a tolerance over which a sensitivity is taken.
const SENSITIVITY_SHARE: f64 = 0.3;
/// Draws from which the noise floor is taken.
const DRAWS: usize = 6;
/// How often parameters move by their sensitivities to take a change from it, and norm from which on it needs that.
const MOVES: usize = 6;
const LARGE: f64 = 10.0 * DETECTABLE;
/// Share by which what is left changes where they stand still.
const STILL: f64 = 0.02;

/// A scene with its undisturbed run, noise floor and sensitivities.
pub(super) struct Bench<'a> {
    pub(super) scene: &'a Scene,
    pub(super) base: &'a World,
    pub(super) scale: Scale,
    nominal: &'a Config,
    /// Integration steps between rows.
    steps: usize,
    loads: Loads,
    samples: Vec<Sample>,
    pub(super) outputs: Outputs,
    /// The undisturbed plant driven by its own logged inputs.
    logged: Option<Outputs>,
    pub(super) whitener: Whitener,
    nuisances: Vec<Nuisance>,
    /// White noise of the pick-off [rad].
    pub(super) pickoff_rad: f64,
}

fn norm(column: &[f64]) -> f64 {
    column.iter().map(|value| value * value).sum::<f64>().sqrt()
}

fn plus(a: &Outputs, b: &Outputs, sign: f64) -> Outputs {
    core::array::from_fn(|channel| a[channel].iter().zip(&b[channel]).map(|(x, y)| x + sign * y).collect())
}

/// What the instruments show of the undisturbed plant under noisy inputs.
fn noisy(scene: &Scene, base: &World, noise: &Noise, draw: &mut Draw, steps: usize) -> Outputs {
    let (shaken, beside) = scene.shaken(&base.truth, noise, draw);
    let carried = Scene::outputs(base, &scene.run(&shaken, &noise.on_inputs(&scene.track, draw), steps));
    let [torque, gimbal] = [noise.motor_torque_nm, noise.gimbal_angle_rad]
        .map(|white| noise.series(white, scene.rows(), scene.track.period_s, draw));
    plus(&carried, &[beside, torque, gimbal], 1.0)
}

impl<'a> Bench<'a> {
    pub(super) fn new(
        scene: &'a Scene,
        base: &'a World,
        nominal: &'a Config,
        drift: &Drift,
        noise: &Noise,
        used: &[usize],
        draw: &mut Draw,
    ) -> Self {
        Self::with_steps(scene, base, nominal, drift, noise, used, draw, STEPS)
    }

    #[allow(clippy::too_many_arguments)] // what a log is made of, and how finely
    pub(super) fn with_steps(
        scene: &'a Scene,
        base: &'a World,
        nominal: &'a Config,
        drift: &Drift,
        noise: &Noise,
        used: &[usize],
        draw: &mut Draw,
        steps: usize,
    ) -> Self {
        let loads = Loads::new(&base.truth.config.bearing, &scene.track, steps);
        let samples = scene.run_with(&base.truth, &scene.track, steps, Some(&loads));
        let outputs = Scene::outputs(base, &samples);
        let floor: Vec<Outputs> =
            (0..DRAWS).map(|_| plus(&noisy(scene, base, noise, draw, steps), &outputs, -1.0)).collect();
        let whitener = Whitener::new(&floor, used, scene.track.period_s);
        let mut bench = Self {
            scene,
            base,
            scale: scene.scale(&samples),
            nominal,
            steps,
            loads,
            samples,
            outputs,
            logged: None,
            whitener,
            nuisances: Vec::new(),
            pickoff_rad: noise.gyro_angle_rad,
        };
        bench.logged = Some(Scene::outputs(base, &scene.run(&base.truth, &base.sensors.logged(&scene.track), steps)));
        for name in NAMES.into_iter().chain(TURNS).chain([BEGINNING]) {
            // a stop that is never touched has no sensitivity
            if name == "stop_angle" && !bench.samples.iter().any(|sample| sample.on_stop) {
                continue;
            }
            let tolerance = drift::tolerance(name);
            let step = SENSITIVITY_SHARE * tolerance;
            let mut world = base.clone();
            drift::shift(&mut world, nominal, name, step);
            let mut column = bench.difference(&world);
            for value in &mut column {
                *value /= step;
            }
            bench.nuisances.push(Nuisance { column, limits: drift::limits(name, drift.of(name)), name });
        }
        bench
    }

    /// What a world shows against its own logged inputs, as far as the undisturbed plant does not show it too.
    pub(super) fn seen(&self, world: &World) -> Outputs {
        let turned = |world: &World| world.sensors.misalignment_rad.map(f64::to_bits);
        let samples = self.scene.run_with(&world.truth, &self.scene.track, self.steps, Some(&self.loads));
        let shown = Scene::outputs(world, &samples);
        match &self.logged {
            Some(logged)
                if world.sensors.skew_s.to_bits() != self.base.sensors.skew_s.to_bits()
                    || turned(world) != turned(self.base) =>
            {
                let track = world.sensors.logged(&self.scene.track);
                let other = Scene::outputs(self.base, &self.scene.run(&self.base.truth, &track, self.steps));
                plus(&shown, &plus(&other, logged, -1.0), -1.0)
            }
            _ => shown,
        }
    }

    /// Whitened difference of a world from the undisturbed one.
    pub(super) fn difference(&self, world: &World) -> Vec<f64> {
        self.whitener.difference(&self.seen(world), &self.outputs)
    }

    /// Whitened difference of two worlds.
    pub(super) fn between(&self, with: &World, without: &World) -> Vec<f64> {
        self.whitener.difference(&self.seen(with), &self.seen(without))
    }

    /// What the nominal parameters leave of a difference that stands beside others, and what they may still do about it:
    /// where it is large they move first, as it is no line in them.
    pub(super) fn left_by_moving<'p>(
        &self,
        with: &World,
        without: &World,
        projection: &Projection<'p>,
        beside: &[&[f64]],
    ) -> (Vec<f64>, Projection<'p>) {
        let shown = self.seen(with);
        let (mut world, mut projection) = (without.clone(), projection.clone());
        let mut difference = self.whitener.difference(&shown, &self.seen(&world));
        for _ in 0..MOVES {
            let (moves, left) = projection.closest(&difference, beside);
            if left < DETECTABLE || norm(&difference) < LARGE {
                break;
            }
            let mut there = world.clone();
            for (nuisance, by) in projection.nuisances().iter().zip(&moves) {
                drift::shift(&mut there, self.nominal, nuisance.name, *by);
            }
            let (next, after) = (projection.moved(&moves), self.whitener.difference(&shown, &self.seen(&there)));
            let left_there = next.left_with(&after, beside);
            // lines that lead astray
            if left_there >= norm(&difference) {
                break;
            }
            (world, projection, difference) = (there, next, after);
            if (left_there - left).abs() < STILL * left {
                break;
            }
        }
        (difference, projection)
    }

    /// The undisturbed world with one effect.
    pub(super) fn world(&self, effect: &Effect, size: f64) -> World {
        let mut world = self.base.clone();
        effect.apply(size, &self.scale, &mut world);
        world
    }

    /// Everything that the nominal model may do inside its tolerance.
    pub(super) fn projection(&self) -> Projection<'_> {
        Projection::new(self.nuisances.iter().collect())
    }

    /// Whether a world still works: the loop holds and the gyro is not on its stop much more than without.
    pub(super) fn works(&self, world: &World) -> bool {
        let power = |outputs: &Outputs, channel: usize| outputs[channel].iter().map(|v| v * v).sum::<f64>();
        let shown = self.seen(world);
        let grown = |channel: usize| power(&shown, channel) / power(&self.outputs, channel).max(1e-30);
        shown.iter().flatten().all(|value| value.is_finite() && value.abs() < 2.0) && grown(0) < 400.0
    }

    /// Whitened change by a small size of each effect of the table, in its plain shape.
    pub(super) fn tangents(&self) -> Vec<(&'static str, Vec<f64>)> {
        library_names()
            // their changes are not along a line
            .filter(|name| !matches!(*name, QUANTISATION | "stop_angle" | "torque_saturation"))
            .map(|name| {
                if let Some(nuisance) =
                    self.nuisances.iter().find(|nuisance| nuisance.name == name && name != "viscous_friction")
                {
                    return (name, nuisance.column.clone());
                }
                let effect = Effect::plain(name);
                let world = self.world(&effect, 4.0 * effect.range().small);
                let column = if block_of(name) == "measurement" && name != "time_skew" {
                    // the platform moves as it does without
                    self.whitener.difference(&Scene::outputs(&world, &self.samples), &self.outputs)
                } else {
                    self.difference(&world)
                };
                (name, column)
            })
            .filter(|(_, column)| column.iter().map(|value| value * value).sum::<f64>() > 1e-6)
            .collect()
    }
}
