//! Noise of a balance from what is left of it: that of a coloured sensor is larger in the band than its samples' own
//! differences show.
//!
//! ```text
//! median |D3 r|^2 / 0.455 = E^2 (20 - 30 w1 + 12 w2 - 2 w3) + A^2 (20 - 30 a1 + 12 a2 - 2 a3)
//! w = exp(-x^2/2)    a = w (1 - 2 x^2 + x^4/3), of a logged rate w (1 - x^2)    x = lag / (sqrt(2) sigma)
//! ```
//!
//! D3: third differences on the grid, of frequencies at the band's edge, where an effect has least; A what noise of the motion
//! brings, as its samples show it or less, E what noise of the effort does, flat over the band.

use super::motion::{Motion, MotionFrom};

/// Median of the square of a normal variable.
const MEDIAN: f64 = 0.455;
/// Third differences that are needed.
const FEWEST: usize = 100;

/// Noise of effort and motion in the balance, no less than what samples and motion show: an effect whose formulation is not
/// exact leaves more than a smaller one.
pub(super) fn floor_left(motion: &Motion, residual: &[f64]) -> f64 {
    let whole = |rows: &[usize]| rows[3] - rows[0] == 3 * motion.thin;
    let windows = motion.rows.windows(4).zip(residual.windows(4)).filter(|(rows, _)| whole(rows));
    let mut squares: Vec<f64> = windows.map(|(_, r)| (r[3] - 3.0 * r[2] + 3.0 * r[1] - r[0]).powi(2)).collect();
    if squares.len() < FEWEST {
        return motion.floor;
    }
    let middle = squares.len() / 2;
    let (_, median, _) = squares.select_nth_unstable_by(middle, f64::total_cmp);
    let (square, of_acceleration) = (*median / MEDIAN, differences(motion, of_acceleration(motion)));
    let of_motion = motion.own_noise.powi(2).min(square / of_acceleration);
    (of_motion + (square - of_motion * of_acceleration) / differences(motion, white)).sqrt().max(motion.floor)
}

/// Variance of third differences of noise with such a correlation over x.
fn differences(motion: &Motion, correlation: fn(f64) -> f64) -> f64 {
    let x = motion.thin as f64 / (2.0_f64.sqrt() * motion.whole_sigma());
    20.0 - 30.0 * correlation(x) + 12.0 * correlation(2.0 * x) - 2.0 * correlation(3.0 * x)
}

fn white(x: f64) -> f64 {
    (-0.5 * x * x).exp()
}

/// Correlation of the noise of acceleration.
fn of_acceleration(motion: &Motion) -> fn(f64) -> f64 {
    match motion.from {
        MotionFrom::Position => |x| white(x) * (1.0 - 2.0 * x * x + x.powi(4) / 3.0),
        MotionFrom::Velocity => |x| white(x) * (1.0 - x * x),
    }
}
