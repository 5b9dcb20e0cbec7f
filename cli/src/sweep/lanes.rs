//! Many platforms at once: [`super::trial`]'s runs, side by side through the flight code's batch.

use std::array::from_fn;

use gimbal_servo::batch::{Batch, Processor, side_by_side};
use gimbal_servo::paper::STANDARD_GRAVITY_MPS2;
use gimbal_servo::{BuildError, Config, Law, Stop};

use super::processor::{self, Work};
use super::trial::{Case, Outcome, PROFILE_G, Root, Spans, free_law};

/// Platforms side by side.
pub(crate) const LANES: usize = 32;

/// What a platform comes to: its run at an acceleration, and the acceleration at which it saturates [g].
pub(super) type Found = (Outcome, Option<f64>);

/// A platform with its laws: as it is, and with its stops out of reach.
struct Lane<'a> {
    config: &'a Config,
    law: Law<f32>,
    free: Law<f32>,
    stop_rad: f64,
}

/// A run of every lane.
struct Runs<'a> {
    laws: [&'a Law<f32>; LANES],
    case: Case,
    accel_g: [f64; LANES],
    period_s: f64,
}

impl Work for Runs<'_> {
    type Output = [Outcome; LANES];

    fn on(self, processor: impl Processor) -> [Outcome; LANES] {
        let Self { laws, case, accel_g, period_s } = self;
        let mut batch = Batch::new(laws);
        let (mut peak_phi, mut peak_theta) = ([0.0_f32; LANES], [0.0_f32; LANES]);
        let mut limited = [false; LANES];
        let mut first = 0;
        // Rows change at the same instants for every acceleration but zero.
        for (_, count) in Spans::new(case, PROFILE_G, period_s) {
            let rows =
                side_by_side(&from_fn(|lane| laws[lane].units().input(&case.row(accel_g[lane], first, period_s))));
            for _ in 0..count {
                let output = batch.step_on(processor, &rows);
                processor.run(|| {
                    raise(&mut peak_phi, output.gimbal_angle_rad);
                    raise(&mut peak_theta, output.gyro_angle_rad);
                });
                for (limited, stop) in limited.iter_mut().zip(output.stop) {
                    *limited |= *stop != Stop::Free;
                }
            }
            first += count;
        }
        from_fn(|lane| {
            let [x, y] = laws[lane].velocity_error_mps(&batch.state(lane));
            Outcome {
                peak_gimbal_angle_rad: f64::from(peak_phi[lane]),
                peak_gyro_angle_rad: f64::from(peak_theta[lane]),
                velocity_error_mps: x.hypot(y),
                limited: limited[lane],
            }
        })
    }
}

/// Raises peaks to absolute values.
#[inline(always)]
fn raise(peaks: &mut [f32; LANES], values: &[f32; LANES]) {
    for (peak, value) in peaks.iter_mut().zip(values) {
        let size = value.abs();
        *peak = if size > *peak { size } else { *peak };
    }
}

/// The runs of at most [`LANES`] platforms of one period; an error where no law can be built.
pub(super) fn run(configs: &[Config], case: Case, accel_g: f64) -> Vec<Result<Found, BuildError>> {
    let mut results = Vec::with_capacity(configs.len());
    let mut lanes = Vec::with_capacity(configs.len());
    for config in configs {
        let built = case.config(config).build::<f32>().and_then(|law| Ok((law, free_law(config, case)?)));
        results.push(built.map(|(law, (free, stop_rad))| lanes.push(Lane { config, law, free, stop_rad })));
    }
    let found = if lanes.is_empty() { Vec::new() } else { all(&lanes, case, accel_g) };
    let mut found = found.into_iter();
    results.into_iter().map(|built| built.map(|()| found.next().expect("as many as were built"))).collect()
}

/// The runs of platforms whose laws are built.
fn all(platforms: &[Lane<'_>], case: Case, accel_g: f64) -> Vec<Found> {
    // Lanes to spare repeat the last platform.
    let lanes: [&Lane<'_>; LANES] = from_fn(|lane| &platforms[lane.min(platforms.len() - 1)]);
    let period_s = lanes[0].config.period_s;
    let runs = |laws, accel_g| processor::on_this(Runs { laws, case, accel_g, period_s });
    let outcomes = runs(lanes.map(|lane| &lane.law), [accel_g; LANES]);
    let mut roots = lanes.map(|lane| Root::new(lane.config.range.radial_accel_mps2 / STANDARD_GRAVITY_MPS2));
    while roots.iter().any(|root| root.asks().is_some()) {
        let asked_g = roots.map(|root| root.asks().unwrap_or(accel_g));
        let outcomes = runs(lanes.map(|lane| &lane.free), asked_g);
        for ((root, outcome), lane) in roots.iter_mut().zip(outcomes).zip(lanes) {
            if root.asks().is_some() {
                root.take(outcome.peak_gyro_angle_rad / lane.stop_rad - 1.0);
            }
        }
    }
    outcomes.into_iter().zip(roots.map(|root| root.found())).take(platforms.len()).collect()
}

#[cfg(test)]
mod tests {
    use gimbal_servo::Config;

    use super::super::trial::{self, Case};

    /// Platforms that differ, one of which cannot be built, at an acceleration that takes some to their stops.
    #[test]
    fn cross_lanes_come_to_what_single_runs_come_to() {
        let mut configs: Vec<Config> = (0..5)
            .map(|k| {
                let mut config = Config::consistent();
                config.servo.gain_nm_per_rad_s *= 1.0 + 0.05 * f64::from(k);
                config.gyro.stop_angle_rad *= 1.0 + 0.2 * f64::from(k);
                config
            })
            .collect();
        configs[2].servo.gain_nm_per_rad_s *= 1000.0;
        for case in [Case::Unbalance, Case::Friction, Case::Both] {
            let found = super::run(&configs, case, 25.0);
            assert!(found[2].is_err());
            for (config, found) in configs.iter().zip(found) {
                let Ok((outcome, limit_g)) = found else {
                    assert!(trial::run(config, case, 25.0).is_err());
                    continue;
                };
                assert_eq!(outcome, trial::run(config, case, 25.0).expect("it was built"));
                assert_eq!(limit_g, trial::saturation_g(config, case).expect("it was built"));
            }
        }
    }
}
