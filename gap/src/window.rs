//! Hann's window.

/// `0.5 - 0.5 cos(2 pi (k + 1/2) / length)`.
pub(crate) fn hann(length: usize) -> Vec<f64> {
    (0..length).map(|k| 0.5 - 0.5 * (std::f64::consts::TAU * (k as f64 + 0.5) / length as f64).cos()).collect()
}
