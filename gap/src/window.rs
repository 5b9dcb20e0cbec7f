//! Hann's window, and the power of a series over frequency.

use realfft::RealFftPlanner;
use realfft::num_complex::Complex;

/// `0.5 - 0.5 cos(2 pi (k + 1/2) / length)`.
pub(crate) fn hann(length: usize) -> Vec<f64> {
    (0..length).map(|k| 0.5 - 0.5 * (std::f64::consts::TAU * (k as f64 + 0.5) / length as f64).cos()).collect()
}

/// Power of the lines of a series with zeros up to a length.
pub(crate) fn spectrum(series: &[f64], length: usize) -> Option<Vec<f64>> {
    let transform = RealFftPlanner::<f64>::new().plan_fft_forward(length);
    let mut padded = transform.make_input_vec();
    padded[..series.len()].copy_from_slice(series);
    let mut lines = transform.make_output_vec();
    transform.process(&mut padded, &mut lines).ok()?;
    Some(lines.iter().map(Complex::norm_sqr).collect())
}
