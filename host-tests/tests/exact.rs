//! The free loop under held inputs against exact discretisation in f64.
//!
//! The reference is the matrix exponential of the physical state (`host_tests::exact`), which has neither the library's
//! modes nor its partial fractions.

use gimbal_servo::Config;
use host_tests::axis::System;
use host_tests::figures::exact_errors;
use host_tests::inputs::{bare, held, torque_chirp, torque_jumps};

/// Asked for at 1 ms: 2e-6 of the peak in `f32`, 1e-6 in fixed point.
fn bound(system: System) -> f64 {
    match system {
        System::F32 => 2e-6,
        System::Fixed => 1e-6,
    }
}

/// Accuracy is promised for peaks of phi of 1 mrad and more; at 1.9 mrad theta is near its stop.
fn check(name: &str, torques_nm: &[f64], bound: impl Fn(System) -> f64) {
    for system in System::BOTH {
        for config in [Config::consistent(), Config::as_printed()] {
            for peak_rad in [1e-3, 1.9e-3] {
                let [phi, theta] = exact_errors(system, &held(bare(config)), torques_nm, peak_rad);
                let text = format!("{name} {} {peak_rad} rad: phi {phi:.2e} theta {theta:.2e}", system.name());
                println!("{text}");
                assert!(phi <= bound(system) && theta <= bound(system), "{text}");
            }
        }
    }
}

#[test]
fn cross_a_step_is_exact_over_ten_seconds() {
    check("step", &vec![1.0; 10_001], bound);
}

#[test]
fn cross_a_random_torque_is_exact_over_ten_seconds() {
    for seed in 1..=6 {
        check(&format!("jumps {seed}"), &torque_jumps(1.0, 10_001, 1e-3, seed), bound);
    }
}

/// 0.1 to 200 Hz, through the loop's resonance, which keeps what is rounded off for a few oscillations.
#[test]
fn cross_a_chirp_is_exact_over_ten_seconds() {
    check("chirp", &torque_chirp(1.0, 10_001, 1e-3), bound);
}
