//! Zero-phase smoothing and derivatives: convolution with a Gaussian of standard deviation sigma and its derivatives.
//!
//! ```text
//! g(t) = exp(-t^2/(2 sigma^2)) / (sigma sqrt(2 pi))        x * g,  x * g' = d(x * g)/dt,  x * g''
//! ```
//!
//! Half power at f = 0.1325/sigma. Kernels are corrected so that polynomials of their order pass exactly.

/// Half power of a Gaussian: frequency times sigma.
pub(super) const HALF_POWER: f64 = 0.1325;

/// An odd kernel, its middle at zero lag.
#[derive(Debug, Clone)]
pub(super) struct Kernel {
    taps: Vec<f64>,
}

impl Kernel {
    /// Smoothing (`order` 0), first or second derivative; sigma in rows, `period_s` of a row.
    pub(super) fn new(sigma_rows: f64, order: u32, period_s: f64) -> Self {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few rows")]
        let half = ((4.0 * sigma_rows).ceil() as usize).max(2);
        let lags: Vec<f64> = (0..=2 * half).map(|place| place as f64 - half as f64).collect();
        let gauss = |lag: &f64| (-0.5 * (lag / sigma_rows).powi(2)).exp();
        let moment =
            |taps: &[f64], power: i32| taps.iter().zip(&lags).map(|(tap, lag)| tap * lag.powi(power)).sum::<f64>();
        let mut taps: Vec<f64> = lags.iter().map(gauss).collect();
        match order {
            0 => {
                let sum = moment(&taps, 0);
                for tap in &mut taps {
                    *tap /= sum;
                }
            }
            1 => {
                taps.iter_mut().zip(&lags).for_each(|(tap, lag)| *tap *= lag);
                let scale = moment(&taps, 1) * period_s;
                for tap in &mut taps {
                    *tap /= scale;
                }
            }
            _ => {
                taps.iter_mut().zip(&lags).for_each(|(tap, lag)| *tap *= (lag / sigma_rows).powi(2) - 1.0);
                let mean = moment(&taps, 0) / taps.len() as f64;
                for tap in &mut taps {
                    *tap -= mean;
                }
                let scale = moment(&taps, 2) * 0.5 * period_s * period_s;
                for tap in &mut taps {
                    *tap /= scale;
                }
            }
        }
        Self { taps }
    }

    /// Rows to either side.
    pub(super) fn half(&self) -> usize {
        self.taps.len() / 2
    }

    /// Gain of white noise.
    pub(super) fn noise_gain(&self) -> f64 {
        self.taps.iter().map(|tap| tap * tap).sum::<f64>().sqrt()
    }

    /// The convolution at one row; rows beyond the ends repeat the end.
    pub(super) fn at(&self, values: &[f64], row: usize) -> f64 {
        let half = self.half();
        if row >= half && row + half < values.len() {
            return self.taps.iter().zip(&values[row - half..=row + half]).map(|(tap, value)| tap * value).sum();
        }
        let last = values.len() - 1;
        self.taps
            .iter()
            .enumerate()
            .map(|(place, tap)| tap * values[(row + place).saturating_sub(half).min(last)])
            .sum()
    }

    /// The convolution at every row.
    pub(super) fn apply(&self, values: &[f64]) -> Vec<f64> {
        (0..values.len()).map(|row| self.at(values, row)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::Kernel;

    #[test]
    fn closed_form_a_parabola_has_its_derivatives() {
        let period_s = 1e-3;
        let values: Vec<f64> = (0..200)
            .map(|k| {
                let t = f64::from(k) * period_s;
                3.0 + 2.0 * t + 5.0 * t * t
            })
            .collect();
        for sigma in [0.6, 1.3, 4.0] {
            let of = |order| Kernel::new(sigma, order, period_s).at(&values, 100);
            assert!((of(1) - 3.0).abs() < 1e-9, "{}", of(1));
            assert!((of(2) - 10.0).abs() < 1e-6, "{}", of(2));
        }
        assert!((Kernel::new(2.0, 0, period_s).at(&[1.0; 50], 0) - 1.0).abs() < 1e-12);
    }
}
