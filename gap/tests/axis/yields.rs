//! What yields a little at a time: friction by Maxwell's elements, a cable by stops of many widths.
//!
//! ```text
//! effort = J a + B v + Fc sgn v + sum f_i z_i        dz_i = dq / d_i, |z_i| <= 1
//! ```

use std::fmt::Write;
use std::path::Path as File;

use gimbal_gap::axis::{AxisDiagnosis, AxisLog, diagnose, text};
use gimbal_model_file::AxisModel;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use crate::simulated::names;

const MODEL: &str = "[axis]\nmotion = \"linear\"\neffort_unit = \"N\"\ninertia = 2.0\nviscous = 5.0\ncoulomb = 3.0\n\
[axis.columns]\ntime = { name = \"t\", unit = \"s\" }\nposition = { name = \"q\", unit = \"m\" }\n\
effort = { name = \"u\", unit = \"N\" }\n";

/// Displacements of eight elements over their mean, weighed by their shares of the force: no law that the diagnosis has.
const ELEMENTS: [(f64, f64); 8] =
    [(0.11, 0.07), (0.25, 0.15), (0.42, 0.13), (0.7, 0.2), (1.1, 0.15), (1.6, 0.12), (2.1, 0.1), (3.4, 0.08)];

/// The diagnosis of 25 s of sines with such a Coulomb friction, and such elements beside it.
fn diagnosed(coulomb_n: f64, elements_n: f64, displacement_m: f64) -> AxisDiagnosis {
    let mut random = ChaCha8Rng::seed_from_u64(3);
    let mut noise = || -> f64 { StandardNormal.sample(&mut random) };
    let position = |t: f64| 0.06 * (2.1 * t).sin() + 0.02 * (7.3 * t).sin() + 0.03 * (3.7 * t).cos();
    let (mut last, mut states) = (position(0.0), [0.0_f64; 8]);
    let mut out = String::from("t,q,u\n");
    for row in 0..25_000 {
        let t = 1e-3 * f64::from(row);
        let (before, now, after) = (position(t - 1e-4), position(t), position(t + 1e-4));
        let (rate, acceleration) = ((after - before) / 2e-4, (after - 2.0 * now + before) / 1e-8);
        let mut share = 0.0;
        for (state, (yields, part)) in states.iter_mut().zip(ELEMENTS) {
            *state = (*state + (now - last) / (yields * displacement_m)).clamp(-1.0, 1.0);
            share += part * *state;
        }
        last = now;
        let effort = 2.04 * acceleration + 4.9 * rate + coulomb_n * (rate / 1e-3).tanh() + elements_n * share;
        let _ = writeln!(out, "{t:.4},{:.8},{:.4}", now + 2e-7 * noise(), effort + 0.05 * noise());
    }
    let model = AxisModel::parse(MODEL, "axis.toml").expect("reads").expect("an axis");
    diagnose(AxisLog::read(out.as_bytes(), File::new("simulated.csv"), &model).expect("reads"), &model, Vec::new())
}

#[test]
fn cross_a_cable_of_stops_of_many_widths_is_one_effect() {
    let diagnosis = diagnosed(3.1, 1.5, 0.02);
    assert_eq!(names(&diagnosis), ["cable_hysteresis"], "{}", text(&diagnosis));
}

#[test]
fn cross_friction_of_elements_that_yield_one_after_the_other_is_pre_sliding_alone() {
    let diagnosis = diagnosed(0.0, 3.1, 0.008);
    assert_eq!(names(&diagnosis), ["presliding"], "{}", text(&diagnosis));
}
