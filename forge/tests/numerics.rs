//! The integrator against itself with finer steps: d, the norm of the difference over the noise that a log carries,
//! stays below 5 in 60 s.
//!
//! Fixed-step Runge-Kutta of order 4 at 20 kHz. The fastest part of the nominal loop is the motor lag with 1000 1/s
//! and friction inside its clamp with up to 750 1/s, so the local error of a smooth step is (0.05)^5/120; what limits
//! is the corner of the clamp, passed without being located.

use gimbal_forge::effects::{Effect, World};
use gimbal_forge::excitation::Excitation;
use gimbal_forge::scene::{Outputs, Scene};
use gimbal_forge::sensors::Sensors;
use gimbal_forge::{Draw, Row, Sample, Track, Truth};
use gimbal_servo::Config;

/// Steps a row of the logs that are handed out.
const HANDED_OUT: usize = 20;
/// Steps a row of the converged solution.
const CONVERGED: usize = 80;
/// The quietest pick-off and torque measurement that are drawn [rad, N m].
const NOISE: [f64; 2] = [1.5e-7, 1e-5];

fn outputs(samples: &[Sample]) -> Outputs {
    Scene::outputs(&World { truth: Truth::new(&Config::consistent()), sensors: Sensors::default() }, samples)
}

fn d(scene: &Scene, truth: &Truth) -> f64 {
    let with = |steps: usize| outputs(&scene.run(truth, &scene.track, steps));
    let (coarse, fine) = (with(HANDED_OUT), with(CONVERGED));
    let mut sum = 0.0;
    for (channel, noise) in NOISE.iter().enumerate() {
        for (a, b) in coarse[channel].iter().zip(&fine[channel]) {
            sum += ((a - b) / noise) * ((a - b) / noise);
        }
    }
    sum.sqrt()
}

fn scene(excitation: Excitation, rows: usize) -> Scene {
    let mut draw = Draw::new(&Draw::seed_of(11), 0);
    Scene { track: excitation.track(rows, None, &mut draw), before: 0 }
}

#[test]
fn closed_form_the_nominal_platform_converges_below_the_noise() {
    let truth = Truth::new(&Config::consistent());
    for excitation in [Excitation::RateTable, Excitation::Boost, Excitation::Manoeuvre, Excitation::CaptiveCarry] {
        let d = d(&scene(excitation, 60_000), &truth);
        println!("{}: d = {d:.3} in 60 s", excitation.name());
        assert!(d < 5.0, "{}: {d}", excitation.name());
    }
}

#[test]
fn closed_form_the_servo_takes_noise_of_the_pickoff_for_motion() {
    let mut truth = Truth::new(&Config::consistent());
    // what never changes is driven to zero: float and gimbal stand where the pick-off is off the other way
    let (rows, off_rad) = (6000, 1e-5);
    truth.drive.noise_rad = vec![off_rad; rows];
    let still = Scene { track: Track { period_s: 1e-3, rows: vec![Row::default(); rows] }, before: 0 };
    let last = *still.run(&truth, &still.track, HANDED_OUT).last().expect("rows");
    let gyro = truth.config.gyro;
    let stands_rad = -off_rad * gyro.damping_nm_s_per_rad / gyro.angular_momentum_nm_s;
    assert!((last.gimbal_angle_rad / stands_rad - 1.0).abs() < 1e-3, "{} {stands_rad}", last.gimbal_angle_rad);
    assert!(last.gyro_angle_rad.abs() < 1e-3 * off_rad, "{}", last.gyro_angle_rad);
    // and the steps are fine enough for what it does from row to row
    let scene = scene(Excitation::Manoeuvre, 20_000);
    let mut draw = Draw::new(&Draw::seed_of(12), 0);
    truth.drive.noise_rad = (0..20_000).map(|_| 6e-7 * draw.normal()).collect();
    let d = d(&scene, &truth) * 3.0_f64.sqrt();
    println!("noise in the loop: d = {d:.3} in 60 s");
    assert!(d < 5.0, "{d}");
}

#[test]
fn closed_form_effects_converge_below_the_noise() {
    let scene = scene(Excitation::Manoeuvre, 20_000);
    let base = World { truth: Truth::new(&Config::consistent()), sensors: Sensors::default() };
    let scale = scene.scale(&scene.run(&base.truth, &scene.track, 8));
    // one of each nature: delay, hysteresis, both forms of pre-sliding, two masses, dead zone, ripple, Stribeck
    for (name, size) in [
        ("loop_delay", 2e-4),
        ("cable_hysteresis", 1e-4),
        ("presliding", 1e-4),
        ("flexible_mode", 0.02),
        ("dead_zone", 1e-5),
        ("torque_ripple", 1e-4),
        ("stribeck", 1e-4),
        ("position_dependent_friction", 0.05),
        ("cable_creep", 1e-3),
        ("wheel_hunting", 1e-2),
    ] {
        let mut world = base.clone();
        Effect::plain(name).apply(size, &scale, &mut world);
        // d grows with the root of the time
        let d = d(&scene, &world.truth) * 3.0_f64.sqrt();
        println!("{name}: d = {d:.3} in 60 s");
        assert!(d < 5.0, "{name}: {d}");
    }
}
