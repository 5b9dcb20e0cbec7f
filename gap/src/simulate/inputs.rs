//! What drives a prediction: the logged inputs, and what follows from them once for all predictions.

use std::ops::{Add, Mul, Sub};

use gimbal_servo::bearing;

use super::Prediction;
use super::bearing::load_nm;

/// Inputs at every row; missing samples filled in.
#[derive(Debug, Clone, Default)]
pub struct Inputs {
    /// Time between two rows [s].
    pub period_s: f64,
    /// Time of the first row since the run began, as far as the log tells [s].
    pub start_s: f64,
    /// Specific force along x, y, z [m/s2].
    pub accel_mps2: [Vec<f64>; 3],
    /// Vehicle rate about the gimbal axis [rad/s].
    pub rate_radps: Vec<f64>,
    /// Vehicle rate about x [rad/s]; empty when not logged.
    pub cross_radps: Vec<f64>,
    /// rel less phi: the integral of the vehicle rate, beginning where `relative_angle_rad` does [rad].
    pub turned_rad: Vec<f64>,
    /// `T_load` under the nominal bearing [N m].
    pub load_nm: Vec<f64>,
    /// `T_load` by a turn of the accelerometers about x and about y [N m/rad].
    pub load_by_turn: [Vec<f64>; 2],
    /// What the mean of `T_load` since the row before is above the line between the rows [N m].
    pub bulge_nm: Vec<f64>,
    /// What it is more along the cubics through the rows than along the lines [N m].
    pub bulge_by_curve_nm: Vec<f64>,
    /// What rows must have more for lines between them to have the means of cubics.
    pub curve: Curve,
}

/// A twelfth of the second differences, less than none: what the mean of a cubic through rows has more than that of a line.
#[derive(Debug, Clone, Default)]
pub struct Curve {
    /// Of the specific force along x, y, z [m/s2].
    pub accel_mps2: [Vec<f64>; 3],
    /// Of the vehicle rate [rad/s].
    pub rate_radps: Vec<f64>,
}

impl Inputs {
    /// Fills in what follows from the columns.
    pub fn complete(&mut self, bearing: &bearing::Config, begin_rad: f64) {
        let [x, y, z] = &self.accel_mps2;
        self.load_nm = (0..x.len()).map(|k| load_nm(bearing, [x[k], y[k], z[k]])).collect();
        let step_rad = 1e-3;
        self.load_by_turn = [[step_rad, 0.0, 0.0], [0.0, step_rad, 0.0]].map(|turn| {
            let of = |k: usize| load_nm(bearing, turned([x[k], y[k], z[k]], turn)) - self.load_nm[k];
            (0..x.len()).map(|k| of(k) / step_rad).collect()
        });
        let line = |axis: &[f64], k: usize, share: f64| axis[k - 1] + share * (axis[k] - axis[k - 1]);
        let cubic = |axis: &[f64], k: usize, share: f64| {
            between(share, [axis[k.max(2) - 2], axis[k - 1], axis[k], axis[(k + 1).min(axis.len() - 1)]])
        };
        let bulge = |k: usize, along: &dyn Fn(&[f64], usize, f64) -> f64| {
            let load_nm = |share: f64| load_nm(bearing, [x, y, z].map(|axis| along(axis, k, share)));
            let chord = 0.5 * (self.load_nm[k - 1] + self.load_nm[k]);
            if z[k] * z[k - 1] >= 0.0 {
                return 2.0 / 3.0 * (load_nm(0.5) - chord);
            }
            (0..8).map(|part| load_nm((f64::from(part) + 0.5) / 8.0)).sum::<f64>() / 8.0 - chord
        };
        let after_first = |bulge: &dyn Fn(usize) -> f64| -> Vec<f64> {
            (0..x.len()).map(|k| if k == 0 { 0.0 } else { bulge(k) }).collect()
        };
        self.bulge_nm = after_first(&|k| bulge(k, &line));
        self.bulge_by_curve_nm = after_first(&|k| bulge(k, &cubic) - self.bulge_nm[k]);
        self.curve = Curve {
            accel_mps2: self.accel_mps2.each_ref().map(|axis| curved(axis)),
            rate_radps: curved(&self.rate_radps),
        };
        let mut turned = begin_rad;
        let mut last = self.rate_radps.first().copied().unwrap_or(0.0);
        self.turned_rad = self
            .rate_radps
            .iter()
            .map(|&rate| {
                turned += 0.5 * self.period_s * (rate + last);
                last = rate;
                turned
            })
            .collect();
        if let Some(first) = self.turned_rad.first_mut() {
            *first = begin_rad;
        }
    }

    /// Rows of a length of time.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "rows")]
    pub(crate) fn rows_of(&self, length_s: f64) -> usize {
        (length_s / self.period_s) as usize
    }

    /// Number of rows.
    #[must_use]
    pub fn len(&self) -> usize {
        self.rate_radps.len()
    }

    /// Whether there is no row.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rate_radps.is_empty()
    }

    /// Slip rate of the bearing, `rate - phi'` [rad/s].
    #[must_use]
    pub fn slip_radps(&self, prediction: &Prediction) -> Vec<f64> {
        less(&self.rate_radps, &prediction.gimbal_rate_radps)
    }

    /// Angle of the gimbal in the vehicle, `turned - phi` [rad].
    #[must_use]
    pub fn rel_rad(&self, prediction: &Prediction) -> Vec<f64> {
        less(&self.turned_rad, &prediction.gimbal_angle_rad)
    }

    /// The columns as they were: the log has them late by `skew_s`. What follows from them is not filled in.
    #[must_use]
    pub fn advanced(&self, skew_s: f64) -> Self {
        let later = Later::by(skew_s / self.period_s);
        Self {
            period_s: self.period_s,
            start_s: self.start_s,
            accel_mps2: self.accel_mps2.each_ref().map(|axis| later.line(axis)),
            rate_radps: later.line(&self.rate_radps),
            cross_radps: later.line(&self.cross_radps),
            ..Self::default()
        }
    }
}

/// ```text
/// mean of a cubic - mean of the line = -h^2 f''/12        h^2 f'' = f(k + 1) - 2 f(k) + f(k - 1)
/// ```
fn curved(values: &[f64]) -> Vec<f64> {
    let mut curve = vec![0.0; values.len()];
    for (place, three) in curve.iter_mut().skip(1).zip(values.windows(3)) {
        *place = (2.0 * three[1] - three[0] - three[2]) / 12.0;
    }
    curve
}

fn less(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

/// A vector after a small turn about x, y, z.
#[inline(always)]
pub(crate) fn turned<T>([x, y, z]: [T; 3], [about_x, about_y, about_z]: [T; 3]) -> [T; 3]
where
    T: Copy + Add<Output = T> + Sub<Output = T> + Mul<Output = T>,
{
    [x + about_y * z - about_z * y, y + about_z * x - about_x * z, z + about_x * y - about_y * x]
}

/// What is smooth, so many rows later.
pub(super) fn later(values: &[f64], rows: f64) -> Vec<f64> {
    Later::by(rows).curve(values)
}

/// Some rows and a part of one later.
struct Later {
    rows: isize,
    share: f64,
}

impl Later {
    #[allow(clippy::cast_possible_truncation, reason = "rows")]
    fn by(shift: f64) -> Self {
        Self { rows: shift.floor() as isize, share: shift - shift.floor() }
    }

    /// Row after row, the ends held.
    fn rows<'a>(&self, values: &'a [f64], more: isize) -> impl Iterator<Item = f64> + 'a {
        let shift = self.rows + more;
        let held = shift.unsigned_abs().min(values.len());
        let (first, last) = (values.first().copied(), values.last().copied());
        let (before, inside, after) =
            if shift < 0 { (held, &values[..values.len() - held], 0) } else { (0, &values[held..], held) };
        let ends = |value: Option<f64>, count: usize| std::iter::repeat_n(value.unwrap_or(0.0), count);
        ends(first, before).chain(inside.iter().copied()).chain(ends(last, after))
    }

    /// On the line between two rows.
    fn line(&self, values: &[f64]) -> Vec<f64> {
        self.rows(values, 0).zip(self.rows(values, 1)).map(|(a, b)| a + self.share * (b - a)).collect()
    }

    /// On the cubic through four rows.
    fn curve(&self, values: &[f64]) -> Vec<f64> {
        let x = self.share;
        let around =
            self.rows(values, -1).zip(self.rows(values, 0)).zip(self.rows(values, 1).zip(self.rows(values, 2)));
        around.map(|((a, b), (c, d))| between(x, [a, b, c, d])).collect()
    }
}

/// On the cubic through four rows (Catmull and Rom), between the middle two.
fn between(x: f64, [a, b, c, d]: [f64; 4]) -> f64 {
    b + 0.5 * x * (c - a + x * (2.0 * a - 5.0 * b + 4.0 * c - d + x * (3.0 * (b - c) + d - a)))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use gimbal_servo::Config;

    use super::Inputs;
    use crate::simulate::load_nm;

    /// Mean of the load over a vibration along z, finely and by rows of 1 ms with their bulges.
    #[test]
    fn closed_form_the_load_of_a_vibration_through_zero_is_its_own() {
        let (bearing, hz, rows) = (Config::consistent().bearing, 151.0, 20_000_u32);
        let force_mps2 = |time_s: f64| 12.0 * (TAU * hz * time_s).sin();
        let fine = |k: u32| load_nm(&bearing, [0.0, 0.0, force_mps2((f64::from(k) + 0.5) / 1e4 / hz)]);
        let true_nm = (0..10_000).map(fine).sum::<f64>() / 1e4;
        let mut inputs = Inputs { period_s: 1e-3, ..Inputs::default() };
        inputs.accel_mps2 = [vec![0.0; rows as usize], vec![0.0; rows as usize], Vec::new()];
        inputs.accel_mps2[2] = (0..rows).map(|k| force_mps2(1e-3 * f64::from(k))).collect();
        inputs.rate_radps = vec![0.0; rows as usize];
        inputs.complete(&bearing, 0.0);
        let mean = |values: &[f64]| values.iter().sum::<f64>() / f64::from(rows);
        let along_lines_nm = mean(&inputs.load_nm) + mean(&inputs.bulge_nm);
        let along_curves_nm = along_lines_nm + mean(&inputs.bulge_by_curve_nm);
        let preload_nm = load_nm(&bearing, [0.0; 3]);
        // the line through two points of a sine has less: a twelfth of the square of its angle
        let less = (TAU * hz * 1e-3).powi(2) / 12.0;
        let off = |own_nm: f64| (own_nm - true_nm) / (true_nm - preload_nm);
        assert!((off(along_lines_nm) + less).abs() < 0.2 * less, "{} of {less}", off(along_lines_nm));
        assert!(off(along_curves_nm).abs() < 0.15 * less, "{}", off(along_curves_nm));
    }
}
