//! Effects that are small beside others, or beside noise.

use gimbal_gap::axis::text;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use crate::simulated::{diagnosed, model, names, read};
use crate::simulator::{Path, Truth, log};

#[test]
fn cross_a_small_pre_sliding_beside_a_large_effect_is_not_named_and_a_large_one_is() {
    for (bristle, effects) in [(1.6e-4, &["torque_ripple"][..]), (1e-3, &["torque_ripple", "presliding"])] {
        let truth = Truth { bristle, ripple: vec![(400.0, 30.0, 0.4)], ..Truth::nominal() };
        let diagnosis = diagnosed(&truth, Path::Sines, 5);
        assert_eq!(names(&diagnosis), effects, "{bristle}: {}", text(&diagnosis));
        let is_told = diagnosis.notes.iter().any(|note| note.starts_with("presliding") && note.ends_with("not named"));
        assert_eq!(is_told, effects.len() == 1, "{:?}", diagnosis.notes);
    }
}

#[test]
fn cross_a_ripple_that_noise_hides_in_the_wide_band_is_told_in_narrower_ones() {
    let truth = Truth { ripple: vec![(100.0, 5.0, 0.4)], ..Truth::nominal() };
    let quiet = log(&truth, Path::Sines, 24.0, 5);
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let mut noise_m = 0.0;
    let mut noisy = String::from("t,x,v,f,code\n");
    for line in quiet.lines().skip(1) {
        let (time, rest) = line.split_once(',').expect("columns");
        let (position, rest) = rest.split_once(',').expect("columns");
        let step: f64 = StandardNormal.sample(&mut random);
        noise_m = 0.9 * noise_m + 1.3e-6 * step;
        let position_m = position.parse::<f64>().expect("a number") + noise_m;
        noisy.push_str(&format!("{time},{position_m:.9},{rest}\n"));
    }
    let diagnosis = gimbal_gap::axis::diagnose(read(&noisy), &model(), Vec::new());
    assert_eq!(names(&diagnosis), ["torque_ripple"], "{}", text(&diagnosis));
}
