//! Numbers of waves over the position at which a balance shows a ripple.

use super::library::Shape;
use super::motion::Motion;
use super::regress::Grams;

/// Numbers of waves that are kept from the search, for each kind of ripple.
const KEPT_WAVES: usize = 12;
/// Share of its power that must pass the smoothing.
const LEAST_PASSED: f64 = 0.1;

/// Ripples whose number of waves stands out in what the parameters leave.
pub(super) fn waves(motion: &Motion, target: &[f64], base: &[Vec<f64>]) -> Vec<Shape> {
    let mut all = base.to_vec();
    all.push(vec![1.0; target.len()]);
    let grams = Grams::new(&all, target, &motion.block);
    let fit = grams.fit(&[0, 1, 2, 3]);
    let rest: Vec<f64> =
        (0..target.len()).map(|row| target[row] - (0..4).map(|c| fit[c] * all[c][row]).sum::<f64>()).collect();
    let (q, v) = (motion.pick(&motion.q), motion.pick(&motion.v));
    let (needed, s) = (motion.pick(&motion.needed), motion.pick(&motion.s));
    let carriers: [(&dyn Fn(usize) -> f64, &dyn Fn(f64) -> Shape, f64); 3] = [
        (&|_| 1.0, &|wave_number| Shape::Ripple { wave_number }, f64::MAX),
        (&|i| needed[i], &|wave_number| Shape::MotorRipple { wave_number }, f64::MAX),
        (&|i| s[i], &|wave_number| Shape::PositionFriction { wave_number }, 24.0),
    ];
    let numbers = motion.wave_numbers();
    let mut shapes = Vec::new();
    for (kind, (carrier, shape, most)) in carriers.iter().enumerate() {
        if motion.stands && kind > 0 {
            continue;
        }
        let mut found: Vec<(f64, f64)> = {
            use rayon::prelude::*;
            let carried: Vec<f64> = (0..q.len()).map(carrier).collect();
            let all: f64 = carried.iter().map(|value| value * value).sum();
            let sigma_s = motion.period_s * motion.whole_sigma();
            numbers
                .par_iter()
                .filter(|k| **k * if motion.rotary { 1.0 } else { motion.travel / std::f64::consts::TAU } <= *most)
                .map(|&k| {
                    let (mut re, mut im, mut power) = (0.0, 0.0, 1e-300);
                    for i in 0..q.len() {
                        // what the smoothing leaves of a wave at this rate
                        let blur = 0.5 * (k * v[i] * sigma_s).powi(2);
                        if blur > 6.0 {
                            continue;
                        }
                        let wave = carried[i] * (-blur).exp();
                        let (sin, cos) = (k * q[i]).sin_cos();
                        re += wave * rest[i] * cos;
                        im += wave * rest[i] * sin;
                        power += wave * wave;
                    }
                    // one that passes at slow rows alone is a function of rests
                    if power > LEAST_PASSED * all { ((re * re + im * im) / power, k) } else { (0.0, k) }
                })
                .collect()
        };
        // peaks alone: neighbours of a line are its skirt
        let peaks: Vec<(f64, f64)> = (0..found.len())
            .filter(|&i| {
                motion.rotary
                    || (i == 0 || found[i - 1].0 <= found[i].0)
                        && (i + 1 == found.len() || found[i + 1].0 <= found[i].0)
            })
            .map(|i| found[i])
            .collect();
        found = peaks;
        found.sort_by(|a, b| b.0.total_cmp(&a.0));
        let kept = if kind == 0 { KEPT_WAVES } else { KEPT_WAVES / 2 };
        shapes.extend(found.iter().filter(|(gain, _)| *gain > 0.0).take(kept).map(|(_, k)| shape(*k)));
    }
    shapes
}
