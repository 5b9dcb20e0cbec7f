//! How long a minute of noisy flight takes: `cargo run --release -p gimbal-plant --example pace`.

use std::time::Instant;

use gimbal_plant::{Plant, Row};
use gimbal_servo::{BuildError, Config};

fn main() -> Result<(), BuildError> {
    let mut seed = 1_u64;
    let mut noise = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        f64::from(u32::try_from(seed >> 32).unwrap_or(0)) / f64::from(u32::MAX) - 0.5
    };
    let mut flight = |noise_radps: f64| -> Vec<Row> {
        (0..=60_000)
            .map(|k| {
                let time_s = 1e-3 * f64::from(k);
                Row {
                    accel_x_mps2: 30.0 * (0.7 * time_s).sin() + noise(),
                    accel_y_mps2: 60.0 * (0.31 * time_s).sin() + noise(),
                    accel_z_mps2: 9.8 + noise(),
                    vehicle_rate_radps: 0.3 * (1.9 * time_s).sin() + noise_radps * noise(),
                    ..Row::default()
                }
            })
            .collect()
    };
    let cases = [
        ("free loop", Config::consistent().without_friction(), 0.0),
        ("with friction", Config::consistent(), 0.0),
        ("with friction and rate noise", Config::consistent(), 0.02),
    ];
    for (name, config, noise_radps) in cases {
        let rows = flight(noise_radps);
        for tolerance in [1e-9, 1e-10, 1e-11, 1e-12, 1e-13] {
            let run = |tolerance: f64| -> Result<_, BuildError> {
                let plant = Plant::new(&config)?.with_tolerance(tolerance);
                let mut state = plant.start();
                let angles: Vec<f64> =
                    rows.windows(2).map(|pair| plant.step(&mut state, &pair[0], &pair[1]).gimbal_angle_rad).collect();
                Ok((angles, state.integrator_steps()))
            };
            let start = Instant::now();
            let (angles, steps) = run(tolerance)?;
            let elapsed = start.elapsed().as_secs_f64();
            let (exact, _) = run(1e-15)?;
            let peak = exact.iter().fold(0.0_f64, |peak, angle| peak.max(angle.abs()));
            let error = angles.iter().zip(&exact).fold(0.0_f64, |worst, (a, b)| worst.max((a - b).abs()));
            println!(
                "{name}: tolerance {tolerance:.0e}, {steps} steps, {elapsed:.3} s, error {:.1e} of peak",
                error / peak
            );
        }
    }
    Ok(())
}
