//! Runs whose bits are frozen: inputs by `+ - * /` alone, so that every host makes the same rows.

use std::fmt::Write;

use gimbal_plant::Row;
use gimbal_servo::effects::Config as Effects;
use gimbal_servo::paper::STANDARD_GRAVITY_MPS2 as G;
use gimbal_servo::{Config, Digest, Fixed, Input, Law, Number, Output};

use crate::axis::{Axis, System, si};
use crate::inputs::{at_period, bare, friction_profile, held, torque_jumps, torque_step, torques, unbalance_profile};
use crate::random::Random;

// the boards' cases have the same
#[allow(unreachable_pub, reason = "a module of the firmware")]
#[path = "../../firmware/src/effects.rs"]
mod sizes;

pub use sizes::all as all_effects;

/// One frozen run.
#[derive(Debug, Clone)]
pub struct Case {
    /// As in the file of reference digests.
    pub name: &'static str,
    /// The axis.
    pub config: Config,
    /// What it does beside the nominal equations, where the law with effects runs.
    pub effects: Option<Effects>,
    /// Its inputs.
    pub rows: Vec<Row>,
}

/// All of them.
#[must_use]
pub fn cases() -> Vec<Case> {
    let case = |name, config, rows| Case { name, config, effects: None, rows };
    let corrected = |name, effects, rows| Case { name, config: Config::consistent(), effects: Some(effects), rows };
    let consistent = Config::consistent();
    let mut coupled = consistent;
    coupled.gyro.cross_coupling = true;
    vec![
        case("step-3e5", bare(consistent), torque_step(3e5, 2.0, 1e-3)),
        case("unbalance-20g", consistent.without_friction(), unbalance_profile(20.0, 1e-3)),
        case("friction-20g", consistent.without_unbalance(), friction_profile(20.0, 1e-3)),
        case("stop-to-stop", held(bare(consistent)), torques(&torque_jumps(0.04, 10_000, 1e-3, 1))),
        case("noise", consistent, noise(5_000, 2)),
        case("noise-coupled", coupled, noise(5_000, 3)),
        case("noise-as-printed-4ms", at_period(Config::as_printed(), 4e-3), noise(5_000, 4)),
        case("noise-250us", at_period(consistent, 0.25e-3), noise(5_000, 5)),
        corrected("noise-all-effects", all_effects(), noise(5_000, 2)),
        corrected("noise-three-effects", sizes::three(), noise(5_000, 2)),
        corrected("stop-to-stop-all-effects", all_effects(), torques(&torque_jumps(0.04, 10_000, 1e-3, 1))),
    ]
}

/// Every input a random walk of its own.
fn noise(count: usize, seed: u64) -> Vec<Row> {
    let mut random = Random::new(seed);
    let mut row = Row::default();
    let walk = |value: f64, size: f64, random: &mut Random| 0.99 * value + 0.1 * size * random.normal();
    (0..count)
        .map(|_| {
            row.accel_x_mps2 = walk(row.accel_x_mps2, 5.0 * G, &mut random);
            row.accel_y_mps2 = walk(row.accel_y_mps2, 5.0 * G, &mut random);
            row.accel_z_mps2 = walk(row.accel_z_mps2, 5.0 * G, &mut random);
            row.vehicle_rate_radps = walk(row.vehicle_rate_radps, 0.2, &mut random);
            row.torque_nm = walk(row.torque_nm, 2e-3, &mut random);
            row.spin_rate_radps = walk(row.spin_rate_radps, 0.1, &mut random);
            row
        })
        .collect()
}

impl Case {
    /// Digest of every output and of the state that is left.
    ///
    /// # Panics
    /// If the configuration does not build.
    #[must_use]
    pub fn digest(&self, system: System) -> u64 {
        match system {
            System::F32 => self.digest_in::<f32>(),
            System::Fixed => self.digest_in::<Fixed>(),
        }
    }

    fn digest_in<N: Number>(&self) -> u64 {
        let mut digest = Digest::default();
        if let Some(effects) = &self.effects {
            let law = self.config.build_with::<N>(effects).expect("effects that build");
            let mut state = law.start();
            self.add_outputs(&mut digest, law.axis(), |row| law.step(&mut state, row));
            digest.add(&law.axis().save(state.axis()));
        } else {
            let Axis { law, mut state } = Axis::<N>::new(&self.config).expect("a configuration that builds");
            self.add_outputs(&mut digest, &law, |row| law.step(&mut state, row));
            digest.add(&law.save(&state));
        }
        digest.value()
    }

    fn add_outputs<N: Number>(&self, digest: &mut Digest, axis: &Law<N>, mut step: impl FnMut(Input<N>) -> Output<N>) {
        for row in &self.rows {
            digest.add_output(&step(axis.units().input(&si(row))));
        }
    }
}

/// One line a run: name, number system, digest.
#[must_use]
pub fn lines() -> String {
    let mut text = String::new();
    for case in cases() {
        for system in System::BOTH {
            let digest = case.digest(system);
            writeln!(text, "{} {} {digest:016x}", case.name, system.name()).expect("a string takes all");
        }
    }
    text
}
