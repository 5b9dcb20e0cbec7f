//! `pickoff_quantisation` as a converter makes it of an angle that has its noise already: every sample is a multiple of the
//! step, however fine that is. What is on a grid by how many digits were written is not told.

use crate::record::{phase, whole_step};

/// Of the gaps between neighbouring angles, the one that is taken for the step, and how far from a whole number of steps a gap
/// may be.
const SMALL: f64 = 0.1;
const OFF: f64 = 0.02;
/// What is less than this share of the noise is how numbers are written.
const WRITTEN: f64 = 1e-4;
/// Standard deviations of the noise's power that a step adds to it, to be told; and its least size over the noise: what is
/// no larger is the least count of a log, as every log has one.
const SHOWN: f64 = 6.0;
const LEAST_COUNT: f64 = 1.3;
/// A step that divides a power of ten by one of two, as converters of so many bits do over a full scale of 1, 2 or 5 units, is
/// the log's up to so many noises; and any step below this, where the realistic ones of a pick-off begin [rad].
const CONVERTED: f64 = 5.0;
const FINEST_RAD: f64 = 1e-6;
const BITS: std::ops::RangeInclusive<i32> = 10..=20;
/// Fewest gaps.
const LEAST: usize = 20;

/// Whether a step adds to the noise of the rows that count.
pub(super) fn adds_to_noise(step_rad: f64, valid: &[bool], noise_rad: f64) -> bool {
    let rows = valid.iter().filter(|valid| **valid).count() as f64;
    let over = step_rad / noise_rad;
    over > LEAST_COUNT && (rows / 2.0).sqrt() * over * over / 12.0 > SHOWN
}

/// The step on whose multiples all angles lie, whatever its size, but for that of written digits [rad].
#[must_use]
pub(super) fn multiples_of(theta: &[f64], valid: &[bool], noise_rad: f64) -> Option<f64> {
    let mut angles: Vec<f64> = theta.iter().zip(valid).filter(|(_, valid)| **valid).map(|(angle, _)| *angle).collect();
    angles.sort_by(f64::total_cmp);
    let gaps = angles.windows(2).map(|pair| pair[1] - pair[0]).filter(|gap| *gap > WRITTEN * noise_rad);
    let mut gaps: Vec<f64> = gaps.collect();
    gaps.sort_by(f64::total_cmp);
    if gaps.len() < LEAST {
        return None;
    }
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the gaps")]
    let first = gaps[(SMALL * gaps.len() as f64) as usize];
    whole_step(gaps.into_iter(), first, OFF).filter(|step_rad| !is_decimal(*step_rad))
}

/// Angles as the steps have them, without what was added behind: the multiples of the step, counted from where most are.
pub(super) fn on_grid(theta: &[f64], valid: &[bool], step_rad: f64) -> Vec<f64> {
    let (first_rad, _) = phase(theta, valid, step_rad);
    theta.iter().map(|angle| first_rad + ((angle - first_rad) / step_rad).round() * step_rad).collect()
}

/// Whether a step that the motor torque does not tell is one of a converter that writes the log, and not of the pick-off.
pub(super) fn is_the_logs(step_rad: f64, noise_rad: f64) -> bool {
    let converted = BITS.into_iter().any(|bits| is_decimal(step_rad * f64::from(bits).exp2()));
    step_rad < FINEST_RAD || converted && step_rad < CONVERTED * noise_rad
}

/// Whether a value is a power of ten.
fn is_decimal(value: f64) -> bool {
    let digits = value.log10();
    (digits - digits.round()).abs() < 1e-3
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use rand_distr::StandardNormal;

    use super::{adds_to_noise, is_the_logs, multiples_of};

    fn step_rad(theta: &[f64], valid: &[bool], noise_rad: f64) -> Option<f64> {
        multiples_of(theta, valid, noise_rad).filter(|step_rad| adds_to_noise(*step_rad, valid, noise_rad))
    }

    fn angles(step_rad: f64) -> Vec<f64> {
        let mut rng = ChaCha8Rng::seed_from_u64(1);
        let moves = |k: i32| 40e-6 * (f64::from(k) * 2e-3).sin();
        let mut noisy = |k: i32| moves(k) + 3e-7 * rng.sample::<f64, _>(StandardNormal);
        (0..10_000).map(|k| (noisy(k) / step_rad).round() * step_rad).collect()
    }

    #[test]
    fn a_step_below_the_noise_is_read_off_its_multiples() {
        let valid = vec![true; 10_000];
        let step = step_rad(&angles(4.321e-7), &valid, 3e-7).unwrap();
        assert!((step / 4.321e-7 - 1.0).abs() < 1e-3, "{step}");
        // the least count of the log, a noise large
        assert_eq!(step_rad(&angles(3.123e-7), &valid, 3.14e-7), None);
        assert_eq!(step_rad(&angles(1e-13), &valid, 3e-7), None);
        // far below the noise, and as many digits as were written
        assert_eq!(step_rad(&angles(3e-8), &valid, 3e-7), None);
        assert_eq!(step_rad(&angles(1e-6), &valid, 3e-7), None);
    }

    #[test]
    fn sixteen_bits_over_40_mrad_are_the_logs_and_fourteen_the_pick_offs() {
        let bits = |bits: f64| 40e-3 / bits.exp2();
        assert!(is_the_logs(bits(16.0), 1e-7) && is_the_logs(bits(14.0), 6e-7));
        assert!(!is_the_logs(bits(14.0), 3e-7) && !is_the_logs(4.321e-6, 3e-6));
        assert!(is_the_logs(4.321e-7, 3e-7));
    }

    #[test]
    fn angles_go_back_to_the_steps_that_they_were_on() {
        let stepped = |k: i32| 2e-7 + 3e-6 * f64::from(k / 10);
        let noisy: Vec<f64> = (0..1000).map(|k| stepped(k) + 4e-7 * f64::from(k % 3 - 1)).collect();
        let back = super::on_grid(&noisy, &vec![true; 1000], 3e-6);
        let worst = (0..1000).zip(&back).map(|(k, angle)| (angle - stepped(k)).abs()).fold(0.0, f64::max);
        assert!(worst < 1e-8, "{worst}");
    }
}
